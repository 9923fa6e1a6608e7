"""The numbers of a scene by their paths, as messages and coordinates name them: "coupler.length", "loads[1].at[2]".

"mechanism" is left out of a path, and lists count from one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

from linksweep.base.conversion import kinds_of
from linksweep.base.frozen import Owner, field_values, with_sound, with_values
from linksweep.base.validate import is_array
from linksweep.scene.dimensions import laid


def numbers(owner: Any, prefix: str = "") -> Iterator[tuple[str, Any, str]]:
    """Every number of a scene with its path and its kind ("" for a word that stands among numbers)."""
    for item in fields(owner):
        value, path = getattr(owner, item.name), prefix + item.name
        if "rule" in item.metadata and not _has_parts(value):
            yield path, value, item.metadata["rule"].kind
        elif item.name == "loads":
            for k, load in enumerate(value, 1):
                yield from numbers(load, f"loads[{k}].")
        elif _has_parts(value):
            yield from numbers(value, "" if item.name == "mechanism" else path + ".")
        elif isinstance(value, tuple | list):
            kinds = zip(value, kinds_of(item.name, value), strict=False)
            yield from ((f"{path}[{k}]", number, kind) for k, (number, kind) in enumerate(kinds, 1))


def free(scene: Any) -> dict[str, tuple[Any, str]]:
    """What may vary in a study: value and kind of each number by its path, but for words that this machine lacks."""
    words = {path: (scene.motion.get(path, value), kind) for path, value, kind in numbers(scene) if kind}
    return {path: (value, kind) for path, (value, kind) in words.items() if value is not None or "." in path}


def replaced(owner: Owner, values: Mapping[str, Any], prefix: str = "") -> Owner:
    """A scene with other numbers at these paths, all put in at once, so that it is judged only when it is complete.

    Raises ValueError where the scene with these numbers is refused.
    """
    parts = field_values(owner)
    below = {name: prefix if name == "mechanism" else prefix + name for name in parts}
    return with_values(owner, **{name: _replaced(part, below[name], values) for name, part in parts.items()})


def bare(value: Any) -> Any:
    """A number, or a part of a scene, without labels: its arrays as xarray's Variables, far quicker to reckon with."""
    return _with_arrays(value, lambda array: array.variable)


def along(value: Any, dims: tuple[str, ...]) -> Any:
    """The same with an axis for each of these dims, by numpy; arrays that have others stay as they are."""
    return _with_arrays(value, lambda array: laid(array, dims) if {*array.dims} <= {*dims} else array)


def _with_arrays(value: Any, made: Callable[[Any], Any]) -> Any:
    if _has_parts(value):
        return with_sound(value, **{item.name: _with_arrays(getattr(value, item.name), made) for item in fields(value)})
    if isinstance(value, tuple | list):
        return tuple(_with_arrays(item, made) for item in value)
    return made(value) if is_array(value) else value


def _replaced(value: Any, path: str, values: Mapping[str, Any]) -> Any:
    if path in values:
        return values[path]
    if _has_parts(value):
        return replaced(value, values, path and path + ".")
    if isinstance(value, tuple | list):
        return tuple(_replaced(item, f"{path}[{k}]", values) for k, item in enumerate(value, 1))
    return value


def _has_parts(value: Any) -> bool:
    return is_dataclass(value) and not isinstance(value, type)
