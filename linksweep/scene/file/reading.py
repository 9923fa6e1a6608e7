"""Read scene files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import xarray as xr

from linksweep.base.validate import refuse
from linksweep.mechanisms import MECHANISMS, Mechanism
from linksweep.scene.file.errors import Log, document
from linksweep.scene.file.schema import build, kinds_of, read
from linksweep.scene.file.text_file import as_path, text_of
from linksweep.scene.loads.load import AT_ANGLES
from linksweep.scene.scene import MECHANISM, Scene


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
    path = as_path(path)
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
    if not whole and isinstance(raw.get("loads"), list):
        raw["loads"] = [_at_angles(load, f"loads[{k}]", arrays or {}) for k, load in enumerate(raw["loads"], 1)]
    machine = {key for kind in _machines(raw) for key in kinds_of(kind)}
    log = Log(raw, arrays or {}, kinds_of(Scene), machine, Path(name).parent, whole)
    scene: Scene = build(Scene, raw, (), log)
    if log.problems:
        raise ValueError(log.report(text, name))
    return scene


class StandIns(Mapping[str, xr.DataArray]):
    """Arrays of one number each, for any path: for a mechanism that is needed for its names alone."""

    def __getitem__(self, path: str) -> xr.DataArray:
        return xr.DataArray([1.0], dims="design")

    def __iter__(self) -> Iterator[str]:
        return iter(())

    def __len__(self) -> int:
        return 0


def mechanism_of(raw: dict[str, Any]) -> Mechanism:
    """Make the mechanism of a document of `write_scene`, for its names alone: it may refer to arrays that are lost.

    Raises ValueError for a document that has none.
    """
    log = Log(raw, StandIns(), (), (), Path(), whole=False)
    mechanism: Mechanism = read(MECHANISM, raw.get("mechanism"), ("mechanism",), log)
    refuse([problem for _, problem in log.problems])
    return mechanism


def _at_angles(load: Any, path: str, arrays: Mapping[str, xr.DataArray]) -> Any:
    """Return a load without the position that it follows where it is a function of that: a cycle holds its samples."""
    if not isinstance(load, dict) or "over" not in load:
        return load
    force = load.get("force", ())
    numbers = {f"{path}.force[{k}]": part for k, part in enumerate(force, 1)} | {f"{path}.torque": load.get("torque")}
    if not any(isinstance(number, dict) and "function" in number and at in arrays for at, number in numbers.items()):
        return load
    followed = {at: {"variable": at} if at in arrays else number for at, number in numbers.items()}
    *components, torque = followed.values()
    own = {key: value for key, value in load.items() if key not in AT_ANGLES}
    own |= ({"force": components} if force else {}) | ({} if torque is None else {"torque": torque})
    return own | {"interpolation": "linear"}


def _machines(raw: dict[str, Any]) -> list[type]:
    """Return the class of a file's mechanism; all classes where its type is not known."""
    table = raw.get("mechanism")
    name = str(table.get("type")) if isinstance(table, dict) else ""
    return [MECHANISMS[name]] if name in MECHANISMS else [*MECHANISMS.values()]
