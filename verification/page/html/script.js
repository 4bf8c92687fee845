"use strict";
const root = document.documentElement;
root.classList.add("js");
const all = (query, within = document) => [...within.querySelectorAll(query)];
const SVG = "http://www.w3.org/2000/svg";
const minus = (text) => text.replaceAll("-", "\u2212");

// Sort a table by the column whose head was pressed; a second press turns the order round.
function sort(button) {
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
}

// Without this script the link gives the compressed file; with it the plain one.
async function unpacked(address) {
  const packed = Uint8Array.from(atob(address.split(",")[1]), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}
async function save(link) {
  const address = URL.createObjectURL(new Blob([await unpacked(link.href)], { type: "text/csv" }));
  const made = document.createElement("a");
  made.href = address;
  made.download = link.dataset.csv;
  made.click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

// The profiles on a line, read from its CSV once: {quantity: {source: {x, value, U}}}.
const known = new Map();
async function profiles(page, line) {
  const link = all("a[data-of]", page).find((a) => a.dataset.of === line);
  if (!link || !("DecompressionStream" in window)) return {};
  if (!known.has(link)) {
    const rows = (await unpacked(link.href)).trim().split("\n").map((row) => row.split(","));
    const column = (n) => rows.slice(1).map((row) => (row[n] === "" || row[n] === undefined ? NaN : +row[n]));
    const found = {};
    let x = [];
    rows[0].forEach((head, n) => {
      const name = head.match(/^(uncertainty of )?(\S+) \[.*?\] (.+)$/);
      if (!name) x = column(n);
      else if (name[1]) found[name[2]][name[3]].U = column(n);
      else (found[name[2]] ??= {})[name[3]] = { x, value: column(n), U: null };
    });
    known.set(link, found);
  }
  return known.get(link);
}

addEventListener("DOMContentLoaded", () => {
  const text = document.getElementById("data")?.content.textContent;
  const data = text ? JSON.parse(text) : null;
  const pages = all(".page");
  const menu = document.querySelector(".menu");
  const wide = matchMedia("(min-width: 75rem)");

  addEventListener("click", (event) => {
    const button = event.target.closest?.("thead button");
    if (button) sort(button);
    const link = event.target.closest?.("a[data-csv]");
    if (link && "DecompressionStream" in window) {
      event.preventDefault();
      save(link);
    }
    if (menu && !wide.matches && event.target.closest?.(".menu a")) menu.open = false;
  });

  // On a narrow screen the comparisons are folded: the first page stays short.
  const chart = document.querySelector("details.chart");
  const narrow = matchMedia("(max-width: 46rem)");
  const fold = () => { if (chart) chart.open = !narrow.matches; };
  narrow.addEventListener("change", fold);
  fold();

  // Dark or light as the system has it, until the button says otherwise.
  const theme = document.querySelector("button.theme");
  if (theme) {
    theme.hidden = false;
    theme.addEventListener("click", () => {
      const dark = (root.style.colorScheme || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
      root.style.colorScheme = dark ? "light" : "dark";
    });
  }
  if (!pages.length) return;

  // The part of the address behind "#" opens a page, a place on it, or with "~" a curve: case~line~quantity.
  async function show(event) {
    const [id, line, quantity] = decodeURIComponent(location.hash.slice(1)).split("~");
    const page = document.getElementById(id)?.closest(".page") ?? pages.findLast((one) => id.startsWith(`${one.id}-`)) ?? pages[0];
    const packed = page.querySelector(".packed");
    if (packed && "DecompressionStream" in window) {
      const address = packed.dataset.html;
      packed.remove();
      const html = await unpacked(address);
      page.querySelector("h2").remove();
      page.insertAdjacentHTML("beforeend", html);
      prepare(page);
    }
    const target = id ? document.getElementById(id) : null;
    for (const one of pages) one.classList.toggle("here", one === page);
    for (const link of all(".menu a")) {
      const current = link.getAttribute("href") === `#${page.id}`;
      if (current) link.setAttribute("aria-current", "page");
      else link.removeAttribute("aria-current");
      if (current && wide.matches) link.scrollIntoView({ block: "nearest" });
    }
    menu.open = wide.matches && page !== pages[0];
    root.classList.toggle("inside", page !== pages[0]);
    const name = page.querySelector("h1, h2").textContent.trim().replace(/\s+/g, " ");
    document.title = `${name} \u2013 coatcheck report`;
    if (page.classList.contains("case")) explorer(page, line, quantity);
    if (line) page.querySelector(".explorer").scrollIntoView();
    else if (target && target !== page) {
      for (let box = target; box; box = box.parentElement) if (box.tagName === "DETAILS") box.open = true;
      target.scrollIntoView();
    } else scrollTo(0, 0);
    if (event) {
      page.tabIndex = -1;
      page.focus({ preventScroll: true });
    }
  }
  addEventListener("hashchange", show);
  wide.addEventListener("change", () => show());

  const search = menu.querySelector("input");
  search.hidden = false;
  search.addEventListener("input", () => {
    const wanted = search.value.toLowerCase().split(/\s+/);
    for (const item of all("li", menu)) {
      const shown = `${item.textContent} ${item.firstElementChild.title}`.toLowerCase();
      item.hidden = !wanted.every((word) => shown.includes(word));
    }
  });
  search.addEventListener("keydown", (event) => {
    const first = all("li", menu).find((item) => !item.hidden);
    if (event.key === "Enter" && first) location.hash = first.firstElementChild.getAttribute("href");
  });

  // What is under the pointer, in words.
  const tip = document.createElement("div");
  tip.className = "tip";
  tip.hidden = true;
  document.body.append(tip);
  function tell(event, html) {
    tip.hidden = !html;
    if (!html) return;
    tip.innerHTML = html;
    const right = event.clientX + 16 + tip.offsetWidth > innerWidth;
    tip.style.left = `${Math.max(4, right ? event.clientX - tip.offsetWidth - 12 : event.clientX + 16)}px`;
    tip.style.top = `${Math.min(event.clientY + 14, innerHeight - tip.offsetHeight - 6)}px`;
  }
  const escaped = (words) => new Option(words).innerHTML;
  const power = (value) => {
    if (value === null || value === undefined || !Number.isFinite(value)) return "not finite";
    if (value === 0) return "0";
    const [mantissa, exponent] = value.toExponential(1).split("e");
    return minus(`${mantissa}\u00b710<sup>${+exponent}</sup>`);
  };
  const sourceOf = (name) => data.sources[name] ?? [name, "other", false];
  const pairOf = (n) => data.pairs[n].slice(0, 2).map((name) => escaped(sourceOf(name)[0])).join(" \u2013 ");

  function under(svg, event) {
    const line = svg.closest("[data-line]")?.dataset.line;
    const rows = (data.cases[svg.dataset.of]?.rows ?? []).filter((row) => !line || data.lines[row[1]] === line);
    const box = svg.getBoundingClientRect();
    const unit = box.width / 566;
    const [low, high] = [+svg.dataset.low, +svg.dataset.high];
    const [u, v] = [(event.clientX - box.left) / unit - 3, (event.clientY - box.top) / unit];
    let best = null;
    rows.forEach((row, n) => {
      if (row[3] === null) return;
      const share = (Math.log10(Math.max(row[3], 1e-99)) - low) / (high - low);
      const [x, y] = [560 * Math.min(Math.max(share, 0), 1), 2 + (18 * (n + 0.5)) / rows.length];
      const away = Math.hypot(x - u, 0.7 * (y - v));
      if (!best || away < best.away) best = { away, row, x, y };
    });
    return best && best.away < 30 ? best : null;
  }
  function prepare(within) {
    all("svg.strip[data-of]", within).forEach(strip);
    all("svg.figure[data-quantity]", within).forEach(figure);
    all("details.numbers-of", within).forEach(numbers);
  }
  function strip(svg) {
    const ring = document.createElementNS(SVG, "circle");
    ring.setAttribute("r", 3.4);
    ring.setAttribute("class", "under");
    svg.addEventListener("pointermove", (event) => {
      const found = under(svg, event);
      if (!found) return svg.dispatchEvent(new Event("pointerleave"));
      const [q, l, p, difference, U, cap, outcome] = found.row;
      const line = data.lines[l] === "contact" ? "" : `, ${escaped(data.lines[l])}`;
      tell(event, `<b>${data.quantities[q][1]}</b>${line}<br>${pairOf(p)}<br>|A \u2212 B| ${power(difference)}` +
        `<br>U ${U === null ? "not stated" : power(U)}, cap ${power(cap)}<br>${data.outcomes[outcome]}`);
      ring.setAttribute("cx", found.x);
      ring.setAttribute("cy", found.y);
      svg.append(ring);
      svg.style.cursor = "pointer";
    });
    svg.addEventListener("pointerleave", () => {
      tell();
      ring.remove();
      svg.style.cursor = "";
    });
    svg.addEventListener("click", (event) => {
      const found = under(svg, event);
      tell();
      if (!found) location.hash = svg.dataset.of;
      else if (data.lines[found.row[1]] === "contact") location.hash = `${svg.dataset.of}-contact`;
      else location.hash = `${svg.dataset.of}~${encodeURIComponent(data.lines[found.row[1]])}~${data.quantities[found.row[0]][0]}`;
    });
  }

  // Scales of a case: a_h, p_h, delta_h, then the divisors of differences of stresses and displacements.
  const scaleOf = (page, quantity) => {
    const scales = data.cases[page.id].scales;
    return quantity.startsWith("u_") ? [scales[0], scales[2], scales[4], "\u03b4"] : [scales[0], scales[1], scales[3], "p"];
  };
  const symbolOf = (quantity) => data.quantities.find((one) => one[0] === quantity)?.[1] ?? escaped(quantity);
  const scaled = (symbol) => `<i>${symbol}</i><sub>H</sub>`;
  const differing = (page, quantity, line, found) => {
    const rows = data.cases[page.id].rows.filter((row) => data.quantities[row[0]][0] === quantity && data.lines[row[1]] === line);
    return rows.map((row) => ({ row, pair: data.pairs[row[2]] })).filter(({ pair }) => found[pair[0]] && found[pair[1]]);
  };
  function values(page, quantity, line, found, n) {
    const [a, size, divisor, symbol] = scaleOf(page, quantity);
    const first = Object.values(found)[0];
    const along = line.endsWith("axis") ? "z" : line.includes("oblique") ? "s" : "x";
    const told = [`<b>${symbolOf(quantity)}</b> / ${scaled(symbol)}, <i>${along}</i> = ${minus((first.x[n] / a).toFixed(3))} <i>a</i><sub>H</sub>`];
    for (const [name, one] of Object.entries(found)) {
      const U = one.U ? one.U[n] / size : 0;
      const digits = U > 0 ? Math.min(Math.max(1 - Math.floor(Math.log10(U)), 2), 9) : 7;
      told.push(`${escaped(sourceOf(name)[0])} ${minus((one.value[n] / size).toFixed(digits))}`);
    }
    for (const { pair } of differing(page, quantity, line, found)) {
      const [one, other] = [found[pair[0]], found[pair[1]]];
      const U = one.U && other.U ? `, U ${power((one.U[n] + other.U[n]) / divisor)}` : "";
      told.push(`<small>${pair.slice(0, 2).map((name) => escaped(sourceOf(name)[0])).join(" \u2013 ")}: ` +
        `${power(Math.abs(one.value[n] - other.value[n]) / divisor)}${U}</small>`);
    }
    return told.join("<br>");
  }
  const nearest = (x, at) => x.reduce((best, value, n) => (Math.abs(value - at) < Math.abs(x[best] - at) ? n : best), 0);

  function figure(svg) {
    const page = svg.closest(".page");
    const { quantity, line } = svg.dataset;
    const [left, width, low, high] = svg.dataset.axis.split(" ").map(Number);
    const rule = document.createElementNS(SVG, "path");
    rule.setAttribute("class", "under");
    svg.addEventListener("pointermove", async (event) => {
      const found = (await profiles(page, line))[quantity];
      if (!found || !data.cases[page.id]) return;
      const box = svg.getBoundingClientRect();
      const u = ((event.clientX - box.left) / box.width) * svg.viewBox.baseVal.width;
      const at = low + ((u - left) / width) * (high - low);
      if (at < low || at > high) return tell();
      const a = scaleOf(page, quantity)[0];
      const n = nearest(Object.values(found)[0].x, at * a);
      const x = left + ((Object.values(found)[0].x[n] / a - low) / (high - low)) * width;
      rule.setAttribute("d", `M${x} 5V209`);
      svg.append(rule);
      tell(event, values(page, quantity, line, found, n));
    });
    svg.addEventListener("pointerleave", () => {
      tell();
      rule.remove();
    });
    svg.addEventListener("click", () => {
      location.hash = `${page.id}~${encodeURIComponent(line)}~${quantity}`;
    });
    svg.style.cursor = "zoom-in";
  }

  // The numbers of all comparisons of a case, a row for each quantity on each line.
  function numbers(box) {
    box.addEventListener("toggle", () => {
      const rows = data.cases[box.closest(".page").id]?.rows ?? [];
      if (box.querySelector("table") || !rows.length) return;
      const pairs = [...new Set(rows.map((row) => row[2]))].sort((one, other) => one - other);
      const places = new Map();
      for (const row of rows) {
        const key = `${row[1]} ${row[0]}`;
        if (!places.has(key)) places.set(key, []);
        places.get(key).push(row);
      }
      const cells = (row) => (row
        ? `<td class="num ${row[6] === data.agrees ? "" : "bad"}">${row[6] === data.agrees ? "" : data.outcomes[row[6]][0]} ${power(row[3])}</td>` +
          `<td class="num">${row[4] === null ? "not stated" : power(row[4])}</td>`
        : "<td></td><td></td>");
      const body = [...places.values()].sort((one, other) => one[0][1] - other[0][1] || one[0][0] - other[0][0]).map((some) =>
        `<tr><th scope="row">${data.quantities[some[0][0]][1]}</th><td>${escaped(data.lines[some[0][1]])}</td><td class="num">${power(some[0][5])}</td>` +
        pairs.map((pair) => cells(some.find((row) => row[2] === pair))).join("") + "</tr>");
      box.insertAdjacentHTML("beforeend", '<div class="scroll" tabindex="0" role="region" aria-label="all comparisons"><table class="comparisons"><thead>' +
        `<tr class="groups"><th colspan="3"></th>${pairs.map((pair) => `<th colspan="2" scope="colgroup">${pairOf(pair)}</th>`).join("")}</tr>` +
        `<tr><th scope="col">quantity</th><th scope="col">line</th><th scope="col">cap on U</th>${pairs.map(() => '<th scope="col">|A \u2212 B|</th><th scope="col">U</th>').join("")}</tr>` +
        `</thead><tbody>${body.join("")}</tbody></table></div>`);
    });
  }

  // One large figure of a case: any quantity on any line, drawn from the numbers in the page.
  // Narrow on a phone, so that its texts keep their size.
  const WIDTH = matchMedia("(max-width: 40rem)").matches ? 460 : 1000;
  const TOP = 12, MIDDLE = 250, LOW = 274, BOTTOM = 440, LEFT = 62, RIGHT = WIDTH - 14;
  function explorer(page, line, quantity) {
    const box = page.querySelector(".explorer");
    const links = all("a[data-of]", page).filter((a) => a.dataset.of !== "contact");
    if (!box || !links.length || !data.cases[page.id]) return;
    if (!box.dataset.made) {
      box.dataset.made = "yes";
      box.hidden = false;
      box.insertAdjacentHTML("beforeend",
        '<p class="choose"><label>Line <select class="line"></select></label> <label>Quantity <select class="quantity"></select></label> ' +
        '<button type="button" class="edge">Contact edge</button> <button type="button" class="whole">Whole line</button></p>' +
        '<p class="legend"></p><svg class="plot" viewBox="0 0 ' + WIDTH + ' 480" role="img" tabindex="0"></svg>' +
        '<p class="caption">Above, values; below, |A \u2212 B| (lines) and U of both (tints) on a logarithmic scale, the cap in red. ' +
        "Drag across the figure to enlarge a part; the arrow keys move the reading.</p>");
      const choice = box.querySelector("select.line");
      choice.append(...links.map((a) => new Option(a.dataset.of)));
      choice.addEventListener("change", () => draw(page, box));
      box.querySelector("select.quantity").addEventListener("change", () => draw(page, box));
      box.querySelector(".whole").addEventListener("click", () => draw(page, box));
      box.querySelector(".edge").addEventListener("click", () => {
        const [a, , , r] = [data.cases[page.id].scales[0], 0, 0, data.cases[page.id].scales[5]];
        draw(page, box, [(r / a) * 0.97, (r / a) * 1.03]);
      });
    }
    if (line) box.querySelector("select.line").value = line;
    if (line || !box.querySelector(".plot").childElementCount) draw(page, box, null, quantity);
  }
  const path = (points) => {
    let pen = "M";
    return points.map(([x, y]) => {
      if (!Number.isFinite(x + y)) { pen = "M"; return ""; }
      const step = `${pen}${x.toFixed(1)} ${y.toFixed(1)}`;
      pen = "L";
      return step;
    }).join("");
  };
  function round(low, high, count) {
    const raw = (high - low) / count;
    const base = 10 ** Math.floor(Math.log10(raw));
    const step = base * [1, 2, 5, 10].find((s) => s * base >= raw * (1 - 1e-9));
    const found = [];
    for (let n = Math.ceil(low / step - 1e-9); n <= high / step + 1e-9; n++) found.push(n * step);
    return found.map((value) => [value, minus(String(+value.toPrecision(6)))]);
  }
  const MARK = { semi: "m-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z", fem: "m0-5l4.6 8h-9.2z" };
  async function draw(page, box, range = null, wanted = null) {
    const line = box.querySelector("select.line").value;
    const all_ = await profiles(page, line);
    const choice = box.querySelector("select.quantity");
    const before = wanted ?? choice.value;
    const names = Object.keys(all_);
    choice.replaceChildren(...names.map((name) => {
      const option = new Option(new DOMParser().parseFromString(symbolOf(name), "text/html").body.textContent, name);
      return option;
    }));
    if (!names.length) return;
    choice.value = names.includes(before) ? before : names[0];
    const quantity = choice.value;
    const found = all_[quantity];
    const [a, size, divisor, symbol] = scaleOf(page, quantity);
    const curves = Object.entries(found).map(([name, one]) => ({
      name, look: sourceOf(name), x: one.x.map((x) => x / a), y: one.value.map((y) => y / size) }));
    const every = curves.flatMap((c) => c.x).filter(Number.isFinite);
    const [low, high] = range ?? [Math.min(...every), Math.max(...every)];
    const X = (x) => LEFT + ((x - low) / (high - low)) * (RIGHT - LEFT);
    const inside = curves.flatMap((c) => c.y.filter((y, n) => Number.isFinite(y) && c.x[n] >= low && c.x[n] <= high));
    let [bottom, top] = [Math.min(...inside), Math.max(...inside)];
    if (!(top > bottom)) [bottom, top] = [bottom - 1, bottom + 1];
    [bottom, top] = [bottom - 0.06 * (top - bottom), top + 0.06 * (top - bottom)];
    const Y = (y) => MIDDLE - ((y - bottom) / (top - bottom)) * (MIDDLE - TOP);
    const gaps = differing(page, quantity, line, found).map(({ row, pair }) => {
      const [one, other] = [found[pair[0]], found[pair[1]]];
      return {
        pair, cap: row[5], x: one.x.map((x) => x / a),
        y: one.value.map((v, n) => Math.abs(v - other.value[n]) / divisor),
        U: one.U && other.U ? one.U.map((u, n) => (u + other.U[n]) / divisor) : null };
    });
    const sizes = gaps.flatMap((g) => [...g.y, ...(g.U ?? [])]).filter((v) => v > 1e-13 && Number.isFinite(v));
    const caps = gaps.map((g) => g.cap);
    const least = Math.floor(Math.log10(Math.min(...sizes, 1e-6)));
    const most = Math.ceil(Math.log10(Math.max(...sizes, ...caps, 1e-5)));
    const L = (v) => BOTTOM - ((Math.log10(Math.max(v, 10 ** least)) - least) / (most - least)) * (BOTTOM - LOW);
    const parts = [`<clipPath id="cut"><path d="M${LEFT} 0H${RIGHT}V480H${LEFT}z"/></clipPath>`];
    const texts = [];
    for (const [x, label] of round(low, high, WIDTH < 500 ? 5 : 8)) {
      parts.push(`<path d="M${X(x).toFixed(1)} ${TOP}V${MIDDLE}M${X(x).toFixed(1)} ${LOW}V${BOTTOM}" class="s-grid"/>`);
      texts.push(`<text x="${X(x).toFixed(1)}" y="${BOTTOM + 17}" text-anchor="middle">${label}</text>`);
    }
    for (const [y, label] of round(bottom, top, 5)) {
      parts.push(`<path d="M${LEFT} ${Y(y).toFixed(1)}H${RIGHT}" class="s-grid"/>`);
      texts.push(`<text x="${LEFT - 6}" y="${(Y(y) + 4).toFixed(1)}" text-anchor="end">${label}</text>`);
    }
    for (let n = least; n <= most; n += Math.max(1, Math.ceil((most - least) / 6))) {
      parts.push(`<path d="M${LEFT} ${L(10 ** n).toFixed(1)}H${RIGHT}" class="s-grid"/>`);
      texts.push(`<text x="${LEFT - 6}" y="${(L(10 ** n) + 4).toFixed(1)}" text-anchor="end">10<tspan dy="-5" font-size="9">${minus(String(n))}</tspan></text>`);
    }
    const broad = (c) => c.look[2] || curves.length === 1;
    for (const c of [...curves].sort((one, other) => broad(other) - broad(one))) {
      const points = c.x.map((x, n) => [X(x), Y(c.y[n])]);
      parts.push(`<path d="${path(points)}" class="s-${c.look[1]}" clip-path="url(#cut)" stroke-width="${broad(c) ? 6 : 1.4}" stroke-opacity="${broad(c) ? 0.35 : 1}"/>`);
      if (!broad(c)) {
        const offset = c.look[1] === "fem" ? 0.5 : 0;
        for (let k = 0; k < 14; k++) {
          const at = nearest(c.x, low + ((k + 0.25 + offset) / 14) * (high - low));
          if (Number.isFinite(c.y[at]) && c.x[at] >= low && c.x[at] <= high)
            parts.push(`<path d="M${X(c.x[at]).toFixed(1)} ${Y(c.y[at]).toFixed(1)}${MARK[c.look[1]] ?? "m-4-4h8v8h-8z"}" class="point s-${c.look[1]}"/>`);
        }
      }
    }
    for (const g of gaps) {
      if (g.U) {
        const over = g.x.map((x, n) => [X(x), L(g.U[n])]).filter(([x, y]) => Number.isFinite(x + y));
        if (over.length)
          parts.push(`<path d="${path(over)}L${over.at(-1)[0].toFixed(1)} ${BOTTOM}L${over[0][0].toFixed(1)} ${BOTTOM}z" class="tint f-${g.pair[2]} s-${g.pair[2]}" clip-path="url(#cut)"/>`);
      }
      parts.push(`<path d="${path(g.x.map((x, n) => [X(x), L(g.y[n])]))}" class="s-${g.pair[2]}" clip-path="url(#cut)" stroke-width="1.5"/>`);
      parts.push(`<path d="M${LEFT} ${L(g.cap).toFixed(1)}H${RIGHT}" class="s-cap" stroke-dasharray="6 3"/>`);
    }
    const svg = box.querySelector(".plot");
    const along = line.endsWith("axis") ? "z" : line.includes("oblique") ? "s" : "x";
    texts.push(`<text x="${(LEFT + RIGHT) / 2}" y="${BOTTOM + 35}" text-anchor="middle"><tspan class="it">${along}</tspan> / <tspan class="it">a</tspan><tspan dy="3" font-size="10">H</tspan></text>`);
    svg.innerHTML = `${parts.join("")}<g class="f-ink">${texts.join("")}</g><path class="under rule"/>`;
    svg.setAttribute("aria-label", `${quantity} on ${line} by every source, with differences`);
    const colours = (list) => list.map(([label, colour]) => `<span><i class="line-${colour}"></i>${label}</span>`).join(" ");
    box.querySelector(".legend").innerHTML = `<span><b>${symbolOf(quantity)} / ${scaled(symbol)}, ${escaped(line)}</b></span> ` +
      colours(curves.map((c) => [escaped(c.look[0]), c.look[1]])) + (gaps.length ? " \u00a0 differences: " : "") +
      colours(gaps.map((g) => [g.pair.slice(0, 2).map((name) => escaped(sourceOf(name)[0])).join(" \u2013 "), g.pair[2]]));
    const first = Object.values(found)[0];
    const at = (event) => {
      const frame = svg.getBoundingClientRect();
      return low + ((((event.clientX - frame.left) / frame.width) * WIDTH - LEFT) / (RIGHT - LEFT)) * (high - low);
    };
    const read = (n, place) => {
      svg.querySelector(".rule").setAttribute("d", `M${X(first.x[n] / a).toFixed(1)} ${TOP}V${BOTTOM}`);
      tell(place, values(page, quantity, line, found, n));
    };
    let start = null, reading = nearest(first.x, ((low + high) / 2) * a);
    svg.onpointermove = (event) => {
      reading = nearest(first.x, at(event) * a);
      read(reading, event);
    };
    svg.onpointerleave = () => tell();
    svg.onpointerdown = (event) => { start = at(event); event.preventDefault(); };
    svg.onpointerup = (event) => {
      const ends = [start, at(event)].sort((one, other) => one - other);
      if (start !== null && ends[1] - ends[0] > 0.01 * (high - low)) draw(page, box, ends);
      start = null;
    };
    svg.onkeydown = (event) => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!step) return;
      event.preventDefault();
      reading = Math.min(Math.max(reading + step, 0), first.x.length - 1);
      const frame = svg.getBoundingClientRect();
      read(reading, { clientX: frame.left + (X(first.x[reading] / a) / WIDTH) * frame.width, clientY: frame.top + 20 });
    };
    svg.onblur = () => tell();
  }

  prepare(document);
  show();
});
