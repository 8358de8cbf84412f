"""Charts are drawn, whole and with their names, and show on request what is hidden at first."""
from selenium.webdriver.common.by import By

# Scrolls to every chart as a reader would, by screens, and returns the names of those with few pixels in the colour of a
# series between their axes: axes and texts are grey, and the legend shows the colours as well. "drawn" is what the page
# has drawn.
UNDRAWN = """
const [least, done] = arguments;
const style = getComputedStyle(document.documentElement);
const colours = [0, 1, 2, 3, 4, 5, 6].map((i) => style.getPropertyValue("--series-" + i).trim())
  .map((text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16)));
const copy = document.createElement("canvas");
const context = copy.getContext("2d", { willReadFrequently: true });
function coloured(canvas) {
  const area = drawn[Number(canvas.id.slice("chart-".length))].chartArea;
  const scale = canvas.width / canvas.clientWidth;
  copy.width = scale * area.width;
  copy.height = scale * area.height;
  context.drawImage(canvas, -Math.floor(scale * area.left), -Math.floor(scale * area.top));
  const pixels = context.getImageData(0, 0, copy.width, copy.height).data;
  let count = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    if (pixels[i + 3] < 100) continue;
    if (colours.some((c) => c.every((value, k) => Math.abs(value - pixels[i + k]) < 40))) ++count;
  }
  return count;
}
(async () => {
  const undrawn = [];
  for (const canvas of document.querySelectorAll(".canvas canvas")) {
    const box = canvas.getBoundingClientRect();
    if (box.top < 0 || box.bottom > innerHeight) {
      canvas.scrollIntoView({ block: "start" });
      await new Promise((settled) => requestAnimationFrame(() => requestAnimationFrame(settled)));
    }
    if (coloured(canvas) < least) undrawn.push(canvas.getAttribute("aria-label"));
  }
  return undrawn;
})().then(done, (error) => done(["none could be read: " + error]));
"""
# Charts with series that are drawn on request, and where the names of these stand, from the middle of the chart.
ON_REQUEST = """
return drawn.map((chart) => [chart.canvas, chart.legend.legendItems.map((item, i) => [item, chart.legend.legendHitBoxes[i]])
  .filter(([item, box]) => chart.data.datasets[item.datasetIndex].hidden)
  .map(([item, box]) => [item.text, box.left + box.width / 2 - chart.width / 2, box.top + box.height / 2 - chart.height / 2])])
  .filter(([canvas, names]) => names.length > 0);
"""
# The picture between a chart's axes.
AREA = """
const area = drawn[Number(arguments[0].id.slice("chart-".length))].chartArea;
const scale = arguments[0].width / arguments[0].clientWidth;
const canvas = document.createElement("canvas");
canvas.width = scale * area.width;
canvas.height = scale * area.height;
canvas.getContext("2d").drawImage(arguments[0], -scale * area.left, -scale * area.top);
return canvas.toDataURL();
"""
# Charts of boxes whose triangles do not stand over the box that they are of: cut low, so that all are beyond.
ASTRAY = """
return drawn.filter((chart) => {
  const sets = chart.data.datasets.filter((set) => set.boxes);
  if (sets.length < 2) return false;
  const cut = chart.options.plugins.cut, whole = cut.y;
  cut.y = [0, 1e-9];
  const offsets = boxPlaces(chart).offsets;
  const expected = sets.flatMap((set) => set.boxes.map((box) =>
    chart.scales.x.getPixelForValue(box[0]) + offsets.get(chart.data.datasets.indexOf(set))));
  const tips = [], lineTo = chart.ctx.lineTo;
  chart.ctx.lineTo = (x, y) => { if (y === chart.chartArea.top) tips.push(x); };
  cutPlugin.afterDatasetsDraw(chart);
  chart.ctx.lineTo = lineTo;
  cut.y = whole;
  return tips.length === 0 || tips.some((x) => !expected.some((other) => Math.abs(x - other) < 1));
}).map((chart) => chart.canvas.getAttribute("aria-label"));
"""
# Charts whose legend is wider than they are; symbols and margins take the rest.
CUT_NAMES = """
return drawn.filter((made) => {
  made.ctx.font = Chart.defaults.font.size + "px " + Chart.defaults.font.family;
  return made.legend.legendItems.some((item) => made.ctx.measureText(item.text).width > made.width - 50);
}).map((made) => made.canvas.getAttribute("aria-label"));
"""


def read_charts(reader, scheme):
    driver = reader.driver
    for chart in driver.execute_async_script(UNDRAWN, 8):
        reader.complain(f"{scheme}: nothing is drawn: {chart}")
    for chart in driver.execute_script(ASTRAY):
        reader.complain(f"{scheme}: triangles stand beside their boxes: {chart}")
    for chart in driver.execute_script(CUT_NAMES):
        reader.complain(f"{scheme}: names of its legend are cut: {chart}")
    return len(driver.find_elements(By.CSS_SELECTOR, ".canvas canvas"))


def ask_for_hidden_series(reader):
    driver = reader.driver
    asked = 0
    for canvas, names in driver.execute_script(ON_REQUEST):
        reader.show(canvas)
        for name, right, down in names:
            before = driver.execute_script(AREA, canvas)
            reader.pointer().move_to_element_with_offset(canvas, int(right), int(down)).click().perform()
            reader.settle()
            asked += 1
            if driver.execute_script(AREA, canvas) == before:
                reader.complain(f"a click on '{name}' shows nothing: {canvas.get_attribute('aria-label')}")
    return asked
