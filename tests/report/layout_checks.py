"""Tables, folded parts and links; the page on a telephone and on paper."""
from selenium.webdriver.common.by import By

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
# Models on paper: how many have a picture that is seen, and how many views are still drawn.
MODELS_ON_PAPER = """
const seen = (element) => element.getClientRects().length > 0;
const pictures = [...document.querySelectorAll(".scene .stills img")];
return [pictures.filter((picture) => seen(picture) && picture.naturalWidth > 100).length, pictures.length,
  [...document.querySelectorAll(".scene canvas")].filter(seen).length];
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


def wide_tables(reader):
    driver = reader.driver
    if not driver.execute_script(MOVED_TABLE):
        reader.complain("a table that is wider than the page does not say so, or its first column goes")


def narrow(reader):
    """On a telephone every row says its numbers, and the page is no wider than the screen."""
    driver = reader.driver
    reader.screen(400, 800)
    reader.settle()
    hidden = driver.execute_script(OUT_OF_SIGHT)
    if hidden:
        reader.complain("at 400 px these cells are out of sight: " + ", ".join(hidden[:5]))
    # Charts and the time line are drawn again in their new size some time after the screen has it.
    if not reader.wait("return document.documentElement.scrollWidth <= 400"):
        reader.complain("at 400 px the page is wider than the screen")
    reader.shoot("narrow")


def print_in_dark(reader):
    """Paper is white, also for who reads in the dark; tables are not cut, and charts can be read on A4 upright."""
    driver = reader.driver
    reader.screen(703, 1032)
    driver.execute_script("window.dispatchEvent(new Event('beforeprint'))")
    reader.scheme("dark", media="print")
    if driver.execute_script("return getComputedStyle(document.documentElement).getPropertyValue('--text').trim()") != "#1c2126":
        reader.complain("print has the colours of the dark scheme")
    cut = driver.execute_script(CUT_TABLES)
    if cut:
        reader.complain(f"print cuts {cut} tables")
    unreadable = driver.execute_script(UNREADABLE_ON_PAPER)
    if unreadable:
        reader.complain("these cannot be read on paper: " + ", ".join(unreadable[:5]))
    shown, models, views = driver.execute_script(MODELS_ON_PAPER)
    if models == 0 or shown < models or views > 0:
        reader.complain(f"paper shows {shown} of {models} pictures of models and {views} views that turn")
    driver.execute_script("window.dispatchEvent(new Event('afterprint'))")
    reader.scheme("light")


def unfold(reader):
    driver = reader.driver
    for details in driver.find_elements(By.CSS_SELECTOR, "details"):
        details.find_element(By.CSS_SELECTOR, "summary").click()
        if details.get_attribute("open") is None or not details.find_elements(By.CSS_SELECTOR, "tr, canvas, .scene"):
            reader.complain("folded away is nothing: " + details.text)


def follow_links(reader):
    driver = reader.driver
    for link in driver.find_elements(By.CSS_SELECTOR, "nav a"):
        target = link.get_attribute("href").split("#")[1]
        if not driver.find_elements(By.ID, target):
            reader.complain("a link leads nowhere: " + link.text)
