"""The numbers of a scene by their paths, as messages and coordinates name them: "coupler.length", "loads[1].at[2]".

"mechanism" is left out of a path, and lists count from one.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linksweep.base.fields import FieldKind, below, declared, has_fields
from linksweep.base.frozen import Owner, with_arrays, with_values
from linksweep.scene.dimensions import aligned


def free(scene: Any) -> dict[str, tuple[Any, str]]:
    """Return value and kind, by path, of each number that may vary in a study; none that this machine does not take."""
    numbers = {path: (scene.motion.get(path, value), kind) for path, (value, kind) in scene.numbers.items()}
    return {path: (value, kind) for path, (value, kind) in numbers.items() if value is not None or "." in path}


def replaced(owner: Owner, values: Mapping[str, Any], prefix: str = "") -> Owner:
    """Copy with other numbers at these paths, all put in at once and validated when the copy is complete.

    Raises ValueError where the scene with these numbers is refused.
    """
    parts = ((name, kind, getattr(owner, name)) for name, kind, _ in declared(owner))
    return with_values(owner, **{name: _replaced(part, prefix + name, kind, values) for name, kind, part in parts})


def along(value: Any, dims: tuple[str, ...]) -> Any:
    """Return a number, or a part of a scene, with its arrays in numpy, an axis for each of these dims.

    Arrays with further dims stay as they are.
    """
    return with_arrays(value, lambda array: aligned(array, dims) if {*array.dims} <= {*dims} else array)


def _replaced(value: Any, path: str, kind: FieldKind, values: Mapping[str, Any]) -> Any:
    if path in values:
        return values[path]
    if has_fields(value):
        return replaced(value, values, below(path, kind))
    if isinstance(value, tuple | list):
        kinds = kind.items(value) or (kind,) * len(value)
        items = enumerate(zip(value, kinds, strict=True), 1)
        return tuple(_replaced(item, f"{path}[{k}]", each, values) for k, (item, each) in items)
    return value
