/* What the page found, as findings of rockfrag.assess.findings: ids of texts, and the values that stand in them. */
const findings = (data) => {
  "use strict";
  const { HARDLY, BELOW, UP_TO, CERTAIN, FEWEST_EARTHQUAKES, LEAST_PART, MOST_SOURCES, MOST_ASSUMPTIONS, MOST_CHANGES, LEAST_WORTH } = data.constants;
  const finding = (id, values = {}) => ({ id, values });
  const number = (form) => (value) => ({ number: value, form });
  const [percent, limit, two, three, four, whole] = ["percent", "limit", "two", "three", "four", "whole"].map(number);
  const listed = (values) => ({ listed: values });
  const wholePercent = (part) => finding("whole_percent", { value: whole(100 * part) });
  const limits = ({ lower, upper }) => ({ lower: limit(lower), upper: limit(upper) });
  const isOpen = ({ lower, upper }) => lower <= 0 && upper >= 1;
  const likelihoodOf = (p) => (BELOW.find(([most]) => p < most) ?? UP_TO.find(([most]) => p <= most) ?? [0, CERTAIN])[1];

  const called = ({ name }) => (name === data.texts.en.the_object ? finding("the_object") : name);
  function where({ place: { storeys, level, label } }) {
    if (!storeys) return finding(data.onFloor ? "on_its_floor" : "on_ground");
    return label ? finding("on_named_level", { level, storeys, label }) : finding("on_level", { level, storeys });
  }

  // the first screen and what stands behind it, of an answer that may not be complete yet
  function of(request, found) {
    const { measure } = request, { unit } = data.measures[measure], { fraction, rocking, probability, counts } = found;
    const main = probability ?? fraction, years = three(found.years), few = found.earthquakes < FEWEST_EARTHQUAKES;
    const amount = (value) => finding("amount", { measure, value: two(value), unit });
    const level = finding("amount", { measure, value: three(found.level), unit }), who = { name: called(request), where: where(request) };
    // exceptionally unlikely that it rocks, limits included
    const atRest = rocking?.upper < BELOW[0][0], value = fraction?.value ?? found.value, rocks = rocking?.value ?? found.rockingValue;

    function howLikely() {
      const about = { ...who, level };
      if (few) {
        const topple = counts ? counts[2] : percent(found.value), total = counts ? counts[0] : data.earthquakes.length;
        return finding("how_likely_few_earthquakes", { ...about, topple, total, n: found.earthquakes });
      }
      if (atRest) return finding("how_likely_at_rest", { ...about, starts: amount(found.rocksFrom) });
      const id = rocks <= HARDLY ? "how_likely_hardly_rocks" : "how_likely";
      return finding(id, { ...about, likelihood: finding(likelihoodOf(value)), p: chance(fraction ?? { value: found.value, lower: 1, upper: 0 }) });
    }
    function chance({ value, lower, upper }) {
      if (value === 0 && upper > 0) return finding("at_most", { upper: percent(upper) });
      if (value === 1 && lower < 1) return finding("at_least", { lower: percent(lower) });
      return percent(value);
    }
    function howFar({ value, lower, upper }) {
      if (!Number.isFinite(value)) return finding("how_far_beyond", { most: finding("quantity", { value: two(found.levels.at(-1)), unit }) });
      const about = { half: finding("quantity", { value: two(value), unit }), lower: two(lower) };
      return Number.isFinite(upper) ? finding("how_far", { ...about, upper: two(upper) }) : finding("how_far_from", about);
    }
    function inYears() {
      if (probability.value === 0 || isOpen(probability)) return finding("in_years_at_most", { years, upper: percent(probability.upper) });
      return finding("in_years", { p: percent(probability.value), years, ...limits(probability) });
    }
    function advice() {
      const { action, source, chance: part } = found.decision;
      if (action === "measure") return finding("measure_first", { what: finding(`measurement_${source}`), cases: whole(10 * part) });
      if (probability) return action === "secure" ? finding("secure_it") : finding("leave_it", { accepted: percent(found.accepted), years });
      if (atRest) return finding("leave_it_at_rest");
      return finding(action === "secure" ? "secure_unless" : "leave_unless", { p: percent(fraction.value || fraction.upper) });
    }
    function first() {
      if (few) return [howLikely(), finding("give_earthquakes", { least: FEWEST_EARTHQUAKES })];
      if (!fraction) return [howLikely()];
      return [howLikely(), ...(atRest ? [] : [howFar(found.half)]), ...(probability ? [inYears()] : []), advice()];
    }

    // ---- behind it

    function atLevel() {
      const every = data.earthquakes.length, [total, rock, topple] = counts ?? [];
      const counted = counts ? [finding(total < every ? "counted_some" : "counted", { ...(total < every ? { every } : {}), total, rock, topple })] : [];
      if (found.site) counted.push(finding("counted_moved", { rock: percent(rocks), topple: percent(value) }));
      const starts = Number.isFinite(found.rocksFrom) ? finding("starts_at", { starts: amount(found.rocksFrom) }) : finding("starts_beyond");
      return [...counted, ...(fraction && !atRest ? [between()] : []), starts, ...(request.level === null ? [finding("exceeded_in_475", { level })] : [])];
    }
    function between() {
      if (isOpen(fraction)) return finding("fraction_open");
      if (fraction.value === 0) return finding("fraction_at_most", { upper: percent(fraction.upper) });
      if (fraction.value === 1) return finding("fraction_at_least", { lower: percent(fraction.lower) });
      return finding("fraction_between", limits(fraction));
    }
    function overYears() {
      if (found.probabilityValue === null) return [finding("needs_hazard")];
      if (!probability) return [];
      const accepted = finding("accepted", { accepted: percent(found.accepted), years });
      if (probability.value === 0) return [finding("years_at_most", { years, upper: percent(probability.upper) }), accepted];
      const about = { p: percent(probability.value), years };
      return [isOpen(probability) ? finding("years_open", about) : finding("years_between", { ...about, ...limits(probability) }), accepted];
    }
    function position() {
      const ways = found.arrangements, said = [];
      if (new Set(ways.map(([, value]) => value)).size > 1) {
        const ranked = [...ways].sort((a, b) => a[1] - b[1]), [[best]] = ranked;
        const each = listed(ranked.map(([way, value]) => finding("way", { way: finding(way), value: percent(value) })));
        said.push(found.safer.includes(best) ? finding("safest", { way: finding(best), ways: each }) : finding("no_safest", { ways: each }));
      }
      if (!request.solid) return [...said, finding(request.narrower ? "rocks_across_narrower" : "rocks_across", { width: four(100 * request.statue.width) })];
      said.push(finding(request.solid.round ? "rolls_in_space" : "moves_in_space"));
      return typeof found.planar === "number" ? [...said, finding("in_one_plane", { value: percent(found.planar) })] : said;
    }
    const changeOf = ({ name, values }) => finding(name, values);
    function reduction({ factor, lower, upper }) {
      const sign = factor > 1 ? -1 : 1, ends = [lower, upper].map((end) => sign * (1 - end)).sort((a, b) => a - b);
      return { value: wholePercent(sign * (1 - factor)), lower: whole(100 * ends[0]), upper: whole(100 * ends[1]) };
    }
    function helps() {
      if (!main) return [];
      if (main.value === 0 || (atRest && !probability)) return [finding("no_change_needed")];
      const shown = found.mitigations.filter((each) => each.shown).slice(0, MOST_CHANGES);
      // what may hold it needs an engine that a page has not
      const leftOut = finding("holders_not_tried");
      if (!shown.length) return [finding("no_change_shown"), leftOut];
      return [...shown.map((each) => (each.factor === 0 ? finding("none_left", { change: changeOf(each) }) : finding("reduces", { change: changeOf(each), ...reduction(each) }))), leftOut];
    }
    function howSure() {
      if (!main) return [];
      const total = Object.values(main.sources).reduce((sum, s) => sum + s * s, 0), said = [finding("sentence", { words: request.solid ? data.motionsInSpace : data.motions })];
      const ranked = Number.isFinite(total) && total > 0 ? Object.entries(main.sources).map(([name, s]) => [name, (s * s) / total]).sort((a, b) => b[1] - a[1]) : [];
      const named = ranked.filter(([, part]) => part >= LEAST_PART).slice(0, MOST_SOURCES);
      if (named.length) said.push(finding("uncertainty", { sources: listed(named.map(([name, part]) => finding("source_part", { source: finding(`source_${name}`), part: wholePercent(part) }))) }));
      const worth = (few ? [] : found.decision?.measurements ?? []).filter(({ chance }) => chance >= LEAST_WORTH);
      const each = worth.map(({ source, chance }) => finding("worth_measuring", { what: finding(`measurement_${source}`), cases: whole(10 * chance) }));
      if (each.length) said.push(finding("worth", { measurements: listed(each) }));
      const size = (keys) => keys.reduce((sum, key) => sum + (main.sources[key] ?? 0) ** 2, 0);
      const order = assumed(request).map(([id, values, keys], i) => [finding(`assumed_${id}`, values), size(keys), i]).sort((a, b) => b[1] - a[1] || a[2] - b[2]);
      const rest = order.length - MOST_ASSUMPTIONS;
      said.push(finding("assumed", { assumptions: listed(order.slice(0, MOST_ASSUMPTIONS).map(([short]) => short)) }));
      return rest > 0 ? [...said, finding("more_assumed", { n: rest })] : said;
    }
    function details() {
      const all = { title_level: atLevel(), title_years: overYears(), title_position: position(), title_helps: helps(), title_sure: howSure() };
      return Object.entries(all).filter(([, said]) => said.length).map(([id, said]) => [finding(id, id === "title_years" ? { years } : {}), said]);
    }
    return { first: first(), details: details(), helps: helps() };
  }
  return { of, called };

  // what was not given: its text, what stands in it, and the sources that it widens; the place first
  function assumed({ place, statue, pedestal, massGiven, restitution, solid, depthGiven }) {
    const found = [], density = whole(data.constants.STONE);
    if (place.assumed === "on_ground") found.push(["on_ground", {}, []]);
    if (place.assumed === "elastic") found.push(["building", {}, ["period", "damping"]]);
    if (place.assumed === "building") found.push(["sketched", { total: three(place.total), period: two(place.period) }, ["period", "damping"]]);
    found.push([solid?.round ? "round_base" : solid ? "box_base" : "planar_base", {}, []]);
    if (restitution === null && !solid?.round) found.push(["restitution", {}, ["restitution"]]);
    if (!depthGiven && !solid) found.push(["depth", { depth: four(100 * statue.width) }, []]);
    if (!massGiven) found.push([solid?.round ? "mass_of_cylinder" : "mass_of_box", { mass: three(statue.mass), density }, ["mass"]]);
    if (statue.cgHeight === null) found.push(["cg_height", {}, ["cg_height"]]);
    if (pedestal && !pedestal.massGiven) found.push(["pedestal", { mass: three(pedestal.mass), density }, ["mass"]]);
    return found;
  }
};
if (typeof module !== "undefined") module.exports = findings;
