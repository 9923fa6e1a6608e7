"""Code, commands and links of the README work."""

import re
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

import linksweep as ls

README = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("block", re.findall(r"```python\n(.*?)```", README, re.DOTALL))
def test_python_of_the_readme_runs(block):
    exec(block, {})
    assert Path("cycle.nc").exists() == ("cycle.nc" in block)
    plt.close("all")


def test_the_readme_has_the_quick_start():
    lines = [line for line in README.splitlines() if line.startswith("python3 -m venv")]
    assert len(lines) == 2
    assert lines[0].endswith("linksweep demo")
    assert lines[1].endswith("pytest")


def test_links_of_the_readme_exist():
    links = re.findall(r"\]\((?!https?:)([^)#]+)\)", README)
    missing = [link for link in links if not (Path(__file__).parents[2] / link).exists()]
    assert links
    assert not missing


def test_the_tree_names_every_room():
    tree = README.split("linksweep/\n", 1)[1].split("```", 1)[0]
    rooms = {path.parent.name for path in Path(ls.__file__).parent.rglob("*/__init__.py")}
    assert {*re.findall(r"(\w+)/", tree)} == rooms
