/* The answer in the words of rockfrag.assess.words, from a table of texts. */
const words = (data, texts) => {
  "use strict";
  const { steps, constants: { EXCEPTIONALLY, MANY, FEW, LEAST_PART, MOST_SOURCES, MOST_ASSUMPTIONS, LEVEL } } = data;
  const fill = (text, values = {}) => text.replace(/\{(\w+)\}/g, (whole, name) => String(values[name] ?? whole));
  const say = (id, values) => fill(texts[id] ?? id, values);
  const local = (text) => text.replace(".", texts.decimal).replace("e+", "e");

  // a number of so many digits, halves to even as Python rounds them: mantissa and exponent
  function rounded(value, digits) {
    const [mantissa, power] = value.toExponential(60).split("e"), kept = mantissa.slice(0, mantissa.indexOf(".") + digits);
    const tie = /^50*$/.test(mantissa.slice(kept.length)) && Number(kept.replace(".", "").at(-1)) % 2 === 0;
    return (tie ? `${kept}e${power}` : value.toExponential(digits - 1)).split("e");
  }
  // a number as Python's g format writes it
  function g(value, digits) {
    if (value === 0) return "0";
    const [mantissa, power] = rounded(value, digits), exponent = Number(power);
    if (exponent >= -4 && exponent < digits) return local(String(Number(`${mantissa}e${power}`)));
    return local(`${Number(mantissa)}e${power[0]}${power.slice(1).padStart(2, "0")}`);
  }
  // whole numbers as Python rounds them, halves to even
  function whole(value) {
    const rounded = Math.round(value);
    return String(Math.abs(value % 1) === 0.5 && rounded % 2 ? rounded - 1 : rounded);
  }
  function percent(value) {
    if (!Number.isFinite(value)) return say("unknown");
    if (value <= 0 || value >= 1) return `${whole(100 * value)} %`;
    if (value < 1e-5) return say("less_than", { value: local("0.001") });
    if (value > 0.995) return say("more_than_99");
    return `${g(100 * value, 2)} %`;
  }
  function end(part) {
    const value = 100 * part;
    if (value < 5e-4) return "0";
    if (value >= 99.5 && value <= 100 - 5e-4) return local(value.toFixed(-Math.floor(Math.log10(100 - value))));
    if (value >= 10) return whole(value);
    return value >= 1 ? g(value, 2) : g(value, 1);
  }
  const range = ({ lower, upper }) => say("range", { low: end(lower), high: end(upper) });
  function interval(estimate) {
    if (!estimate) return "";
    if (estimate.value === 1) return ` (${say("lower_limit", { limit: percent(estimate.lower) })})`;
    if (estimate.value === 0) return ` (${say("upper_limit", { limit: percent(estimate.upper) })})`;
    if (estimate.lower <= 0 && estimate.upper >= 1) return ` (${say("no_interval")})`;
    return ` (${say("interval", { level: whole(100 * LEVEL), range: range(estimate) })})`;
  }
  const capital = (text) => text.slice(0, 1).toUpperCase() + text.slice(1);
  const listed = (all) => (all.length < 2 ? all.join("") : `${all.slice(0, -1).join(", ")} ${say("and")} ${all.at(-1)}`);

  const [source = ""] = /\s*\([^)]*\)$/.exec(data.motions) ?? [];
  const motions = say("motions", { words: data.motions, motions: data.earthquakes.length, earthquakes: Math.max(...data.earthquakes) + 1, source });
  const nameOf = (request) => (request.name === data.texts.en.the_object ? say("the_object") : request.name);
  function linesOf(request, found) {
    const { measure, place, pedestal, statue } = request, { unit } = data.measures[measure];
    const name = nameOf(request);
    const ordinal = (n) => texts.ordinals[n] ?? `${n}${texts.ordinal_endings[n % 100 > 10 && n % 100 < 14 ? 0 : n % 10] ?? texts.ordinal_endings[0]}`;
    const floorName = place.level === place.storeys ? say("roof") : say("floor_name", { europe: ordinal(place.level), america: ordinal(place.level + 1) });
    const where = place.storeys ? `${say(place.label ? "on_named" : "on_level", place)} (${floorName})` : say(data.onFloor ? "on_floor" : "on_ground");
    const amount = (value) => `${measure} ${g(value, 3)} ${unit}`;
    const starts = Number.isFinite(found.rocksFrom) ? `${measure} ${g(found.rocksFrom, 2)} ${unit}` : say("more_than_tried");
    const at = say("at", { level: amount(found.level) }) + (request.level === null ? ` (${say("once_in_475")})` : "");
    const { fraction, rocking, counts, probability } = found, main = probability ?? fraction;
    const value = fraction?.value ?? found.value;

    function counted(what) {
      const [total, ...each] = counts ?? [data.earthquakes.length, 0, 0], number = each[what];
      const verb = (many) => say(`${what ? "topple" : "rock"}_${many ? "many" : "one"}`);
      if (!(what ? found.value : found.rockingValue)) return say("none_of", { total, verb: verb(false) });
      if (!counts) return say("of_the_motions", { value: percent(what ? found.value : found.rockingValue), verb: verb(true) });
      if (number === total) return say("all_of", { total, verb: verb(true) });
      return say(number === 1 ? "one_of" : "some_of", { number, total, verb: verb(number !== 1) });
    }
    function narrowing(better = found.narrowed, of = main) {
      if (!better || range(better) === range(of)) return "";
      return say("narrowing", { what: listed(better.known.map((key) => texts.measurements[key])), range: range(better) });
    }
    function result() {
      const who = `${capital(name)} ${where}`;
      if (found.rockingValue === 0) {
        if (!rocking) return `${who} ${say("not_expected_yet", { at })}`;
        if (rocking.upper === 0) return `${who} ${say("does_not_move", { at, starts })}`;
        const limit = say("limit_of_toppling", { limit: percent(fraction.upper) });
        if (found.rocksFrom > found.level) return `${who} ${say("not_expected_to_move", { at, starts, limit })}`;
        return `${who} ${say("not_expected_counted", { at, counted: counted(0), limit })}`;
      }
      const said = say("said", { topples: counted(1), interval: interval(fraction), rocks: counted(0) });
      if (fraction && found.wide) {
        const better = narrowing(found.narrowedFraction, fraction), more = better ? ` ${capital(better)}.` : "";
        return say("not_decidable", { name, where, at, said }) + more;
      }
      const may = value >= MANY ? "likely" : value === 0 ? "unlikely" : "may";
      return `${who} ${say(may)} ${at}: ${said}`;
    }
    function stepOf(p) {
      const inFifty = -Math.expm1(50 * (Math.log1p(-Math.min(p, 1 - 1e-15)) / found.years));
      return steps.findIndex(({ below }) => inFifty < (below ?? Infinity));
    }
    function risk() {
      if (found.probabilityValue === null) return say("no_hazard");
      if (!probability) return say("topples_with", { value: percent(found.probabilityValue), years: found.years, interval: "" }) + ".";
      const worst = stepOf(probability.upper), best = stepOf(probability.lower), middle = probability.value === 0 ? worst : stepOf(probability.value);
      const names = texts.steps, first = probability.value === 0
        ? say("none_topples", { years: found.years, limit: percent(probability.upper) })
        : say("topples_with", { value: percent(probability.value), years: found.years, interval: interval(probability) });
      const step = probability.value === 0 ? say("at_most", { step: names[worst] })
        : best === worst ? names[middle] : say("reaches", { step: names[middle], best: names[best], worst: names[worst] });
      return `${first}. ${say("on_our_scale", { step, scale: texts.scale })} ${texts.advice[middle]} ${say("all_shaking", { level: amount(found.level) })}`;
    }
    function inSpaceWords() {
      const what = say(request.solid.round ? "rolls_in_space" : "moves_in_space");
      return typeof found.planar === "number" ? `${what}${say("beside_planar", { value: found.planar === 0 ? say("none_of_motions") : percent(found.planar) })}` : `${what}.`;
    }
    function position() {
      const plane = request.solid ? inSpaceWords() : say("plane", { width: g(100 * statue.width, 4) }) + " " + say("any_direction");
      if (!pedestal || found.arrangements.length < 3) return plane;
      const shown = (v) => (v === 0 ? say("none_of_motions") : percent(v));
      const ranked = [...found.arrangements].sort((a, b) => a[1] - b[1]), all = ranked.map(([id, v]) => `${say(id)} ${shown(v)}`).join(", ");
      if (new Set(ranked.map(([, v]) => v)).size === 1) return `${say("equally_safe", { all })} ${plane}`;
      return `${say("safest", { where: say(ranked[0][0]), all })} ${plane}`;
    }
    function mitigation(item) {
      const what = say(`help_${item.name}`, Object.fromEntries(Object.entries(item.values).map(([key, v]) => [key, g(v, 3)])));
      if (Number.isNaN(item.factor)) return `${what}: ${percent(item.value)}`;
      if (item.factor === 0) return say("leaves_none", { what });
      const change = 100 * (1 - item.factor);
      if (change < 0) return say("makes_larger", { what, times: g(item.factor, 2) });
      const ends = [item.lower, item.upper].map((f) => 100 * (1 - f)).sort((a, b) => a - b);
      const limits = Number.isFinite(item.lower) ? ` (${say("range", { low: whole(ends[0]), high: whole(ends[1]) })})`.replaceAll("-", "−") : "";
      return say("reduces", { what, value: whole(change), limits });
    }
    function helps() {
      if (!main) return "";
      if (main.value === 0) return say(found.wide ? "none_can_show" : "no_change_needed");
      if (found.mitigations.length && found.mitigations.every(({ factor, helps: better }) => Number.isNaN(factor) && !better)) return say("too_few");
      const best = found.mitigations.filter((item) => item.helps).slice(0, 3);
      return best.length ? `${capital(best.map(mitigation).join("; "))}.` : say("none_helps");
    }
    function sure() {
      if (!main) return "";
      const records = request.solid && data.both.records.length;
      const total = Object.values(main.sources).reduce((sum, s) => sum + s * s, 0), lines = [`${records ? say("motions_in_space", { motions, records }) : motions}.`];
      const ranked = Number.isFinite(total) && total > 0 ? Object.entries(main.sources).map(([key, s]) => [key, (s * s) / total]).sort((a, b) => b[1] - a[1]) : [];
      const named = ranked.filter(([, part]) => part >= LEAST_PART).slice(0, MOST_SOURCES);
      if (named.length) lines.push(say("variance", { all: listed(named.map(([key, part]) => say("part_from", { part: whole(100 * part), what: texts.sources[key] }))) }));
      if (narrowing() && !(found.wide && main === fraction)) lines.push(`${capital(narrowing())}.`);
      const size = (keys) => keys.reduce((sum, key) => sum + (main.sources[key] ?? 0) ** 2, 0);
      const assumed = assumptions(request).map(([id, values, keys]) => [say(id, values), size(keys)]);
      const order = assumed.map((item, i) => [...item, i]).sort((a, b) => b[1] - a[1] || a[2] - b[2]).map(([text]) => text);
      const rest = order.length - MOST_ASSUMPTIONS;
      lines.push(say("assumed", { all: order.slice(0, MOST_ASSUMPTIONS).join(", "), rest: rest > 0 ? say(rest > 1 ? "more_assumptions" : "more_assumption", { rest }) : "" }));
      return lines.join(" ");
    }
    function headline() {
      const values = { name: capital(name), at: say("at", { level: amount(found.level) }) };
      if (rocking?.upper === 0) return say("head_does_not_move", values);
      if (found.rockingValue === 0) return say("head_not_expected", values);
      if (fraction && found.wide) return say("head_open", values);
      return say(value >= MANY ? "head_likely" : value > FEW ? "head_may" : "head_unlikely", values);
    }
    return { headline: headline(), result: result(), risk: risk(), position: position(), helps: helps(), sure: sure(), mitigation };
  }
  return Object.assign(linesOf, { nameOf, motions });

  // what was not given: text, what stands in it, and the sources that it widens; the place first
  function assumptions({ place, statue, pedestal, massGiven, restitution, solid, depthGiven }) {
    const found = [];
    if (place.assumed === "on_ground") found.push(["assumed_ground", {}, []]);
    if (place.assumed === "elastic") found.push(["assumed_elastic", {}, ["period", "damping"]]);
    if (place.assumed === "building") found.push(["assumed_building", { total: g(place.total, 3), period: g(place.period, 2) }, ["period", "damping"]]);
    found.push([solid?.round ? "assumed_rolling" : "assumed_rectangular", {}, []]);
    if (restitution === null && !solid?.round) found.push(["assumed_momentum", {}, ["restitution"]]);
    if (!depthGiven && !solid) found.push(["assumed_depth", { depth: g(100 * statue.width, 4) }, []]);
    if (!massGiven) found.push(["assumed_mass", { mass: g(statue.mass, 3) }, ["mass"]]);
    if (statue.cgHeight === null) found.push(["assumed_half", {}, ["cg_height"]]);
    if (pedestal && !pedestal.massGiven) found.push(["assumed_pedestal", { mass: g(pedestal.mass, 3) }, ["mass"]]);
    return found;
  }
};
if (typeof module !== "undefined") module.exports = words;
