/* What all drawings of a page share: its colours, and a canvas at the resolution of the
 * screen.
 */
function rockfragColours() {
  "use strict";
  const style = getComputedStyle(document.documentElement);
  const names = [
    "ink",
    "soft",
    "line",
    "paper",
    "wash",
    "accent",
    "blue",
    "red",
    "band",
    "rule",
  ];
  return Object.fromEntries(
    names.map((name) => [name, style.getPropertyValue("--" + name).trim()]),
  );
}
function rockfragSized(canvas) {
  "use strict";
  const ratio = devicePixelRatio || 1;
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  const [wide, high] = [width, height].map((value) => Math.round(value * ratio));
  if (canvas.width !== wide || canvas.height !== high)
    Object.assign(canvas, { width: wide, height: high });
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = "12px system-ui, sans-serif";
  return [context, width, height];
}
// what says texts with values in their places; numbers stay on a line with their units
function rockfragSayer(texts) {
  "use strict";
  return (id, values = {}) =>
    texts[id]
      .replace(/\{(\w+)\}/g, (_, place) => values[place])
      .replace(/(\d) (?=(?:g|s|m|cm)(?![\w/]))/g, "$1\u00a0");
}
// what writes a number with so many decimals, by a language's sign for them
function rockfragDecimals(decimal) {
  "use strict";
  return (value, digits) =>
    value
      .toFixed(digits)
      .replace(/^-(?=[0.]*$)/, "")
      .replace("-", "−")
      .replace(".", decimal);
}
// where an amplitude lies between the first and the last of a rising row, by logarithm
function rockfragAlong(amplitudes) {
  "use strict";
  const [low, high] = [amplitudes[0], amplitudes.at(-1)];
  return (amplitude) => Math.log(amplitude / low) / Math.log(high / low);
}
// an upright line in a drawing
function rockfragUpright(context, x, top, bottom) {
  "use strict";
  context.beginPath();
  context.moveTo(x, top);
  context.lineTo(x, bottom);
  context.stroke();
}
// amplitudes below a bar, as far as it has them, and the chosen one over it
function rockfragBarScale(drawing, chosen) {
  "use strict";
  const { context, width, height, along, colours } = drawing;
  const x = (peak) => 4 + along(peak) * (width - 8);
  context.fillStyle = colours.soft;
  for (const peak of [0.05, 0.1, 0.2, 0.5, 1, 2, 5])
    if (along(peak) >= 0 && along(peak) <= 1)
      context.fillText(`${peak} g`, Math.min(x(peak), width - 30), height - 3);
  context.strokeStyle = colours.ink;
  context.lineWidth = 2;
  rockfragUpright(context, x(chosen), 0, height - 14);
  context.lineWidth = 1;
}
// what a bar of outcomes says where it is not seen: a 1 for each amplitude that
// topples, and the least of these
function rockfragBarLabel(say, row, least) {
  "use strict";
  const fell = [...row].filter((one) => one === "1").length;
  const count = row.length;
  return fell ? say("bar_some", { fell, count, least }) : say("bar_none", { count });
}
