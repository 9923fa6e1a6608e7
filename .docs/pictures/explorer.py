"""The picture of the explorer: `python .docs/pictures/explorer.py` writes it beside this file, with a Chromium."""

import re
import shutil
import subprocess
import sys
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import Page, sync_playwright

HERE = Path(__file__).parent
SERVE = [sys.executable, "-u", "-m", "linksweep", "explore", "press", "--no-browser"]
WINDOW = {"width": 1280, "height": 800}


def main() -> None:
    """Write explorer.png: a press beside the design that was pinned before its coupler was made longer."""
    with subprocess.Popen(SERVE, stdout=subprocess.PIPE, text=True) as server, sync_playwright() as driver:
        address = next(url[0] for line in server.stdout or () if (url := re.search(r"http://\S+", line)))
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport=WINDOW)
        page.goto(address)
        compare(page)
        with Image.open(BytesIO(page.screenshot())) as picture:
            picture.quantize(128, dither=Image.Dither.NONE).save(HERE / "explorer.png", optimize=True)
        server.terminate()


def compare(page: Page) -> None:
    """Pin the design, and change its coupler, at a crank angle of 60 degrees."""
    page.get_by_role("button", name="Pause").click()
    page.locator(".transport input").fill("60")
    page.get_by_role("button", name="Pin design").click()
    length = page.locator(".row[data-path='coupler.length'] input[type=text]")
    length.fill("0.24")
    length.press("Enter")
    page.locator(".sheet").focus()
    page.wait_for_timeout(1000)


if __name__ == "__main__":
    main()
