"""Code, commands and links of the README work."""

import re
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

import linksweep as ls
from linksweep.scene.examples import names

README = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
LISTED = re.search(r"\*\*Examples\*\* (.*?):\n", README, re.DOTALL).group(1)


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("block", re.findall(r"```python\n(.*?)```", README, re.DOTALL))
def test_python_of_the_readme_runs(block):
    exec(block, {})
    assert Path("cycle.nc").exists() == ("cycle.nc" in block)
    plt.close("all")


@pytest.mark.parametrize("block", re.findall(r"```toml\n(.*?)```", README, re.DOTALL))
def test_scene_files_of_the_readme_run(block):
    Path("scene.toml").write_text(block, encoding="utf-8")
    assert ls.peaks(ls.load_scene("scene.toml")).status == 0


def test_the_readme_lists_all_example_linkages():
    examples = {name for name in names() if isinstance(ls.example(name).mechanism, ls.Linkage)}
    assert {*re.findall(r'"([a-z]+(?:-[a-z0-9]+)*)"', LISTED)} == examples


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
