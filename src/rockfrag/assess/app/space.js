/* Bodies in space: what of a request moves so, and its outcomes, as
 * rockfrag.assess.objects and .outcomes have them.
 */
const inSpace = (data, core) => {
  "use strict";
  const { both } = data;
  const recordOf = data.earthquakes.map(
    (_, m) =>
      both.records.find(({ first, second }) => m === first || m === second) ?? {
        first: m,
        second: null,
      },
  );
  const inFewer = new Uint8Array(data.earthquakes.length);
  for (const m of both.fewer) inFewer[m] = 1;

  // ---- bodies, as rows of the core

  const rowOf = ({ width, height, mass, inertia, cgHeight, cgOffset, depth }) =>
    core.put([
      width,
      height,
      mass,
      inertia ?? NaN,
      cgHeight ?? NaN,
      cgOffset ?? 0,
      depth ?? NaN,
    ]);
  const known = (value) => (Number.isNaN(value) ? null : value);
  // a block as a function of the core changes it
  const change = (name, block, ...given) =>
    core.within(() => {
      const found = core.zeros([7]);
      core.call(name, rowOf(block), ...given, found);
      const [width, height, mass, inertia, cgHeight, cgOffset, depth] = [
        ...found.values,
      ].map(known);
      return { width, height, mass, inertia, cgHeight, cgOffset, depth };
    });
  const isSo = (name, ...blocks) =>
    Boolean(core.within(() => core.choose(name, ...blocks.map(rowOf))));

  // a block as it moves in space, of an object (its own sizes); null where that is not
  // known
  function solidOf(top, own, { round, facing }) {
    if (round && isSo("is_whole", top, own)) return null;
    const { width, height, mass, cgHeight, cgOffset } = top;
    const moments = core.within(() => {
      const found = core.zeros([4]);
      core.call(
        ...(round ? ["tell_round", rowOf(top)] : ["tell_box", rowOf(top), rowOf(own)]),
        found,
      );
      return [...found.values];
    });
    const [depth] = moments.splice(3);
    const solid = { width, height, mass, cgHeight, cgOffset, inertia: moments };
    if (round) return rockfragSolid({ ...solid, round });
    const turn = facing % 360 ? facing * (Math.PI / 180) : 0;
    return rockfragSolid({ ...solid, depth, turn });
  }

  // what is shaken in a plane, with what moves in space beside it
  function planOf({ statue, solid }, runs) {
    // a round base rolls on its rim; what it is fixed to stands on another one
    const rolling = ({ height }) => (height === statue.height ? both.rolling : NaN);
    const found = runs
      .filter(({ name }) => name !== "restitution")
      .map((run) => {
        const own = run.role === "moved" ? run.body.statue : statue;
        return {
          ...run,
          few: false,
          fewer: Boolean(run.role === "moved" || run.role === "mitigation"),
          fewest: run.role === "moved",
          body: solid.round
            ? { ...run.body, rolling: rolling(run.body.statue) }
            : run.body,
          worst: solid.round,
          solid: solidOf(run.body.statue, own, solid),
        };
      });
    const now = found[0];
    if (!solid.round && solid.anywhere) {
      const facing = (by) => ({
        ...now,
        role: "moved",
        name: "facing",
        fewer: true,
        fewest: true,
        solid: solidOf(statue, statue, { ...solid, facing: solid.facing + by }),
      });
      // sources are drawn in this order: those of the object before those of the floor
      const floor = found.findIndex((run) => run.floor);
      const at = floor < 0 ? found.length : floor;
      found.splice(at, 0, facing(-both.aside), facing(both.aside));
    }
    // of fewer motions the object as it stands, in one plane along one component, and
    // at the site's level alone, which comes first
    if (runs.length > 1)
      found.push(
        { ...now, role: "before", fewer: true },
        { ...now, role: "planar", solid: null, worst: false, body: runs[0].body },
        { ...now, role: "first" },
      );
    return found;
  }

  // ---- motions

  // a component at the times that it has in common with the other
  function common(motion, times) {
    if (!times) return motion;
    const { begin, skip, count, dt } = times;
    const { samples } = motion;
    if (skip !== null) return { samples: samples.subarray(skip, skip + count), dt };
    return {
      dt,
      samples: core.within(() => {
        const found = core.zeros([count]);
        core.call("fill_between", core.put(samples), motion.dt, begin, dt, found);
        return found.values.slice();
      }),
    };
  }
  const pairOf = (record, shaken) =>
    record.second === null
      ? [shaken(record.first), null]
      : [record.first, record.second].map((m, k) => common(shaken(m), record.times[k]));
  const turned = ([one, other], [cosine, sine]) => ({
    dt: one.dt,
    samples: core.within(() => {
      const found = core.zeros([one.samples.length]);
      core.call(
        "fill_direction",
        core.put(one.samples),
        core.put(other.samples),
        cosine,
        sine,
        found,
      );
      return found.values.slice();
    }),
  });

  // ---- statics: the factor on a motion from which it lifts an object

  const peakOf = ({ samples }) =>
    core.within(() => core.call("peak_of", core.put(samples)));
  const liftingInPlane = ({ uplift }, { peak }) =>
    core.call("lifting_in_plane", uplift, peak);
  // over an edge or a rim, by both components
  const liftingInSpace = ({ points, height, rim, centre }, [one, other]) =>
    core.within(() => {
      const shaken = [
        core.put(one.samples),
        other ? core.put(other.samples) : core.zeros([one.samples.length]),
      ];
      if (rim) return core.call("lifting_over_rim", rim, ...centre, height, ...shaken);
      return core.call(
        "lifting_over_edges",
        core.put(points.flat(), [points.length, 2]),
        height,
        ...shaken,
      );
    });

  // ---- outcomes

  // a worker's part: outcomes of a run under motions first to last - 1; `shaken` gives
  // a motion on the run's floor, `scalesOf` levels, factors to them and which are
  // allowed, and `factorsOf` those on what shakes
  function counter(ensemble, space) {
    return function count(run, first, last, shaken, { scalesOf, factorsOf }) {
      const kept = Array.from({ length: last - first }, (_, i) => first + i).filter(
        (m) => !run.fewer || inFewer[m],
      );
      const all = scalesOf(kept);
      const { levels, allowed } = all;
      const each = levels.length;
      const found = Object.fromEntries(
        ["overturned", "rocked", "allowed"].map((name) => [
          name,
          new Uint8Array((last - first) * each),
        ]),
      );
      found.lifting = new Float64Array(last - first).fill(Infinity);
      const lift = (m, factor) => {
        found.lifting[m - first] = Math.min(found.lifting[m - first], factor);
      };
      const put = (name, m, values) =>
        values.forEach((value, k) => {
          found[name][(m - first) * each + k] |= value;
        });
      kept.forEach((m, i) =>
        put("allowed", m, allowed.subarray(i * each, (i + 1) * each)),
      );
      if (!kept.length) return found;
      const planarIn = (sides, stands, own) =>
        planarOutcomes(run.body, sides, own, stands, factorsOf);
      const note = (m, counted, i) => {
        for (const name of ["overturned", "rocked"])
          put(name, m, counted[name].subarray(i * each, (i + 1) * each));
      };
      const planar = !run.solid || run.body.pedestal;
      if (planar && !run.worst) {
        const body = ensemble.bodyOf(run.body);
        const shaking = kept.map(shaken);
        const counted = ensemble.count(body, shaking, factorsOf(all, shaking));
        kept.forEach((m, i) => {
          note(m, counted, i);
          lift(m, liftingInPlane(body, shaking[i]));
        });
      }
      if (run.solid || run.worst)
        for (const record of new Set(kept.map((m) => recordOf[m]))) {
          const own = scalesOf([record.first]);
          const places = [record.first, record.second].filter((m) => kept.includes(m));
          // what has fallen in one answer needs no other
          const stands = () =>
            levels.map((_, k) =>
              places.some((m) => !found.overturned[(m - first) * each + k]),
            );
          const add = (counted) => {
            for (const m of places) note(m, counted, 0);
          };
          const sides =
            planar && run.worst
              ? sidesOf(record, shaken).map((side) => ({
                  ...side,
                  peak: peakOf(side),
                }))
              : [];
          const across = sides.length / 2;
          const some = sides.filter((_, i) => i % across === 0);
          if (some.length) add(planarIn(some, stands(), own));
          for (const m of places) {
            for (const side of sides)
              lift(m, liftingInPlane(ensemble.bodyOf(run.body), side));
            if (run.solid)
              lift(m, liftingInSpace(space.bodyOf(run.solid), pairOf(record, shaken)));
          }
          if (run.solid)
            add(
              solidOutcomes(
                run.solid,
                record,
                shaken,
                factorsOf(own, [shaken(record.first)]),
                stands(),
              ),
            );
          if (sides.length > some.length)
            add(
              planarIn(
                sides.filter((_, i) => i % across),
                stands(),
                own,
              ),
            );
        }
      return found;
    };
    function solidOutcomes(solid, record, shaken, scales, stands) {
      const body = space.bodyOf(solid);
      const [one, other] = pairOf(record, shaken);
      const counted = Array.from(scales, (scale, k) =>
        stands[k]
          ? space.integrate({
              body,
              x: one.samples,
              y: other?.samples ?? null,
              dt: one.dt,
              scale,
            })
          : { overturned: 0, peak: 0 },
      );
      return {
        overturned: Uint8Array.from(counted, (each) => each.overturned),
        rocked: Uint8Array.from(counted, (each) => each.peak > 0),
      };
    }
    // a record in all directions
    function sidesOf(record, shaken) {
      const pair = pairOf(record, shaken);
      return pair[1] ? both.turns.map((turn) => turned(pair, turn)) : [pair[0]];
    }
    // in the worst of some directions: what happens from one side happens
    function planarOutcomes(
      body,
      sides,
      { levels, scales: row, allowed },
      stands,
      factorsOf,
    ) {
      const every = (values) =>
        values.constructor.from(
          { length: sides.length * levels.length },
          (_, i) => values[i % levels.length],
        );
      const counts = every(
        Uint8Array.from(allowed, (may, k) => (may && stands[k] ? 1 : 0)),
      );
      const scales = factorsOf({ levels, scales: every(row), allowed: counts }, sides);
      const counted = ensemble.count(ensemble.bodyOf(body), sides, scales);
      const joined = {};
      for (const name of ["overturned", "rocked"])
        joined[name] = Uint8Array.from(levels, (_, k) =>
          Math.max(...sides.map((_, i) => counted[name][i * levels.length + k])),
        );
      return joined;
    }
  }
  return {
    planOf,
    counter,
    pairOf,
    recordOf,
    solidOf,
    change,
    isSo,
    rowOf,
    peakOf,
    liftingInSpace,
    fewer: both.fewer,
  };
};
if (typeof module !== "undefined") module.exports = inSpace;
