// Axes and colours of charts: the colours are those of the page's style.
"use strict";

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/// Of the style: --series-0 and so on.
const seriesColours = 12;

function strokeOf(series) {
  return colour("--series-" + (series.colour % seriesColours));
}

/// A long title has its unit on a line of its own: it stands along the axis, which may be shorter.
function titleLines(title) {
  return title.length > 24 ? title.split(/ (?=\[)/) : title;
}

function axis(title, extra) {
  return Object.assign({
    type: "linear",
    title: { display: title !== "", text: extra.axis === "y" ? titleLines(title) : title, color: colour("--text") },
    ticks: { color: colour("--faint"), maxTicksLimit: 9 },
    grid: { color: colour("--line") },
  }, extra);
}

/// Makes a unit of x as long as one of y, with the data in the middle; chosen: ranges in place of the data's.
function equalise(chart, chosen) {
  const points = chart.data.datasets.flatMap((set) => set.data).filter((p) => p.x !== null && p.y !== null);
  if (points.length === 0) return;
  const range = (values) => values.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, -Infinity]);
  const [xLow, xHigh] = chosen.x || range(points.map((p) => p.x));
  const [yLow, yHigh] = chosen.y || range(points.map((p) => p.y));
  const area = chart.chartArea;
  const unit = 1.08 * Math.max((xHigh - xLow) / area.width, (yHigh - yLow) / area.height, 1e-6);
  const around = (low, high, pixels) => ({ min: (low + high - unit * pixels) / 2, max: (low + high + unit * pixels) / 2 });
  Object.assign(chart.options.scales.x, around(xLow, xHigh, area.width));
  Object.assign(chart.options.scales.left, around(yLow, yHigh, area.height));
  chart.update("none");
}

/// Numbers of few digits; with exponents where they would be long.
function shortNumber(value) {
  return Math.abs(value) >= 1e6 ? value.toExponential(1) : String(Number(value.toPrecision(4)));
}

/// With as many decimals as neighbours need to differ.
function tickText(value, index, ticks) {
  if (ticks.length < 2 || Math.abs(value) >= 1e6) return shortNumber(value);
  const step = Math.abs(ticks[1].value - ticks[0].value);
  return String(Number(value.toFixed(Math.min(12, Math.max(0, Math.ceil(-Math.log10(step) - 1e-9))))));
}

function shortTicks(scale, text) {
  scale.ticks.callback = text;
  return scale;
}

/// Round numbers only: the ends of an axis that was cut or equalised are none.
function roundTicks(scale) {
  const most = scale.isHorizontal() && scale.width < 300 ? 5 : 7;
  const span = scale.max - scale.min;
  if (!(span > 0)) return;
  const decade = 10 ** Math.floor(Math.log10(span / most));
  const step = [1, 2, 5, 10, 20].map((digit) => digit * decade).find((candidate) => candidate * most >= span);
  scale.ticks = [];
  for (let k = Math.ceil(scale.min / step - 1e-6); k * step <= scale.max + 1e-6 * step; ++k) scale.ticks.push({ value: k * step });
}

/// Ticks at 1, 2 and 5 of each decade, or at each decade where there are many.
function logTicks(scale) {
  const digits = scale.max > 1000 * scale.min ? [1] : [1, 2, 5];
  const inside = (value) => value >= scale.min && value <= scale.max;
  scale.ticks = [];
  for (let power = Math.floor(Math.log10(scale.min)); 10 ** power <= scale.max; ++power) {
    digits.map((digit) => digit * 10 ** power).filter(inside).forEach((value) => scale.ticks.push({ value: value }));
  }
}

/// A name at each of the places 1, 2, ...
function nameTicks(scale, names) {
  Object.assign(scale, { min: 0.5, max: names.length + 0.5, title: Object.assign(scale.title, { display: false }) });
  Object.assign(scale.ticks, { autoSkip: false, maxRotation: 90, callback: (value) => names[Math.round(value) - 1] });
  scale.afterBuildTicks = (built) => { built.ticks = names.map((_, i) => ({ value: i + 1 })); };
}

/// A tick below each box.
function boxTicks(scale, boxes) {
  const places = [...new Set(boxes.flatMap((series) => series.points.map((b) => b[0])))].sort((a, b) => a - b);
  const margin = places.length > 1 ? 0.6 * (places[1] - places[0]) : 1;
  Object.assign(scale, { min: places[0] - margin, max: places[places.length - 1] + margin });
  scale.ticks.callback = (value) => Number(value.toPrecision(2));
  scale.afterBuildTicks = (built) => { built.ticks = places.map((x) => ({ value: x })); };
}

/// The stretch of time that a chart is zoomed to; paper shows all of it.
function zoomOf(chart) {
  return document.documentElement.classList.contains("paper") ? null : chart.zoom || null;
}

/// The ranges that a chart shows; null: all of it.
function rangesOf(chart) {
  return { x: zoomOf(chart) || (chart.whole ? null : chart.xRange), y: chart.whole ? null : chart.yRange };
}

/// The values that points have within a range of x; lines also those at its ends, where no point may be.
function valuesWithin(points, [low, high], line) {
  const values = [];
  points.forEach((point, i) => {
    const next = points[i + 1];
    if (point.y === null) return;
    if (point.x >= low && point.x <= high) values.push(point.y);
    if (!line || !next || next.y === null) return;
    [low, high].filter((x) => point.x < x && x < next.x)
      .forEach((x) => values.push(point.y + (next.y - point.y) * (x - point.x) / (next.x - point.x)));
  });
  return values;
}

/// Fits an axis of values to what its shown series reach within the zoom; a chart that was cut stays within its cut.
function fitToZoom(scale, zoom, cut) {
  const shown = scale.chart.data.datasets.filter((set, index) => set.yAxisID === scale.id && scale.chart.isDatasetVisible(index));
  const values = shown.flatMap((set) => valuesWithin(set.data, zoom, set.showLine));
  if (values.length === 0) return;
  const least = values.reduce((a, b) => Math.min(a, b)), most = values.reduce((a, b) => Math.max(a, b));
  const margin = 0.05 * (most - least) || Math.abs(most) / 10 || 0.5;
  const zero = scale.options.beginAtZero;
  scale.min = zero && least >= 0 ? 0 : least - margin;
  scale.max = zero && most <= 0 ? 0 : most + margin;
  if (!cut) return;
  const beyond = scale.min >= cut[1] || scale.max <= cut[0];
  scale.min = beyond ? cut[0] : Math.max(scale.min, cut[0]);
  scale.max = beyond ? cut[1] : Math.min(scale.max, cut[1]);
}

function limit(scale, range) {
  if (range) Object.assign(scale, { min: range[0], max: range[1] });
}

function scalesOf(chart) {
  const bars = chart.categories.length > 0;
  const scales = {
    x: bars ? axis(chart.x, { type: "category", stacked: true })
      : axis(chart.x, { axis: "x", type: chart.log ? "logarithmic" : "linear" }),
    left: axis(chart.left, { axis: "y", position: "left", beginAtZero: chart.zero, stacked: bars }),
  };
  if (chart.right !== "") {
    scales.right = axis(chart.right, { axis: "y", position: "right", beginAtZero: chart.zero, grid: { drawOnChartArea: false } });
  }
  if (!bars) {
    Object.values(scales).forEach((scale) => { if (scale.type === "linear") shortTicks(scale, tickText).afterBuildTicks = roundTicks; });
  }
  if (chart.log) {
    scales.x.afterBuildTicks = logTicks;
    shortTicks(scales.x, shortNumber).ticks.autoSkip = false;
  }
  const ranges = rangesOf(chart);
  const zoom = zoomOf(chart);
  limit(scales.x, ranges.x);
  if (!zoom) limit(scales.left, ranges.y);
  [scales.left, scales.right].filter((scale) => zoom && scale).forEach((scale) => {
    const cut = scale === scales.left ? ranges.y : null;
    Object.assign(scale, { bounds: "data", afterDataLimits: (made) => fitToZoom(made, zoom, cut) });
  });
  const boxes = chart.series.filter((series) => series.style === "boxes");
  if (boxes.length > 0) boxTicks(scales.x, boxes);
  if (chart.names.length > 0) nameTicks(scales.x, chart.names);
  return scales;
}

/// A long name over several lines, since a tick of one line would leave no room for the bars.
function linesOf(name) {
  const lines = [];
  name.split(" ").forEach((word) => {
    const last = lines.length - 1;
    if (last >= 0 && lines[last].length + word.length < 24) lines[last] += " " + word;
    else lines.push(word);
  });
  return lines;
}
