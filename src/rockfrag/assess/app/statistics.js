/* Distributions and the probit regression, as scipy and rockfrag.fragility.batch_glm have them (held equal by tests). */
const statistics = (() => {
  "use strict";
  const ROOT_TWO = Math.SQRT2, LOG_ROOT_TWO_PI = 0.5 * Math.log(2 * Math.PI);
  const polynomial = (coefficients, x) => {
    let sum = 0;
    for (const c of coefficients) sum = sum * x + c;
    return sum;
  };

  // exp(x²) erfc(x) for x ≥ 0 (Cody 1969, Math. Comp. 23: 631)
  const MIDDLE = [2.15311535474403846e-8, 0.564188496988670089, 8.88314979438837594, 66.1191906371416295,
    298.635138197400131, 881.95222124176909, 1712.04761263407058, 2051.07837782607147, 1230.33935479799725];
  const MIDDLE_BELOW = [1, 15.7449261107098347, 117.693950891312499, 537.181101862009858, 1621.38957456669019,
    3290.79923573345963, 4362.61909014324716, 3439.36767414372164, 1230.33935480374942];
  const FAR = [0.0163153871373020978, 0.305326634961232344, 0.360344899949804439, 0.125781726111229246,
    0.0160837851487422766, 6.58749161529837803e-4];
  const FAR_BELOW = [1, 2.56852019228982242, 1.87295284992346725, 0.527905102951428412, 0.0605183413124413191,
    0.00233520497626869185];
  const SMALL = [0.185777706184603153, 3.1611237438705656, 113.864154151050156, 377.485237685302021, 3209.37758913846947];
  const SMALL_BELOW = [1, 23.6012909523441209, 244.024637934444173, 1282.61652607737228, 2844.23683343917062];
  function scaledErfc(x) {
    if (x <= 0.46875) return Math.exp(x * x) * (1 - smallErf(x));
    if (x <= 4) return polynomial(MIDDLE, x) / polynomial(MIDDLE_BELOW, x);
    const y = 1 / (x * x), r = (y * polynomial(FAR, y)) / polynomial(FAR_BELOW, y);
    return (1 / Math.sqrt(Math.PI) - r) / x;
  }
  const smallErf = (x) => (x * polynomial(SMALL, x * x)) / polynomial(SMALL_BELOW, x * x);
  // ln Φ(x)
  function logNdtr(x) {
    const z = Math.abs(x) / ROOT_TWO;
    if (z <= 0.46875) return Math.log(0.5 * (1 + smallErf(x / ROOT_TWO)));
    const tail = 0.5 * scaledErfc(z) * Math.exp(-z * z);
    return x > 0 ? Math.log1p(-tail) : Math.log(0.5 * scaledErfc(z)) - z * z;
  }

  // ln Γ (Lanczos, g = 607/128)
  function logGamma(x) {
    const c = [57.156235665862923517, -59.597960355475491248, 14.136097974741747174, -0.49191381609762019978,
      0.33994649984811888699e-4, 0.46523628927048575665e-4, -0.98374475304879564677e-4, 0.15808870322491248884e-3,
      -0.21026444172410488319e-3, 0.2174396181152126432e-3, -0.16431810653676389022e-3, 0.84418223983852743293e-4,
      -0.2619083840158140867e-4, 0.36899182659531622704e-5];
    const t = x + 5.2421875;
    const sum = c.reduce((total, each, i) => total + each / (x + 1 + i), 0.999999999999997092);
    return (x + 0.5) * Math.log(t) - t + Math.log((2.5066282746310005 * sum) / x);
  }
  // P(T > t) of Student's t, t ≥ 0, by the continued fraction of the incomplete beta function
  function studentTail(t, freedom) {
    const a = freedom / 2, b = 0.5, x = freedom / (freedom + t * t), rest = (t * t) / (freedom + t * t);
    // ln (ν/(ν+t²)) without rounding where ν is large
    const front = Math.exp(logBeta(a) - a * Math.log1p((t * t) / freedom) + b * Math.log(rest));
    return x < (a + 1) / (a + b + 2) ? (0.5 * front * fraction(a, b, x)) / a : 0.5 - (0.5 * front * fraction(b, a, rest)) / b;
  }
  // -ln B(a, 1/2); of large a by its series, where the difference of ln Γ would round
  function logBeta(a) {
    if (a < 1e4) return logGamma(a + 0.5) - logGamma(a) - logGamma(0.5);
    return 0.5 * Math.log(a) - 1 / (8 * a) + 1 / (192 * a ** 3) - 0.5 * Math.log(Math.PI);
  }
  function fraction(a, b, x) {
    const tiny = 1e-300;
    let c = 1, d = 1 / (Math.abs(1 - ((a + b) * x) / (a + 1)) < tiny ? tiny : 1 - ((a + b) * x) / (a + 1)), h = d;
    for (let m = 1; m < 10000; m++) {
      for (const step of [(m * (b - m) * x) / ((a + 2 * m - 1) * (a + 2 * m)), (-(a + m) * (a + b + m) * x) / ((a + 2 * m) * (a + 2 * m + 1))]) {
        d = 1 / (Math.abs(1 + step * d) < tiny ? tiny : 1 + step * d);
        c = Math.abs(1 + step / c) < tiny ? tiny : 1 + step / c;
        h *= c * d;
      }
      if (Math.abs(c * d - 1) < 1e-16) break;
    }
    return h;
  }
  // t that Student's t exceeds with a probability below 1/2
  function studentQuantile(tail, freedom) {
    let low = 0, high = 1;
    while (studentTail(high, freedom) > tail) high *= 2;
    for (let i = 0; i < 200 && high - low > 4e-16 * high; i++) {
      const middle = (low + high) / 2;
      if (studentTail(middle, freedom) > tail) low = middle;
      else high = middle;
    }
    return (low + high) / 2;
  }

  // ---- symmetric matrices of a few rows

  // inverse and logarithm of the determinant (Cholesky); null where it is not positive
  function inverted(matrix) {
    const k = matrix.length, l = matrix.map((row) => row.slice());
    let log = 0;
    for (let i = 0; i < k; i++) {
      for (let j = 0; j <= i; j++) {
        let sum = matrix[i][j];
        for (let n = 0; n < j; n++) sum -= l[i][n] * l[j][n];
        if (i === j && !(sum > 1e-14 * matrix[i][i])) return null;
        l[i][j] = i === j ? Math.sqrt(sum) : sum / l[j][j];
      }
      log += 2 * Math.log(l[i][i]);
    }
    const inverse = matrix.map(() => new Array(k));
    for (let column = 0; column < k; column++) {
      const x = new Array(k);
      for (let i = 0; i < k; i++) {
        x[i] = i === column ? 1 : 0;
        for (let j = 0; j < i; j++) x[i] -= l[i][j] * x[j];
        x[i] /= l[i][i];
      }
      for (let i = k - 1; i >= 0; i--) {
        for (let j = i + 1; j < k; j++) x[i] -= l[j][i] * x[j];
        x[i] /= l[i][i];
      }
      x.forEach((value, i) => { inverse[i][column] = value; });
    }
    return { inverse, log };
  }
  const dot = (a, b) => {
    let sum = 0;
    for (let i = 0; i < a.length; i++) sum += a[i] * b[i];
    return sum;
  };
  const times = (matrix, vector) => matrix.map((row) => dot(row, vector));

  // coefficients of a probit regression by Fisher scoring; `fell` of `trials` a row; null where it has none
  function fitProbit(design, fell, trials, { penalised = false, tolerance = 1e-9, start = null } = {}) {
    const k = design[0].length;
    let c = start ?? new Array(k).fill(0), step = new Array(k).fill(0), best = -Infinity;
    for (let pass = 0; pass < 100; pass++) {
      const trial = c.map((value, i) => value + step[i]);
      const fisher = trial.map(() => new Array(k).fill(0)), terms = new Float64Array(4 * design.length);
      let goal = 0;
      for (let r = 0, at = 0; r < design.length; r++, at += 4) {
        const x = design[r], eta = Math.max(-30, Math.min(30, dot(x, trial)));
        const p = logNdtr(eta), q = logNdtr(-eta), density = -0.5 * eta * eta - LOG_ROOT_TWO_PI;
        const weight = trials[r] * Math.exp(2 * density - p - q);
        for (let i = 0; i < k; i++) for (let j = 0; j < k; j++) fisher[i][j] += weight * x[i] * x[j];
        goal += fell[r] * p + (trials[r] - fell[r]) * q;
        terms[at] = eta;
        terms[at + 1] = Math.exp(density - p);
        terms[at + 2] = Math.exp(density - q);
        terms[at + 3] = weight;
      }
      const found = inverted(fisher);
      if (!found) return null;
      if (penalised) goal += 0.5 * found.log;
      const size = Math.max(...step.map(Math.abs));
      if (goal < best - 1e-10) {
        if (size < 1e-14) return { coefficients: c, converged: false };
        step = step.map((value) => value / 2);
        continue;
      }
      const settled = size < tolerance && best > -Infinity;
      c = trial;
      best = goal;
      if (settled) return { coefficients: c, converged: true };
      const score = new Array(k).fill(0);
      for (let r = 0; r < design.length; r++) {
        const x = design[r], eta = terms[4 * r], up = terms[4 * r + 1], down = terms[4 * r + 2], weight = terms[4 * r + 3];
        let value = fell[r] * up - (trials[r] - fell[r]) * down;
        if (penalised) value += 0.5 * weight * dot(x, times(found.inverse, x)) * (-2 * eta - up + down);
        for (let i = 0; i < k; i++) score[i] += value * x[i];
      }
      step = times(found.inverse, score);
    }
    return { coefficients: c, converged: false };
  }

  return { logNdtr, studentTail, studentQuantile, fitProbit, inverted, dot, times, LOG_ROOT_TWO_PI };
})();
if (typeof module !== "undefined") module.exports = statistics;
