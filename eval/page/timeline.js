// One time for all that a part of the page shows: a slider, lines in its charts over time, dots in its views, the
// nearest image. Cameras in 3D views follow the event "time-chosen".
"use strict";
(function () {
  const steps = 1000;

  function element(tag, parent, text) {
    const made = document.createElement(tag);
    if (text !== undefined) made.textContent = text;
    parent.appendChild(made);
    return made;
  }

  function overlay(index, name) {
    const made = element("div", document.getElementById("chart-" + index).parentElement);
    made.className = name;
    made.hidden = true;
    return made;
  }

  /// Of points in order of x, the y that is nearest to it; nothing where a curve has a gap or does not reach.
  function valueAt(points, x, reach) {
    let low = 0, high = points.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (points[middle][0] <= x) low = middle; else high = middle;
    }
    const best = [points[low], points[high]].filter((p) => p && p[1] !== null)
      .sort((a, b) => Math.abs(a[0] - x) - Math.abs(b[0] - x))[0];
    return best && Math.abs(best[0] - x) <= reach ? best[1] : null;
  }

  function start(host) {
    const part = Number(host.id.slice("part-".length));
    const all = description.map((chart, index) => ({ chart: chart, index: index })).filter(({ chart }) => chart.part === part);
    const timed = all.filter(({ chart }) => chart.x === "time [s]" && chart.categories.length === 0);
    const pictures = [...host.querySelectorAll("figure[data-time]")]
      .map((figure) => ({ figure: figure, time: Number(figure.dataset.time), image: figure.querySelector("img") }));
    const strip = pictures.filter(({ figure }) => figure.closest(".strip"));
    const ends = timed.flatMap(({ chart }) => chart.series.flatMap((s) => s.points.length ? [s.points[s.points.length - 1][0]] : []));
    const end = Math.max(0, ...ends, ...pictures.map((p) => p.time));
    if (timed.length === 0 || end === 0) return;

    // The bar, below the heading and its first table.
    const bar = document.createElement("div");
    bar.className = "timebar";
    const first = host.querySelector("h3[id]");
    const below = first && first.parentElement.tagName === "SUMMARY" ? first.closest("details") : first;
    (below ? below.parentElement : host).insertBefore(bar, below);
    const preview = strip.length > 0 ? element("img", bar) : null;
    if (preview) preview.alt = "";
    const controls = element("div", bar);
    const legend = element("div", controls);
    legend.className = "legend";
    const line = element("label", controls, "time ");
    const slider = element("input", line);
    Object.assign(slider, { type: "range", min: 0, max: end, step: end / steps, value: 0 });
    const readout = element("output", controls);

    // The runs: those of the first chart that names several.
    const named = all.map(({ chart }) => chart).find((chart) => chart.equal) || timed[0].chart;
    withDashes(named.series).forEach((series) => {
      const button = element("button", legend);
      button.type = "button";
      button.append(lineSwatch(series), series.label);
      button.dataset.run = series.label;
      button.setAttribute("aria-pressed", String(!series.hidden));
      button.addEventListener("click", () => showRun(part, series.label, button.getAttribute("aria-pressed") !== "true"));
    });
    window.addEventListener("run-shown", (event) => {
      if (event.detail.part !== part) return;
      legend.querySelectorAll("button").forEach((button) => {
        if (isOf(button.dataset.run, event.detail.run)) button.setAttribute("aria-pressed", String(event.detail.visible));
      });
      show();
    });

    const errors = timed.find(({ chart }) => chart.left === "error [cm]");
    const reach = end / 50;
    const cursors = timed.map(({ index }) => ({ index: index, line: overlay(index, "cursor") }));
    const places = all.filter(({ chart }) => chart.equal).map(({ chart, index }) => ({ index: index,
      axes: [chart.x, chart.left].map((name) => timed.find((other) => other.chart.left === name)),
      dots: chart.series.map((series) => ({ series: series, dot: overlay(index, "place") })) }))
      .filter(({ axes }) => axes.every((found) => found));
    let time = 0;
    let waiting = false;

    function showCursors() {
      cursors.forEach(({ index, line }) => {
        const { scales, chartArea } = drawn[index];
        const x = scales.x.getPixelForValue(time);
        line.hidden = !(x >= chartArea.left - 1 && x <= chartArea.right + 1);
        Object.assign(line.style, { left: x + "px", top: chartArea.top + "px", height: chartArea.bottom - chartArea.top + "px" });
      });
      places.forEach(({ index, axes, dots }) => {
        const { scales, chartArea } = drawn[index];
        dots.forEach(({ series, dot }) => {
          const at = axes.map(({ chart }) => chart.series.find((other) => other.label === series.label))
            .map((curve) => curve ? valueAt(curve.points, time, reach) : null);
          const x = scales.x.getPixelForValue(at[0]), y = scales.left.getPixelForValue(at[1]);
          dot.hidden = at.includes(null) || series.hidden || x < chartArea.left || x > chartArea.right || y < chartArea.top || y > chartArea.bottom;
          dot.style.background = "var(--series-" + (series.colour % seriesColours) + ")";
          Object.assign(dot.style, { left: x + "px", top: y + "px" });
        });
      });
    }

    function showPictures() {
      const nearest = (list) => list.reduce((best, p) => !best || Math.abs(p.time - time) < Math.abs(best.time - time) ? p : best, null);
      const current = nearest(strip);
      if (preview && preview.src !== current.image.src) preview.src = current.image.src;
      pictures.forEach((p) => p.figure.classList.toggle("current", p === current || Math.abs(p.time - time) <= end / steps));
    }

    function show() {
      waiting = false;
      showCursors();
      showPictures();
      const values = errors ? errors.chart.series.filter((series) => !series.hidden)
        .map((series) => [series.label, valueAt(series.points, time, reach)]).filter(([, value]) => value !== null)
        .map(([label, value]) => label + " " + Number(value.toPrecision(3)) + " cm") : [];
      readout.textContent = time.toFixed(2) + " s" + (values.length > 0 ? ": position error " + values.slice(0, 6).join(", ") : "");
      slider.setAttribute("aria-valuetext", time.toFixed(2) + " seconds");
    }

    function choose(chosen) {
      time = Math.min(end, Math.max(0, chosen));
      slider.value = time;
      window.dispatchEvent(new CustomEvent("time-chosen", { detail: { part: part, time_s: time } }));
      if (!waiting) requestAnimationFrame(show);
      waiting = true;
    }

    slider.addEventListener("input", () => choose(Number(slider.value)));
    timed.forEach(({ index }) => {
      const canvas = document.getElementById("chart-" + index);
      canvas.tabIndex = 0;
      canvas.addEventListener("pointermove", (event) => {
        const { scales, chartArea } = drawn[index];
        if (event.offsetX >= chartArea.left && event.offsetX <= chartArea.right) choose(scales.x.getValueForPixel(event.offsetX));
      });
      canvas.addEventListener("keydown", (event) => {
        const turn = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
        if (turn === undefined) return;
        event.preventDefault();
        choose(time + turn * (event.shiftKey ? 10 : 1) * end / 200);
      });
    });
    pictures.forEach(({ figure, time: at }) => {
      const button = element("button", figure.querySelector("figcaption"), at.toFixed(2) + " s");
      button.type = "button";
      button.title = "show this time everywhere";
      button.addEventListener("click", () => choose(at));
    });
    window.addEventListener("charts-drawn", show);
    window.addEventListener("resize", () => setTimeout(show, 100));
    show();
  }

  document.querySelectorAll("section.timeline").forEach(start);
})();
