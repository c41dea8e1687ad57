/* The form: what was typed, as a request in SI, or a refusal beside its field. */
const objects = (data, core) => {
  "use strict";
  const { units, constants } = data;
  const {
    DEPTHS,
    DENSITIES,
    PERIOD_FACTORS,
    STOREY_HEIGHT,
    HIGHEST_BUILDING,
    VARIANTS,
    LONGEST_PERIOD,
  } = constants;

  // a refusal: the field it is about, and the sentence of the table with what stands in
  // it
  class Refusal extends Error {
    constructor(field, id, values = {}) {
      super(`${field}: ${id}`);
      Object.assign(this, { field, id, values });
    }
  }
  const refuse = (field, id, values) => {
    throw new Refusal(field, id, values);
  };

  // ---- what was typed

  const NUMBER = /^\s*([-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*$/s;
  const plain = (unit) =>
    unit
      .replaceAll("²", "2")
      .replaceAll("^", "")
      .split(/[\s·*_/]+/)
      .join("_");

  // a number with its unit in SI; null where nothing stands
  function quantity(field, text, dimension) {
    if (!text?.trim()) return null;
    const example = units.examples[dimension];
    const found = NUMBER.exec(text);
    const value = found ? Number(found[1].replace(",", ".")) : NaN;
    if (!Number.isFinite(value))
      refuse(field, "no_number", { text: short(text), example });
    const unit = units.dimensions[dimension][plain(found[2])];
    if (!unit) {
      refuse(field, found[2] ? "no_unit" : "unit_missing", {
        text: short(text),
        example,
        known: units.known[dimension],
      });
    }
    return (value * unit[0]) / unit[1];
  }
  const short = (text) => String(text).trim().slice(0, 60);
  function positive(field, text, dimension) {
    const value = quantity(field, text, dimension);
    if (value !== null && !(value > 0))
      refuse(field, "not_above_zero", { text: short(text) });
    return value;
  }
  function number(field, text, id, low, high) {
    if (!text?.trim()) return null;
    const found = NUMBER.exec(text);
    const value =
      found && /^[a-z]*$/i.test(found[2]) ? Number(found[1].replace(",", ".")) : NaN;
    if (!(value > low && value <= high))
      refuse(field, id, { text: short(text), low, high });
    return value;
  }

  // what stands in the fields, each as the schema has it; null where nothing does
  const READ = {
    quantity: ({ name, dimension, positive: above }, text) =>
      (above ? positive : quantity)(name, text, dimension),
    number: ({ name, limits: [low, high] }, text) =>
      number(name, text, name, low, high),
    flag: (_, text) => Boolean(text),
  };
  const givenIn = (form) =>
    Object.fromEntries(
      data.fields.map((field) => [
        field.name,
        READ[field.kind]?.(field, form[field.name]) ?? null,
      ]),
    );

  // a block after functions of the core in turn
  const { change } = inSpace(data, core);
  const stepped = (block, steps) =>
    steps.reduce((made, [name, numbers]) => change(name, made, ...numbers), block);

  // a kind of standing that is asked for by a word; null where its sizes say all
  function kindOf({ stands }) {
    if (!stands) return null;
    return data.kinds[stands] ?? refuse("stands", "kind");
  }

  // the form's texts, by field, as a request in SI
  function requestOf(form) {
    const given = givenIn(form);
    const { round, height, mass, cg_height: cgHeight, restitution } = given;
    if (given.width === null) refuse("width", "missing", { example: "35 cm" });
    if (height === null) refuse("height", "missing", { example: "1.2 m" });
    if (cgHeight !== null && cgHeight >= height) refuse("cg_height", "above_top");
    const { width, depth, facing, narrower = false } = planOfBase(given);
    const [low, high] = DENSITIES;
    const statue = {
      width,
      height,
      mass: mass ?? core.call("solid_mass", width, depth, height, Boolean(round)),
      cgHeight,
      cgOffset: given.cg_offset ?? 0,
    };
    checkDensity("mass", statue);
    const density = statue.mass / (width * depth * height);
    if (given.depth !== null && !(density >= low && density <= high))
      refuse("mass", "density");
    if (round) statue.inertia = core.call("round_inertia", width, height, statue.mass);
    if (round && restitution !== null) refuse("restitution", "rolls");
    const kind = kindOf(form);
    if (kind && round) refuse("stands", "kind");
    const deep =
      given.depth !== null &&
      !round &&
      !kind &&
      restitution === null &&
      data.both.records.length > 0;
    if (!deep && given.facing !== null) refuse("facing", "facing_in_plane");
    if (deep) statue.depth = depth;
    return {
      name: short(form.name ?? "") || data.texts.en.the_object,
      kind,
      sizes: statue,
      statue: kind ? stepped(statue, kind.steps) : statue,
      narrower,
      pedestal: pedestalOf(given),
      massGiven: mass !== null,
      depthGiven: given.depth !== null,
      restitution,
      solid: round || deep ? { round, facing, anywhere: given.facing === null } : null,
      place: placeOf(form, given),
      ...shakingOf(form),
    };
  }
  function pedestalOf({
    pedestal_width: width,
    pedestal_height: height,
    pedestal_mass: mass,
  }) {
    if ([width, height, mass].every((each) => each === null)) return null;
    if (width === null) refuse("pedestal_width", "missing", { example: "50 cm" });
    if (height === null) refuse("pedestal_height", "missing", { example: "90 cm" });
    const pedestal = {
      width,
      height,
      mass: mass ?? core.call("solid_mass", width, width, height, false),
      massGiven: mass !== null,
    };
    checkDensity("pedestal_mass", pedestal);
    return pedestal;
  }
  // the narrower side of the base, the other one, and the direction of the narrower one
  // [degrees]
  function planOfBase({ width, depth, facing, round }) {
    if (round && depth !== null && depth !== width) refuse("depth", "round_depth");
    if (facing !== null && (round || depth === null)) refuse("facing", "no_facing");
    if (depth === null || !(depth < width))
      return { width, depth: depth ?? width, facing: facing ?? 0 };
    return { width: depth, depth: width, facing: (facing ?? 0) + 90, narrower: true };
  }
  function checkDensity(field, { width, height, mass }) {
    const most = mass / (width * height * DEPTHS[0] * width);
    const least = mass / (width * height * DEPTHS[1] * Math.max(width, height));
    if (!(most >= DENSITIES[0] && least <= DENSITIES[1])) refuse(field, "density");
  }

  function shakingOf(form) {
    const measure = data.measures[form.measure] ? form.measure : "PGA";
    const { highest } = data.measures[measure];
    const value = levelOf(form.level, measure);
    if (value !== null && !(value > 0 && value <= highest))
      refuse("level", "level", { highest, unit: data.measures[measure].unit });
    const years = number("years", form.years, "years", 0, LONGEST_PERIOD);
    const curve = curveOf(form.hazard, measure);
    if (curve && years !== null) refuse("years", "both_hazards");
    if (years !== null && value === null) refuse("level", "level_missing");
    if (value === null && !curve) refuse("level", "level_missing");
    return { measure, level: value, years, curve };
  }

  // a level in the unit of its measure: cm/s or g
  function levelOf(text, measure) {
    const isVelocity = measure === "PGV";
    const level = quantity("level", text, isVelocity ? "velocity" : "acceleration");
    if (level === null) return null;
    return isVelocity ? level * 100 : level / constants.GRAVITY;
  }

  // pasted lines of a level and its annual rate, return period (above 1) or as the
  // heading says
  function curveOf(text, measure) {
    if (!text?.trim()) return null;
    if (text.length > 20000) refuse("hazard", "hazard_long");
    const lines = text
      .trim()
      .split(/\r?\n/)
      .map((line) => line.trim())
      .filter((line) => line && !line.startsWith("#"));
    const cells = (line) =>
      line.split(/[;\t]+|\s+|,(?=\s)|(?<=\.\d+),|,(?=\d*\.)/).filter(Boolean);
    const heading = /[a-df-zA-DF-Z]/.test(lines[0]) ? lines.shift().toLowerCase() : "";
    const rateOf = rateBelow(heading);
    const rows = lines
      .map((line, i) => {
        const row = cells(line).map((cell) =>
          /^[-+\d.,eE]+$/.test(cell) ? Number(cell.replace(",", ".")) : NaN,
        );
        if (row.length !== 2 || !row.every(Number.isFinite))
          refuse("hazard", "hazard_line", {
            line: i + 1 + (heading ? 1 : 0),
            text: short(line),
          });
        return [row[0], rateOf(row[1])];
      })
      .sort((a, b) => a[0] - b[0])
      .filter(([, rate], i, all) => rate > 0 && !(all[i + 1]?.[1] === rate));
    const { highest, damaging } = data.measures[measure];
    if (rows.length < 2) refuse("hazard", "hazard_few");
    rows.forEach(([level, rate], i) => {
      if (
        !(level > 0 && rate <= 100) ||
        (i && !(level > rows[i - 1][0] && rate < rows[i - 1][1]))
      )
        refuse("hazard", "hazard_order", { line: i + 1 });
    });
    if (!(rows.at(-1)[0] <= highest && rows.at(-1)[0] >= damaging))
      refuse("hazard", "hazard_unit", {
        highest,
        damaging,
        unit: data.measures[measure].unit,
      });
    return {
      levels: rows.map((row) => row[0]),
      rates: rows.map((row) => row[1]),
      quantiles:
        text === data.form?.hazard && measure === data.form.measure
          ? data.quantiles
          : [],
    };
  }
  // the annual rate of what stands under a heading: a rate, a return period or a
  // probability in some years
  function rateBelow(heading) {
    if (/return|tr\b|anni|periodo/.test(heading)) return (period) => 1 / period;
    if (!/poe/.test(heading)) return (rate) => rate;
    const years = Number(/poe_?(\d+)/.exec(heading)?.[1] ?? 50);
    return (p) => (p >= 0 && p < 1 ? core.call("rate_of", p, years) : NaN);
  }

  // a floor, as the building is and with each property moved
  const floorsOf = (level, named) =>
    level === 0
      ? {}
      : Object.fromEntries(
          Object.entries(named).map(([name, about]) => [name, { ...about, level }]),
        );
  const BUILDING = ["storey_height", "material", "period"];
  function placeOf(form, { storey_height: each, period: given }) {
    if (data.onFloor || !form.floor?.trim()) {
      if (each !== null || given !== null)
        refuse("floor", "missing", { example: "2/4" });
      return {
        ground: true,
        key: "",
        floors: {},
        assumed: data.onFloor ? "" : "on_ground",
      };
    }
    const { own } = data;
    const found = /^\s*(\d{1,3})\s*\/\s*(\d{1,3})\s*$/.exec(form.floor);
    const label = own?.levels[form.floor.trim()] === undefined ? "" : form.floor.trim();
    const numbers = found ? [Number(found[1]), Number(found[2])] : [1, 0];
    const [level, storeys] = label ? [own.levels[label], own.storeys] : numbers;
    if (!(level <= storeys && storeys >= 1 && storeys <= HIGHEST_BUILDING))
      refuse("floor", "floor", { most: HIGHEST_BUILDING, text: short(form.floor) });
    if (
      own &&
      (own.whole ||
        (storeys === own.storeys &&
          BUILDING.every(
            (name) =>
              (form[name] ?? "") ===
              (data.form[name] ?? (name === "material" ? "masonry" : "")),
          )))
    ) {
      if (storeys !== own.storeys || level > storeys)
        refuse("floor", "own_floor", {
          storeys: own.storeys,
          labels: Object.keys(own.levels).join(", "),
          text: short(form.floor),
        });
      return {
        ground: level === 0,
        level,
        storeys,
        label: found ? "" : label,
        total: own.total,
        period: own.period,
        key: `own ${level}`,
        assumed: own.whole ? "elastic" : "building",
        floors: floorsOf(level, own.floors),
      };
    }
    const heights = new Array(storeys).fill(each ?? STOREY_HEIGHT);
    const total = heights.reduce((a, b) => a + b, 0);
    if (!(heights[0] >= data.limits.storey[0] && heights[0] <= data.limits.storey[1]))
      refuse("storey_height", "storey");
    const material = PERIOD_FACTORS[form.material] ? form.material : "masonry";
    const height = heights[0];
    const period = given ?? core.call("usual_period", PERIOD_FACTORS[material], total);
    if (!(period >= data.limits.period[0] && period <= data.limits.period[1]))
      refuse("period", "period");
    const sketched = { storeys, height, period };
    const moved = given === null ? VARIANTS.assumed : VARIANTS.known;
    const named = Object.entries(moved).map(([name, about]) => [
      name,
      { sketched, ...about },
    ]);
    return {
      ground: level === 0,
      level,
      storeys,
      total,
      period,
      key: JSON.stringify([level, sketched]),
      assumed: "building",
      floors: floorsOf(level, Object.fromEntries(named)),
    };
  }
  return { requestOf, refuse, stepped };
};
if (typeof module !== "undefined") module.exports = objects;
