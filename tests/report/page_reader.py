"""A page in headless Chromium, and what was found to be wrong with it."""
import time

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains

DRIVER = "/usr/bin/chromedriver"
FLAGS = ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--window-size=1280,900",
         "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
         # Meshes need WebGL; all else is drawn faster without a GPU than by one in software.
         "--disable-gpu-rasterization", "--disable-accelerated-2d-canvas", "--disable-gpu-compositing",
         "--webgl-antialiasing-mode=none")
# Chromium's, not the page's: where no GPU draws canvases, a picture of WebGL has to be read back.
OF_FLAGS = "GL Driver Message (OpenGL, Performance, GL_CLOSE_PATH_NV, High): GPU stall due to ReadPixels"
LISTEN = """
window.chosenTimes = [];
window.addEventListener("time-chosen", (event) => window.chosenTimes.push(event.detail.time_s));
"""
SETTLE = "requestAnimationFrame(() => requestAnimationFrame(() => arguments[0]()))"


class Reader:
    def __init__(self, screenshots):
        options = webdriver.ChromeOptions()
        for flag in FLAGS:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service(DRIVER), options=options)
        self.driver.set_script_timeout(60)
        self.screenshots = screenshots
        self.problems = []
        self.shots = 0

    def complain(self, what):
        self.problems.append(what)

    def settle(self):
        self.driver.execute_async_script(SETTLE)

    def show(self, element):
        self.driver.execute_async_script("arguments[0].scrollIntoView({block: 'center'});" + SETTLE.replace("arguments[0]", "arguments[1]"),
                                         element)

    def wait(self, condition, *arguments):
        """Until a script returns what is true; false: it does not within a minute, as a busy machine may need."""
        end = time.monotonic() + 60
        while time.monotonic() < end:
            if self.driver.execute_script(condition, *arguments):
                return True
            time.sleep(0.05)
        return False

    def pointer(self):
        """Moves in few steps: each makes the page follow."""
        return ActionChains(self.driver, duration=20)

    def shoot(self, name):
        if self.screenshots:
            self.shots += 1
            self.driver.save_screenshot(str(self.screenshots / f"{self.shots:02d}-{name}.png"))

    def screen(self, width, height):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def scheme(self, name, media=""):
        """Returns once the page has drawn its charts in these colours."""
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                    {"media": media, "features": [{"name": "prefers-color-scheme", "value": name}]})
        self.settle()

    def no_leaks(self):
        remote = self.driver.execute_script(
            "return performance.getEntriesByType('resource').map((r) => r.name).filter((n) => !n.startsWith('data:'))")
        for name in remote:
            self.complain("the page loads " + name)
        for entry in self.driver.get_log("browser"):
            if OF_FLAGS not in entry["message"]:
                self.complain(f"console: {entry['level']}: {entry['message']}")
