// What charts draw beside lines: box plots, and marks where a curve leaves a chart that was cut.
"use strict";

function clipToArea(chart) {
  const area = chart.chartArea;
  chart.ctx.beginPath();
  chart.ctx.rect(area.left, area.top, area.width, area.height);
  chart.ctx.clip();
}

/// Where the boxes of each visible series stand from the place of their group, by the series' number, and how much room
/// each has, in pixels.
function boxPlaces(chart) {
  const sets = chart.data.datasets.map((set, index) => ({ set: set, index: index })).filter(({ set }) => set.boxes);
  const visible = sets.filter(({ index }) => chart.isDatasetVisible(index));
  const places = [...new Set(visible.flatMap(({ set }) => set.boxes.map((b) => b[0])))].sort((a, b) => a - b);
  const gaps = places.slice(1).map((x, i) => chart.scales.x.getPixelForValue(x) - chart.scales.x.getPixelForValue(places[i]));
  const room = Math.min(90, 0.75 * Math.min(...gaps, chart.chartArea.width / 3));
  const width = room / visible.length;
  return { width: width, offsets: new Map(visible.map(({ index }, place) => [index, (place + 0.5) * width - room / 2])) };
}

/// Boxes from the lower to the upper quartile, with the median and whiskers; those at one place stand side by side.
const boxPlugin = {
  id: "boxes",
  afterDatasetsDraw(chart) {
    const { width, offsets } = boxPlaces(chart);
    if (offsets.size === 0) return;
    const context = chart.ctx;
    context.save();
    clipToArea(chart);
    offsets.forEach((offset, index) => {
      const set = chart.data.datasets[index];
      context.strokeStyle = set.borderColor;
      context.lineWidth = 1.4;
      set.boxes.forEach(([x, ...values]) => {
        const middle = chart.scales.x.getPixelForValue(x) + offset;
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

/// Triangles at the upper edge, in the colour of the curve or over the box that lies above it.
const cutPlugin = {
  id: "cut",
  afterDatasetsDraw(chart) {
    const cut = chart.options.plugins.cut;
    if (!cut.y || cut.equal) return;
    const context = chart.ctx;
    const top = chart.chartArea.top;
    const { offsets } = boxPlaces(chart);
    chart.data.datasets.forEach((set, index) => {
      if (!chart.isDatasetVisible(index) || set.yAxisID !== "left" || set.band) return;
      let last = -Infinity;
      set.data.forEach((point) => {
        if (!(point.y > cut.y[1])) return;
        const x = chart.scales.x.getPixelForValue(point.x) + (offsets.get(index) || 0);
        if (Math.abs(x - last) < 14 || x < chart.chartArea.left || x > chart.chartArea.right) return;
        last = x;
        context.fillStyle = set.borderColor;
        context.beginPath();
        context.moveTo(x - 5, top + 8); context.lineTo(x + 5, top + 8); context.lineTo(x, top);
        context.fill();
      });
    });
  },
};
