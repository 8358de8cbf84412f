// Draws the charts of a page from the JSON beside it, in the colours of the page's style.
"use strict";
const description = JSON.parse(document.getElementById("charts").textContent);
let drawn = [];

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function axis(title, extra) {
  return Object.assign({
    type: "linear",
    title: { display: title !== "", text: title, color: colour("--text") },
    ticks: { color: colour("--faint"), maxTicksLimit: 9 },
    grid: { color: colour("--line") },
  }, extra);
}

function dataset(series) {
  const stroke = colour("--series-" + (series.colour % 5));
  return {
    label: series.label,
    data: series.points.map(([x, y]) => ({ x: x, y: y })),
    yAxisID: series.right ? "right" : "left",
    borderColor: stroke,
    backgroundColor: series.style === "bars" ? stroke + "66" : stroke,
    borderWidth: series.style === "dots" ? 0 : 1.3,
    pointRadius: series.style === "dots" ? 2.5 : 0,
    pointHitRadius: 6,
    showLine: series.style !== "dots",
    stepped: series.style === "bars" ? "middle" : false,
    fill: series.style === "bars" ? "origin" : false,
    spanGaps: false,
  };
}

function draw() {
  drawn.forEach((chart) => chart.destroy());
  drawn = description.map((chart, index) => {
    const scales = { x: axis(chart.x, { axis: "x" }), left: axis(chart.left, { axis: "y", position: "left", beginAtZero: chart.zero }) };
    if (chart.right !== "") {
      scales.right = axis(chart.right, { axis: "y", position: "right", beginAtZero: chart.zero, grid: { drawOnChartArea: false } });
    }
    return new Chart(document.getElementById("chart-" + index), {
      type: "line",
      data: { datasets: chart.series.map(dataset) },
      options: {
        animation: false,
        maintainAspectRatio: false,
        parsing: false,
        normalized: true,
        interaction: { mode: "nearest", axis: "x", intersect: false },
        plugins: {
          legend: { labels: { color: colour("--text"), boxWidth: 14, boxHeight: 3 } },
          tooltip: { callbacks: { title: (items) => chart.x + ": " + items[0].parsed.x } },
        },
        scales: scales,
      },
    });
  });
}

draw();
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
