/* From outcomes to shares, probabilities and their intervals, as rockfrag.assess.risk and its like have them. */
const risk = (data) => {
  "use strict";
  const { HALF, Z, FLANK_Z, LEVEL, LEAST_CHANCE, EC8_SLOPE, EC8_SLOPE_SD } = data.constants;
  const hypot = (values) => Math.sqrt(values.reduce((sum, value) => sum + value * value, 0));
  const logit = (p) => Math.log(p / (1 - p));
  const expit = (x) => 1 / (1 + Math.exp(-x));

  // numpy's interp, flat beyond the ends
  function interpolated(x, xs, ys) {
    if (x <= xs[0]) return ys[0];
    if (x >= xs.at(-1)) return ys.at(-1);
    let j = 0;
    while (xs[j + 1] <= x) j++;
    return ((ys[j + 1] - ys[j]) / (xs[j + 1] - xs[j])) * (x - xs[j]) + ys[j];
  }

  // fraction of the motions in a state ("overturned", "rocked") at each level; `without` leaves out an earthquake
  function fractions(outcomes, state = "overturned", without = -1) {
    const { levels, allowed } = outcomes, happened = outcomes[state], found = [];
    for (let k = 0, last = 0; k < levels.length; k++) {
      let total = 0, some = 0;
      for (let m = 0; m < data.earthquakes.length; m++) {
        const at = m * levels.length + k;
        if (data.earthquakes[m] === without || !allowed[at]) continue;
        total += 1;
        some += happened[at];
      }
      if (total > 0) last = some / total;
      found.push(last);
    }
    return found;
  }

  // ---- hazard: a power law between points

  const curveOf = (levels, rates, quantiles = []) => ({ levels, rates, quantiles });
  function curveOfOneLevel(level, years) {
    const curve = (k) => curveOf([0.1, 1, 10].map((f) => level * f), [0.1, 1, 10].map((f) => f ** -k / years));
    const flanks = [[-FLANK_Z, EC8_SLOPE + EC8_SLOPE_SD], [FLANK_Z, EC8_SLOPE - EC8_SLOPE_SD]];
    return { ...curve(EC8_SLOPE), quantiles: flanks.map(([z, k]) => ({ z, ...curve(k) })) };
  }
  const slope = ({ levels, rates }, i) => Math.log(rates[i + 1] / rates[i]) / Math.log(levels[i + 1] / levels[i]);
  function rateOf(curve, level) {
    let i = 0;
    while (i < curve.levels.length - 2 && curve.levels[i + 1] < level) i++;
    return curve.rates[i] * Math.exp(slope(curve, i) * Math.log(level / curve.levels[i]));
  }
  function levelOf(curve, rate) {
    let i = 0;
    while (i < curve.rates.length - 2 && curve.rates[i + 1] > rate) i++;
    return curve.levels[i] * Math.exp(Math.log(rate / curve.rates[i]) / slope(curve, i));
  }
  function topplingRate(levels, shares, curve, shift) {
    const x = levels.map((level) => Math.log(level) + shift);
    const knots = curve.levels.map(Math.log).filter((knot) => knot > x[0] && knot < x.at(-1));
    const ends = [...new Set([...x, ...knots])].sort((a, b) => a - b);
    const share = ends.map((end) => interpolated(end, x, shares));
    const rate = ends.map((end) => rateOf(curve, Math.exp(end)));
    let sum = share.at(-1) * rate.at(-1);
    for (let i = 0; i + 1 < ends.length; i++) {
      const width = ends[i + 1] - ends[i], fall = -Math.log(rate[i + 1] / rate[i]) / width;
      sum += share[i] * rate[i] - share[i + 1] * rate[i + 1]
        + (((share[i + 1] - share[i]) / width) * (rate[i] - rate[i + 1])) / fall;
    }
    return sum;
  }
  const probabilityIn = (rate, years) => -Math.expm1(-years * rate);

  // ---- what is estimated

  const riskTarget = (curve, years) => ({
    of: (levels, shares, shift) => topplingRate(levels, shares, curve, shift),
    forward: (value) => (value > 0 ? Math.log(value) : -Infinity),
    back: (value) => probabilityIn(Math.exp(value), years),
    state: "overturned", added: 0, certain: 1,
  });
  const fractionTarget = (level, state = "overturned") => ({
    of: (levels, shares, shift) => interpolated(Math.log(level) - shift, levels.map(Math.log), shares),
    forward: logit, back: expit, state, added: HALF, certain: 1,
  });
  const amplitudeTarget = (part) => ({
    of: (levels, shares, shift) => {
      const i = shares.findIndex((share) => share >= part);
      if (i < 0) return Infinity;
      if (i === 0) return levels[0];
      const x = levels.map(Math.log), along = (part - shares[i - 1]) / (shares[i] - shares[i - 1]);
      return Math.exp(x[i - 1] + along * (x[i] - x[i - 1]) + shift);
    },
    forward: (value) => (value > 0 ? Math.log(value) : -Infinity),
    back: Math.exp, state: "overturned", added: 0, certain: Infinity,
  });
  // earthquakes of the motions that were tried
  const groupsOf = ({ motions }) => [...new Set(motions ? motions.map((m) => data.earthquakes[m]) : data.earthquakes)];
  function onScale(target, outcomes, { without = -1, shift = 0, added = 0 } = {}) {
    let shares = fractions(outcomes, target.state, without);
    if (added) {
      const count = groupsOf(outcomes).length - (without >= 0 ? 1 : 0), could = fractions(outcomes, "rocked", without);
      shares = shares.map((share, k) => (count * share + (could[k] > 0 ? added : 0)) / (count + 2 * added));
    }
    return target.forward(target.of(outcomes.levels, shares, shift));
  }
  const valueOf = (target, outcomes, without = -1) => target.back(onScale(target, outcomes, { without }));

  // ---- intervals

  const all = groupsOf({}), groups = all.length;
  function withoutEach(target, outcomes) {
    const found = all.map((without) => onScale(target, outcomes, { without, added: target.added }));
    return found.every(Number.isFinite) ? found : all.map((without) => onScale(target, outcomes, { without, added: HALF }));
  }
  function jackknife(values) {
    const n = values.length, mean = values.reduce((a, b) => a + b, 0) / n;
    if (n < 2 || !values.every(Number.isFinite)) return Infinity;
    return Math.sqrt(((n - 1) / n) * values.reduce((sum, value) => sum + (value - mean) ** 2, 0));
  }
  function halfWidth(low, high, middle) {
    const ends = [low, high].filter(Number.isFinite);
    if (ends.length === 2) return Math.abs(high - low) / 2;
    return ends.length ? Math.abs(ends[0] - middle) : 0;
  }
  const quantile = (freedom) => statistics.studentQuantile(0.5 - LEVEL / 2, freedom);

  // `moved`: [name, lower, upper] outcomes; `fixed` and `shifts`: standard deviations by name
  function estimate(target, outcomes, moved, fixed, shifts) {
    const middle = onScale(target, outcomes);
    if (!Number.isFinite(middle)) return bounded(target, outcomes, middle, moved, shifts);
    const near = (changed, shift = 0) => onScale(target, changed, { shift, added: target.added });
    const own = near(outcomes), sources = { motions: jackknife(withoutEach(target, outcomes)) };
    for (const [name, lower, upper] of moved) sources[name] = halfWidth(near(lower), near(upper), own);
    for (const [name, spread] of Object.entries(shifts))
      sources[name] = halfWidth(near(outcomes, -spread), near(outcomes, spread), own);
    Object.assign(sources, fixed);
    const total = hypot(Object.values(sources));
    const t = !Number.isFinite(total) || sources.motions === 0 ? Z : quantile((groups - 1) * (total / sources.motions) ** 4);
    const shift = t * hypot(Object.values(shifts));
    const ends = [-shift, shift].map((by) => onScale(target, outcomes, { shift: by })).sort((a, b) => a - b);
    const others = t * hypot(Object.keys(sources).filter((name) => !(name in shifts)).map((name) => sources[name]));
    const down = Math.max(0, middle - ends[0]), up = Math.max(0, ends[1] - middle);
    return {
      value: target.back(middle),
      lower: target.back(Math.min(middle, own) - Math.hypot(others, down)),
      upper: target.back(Math.max(middle, own) + Math.hypot(others, up)),
      sources,
    };
  }
  const hiddenPart = 1 - (1 - LEVEL) ** (1 / groups);
  function bounded(target, outcomes, middle, moved, shifts) {
    const shift = Z * hypot(Object.values(shifts));
    const most = (changed, by = 0) => {
      const rocks = fractions(changed, "rocked");
      const shares = fractions(changed, target.state).map((share, k) => (rocks[k] > 0 ? Math.max(share, hiddenPart) : 0));
      return target.of(changed.levels, shares, -by);
    };
    const least = (changed, by = 0) =>
      target.of(changed.levels, fractions(changed, target.state).map((share) => Math.min(share, 1 - hiddenPart)), by);
    const told = (value, lower, upper) => ({ value, lower, upper, sources: {} });
    if (target.certain === Infinity) return told(Infinity, Math.min(most(outcomes, shift), outcomes.levels.at(-1)), Infinity);
    if (middle > 0) return told(1, target.back(limit(target, least, outcomes, moved, shift, -1)), 1);
    return told(0, 0, target.back(limit(target, most, outcomes, moved, shift, 1)));
  }
  function limit(target, of, outcomes, moved, shift, sign) {
    const [bound, plain] = [shift, 0].map((by) => target.forward(of(outcomes, by)));
    const ends = moved.map(([, ...both]) => Math.max(...both.map((side) => sign * target.forward(of(side)))));
    if (!Number.isFinite(plain)) return sign * Math.max(sign * bound, ...ends);
    return bound + sign * Z * hypot(ends.map((end) => Math.max(0, end - sign * plain)));
  }
  function estimateRocking(level, outcomes, moved, exact) {
    const target = fractionTarget(level, "rocked");
    const found = estimate(target, outcomes, moved, {}, {});
    if (found.value > 0 && found.value < 1) return found;
    const sides = moved.flatMap(([, ...both]) => both.map((side) => valueOf(target, side)));
    const hidden = exact ? 0 : hiddenPart;
    if (found.value === 0) return { value: 0, lower: 0, upper: Math.max(hidden, ...sides), sources: {} };
    return { value: 1, lower: Math.min(1 - hidden, ...sides), upper: 1, sources: {} };
  }
  // standard deviation of ln rate that the quantiles of a hazard stand for
  function ofQuantiles(outcomes, curve) {
    const known = curve.quantiles.map((each) => [each.z, onScale(riskTarget(each, 1), outcomes)])
      .filter(([, value]) => Number.isFinite(value)).sort((a, b) => a[0] - b[0]);
    if (known.length < 2) return {};
    return { hazard: Math.abs(known.at(-1)[1] - known[0][1]) / (known.at(-1)[0] - known[0][0]) };
  }

  // what a change does, with limits of the factor by the same motions, and whether these show that it helps
  function compared(target, now, changed) {
    const before = valueOf(target, now), after = valueOf(target, changed), grows = target.certain === Infinity;
    const helps = grows ? after > before : after < before;
    const found = { value: after, factor: NaN, lower: NaN, upper: NaN, helps, shown: false };
    if (!(Number.isFinite(before) && before > 0 && Number.isFinite(after))) return found;
    found.factor = after / before;
    const shaken = groupsOf(now), pairs = shaken.map((without) => [valueOf(target, changed, without), valueOf(target, now, without)]);
    if (shaken.length > 1 && pairs.flat().every((value) => Number.isFinite(value) && value > 0)) {
      const half = quantile(shaken.length - 1) * jackknife(pairs.map(([a, b]) => Math.log(a / b)));
      Object.assign(found, { lower: found.factor * Math.exp(-half), upper: found.factor * Math.exp(half) });
    }
    found.shown = helps && (grows ? found.lower > 1 : found.upper < 1);
    // no motion is left; more than one earthquake must have had one
    if (found.factor === 0) found.shown = helps && shaken.length > 1 && pairs.every(([, without]) => without > 0);
    return found;
  }

  // what to do, as rockfrag.assess.decision has it
  function decide({ value, sources }, accepted) {
    const action = value > accepted ? "secure" : "leave", away = Math.abs(logit(value) - logit(accepted));
    if (!(value > 0 && value < 1)) return { action };
    for (const [source, left] of data.measurements) {
      const spread = (sources[source] ?? 0) * Math.sqrt(1 - left ** 2), chance = spread > 0 ? Math.exp(statistics.logNdtr(-away / spread)) : 0;
      if (chance >= LEAST_CHANCE) return { action: "measure", source, chance };
    }
    return { action };
  }

  return {
    fractions, curveOf, curveOfOneLevel, rateOf, levelOf, probabilityIn, riskTarget, fractionTarget, amplitudeTarget, valueOf,
    estimate, estimateRocking, ofQuantiles, compared, decide, groups,
  };
};
if (typeof module !== "undefined") module.exports = risk;
