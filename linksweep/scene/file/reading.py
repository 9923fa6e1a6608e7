"""Read scene files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from linksweep.mechanisms import MECHANISMS
from linksweep.scene.file.errors import Log, document
from linksweep.scene.file.schema import build, kinds_of
from linksweep.scene.file.text_file import text_of
from linksweep.scene.scene import Scene


def read_scene(path: str | Path) -> Scene:
    """Read a scene file.

    Raises
    ------
    ValueError
        When the file is missing or has errors: all of them, one a line, each with file, line and path.

    Examples
    --------
    >>> from importlib.resources import files
    >>> read_scene(files("linksweep.scene.examples") / "press.toml").drive
    'crank'
    """
    path = Path(path)
    return parse_scene(text_of(path, str(path), ".toml"), str(path))


def parse_scene(
    text: str, name: str = "scene", arrays: Mapping[str, xr.DataArray] | None = None, whole: bool = True
) -> Scene:
    """Make a scene of the text of a scene file.

    Parameters
    ----------
    text, name : str
        The TOML text, and the name of the file in messages.
    arrays : mapping of str to DataArray, optional
        The arrays by path, to which ``{variable = "coupler.length"}`` in a text of `write_scene` refers.
    whole : bool
        True to refuse a function that no samples represent; False to take its samples from `arrays`.

    Raises
    ------
    ValueError
        As `read_scene`.
    """
    raw = document(text, name)
    machine = {key for kind in _machines(raw) for key in kinds_of(kind)}
    log = Log(raw, arrays or {}, kinds_of(Scene), machine, Path(name).parent, whole)
    scene: Scene = build(Scene, raw, (), log)
    if log.problems:
        raise ValueError(log.report(text, name))
    return scene


def _machines(raw: dict[str, Any]) -> list[type]:
    """Return the class of a file's mechanism; all classes where its type is not known."""
    table = raw.get("mechanism")
    name = str(table.get("type")) if isinstance(table, dict) else ""
    return [MECHANISMS[name]] if name in MECHANISMS else [*MECHANISMS.values()]
