"""Write scenes as the text of a scene file."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, NamedTuple

import xarray as xr

from linksweep.base.fields import ANYTHING, FieldKind, PartField, declared, has_fields, left_out
from linksweep.base.records import NamedField, Record
from linksweep.base.validate import refuse
from linksweep.scene.curves.over_position import is_function
from linksweep.scene.curves.tabulated import tabulated
from linksweep.scene.file.errors import Where, path_of
from linksweep.scene.file.file_text import document_text
from linksweep.scene.file.schema import INSTEAD
from linksweep.scene.scene import Scene

FOLLOWING = "of a position"
UNSTEADY = "of theta2 that jumps, or changes too quickly for a file to hold it"

HEAD = """\
# A scene of linksweep: see it with "linksweep check", "peaks" or "report" and the name of this file.
# Plain numbers are in SI units, angles in degrees; a number with another unit stands in quotes, "8 cm".
"""


def write_scene(scene: Scene, elsewhere: Collection[str] = ()) -> str:
    """Return the text of a scene file from which `parse_scene` makes an equal scene, to the bit.

    Names and attributes of DataArrays are not written, nor coordinates other than those of their dims. A function of
    theta2 is written as the samples of `linksweep.scene.curves.tabulated`; for one without such samples the text says
    so.

    Parameters
    ----------
    elsewhere : paths of DataArrays that are stored elsewhere: the text has ``{variable = "coupler.length"}``.
    """
    return document_text(_Writer(scene, elsewhere).written(scene, ANYTHING, ()))


def toml_of(scene: Scene) -> str:
    """Return the text of a scene file for people: see `Scene.to_toml`."""
    require_writable(scene)
    return HEAD + write_scene(scene)


def require_writable(scene: Scene) -> None:
    """Raise ValueError where a function has no samples that represent it, as a function of a position never has."""
    turn = scene.mechanism.period
    paths = [path for path, function in scene.functions.items() if tabulated(function, turn) is None]
    refuse([f"{path} is a function {UNSTEADY}: {INSTEAD}" for path in paths])
    follow = [k for k, load in enumerate(scene.loads, 1) if any(map(is_function, load.over_positions))]
    refuse([f"loads[{k}] has a function {FOLLOWING}: {INSTEAD}" for k in follow])


class _Writer(NamedTuple):
    """The scene to be written, and the paths of its arrays that are stored elsewhere."""

    scene: Scene
    elsewhere: Collection[str]

    def written(self, value: Any, kind: FieldKind, where: Where) -> Any:
        """Return a value of the scene as TOML has it."""
        if type(value) in (float, str):
            return value
        if has_fields(value):
            return self._table(value, kind, where)
        if isinstance(value, (tuple, list)):
            if {*map(type, value)} <= {float}:
                return [*value]
            kinds = kind.items(value) or (kind,) * len(value)
            items = enumerate(zip(value, kinds, strict=True))
            return [self.written(item, each, (*where, k)) for k, (item, each) in items]
        if isinstance(value, xr.DataArray):
            path = path_of(where)
            return {"variable": path} if path in self.elsewhere else _array_written(value)
        if callable(value):
            return self._samples(value, path_of(where))
        return value if isinstance(value, str) else float(value)

    def _table(self, part: Any, kind: FieldKind, where: Where) -> dict[str, Any]:
        """Return the words of a part, those of things that it names inline among them; its `type` unless implied."""
        words: dict[str, Any] = {}
        for name, each, _ in declared(part):
            value = getattr(part, name)
            if type(value) is float or (type(value) is str and value):
                words[name] = value
            elif value is None:
                continue
            elif isinstance(each, NamedField) and each.inline:
                words |= self._table(value, each, where)
            elif not left_out(value):
                words[name] = self.written(value, each, (*where, name))
        return words if _implied(part, kind, where) else {"type": type(part).__name__, **words}

    def _samples(self, function: Any, path: str) -> dict[str, Any]:
        """Return the samples of a function of theta2; a note where there are none, or for a function of a position."""
        of_angle = path in self.scene.functions
        samples = tabulated(function, self.scene.mechanism.period) if of_angle else None
        return {"function": UNSTEADY if of_angle else FOLLOWING} if samples is None else _array_written(samples)


def _implied(part: Any, kind: FieldKind, where: Where) -> bool:
    """Return whether a table needs no `type`: the scene, named things, the default of a list, a single class."""
    if not isinstance(kind, PartField):
        return isinstance(part, (Scene, Record))
    return len(kind.classes) == 1 or (isinstance(where[-1], int) and type(part) is kind.default)


def _array_written(array: xr.DataArray) -> dict[str, Any]:
    coords = {str(dim): _labels_written(array.coords[dim].values) for dim in array.dims if dim in array.coords}
    angles = {"theta2": coords.pop("theta2")} if "theta2" in coords else {}
    dims = {"dim": array.dims[0]} if array.ndim == 1 else {"dims": list(array.dims)}
    return dims | angles | {"values": array.values.tolist()} | ({} if angles and not coords else {"coords": coords})


def _labels_written(labels: Any) -> list[Any]:
    """Return labels as a file has them; numpy knows times in nanoseconds as integers only."""
    listed: list[Any] = (labels.astype("M8[us]") if labels.dtype.kind == "M" else labels).tolist()
    return listed
