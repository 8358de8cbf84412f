// Zoom of charts over time: what is dragged over in one is shown by all of its part. A double click, a button and Escape
// show the whole again; + and - zoom around the chosen time, which the charts follow.
"use strict";
(function () {
  const leastDrag = 6;  // in pixels: less is a click
  const deepest = 1e-4;  // of the whole

  const overTime = description.map((chart, index) => ({ chart: chart, index: index }))
    .filter(({ chart }) => chart.x === "time [s]" && chart.categories.length === 0 && !chart.log);
  const parts = new Map();
  overTime.forEach((place) => parts.set(place.chart.part, [...(parts.get(place.chart.part) || []), place]));
  parts.forEach(start);

  function canvasOf(index) {
    return document.getElementById("chart-" + index);
  }

  function isInside(event, { left, right, top, bottom }) {
    return event.offsetX >= left && event.offsetX <= right && event.offsetY >= top && event.offsetY <= bottom;
  }

  /// A button above each chart, which is there while something is zoomed.
  function wholeButtons(charts, show) {
    return charts.map(({ index }) => {
      const figure = canvasOf(index).closest("figure");
      const button = document.createElement("button");
      Object.assign(button, { type: "button", className: "unzoom", hidden: true });
      button.textContent = figure.closest(".timeline") ? "whole run" : "all of the time";
      button.addEventListener("click", () => {
        show();
        canvasOf(index).focus({ preventScroll: true });
      });
      figure.insertBefore(button, figure.firstChild);
      return button;
    });
  }

  /// The end of a drag is no click, which might hide a run whose name it ends at.
  function swallowClick() {
    const swallow = (event) => event.stopPropagation();
    window.addEventListener("click", swallow, { capture: true, once: true });
    setTimeout(() => window.removeEventListener("click", swallow, { capture: true }));
  }

  /// Calls zoom with the range of x that is dragged over.
  function watchDrags(index, zoom) {
    const canvas = canvasOf(index);
    const range = document.createElement("div");
    Object.assign(range, { className: "range", hidden: true });
    canvas.parentElement.appendChild(range);
    let from = null;
    const within = (x) => Math.min(drawn[index].chartArea.right, Math.max(drawn[index].chartArea.left, x));
    const stop = () => {
      from = null;
      range.hidden = true;
    };
    canvas.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || !event.isPrimary || !isInside(event, drawn[index].chartArea)) return;
      from = event.offsetX;
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (from === null) return;
      const to = within(event.offsetX);
      const { top, height } = drawn[index].chartArea;
      range.hidden = Math.abs(to - from) < leastDrag;
      Object.assign(range.style, { left: Math.min(from, to) + "px", width: Math.abs(to - from) + "px", top: top + "px", height: height + "px" });
    });
    canvas.addEventListener("pointerup", (event) => {
      if (from === null) return;
      const ends = [from, within(event.offsetX)].sort((a, b) => a - b);
      stop();
      if (ends[1] - ends[0] < leastDrag) return;
      swallowClick();
      zoom(ends.map((x) => drawn[index].scales.x.getValueForPixel(x)));
    });
    canvas.addEventListener("pointercancel", stop);
    canvas.addEventListener("keydown", (event) => { if (event.key === "Escape") stop(); });
  }

  function start(charts, part) {
    const times = charts.flatMap(({ chart }) => chart.series.flatMap((series) => series.points.map((point) => point[0])));
    const first = times.reduce((a, b) => Math.min(a, b), Infinity), last = times.reduce((a, b) => Math.max(a, b), -Infinity);
    const whole = last - first;
    if (!(whole > 0)) return;
    let shown = null;
    let time = null;
    const buttons = wholeButtons(charts, () => show(null));

    function show(range) {
      shown = range;
      charts.forEach(({ chart, index }) => {
        chart.zoom = range;
        rescale(chart, drawn[index]);
      });
      buttons.forEach((button) => { button.hidden = range === null; });
      window.dispatchEvent(new Event("charts-drawn"));
    }

    /// Of this length, around a time, as far as there is something.
    function showAround(middle, length) {
      if (length >= whole) return show(null);
      const low = Math.min(last - length, Math.max(first, middle - length / 2));
      show([low, low + length]);
    }

    function zoom([low, high]) {
      const ends = [Math.max(first, low), Math.min(last, high)];
      if (ends[1] - ends[0] >= deepest * whole) show(ends);
      else showAround((low + high) / 2, deepest * whole);
    }

    window.addEventListener("time-chosen", (event) => {
      if (event.detail.part !== part) return;
      time = event.detail.time_s;
      if (!shown) return;
      const length = shown[1] - shown[0];
      // The pointer at the edge of a chart may be a rounding beyond it.
      if (time < shown[0] - length / 100 || time > shown[1] + length / 100) showAround(time, length);
    });
    charts.forEach(({ index }) => {
      const canvas = canvasOf(index);
      canvas.classList.add("zoomable");
      canvas.tabIndex = 0;
      watchDrags(index, zoom);
      canvas.addEventListener("dblclick", (event) => { if (shown && isInside(event, drawn[index].chartArea)) show(null); });
      canvas.addEventListener("keydown", (event) => {
        if (event.ctrlKey || event.metaKey || event.altKey) return;
        const [low, high] = shown || [first, last];
        const middle = time === null ? (low + high) / 2 : time;
        if (event.key === "+") showAround(middle, Math.max(deepest * whole, (high - low) / 2));
        else if (event.key === "-" && shown) showAround(middle, 2 * (high - low));
        else if (event.key === "Escape" && shown) show(null);
      });
    });
  }
})();
