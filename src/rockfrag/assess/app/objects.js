/* From what was typed to bodies: sizes, what stands on what, what is not known to the digit, and what helps. */
const objects = (data) => {
  "use strict";
  const { units, constants } = data;
  const {
    STONE, DEPTHS, DENSITIES, WIDER, PLATE, STEEL, LOWER, BALLAST, BALLAST_AT, PEDESTAL_HEIGHT, PERIOD_FACTORS, STOREY_HEIGHT,
    STOREY_MASS, HIGHEST_BUILDING, DAMPING, TOLERANCES, PLACE_TOLERANCES, KNOWN_PERIOD, LONGEST_PERIOD,
  } = constants;

  // a refusal: the field it is about, and the sentence of the table with what stands in it
  class Refusal extends Error {
    constructor(field, id, values = {}) {
      super(`${field}: ${id}`);
      Object.assign(this, { field, id, values });
    }
  }
  const refuse = (field, id, values) => { throw new Refusal(field, id, values); };

  // ---- what was typed

  const NUMBER = /^\s*([-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$/s;
  const plain = (unit) => unit.replaceAll("²", "2").replaceAll("^", "").split(/[\s·*_/]+/).join("_");

  // a number with its unit in SI; null where nothing stands
  function quantity(field, text, dimension) {
    if (!text?.trim()) return null;
    const example = units.examples[dimension], found = NUMBER.exec(text);
    const value = found ? Number(found[1].replace(",", ".")) : NaN;
    if (!Number.isFinite(value)) refuse(field, "no_number", { text: short(text), example });
    const unit = units.dimensions[dimension][plain(found[2])];
    if (!unit) {
      refuse(field, found[2] ? "no_unit" : "unit_missing", { text: short(text), example, known: units.known[dimension] });
    }
    return (value * unit[0]) / unit[1];
  }
  const short = (text) => String(text).trim().slice(0, 60);
  function positive(field, text, dimension) {
    const value = quantity(field, text, dimension);
    if (value !== null && !(value > 0)) refuse(field, "not_above_zero", { text: short(text) });
    return value;
  }
  function number(field, text, id, low, high) {
    if (!text?.trim()) return null;
    const found = NUMBER.exec(text), value = found && /^[a-z]*$/i.test(found[2]) ? Number(found[1].replace(",", ".")) : NaN;
    if (!(value > low && value <= high)) refuse(field, id, { text: short(text), low, high });
    return value;
  }

  // the form's texts, by field, as a request in SI
  function requestOf(form) {
    const round = Boolean(form.round), side = positive("width", form.width, "length"), height = positive("height", form.height, "length");
    if (side === null) refuse("width", "missing", { example: "35 cm" });
    if (height === null) refuse("height", "missing", { example: "1.2 m" });
    const mass = positive("mass", form.mass, "mass"), cgHeight = positive("cg_height", form.cg_height, "length");
    if (cgHeight !== null && cgHeight >= height) refuse("cg_height", "above_top");
    const cgOffset = quantity("cg_offset", form.cg_offset, "length") ?? 0;
    const { width, depth, facing, narrower = false } = planOfBase(form, side, round), [low, high] = DENSITIES;
    const statue = { width, height, mass: mass ?? STONE * width * depth * height * (round ? Math.PI / 4 : 1), cgHeight, cgOffset };
    checkDensity("mass", statue);
    const density = statue.mass / (width * depth * height);
    if (form.depth?.trim() && !(density >= low && density <= high)) refuse("mass", "density");
    if (round) statue.inertia = (statue.mass * (0.75 * width * width + height * height)) / 12;
    const restitution = number("restitution", form.restitution, "restitution", 0, 1);
    if (round && restitution !== null) refuse("restitution", "rolls");
    const deep = Boolean(form.depth?.trim()) && !round && restitution === null && data.both.records.length > 0;
    if (!deep && form.facing?.trim()) refuse("facing", "facing_in_plane");
    if (deep) statue.depth = depth;
    let pedestal = null;
    if (form.pedestal_width?.trim() || form.pedestal_height?.trim()) {
      const wide = positive("pedestal_width", form.pedestal_width, "length"), high = positive("pedestal_height", form.pedestal_height, "length");
      if (wide === null) refuse("pedestal_width", "missing", { example: "50 cm" });
      if (high === null) refuse("pedestal_height", "missing", { example: "90 cm" });
      const heavy = positive("pedestal_mass", form.pedestal_mass, "mass");
      pedestal = { width: wide, height: high, mass: heavy ?? STONE * wide * wide * high, massGiven: heavy !== null };
      checkDensity("pedestal_mass", pedestal);
    } else if (form.pedestal_mass?.trim()) refuse("pedestal_width", "missing", { example: "50 cm" });
    return {
      name: short(form.name ?? "") || data.texts.en.the_object, statue, narrower, pedestal, massGiven: mass !== null, depthGiven: Boolean(form.depth?.trim()), restitution,
      solid: round || deep ? { round, facing, anywhere: !form.facing?.trim() } : null, place: placeOf(form), ...shakingOf(form),
    };
  }
  // the narrower side of the base, the other one, and the direction of the narrower one [degrees]
  function planOfBase(form, width, round) {
    const depth = positive("depth", form.depth, "length"), facing = number("facing", form.facing, "facing", -1e-300, 360);
    if (round && depth !== null && depth !== width) refuse("depth", "round_depth");
    if (facing !== null && (round || depth === null)) refuse("facing", "no_facing");
    if (depth === null || !(depth < width)) return { width, depth: depth ?? width, facing: facing ?? 0 };
    return { width: depth, depth: width, facing: (facing ?? 0) + 90, narrower: true };
  }
  function checkDensity(field, { width, height, mass }) {
    const most = mass / (width * height * DEPTHS[0] * width), least = mass / (width * height * DEPTHS[1] * Math.max(width, height));
    if (!(most >= DENSITIES[0] && least <= DENSITIES[1])) refuse(field, "density");
  }

  function shakingOf(form) {
    const measure = data.measures[form.measure] ? form.measure : "PGA", { highest } = data.measures[measure];
    const level = quantity("level", form.level, measure === "PGV" ? "velocity" : "acceleration");
    const value = level === null ? null : measure === "PGV" ? level * 100 : level / constants.GRAVITY;
    if (value !== null && !(value > 0 && value <= highest)) refuse("level", "level", { highest, unit: data.measures[measure].unit });
    const years = number("years", form.years, "years", 0, LONGEST_PERIOD), curve = curveOf(form.hazard, measure);
    if (curve && years !== null) refuse("years", "both_hazards");
    if (years !== null && value === null) refuse("level", "level_missing");
    if (value === null && !curve) refuse("level", "level_missing");
    return { measure, level: value, years, curve };
  }

  // pasted lines of a level and its annual rate, return period (above 1) or as the heading says
  function curveOf(text, measure) {
    if (!text?.trim()) return null;
    if (text.length > 20000) refuse("hazard", "hazard_long");
    const lines = text.trim().split(/\r?\n/).map((line) => line.trim()).filter((line) => line && !line.startsWith("#"));
    const cells = (line) => line.split(/[;\t]+|\s+|,(?=\s)|(?<=\.\d+),|,(?=\d*\.)/).filter(Boolean);
    const heading = /[a-df-zA-DF-Z]/.test(lines[0]) ? lines.shift().toLowerCase() : "";
    const told = /return|tr\b|anni|periodo/.test(heading) ? (v) => 1 / v : /poe/.test(heading) ? poe(heading) : (v) => v;
    const rows = lines.map((line, i) => {
      const row = cells(line).map((cell) => (/^[-+\d.,eE]+$/.test(cell) ? Number(cell.replace(",", ".")) : NaN));
      if (row.length !== 2 || !row.every(Number.isFinite)) refuse("hazard", "hazard_line", { line: i + 1 + (heading ? 1 : 0), text: short(line) });
      return [row[0], told(row[1])];
    }).sort((a, b) => a[0] - b[0]).filter(([, rate], i, all) => rate > 0 && !(all[i + 1]?.[1] === rate));
    const { highest, damaging } = data.measures[measure];
    if (rows.length < 2) refuse("hazard", "hazard_few");
    rows.forEach(([level, rate], i) => {
      if (!(level > 0 && rate <= 100) || (i && !(level > rows[i - 1][0] && rate < rows[i - 1][1]))) refuse("hazard", "hazard_order", { line: i + 1 });
    });
    if (!(rows.at(-1)[0] <= highest && rows.at(-1)[0] >= damaging)) refuse("hazard", "hazard_unit", { highest, damaging, unit: data.measures[measure].unit });
    return { levels: rows.map((row) => row[0]), rates: rows.map((row) => row[1]), quantiles: text === data.form?.hazard && measure === data.form.measure ? data.quantiles : [] };
  }
  const poe = (heading) => {
    const years = Number(/poe_?(\d+)/.exec(heading)?.[1] ?? 50);
    return (p) => (p >= 0 && p < 1 ? -Math.log1p(-p) / years : NaN);
  };

  // a floor whose modes stand in the page, as the building is and with each property moved
  function tabled(known, at) {
    const floors = Object.fromEntries(at.level === 0 ? [] : Object.entries(known).map(([name, modes]) => [name, { modes, level: at.level }]));
    return { assumed: "building", ...at, ground: at.level === 0, floors };
  }
  const BUILDING = ["storey_height", "material", "period"];
  function placeOf(form) {
    if (data.onFloor || !form.floor?.trim()) {
      if (form.storey_height?.trim() || form.period?.trim()) refuse("floor", "missing", { example: "2/4" });
      return { ground: true, key: "", floors: {}, assumed: data.onFloor ? "" : "on_ground" };
    }
    const { own } = data, found = /^\s*(\d{1,3})\s*\/\s*(\d{1,3})\s*$/.exec(form.floor);
    const label = own?.levels[form.floor.trim()] === undefined ? "" : form.floor.trim();
    const [level, storeys] = label ? [own.levels[label], own.storeys] : found ? [Number(found[1]), Number(found[2])] : [1, 0];
    if (!(level <= storeys && storeys >= 1 && storeys <= HIGHEST_BUILDING)) refuse("floor", "floor", { most: HIGHEST_BUILDING, text: short(form.floor) });
    if (own && (own.whole || (storeys === own.storeys && BUILDING.every((name) => (form[name] ?? "") === (data.form[name] ?? (name === "material" ? "masonry" : "")))))) {
      if (storeys !== own.storeys || level > storeys) refuse("floor", "own_floor", { storeys: own.storeys, labels: Object.keys(own.levels).join(", "), text: short(form.floor) });
      return tabled(own.modes, { level, storeys, label: found ? "" : label, total: own.total, period: own.period, key: `own ${level}`, assumed: own.whole ? "elastic" : "building" });
    }
    const each = positive("storey_height", form.storey_height, "length"), given = positive("period", form.period, "time");
    const heights = new Array(storeys).fill(each ?? STOREY_HEIGHT), total = heights.reduce((a, b) => a + b, 0);
    if (!(heights[0] >= data.limits.storey[0] && heights[0] <= data.limits.storey[1])) refuse("storey_height", "storey");
    const material = PERIOD_FACTORS[form.material] ? form.material : "masonry";
    const period = given ?? PERIOD_FACTORS[material] * total ** 0.75;
    if (!(period >= data.limits.period[0] && period <= data.limits.period[1])) refuse("period", "period");
    const known = each === null && given === null && material === "masonry" ? data.floors?.[storeys] : null;
    if (known) return tabled(known, { level, storeys, total, period, key: `${level}/${storeys}` });
    const masses = heights.map(() => STOREY_MASS), stiffnesses = building.stiffnessesFor(masses, heights, period);
    const at = { masses, stiffnesses, damping: DAMPING, level };
    const slower = (factor) => ({ ...at, stiffnesses: stiffnesses.map((k) => k / factor ** 2) });
    const spread = { ...PLACE_TOLERANCES, ...(given === null ? {} : { period: KNOWN_PERIOD }) };
    const floors = level === 0 ? {} : {
      "": at, "period-": slower(1 - spread.period), "period+": slower(1 + spread.period),
      "damping-": { ...at, damping: DAMPING * (1 - spread.damping) }, "damping+": { ...at, damping: DAMPING * (1 + spread.damping) },
    };
    return { ground: level === 0, level, storeys, floors, key: JSON.stringify(at), assumed: "building", total, period, computed: level > 0 };
  }

  // ---- bodies

  const three = (value) => ({ number: value, form: "three" });
  const inertiaOf = (block) => block.inertia ?? (block.mass * (block.width * block.width + block.height * block.height)) / 12;
  const heightOf = (block) => block.cgHeight ?? block.height / 2;
  const wider = (block, factor) => ({ ...block, width: block.width * factor, inertia: inertiaOf(block), ...(block.depth ? { depth: block.depth * factor } : {}) });
  const higher = (block, factor) => ({ ...block, cgHeight: Math.min(heightOf(block) * factor, block.height), inertia: inertiaOf(block) });

  // what is shaken: roles, and bodies as the module takes them; the object as it stands first
  function planOf(request, ensemble) {
    const { statue, pedestal, restitution: measured, place } = request;
    const body = (top, below = pedestal, restitution_factor = 1) => ({ statue: top, pedestal: below, measured, restitution_factor });
    const joined = (top, below) => {
      const { centre: [x, y, inertia] } = ensemble.bodyOf({ statue: top, pedestal: below });
      return { width: below.width, height: below.height + top.height, mass: below.mass + top.mass, inertia, cgHeight: y, cgOffset: x };
    };
    const held = { to_pedestal: () => body(joined(statue, pedestal), null), to_floor: () => body(statue, null) }[pedestal && request.fixed];
    const moving = (runs) => (request.solid ? inSpace(data).planOf(request, runs) : runs);
    if (held) return moving([{ role: "now", body: held() }]);
    stands(body(statue), ensemble);
    if (measured !== null && measured > ensemble.bodyOf(body(statue)).largest) refuse("restitution", "gains_energy");
    const runs = [{ role: "now", body: body(statue) }];
    const move = (name, make) => {
      const s = TOLERANCES[name];
      for (const factor of [1 - s, 1 + s]) runs.push({ role: "moved", name, few: true, body: make(factor) });
    };
    move("width", (f) => body(wider(statue, f), pedestal && wider(pedestal, f)));
    move("cg_height", (f) => body(higher(statue, f)));
    move("restitution", (f) => body(statue, pedestal, f));
    if (pedestal) move("mass", (f) => body({ ...statue, mass: statue.mass * f, inertia: inertiaOf(statue) * f }));
    for (const floor of Object.keys(place.floors).filter(Boolean))
      runs.push({ role: "moved", name: floor.slice(0, -1), few: true, floor, body: body(statue) });
    if (pedestal) {
      runs.push({ role: "arrangement", name: "fixed_to_its_pedestal", change: "fix_object", values: {}, body: body(joined(statue, pedestal), null) });
      runs.push({ role: "arrangement", name: "on_the_floor", change: "fix_pedestal", values: {}, body: body(statue, null) });
    }
    const helps = (name, what, values = {}) => runs.push({ role: "mitigation", change: name, body: what, values });
    const onPlate = (block) => joined(block, { width: WIDER * block.width, height: PLATE, mass: STEEL * PLATE * (WIDER * block.width) ** 2 });
    const plate = (block) => ({ width: three(100 * WIDER * block.width), thick: three(100 * PLATE) });
    if (!pedestal) helps("plate_under_it", body(onPlate(statue)), plate(statue));
    else {
      helps("plate_under_pedestal", body(statue, onPlate(pedestal)), plate(pedestal));
      if (WIDER * statue.width <= pedestal.width) helps("plate_under_object", body(onPlate(statue)), plate(statue));
    }
    helps("lower_centre", body(higher(statue, LOWER)), { part: { number: 1 - LOWER, form: "percent" } });
    helps("ballast", body(withBallast(statue)), { part: { number: BALLAST, form: "percent" } });
    if (pedestal) {
      const half = { ...pedestal, height: PEDESTAL_HEIGHT * pedestal.height, mass: PEDESTAL_HEIGHT * pedestal.mass };
      helps("lower_pedestal", body(statue, half), { height: three(100 * half.height) });
    }
    for (const { body: each } of runs) stands(each, ensemble);
    return moving(runs);
  }
  // what cannot stand is said beside the width
  function stands(body, ensemble) {
    try {
      ensemble.bodyOf(body);
    } catch ({ message }) {
      refuse("width", `fault_${ROCKFRAG_FAULTS.indexOf(message)}`);
    }
  }
  function withBallast(block, part = BALLAST) {
    const added = part * block.mass, mass = block.mass + added, at = BALLAST_AT * block.height, h = heightOf(block);
    const cgHeight = (block.mass * h + added * at) / mass, cgOffset = (block.mass * block.cgOffset) / mass;
    const own = block.mass * ((h - cgHeight) ** 2 + (block.cgOffset - cgOffset) ** 2);
    const inertia = inertiaOf(block) + own + added * ((at - cgHeight) ** 2 + cgOffset ** 2);
    return { ...block, mass, cgHeight, cgOffset, inertia };
  }
  // the object with a wider foot, a lower centre of gravity and ballast of a part of its mass in its foot
  function changed(statue, { wider: foot, lower, ballast }) {
    const heavier = ballast ? withBallast(statue, ballast) : statue;
    return higher(wider(heavier, foot), lower);
  }
  return { requestOf, planOf, changed };
};
if (typeof module !== "undefined") module.exports = objects;
