/* Bodies in space: what of a request moves so, and its outcomes, as rockfrag.assess.objects and .outcomes have them. */
const inSpace = (data) => {
  "use strict";
  const { both, constants: { GRAVITY } } = data;
  const recordOf = data.earthquakes.map((_, m) => both.records.find(({ first, second }) => m === first || m === second) ?? { first: m, second: null });
  const inFewer = new Uint8Array(data.earthquakes.length);
  for (const m of both.fewer) inFewer[m] = 1;
  const inertiaOf = (block) => block.inertia ?? (block.mass * (block.width * block.width + block.height * block.height)) / 12;

  // ---- bodies

  // a block as it moves in space, of an object (its own sizes); null where that is not known
  function solidOf(top, own, { round, facing }) {
    const whole = top.height > own.height * both.higher, across = inertiaOf(top);
    const { width, height, mass, cgHeight, cgOffset } = top;
    if (round) return whole ? null : rockfragSolid({ width, height, mass, cgHeight, cgOffset, round, inertia: [across, across, (mass * width * width) / 8] });
    const aside = (own.mass * (own.depth * own.depth - own.width * own.width)) / 12;
    let along = (own.mass * (own.width * own.width + own.depth * own.depth)) / 12;
    if (whole) along += ((mass - own.mass) * width * width) / 6;
    const depth = whole ? Math.max(own.depth, width) : own.depth, turned = ((facing % 360) + 360) % 360;
    return rockfragSolid({ width, depth, height, mass, cgHeight, cgOffset, inertia: [across + aside, across, along], turn: turned ? facing * (Math.PI / 180) : 0 });
  }

  // what is shaken in a plane, with what moves in space beside it
  function planOf({ statue, solid }, runs) {
    // a round base rolls on its rim; what it is fixed to stands on another one
    const rolling = ({ height }) => (height === statue.height ? both.rolling : NaN);
    const found = runs.filter(({ name }) => name !== "restitution").map((run) => {
      const own = run.role === "moved" ? run.body.statue : statue;
      return { ...run, few: false, fewer: Boolean(run.role === "moved" || run.role === "mitigation"), fewest: run.role === "moved",
        body: solid.round ? { ...run.body, rolling: rolling(run.body.statue) } : run.body, worst: solid.round,
        solid: solidOf(run.body.statue, own, solid) };
    });
    const now = found[0];
    if (!solid.round && solid.anywhere) {
      const facing = (by) => ({ ...now, role: "moved", name: "facing", fewer: true, fewest: true, solid: solidOf(statue, statue, { ...solid, facing: solid.facing + by }) });
      found.push(facing(-both.aside), facing(both.aside));
    }
    // of fewer motions the object as it stands, in one plane along one component, and at the site's level alone, which comes first
    if (runs.length > 1) found.push({ ...now, role: "before", fewer: true }, { ...now, role: "planar", solid: null, worst: false, body: runs[0].body },
      { ...now, role: "first" });
    return found;
  }

  // ---- motions

  // a component at the times that it has in common with the other
  function common(motion, times) {
    if (!times) return motion;
    const { begin, skip, count, dt } = times, { samples } = motion;
    if (skip !== null) return { samples: samples.subarray(skip, skip + count), dt };
    const found = new Float64Array(count), last = samples.length - 1, at = (j) => j * motion.dt;
    for (let i = 0, j = 0; i < count; i++) {
      const x = begin + i * dt;
      while (j < last && at(j + 1) <= x) j++;
      found[i] = j >= last ? samples[last] : ((samples[j + 1] - samples[j]) / (at(j + 1) - at(j))) * (x - at(j)) + samples[j];
    }
    return { samples: found, dt };
  }
  const pairOf = (record, shaken) => (record.second === null ? [shaken(record.first), null]
    : [record.first, record.second].map((m, k) => common(shaken(m), record.times[k])));
  function turned([one, other], [c, s]) {
    return { dt: one.dt, samples: one.samples.map((a, i) => a * c + other.samples[i] * s) };
  }

  // ---- statics: the factor on a motion from which it lifts an object

  const liftingInPlane = (body, { samples }) => (body.uplift * GRAVITY) / samples.reduce((peak, a) => Math.max(peak, Math.abs(a)), 0);
  const length = (x, y) => Math.sqrt(x * x + y * y);
  // over an edge or a rim, by both components
  function liftingInSpace({ points, height, rim, centre }, [one, other]) {
    let most = 0;
    if (rim) {
      const least = (GRAVITY * (rim - length(...centre))) / height;
      one.samples.forEach((a, i) => { most = Math.max(most, length(a, other ? other.samples[i] : 0)); });
      return least / most;
    }
    const edges = points.map(([x, y], i) => {
      const [toX, toY] = points[(i + 1) % points.length], [dx, dy] = [toX - x, toY - y], side = length(dx, dy), normal = [dy / side, -dx / side];
      const least = (GRAVITY * (normal[0] * x + normal[1] * y)) / height;
      return [normal[0] / least, normal[1] / least];
    });
    one.samples.forEach((a, i) => { for (const [x, y] of edges) most = Math.max(most, -(x * a + y * (other ? other.samples[i] : 0))); });
    return 1 / most;
  }

  // ---- outcomes

  // a worker's part: outcomes of a run under motions first to last - 1; `shaken` gives a motion on the run's floor, and
  // `scalesOf` levels, factors on motions and which are allowed
  function counter(ensemble, space) {
    return function count(run, first, last, shaken, scalesOf) {
      const kept = Array.from({ length: last - first }, (_, i) => first + i).filter((m) => !run.fewer || inFewer[m]);
      const { levels, allowed, scales } = scalesOf(kept), each = levels.length;
      const found = Object.fromEntries(["overturned", "rocked", "allowed"].map((name) => [name, new Uint8Array((last - first) * each)]));
      found.lifting = new Float64Array(last - first).fill(Infinity);
      const lift = (m, factor) => { found.lifting[m - first] = Math.min(found.lifting[m - first], factor); };
      const put = (name, m, values) => values.forEach((value, k) => { found[name][(m - first) * each + k] |= value; });
      kept.forEach((m, i) => put("allowed", m, allowed.subarray(i * each, (i + 1) * each)));
      if (!kept.length) return found;
      const note = (m, told, i) => { for (const name of ["overturned", "rocked"]) put(name, m, told[name].subarray(i * each, (i + 1) * each)); };
      const planar = !run.solid || run.body.pedestal;
      if (planar && !run.worst) {
        const body = ensemble.bodyOf(run.body), shaking = kept.map(shaken), told = ensemble.count(body, shaking, scales);
        kept.forEach((m, i) => { note(m, told, i); lift(m, liftingInPlane(body, shaking[i])); });
      }
      if (run.solid || run.worst) for (const record of new Set(kept.map((m) => recordOf[m]))) {
        const own = scalesOf([record.first]), places = [record.first, record.second].filter((m) => kept.includes(m));
        // what has fallen in one answer needs no other
        const stands = () => levels.map((_, k) => places.some((m) => !found.overturned[(m - first) * each + k]));
        const add = (told) => { for (const m of places) note(m, told, 0); };
        const sides = planar && run.worst ? sidesOf(record, shaken) : [], across = sides.length / 2;
        const some = sides.filter((_, i) => i % across === 0);
        if (some.length) add(planarOutcomes(run.body, some, own, stands()));
        for (const m of places) {
          for (const side of sides) lift(m, liftingInPlane(ensemble.bodyOf(run.body), side));
          if (run.solid) lift(m, liftingInSpace(space.bodyOf(run.solid), pairOf(record, shaken)));
        }
        if (run.solid) add(solidOutcomes(run.solid, record, shaken, own.scales, stands()));
        if (sides.length > some.length) add(planarOutcomes(run.body, sides.filter((_, i) => i % across), own, stands()));
      }
      return found;
    };
    function solidOutcomes(solid, record, shaken, scales, stands) {
      const body = space.bodyOf(solid), [one, other] = pairOf(record, shaken);
      const told = Array.from(scales, (scale, k) => (stands[k] ? space.integrate({ body, x: one.samples, y: other?.samples ?? null, dt: one.dt, scale }) : { overturned: 0, peak: 0 }));
      return { overturned: Uint8Array.from(told, (each) => each.overturned), rocked: Uint8Array.from(told, (each) => each.peak > 0) };
    }
    // a record in all directions
    function sidesOf(record, shaken) {
      const pair = pairOf(record, shaken);
      return pair[1] ? both.turns.map((turn) => turned(pair, turn)) : [pair[0]];
    }
    // in the worst of some directions: what happens from one side happens
    function planarOutcomes(body, sides, { levels, allowed, factors }, stands) {
      const scales = new Float64Array(sides.length * levels.length);
      sides.forEach(({ samples }, i) => levels.forEach((_, k) => { scales[i * levels.length + k] = factors(k, allowed[k] && stands[k], samples); }));
      const told = ensemble.count(ensemble.bodyOf(body), sides, scales), joined = {};
      for (const name of ["overturned", "rocked"])
        joined[name] = Uint8Array.from(levels, (_, k) => Math.max(...sides.map((_, i) => told[name][i * levels.length + k])));
      return joined;
    }
  }
  return { planOf, counter, pairOf, recordOf, solidOf, fewer: both.fewer };
};
if (typeof module !== "undefined") module.exports = inSpace;
