/* All that is not known drawn at once, as rockfrag.assess.core has it: fractions under each draw, parts, decisions. */
const core = (data) => {
  "use strict";
  const { CLASSES, ROUNDING, LEAST_SPREAD, BINS, CENTRES, LEAST_CHANCE, MEMBERS, FEW_MEMBERS } = data.constants;
  const numbers = (text) => new Float64Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const { columns } = data.draws, normals = numbers(data.draws.normals);
  const weights = Object.fromEntries(Object.entries(data.draws.weights).map(([count, text]) => [count, numbers(text)]));
  const sum = (values) => values.reduce((total, value) => total + value, 0);
  const mean = (values) => sum(values) / values.length;
  function variance(values) {
    const middle = mean(values);
    return mean(values.map((value) => (value - middle) ** 2));
  }

  const motionsOf = ({ motions }) => motions ?? data.earthquakes.map((_, m) => m);
  // level at which each motion lifts the object; of what rocks no higher one
  function liftsFrom({ levels, allowed, rocked, overturned, lifting, motions }) {
    return motionsOf({ motions }).map((m) => {
      const first = levels.findIndex((_, k) => allowed[m * levels.length + k] && (rocked[m * levels.length + k] || overturned[m * levels.length + k]));
      return Math.min(first < 0 ? Infinity : levels[first], lifting[m]);
    });
  }

  // what motions do to the object, by earthquake, level and the level at which they lift it
  function countMotions(outcomes) {
    const { levels, allowed, overturned } = outcomes, motions = motionsOf(outcomes), size = levels.length;
    const names = [...new Set(motions.map((m) => data.earthquakes[m]))], count = names.length;
    const quake = motions.map((m) => names.indexOf(data.earthquakes[m])), logs = levels.map(Math.log);
    const nearest = levels.map((_, k) => k);
    for (let k = 0, last = 0; k < size; k++) nearest[k] = motions.some((m) => allowed[m * size + k]) ? (last = k) : last;
    const uplifts = liftsFrom(outcomes).map(Math.log), finite = uplifts.filter(Number.isFinite), classes = classesOf(finite);
    const width = classes.length + 1, place = uplifts.map((u) => classes.filter((each) => each <= u).length);
    const toppled = new Float64Array(count * size * width), shaken = new Float64Array(count * size), lifted = new Float64Array(count * width), each = new Float64Array(count);
    motions.forEach((m, i) => {
      each[quake[i]] += 1;
      if (Number.isFinite(uplifts[i])) lifted[quake[i] * width + place[i]] += 1;
      for (let k = 0; k < size; k++) {
        const at = m * size + nearest[k];
        if (!allowed[at]) continue;
        shaken[quake[i] * size + k] += 1;
        if (overturned[at] && Number.isFinite(uplifts[i])) toppled[(quake[i] * size + k) * width + place[i]] += 1;
      }
    });
    for (const table of [toppled, lifted]) for (let at = 0; at < table.length; at++) if (at % width) table[at] += table[at - 1];
    const fell = motions.filter((m) => levels.some((_, k) => allowed[m * size + k])).map((m) => {
      let last = 0;
      for (let k = 0; k < size; k++) if (allowed[m * size + k]) {
        if (overturned[m * size + k]) return logs[k];
        last = k;
      }
      return logs[last];
    });
    const topplesNext = middleAndSpread(fell, logs.at(-1), LEAST_SPREAD), liftsNext = middleAndSpread(finite, logs.at(-1), 0);
    return { logs, count, width, classes, each, lifted, topplesNext, liftsNext, toppled, shaken };
  }
  function classesOf(finite) {
    const known = [...new Set(finite)].sort((a, b) => a - b);
    if (known.length <= CLASSES) return known;
    return Array.from({ length: CLASSES }, (_, i) => known[Math.trunc(i * (known.length / CLASSES))]);
  }
  function middleAndSpread(logs, otherwise, least) {
    return logs.length ? [mean(logs), Math.max(Math.sqrt(variance(logs)), least)] : [otherwise, Math.max(least, LEAST_SPREAD)];
  }
  const part = (value, [middle, spread]) => {
    if (spread <= 0) return value - middle >= -ROUNDING ? 1 : 0;
    return Math.exp(statistics.logNdtr((value - middle) / spread));
  };
  // fractions that topple and rock under each draw, by draw and level; `shifts`: [name, lifts, topples]
  function predict(outcomes, shifts, few = false) {
    const counts = countMotions(outcomes), { logs, count, width, classes, topplesNext, liftsNext } = counts, size = logs.length;
    const members = few ? FEW_MEMBERS : MEMBERS, w = weights[count], sets = w.length / (count + 1), draws = sets * members;
    const toppling = new Float64Array(draws * size), rocking = new Float64Array(draws * size);
    const at = (set, level, lifted) => {
      let fell = 0, total = 0;
      for (let e = 0; e < count; e++) {
        total += w[set + e] * counts.shaken[e * size + level];
        fell += w[set + e] * counts.toppled[(e * size + level) * width + lifted];
      }
      return total > 0 ? fell / total : 0;
    };
    for (let d = 0; d < draws; d++) {
      const set = Math.floor(d / members) * (count + 1), own = w[set + count];
      let lifts = 0, topples = 0, total = 0, lifted = 0, place = 0;
      shifts.forEach(([, lift, topple], j) => {
        lifts += normals[d * columns + j] * lift;
        topples += normals[d * columns + j] * topple;
      });
      for (let e = 0; e < count; e++) total += w[set + e] * counts.each[e];
      for (let k = 0; k < size; k++) {
        const y = logs[k] - lifts, v = logs[k] - topples;
        while (lifted < classes.length && classes[lifted] <= y + ROUNDING) lifted++;
        while (place < size - 2 && logs[place + 1] <= v) place++;
        const along = size > 1 ? Math.min(Math.max((v - logs[place]) / (logs[place + 1] - logs[place]), 0), 1) : 0;
        let fell = 0, rocks = 0;
        if (along < 1) fell += (1 - along) * at(set, place, lifted);
        if (along > 0) fell += along * at(set, place + 1, lifted);
        for (let e = 0; e < count; e++) rocks += w[set + e] * counts.lifted[e * width + lifted];
        const next = part(y, liftsNext);
        rocking[d * size + k] = ((1 - own) * rocks) / total + own * next;
        toppling[d * size + k] = Math.min((1 - own) * fell + own * Math.min(part(v, topplesNext), next), rocking[d * size + k]);
      }
    }
    return { levels: outcomes.levels, toppling, rocking, draws, members, names: shifts.map(([name]) => name) };
  }
  const sourceOf = (prediction, name) => {
    const j = prediction.names.indexOf(name);
    return Float64Array.from({ length: prediction.draws }, (_, d) => normals[d * columns + j]);
  };
  function meansBySource(values, source) {
    const order = Array.from(values.keys()).sort((a, b) => source[a] - source[b] || a - b), each = values.length / BINS;
    return Array.from({ length: BINS }, (_, b) => mean(order.slice(b * each, (b + 1) * each).map((d) => values[d])));
  }
  // mean of each set of weights
  function meansBySet(values, members) {
    return Array.from({ length: values.length / members }, (_, b) => mean(values.slice(b * members, (b + 1) * members)));
  }
  // part of each source, and of the motions, in the variance of values
  function parts(prediction, values) {
    const total = variance(values);
    if (!(total > 0)) return {};
    const found = { motions: variance(meansBySet(values, prediction.members)) / total };
    for (const name of prediction.names) found[name] = variance(meansBySource(values, sourceOf(prediction, name))) / total;
    return found;
  }
  function meansOnceKnown(values, source, left) {
    const means = meansBySource(values, source);
    if (left <= 0) return means;
    return CENTRES.map((centre) => {
      const w = CENTRES.map((z) => Math.exp(-0.5 * ((z - Math.sqrt(1 - left ** 2) * centre) / left) ** 2));
      return sum(w.map((each, i) => each * means[i])) / sum(w);
    });
  }
  // leave it, secure it, or measure first what would turn that round with a chance; the cheapest measurement first
  function decide(prediction, middle, values, measurements, accepted) {
    const otherwise = middle > accepted ? "secure" : "leave";
    for (const [source, left] of measurements) {
      if (!prediction.names.includes(source)) continue;
      const turned = meansOnceKnown(values, sourceOf(prediction, source), left).filter((each) => each > accepted !== middle > accepted);
      if (turned.length / BINS >= LEAST_CHANCE) return { action: "measure", otherwise, source, chance: turned.length / BINS };
    }
    return { action: otherwise, otherwise, source: "", chance: 0 };
  }
  return { predict, parts, decide, liftsFrom, sourceOf, meansBySet, mean, variance };
};
if (typeof module !== "undefined") module.exports = core;
