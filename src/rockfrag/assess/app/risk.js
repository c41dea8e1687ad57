/* What is estimated of outcomes, by calls of the core in turn; see
 * rockfrag.assess.risk.
 */
const risk = (data, core) => {
  "use strict";
  const {
    zeros,
    put,
    call,
    within,
    constants: {
      FRACTION,
      RATE,
      LEVEL,
      CLASSES,
      BINS,
      MOST_LEVELS,
      MEMORY,
      STATE,
      ACTION,
      OTHERWISE,
      FIRST,
    },
  } = core;
  const { FLANK_Z, EC8_SLOPE, EC8_SLOPE_SD, MEMBERS, FEW_MEMBERS } = data.constants;
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const numbers = (text) => new Float64Array(bytes(text).buffer);
  const { columns } = data.draws;
  const normals = put(numbers(data.draws.normals), [data.draws.size, columns]);
  const bins = bytes(data.draws.bins);
  const fewNormals = put(
    normals.values.slice(0, (data.draws.size / MEMBERS) * FEW_MEMBERS * columns),
    [(data.draws.size / MEMBERS) * FEW_MEMBERS, columns],
  );
  const sets = data.draws.size / MEMBERS;
  const weights = Object.fromEntries(
    Object.entries(data.draws.weights).map(([count, text]) => [
      count,
      put(numbers(text), [sets, Number(count) + 1]),
    ]),
  );

  // ---- outcomes in the core's memory, those of the motions that were tried

  function placed(outcomes) {
    const { levels } = outcomes;
    const rows = outcomes.motions ?? data.earthquakes.map((_, m) => m);
    const size = levels.length;
    const table = (name) =>
      put(
        Uint8Array.from(
          { length: rows.length * size },
          (_, i) => outcomes[name][rows[Math.floor(i / size)] * size + (i % size)],
        ),
        [rows.length, size],
      );
    const names = [...new Set(rows.map((m) => data.earthquakes[m]))];
    const made = {
      levels: put(levels),
      count: names.length,
      rows,
      uplifts: zeros([rows.length]),
      ones: put(rows.map(() => 1)),
    };
    for (const name of ["overturned", "rocked", "allowed"]) made[name] = table(name);
    made.quakes = put(
      BigInt64Array.from(rows, (m) => BigInt(names.indexOf(data.earthquakes[m]))),
    );
    lift(
      made,
      rows.map((m) => outcomes.lifting[m]),
    );
    return outcomes.site ? moved(made, outcomes.site) : made;
  }
  const lift = (at, lifting) =>
    call(
      "fill_uplifts",
      at.levels,
      at.rocked,
      at.overturned,
      at.allowed,
      put(lifting),
      at.uplifts,
    );
  // the same with the velocity of a site
  function moved(at, { logs, weight, lines, nodes, byStatics }) {
    const wanted = zeros(at.levels.shape);
    const each = (values) => [...values].flatMap((value) => nodes.map(() => value));
    const rows = each(at.rows);
    const shape = [rows.length, at.levels.shape[0]];
    const [allowed, overturned, rocked] = [1, 2, 3].map(() => zeros(shape, Uint8Array));
    call("fill_wanted", at.levels, put(lines.flat(), [lines.length, 2]), wanted);
    call(
      "fill_moved",
      at.levels,
      at.allowed,
      at.overturned,
      at.rocked,
      put(at.rows.map((m) => logs[m])),
      wanted,
      put(nodes),
      weight,
      byStatics ? 1 : 0,
      zeros(at.levels.shape),
      zeros(shape, BigInt64Array),
      allowed,
      overturned,
      rocked,
    );
    const made = {
      ...at,
      rows,
      allowed,
      overturned,
      rocked,
      uplifts: zeros([rows.length]),
      ones: put(rows.map(() => 1)),
      quakes: put(BigInt64Array.from(each(at.quakes.values))),
    };
    lift(made, each(at.uplifts.values));
    return made;
  }
  function counted(at, state = "overturned") {
    const found = zeros(at.levels.shape);
    call("fill_counted", at[state], at.allowed, at.ones, found);
    return found;
  }
  const fractions = (outcomes) => within(() => [...counted(placed(outcomes)).values]);
  const liftsFrom = (outcomes) => within(() => [...placed(outcomes).uplifts.values]);

  // ---- hazard

  const curveOf = (levels, rates, quantiles = []) => ({ levels, rates, quantiles });
  function curveOfOneLevel(level, years) {
    const curve = (slope) =>
      within(() => {
        const levels = zeros([3]);
        const rates = zeros([3]);
        call("fill_power_law", level, years, slope, levels, rates);
        return curveOf([...levels.values], [...rates.values]);
      });
    const flanks = [
      [-FLANK_Z, EC8_SLOPE + EC8_SLOPE_SD],
      [FLANK_Z, EC8_SLOPE - EC8_SLOPE_SD],
    ];
    return {
      ...curve(EC8_SLOPE),
      quantiles: flanks.map(([z, slope]) => ({ z, ...curve(slope) })),
    };
  }
  const levelOf = ({ levels, rates }, rate) =>
    within(() => {
      const found = zeros([1]);
      call("fill_level", put(levels), put(rates), rate, found);
      return found.values[0];
    });
  function rateWeights(levels, curve) {
    const found = zeros(levels.shape);
    call("fill_rate_weights", levels, 0, put(curve.levels), put(curve.rates), found);
    return found;
  }
  const row = (values) => values.as([1, values.shape[0]]);
  const rateOf = (at, curve) =>
    call("fill_sums", row(counted(at)), rateWeights(at.levels, curve), zeros([1]));

  // ---- what is estimated

  const riskTarget = (curve, years) => ({
    kind: RATE,
    years,
    state: "overturned",
    weigh: (levels) => rateWeights(levels, curve),
  });
  const fractionTarget = (level, state = "overturned") => ({
    kind: FRACTION,
    years: 1,
    state,
    weigh: (levels) => {
      const found = zeros(levels.shape);
      call("fill_place", levels, level, found);
      return found;
    },
  });
  const amplitudeTarget = (part) => ({
    kind: LEVEL,
    years: 1,
    state: "overturned",
    part,
  });
  function shownOf({ kind, years }, values) {
    const found = zeros(values.shape);
    call("fill_shown", BigInt(kind), years, values, found);
    return found;
  }
  const shown = (target, value) => shownOf(target, put([value])).values[0];
  // of fractions as counted
  const valueOf = (target, outcomes) =>
    within(() => {
      const at = placed(outcomes);
      const fractions = row(counted(at, target.state));
      return shown(
        target,
        call("fill_sums", fractions, target.weigh(at.levels), zeros([1])),
      );
    });

  // ---- what is not known: sources with what they move of uplift and of toppling

  const afterUplift = (name, spread) => [name, 0, spread];
  const shiftOf = (name, lower, upper) =>
    within(() => {
      const [low, high] = [lower, upper].map(placed);
      const found = zeros([2]);
      call(
        "fill_shift",
        low.levels,
        counted(low),
        counted(high),
        low.uplifts,
        high.uplifts,
        found,
      );
      return [name, ...found.values];
    });
  // what the velocity of the site does: the shift of ln level that it leaves open, and
  // how motions are moved; null where nothing follows
  const velocityOf = (
    outcomes,
    { logs, median, spread, published },
    level,
    byStatics,
  ) =>
    within(() => {
      const at = placed(outcomes);
      const found = zeros([5]);
      const tests = zeros([at.rows.length * MOST_LEVELS, MEMORY]);
      call(
        "fill_weight",
        at.levels,
        at.allowed,
        at.overturned,
        put(at.rows.map((m) => logs[m])),
        at.quakes,
        published ? 1 : 0,
        tests,
        zeros([STATE]),
        found,
      );
      const [weight, error] = found.values;
      if (Number.isNaN(weight)) return null;
      if (!published) return { shift: weight * spread, site: null };
      const { lines, nodes, ofSite } = published;
      const table = put(lines.flat(), [lines.length, 2]);
      const wanted = zeros(at.levels.shape);
      call("fill_wanted", at.levels, table, wanted);
      const shift = call(
        "shift_by_velocity",
        weight,
        call("spread_of_mean", level, ofSite, table),
        error,
        wanted,
        median,
      );
      return { shift, site: { logs, weight, lines, nodes, byStatics } };
    });
  const ofQuantiles = (outcomes, curve) =>
    within(() => {
      const at = placed(outcomes);
      const known = curve.quantiles;
      const spread = call(
        "spread_of_quantiles",
        put(known.map(({ z }) => z)),
        put(known.map((each) => rateOf(at, each))),
      );
      return Number.isNaN(spread) ? {} : { hazard: spread };
    });

  // ---- under each draw; what these return stands in the core's memory

  function predict(outcomes, shifts, few = false) {
    const at = placed(outcomes);
    const { count } = at;
    const size = outcomes.levels.length;
    const own = few ? fewNormals : normals;
    const tables = [own.shape[0], size];
    const counts = [
      zeros([size]),
      zeros([count, size, CLASSES + 1]),
      zeros([count, size]),
      zeros([count, CLASSES + 1]),
      zeros([count]),
      zeros([CLASSES]),
      zeros([4]),
    ];
    call(
      "fill_counts",
      at.levels,
      at.overturned,
      at.allowed,
      at.uplifts,
      at.quakes,
      zeros([3, at.rows.length]),
      ...counts,
    );
    const overturned = zeros(tables);
    const rocked = zeros(tables);
    call(
      "fill_fractions",
      ...counts,
      weights[count],
      own,
      put(
        shifts.flatMap(([, lifts, topples]) => [lifts, topples]),
        [shifts.length, 2],
      ),
      overturned,
      rocked,
    );
    return {
      levels: at.levels,
      overturned,
      rocked,
      normals: own,
      count,
      names: shifts.map(([name]) => name),
    };
  }
  function drawn(target, prediction, rates) {
    const table = prediction[target.state];
    const values = zeros([table.shape[0]]);
    if (target.kind === LEVEL) {
      call("fill_crossings", table, prediction.levels, target.part, values);
      return { values, middle: NaN };
    }
    const middle = call("fill_sums", table, target.weigh(prediction.levels), values);
    if (target.kind === RATE && Object.keys(rates).length)
      call(
        "fill_errors",
        values,
        prediction.normals,
        put(prediction.names.map((name) => rates[name] ?? 0)),
      );
    return { values, middle };
  }
  const rowsOf = (names) =>
    put(bins.slice(0, names.length * data.draws.size), [names.length, data.draws.size]);
  const estimate = (target, prediction, rates) =>
    within(() => {
      const { values, middle } = drawn(target, prediction, rates);
      const { names, levels, count } = prediction;
      const memory = () => zeros(values.shape);
      const found = zeros([4 + names.length]);
      call(
        "fill_estimate",
        BigInt(target.kind),
        target.years,
        middle,
        levels.values.at(-1),
        values,
        memory(),
        memory(),
        rowsOf(names),
        BigInt(sets),
        BigInt(count),
        found,
      );
      const [value, lower, upper, ...parts] = found.values;
      const named = ["motions", ...names].map((name, i) => [name, parts[i]]);
      return {
        value,
        lower,
        upper,
        sources: parts.some((part) => part > 0) ? Object.fromEntries(named) : {},
      };
    });
  // what to do: leave it, secure it, or measure first what would turn that round with a
  // chance, the cheapest first
  const decision = (target, prediction, rates, accepted) =>
    within(() => {
      const { values, middle } = drawn(target, prediction, rates);
      const { names } = prediction;
      const found = zeros([3]);
      const limit =
        target.kind === RATE ? call("rate_of", accepted, target.years) : accepted;
      const known = data.measurements.filter(([source]) => names.includes(source));
      const turned = zeros([known.length, 2]);
      const places = put(
        BigInt64Array.from(known, ([source]) => BigInt(names.indexOf(source))),
      );
      call(
        "fill_decision",
        values,
        rowsOf(names),
        places,
        put(known.map(([, left]) => left)),
        middle,
        limit,
        zeros([BINS]),
        turned,
        found,
      );
      const measurements = known.map(([source], i) => ({
        source,
        chance: turned.values[2 * i],
      }));
      const { values: codes } = found;
      return {
        action: codes[ACTION],
        otherwise: codes[OTHERWISE],
        measurements,
        ...measurements[codes[FIRST]],
      };
    });
  const countsAt = ({ levels, allowed, rocked, overturned, motions }, level) =>
    within(() => {
      const table = (values) =>
        put(values, [values.length / levels.length, levels.length]);
      const found = zeros([3]);
      call(
        "fill_counts_at",
        put(levels),
        level,
        ...[allowed, rocked, overturned].map(table),
        found,
      );
      return found.values[0] ? [...found.values] : null;
    });
  const ordered = (items, first, second, falling) =>
    within(() => {
      const order = zeros([items.length], BigInt64Array);
      call(
        "fill_order",
        put(items.map(first)),
        put(items.map(second)),
        falling ? 1 : 0,
        order,
      );
      return [...order.values].map((place) => items[Number(place)]);
    });
  // sources with their parts in the variance of an interval, the largest first; none
  // where there are none
  const partsOf = (sources) =>
    within(() => {
      const deviations = put(Object.values(sources));
      const parts = zeros(deviations.shape);
      call("fill_parts", deviations, parts);
      const each = Object.keys(sources).map((name, i) => [name, parts.values[i]]);
      return ordered(
        each,
        ([name]) => -sources[name],
        ([, part]) => part,
      ).filter(() => parts.values.some(Boolean));
    });
  const meanOf = (target, shifts, rates, outcomes) =>
    within(() => shown(target, drawn(target, predict(outcomes, shifts), rates).middle));
  const earthquakes = new Set(data.earthquakes).size;
  // what changes do with the same errors, with limits of the factor over the
  // earthquakes
  function compared(target, shifts, rates, now) {
    const with_ = (outcomes) =>
      shownOf(target, drawn(target, predict(outcomes, shifts, true), rates).values);
    const today = within(() => with_(now).values.slice());
    return (changed) =>
      within(() => {
        const before = put(today);
        const after = with_(changed);
        const found = zeros([7]);
        call(
          "fill_comparison",
          BigInt(target.kind),
          before,
          after,
          BigInt(sets),
          BigInt(earthquakes),
          zeros([2, before.shape[0]]),
          found,
        );
        const [, value, factor, lower, upper, helps, shown] = found.values;
        return {
          value,
          factor,
          lower,
          upper,
          helps: Boolean(helps),
          shown: Boolean(shown),
        };
      });
  }

  return {
    fractions,
    curveOf,
    curveOfOneLevel,
    levelOf,
    riskTarget,
    fractionTarget,
    amplitudeTarget,
    valueOf,
    liftsFrom,
    estimate,
    meanOf,
    shiftOf,
    velocityOf,
    afterUplift,
    predict,
    decision,
    ofQuantiles,
    compared,
    countsAt,
    ordered,
    partsOf,
    within,
  };
};
if (typeof module !== "undefined") module.exports = risk;
