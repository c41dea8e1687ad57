/* Floors of an elastic building, as rockfrag.building has them: modes, and oscillators solved exactly. */
const building = (() => {
  "use strict";

  // eigenvalues, rising, and vectors of a symmetric matrix (Jacobi's rotations)
  function eigen(matrix) {
    const n = matrix.length, a = matrix.map((row) => row.slice()), v = a.map((_, i) => a.map((__, j) => (i === j ? 1 : 0)));
    for (let sweep = 0; sweep < 100; sweep++) {
      let largest = 0;
      for (let p = 0; p < n; p++) {
        for (let q = p + 1; q < n; q++) {
          const small = 1e-17 * Math.sqrt(Math.abs(a[p][p] * a[q][q]));
          if (Math.abs(a[p][q]) <= small) continue;
          largest = Math.max(largest, Math.abs(a[p][q]));
          const theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
          const t = (theta >= 0 ? 1 : -1) / (Math.abs(theta) + Math.hypot(1, theta)), c = 1 / Math.hypot(1, t), s = t * c;
          for (let k = 0; k < n; k++) [a[k][p], a[k][q]] = [c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]];
          for (let k = 0; k < n; k++) [a[p][k], a[q][k]] = [c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]];
          for (let k = 0; k < n; k++) [v[k][p], v[k][q]] = [c * v[k][p] - s * v[k][q], s * v[k][p] + c * v[k][q]];
        }
      }
      if (largest === 0) break;
    }
    const order = a.map((_, i) => i).sort((i, j) => a[i][i] - a[j][j]);
    return order.map((i) => ({ value: a[i][i], vector: v.map((row) => row[i]) }));
  }
  const chain = (k) => k.map((_, i) => k.map((__, j) =>
    i === j ? k[i] + (k[i + 1] ?? 0) : Math.abs(i - j) === 1 ? -k[Math.max(i, j)] : 0));
  function modesOf(masses, stiffnesses) {
    const root = masses.map((m) => 1 / Math.sqrt(m));
    return eigen(chain(stiffnesses).map((row, i) => row.map((value, j) => root[i] * value * root[j]))).map(({ value, vector }) => {
      const top = root.at(-1) * vector.at(-1), shape = vector.map((x, i) => (root[i] * x) / top);
      const modal = shape.reduce((sum, x, i) => sum + masses[i] * x * x, 0), excited = shape.reduce((sum, x, i) => sum + masses[i] * x, 0);
      return { omega: Math.sqrt(value), fractions: shape.map((x) => (excited / modal) * x) };
    });
  }
  function stiffnessesFor(masses, heights, period) {
    const shape = heights.map((height) => 1 / height), first = modesOf(masses, shape)[0].omega ** 2;
    return shape.map((k) => ((2 * Math.PI) / period) ** 2 / first * k);
  }

  // (u, u', a, s) → (u, u') one step later (Nigam and Jennings 1969), damping below critical
  function propagator(omega, damping, step) {
    const rate = damping * omega, turn = omega * Math.sqrt(1 - damping ** 2), decay = Math.exp(-rate * step), square = omega ** 2;
    const cosine = decay * Math.cos(turn * step), sine = (decay * Math.sin(turn * step)) / turn;
    const free = [[cosine + rate * sine, sine], [-square * sine, cosine - rate * sine]];
    const before = [[-1 / square, (2 * damping) / omega / square], [0, -1 / square]];
    const after = [[before[0][0], before[0][1] - step / square], before[1]];
    return free.map((row, i) => [...row, ...[0, 1].map((j) => after[i][j] - (row[0] * before[0][j] + row[1] * before[1][j]))]);
  }

  // acceleration of a floor under that of the ground; `modes` as the package has them, or those of masses and stiffnesses
  function floorMotion({ modes, masses, stiffnesses, damping, level }, { samples, dt }) {
    const found = new Float64Array(samples.length);
    const each = modes ?? modesOf(masses, stiffnesses).map(({ omega, fractions }) => (
      { fractions, damper: 2 * damping * omega, spring: omega ** 2, steps: { [dt]: propagator(omega, damping, dt) } }));
    for (const { fractions, damper, spring, steps } of each) {
      const [[a, b, c, d], [e, f, g, h]] = steps[dt], part = fractions[level - 1];
      let u = 0, v = 0;
      for (let i = 0; i < samples.length; i++) {
        found[i] += part * -(damper * v + spring * u);
        const here = samples[i], s = (samples[i + 1] - here) / dt;
        [u, v] = [a * u + b * v + c * here + d * s, e * u + f * v + g * here + h * s];
      }
    }
    return { samples: found, dt };
  }
  return { modesOf, stiffnessesFor, floorMotion };
})();
if (typeof module !== "undefined") module.exports = building;
