"""A film's page in a real Chromium: it fits any width, has its title, plays and stops."""

import pytest
from browser import chromium

import linksweep as ls

pytestmark = pytest.mark.long


def test_a_film_fits_any_width_and_plays(tmp_path):
    ls.plot.animate(ls.example("press"), frames=4, title="My press").save(tmp_path / "film.html")
    with chromium() as browser:
        page = browser.new_page()
        complaints: list[str] = []
        page.on("console", lambda message: complaints.append(message.text))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto((tmp_path / "film.html").as_uri())
        assert page.title() == page.locator("figcaption").text_content() == "My press"
        for width in (1200, 500, 320):
            page.set_viewport_size({"width": width, "height": 700})
            assert page.evaluate("document.documentElement.scrollWidth") <= width
            box = page.locator("img").bounding_box()
            assert box["width"] <= width and box["height"] / box["width"] > 1.2  # not squeezed
        page.wait_for_function("document.querySelector('input').value === '3'")
        page.get_by_role("button", name="Pause").click()
        here = page.locator("input").input_value()
        page.wait_for_timeout(200)
        assert page.locator("input").input_value() == here and complaints == []
