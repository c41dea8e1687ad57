/* The velocity that the given measure leaves open, as rockfrag.assess.conversion and rockfrag.fragility.vector have it. */
const conversion = (data) => {
  "use strict";
  const { fitProbit, inverted, dot, times, logNdtr, studentTail, LOG_ROOT_TWO_PI } = statistics;
  const { MOST_LEVELS, OF_DISPLACEMENT, INTERACTION_LEVEL, FOLDS, WORST_SCORE } = data.constants;
  const ones = (rows) => rows.map(() => 1);

  function fitted(design, fell) {
    const plain = fitProbit(design, fell, ones(fell), { tolerance: 1e-11 });
    // a plane that parts what fell from what stood leaves no maximum
    const apart = !plain?.converged || design.every((x, r) => (fell[r] ? 1 : -1) * dot(plain.coefficients, x) >= 0);
    const fit = apart ? fitProbit(design, fell, ones(fell), { penalised: true, tolerance: 1e-11 }) : plain;
    return fit && { coefficients: fit.coefficients, apart };
  }

  // p value of the last column, by a score test over earthquakes
  function interactionP(c, design, fell, group) {
    const others = design.map((x) => x.slice(0, 3)), last = design.map((x) => x[3]);
    const matrix = [0, 1, 2].map(() => [0, 0, 0]), side = [0, 0, 0];
    const terms = others.map((x, r) => {
      const eta = Math.max(-8, Math.min(8, dot(c, x)));
      const density = Math.exp(-0.5 * eta * eta - LOG_ROOT_TWO_PI), p = Math.exp(logNdtr(eta)), variance = p * Math.exp(logNdtr(-eta));
      const weight = (density * density) / variance;
      for (let i = 0; i < 3; i++) {
        side[i] += weight * x[i] * last[r];
        for (let j = 0; j < 3; j++) matrix[i][j] += weight * x[i] * x[j];
      }
      return { density, p, variance };
    });
    const explained = times(inverted(matrix).inverse, side), sums = new Map();
    terms.forEach(({ density, p, variance }, r) => {
      const left = last[r] - dot(explained, others[r]);
      sums.set(group[r], (sums.get(group[r]) ?? 0) + (left * (fell[r] - p) * density) / variance);
    });
    const scores = [...sums.values()], n = scores.length, total = scores.reduce((a, b) => a + b, 0);
    if (n < 3) return NaN;
    const spread = Math.sqrt((n * scores.reduce((sum, s) => sum + (s - total / n) ** 2, 0)) / (n - 1));
    return spread === 0 ? NaN : 2 * studentTail(Math.abs(total) / spread, n - 1);
  }

  // log score of earthquakes held out in turn, fitted from the coefficients of all
  function heldOut(design, fell, group, start) {
    const order = [...new Set(group)], fold = group.map((name) => order.indexOf(name) % FOLDS);
    let score = 0;
    for (let out = 0; out < Math.min(FOLDS, order.length); out++) {
      const fit = fitProbit(design, fell.map((y, r) => (fold[r] === out ? 0 : y)), fold.map((own) => (own === out ? 0 : 1)), {
        penalised: true, tolerance: 1e-6, start,
      });
      design.forEach((x, r) => {
        if (fold[r] !== out) return;
        const eta = fit ? dot(fit.coefficients, x) : 0;
        score += Math.max(logNdtr(fell[r] ? eta : -eta), WORST_SCORE);
      });
    }
    return score;
  }

  // standard deviation of ln level by which the site's velocity may differ from that of the motions; null where no fit is
  return function shiftOf(outcomes, { logs, median, spread }) {
    const { levels, allowed, overturned } = outcomes, step = Math.ceil(levels.length / MOST_LEVELS);
    const design = [], fell = [], group = [];
    for (let m = 0; m < logs.length; m++) {
      for (let k = 0; k < levels.length; k += step) {
        if (!allowed[m * levels.length + k]) continue;
        design.push([1, Math.log(levels[k]), logs[m]]);
        fell.push(overturned[m * levels.length + k]);
        group.push(data.earthquakes[m]);
      }
    }
    if (Math.min(...fell) === Math.max(...fell)) return null;
    const plain = fitted(design, fell);
    if (!plain) return null;
    let c = plain.coefficients;
    if (!plain.apart) {
      const crossed = design.map((x) => [...x, x[1] * x[2]]);
      if (interactionP(c, crossed, fell, group) < INTERACTION_LEVEL) {
        const full = fitted(crossed, fell);
        if (full && !full.apart && heldOut(crossed, fell, group, full.coefficients) > heldOut(design, fell, group, c)) c = full.coefficients;
      }
    }
    const product = c[3] ?? 0, slope = c[1] + product * median;
    if (!(slope > 0)) return null;
    const log = (-c[0] - c[2] * median) / slope;
    const weight = Math.max(0, Math.min(OF_DISPLACEMENT, (c[2] + product * log) / slope));
    return { shift: weight * spread, weight };
  };
};
if (typeof module !== "undefined") module.exports = conversion;
