/* Wax or putty under an object, tried live: until a pad is torn off the object moves
 * with the ground, then it is free.
 *
 * The instant is that at which equation 3 of docs/holding.md is first broken, to a
 * sample; what follows is the free object, shaken from there on by what is left of the
 * motion.
 */
const puttied = (constants) => {
  "use strict";
  const { PADS_AT, GRAVITY } = constants;
  // accelerations over which the left and the right pads of an object are torn off,
  // those of a pull of all pads [N]
  function breaksFrom({ width, height, mass, cgHeight = null, cgOffset = 0 }, pull) {
    const half = (PADS_AT * width) / 2;
    const high = cgHeight ?? height / 2;
    return [half - cgOffset, half + cgOffset].map(
      (arm) => (GRAVITY * arm + (pull * half) / mass) / high,
    );
  }
  // which pad a motion tears off first is not asked: the sample from which on one is,
  // -1 if none is ever
  const breaksAt = (samples, scale, [left, right]) =>
    samples.findIndex((a) => scale * a > left || -scale * a > right);

  // as ensemble.count: outcomes of a body under motions at factors, shape (motions,
  // scales)
  function count(ensemble, body, limits, motions, scales) {
    const each = scales.length / motions.length;
    const left = [];
    scales.forEach((scale, at) => {
      const { samples, dt } = motions[Math.floor(at / each)];
      const first = breaksAt(samples, scale, limits);
      if (first >= 0)
        left.push({ at, scale, motion: { samples: samples.subarray(first), dt } });
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
      [overturned[at], rocked[at]] = [found.overturned[i], found.rocked[i]];
    });
    return { overturned, rocked };
  }
  return { breaksFrom, count };
};
if (typeof module !== "undefined") module.exports = puttied;
