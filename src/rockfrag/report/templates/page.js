"use strict";
// Chapters open when something links into them, and all of them for print.
function openAround(id) {
  const target = id && document.getElementById(id);
  if (!target) return;
  for (let one = target; one; one = one.parentElement)
    if (one.tagName === "DETAILS") one.open = true;
  target.scrollIntoView();
}
addEventListener("hashchange", () =>
  openAround(decodeURIComponent(location.hash.slice(1))),
);
openAround(decodeURIComponent(location.hash.slice(1)));
for (const link of document.querySelectorAll('a[href^="#"]'))
  link.addEventListener("click", () => openAround(link.hash.slice(1)));
let closed = [];
addEventListener("beforeprint", () => {
  closed = [...document.querySelectorAll("details:not([open])")];
  for (const one of closed) one.open = true;
});
addEventListener("afterprint", () => {
  for (const one of closed) one.open = false;
});

// Longer tables and lists can be filtered, and tables sorted by any column.
const LONG = 8;
function sortKey(cell) {
  const text = cell.textContent
    .trim()
    .replace(/^[<>≤≥] /, "")
    .replaceAll("−", "-");
  const number = parseFloat(text);
  return Number.isNaN(number) ? text.toLowerCase() : number;
}
function compare(a, b) {
  if (typeof a === typeof b) return Number(a > b) - Number(a < b);
  return typeof a === "number" ? -1 : 1;
}
function sortBy(table, column, falling) {
  const body = table.tBodies[0];
  const rows = [...body.rows].map((row) => [sortKey(row.cells[column]), row]);
  rows.sort((a, b) => (falling ? compare(b[0], a[0]) : compare(a[0], b[0])));
  body.append(...rows.map((row) => row[1]));
  for (const [number, head] of [...table.tHead.rows[0].cells].entries()) {
    if (number === column)
      head.setAttribute("aria-sort", falling ? "descending" : "ascending");
    else head.removeAttribute("aria-sort");
  }
}
function sortable(table, tools) {
  const choice = document.createElement("select");
  choice.setAttribute("aria-label", "Sort by");
  choice.className = "sort";
  choice.add(new Option("Sort by …", ""));
  for (const [column, head] of [...table.tHead.rows[0].cells].entries()) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = head.textContent;
    button.addEventListener("click", () =>
      sortBy(table, column, head.getAttribute("aria-sort") === "ascending"),
    );
    head.replaceChildren(button);
    choice.add(new Option(button.textContent, column));
  }
  choice.addEventListener("change", () => {
    if (choice.value) sortBy(table, Number(choice.value), false);
  });
  tools.append(choice);
}
function filterable(items, tools, what) {
  const box = document.createElement("input");
  box.type = "search";
  box.placeholder = `Filter ${items.length} ${what}`;
  box.setAttribute("aria-label", `Filter ${what}`);
  box.addEventListener("input", () => {
    const wanted = box.value.toLowerCase();
    for (const item of items)
      item.hidden = !item.textContent.toLowerCase().includes(wanted);
  });
  tools.append(box);
}
function tools(before) {
  const bar = document.createElement("div");
  bar.className = "tools";
  before.before(bar);
  return bar;
}
for (const table of document.querySelectorAll("figure.table table")) {
  const rows = [...table.tBodies[0].rows];
  if (rows.length < 3) continue;
  const bar = tools(table);
  if (rows.length > LONG) filterable(rows, bar, "rows");
  sortable(table, bar);
}
for (const list of document.querySelectorAll(".ledger"))
  filterable([...list.children], tools(list), "statements");
