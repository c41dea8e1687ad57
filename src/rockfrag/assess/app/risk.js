/* From outcomes to shares, probabilities and their intervals, as rockfrag.assess.risk and its like have them. */
const risk = (data) => {
  "use strict";
  const { FLANK_Z, LEVEL, NONE_BELOW, LEAST_SPAN, EC8_SLOPE, EC8_SLOPE_SD } = data.constants;
  const drawn = core(data);

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

  const { parts, predict, liftsFrom, meansBySet, mean, variance } = drawn;
  const same = (value) => value;
  // `of` turns levels and the shares at each into a number, `shown` that into the one that is shown
  function riskTarget(curve, years) {
    let known = null, rates = [];
    const of = (levels, shares) => {
      if (known !== levels) {
        known = levels;
        rates = levels.map((_, k) => topplingRate(levels, levels.map((_, i) => Number(i === k)), curve, 0));
      }
      return shares.reduce((sum, share, k) => sum + share * rates[k], 0);
    };
    const scale = (values) => values.map((value) => Math.log(Math.max(value, 1e-3 * mean(values), 1e-300)));
    return { kind: "rate", of, scale, shown: (value) => probabilityIn(value, years), state: "overturned", noneBelow: -Infinity };
  }
  const fractionTarget = (level, state = "overturned") => ({
    kind: "fraction", level, of: (levels, shares) => interpolated(0, levels.map((each) => Math.log(each / level)), shares),
    scale: same, shown: same, state, noneBelow: NONE_BELOW,
  });
  const amplitudeTarget = (part) => ({
    kind: "level",
    of: (levels, shares) => {
      const i = shares.findIndex((share) => share >= part);
      if (i < 0) return Infinity;
      if (i === 0) return levels[0];
      const x = levels.map(Math.log), along = (part - shares[i - 1]) / (shares[i] - shares[i - 1]);
      return Math.exp(x[i - 1] + along * (x[i] - x[i - 1]));
    },
    scale: (values) => values.map(Math.log), shown: same, state: "overturned", noneBelow: -Infinity,
  });
  // earthquakes of the motions that were tried
  const groupsOf = ({ motions }) => [...new Set(motions ? motions.map((m) => data.earthquakes[m]) : data.earthquakes)];
  // of shares as counted
  const valueOf = (target, outcomes) => target.shown(target.of(outcomes.levels, fractions(outcomes, target.state)));

  // ---- what is not known

  const afterUplift = (name, spread) => [name, 0, spread];
  // what a property moves at its standard deviation, by outcomes with it on both sides
  function shiftOf(name, lower, upper) {
    const [low, high] = [lower, upper].map((side) => {
      const known = liftsFrom(side).filter(Number.isFinite);
      return known.length ? mean(known.map(Math.log)) : 0;
    });
    const lifts = (high - low) / 2, { levels } = lower, [below, above] = [lower, upper].map((side) => fractions(side));
    const middle = below.map((share, k) => (share + above[k]) / 2), span = Math.max(...middle) - middle[0];
    if (span < LEAST_SPAN) return [name, lifts, lifts];
    let area = 0;
    for (let k = 0; k + 1 < levels.length; k++) area += (Math.log(levels[k + 1] / levels[k]) * (below[k] - above[k] + below[k + 1] - above[k + 1])) / 2;
    return [name, lifts, area / 2 / span];
  }

  // ---- intervals

  const all = groupsOf({}), groups = all.length;
  const rowOf = (values, d, size) => Array.from(values.subarray(d * size, (d + 1) * size));
  // the number in each draw, before it is shown; `rates`: standard deviations of ln rate by source
  function drawnValues(target, prediction, rates) {
    const { levels, draws } = prediction, table = target.state === "rocked" ? prediction.rocking : prediction.toppling;
    const at = target.kind === "fraction" ? levels.indexOf(target.level) : -1;
    const values = new Float64Array(draws);
    for (let d = 0; d < draws; d++) values[d] = at < 0 ? target.of(levels, rowOf(table, d, levels.length)) : table[d * levels.length + at];
    if (target.kind === "rate") for (const [name, spread] of Object.entries(rates)) {
      const source = drawn.sourceOf(prediction, name);
      for (let d = 0; d < draws; d++) values[d] *= Math.exp(spread * source[d] - spread ** 2 / 2);
    }
    return values;
  }
  function middleOf(target, prediction, values) {
    if (target.kind === "level") return [...values].sort((a, b) => a - b)[Math.floor(0.5 * (values.length - 1))];
    const { levels, draws } = prediction, table = target.state === "rocked" ? prediction.rocking : prediction.toppling;
    const means = levels.map((_, k) => {
      let sum = 0;
      for (let d = 0; d < draws; d++) sum += table[d * levels.length + k];
      return sum / draws;
    });
    return target.shown(target.of(levels, means));
  }
  function estimate(target, prediction, rates) {
    const values = drawnValues(target, prediction, rates), shown = values.map(target.shown), value = middleOf(target, prediction, values);
    const ordered = Float64Array.from(shown).sort(), aside = Math.trunc(((1 - LEVEL) / 2) * ordered.length);
    let lower = ordered[aside], upper = ordered[ordered.length - 1 - aside];
    if (groups < 2 && target.kind !== "level") [lower, upper] = [0, 1];
    if (lower < target.noneBelow) lower = 0;
    if (upper > 1 - target.noneBelow) upper = 1;
    const last = prediction.levels.at(-1), scaled = target.scale(target.kind === "level" ? values.map((each) => Math.min(each, last)) : values);
    const spread = Math.sqrt(variance(scaled));
    const sources = Object.fromEntries(Object.entries(parts(prediction, scaled)).map(([name, part]) => [name, spread * Math.sqrt(part)]));
    return { value, lower: Math.min(lower, value), upper: Math.max(upper, value), sources, draws: values };
  }
  // what to do by a probability; of one in some years by its rate, of which means are taken
  function decision(target, prediction, { value, draws }, accepted, years) {
    const rate = (p) => (target.kind === "rate" ? -Math.log1p(-Math.min(p, 1 - 1e-15)) / years : p);
    return drawn.decide(prediction, rate(value), draws, data.measurements, rate(accepted));
  }
  // standard deviation of ln rate that the quantiles of a hazard stand for
  function ofQuantiles(outcomes, curve) {
    const known = curve.quantiles.map((each) => [each.z, Math.log(topplingRate(outcomes.levels, fractions(outcomes), each, 0))])
      .filter(([, value]) => Number.isFinite(value)).sort((a, b) => a[0] - b[0]);
    if (known.length < 2) return {};
    return { hazard: Math.abs(known.at(-1)[1] - known[0][1]) / (known.at(-1)[0] - known[0][0]) };
  }

  // numpy's quantile
  function quantileOf(values, part) {
    const ordered = [...values].sort((a, b) => a - b), at = part * (ordered.length - 1), low = Math.floor(at);
    return ordered[low] + (at - low) * ((ordered[low + 1] ?? ordered[low]) - ordered[low]);
  }
  function comparedBy(target, shifts, rates, outcomes) {
    const prediction = predict(outcomes, shifts, true), values = drawnValues(target, prediction, rates).map(target.shown);
    return [mean(values), meansBySet(values, prediction.members)];
  }
  function meanOf(target, shifts, rates, outcomes) {
    const prediction = predict(outcomes, shifts);
    return middleOf(target, prediction, target.kind === "level" ? drawnValues(target, prediction, rates) : null);
  }
  // what changes do with the same errors, with limits of the factor over the earthquakes
  function compared(target, shifts, rates, now) {
    const [before, bySet] = comparedBy(target, shifts, rates, now);
    return (changed) => {
      const [after, withIt] = comparedBy(target, shifts, rates, changed);
      const found = { value: after, factor: NaN, lower: NaN, upper: NaN, helps: after < before, shown: false };
      if (!(before > 0)) return found;
      const factor = after / before, ratios = withIt.map((each, i) => each / bySet[i]).filter((_, i) => bySet[i] > 0);
      const [low, high] = [(1 - LEVEL) / 2, (1 + LEVEL) / 2].map((end) => quantileOf(ratios, end));
      const upper = Math.max(high, factor);
      return { ...found, factor, lower: Math.min(low, factor), upper, shown: upper < 1 };
    };
  }

  return {
    fractions, curveOf, curveOfOneLevel, rateOf, levelOf, probabilityIn, riskTarget, fractionTarget, amplitudeTarget, valueOf,
    liftsFrom, estimate, meanOf, shiftOf, afterUplift, predict, decision, ofQuantiles, compared, groups,
  };
};
if (typeof module !== "undefined") module.exports = risk;
