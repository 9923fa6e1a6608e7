"""The explorer's page in a real Chromium: it loads, follows slider and mouse, compares, saves, and prints.

Expected numbers are those of `ls.peaks` and `ls.sweep` for the design that the page then has.
"""

import math
import re
import statistics
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from browser import chromium

import linksweep as ls
from linksweep.scene.parameters import replaced

pytestmark = pytest.mark.long

WAIT = 60_000  # ms: for a busy machine
FRAMES = 30.0  # a second, at least
COUNT = "window.frames = []; (function next(t) { frames.push(t); requestAnimationFrame(next); })(0)"


@pytest.fixture(scope="module")
def browser():
    with chromium() as started:
        yield started


@pytest.fixture(scope="module")
def address():
    """Serve the press as the command does, on a free port."""
    command = [sys.executable, "-u", "-m", "linksweep", "explore", "press", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as server:
        for line in server.stdout:
            if url := re.search(r"http://\S+", line):
                yield url[0]
                break
        server.terminate()


class Screen:
    """A page with the machine standing still at 45 degrees, and its console's complaints."""

    def __init__(self, browser, address: str, width: int = 1280, height: int = 800) -> None:
        self.page = browser.new_page(viewport={"width": width, "height": height}, accept_downloads=True)
        self.complaints: list[str] = []
        self.page.on("console", lambda m: self.complaints.append(m.text) if m.type in ("error", "warning") else None)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(address, timeout=WAIT)
        self.settle()
        self.press("Pause")
        self.page.locator(".transport input").fill("45")
        self.page.locator(".sheet").focus()

    def settle(self) -> None:
        """Wait for the replies to all questions: the last is about the exact peaks."""
        self.page.wait_for_selector(".sheet[aria-busy=false] .peaks:not(.old) tbody tr", timeout=WAIT)

    def press(self, name: str) -> None:
        self.page.get_by_role("button", name=name, exact=True).click()
        self.settle()

    def field(self, path: str):
        return self.page.locator(f".row[data-path='{path}'] input[type=text]")

    def number(self, path: str) -> float:
        return float(self.field(path).input_value().replace("−", "-"))

    def peak(self, name: str) -> float:
        return float(self.page.locator(".peaks tr", has_text=name).first.locator("td").first.text_content())

    def pin(self, letter: str) -> tuple[float, float]:
        box = self.page.locator(f".handle[aria-label^='Pin {letter}:']").bounding_box()
        return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    def drag(self, start, way, steps: int = 30) -> None:
        mouse = self.page.mouse
        mouse.move(*start)
        mouse.down()
        for k in range(1, steps + 1):
            mouse.move(start[0] + way[0] * k / steps, start[1] + way[1] * k / steps)
            self.page.wait_for_timeout(8)
        mouse.up()
        self.settle()


@pytest.fixture
def screen(browser, address):
    screen = Screen(browser, address)
    yield screen
    assert screen.complaints == []
    screen.page.close()


def scene(**numbers) -> ls.Scene:
    return replaced(ls.example("press"), {path.replace("__", "."): value for path, value in numbers.items()})


def test_it_shows_the_exact_peaks(screen):
    assert screen.peak("F₃₂") == pytest.approx(float(ls.peaks(scene()).F32_peak), rel=1e-4)
    assert "crank-rocker" in screen.page.locator(".checks").text_content()


def test_a_slider_moves_everything(screen):
    slider = screen.page.locator(".row[data-path='coupler.length'] input[type=range]")
    box = slider.bounding_box()
    screen.drag((box["x"] + box["width"] / 2, box["y"] + box["height"] / 2), (14, 0))
    length = screen.number("coupler.length")
    assert length > 0.225
    assert screen.peak("F₃₂") == pytest.approx(float(ls.peaks(scene(coupler__length=length)).F32_peak), rel=1e-4)
    screen.press("Undo")
    assert screen.number("coupler.length") == 0.22  # one gesture, one step


def test_undo_takes_back_a_change_that_still_waits(screen):
    screen.page.locator(".row[data-path='coupler.length'] input[type=range]").evaluate("""slider => {
        const undo = slider.getRootNode().querySelector("button.undo");
        slider.dispatchEvent(new Event("pointerdown"));
        for (const length of [0.23, 0.24, 0.25]) {  // Python is busy with the first one
            slider.value = length;
            slider.dispatchEvent(new Event("input"));
        }
        undo.disabled = false;
        undo.click();
    }""")
    screen.settle()
    assert screen.number("coupler.length") == 0.22


def test_a_pin_follows_the_mouse_while_frames_stay_quick(screen):
    screen.press("Pin design")
    start = screen.pin("C")
    screen.page.evaluate(COUNT)
    screen.drag(start, (-30, -50), steps=60)
    times = screen.page.evaluate("frames")[2:]
    assert math.dist(screen.pin("C"), (start[0] - 30, start[1] - 50)) < 60  # the view may be fitted anew at the end
    numbers = {path: screen.number(path) for path in ("coupler.length", "rocker.length")}
    expected = ls.peaks(replaced(scene(), numbers))
    assert screen.peak("F₃₂") == pytest.approx(float(expected.F32_peak), rel=1e-3)  # the fields have five digits
    steps = [later - now for now, later in pairwise(times)]
    rate = 1000.0 / statistics.median(steps)  # of a machine that other tests share
    print(f"{rate:.0f} frames a second while a pin is dragged ({1000.0 / statistics.mean(steps):.0f} in the mean)")
    assert rate > FRAMES


def test_the_crank_turns_with_its_pin_and_keeps_its_length(screen):
    (bx, by), c = screen.pin("B"), screen.pin("C")
    screen.drag((bx, by), (20, 24), steps=10)  # clockwise, and never further from the circle than it holds
    assert screen.number("crank.length") == 0.08 and screen.number("coupler.length") == 0.22
    angle = screen.page.locator(".transport output").text_content()
    assert float(re.search(r"[\d.]+(?=°)", angle)[0]) < 40.0
    assert screen.pin("C") != c


def test_another_assembly_is_chosen(screen):
    choice = screen.page.locator(".row[data-path=branch] select")
    choice.select_option("crossed")
    screen.settle()
    crossed = replace(scene(), mechanism=replace(scene().mechanism, branch="crossed"))
    assert screen.peak("F₃₂") == pytest.approx(float(ls.peaks(crossed).F32_peak), rel=1e-4)
    screen.press("Undo")
    assert choice.input_value() == "open"


def test_loads_and_centres_of_gravity_have_their_signs(screen):
    paths = [made.get_attribute("d") for made in screen.page.locator(".machine path.sign").all()]
    assert [bool(d) for d in paths] == [False, True]  # of a force an arrow, of a torque an arc
    push = screen.page.locator(".machine .arrow.load").first
    assert float(push.get_attribute("y2")) > float(push.get_attribute("y1"))  # a force downwards, as y does on a screen
    assert screen.page.locator(".centre-of-gravity").count() == 3
    _, y = screen.pin("D")
    box = screen.page.locator(".machine path.sign").nth(1).bounding_box()
    assert box["y"] < y < box["y"] + box["height"]


def test_numbers_are_typed_with_units_and_refused_in_words(screen):
    field = screen.field("crank.length")
    field.fill("90 mm")
    field.press("Enter")
    screen.settle()
    assert screen.number("crank.length") == 0.09
    field.fill("9 apples")
    field.press("Enter")
    note = screen.page.locator(".note.refused")
    note.wait_for(timeout=WAIT)
    assert "apples" in note.text_content() and screen.number("crank.length") == 0.09


def test_a_design_is_pinned_compared_and_restored(screen):
    screen.press("Pin design")
    assert [cell.text_content() for cell in screen.page.locator(".peaks thead th").all()][-2:] == ["pinned", "change"]
    screen.field("coupler.length").fill("0.25")
    screen.field("coupler.length").press("Enter")
    screen.settle()
    row = screen.page.locator(".peaks tr", has_text="F₃₂").first.text_content()
    old, new = (float(ls.peaks(one).F32_peak) for one in (scene(), scene(coupler__length=0.25)))
    assert f"{abs(new / old - 1.0):.1%}".replace("%", " %") in row
    screen.press("Back to it")
    assert screen.number("coupler.length") == 0.22
    screen.press("Unpin")
    assert screen.page.locator("button.back").is_hidden()


@pytest.mark.parametrize(("button", "name"), [("TOML", "scene.toml"), ("Python", "scene.py")])
def test_a_design_is_saved(screen, button, name, tmp_path):
    screen.field("crank.length").fill("0.07")
    screen.field("crank.length").press("Enter")
    screen.settle()
    with screen.page.expect_download(timeout=WAIT) as download:
        screen.press(button)
    assert download.value.suggested_filename == name
    file = Path(tmp_path, name)
    download.value.save_as(file)
    if name == "scene.toml":
        assert ls.load_scene(file) == scene(crank__length=0.07)
    else:
        assert "crank=ls.Bar(length=0.07," in file.read_text("utf-8")


def test_the_keyboard_does_all_that_the_mouse_does(screen):
    keyboard, output = screen.page.keyboard, screen.page.locator(".transport output")
    before = output.text_content()
    keyboard.press("ArrowRight")
    assert output.text_content() != before
    keyboard.press("Space")
    assert screen.page.locator(".play").text_content() == "Pause"
    keyboard.press("Space")
    slider = screen.page.locator(".row[data-path='coupler.length'] input[type=range]")
    slider.focus()
    keyboard.press("ArrowRight")
    screen.settle()
    assert screen.number("coupler.length") == pytest.approx(0.221)
    screen.page.locator(".handle[aria-label^='Pin C:']").focus()
    keyboard.press("Shift+ArrowUp")
    screen.settle()
    assert screen.number("rocker.length") != 0.18
    screen.page.locator(".sheet").focus()
    keyboard.press("Control+z")
    keyboard.press("Control+z")
    screen.settle()
    assert (screen.number("coupler.length"), screen.number("rocker.length")) == (0.22, 0.18)
    keyboard.press("Control+Shift+Z")
    screen.settle()
    assert screen.number("coupler.length") == pytest.approx(0.221)


@pytest.mark.parametrize("width", [1440, 1000, 600, 360])
def test_nothing_is_wider_than_the_window(browser, address, width):
    screen = Screen(browser, address, width, 800)
    wide = screen.page.evaluate("document.documentElement.scrollWidth")
    boxes = [screen.page.locator(part).bounding_box() for part in (".stage", ".side", ".results", ".controls")]
    assert wide <= width
    assert all(box["x"] >= 0 and box["x"] + box["width"] <= width + 0.5 for box in boxes)
    assert screen.complaints == []
    screen.page.close()


def test_it_prints_on_two_pages_at_most(screen):
    pages = screen.page.pdf(format="A4", landscape=True, print_background=True)
    assert 1 <= len(re.findall(rb"/Type\s*/Page\b", pages)) <= 2
    screen.page.emulate_media(media="print")
    assert screen.page.locator(".machine").is_visible() and screen.page.locator(".peaks").is_visible()
    assert not screen.page.locator(".transport").is_visible() and not screen.page.locator(".tools").is_visible()


def test_reduced_motion_is_respected(browser, address):
    page = browser.new_page(reduced_motion="reduce")
    page.goto(address, timeout=WAIT)
    page.wait_for_selector(".peaks tbody tr", timeout=WAIT)
    assert page.locator(".play").text_content() == "Play"
    page.close()
