"""README and guide: their code runs, their scene files are read, their links lead somewhere, and no name is missing."""

import re
from collections import Counter
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

import linksweep as ls

ROOT = Path(__file__).parents[2]
DOCS = ROOT / ".docs"
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = [ROOT / "README.md", ROOT / ".github" / "CONTRIBUTING.md", *sorted((DOCS / "guide").glob("*.md"))]
PAGES += [*sorted((DOCS / "reference").glob("*.md")), *sorted(DOCS.glob("*.md"))]
LONG = {"decisions.md", "pictures.md", "studies.md"}
"""Pages whose code takes some seconds."""


def blocks(page: Path, language: str) -> list[str]:
    """Return the blocks of a page in a language."""
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)


def pages_with(language: str) -> list:
    """Return the pages that have blocks in a language, some of them marked long."""
    return [
        pytest.param(page, id=str(page.relative_to(ROOT)), marks=[pytest.mark.long] if page.name in LONG else [])
        for page in PAGES
        if blocks(page, language)
    ]


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("page", pages_with("python"))
def test_python_of_a_page_runs_from_top_to_bottom(page):
    """A block of text right after the code is what the code prints."""
    names: dict = {}
    text = page.read_text(encoding="utf-8")
    for code, output in re.findall(r"```python\n(.*?)```(?:\n\n```text\n(.*?)```)?", text, re.DOTALL):
        printed = StringIO()
        with redirect_stdout(printed):
            exec(compile(code, page.name, "exec"), names)
        assert printed.getvalue() == output or not output
        plt.close("all")
    if page.name == "README.md":
        assert Path("cycle.nc").exists() and ls.load_scene("scene.toml") == names["scene"]


@pytest.mark.parametrize("page", pages_with("toml"))
def test_scene_files_of_a_page_run(page):
    for block in blocks(page, "toml"):
        Path("scene.toml").write_text(block, encoding="utf-8")
        assert ls.peaks(ls.load_scene("scene.toml"), theta2=24).status == 0


def test_the_readme_has_the_quick_start():
    lines = [line for line in README.splitlines() if line.startswith("python3 -m venv")]
    assert len(lines) == 2
    assert lines[0].endswith("linksweep demo")
    assert lines[1].endswith("pytest")


def test_the_readme_is_a_front_page():
    """It has short lines, but for tables and pictures, and leaves details to the guide."""
    lines = README.splitlines()
    assert [line for line in lines if len(line) > 100 and line[:1] not in ("|", "!")] == []
    assert len(lines) < 150


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_of_a_page_exist(page):
    """Links to pages that are written at build time are checked by the build."""
    links = re.findall(r"\]\((?!https?:|#)([^)#]+)", page.read_text(encoding="utf-8"))
    assert [link for link in links if "generated/" not in link and not (page.parent / link).exists()] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_lines_of_a_page_are_short(page):
    lines = page.read_text(encoding="utf-8").splitlines()
    assert [line for line in lines if len(line) > 120 and not line.startswith("|")] == []  # a row is one line


def test_the_tree_names_every_room():
    tree = (DOCS / "guide" / "built.md").read_text(encoding="utf-8").split("linksweep/\n", 1)[1].split("```", 1)[0]
    rooms = {path.parent.name for path in Path(ls.__file__).parent.rglob("*/__init__.py")}
    assert {*re.findall(r"(\w+)/", tree)} == rooms


def test_every_public_name_stands_once_in_the_reference():
    """The reference lists by subject what `ls` and `ls.plot` have; a new name needs a line there."""
    text = (DOCS / "reference" / "api.md").read_text(encoding="utf-8")
    listed = Counter(re.findall(r"^   ~?([A-Za-z_.]+)$", text, re.MULTILINE))
    public = {*ls.__all__, *(f"plot.{name}" for name in ls.plot.__all__)} - {"plot"}
    assert sorted(public - listed.keys()) == []
    assert [name for name, count in listed.items() if count > 1] == []
    assert [name for name in listed if name not in public and name.count(".") < 2] == []


def test_every_notebook_stands_once_in_the_reading_order():
    text = (DOCS / "notebooks.md").read_text(encoding="utf-8")
    listed = Counter(re.findall(r"^generated/notebooks/(\w+)$", text, re.MULTILINE))
    assert listed == Counter(path.stem for path in (ROOT / "notebooks").glob("*.py"))
