"""Charts over time are zoomed together, by a drag and by keys, until they show the whole again."""
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from page_reader import LISTEN

# On a canvas, from its middle.
DOUBLE_CLICK = """
const [canvas, right, down] = arguments;
const box = canvas.getBoundingClientRect();
canvas.dispatchEvent(new MouseEvent("dblclick", {bubbles: true, clientX: box.left + box.width / 2 + right,
                                                 clientY: box.top + box.height / 2 + down}));
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


def alike(on_paper, on_screen):
    """True if the ends differ by less than a fifth of the range: axes of another width end at other round numbers."""
    tolerance = 0.2 * (on_screen[1] - on_screen[0])
    return all(abs(a - b) < tolerance for a, b in zip(on_paper, on_screen, strict=True))


def time_ranges(reader, part, expected, what):
    """Whether all charts over time of a part show the same range; None: any."""
    driver = reader.driver
    reader.settle()
    ranges = driver.execute_script(TIME_RANGES, part)
    for found in ranges:
        if expected and any(abs(a - b) > 0.01 * (expected[1] - expected[0]) for a, b in zip(found, expected)):
            reader.complain(f"{what}: a chart shows {found} in place of {expected}")
    return ranges


def drag(reader, canvas, share, to_share):
    """Drags over a part of a chart and returns the range of time that this is."""
    driver = reader.driver
    right, down, low = driver.execute_script(PLACE, canvas, share)
    to_right, _, high = driver.execute_script(PLACE, canvas, to_share)
    reader.pointer().move_to_element_with_offset(canvas, right, down).click_and_hold() \
        .move_by_offset(to_right - right, 3).release().perform()
    return sorted([low, high])


def zoom_charts(reader):
    """What is dragged over in one chart over time is shown by all of the recording, until it is reset."""
    driver = reader.driver
    for bar in driver.find_elements(By.CSS_SELECTOR, ".timebar"):
        section = bar.find_element(By.XPATH, "..")
        part = int(section.get_attribute("id").split("-")[1])
        whole = driver.execute_script(TIME_RANGES, part)
        canvas = section.find_elements(By.CSS_SELECTOR, ".canvas canvas.zoomable")[1]
        button = canvas.find_element(By.XPATH, "ancestor::figure").find_element(By.CSS_SELECTOR, ".unzoom")
        reader.show(canvas)

        def all_of_it(what):
            if time_ranges(reader, part, None, what) != whole or button.is_displayed():
                reader.complain(f"{what} does not show the whole run")

        expected = drag(reader, canvas, 0.6, 0.3)
        time_ranges(reader, part, expected, "a drag")
        for chart in driver.execute_script(UNFITTED):
            reader.complain("values are not fitted to the zoom: " + chart)
        reader.shoot("zoom")
        right, down, at = driver.execute_script(PLACE, canvas, 0.25)
        driver.execute_script(LISTEN)
        reader.pointer().move_to_element_with_offset(canvas, right, down).click().perform()
        if abs(driver.execute_script("return window.chosenTimes.at(-1)") - at) > 0.01 * (expected[1] - expected[0]):
            reader.complain("a click in a zoomed chart does not choose its time")
        time_ranges(reader, part, expected, "a click")
        driver.execute_script("window.dispatchEvent(new Event('beforeprint'))")
        on_paper = driver.execute_script(TIME_RANGES, part)
        if not all(alike(*ranges) for ranges in zip(on_paper, whole, strict=True)):
            reader.complain(f"paper does not show the whole of a zoomed chart: {on_paper} in place of {whole}")
        driver.execute_script("window.dispatchEvent(new Event('afterprint'))")
        time_ranges(reader, part, expected, "after a print")
        canvas.send_keys("+")
        length = (expected[1] - expected[0]) / 2
        time_ranges(reader, part, [at - length / 2, at + length / 2], "the key +")
        canvas.send_keys(Keys.ESCAPE)
        all_of_it("Escape")
        drag(reader, canvas, 0.2, 0.9)
        # Two clicks are a double one only within half a second, which a busy machine does not promise.
        driver.execute_script(DOUBLE_CLICK, canvas, right, down)
        all_of_it("a double click")
        drag(reader, canvas, 0.2, 0.9)
        button.click()
        all_of_it("the button")
