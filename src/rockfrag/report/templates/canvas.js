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
// what says texts with values in their places
function rockfragSayer(texts) {
  "use strict";
  return (id, values = {}) =>
    texts[id].replace(/\{(\w+)\}/g, (_, place) => values[place]);
}
// what a bar of outcomes says where it is not seen: a 1 for each amplitude that
// topples, and the least of these
function rockfragBarLabel(say, row, least) {
  "use strict";
  const fell = [...row].filter((one) => one === "1").length;
  const count = row.length;
  return fell ? say("bar_some", { fell, count, least }) : say("bar_none", { count });
}
