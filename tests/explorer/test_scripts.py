"""Scripts of the explorer's page in node, without a page: its numbers, scales and grid lines."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

import linksweep.explorer

PAGE = Path(linksweep.explorer.__file__).with_name("page")
SCRIPTS = ("drawing.js", "charts.js")
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
