"""A scene as a file: TOML, the report, or Python."""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import NamedTuple

from linksweep.base.validate import refuse
from linksweep.reports.page import page
from linksweep.scene.scene import Scene

WIDTH = 100  # of a line of Python


class File(NamedTuple):
    """A file to save: its name, its kind for the browser, its text."""

    name: str
    kind: str
    text: str


def as_toml(scene: Scene, title: str) -> File:
    """Write a scene file, which `linksweep explore` opens again."""
    return File("scene.toml", "application/toml", scene.to_toml())


def as_report(scene: Scene, title: str) -> File:
    """Write the report to print."""
    return File("report.html", "text/html", page(scene, title))


def as_python(scene: Scene, title: str) -> File:
    """Write the lines of Python that make the scene. Raises ValueError where it holds arrays or functions."""
    held = [*scene.arrays, *scene.functions]
    refuse([f"{', '.join(held)}: not written as Python: save the scene as TOML, and ls.load_scene it"] if held else [])
    code = _written(ast.parse(repr(scene), mode="eval").body, 0)
    return File("scene.py", "text/x-python", f"import linksweep as ls\n\nscene = {code}\n")


EXPORTS: dict[str, Callable[[Scene, str], File]] = {"toml": as_toml, "report": as_report, "python": as_python}


def _written(code: ast.expr, indent: int) -> str:
    """Return code, such as the repr of a scene, with the names of linksweep: on one line where that is short enough."""
    match code:
        case ast.Call(ast.Name(name), keywords=keywords):
            parts = [(f"{keyword.arg}=", keyword.value) for keyword in keywords]
            start, end = f"ls.{name}(", ")"
        case ast.Tuple(items):
            parts, start, end = [("", item) for item in items], "(", ")"
        case ast.Dict(names, items):
            parts = [(f"{ast.unparse(name)}: ", item) for name, item in zip(names, items, strict=True) if name]
            start, end = "{", "}"
        case _:
            return ast.unparse(code)
    inner = indent + 4
    alone = start == "(" and len(parts) == 1  # a tuple of one, which needs its comma
    line = start + ", ".join(name + _written(part, inner) for name, part in parts) + end
    if len(line) + indent <= WIDTH and "\n" not in line and not alone:
        return line
    rows = "".join(f"{' ' * inner}{name}{_written(part, inner)},\n" for name, part in parts)
    return f"{start}\n{rows}{' ' * indent}{end}"
