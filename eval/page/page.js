// Draws the charts of a page from the JSON beside it, in the colours of the page's style.
"use strict";
const description = JSON.parse(document.getElementById("charts").textContent);
let drawn = [];

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function strokeOf(series) {
  return colour("--series-" + (series.colour % 8));
}

function axis(title, extra) {
  return Object.assign({
    type: "linear",
    title: { display: title !== "", text: title, color: colour("--text") },
    ticks: { color: colour("--faint"), maxTicksLimit: 9 },
    grid: { color: colour("--line") },
  }, extra);
}

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

function dataset(series) {
  const stroke = strokeOf(series);
  const boxes = series.style === "boxes";
  const segments = series.style === "segments";
  return {
    label: series.label,
    // A box is drawn by a plugin; its two points make the axes reach its whiskers.
    data: boxes ? series.points.flatMap((b) => [{ x: b[0], y: b[1] }, { x: b[0], y: b[5] }])
      : segments ? segmentPoints(series.points) : series.points.map(([x, y]) => ({ x: x, y: y })),
    hidden: series.hidden,
    boxes: boxes ? series.points : null,
    yAxisID: series.right ? "right" : "left",
    borderColor: series.style === "backdrop" ? stroke + "66" : stroke,
    backgroundColor: series.style === "bars" ? stroke + "66" : stroke,
    borderWidth: series.style === "dots" || boxes ? 0 : series.style === "backdrop" ? 4 : segments ? 0.8 : 1.3,
    borderDash: series.dashes,
    pointStyle: series.style === "dots" ? "circle" : ["line", "backdrop", "segments"].includes(series.style) ? "line" : "rect",
    // Later lines are dashed: they lie on the earlier ones.
    order: series.style === "backdrop" ? 1 : segments ? 0.5 : -series.place,
    pointRadius: series.style === "dots" ? 2.5 : 0,
    pointHitRadius: 6,
    showLine: series.style !== "dots" && !boxes,
    stepped: series.style === "bars" ? "middle" : false,
    fill: series.style === "bars" ? "origin" : false,
    spanGaps: false,
  };
}

/// Bars that stand on one another, one stack a category.
function barDataset(series, count) {
  const stroke = strokeOf(series);
  const data = new Array(count).fill(null);
  series.points.forEach(([x, y]) => { data[x] = y; });
  return { label: series.label, data: data, backgroundColor: stroke, borderColor: colour("--panel"), borderWidth: 1,
    yAxisID: "left" };
}

/// Boxes from the lower to the upper quartile, with the median and whiskers; those at one place stand side by side.
const boxPlugin = {
  id: "boxes",
  afterDatasetsDraw(chart) {
    const sets = chart.data.datasets.map((set, index) => ({ set: set, index: index })).filter(({ set }) => set.boxes);
    const visible = sets.filter(({ index }) => chart.isDatasetVisible(index));
    if (visible.length === 0) return;
    const context = chart.ctx;
    const places = [...new Set(visible.flatMap(({ set }) => set.boxes.map((b) => b[0])))].sort((a, b) => a - b);
    const gaps = places.slice(1).map((x, i) => chart.scales.x.getPixelForValue(x) - chart.scales.x.getPixelForValue(places[i]));
    const room = Math.min(90, 0.75 * Math.min(...gaps, chart.chartArea.width / 3));
    const width = room / visible.length;
    context.save();
    visible.forEach(({ set }, place) => {
      context.strokeStyle = set.borderColor;
      context.lineWidth = 1.4;
      set.boxes.forEach(([x, ...values]) => {
        const middle = chart.scales.x.getPixelForValue(x) + (place + 0.5) * width - room / 2;
        const [min, low, median, high, max] = values.map((value) => chart.scales.left.getPixelForValue(value));
        const half = 0.38 * width;
        context.beginPath();
        context.moveTo(middle, min); context.lineTo(middle, low);
        context.moveTo(middle, high); context.lineTo(middle, max);
        context.moveTo(middle - half / 2, min); context.lineTo(middle + half / 2, min);
        context.moveTo(middle - half / 2, max); context.lineTo(middle + half / 2, max);
        context.rect(middle - half, high, 2 * half, low - high);
        context.moveTo(middle - half, median); context.lineTo(middle + half, median);
        context.fillStyle = set.borderColor + "33";
        context.fillRect(middle - half, high, 2 * half, low - high);
        context.stroke();
      });
    });
    context.restore();
  },
};

/// Makes a unit of x as long as one of y, with the data in the middle.
function equalise(chart) {
  const points = chart.data.datasets.flatMap((set) => set.data).filter((p) => p.x !== null && p.y !== null);
  if (points.length === 0) return;
  const range = (values) => values.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, -Infinity]);
  const [xLow, xHigh] = range(points.map((p) => p.x));
  const [yLow, yHigh] = range(points.map((p) => p.y));
  const area = chart.chartArea;
  const unit = 1.08 * Math.max((xHigh - xLow) / area.width, (yHigh - yLow) / area.height, 1e-6);
  const around = (low, high, pixels) => ({ min: (low + high - unit * pixels) / 2, max: (low + high + unit * pixels) / 2 });
  Object.assign(chart.options.scales.x, around(xLow, xHigh, area.width));
  Object.assign(chart.options.scales.left, around(yLow, yHigh, area.height));
  chart.update("none");
}

function shortTicks(scale) {
  scale.ticks.callback = (value) => Number(value.toPrecision(3));
  return scale;
}

/// Round numbers only: the ends of an equalised axis are none.
function roundTicks(scale) {
  const step = [1, 2, 5, 10].map((digit) => digit * 10 ** Math.floor(Math.log10((scale.max - scale.min) / 7)))
    .find((candidate) => candidate * 7 >= scale.max - scale.min);
  scale.ticks = [];
  for (let k = Math.ceil(scale.min / step); k * step <= scale.max; ++k) scale.ticks.push({ value: k * step });
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
  if (chart.equal) Object.values(scales).forEach((scale) => { shortTicks(scale).afterBuildTicks = roundTicks; });
  if (chart.log) {
    scales.x.afterBuildTicks = logTicks;
    shortTicks(scales.x).ticks.autoSkip = false;
  }
  const boxes = chart.series.filter((series) => series.style === "boxes");
  if (boxes.length > 0) {
    const places = [...new Set(boxes.flatMap((series) => series.points.map((b) => b[0])))].sort((a, b) => a - b);
    const margin = places.length > 1 ? 0.6 * (places[1] - places[0]) : 1;
    scales.x.min = places[0] - margin;
    scales.x.max = places[places.length - 1] + margin;
    scales.x.ticks.callback = (value) => Number(value.toPrecision(3));
    scales.x.afterBuildTicks = (scale) => { scale.ticks = places.map((x) => ({ value: x })); };
  }
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

function draw() {
  drawn.forEach((chart) => chart.destroy());
  drawn = description.map((chart, index) => {
    const bars = chart.categories.length > 0;
    const made = new Chart(document.getElementById("chart-" + index), {
      type: bars ? "bar" : "line",
      data: {
        labels: bars ? chart.categories.map(linesOf) : undefined,
        datasets: withDashes(chart.series).map((series) => bars ? barDataset(series, chart.categories.length) : dataset(series)),
      },
      options: {
        animation: false,
        maintainAspectRatio: false,
        // Points of a view are in no order of x.
        parsing: bars || chart.equal ? undefined : false,
        normalized: !bars && !chart.equal,
        interaction: { mode: "nearest", axis: chart.equal ? "xy" : "x", intersect: false },
        onResize: chart.equal ? (resized) => setTimeout(() => { if (resized.ctx) equalise(resized); }) : undefined,
        plugins: {
          legend: { labels: { color: colour("--text"), sort: (a, b) => a.datasetIndex - b.datasetIndex, usePointStyle: true, pointStyleWidth: 26, boxHeight: 5 } },
          tooltip: { callbacks: bars ? { title: (items) => chart.categories[items[0].dataIndex] } : { title: (items) => chart.x + ": " + items[0].parsed.x } },
        },
        scales: scalesOf(chart),
      },
      plugins: [boxPlugin],
    });
    if (chart.equal) equalise(made);
    return made;
  });
}

draw();
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
