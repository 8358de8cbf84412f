#!/usr/bin/env python3
"""Opens a page in headless Chromium as a reader would: scrolls to every part, in light and dark, turns the meshes, opens
what is folded away, and fails on any message of the console, chart without a drawing or mesh without a picture.

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
        for scene in scenes:
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
                choice.click()
                settle(self.driver)
            turned = self.driver.execute_script(PICTURE, views[0])
            scene.find_element(By.CSS_SELECTOR, "button").click()
            settle(self.driver)
            if self.driver.execute_script(PICTURE, views[0]) == turned:
                self.complain("the view is not reset")
        return len(scenes)

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
        scenes = reader.turn_meshes()
        reader.unfold()
        reader.follow_links()
        reader.scheme("dark")
        reader.read_charts("dark")
        reader.no_leaks()
    finally:
        driver.quit()
    for problem in reader.problems:
        print("FAILED: " + problem)
    print(f"{page.name}: {charts} charts, {scenes} scenes, {asked} series on request, {len(reader.problems)} problems")
    if charts == 0:
        print("FAILED: the page has no charts")
        return 1
    return 1 if reader.problems else 0


if __name__ == "__main__":
    sys.exit(main())
