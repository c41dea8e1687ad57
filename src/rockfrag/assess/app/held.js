/* Wax or putty under an object, tried live: until a pad is torn off the object moves
 * with the ground, then it is free.
 *
 * The core finds the sample from which on equation 3 of docs/holding.md is broken; what
 * follows is the free object, shaken from there on by what is left of the motion.
 */
const puttied = (core, rowOf) => {
  "use strict";
  // accelerations over which the left and the right pads of an object are torn off,
  // those of a pull of all pads [N]
  const breaksFrom = (block, pull) =>
    core.within(() => {
      const limits = core.zeros([2]);
      core.call("tell_pads", rowOf(block), pull, limits);
      return [...limits.values];
    });
  // the first sample that tears a pad off, at each factor on a motion
  const tornAt = (samples, scales, limits) =>
    core.within(() => {
      const first = core.zeros([scales.length], BigInt64Array);
      core.call(
        "fill_torn",
        core.put(samples),
        core.put(scales),
        core.put(limits),
        first,
      );
      return Array.from(first.values, Number);
    });

  // as ensemble.count: outcomes of a body under motions at factors, shape (motions,
  // scales)
  function count(ensemble, body, limits, motions, scales) {
    const each = scales.length / motions.length;
    const left = [];
    motions.forEach(({ samples, dt }, m) => {
      const own = scales.subarray(m * each, (m + 1) * each);
      tornAt(samples, own, limits).forEach((first, k) => {
        if (first < 0) return;
        const motion = { samples: samples.subarray(first), dt };
        left.push({ at: m * each + k, scale: own[k], motion });
      });
    });
    const overturned = new Uint8Array(scales.length);
    const rocked = new Uint8Array(scales.length);
    if (!left.length) return { overturned, rocked };
    const found = ensemble.count(
      body,
      left.map(({ motion }) => motion),
      Float64Array.from(left, ({ scale }) => scale),
    );
    left.forEach(({ at }, i) => {
      overturned[at] = found.overturned[i];
      rocked[at] = found.rocked[i];
    });
    return { overturned, rocked };
  }
  return { breaksFrom, count };
};
if (typeof module !== "undefined") module.exports = puttied;
