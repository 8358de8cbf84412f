#!/usr/bin/env python3
"""Opens a page in headless Chromium as a reader would: scrolls to every part, in light and dark, zooms the charts, turns the
meshes, opens what is folded away, and fails on any message of the console, chart without a drawing or mesh without a picture.

Usage: page_test.py PAGE.html [SCREENSHOT_FOLDER]

Needs Selenium and ChromeDriver (Debian: python3-selenium, chromium-driver); exit code 77 where they are missing.
"""
import pathlib
import sys
import time

try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.chrome.service import Service
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

DRIVER = "/usr/bin/chromedriver"
# How many pixels of a chart have the colour of a series, about: axes and texts are grey.
SERIES = """
const canvas = document.createElement("canvas");
canvas.width = arguments[0].width;
canvas.height = arguments[0].height;
const context = canvas.getContext("2d", { willReadFrequently: true });
context.drawImage(arguments[0], 0, 0);
// Without the legend, which shows the colours as well. "drawn" is what the page has drawn.
const area = drawn[Number(arguments[0].id.slice("chart-".length))].chartArea;
const scale = canvas.width / arguments[0].clientWidth;
const pixels = context.getImageData(scale * area.left, scale * area.top, scale * area.width, scale * area.height).data;
const style = getComputedStyle(document.documentElement);
const colours = [0, 1, 2, 3, 4, 5, 6].map((i) => style.getPropertyValue("--series-" + i).trim())
  .map((text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16)));
let count = 0;
for (let i = 0; i < pixels.length; i += 4) {
  if (pixels[i + 3] < 100) continue;
  if (colours.some((c) => c.every((value, k) => Math.abs(value - pixels[i + k]) < 40))) ++count;
}
return count;
"""
# A view that shows a mesh has more than one colour.
DRAWN = """
const canvas = document.createElement("canvas");
canvas.width = arguments[0].width;
canvas.height = arguments[0].height;
const context = canvas.getContext("2d", { willReadFrequently: true });
context.drawImage(arguments[0], 0, 0);
const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
const colours = new Set();
for (let i = 0; i < pixels.length && colours.size < 8; i += 4)
  colours.add(pixels[i] << 24 | pixels[i + 1] << 16 | pixels[i + 2] << 8 | pixels[i + 3]);
return colours.size;
"""
# Where the names of the series stand that are drawn on request, from the middle of the chart.
ON_REQUEST = """
const chart = drawn[Number(arguments[0].id.slice("chart-".length))];
return chart.legend.legendItems.map((item, i) => [item, chart.legend.legendHitBoxes[i]])
  .filter(([item, box]) => chart.data.datasets[item.datasetIndex].hidden)
  .map(([item, box]) => [item.text, box.left + box.width / 2 - chart.width / 2, box.top + box.height / 2 - chart.height / 2]);
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
# Cells of tables whose right end is beyond the screen, where one would have to scroll for them.
OUT_OF_SIGHT = """
return [...document.querySelectorAll("table.labelled td")].filter((cell) => cell.textContent !== "" && cell.getBoundingClientRect().right > innerWidth + 1)
  .map((cell) => cell.textContent);
"""
CUT_TABLES = """
return [...document.querySelectorAll(".scroll")].filter((box) => getComputedStyle(box).overflowX !== "visible").length;
"""
# Charts that paper shows low, or with the title of an axis cut; words of tables that may be broken anywhere.
UNREADABLE_ON_PAPER = """
const charts = drawn.filter((chart) => {
  const cut = Object.values(chart.scales).some((scale) => {
    if (scale.isHorizontal()) return false;
    chart.ctx.font = Chart.helpers.toFont(scale.options.title.font).string;
    const room = 2 * Math.min((scale.top + scale.bottom) / 2, chart.height - (scale.top + scale.bottom) / 2);
    return [scale.options.title.text].flat().some((line) => chart.ctx.measureText(line).width > room);
  });
  return cut || chart.chartArea.height * chart.canvas.clientHeight / chart.height < 60;
}).map((chart) => chart.canvas.getAttribute("aria-label"));
const cells = [...document.querySelectorAll("td")].filter((cell) => getComputedStyle(cell).overflowWrap === "anywhere");
return charts.concat(cells.map((cell) => cell.textContent));
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
# Whether a table that is wider than its place has a sign of it, and keeps its first column when it is moved.
MOVED_TABLE = """
const box = [...document.querySelectorAll(".scroll")].find((other) => other.querySelector("th"));
const table = box.querySelector("table"), cell = box.querySelector("td");
table.style.minWidth = "2000px";
box.scrollLeft = 400;
const kept = Math.abs(cell.getBoundingClientRect().left - box.getBoundingClientRect().left) < 2;
const told = getComputedStyle(box).backgroundImage.includes("gradient");
table.style.minWidth = "";
return kept && told;
"""
# Positions of the recording's camera that are out of sight when a model is seen first.
PATH_OUT_OF_SIGHT = """
const [index] = arguments;
const scene = JSON.parse(document.getElementById("scenes").textContent)[index];
const camera = new THREE.PerspectiveCamera(45, 1.3, 0.01, 100);
fittedView(camera, scene, [new THREE.Vector3(...scene.low), new THREE.Vector3(...scene.high)]);
camera.updateMatrixWorld();
let count = 0;
scene.paths.forEach((path) => {
  for (let i = 0; i + 8 <= path.poses.length; i += 8) {
    const seen = new THREE.Vector3(...path.poses.slice(i + 1, i + 4)).project(camera);
    if (Math.abs(seen.x) > 1 || Math.abs(seen.y) > 1 || seen.z > 1) ++count;
  }
});
return count;
"""
# On a canvas, from its middle.
DOUBLE_CLICK = """
const [canvas, right, down] = arguments;
const box = canvas.getBoundingClientRect();
canvas.dispatchEvent(new MouseEvent("dblclick", {bubbles: true, clientX: box.left + box.width / 2 + right,
                                                 clientY: box.top + box.height / 2 + down}));
"""
LISTEN = """
window.chosenTimes = [];
window.addEventListener("time-chosen", (event) => window.chosenTimes.push(event.detail.time_s));
"""
# In how many charts of a part a run is drawn.
SHOWN = """
const [part, run] = arguments;
return description.filter((chart, i) => chart.part === part
  && chart.series.some((series, place) => isOf(series.label, run) && drawn[i].isDatasetVisible(place))).length;
"""
# Of the charts over time of a part: their ranges of x.
TIME_RANGES = """
return description.map((chart, i) => [chart, drawn[i].scales.x]).filter(([chart]) => chart.part === arguments[0]
  && chart.x === "time [s]" && chart.categories.length === 0).map(([, x]) => [x.min, x.max]);
"""
# A place in a chart, as shares of its axes: the offset from its middle, and the time there.
PLACE = """
const made = drawn[Number(arguments[0].id.slice("chart-".length))], area = made.chartArea;
const x = Math.round(area.left + arguments[1] * area.width), y = Math.round(area.top + area.height / 2);
return [x - Math.floor(made.width / 2), y - Math.floor(made.height / 2), made.scales.x.getValueForPixel(x)];
"""
# Charts whose axis of values does not fit what is drawn: something is beyond it, or nothing needs most of it.
UNFITTED = """
return drawn.filter((made, i) => {
  const chart = description[i];
  if (!chart.zoom || chart.yRange) return false;
  const { min, max } = made.scales.left;
  const values = made.data.datasets.filter((set, k) => set.yAxisID === "left" && made.isDatasetVisible(k))
    .flatMap((set) => set.data).filter((p) => p.y !== null && p.x >= chart.zoom[0] && p.x <= chart.zoom[1]).map((p) => p.y);
  return values.some((y) => y < min || y > max) || max - min > 3 * (Math.max(...values, 0) - (chart.zero ? 0 : Math.min(...values))) + 1e-3;
}).map((made) => made.canvas.getAttribute("aria-label"));
"""
# Charts whose legend is wider than they are; symbols and margins take the rest.
CUT_NAMES = """
return drawn.filter((made) => {
  made.ctx.font = Chart.defaults.font.size + "px " + Chart.defaults.font.family;
  return made.legend.legendItems.some((item) => made.ctx.measureText(item.text).width > made.width - 50);
}).map((made) => made.canvas.getAttribute("aria-label"));
"""
PICTURE = "return arguments[0].toDataURL().length + ':' + arguments[0].toDataURL().slice(-4000);"


def browser():
    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--window-size=1280,900",
                     "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(DRIVER), options=options)


def settle(driver):
    driver.execute_async_script("requestAnimationFrame(() => requestAnimationFrame(arguments[0]))")


class Reader:
    def __init__(self, driver, screenshots):
        self.driver = driver
        self.screenshots = screenshots
        self.problems = []
        self.shots = 0

    def complain(self, what):
        self.problems.append(what)

    def show(self, element):
        self.driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
        settle(self.driver)

    def shoot(self, name):
        if self.screenshots:
            self.shots += 1
            self.driver.save_screenshot(str(self.screenshots / f"{self.shots:02d}-{name}.png"))

    def read_charts(self, scheme):
        canvases = self.driver.find_elements(By.CSS_SELECTOR, ".canvas canvas")
        for canvas in canvases:
            self.show(canvas)
            if self.driver.execute_script(SERIES, canvas) < 8:
                self.complain(f"{scheme}: nothing is drawn: {canvas.get_attribute('aria-label')}")
        for chart in self.driver.execute_script(ASTRAY):
            self.complain(f"{scheme}: triangles stand beside their boxes: {chart}")
        for chart in self.driver.execute_script(CUT_NAMES):
            self.complain(f"{scheme}: names of its legend are cut: {chart}")
        return len(canvases)

    def ask_for_hidden_series(self):
        asked = 0
        for canvas in self.driver.find_elements(By.CSS_SELECTOR, ".canvas canvas"):
            for name, right, down in self.driver.execute_script(ON_REQUEST, canvas):
                self.show(canvas)
                before = self.driver.execute_script(AREA, canvas)
                ActionChains(self.driver).move_to_element_with_offset(canvas, int(right), int(down)).click().perform()
                settle(self.driver)
                asked += 1
                if self.driver.execute_script(AREA, canvas) == before:
                    self.complain(f"a click on '{name}' shows nothing: {canvas.get_attribute('aria-label')}")
        return asked

    def turn_meshes(self):
        scenes = self.driver.find_elements(By.CSS_SELECTOR, ".scene")
        for index, scene in enumerate(scenes):
            if self.driver.execute_script(PATH_OUT_OF_SIGHT, index):
                self.complain(f"the first view of model {index} cuts the way of the camera")
            self.show(scene)
            time.sleep(0.3)
            views = scene.find_elements(By.CSS_SELECTOR, "canvas")
            if not views:
                self.complain("a scene shows no mesh: " + scene.text)
                continue
            self.shoot("meshes")
            before = self.driver.execute_script(PICTURE, views[0])
            self.show(views[0])
            ActionChains(self.driver).move_to_element(views[0]).click_and_hold().move_by_offset(60, 25).release().perform()
            settle(self.driver)
            for view in views:
                if self.driver.execute_script(DRAWN, view) < 4:
                    self.complain("a mesh has no picture: " + view.get_attribute("aria-label"))
            if self.driver.execute_script(PICTURE, views[0]) == before:
                self.complain("a mesh does not turn")
            for choice in scene.find_elements(By.CSS_SELECTOR, "input"):
                self.show(choice)
                choice.click()
                settle(self.driver)
            turned = self.driver.execute_script(PICTURE, views[0])
            scene.find_element(By.CSS_SELECTOR, "button").click()
            settle(self.driver)
            if self.driver.execute_script(PICTURE, views[0]) == turned:
                self.complain("the view is not reset")
        return len(scenes)

    def wide_tables(self):
        if not self.driver.execute_script(MOVED_TABLE):
            self.complain("a table that is wider than the page does not say so, or its first column goes")

    def narrow(self):
        """On a telephone every row says its numbers, and the page is no wider than the screen."""
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": 400, "height": 800, "deviceScaleFactor": 1, "mobile": False})
        settle(self.driver)
        hidden = self.driver.execute_script(OUT_OF_SIGHT)
        if hidden:
            self.complain("at 400 px these cells are out of sight: " + ", ".join(hidden[:5]))
        if self.driver.execute_script("return document.documentElement.scrollWidth > 400"):
            self.complain("at 400 px the page is wider than the screen")
        self.shoot("narrow")
        self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        settle(self.driver)

    def choose_times(self):
        """Arrow keys on the slider move the lines of the charts, the dots of the views and the camera of the models."""
        bars = self.driver.find_elements(By.CSS_SELECTOR, ".timebar")
        for bar in bars:
            part = bar.find_element(By.XPATH, "..")
            self.show(bar)
            lines = [line for line in part.find_elements(By.CSS_SELECTOR, ".cursor")]
            before = [line.get_attribute("style") for line in lines]
            self.driver.execute_script(LISTEN)
            slider = bar.find_element(By.CSS_SELECTOR, "input[type=range]")
            slider.send_keys(*([Keys.ARROW_RIGHT] * 40))
            settle(self.driver)
            if not lines or any(old == line.get_attribute("style") for old, line in zip(before, lines)):
                self.complain("a chart does not follow the time: " + part.get_attribute("id"))
            if not self.driver.execute_script("return window.chosenTimes.length"):
                self.complain("nobody is told of the time")
            if part.find_elements(By.CSS_SELECTOR, ".strip") and not part.find_elements(By.CSS_SELECTOR, ".strip .current"):
                self.complain("no image is that of the time")
        return len(bars)

    def hide_a_run(self):
        """A click in the legend acts on all charts of the recording."""
        for bar in self.driver.find_elements(By.CSS_SELECTOR, ".timebar"):
            buttons = bar.find_elements(By.CSS_SELECTOR, ".legend button")
            run = buttons[-1].get_attribute("data-run")
            part = int(bar.find_element(By.XPATH, "..").get_attribute("id").split("-")[1])
            self.show(bar)
            shown = self.driver.execute_script(SHOWN, part, run)
            buttons[-1].click()
            settle(self.driver)
            if shown < 3 or self.driver.execute_script(SHOWN, part, run) != 0:
                self.complain(f"the legend hides '{run}' in some charts only")
            buttons[-1].click()
            settle(self.driver)
            if self.driver.execute_script(SHOWN, part, run) != shown:
                self.complain(f"the legend does not bring '{run}' back")

    def time_ranges(self, part, expected, what):
        """Whether all charts over time of a part show the same range; None: any."""
        settle(self.driver)
        ranges = self.driver.execute_script(TIME_RANGES, part)
        for found in ranges:
            if expected and any(abs(a - b) > 0.01 * (expected[1] - expected[0]) for a, b in zip(found, expected)):
                self.complain(f"{what}: a chart shows {found} in place of {expected}")
        return ranges

    def drag(self, canvas, share, to_share):
        """Drags over a part of a chart and returns the range of time that this is."""
        right, down, low = self.driver.execute_script(PLACE, canvas, share)
        to_right, _, high = self.driver.execute_script(PLACE, canvas, to_share)
        ActionChains(self.driver).move_to_element_with_offset(canvas, right, down).click_and_hold() \
            .move_by_offset(to_right - right, 3).release().perform()
        return sorted([low, high])

    def zoom_charts(self):
        """What is dragged over in one chart over time is shown by all of the recording, until it is reset."""
        for bar in self.driver.find_elements(By.CSS_SELECTOR, ".timebar"):
            section = bar.find_element(By.XPATH, "..")
            part = int(section.get_attribute("id").split("-")[1])
            whole = self.driver.execute_script(TIME_RANGES, part)
            canvas = section.find_elements(By.CSS_SELECTOR, ".canvas canvas.zoomable")[1]
            button = canvas.find_element(By.XPATH, "ancestor::figure").find_element(By.CSS_SELECTOR, ".unzoom")
            self.show(canvas)

            def all_of_it(what):
                if self.time_ranges(part, None, what) != whole or button.is_displayed():
                    self.complain(f"{what} does not show the whole run")

            expected = self.drag(canvas, 0.6, 0.3)
            self.time_ranges(part, expected, "a drag")
            for chart in self.driver.execute_script(UNFITTED):
                self.complain("values are not fitted to the zoom: " + chart)
            self.shoot("zoom")
            right, down, at = self.driver.execute_script(PLACE, canvas, 0.25)
            self.driver.execute_script(LISTEN)
            ActionChains(self.driver).move_to_element_with_offset(canvas, right, down).click().perform()
            if abs(self.driver.execute_script("return window.chosenTimes.at(-1)") - at) > 0.01 * (expected[1] - expected[0]):
                self.complain("a click in a zoomed chart does not choose its time")
            self.time_ranges(part, expected, "a click")
            self.driver.execute_script("window.dispatchEvent(new Event('beforeprint'))")
            if self.driver.execute_script(TIME_RANGES, part) != whole:
                self.complain("paper does not show the whole of a zoomed chart")
            self.driver.execute_script("window.dispatchEvent(new Event('afterprint'))")
            self.time_ranges(part, expected, "after a print")
            canvas.send_keys("+")
            length = (expected[1] - expected[0]) / 2
            self.time_ranges(part, [at - length / 2, at + length / 2], "the key +")
            canvas.send_keys(Keys.ESCAPE)
            all_of_it("Escape")
            self.drag(canvas, 0.2, 0.9)
            # Two clicks are a double one only within half a second, which a busy machine does not promise.
            self.driver.execute_script(DOUBLE_CLICK, canvas, right, down)
            all_of_it("a double click")
            self.drag(canvas, 0.2, 0.9)
            button.click()
            all_of_it("the button")

    def print_in_dark(self):
        """Paper is white, also for who reads in the dark; tables are not cut, and charts can be read on A4 upright."""
        self.scheme("dark")
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": 703, "height": 1032, "deviceScaleFactor": 1, "mobile": False})
        self.driver.execute_script("window.dispatchEvent(new Event('beforeprint'))")
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print",
                                    "features": [{"name": "prefers-color-scheme", "value": "dark"}]})
        settle(self.driver)
        if self.driver.execute_script("return getComputedStyle(document.documentElement).getPropertyValue('--text').trim()") != "#1c2126":
            self.complain("print has the colours of the dark scheme")
        cut = self.driver.execute_script(CUT_TABLES)
        if cut:
            self.complain(f"print cuts {cut} tables")
        unreadable = self.driver.execute_script(UNREADABLE_ON_PAPER)
        if unreadable:
            self.complain("these cannot be read on paper: " + ", ".join(unreadable[:5]))
        self.driver.execute_script("window.dispatchEvent(new Event('afterprint'))")
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "", "features": []})
        self.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        settle(self.driver)

    def unfold(self):
        for details in self.driver.find_elements(By.CSS_SELECTOR, "details"):
            self.show(details)
            details.find_element(By.CSS_SELECTOR, "summary").click()
            if details.get_attribute("open") is None or not details.find_elements(By.CSS_SELECTOR, "tr"):
                self.complain("folded away is nothing: " + details.text)

    def follow_links(self):
        for link in self.driver.find_elements(By.CSS_SELECTOR, "nav a"):
            target = link.get_attribute("href").split("#")[1]
            if not self.driver.find_elements(By.ID, target):
                self.complain("a link leads nowhere: " + link.text)

    def scheme(self, name):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                    {"features": [{"name": "prefers-color-scheme", "value": name}]})
        settle(self.driver)
        time.sleep(0.3)

    def no_leaks(self):
        remote = self.driver.execute_script(
            "return performance.getEntriesByType('resource').map((r) => r.name).filter((n) => !n.startsWith('data:'))")
        for name in remote:
            self.complain("the page loads " + name)
        for entry in self.driver.get_log("browser"):
            self.complain(f"console: {entry['level']}: {entry['message']}")


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    if not pathlib.Path(DRIVER).exists():
        print(f"skipped: no {DRIVER}")
        return 77
    page = pathlib.Path(sys.argv[1]).resolve()
    screenshots = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else None
    if screenshots:
        screenshots.mkdir(parents=True, exist_ok=True)
    driver = browser()
    try:
        driver.set_script_timeout(60)
        driver.get(page.as_uri())
        reader = Reader(driver, screenshots)
        settle(driver)
        reader.shoot("top")
        charts = reader.read_charts("light")
        asked = reader.ask_for_hidden_series()
        bars = reader.choose_times()
        reader.hide_a_run()
        reader.zoom_charts()
        scenes = reader.turn_meshes()
        reader.unfold()
        reader.follow_links()
        reader.wide_tables()
        reader.scheme("dark")
        reader.read_charts("dark")
        reader.print_in_dark()
        reader.narrow()
        reader.no_leaks()
    finally:
        driver.quit()
    for problem in reader.problems:
        print("FAILED: " + problem)
    print(f"{page.name}: {charts} charts, {scenes} scenes, {bars} time lines, {asked} series on request, {len(reader.problems)} problems")
    if bars == 0:
        print("FAILED: the page has no time line")
        return 1
    if charts == 0:
        print("FAILED: the page has no charts")
        return 1
    return 1 if reader.problems else 0


if __name__ == "__main__":
    sys.exit(main())
