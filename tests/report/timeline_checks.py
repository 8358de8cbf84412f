"""The slider and the legend of a recording act on all that shows it."""
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from page_reader import LISTEN

# In how many charts of a part a run is drawn.
SHOWN = """
const [part, run] = arguments;
return description.filter((chart, i) => chart.part === part
  && chart.series.some((series, place) => isOf(series.label, run) && drawn[i].isDatasetVisible(place))).length;
"""


def choose_times(reader):
    """Arrow keys on the slider move the lines of the charts, the dots of the views and the camera of the models."""
    driver = reader.driver
    bars = driver.find_elements(By.CSS_SELECTOR, ".timebar")
    for bar in bars:
        part = bar.find_element(By.XPATH, "..")
        reader.show(bar)
        lines = [line for line in part.find_elements(By.CSS_SELECTOR, ".cursor")]
        before = [line.get_attribute("style") for line in lines]
        driver.execute_script(LISTEN)
        slider = bar.find_element(By.CSS_SELECTOR, "input[type=range]")
        slider.send_keys(*([Keys.ARROW_RIGHT] * 40))
        reader.settle()
        if not lines or any(old == line.get_attribute("style") for old, line in zip(before, lines)):
            reader.complain("a chart does not follow the time: " + part.get_attribute("id"))
        if not driver.execute_script("return window.chosenTimes.length"):
            reader.complain("nobody is told of the time")
        if part.find_elements(By.CSS_SELECTOR, ".strip") and not part.find_elements(By.CSS_SELECTOR, ".strip .current"):
            reader.complain("no image is that of the time")
    return len(bars)


def hide_a_run(reader):
    """A click in the legend acts on all charts of the recording."""
    driver = reader.driver
    for bar in driver.find_elements(By.CSS_SELECTOR, ".timebar"):
        buttons = bar.find_elements(By.CSS_SELECTOR, ".legend button")
        run = buttons[-1].get_attribute("data-run")
        part = int(bar.find_element(By.XPATH, "..").get_attribute("id").split("-")[1])
        reader.show(bar)
        shown = driver.execute_script(SHOWN, part, run)
        buttons[-1].click()
        reader.settle()
        if shown < 3 or driver.execute_script(SHOWN, part, run) != 0:
            reader.complain(f"the legend hides '{run}' in some charts only")
        buttons[-1].click()
        reader.settle()
        if driver.execute_script(SHOWN, part, run) != shown:
            reader.complain(f"the legend does not bring '{run}' back")
