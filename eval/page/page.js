// Draws the charts of a page from the JSON beside it. A legend acts on all charts of a part of the page.
"use strict";
const description = JSON.parse(document.getElementById("charts").textContent);
let drawn = [];
document.documentElement.classList.add("scripted");

/// Dashes of each line, so that lines can be told apart where they cover each other, and in print.
const dashes = [[], [8, 4], [2, 3], [9, 3, 2, 3]];

function withDashes(list) {
  let lines = 0;
  return list.map((series, place) => Object.assign({ place: place,
    dashes: series.style === "line" ? dashes[lines++ % dashes.length] : [] }, series));
}

/// Points with a gap after every other one.
function segmentPoints(points) {
  return points.flatMap(([x, y], i) => i % 2 === 0 ? [{ x: x, y: y }] : [{ x: x, y: y }, { x: null, y: null }]);
}

/// The outline of a histogram whose points are the middles of its bins.
function outline(points) {
  const half = points.length > 1 ? (points[1][0] - points[0][0]) / 2 : 0.5;
  const corners = points.flatMap(([x, y]) => [{ x: x - half, y: y }, { x: x + half, y: y }]);
  if (corners.length > 0) {
    corners.unshift({ x: corners[0].x, y: 0 });
    corners.push({ x: corners[corners.length - 1].x, y: 0 });
  }
  return corners;
}

function pointsOf(series) {
  // A box is drawn by a plugin; its two points make the axes reach its whiskers.
  if (series.style === "boxes") return series.points.flatMap((b) => [{ x: b[0], y: b[1] }, { x: b[0], y: b[5] }]);
  if (series.style === "segments") return segmentPoints(series.points);
  if (series.style === "bars") return outline(series.points);
  return series.points.map(([x, y]) => ({ x: x, y: y }));
}

const orders = { backdrop: 1, band: 2, segments: 0.5 };
const widths = { dots: 0, boxes: 0, backdrop: 4, segments: 0.8, band: 0.5 };

/// Viridis, as the colour bar has it (page.css).
const ramp = [[68, 1, 84], [62, 74, 137], [38, 130, 142], [53, 183, 121], [180, 222, 44], [253, 231, 37]];

/// share: of the largest value. Grey where it is unknown.
function rampColour(share) {
  if (share === null || !isFinite(share)) return "rgb(170,170,170)";
  const at = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
  const below = Math.min(Math.floor(at), ramp.length - 2);
  const mixed = ramp[below].map((c, i) => Math.round(c + (at - below) * (ramp[below + 1][i] - c)));
  return `rgb(${mixed.join(",")})`;
}

/// Each segment has the colour of the value at its end.
function segmentColours(series, top) {
  if (!top || series.points.length === 0 || series.points[0].length < 3) return {};
  return { borderWidth: 3, segment: { borderColor: (segment) => rampColour(series.points[segment.p1DataIndex][2] / top) } };
}

/// top: the value of the last colour of lines that are coloured by their values.
function dataset(series, top) {
  const stroke = strokeOf(series);
  const boxes = series.style === "boxes";
  const filled = series.style === "bars" || series.style === "band";
  return Object.assign({
    label: series.label,
    data: pointsOf(series),
    hidden: series.hidden,
    boxes: boxes ? series.points : null,
    band: series.style === "band",
    yAxisID: series.right ? "right" : "left",
    borderColor: series.style === "backdrop" ? stroke + "66" : stroke,
    backgroundColor: series.style === "bars" ? stroke + "66" : series.style === "band" ? stroke + "30" : stroke,
    borderWidth: widths[series.style] === undefined ? 1.3 : widths[series.style],
    borderDash: series.dashes,
    pointStyle: series.style === "dots" ? "circle" : ["line", "backdrop", "segments"].includes(series.style) ? "line" : "rect",
    // Later lines are dashed: they lie on the earlier ones.
    order: orders[series.style] || -series.place,
    pointRadius: series.style === "dots" ? 2.5 : 0,
    pointHitRadius: 6,
    showLine: series.style !== "dots" && !boxes,
    fill: filled ? "origin" : false,
    spanGaps: false,
  }, segmentColours(series, top));
}

/// Bars that stand on one another, one stack a category.
function barDataset(series, count) {
  const stroke = strokeOf(series);
  const data = new Array(count).fill(null);
  series.points.forEach(([x, y]) => { data[x] = y; });
  return { label: series.label, data: data, hidden: series.hidden, backgroundColor: stroke, borderColor: colour("--panel"), borderWidth: 1,
    yAxisID: "left" };
}

/// "full, lost" and "full, 3 sigma" are of the run "full".
function isOf(label, run) {
  return label === run || label.startsWith(run + ", ");
}

/// Shows or hides all of a run, in all charts of a part.
function showRun(part, run, visible) {
  description.forEach((chart, index) => {
    if (chart.part !== part) return;
    let changed = false;
    chart.series.forEach((series, place) => {
      if (!isOf(series.label, run)) return;
      series.hidden = !visible;
      drawn[index].setDatasetVisibility(place, visible);
      changed = true;
    });
    if (changed) drawn[index].update("none");
  });
  window.dispatchEvent(new CustomEvent("run-shown", { detail: { part: part, run: run, visible: visible } }));
}

function tooltipTitle(chart, items) {
  if (chart.categories.length > 0) return chart.categories[items[0].dataIndex];
  if (chart.names.length > 0) return chart.names[Math.round(items[0].parsed.x) - 1];
  return chart.x + ": " + shortNumber(items[0].parsed.x);
}

/** A text that is no wider than the room (px) in the chart's font: the middle of a long name is left out, since its end tells runs apart as well. */
function shortened(context, text, room) {
  context.save();
  context.font = `${Chart.defaults.font.size}px ${Chart.defaults.font.family}`;
  let short = text;
  for (let kept = text.length - 1; kept > 8 && context.measureText(short).width > room; --kept)
    short = text.slice(0, Math.ceil(kept / 2)) + "\u2026" + text.slice(text.length - Math.floor(kept / 2));
  context.restore();
  return short;
}

/// A piece of the series' line, with its dashes.
function lineSwatch(series) {
  const name = "http://www.w3.org/2000/svg";
  const picture = document.createElementNS(name, "svg");
  const line = document.createElementNS(name, "line");
  const put = (element, values) => Object.entries(values).forEach(([key, value]) => element.setAttribute(key, value));
  put(picture, { width: 28, height: 8, "aria-hidden": "true" });
  put(line, { x1: 0, x2: 28, y1: 4, y2: 4, "stroke-dasharray": (series.dashes || []).join(" "), "stroke-width": series.style === "backdrop" ? 5 : 2.5 });
  line.style.stroke = "var(--series-" + (series.colour % seriesColours) + ")";
  picture.append(line);
  return picture;
}

/** Names fit the chart, and lines have the dashes of their curves. Dots are round in a legend, too, whose other symbols are wide. */
function legendLabels(made) {
  const labels = Chart.defaults.plugins.legend.labels.generateLabels(made);
  for (const label of labels) {
    label.text = shortened(made.ctx, label.text, made.width - 60);
    if (label.pointStyle === "line") label.lineDash = made.data.datasets[label.datasetIndex].borderDash || [];
    if (label.pointStyle === "circle") label.pointStyle = dotOf(label.fillStyle);
  }
  return labels;
}

const dots = new Map();  // by colour: a legend asks for them at each update

function dotOf(fill) {
  if (dots.has(fill)) return dots.get(fill);
  const dot = document.createElement("canvas");
  dot.width = dot.height = 8;
  const context = dot.getContext("2d");
  context.fillStyle = fill;
  context.arc(4, 4, 3, 0, 2 * Math.PI);
  context.fill();
  dots.set(fill, dot);
  return dot;
}

function drawChart(chart, index) {
  const bars = chart.categories.length > 0;
  const made = new Chart(document.getElementById("chart-" + index), {
    type: bars ? "bar" : "line",
    data: {
      labels: bars ? chart.categories.map(linesOf) : undefined,
      datasets: withDashes(chart.series).map((series) => bars ? barDataset(series, chart.categories.length) : dataset(series, chart.top)),
    },
    options: {
      animation: false,
      maintainAspectRatio: false,
      // Points of a view are in no order of x.
      parsing: bars || chart.equal ? undefined : false,
      normalized: !bars && !chart.equal,
      interaction: { mode: "nearest", axis: chart.equal ? "xy" : "x", intersect: false },
      onResize: chart.equal ? (resized) => setTimeout(() => { if (resized.ctx) equalise(resized, rangesOf(chart)); }) : undefined,
      plugins: {
        cut: { y: rangesOf(chart).y, equal: chart.equal },
        legend: {
          labels: { color: colour("--text"), sort: (a, b) => a.datasetIndex - b.datasetIndex, usePointStyle: true, pointStyleWidth: 26, boxHeight: 5, generateLabels: legendLabels },
          onClick: (event, item) => showRun(chart.part, made.data.datasets[item.datasetIndex].label, !made.isDatasetVisible(item.datasetIndex)),
        },
        tooltip: { callbacks: {
          title: (items) => tooltipTitle(chart, items),
          label: (item) => [shortened(made.ctx, item.dataset.label || "", made.width - 150), item.formattedValue].filter(Boolean).join(": "),
        } },
      },
      scales: scalesOf(chart),
    },
    plugins: [boxPlugin, cutPlugin],
  });
  if (chart.equal) equalise(made, rangesOf(chart));
  return made;
}

function draw() {
  drawn.forEach((chart) => chart.destroy());
  drawn = description.map(drawChart);
  window.dispatchEvent(new Event("charts-drawn"));
}

/// Draws a chart again in other ranges.
function rescale(chart, made) {
  made.options.scales = scalesOf(chart);
  made.update("none");
}

/// A button below each chart that was cut.
function offerWhole(chart, index) {
  if (!chart.xRange && !chart.yRange) return;
  const button = document.createElement("button");
  const name = () => { button.textContent = chart.whole ? "cut again" : "show all of it"; };
  button.type = "button";
  name();
  button.addEventListener("click", () => {
    chart.whole = !chart.whole;
    drawn[index].destroy();
    drawn[index] = drawChart(chart, index);
    window.dispatchEvent(new Event("charts-drawn"));
    name();
  });
  document.getElementById("chart-" + index).closest("figure").appendChild(button);
}

/// Tables become lists of rows on narrow screens, where each cell says what it is.
function labelCells() {
  document.querySelectorAll("table").forEach((table) => {
    const names = [...table.querySelectorAll("thead th")].map((cell) => cell.textContent);
    if (names.length < 3) return;
    table.classList.add("labelled");
    table.querySelectorAll("tbody tr").forEach((row) => [...row.cells].forEach((cell, i) => { cell.dataset.label = names[i]; }));
  });
}

/// The first number of a cell: of "1.22 [1.10, 1.40]" 1.22. Nothing of "-", "lost" and texts.
function numberOf(cell) {
  const number = /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?/.exec(cell.textContent.trim());
  return number ? Number(number[0]) : null;
}

/** Numbers by value, before texts; texts by their letters. Rows that are equal keep their order. */
function compareCells(a, b) {
  const [x, y] = [numberOf(a), numberOf(b)];
  if (x !== null && y !== null) return x - y;
  if (x !== null || y !== null) return x !== null ? -1 : 1;
  return a.textContent.localeCompare(b.textContent, "en");
}

/// Rows that are fixed (means) stay at the end.
function sortBy(table, column, descending) {
  const rows = [...table.tBodies[0].rows];
  const moved = rows.filter((row) => !row.classList.contains("fixed"));
  const sign = descending ? -1 : 1;
  moved.sort((a, b) => {
    const order = compareCells(a.cells[column], b.cells[column]);
    const missing = (numberOf(a.cells[column]) === null) !== (numberOf(b.cells[column]) === null);
    return missing ? order : sign * order;  // what has no number comes last in either direction
  });
  table.tBodies[0].append(...moved, ...rows.filter((row) => row.classList.contains("fixed")));
}

/// A heading is a button: a click sorts by its column, another one the other way round.
function offerSorting() {
  document.querySelectorAll("table.sortable").forEach((table) => {
    const headings = [...table.querySelectorAll("thead th")];
    headings.forEach((heading, column) => {
      const sort = () => {
        const descending = heading.getAttribute("aria-sort") === "ascending";
        headings.forEach((other) => other.removeAttribute("aria-sort"));
        heading.setAttribute("aria-sort", descending ? "descending" : "ascending");
        sortBy(table, column, descending);
      };
      heading.setAttribute("role", "button");
      heading.tabIndex = 0;
      heading.title = "sort by this column";
      heading.addEventListener("click", sort);
      heading.addEventListener("keydown", (event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        sort();
      });
    });
  });
}

let openedForPaper = [];

/// Paper has no clicks: what is folded is open there.
function unfoldForPaper(paper) {
  if (paper) openedForPaper = [...document.querySelectorAll("details.fold:not([open])")];
  openedForPaper.forEach((details) => { details.open = paper; });
  if (!paper) openedForPaper = [];
}

/// Of charts on paper, in pixels: such that texts are as large as those beside them. page.css has the same shapes.
const paperSize = { view: [270, 210], chart: [300, 220] };
const leastOnPaper = 100;  // height of what is drawn

/// Paper is white, and its columns have other widths than a screen's. A view is fitted at once: paper does not wait.
function drawForPaper(paper) {
  const dark = window.matchMedia("(prefers-color-scheme: dark)").matches;
  document.documentElement.classList.toggle("paper", paper);
  if (dark) draw();
  drawn.forEach((made, index) => {
    const { equal } = description[index];
    const place = made.canvas.parentElement;
    const [width, height] = paperSize[equal ? "view" : "chart"];
    if (description[index].zoom) rescale(description[index], made);
    made.options.devicePixelRatio = paper ? 2 : undefined;
    made.resize(...(paper ? [width, height] : []));
    // Long legends and names below the axis leave little room for what is drawn.
    const missing = paper && !equal ? Math.max(0, leastOnPaper - made.chartArea.height) : 0;
    if (missing > 0) made.resize(width, height + missing);
    place.style.aspectRatio = missing > 0 ? `${width} / ${height + missing}` : "";
    if (equal) equalise(made, rangesOf(description[index]));
  });
}

labelCells();
offerSorting();
draw();
description.forEach(offerWhole);
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
window.addEventListener("beforeprint", () => { unfoldForPaper(true); drawForPaper(true); });
window.addEventListener("afterprint", () => { drawForPaper(false); unfoldForPaper(false); });
