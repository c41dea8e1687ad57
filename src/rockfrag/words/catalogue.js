/* Findings in the words of a catalogue, as rockfrag.words.catalogue says them: the same
 * files, the same rules.
 */
const catalogue = (texts) => {
  "use strict";
  const DIGITS = { two: 2, three: 3, four: 4 };
  const SURE = 0.995;
  const LEAST = 1e-5;
  const local = (digits) => digits.replace("-", "−").replace(".", texts.decimal);

  // a number of so many digits, halves to even as Python rounds them: mantissa and
  // exponent
  function rounded(value, digits) {
    const [mantissa, power] = value.toExponential(60).split("e");
    const kept = mantissa.slice(0, mantissa.indexOf(".") + digits);
    const tie =
      /^50*$/.test(mantissa.slice(kept.length)) &&
      Number(kept.replace(".", "").at(-1)) % 2 === 0;
    return (tie ? `${kept}e${power}` : value.toExponential(digits - 1)).split("e");
  }
  function significant(value, digits) {
    const [mantissa, power] = rounded(value, digits);
    const decimals = Math.max(0, digits - 1 - Number(power));
    const text = Number(`${mantissa}e${power}`).toFixed(decimals);
    return text.includes(".") ? text.replace(/0+$/, "").replace(/\.$/, "") : text;
  }
  function whole(value) {
    const near = Math.round(value);
    const even = Math.abs(value % 1) === 0.5 && near % 2 ? near - 1 : near;
    return String(even || 0).replace("-", "−");
  }
  function limit(fraction) {
    const value = 100 * fraction;
    if (value < 5e-4) return "0";
    if (value >= 99.95) return "100";
    if (value >= 99.5) return value.toFixed(1);
    if (value >= 10) return whole(value);
    return significant(value, value >= 1 ? 2 : 1);
  }
  function percent(value) {
    if (value > 0 && value < LEAST)
      return texts.less_than.replace("{value}", local("0.001"));
    if (value > SURE && value < 1) return texts.more_than_99;
    return `${local(significant(100 * value, value < 1 ? 2 : 3))} %`;
  }
  function ordinal(value) {
    const last = [11, 12, 13].includes(value % 100) ? 0 : value % 10;
    return (
      texts.ordinals[value] ??
      `${value}${texts.ordinal_endings[last] ?? texts.ordinal_endings[0]}`
    );
  }
  function number({ number: value, form }) {
    if (!Number.isFinite(value)) return texts.unknown;
    if (form === "percent") return percent(value);
    if (form === "ordinal") return ordinal(value);
    if (form === "whole") return whole(value);
    return local(form === "limit" ? limit(value) : significant(value, DIGITS[form]));
  }
  function listed(words) {
    return words.length < 2
      ? words.join("")
      : `${words.slice(0, -1).join(", ")} ${texts.and} ${words.at(-1)}`;
  }
  function text(id, n) {
    const found = texts[id] ?? id;
    if (typeof found === "string") return found;
    const form = Object.keys(texts.plural).find((name) =>
      texts.plural[name].includes(n),
    );
    return found[form] ?? found.other;
  }
  function say(value) {
    if (value === null || typeof value !== "object") return String(value);
    if (value.listed) return listed(value.listed.map(say));
    if ("number" in value) return number(value);
    const { id, values = {} } = value;
    return text(id, values.n).replace(/\{(\w+)\}/g, (place, name) =>
      name in values ? say(values[name]) : place,
    );
  }
  function sentence(value) {
    const words = say(value);
    return words.slice(0, 1).toUpperCase() + words.slice(1);
  }
  const paragraph = (values) => values.map(sentence).join(" ");
  return { say, sentence, paragraph };
};
if (typeof module !== "undefined") module.exports = catalogue;
