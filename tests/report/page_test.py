#!/usr/bin/env python3
"""Opens a page in headless Chromium as a reader would: scrolls to every part, in light and dark, zooms the charts, turns the
meshes, opens what is folded away, and fails on any message of the console, chart without a drawing or mesh without a picture.

Usage: page_test.py PAGE.html [SCREENSHOT_FOLDER]

Needs Selenium and ChromeDriver (Debian: python3-selenium, chromium-driver); exit code 77 where they are missing.
"""
import pathlib
import sys

try:
    import page_reader
    from selenium.webdriver.common.by import By
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)
from chart_checks import ask_for_hidden_series, read_charts
from layout_checks import follow_links, narrow, print_in_dark, unfold, wide_tables
from scene_checks import picture_in, turn_meshes
from timeline_checks import choose_times, hide_a_run
from zoom_checks import zoom_charts


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    if not pathlib.Path(page_reader.DRIVER).exists():
        print(f"skipped: no {page_reader.DRIVER}")
        return 77
    page = pathlib.Path(sys.argv[1]).resolve()
    screenshots = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else None
    if screenshots:
        screenshots.mkdir(parents=True, exist_ok=True)
    reader = page_reader.Reader(screenshots)
    try:
        reader.driver.get(page.as_uri())
        reader.settle()
        reader.shoot("top")
        charts = read_charts(reader, "light")
        asked = ask_for_hidden_series(reader)
        bars = choose_times(reader)
        hide_a_run(reader)
        zoom_charts(reader)
        scenes = turn_meshes(reader)
        unfold(reader)
        follow_links(reader)
        wide_tables(reader)
        in_light = picture_in(reader, "light")
        reader.show(reader.driver.find_element(By.CSS_SELECTOR, "h1"))
        reader.scheme("dark")
        read_charts(reader, "dark")
        picture_in(reader, "dark", before=in_light)
        # Other widths make the page draw all charts again, so they come last.
        narrow(reader)
        print_in_dark(reader)
        reader.no_leaks()
    finally:
        reader.driver.quit()
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
