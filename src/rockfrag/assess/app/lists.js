/* Objects as CSV and as statue.yaml: written by the page, and read again; nothing in
 * them is executed.
 */
const lists_ = (data, known) => {
  "use strict";
  const fields = known.map(({ name }) => name);
  const cell = (text) =>
    /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  // a sheet would take what begins so for a formula
  const guarded = (text) => (/^[-=+@\t\r]/.test(text) ? ` ${text}` : text);
  const csvOf = (forms) =>
    [
      fields.join(","),
      ...forms.map((form) =>
        fields.map((name) => cell(guarded(String(form[name] ?? "")))).join(","),
      ),
    ].join("\r\n") + "\r\n";
  const counted = (text, letter) => text.split(letter).length;
  // rows of cells; of a file that ends within quotation marks the row in which they
  // open is named
  function rowsOf(text, say) {
    const rows = [[""]];
    const [head] = text.split("\n", 1);
    const [separator] = [",", ";", "\t"].sort(
      (a, b) => counted(head, b) - counted(head, a),
    );
    let quoted = false;
    let opened = 0;
    for (let i = 0; i < text.length; i++) {
      const letter = text[i];
      const row = rows.at(-1);
      if (quoted && letter === '"' && text[i + 1] === '"')
        row[row.length - 1] += text[++i];
      else if (letter === '"') {
        quoted = !quoted;
        opened = rows.length;
      } else if (!quoted && letter === separator) row.push("");
      else if (!quoted && letter === "\n") rows.push([""]);
      else if (letter !== "\r" || quoted) row[row.length - 1] += letter;
    }
    if (quoted) throw new Error(say("file_open_quote", { row: opened }));
    return rows.filter((row) => row.some((text) => text.trim()));
  }
  const MOST_ROWS = 500;
  // keys of statue.yaml by the fields of the form; a level, its measure and a hazard
  // have fields of their own
  const KEYS = Object.fromEntries(known.map(({ name, key }) => [name, key]));
  const isFlag = Object.fromEntries(
    known.map(({ name, kind }) => [name, kind === "flag"]),
  );
  function yamlOf(form, say) {
    const typed = (name) => form[name] === true || form[name]?.trim?.();
    const own = known.filter(
      ({ name, key }) => key.length && name !== "years" && typed(name),
    );
    const number = own.filter(({ kind }) => kind === "number").map(({ name }) => name);
    const value = (name) => {
      if (form[name] === true) return "true";
      if (number.includes(name)) return point(form[name]);
      return JSON.stringify(point(form[name].trim()));
    };
    const at = (home) =>
      own.filter(
        ({ key }) =>
          key.length === 2 &&
          key[0] === home &&
          (home !== "building" || typed("floor")),
      );
    const lines = own
      .filter(({ key }) => key.length === 1)
      .map(({ name, key: [key] }) => `${key}: ${value(name)}`);
    for (const home of ["pedestal", "building"]) {
      const inner = at(home);
      if (inner.length)
        lines.push(
          `${home}:`,
          ...inner.map(({ name, key: [, key] }) => `  ${key}: ${value(name)}`),
        );
    }
    const period = /^SA\((.*)\)$/.exec(form.measure)?.[1];
    if (form.level?.trim())
      lines.push(
        period
          ? `sa: ["${period} s", ${value("level")}]`
          : `${form.measure === "PGV" ? "pgv" : "pga"}: ${value("level")}`,
      );
    if (form.years?.trim())
      lines.push(`return_period: ${JSON.stringify(form.years.trim())}`);
    if (data.own?.whole && form.floor?.trim())
      lines.push(`# ${say("building_beside")}`);
    if (form.hazard?.trim()) lines.push(`# ${say("hazard_beside")}`);
    return lines.join("\n") + "\n";
  }
  const point = (text) => text.replace(/^(\s*[-+]?\d+),(\d+)/, "$1.$2");
  function ofYaml(text, say) {
    const form = {};
    const unquoted = (value) => {
      // a comment begins with a # behind a blank; searched from there, in a time that
      // grows with the length
      const at = [...value.matchAll(/#/g)]
        .map(({ index }) => index)
        .find((index) => /\s/.test(value[index - 1] ?? ""));
      const plain = value.slice(0, at).trim();
      return /^".*"$/.test(plain) ? JSON.parse(plain) : plain.replace(/^'(.*)'$/, "$1");
    };
    let home = "";
    for (const line of text.split(/\r?\n/)) {
      if (!line.trim() || /^\s*#/.test(line)) continue;
      const found = /^(\s*)([a-z_]+):\s*(.*)$/.exec(line);
      if (!found) throw new Error(say("file_keys", { key: line.trim().slice(0, 40) }));
      const [, indent, key, value] = found;
      const spectral =
        key === "sa" && /^\["?([\d.]+) *s"?, *"?([^"\]]*)"?\]$/.exec(value);
      if (spectral)
        Object.assign(form, { measure: `SA(${spectral[1]})`, level: spectral[2] });
      if (spectral && data.measures[form.measure]) continue;
      if (!indent) home = value ? "" : key;
      if (!indent && !value) continue;
      const place = indent ? [home, key] : [key];
      const name =
        { pga: "level", pgv: "level", return_period_years: "years" }[place.join(".")] ??
        fields.find((own) => KEYS[own].join(".") === place.join("."));
      if (!name) throw new Error(say("file_keys", { key: key.slice(0, 40) }));
      form[name] = isFlag[name] ? unquoted(value) === "true" : String(unquoted(value));
      if (key === "pgv" || key === "pga") form.measure = key.toUpperCase();
    }
    // without a floor it stands on the ground
    return [{ floor: "", ...form }];
  }
  // a museum's table: a title, sides in columns such as Height (cm), and whatever else
  // it keeps
  const SIDES = /^(height|width|depth|diameter)[ _]*\(?(mm|cm|m|in|ft)\.?\)?$/i;
  const NAMES = ["title", "object name", "name", "titel", "titre"];
  const WORDS = /^(dimensions?|size|maße|abmessungen|afmetingen)$/i;
  function ofMuseum(titles, rows, say) {
    const sides = titles.map((title) => SIDES.exec(title));
    const at = (side) => sides.findIndex((found) => found?.[1].toLowerCase() === side);
    if (at("height") < 0) throw new Error(say("file_in_words"));
    const named = NAMES.map((name) =>
      titles.findIndex((title) => title.toLowerCase() === name),
    ).find((i) => i >= 0);
    const length = (row, side) =>
      at(side) >= 0 && row[at(side)]
        ? `${row[at(side)]} ${sides[at(side)][2].toLowerCase()}`
        : "";
    const forms = rows.map((row, i) => {
      const form = {
        name: row[named] || String(i + 1),
        width: length(row, "width") || length(row, "diameter"),
        height: length(row, "height"),
      };
      if (length(row, "depth")) form.depth = length(row, "depth");
      if (!length(row, "width") && length(row, "diameter")) form.round = "true";
      return form;
    });
    return { forms, unused: filled(titles, rows, (i) => i !== named && !sides[i]) };
  }
  // titles of columns of which some cell says something
  const filled = (titles, rows, isAsked) =>
    titles.filter((_, i) => isAsked(i) && rows.some((row) => row[i]));

  // an inventory as rockfrag assess reads it, and a list that the page saved: columns
  // are fields of the form, with units in the titles or in the cells
  function fieldOf(title) {
    if (fields.includes(title)) return { name: title, unit: "" };
    const quantities = known.filter(({ kind }) => kind === "quantity");
    for (const { name, dimension } of quantities)
      for (const unit of Object.keys(data.units.dimensions[dimension]))
        if (title === `${name}_${unit.toLowerCase()}`) return { name, unit };
    return null;
  }
  // columns that change nothing of what an object does
  const WITHOUT_EFFECT = ["value", "latitude", "longitude"];
  const ANSWERS = { yes: true, true: true, 1: true, x: true };
  Object.assign(ANSWERS, { no: false, false: false, 0: false });
  function ofInventory(titles, rows, say) {
    const columns = titles.map(fieldOf);
    const unknown = filled(titles, rows, (i) => !columns[i]);
    const lost = unknown.find((title) => !WITHOUT_EFFECT.includes(title));
    if (lost !== undefined)
      throw new Error(say("file_keys", { key: lost.slice(0, 40) }));
    const textOf = ({ name, unit }, text, row) => {
      if (!text) return "";
      if (isFlag[name]) return String(answerOf(name, text, row, say));
      return unit && /\d\s*$/.test(text) ? `${text} ${unit}` : text;
    };
    const forms = rows.map((row, k) => {
      const form = {};
      columns.forEach((column, i) => {
        if (column) form[column.name] = textOf(column, row[i], k + 2);
      });
      return form;
    });
    return { forms, unused: unknown };
  }
  function answerOf(name, text, row, say) {
    const answer = ANSWERS[text.toLowerCase()];
    if (answer === undefined)
      throw new Error(say("file_flag", { row, column: name, text: text.slice(0, 40) }));
    return answer;
  }

  // objects of a file as the form has them, and titles of columns that are not used
  function read(name, text, say) {
    if (!/\.csv$/i.test(name)) return { forms: ofYaml(text, say), unused: [] };
    const plain = text.replace(/^\ufeff/, "");
    const [titles = [], ...rows] = rowsOf(plain, say).map((row) =>
      row.map((cell) => cell.trim()),
    );
    const isWidth = (title) => fieldOf(title)?.name === "width";
    const isInventory = titles.includes("name") && titles.some(isWidth);
    const isMuseums = titles.some((title) => WORDS.test(title) || SIDES.test(title));
    const reader = isMuseums && !isInventory ? ofMuseum : ofInventory;
    if (reader === ofInventory) checkTitles(titles, say);
    if (!rows.length) throw new Error(say("file_no_rows"));
    if (rows.length > MOST_ROWS)
      throw new Error(say("file_too_many", { count: rows.length, most: MOST_ROWS }));
    const torn = rows.findIndex((row) => row.length !== titles.length);
    if (torn >= 0)
      throw new Error(
        say("file_row_cells", {
          row: torn + 2,
          found: rows[torn].length,
          expected: titles.length,
        }),
      );
    return reader(titles, rows, say);
  }
  // a file of something else is not an inventory; a quantity stands once
  function checkTitles(titles, say) {
    const columns = titles.map((title) => fieldOf(title)?.name);
    const twice = columns.findIndex((name, i) => name && columns.indexOf(name) < i);
    if (twice >= 0)
      throw new Error(say("file_twice", { key: titles[twice].slice(0, 40) }));
    if (!columns.some(Boolean))
      throw new Error(say("file_keys", { key: (titles[0] ?? "").slice(0, 40) }));
  }
  return { csvOf, yamlOf, read };
};
if (typeof module !== "undefined") module.exports = lists_;
