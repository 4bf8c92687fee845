"use strict";
// Sort a table by the column whose head was pressed; a second press turns the order round.
for (const button of document.querySelectorAll("thead button")) {
  button.addEventListener("click", () => {
    const head = button.closest("th");
    const column = head.cellIndex;
    const body = head.closest("table").tBodies[0];
    const down = head.getAttribute("aria-sort") === "ascending";
    for (const other of head.parentNode.cells) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    const key = (row) => {
      const cell = row.cells[column];
      const number = parseFloat(cell.dataset.sort ?? cell.textContent.replace("\u2212", "-"));
      return Number.isNaN(number) ? cell.textContent.trim() : number;
    };
    const order = (a, b) => {
      const [x, y] = [key(a), key(b)];
      if (typeof x === typeof y) return typeof x === "number" ? x - y : x.localeCompare(y);
      return typeof x === "number" ? -1 : 1;
    };
    const rows = [...body.rows].sort(order);
    if (down) rows.reverse();
    body.append(...rows);
  });
}
// Without this script the link gives the compressed file; with it the plain one.
for (const link of document.querySelectorAll("a[data-csv]")) {
  link.addEventListener("click", async (event) => {
    if (!("DecompressionStream" in window)) return;
    event.preventDefault();
    const packed = Uint8Array.from(atob(link.href.split(",")[1]), (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    const address = URL.createObjectURL(new Blob([await new Response(stream).blob()], { type: "text/csv" }));
    const save = document.createElement("a");
    save.href = address;
    save.download = link.dataset.csv;
    save.click();
    setTimeout(() => URL.revokeObjectURL(address), 10000);
  });
}
// Paper shows what is folded away on screen.
let folded = [];
addEventListener("beforeprint", () => {
  folded = [...document.querySelectorAll("details:not([open])")];
  for (const item of folded) item.open = true;
});
addEventListener("afterprint", () => {
  for (const item of folded) item.open = false;
});
// Dark or light as the system has it, until the button says otherwise.
const theme = document.querySelector("button.theme");
if (theme) {
  theme.hidden = false;
  theme.addEventListener("click", () => {
    const root = document.documentElement;
    const dark = (root.style.colorScheme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
    root.style.colorScheme = dark ? "light" : "dark";
  });
}
