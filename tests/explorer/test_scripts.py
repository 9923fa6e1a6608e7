"""Scripts of the explorer's page in node, without a page: its numbers, scales and grid lines."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

import linksweep.explorer

PAGE = Path(linksweep.explorer.__file__).with_name("page")
SCRIPTS = ("drawing.js", "charts.js", "controls.js")
NODE = shutil.which("node")

pytestmark = pytest.mark.skipif(NODE is None, reason="no node: install Debian's package nodejs")


def value(expression: str):
    """Return the value of an expression of the page's functions."""
    scripts = "\n".join((PAGE / name).read_text("utf-8") for name in SCRIPTS)
    done = subprocess.run(
        [NODE, "-e", f"{scripts}\nconsole.log(JSON.stringify({expression}))"],
        check=True,
        capture_output=True,
        text=True,
    )
    return json.loads(done.stdout)


def test_angles_of_a_cycle_are_round_and_few():
    """A turn has quarters; of many turns whole ones, so that no two numbers overlap."""
    steps = value("[360, 720, 1080, 2520, 8910, 35640].map(angleStep)")
    assert steps == [90, 180, 180, 360, 1800, 7200]


def test_numbers_have_as_many_digits_as_asked_for():
    assert value("[number(1234567.8), number(1.23456e-5, 5), number(-1.23456e-5), number(1e21), number(1e6, 6)]") == [
        *("1.235e6", "1.2346e−5", "−1.235e−5", "1e21", "1e6")
    ]


def test_every_minus_of_a_typed_number_is_read():
    assert value('typed("−1.5e−3 m")') == "-1.5e-3 m"


def test_a_curve_of_zeros_has_a_scale():
    """Its line lies at a finite height, within the chart; so does that of the first curve without any number."""
    chart = "Object.assign(Object.create(Curves.prototype), {height: 100, ghost: [], series: [{values: %s}]})"
    for values in ("[0, 0, 0]", "[NaN, NaN]", "[5, 5]", "[-3, -2]"):
        low, high = value(f"(chart => (chart.range(), [chart.low, chart.high]))({chart % values})")
        assert low < high, values
    assert 0.0 < value(f"(chart => (chart.range(), chart.y(0)))({chart % '[0, 0, 0]'})") < 100.0
