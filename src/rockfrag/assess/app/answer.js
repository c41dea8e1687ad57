/* The answer about one object: outcomes of its bodies by motion and level, and what
 * follows from them.
 */
const answer = (data, core) => {
  "use strict";
  const {
    constants: { MODEL, SPACE, ACCEPTED_AT_A_LEVEL, ACCEPTED_IN_FIFTY_YEARS },
    measures,
  } = data;
  const judge = risk(data, core);
  const spatial = inSpace(data, core);
  const building = floors(data, core);
  const wording = findings(data, core, judge);
  const holders = holding(data, core, spatial);

  // levels of a run: the asked one among those of the measure
  function levelsOf(request, run) {
    if (["first", "asked"].includes(run.role)) return [siteLevel(request)];
    const table = tableOf(request);
    const fewness = ["fewest", "fewer", "few"].find((name) => run[name]);
    const all = run.hold
      ? [...holders.levelsOf(request)]
      : [...table[fewness ?? "levels"]];
    const asked = siteLevel(request);
    if (!all.includes(asked)) all.push(asked);
    return all.sort((a, b) => a - b);
  }
  const tableOf = (request) =>
    (request.solid ? data.both.measures : measures)[request.measure];
  const hazardOf = ({ curve, years, level }) =>
    curve ?? (years === null ? null : judge.curveOfOneLevel(level, years));
  const siteLevel = (request) => request.level ?? judge.levelOf(request.curve, 1 / 475);

  // factors to all levels of some motions, and which of them count
  // at one level any peak is believed
  const scalesOf = (request, run, places, shaking) =>
    core.within(() => {
      const levels = levelsOf(request, run);
      const { values } = tableOf(request);
      const shape = [places.length, levels.length];
      const scales = core.zeros(shape);
      const allowed = core.zeros(shape, Uint8Array);
      const peaks = shaking.map(({ peak }) => (run.role === "asked" ? 0 : peak));
      core.call(
        "fill_scales",
        core.put(levels),
        core.put(places.map((m) => values[m])),
        core.put(peaks),
        scales,
        allowed,
      );
      return { levels, scales: scales.values.slice(), allowed: allowed.values.slice() };
    });
  // those on what shakes the object; at rest what does not count
  const factorsOf = ({ levels, scales, allowed }, shaking) =>
    core.within(() => {
      const shape = [shaking.length, levels.length];
      const factors = core.zeros(shape);
      const peaks = core.put(shaking.map(({ peak }) => peak));
      core.call(
        "fill_factors",
        core.put(scales, shape),
        core.put(allowed, shape),
        peaks,
        factors,
      );
      return factors.values.slice();
    });

  // a worker's part: outcomes of a run under some of the motions
  function counter(ensemble, motions, space, plane) {
    const solids = spatial.counter(ensemble, space);
    const held = holders.counter(ensemble, plane, space);
    const shaken = new Map();
    let standing = "";
    function shakingOf(place, floor, part) {
      // floors of one place are kept, and the ground
      if (!place.ground && place.key !== standing)
        for (const key of shaken.keys()) if (key) shaken.delete(key);
      if (!place.ground) standing = place.key;
      const key = place.ground ? "" : `${place.key} ${floor}`;
      const known = shaken.get(key) ?? new Map();
      shaken.set(key, known);
      if (!known.has(part))
        known.set(
          part,
          partOf(part).map((motion) => {
            const moved = place.ground
              ? motion
              : building.floorMotion(place.floors[floor], motion);
            return { ...moved, peak: spatial.peakOf(moved) };
          }),
        );
      return known.get(part);
    }
    const partOf = (part) => {
      const [first, last] = part.split("-");
      return motions.slice(Number(first), Number(last));
    };
    return function count(request, run, { first, last }) {
      if (run.hold) return countHeld(request, run, first, last);
      if (request.solid) return countInSpace(request, run, first, last);
      const places = Array.from({ length: last - first }, (_, i) => first + i);
      const on = (floor) => shakingOf(request.place, floor, `${first}-${last}`);
      // what is allowed follows from the floor as it is, on whatever floor it is
      // counted
      const shaking = on(run.floor ?? "");
      const own = scalesOf(request, run, places, on(""));
      const factors = factorsOf(own, shaking);
      const body = ensemble.bodyOf(run.body);
      return {
        ...ensemble.count(body, shaking, factors),
        allowed: own.allowed,
        lifting: Float64Array.from(shaking, ({ peak }) =>
          core.call("lifting_in_plane", body.uplift, peak),
        ),
      };
    };
    // of a trial, of the motions by which it is tried alone
    function countHeld(request, run, first, last) {
      const on = (m) => shakingOf(request.place, "", `${m}-${m + 1}`)[0];
      const chosen = holders.motionsOf(request, run);
      const every = Array.from({ length: last - first }, (_, i) => first + i);
      const places = every.filter((m) => !chosen || chosen.includes(m));
      if (!places.length) return { places };
      const made = {
        scalesOf: (some) => scalesOf(request, run, some, some.map(on)),
        factorsOf,
      };
      return { places, ...held(run, places, on, made) };
    }
    function countInSpace(request, run, first, last) {
      const on = (floor) => (m) => shakingOf(request.place, floor, `${m}-${m + 1}`)[0];
      const made = {
        scalesOf: (places) => scalesOf(request, run, places, places.map(on(""))),
        factorsOf,
      };
      return solids(run, first, last, on(run.floor ?? ""), made);
    }
  }

  // all parts of a run put together
  function joined(request, run, parts) {
    if (run.hold) return joinedOfTrial(request, run, parts);
    const levels = levelsOf(request, run);
    const found = { levels, motions: run.fewer ? spatial.fewer : null };
    for (const name of ["overturned", "rocked", "allowed"]) {
      found[name] = new Uint8Array(levels.length * data.earthquakes.length);
      for (const part of parts) found[name].set(part[name], part.first * levels.length);
    }
    // from factors to levels
    found.lifting = new Float64Array(data.earthquakes.length);
    for (const part of parts) found.lifting.set(part.lifting, part.first);
    const { values } = tableOf(request);
    found.lifting.forEach((factor, m) => {
      found.lifting[m] = factor * values[m];
    });
    return found;
  }

  function joinedOfTrial(request, run, parts) {
    const levels = levelsOf(request, run);
    const found = { levels, motions: holders.motionsOf(request, run) };
    const tables = ["overturned", "rocked", "leaning", "allowed"];
    for (const name of tables)
      found[name] = new Uint8Array(levels.length * data.earthquakes.length);
    found.lifting = new Float64Array(data.earthquakes.length).fill(Infinity);
    const { values } = tableOf(request);
    for (const part of parts)
      part.places.forEach((m, i) => {
        for (const name of tables)
          found[name].set(
            part[name].subarray(i * levels.length, (i + 1) * levels.length),
            m * levels.length,
          );
        found.lifting[m] = part.lifting[i] * values[m];
      });
    return found;
  }
  // what a holder must bear, or as much as is said of it, and in how many motions it
  // holds then
  const asked = (kind, parts, bears = null) =>
    core.within(() => {
      const demands = parts.flatMap(({ places, demand, allowed }) =>
        places.flatMap((_, i) => (allowed[i] ? [demand[i]] : [])),
      );
      const given = core.put(demands);
      const least = core.call("ask", given, core.zeros([demands.length]));
      const enough = bears ?? core.call("rounded_up", least);
      const held = core.call("count_held", given, enough);
      return { kind, least, bears: enough, held, total: demands.length };
    });
  // a trial beside the object without what holds it: the answer's own numbers of both
  function tried(request, { free, held, asked, answered }) {
    const { level, site, shifts, rates } = answered;
    const hazard = hazardOf(request);
    const target = hazard ? judge.riskTarget(hazard, 50) : judge.fractionTarget(level);
    const here = (outcomes) => (site ? { ...outcomes, site } : outcomes);
    const does = judge.compared(target, shifts, rates, here(free))(here(held));
    return {
      does,
      before: changed(request, free, answered),
      after: changed(request, held, answered),
      said: wording.ofTrial(request, { level, does, asked, hold: request.hold }),
      motions: free.motions.length,
      levels: free.levels.length,
    };
  }

  const ESTIMATED = [
    "fraction",
    "rocking",
    "probability",
    "main",
    "half",
    "decision",
    "shifts",
    "rates",
  ];
  // what is known so far of runs whose outcomes are complete; `outcomes` by the place
  // of the run in the plan, `earlier` what was found when there were fewer
  function found(request, runs, outcomes, ensemble, earlier) {
    const early = !outcomes[0];
    const now = outcomes[early ? runs.findIndex(({ role }) => role === "first") : 0];
    const level = siteLevel(request);
    const hazard = early ? null : hazardOf(request);
    const { place } = request;
    const exact = request.measure === "PGA" && place.ground && !request.solid;
    const { ratios } = tableOf(request);
    const velocity =
      early || !ratios ? null : judge.velocityOf(now, ratios, level, exact);
    const here = (outcomes) =>
      velocity?.site ? { ...outcomes, site: velocity.site } : outcomes;
    const atSite = here(now);
    const known = (role) =>
      runs
        .map((run, i) => ({ ...run, outcomes: outcomes[i] && here(outcomes[i]) }))
        .filter((run) => run.role === role && run.outcomes);
    const target = hazard ? judge.riskTarget(hazard, 50) : judge.fractionTarget(level);
    const answer = {
      level,
      years: 50,
      counts: judge.countsAt(now, level),
      rocksFrom: rocksFrom(request, now, exact, ensemble),
      shares: judge.fractions(atSite),
      levels: now.levels,
      site: velocity?.site ?? null,
    };
    answer.value = judge.valueOf(judge.fractionTarget(level), atSite);
    answer.rockingValue = judge.valueOf(judge.fractionTarget(level, "rocked"), atSite);
    answer.probabilityValue = hazard ? judge.valueOf(target, atSite) : null;
    answer.deciding = deciding(now, level);
    answer.earthquakes = new Set(data.earthquakes).size;
    answer.accepted = hazard ? ACCEPTED_IN_FIFTY_YEARS : ACCEPTED_AT_A_LEVEL;
    const moved = known("moved");
    const sides = [];
    for (let i = 0; i + 1 < moved.length; i += 2)
      sides.push([moved[i].name, moved[i].outcomes, moved[i + 1].outcomes]);
    answer.complete = runs.every((run, i) => run.role !== "moved" || outcomes[i]);
    if (earlier?.complete) for (const name of ESTIMATED) answer[name] = earlier[name];
    else if (answer.complete) {
      const { shiftOf, afterUplift } = judge;
      const shifts = [
        ...sides.map(([name, lower, upper]) => shiftOf(name, lower, upper)),
        afterUplift("model", MODEL),
      ];
      if (!request.solid) shifts.push(afterUplift("space", SPACE));
      if (velocity) shifts.push(afterUplift("conversion", velocity.shift));
      const rates = hazard ? judge.ofQuantiles(atSite, hazard) : {};
      for (const name of Object.keys(rates)) shifts.push(afterUplift(name, 0));
      Object.assign(
        answer,
        { shifts, rates },
        judge.within(() => {
          const prediction = judge.predict(atSite, shifts);
          const of = (target) => judge.estimate(target, prediction, rates);
          const fraction = of(judge.fractionTarget(level));
          const rocking = of(judge.fractionTarget(level, "rocked"));
          const probability = hazard ? of(target) : null;
          const decision = judge.decision(target, prediction, rates, answer.accepted);
          return {
            fraction,
            rocking,
            ...(hazard ? { probability } : {}),
            main: probability ?? fraction,
            half: of(judge.amplitudeTarget(0.5)),
            decision,
          };
        }),
      );
    }
    const { shifts = [], rates = {} } = answer;
    const meanOf = (outcomes) =>
      answer.shifts
        ? judge.meanOf(target, shifts, rates, outcomes)
        : judge.valueOf(target, outcomes);
    answer.arrangements = [
      [ownOf(request), answer.main?.value ?? meanOf(atSite)],
      ...known("arrangement").map((run) => [run.name, meanOf(run.outcomes)]),
    ];
    const [before] = known("before");
    const [planar] = known("planar");
    const as = {
      mitigation: judge.compared(target, shifts, rates, before?.outcomes ?? atSite),
      arrangement: judge.compared(target, shifts, rates, atSite),
    };
    answer.planar = planar ? meanOf(planar.outcomes) : null;
    const changes = [...known("mitigation"), ...known("arrangement")].filter(
      ({ change }) => change,
    );
    const tried = changes.map(({ role, change, values, outcomes: with_ }) => ({
      name: change,
      values,
      ...as[role](with_),
    }));
    answer.mitigations = judge.ordered(
      tried,
      ({ factor }) => factor,
      ({ value }) => value,
    );
    answer.safer = saferOf(request, known("arrangement"), answer.mitigations);
    answer.said = wording.of(request, answer);
    return answer;
  }
  // the answer's own numbers for the object with a change, whose outcomes are these; as
  // much of it is not known
  function changed(request, outcomes, { level, site, shifts, rates }) {
    const hazard = hazardOf(request);
    const atSite = site ? { ...outcomes, site } : outcomes;
    const meanOf = (target, of = atSite) => judge.meanOf(target, shifts, rates, of);
    const target = judge.fractionTarget(level);
    const fraction = meanOf(target);
    const found = {
      fraction,
      probability: hazard && meanOf(judge.riskTarget(hazard, 50)),
    };
    const { leaning } = outcomes;
    if (!leaning) return found;
    const overturned = atSite.overturned.map((fell, k) => fell | leaning[k]);
    return { ...found, leans: meanOf(target, { ...atSite, overturned }) - fraction };
  }
  // the way in which it stands
  const ownOf = ({ pedestal }) => (pedestal ? "on_its_pedestal" : "on_the_floor");
  // arrangements that the motions show to be safer than its own, or its own if it is
  // safer than all others
  function saferOf(request, arrangements, mitigations) {
    const each = arrangements.map(({ name, change }) => [
      name,
      mitigations.find((item) => item.name === change),
    ]);
    const better = each.filter(([, item]) => item.shown).map(([name]) => name);
    return each.length &&
      each.every(([, { lower, helps }]) => core.choose("is_worse", lower, helps))
      ? [...better, ownOf(request)]
      : better;
  }
  function rocksFrom(request, now, exact, ensemble) {
    if (exact)
      return ensemble.bodyOf({ ...request, measured: request.restitution }).uplift;
    return Math.min(...judge.liftsFrom(now));
  }
  // the motion that is drawn, and at which level
  const deciding = ({ levels, allowed, overturned }, level) =>
    core.within(() => {
      const shape = [data.earthquakes.length, levels.length];
      const tables = [allowed, overturned].map((table) => core.put(table, shape));
      const found = core.zeros([3]);
      core.call("fill_deciding", core.put(levels), ...tables, level, found);
      const { MOTION, AT_LEVEL, FALLS } = core.constants;
      const values = [...found.values];
      return {
        motion: values[MOTION],
        level: values[AT_LEVEL],
        falls: Boolean(values[FALLS]),
      };
    });
  return { counter, joined, found, changed, asked, tried };
};
if (typeof module !== "undefined") module.exports = answer;
