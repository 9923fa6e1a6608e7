"""Methods and sources: the equations and the literature at the top of modules, for those who read no code."""

import importlib.util
import inspect
import pkgutil
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from docutils import nodes
from sphinx import addnodes
from sphinx.util.nodes import make_refnode

import linksweep as ls
from generators.page import Page

NAMED = re.compile(r"`(linksweep(?:\.\w+)+)`")
SUBJECTS = {
    "physics": "Laws",
    "scene": "Loads and motion",
    "chains": "Machines",
    "mechanisms": "Machines",
    "engine": "Evaluation",
    "results": "Results",
    "analysis": "Decisions",
    "files": "Files",
}
"""Headings, by the room of the module."""

EQUATIONS = re.compile(r"\n\n    ")

INTRODUCTION = """\
How results are computed: equations and sources, as they stand at the top of the modules that the
[reference](../reference/api.md) names or is made of.

Three lecture papers are cited as documents. **Document 1**, "Matrix Dynamic Analysis for Four Bar", has a four-bar of
steel bars in numbers, and a slider-crank with friction. **Document 2**, "ME 470 Final Project", has the four-bar over a
whole revolution, with loads. **Document 3**, lecture 17, has the drives of both by another link, and the rocket car in
a loop. The notebooks [worked_example](notebooks/worked_example) and [me470](notebooks/me470) go through the first two.
"""


def write(folder: Path) -> None:
    """Write methods.md."""
    texts = {name: inspect.cleandoc(importlib.import_module(name).__doc__ or "") for name in _modules()}
    page = Page()
    page.heading("Methods and sources", INTRODUCTION, level=1)
    for subject in dict.fromkeys(SUBJECTS.values()):
        page.heading(subject)
        for name in (name for name in texts if SUBJECTS[name.split(".")[1]] == subject):
            title, colon, _ = texts[name].partition("\n\n")[0].removesuffix(".").partition(": ")
            page.text(f"({_label(name)})=")
            page.heading(" ".join(title.split()), level=3)
            page.text(_with_equations(texts[name] if colon else texts[name].partition("\n\n")[2]))
            page.text(f"In the code: `{name}`.")
    page.write(folder / "methods.md")


@cache
def _modules() -> list[str]:
    """Return the modules of public objects that have equations, those that docstrings name, and those named there."""
    public = [getattr(ls, name) for name in ls.__all__]
    homes = {thing.__module__ for thing in public if hasattr(thing, "__module__")}
    found = {name for name in homes if EQUATIONS.search(importlib.import_module(name).__doc__ or "")}
    public += [member for cls in public if inspect.isclass(cls) for member in vars(cls).values()]
    texts = [getattr(thing, "__doc__", None) or "" for thing in [*public, *map(importlib.import_module, found)]]
    while texts:
        for name in {*NAMED.findall(texts.pop())} - found:
            if _is_module(name):
                found.add(name)
                texts.append(importlib.import_module(name).__doc__ or "")
    everywhere = [module.name for module in pkgutil.walk_packages(ls.__path__, "linksweep.")]
    return sorted(found, key=everywhere.index)


def link(app, env, node: addnodes.pending_xref, content: nodes.Element) -> nodes.Element | None:
    """Make the name of a module in a docstring a link to its methods, where it has some."""
    name = node.get("reftarget", "")
    place = ("generated/methods", _label(name), content)
    return make_refnode(app.builder, node["refdoc"], *place) if name in _modules() else None


def _label(name: str) -> str:
    """Return the label of a module's methods."""
    return name.replace(".", "-").replace("_", "-")


def _is_module(name: str) -> bool:
    try:
        return name.count(".") > 1 and importlib.util.find_spec(name) is not None
    except ModuleNotFoundError:
        return False


def _with_equations(text: str) -> str:
    """Return the text of a docstring as Markdown, with its indented lines, which are equations, as they stand."""
    return "\n\n".join(_paragraphs(text))


def _paragraphs(text: str) -> Iterator[str]:
    for paragraph in re.split(r"\n\n+", text):
        lines = paragraph.splitlines()
        yield (
            f"```text\n{inspect.cleandoc(paragraph)}\n```"
            if all(line.startswith("  ") for line in lines)
            else paragraph
        )
