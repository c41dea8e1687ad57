/* What the page found, as findings of rockfrag.assess.findings: ids of texts, and the
 * values that stand in them.
 */
const findings = (data, core, judge) => {
  "use strict";
  const { choose } = core;
  const { partsOf, ordered } = judge;
  const { MOST_SOURCES, MOST_CHANGES, FEWEST_EARTHQUAKES } = data.constants;
  const finding = (id, values = {}) => ({ id, values });
  const number = (form) => (value) => ({ number: value, form });
  const [percent, limit, two, three, four, whole] = [
    "percent",
    "limit",
    "two",
    "three",
    "four",
    "whole",
  ].map(number);
  const listed = (values) => ({ listed: values });
  const wholePercent = (part) => finding("whole_percent", { value: whole(100 * part) });
  const limits = ({ lower, upper }) => ({ lower: limit(lower), upper: limit(upper) });
  const numbers = ({ value, lower, upper }) => [value, lower, upper];
  // the text that a function of the core chooses by numbers
  const chosen = (choice, ...given) => data.choices[choice][choose(choice, ...given)];

  const called = ({ name }) =>
    name === data.texts.en.the_object ? finding("the_object") : name;
  function where({ place: { storeys, level, label } }) {
    if (!storeys) return finding(data.onFloor ? "on_its_floor" : "on_ground");
    return label
      ? finding("on_named_level", { level, storeys, label })
      : finding("on_level", { level, storeys });
  }

  // what a change takes off a risk, with its limits
  function reduction({ factor, lower, upper }) {
    const [value, least, most] = core.within(() => {
      const found = core.zeros([3]);
      core.call("tell_reduction", factor, lower, upper, found);
      return [...found.values];
    });
    return {
      value: percent(value),
      ...limits({ lower: least, upper: most }),
    };
  }
  // the least that a change takes off that takes off nearly all
  const nearlyAll = ({ upper }) => ({
    lower: whole(choose("whole_percent_below", 1 - upper)),
  });

  // the first screen and what stands behind it, of an answer that may not be complete
  // yet
  function of(request, found) {
    const { measure } = request;
    const { unit } = data.measures[measure];
    const { fraction, rocking, probability, counts } = found;
    const main = probability ?? fraction;
    const years = three(found.years);
    const few = choose("are_few", found.earthquakes);
    const amount = (value) => finding("amount", { measure, value: two(value), unit });
    const level = finding("amount", { measure, value: three(found.level), unit });
    const who = { name: called(request), where: where(request) };
    const atRest = choose("stays", rocking?.upper ?? 1);
    const value = fraction?.value ?? found.value;
    const rocks = rocking?.value ?? found.rockingValue;

    function howLikely() {
      const kind = chosen("how_likely", few, atRest, rocks);
      const nowhere =
        kind === "how_likely_at_rest" && !Number.isFinite(found.rocksFrom);
      const id = nowhere ? "how_likely_rocks_nowhere" : kind;
      const topple = counts ? counts[2] : percent(found.value);
      const about =
        {
          how_likely_few_earthquakes: () => ({
            topple,
            total: counts ? counts[0] : data.earthquakes.length,
            n: found.earthquakes,
          }),
          how_likely_at_rest: () => ({ starts: amount(found.rocksFrom) }),
          how_likely_rocks_nowhere: () => ({}),
        }[id] ??
        (() => ({
          likelihood: finding(chosen("likelihood", value)),
          p: chance(fraction ?? { value: found.value, lower: 1, upper: 0 }),
        }));
      return finding(id, { ...who, level, ...about() });
    }
    function chance(estimate) {
      const id = chosen("chance", ...numbers(estimate));
      const { value, lower, upper } = estimate;
      return (
        {
          at_most: () => finding(id, { upper: percent(upper) }),
          at_least: () => finding(id, { lower: percent(lower) }),
        }[id]?.() ?? percent(value)
      );
    }
    function howFar({ value, lower, upper }) {
      const id = chosen("how_far", value, upper);
      const quantity = (each) => finding("quantity", { value: two(each), unit });
      const half = { half: quantity(value), lower: two(lower) };
      return finding(
        id,
        {
          how_far: { ...half, upper: two(upper) },
          how_far_from: half,
          how_far_beyond: { most: quantity(found.levels.at(-1)) },
        }[id],
      );
    }
    function inYears() {
      const id = chosen("in_years", ...numbers(probability));
      return finding(
        id,
        {
          in_years: { p: percent(probability.value), years, ...limits(probability) },
          in_years_at_most: { years, upper: percent(probability.upper) },
        }[id],
      );
    }
    function advice() {
      const { action, source, chance: part } = found.decision;
      const worth = main.value || main.upper;
      const p = percent(worth);
      const id = chosen("advice", action, Boolean(probability), atRest, worth);
      const measured = {
        what: finding(`measurement_${source}`),
        cases: whole(10 * part),
      };
      return finding(
        id,
        {
          measure_first: measured,
          leave_it: { accepted: percent(found.accepted), years },
          secure_unless: { p },
          leave_unless: { p },
        }[id],
      );
    }
    function first() {
      if (few)
        return [
          howLikely(),
          finding("give_earthquakes", { least: FEWEST_EARTHQUAKES }),
        ];
      if (!fraction) return [howLikely()];
      return [
        howLikely(),
        ...(atRest ? [] : [howFar(found.half)]),
        ...(probability ? [inYears()] : []),
        advice(),
      ];
    }

    // ---- behind it

    function atLevel() {
      const every = data.earthquakes.length;
      const [total, rock, topple] = counts ?? [];
      const id = counts && chosen("counted", total, every);
      const counted = counts
        ? [
            finding(id, {
              ...(id === "counted" ? {} : { every }),
              total,
              rock,
              topple,
            }),
          ]
        : [];
      if (found.site)
        counted.push(
          finding("counted_moved", { rock: percent(rocks), topple: percent(value) }),
        );
      const begins = chosen("starts", found.rocksFrom);
      const starts = finding(
        begins,
        begins === "starts_at" ? { starts: amount(found.rocksFrom) } : {},
      );
      return [
        ...counted,
        ...(fraction && !atRest ? [between()] : []),
        starts,
        ...(request.level === null ? [finding("exceeded_in_475", { level })] : []),
      ];
    }
    function between() {
      const id = chosen("between", ...numbers(fraction));
      const { lower, upper } = fraction;
      return finding(
        id,
        {
          fraction_at_most: { upper: percent(upper) },
          fraction_at_least: { lower: percent(lower) },
          fraction_between: limits(fraction),
        }[id],
      );
    }
    function overYears() {
      if (found.probabilityValue === null) return [finding("needs_hazard")];
      if (!probability) return [];
      const id = chosen("over_years", ...numbers(probability));
      const p = percent(probability.value);
      const about = {
        years_at_most: { upper: percent(probability.upper) },
        years_open: { p },
        years_between: { p, ...limits(probability) },
      }[id];
      return [
        finding(id, { years, ...about }),
        finding("accepted", { accepted: percent(found.accepted), years }),
      ];
    }
    function position() {
      const ways = found.arrangements;
      const said = [];
      if (new Set(ways.map(([, value]) => value)).size > 1) {
        const ranked = ordered(
          ways,
          ([, value]) => value,
          () => 0,
        );
        const [[best]] = ranked;
        const id = chosen("safest", found.safer.includes(best));
        const each = listed(
          ranked.map(([way, value]) =>
            finding("way", { way: finding(way), value: percent(value) }),
          ),
        );
        said.push(
          finding(id, {
            ways: each,
            ...(id === "safest" ? { way: finding(best) } : {}),
          }),
        );
      }
      if (!request.solid) return [...said, planeOf(request)];
      said.push(finding(request.solid.round ? "rolls_in_space" : "moves_in_space"));
      return typeof found.planar === "number"
        ? [...said, finding("in_one_plane", { value: percent(found.planar) })]
        : said;
    }
    function planeOf({ kind, narrower, statue: { width } }) {
      if (kind) return finding(kind.plane);
      const id = narrower ? "rocks_across_narrower" : "rocks_across";
      return finding(id, { width: four(100 * width) });
    }
    const changeOf = ({ name, values }) => finding(name, values);
    const takenOff = (id, each) =>
      ({ none_left: () => ({}), reduces_nearly_all: nearlyAll })[id]?.(each) ??
      reduction(each);
    function helps() {
      if (!main) return [];
      if (!choose("needs_change", main.value, atRest, Boolean(probability)))
        return [finding("no_change_needed")];
      const shown = found.mitigations
        .filter((each) => each.shown)
        .slice(0, MOST_CHANGES);
      // what may hold it is tried when it is chosen
      const leftOut = request.hold ? [] : [finding("holders_not_tried")];
      if (!shown.length) return [finding("no_change_shown"), ...leftOut];
      const said = shown.map((each) => [chosen("reduces", each.factor, false), each]);
      return [
        ...said.map(([id, each]) =>
          finding(id, {
            change: changeOf(each),
            ...takenOff(id, each),
          }),
        ),
        ...leftOut,
      ];
    }
    function howSure() {
      if (!main) return [];
      const said = [
        finding("sentence", {
          words: request.solid ? data.motionsInSpace : data.motions,
        }),
      ];
      const named = partsOf(main.sources)
        .filter(([, part]) => choose("names_source", part))
        .slice(0, MOST_SOURCES);
      if (named.length)
        said.push(
          finding("uncertainty", {
            sources: listed(
              named.map(([name, part]) =>
                finding("source_part", {
                  source: finding(`source_${name}`),
                  part: wholePercent(part),
                }),
              ),
            ),
          }),
        );
      const worth = (few ? [] : (found.decision?.measurements ?? [])).filter(
        ({ chance }) => choose("lists_measurement", chance),
      );
      const each = worth.map(({ source, chance }) =>
        finding("worth_measuring", {
          what: finding(`measurement_${source}`),
          cases: whole(10 * chance),
        }),
      );
      if (each.length) said.push(finding("worth", { measurements: listed(each) }));
      const order = ordered(
        assumed(request),
        ([, , keys]) => -widening(keys),
        () => 0,
      ).map(([id, values]) => finding(`assumed_${id}`, values));
      // all of them, as they stand nowhere else
      return [...said, finding("assumed", { assumptions: listed(order) })];
    }
    // how much sources widen the interval together
    const widening = (keys) =>
      core.within(() => {
        const deviations = keys.map((key) => main.sources[key] ?? 0);
        return core.call("sum_of_squares", core.put(deviations));
      });
    function details() {
      const all = {
        title_level: atLevel(),
        title_years: overYears(),
        title_position: position(),
        title_helps: helps(),
        title_sure: howSure(),
      };
      return Object.entries(all)
        .filter(([, said]) => said.length)
        .map(([id, said]) => [
          finding(id, id === "title_years" ? { years } : {}),
          said,
        ]);
    }
    return { first: first(), details: details(), helps: helps() };
  }
  // what holds an object, with what it bears
  function holderOf({ there, kind }, bears) {
    const { called, place, factor } = data.holding.kinds[kind ?? there.kind];
    const value = kind ? bears : there.value;
    if (!place) return called;
    const put = { ...called.values[place], number: factor * value };
    return finding(called.id, { ...called.values, [place]: put });
  }
  // what a holder that was tried does, and in how many motions it holds
  function ofTrial({ measure, hold }, { level, does, asked }) {
    const { unit } = data.measures[measure];
    const amount = finding("amount", { measure, value: three(level), unit });
    const holder = holderOf(hold, asked?.bears);
    const change = asked
      ? finding("holds", {
          change: holder,
          level: amount,
          held: asked.held,
          total: asked.total,
        })
      : holder;
    return finding("tried", { change, does: alone(does) });
  }
  function alone({ factor, lower, upper, shown }) {
    const id = chosen("change_alone", factor, false, shown);
    const about =
      {
        cell_unknown: () => ({}),
        cell_none_left: () => ({}),
        cell_same: () => ({}),
        cell_reduces: () => reduction({ factor, lower, upper }),
        cell_reduces_nearly_all: () => nearlyAll({ upper }),
      }[id] ?? (() => ({ value: percent(Math.abs(1 - factor)) }));
    return finding(id, about());
  }
  return { of, ofTrial };

  // what was not given: its text, what stands in it, and the sources that it widens;
  // the place first
  function assumed({
    kind,
    place,
    sizes: statue,
    pedestal,
    massGiven,
    restitution,
    solid,
    depthGiven,
  }) {
    const found = [];
    const density = whole(data.constants.STONE);
    if (place.assumed === "on_ground") found.push(["on_ground", {}, []]);
    if (place.assumed === "elastic")
      found.push(["building", {}, ["period", "damping"]]);
    if (place.assumed === "building")
      found.push([
        "sketched",
        { total: three(place.total), period: two(place.period) },
        ["period", "damping"],
      ]);
    found.push([kind?.assumption ?? baseOf(solid), {}, []]);
    if (restitution === null && !solid?.round)
      found.push(["restitution", {}, ["restitution"]]);
    if (!depthGiven && !solid)
      found.push(["depth", { depth: four(100 * statue.width) }, []]);
    if (!massGiven)
      found.push([
        solid?.round ? "mass_of_cylinder" : "mass_of_box",
        { mass: three(statue.mass), density },
        ["mass"],
      ]);
    if (statue.cgHeight === null) found.push(["cg_height", {}, ["cg_height"]]);
    if (pedestal && !pedestal.massGiven)
      found.push(["pedestal", { mass: three(pedestal.mass), density }, ["mass"]]);
    return found;
  }
  function baseOf(solid) {
    if (!solid) return "planar_base";
    return solid.round ? "round_base" : "box_base";
  }
};
if (typeof module !== "undefined") module.exports = findings;
