"""Dataclasses that compare by content, also where they hold DataArrays, and print what differs from defaults."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from typing import Any

from linksweep.base.fields import converted_fields, declared, has_fields
from linksweep.base.frozen import field_values, normalise
from linksweep.base.validate import is_array


class ByContent:
    """Base of frozen dataclasses (eq=False, repr=False) whose numbers become float64 and that are equal to another of
    their class with equal content: numbers, dims and labels. A `__post_init__` of a subclass calls this one first."""

    def __post_init__(self) -> None:
        normalise(self, **converted_fields(self))

    def __eq__(self, other: object) -> bool:
        return content(self) == content(other) if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        return hash(content(self))

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields alone for copies and pickles, without results cached in the object."""
        return field_values(self)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(self._own_words())})"

    def _repr_html_(self) -> str:
        """Return a drawing and tables for a notebook; by name, for they are made in a room above."""
        html_of: Callable[[Any], str] = import_module("linksweep.reports.notebook").html_of
        return html_of(self)

    def _own_words(self) -> Iterator[str]:
        """Yield "name=value" for each field that differs from its default, and for each thing that it names inline."""
        defaults = self._defaults()
        for name, kind, _ in declared(self):
            value = getattr(self, name)
            if kind.inline and isinstance(value, Mapping):
                yield from (f"{own}={item!r}" for own, item in value.items())
            elif repr(value) != repr(defaults[name]):
                yield f"{name}={value!r}"

    def _defaults(self) -> dict[str, Any]:
        """Return the default of each field."""
        return {name: default for name, _, default in declared(self)}


def content(value: Any) -> Any:
    """Return the content that decides equality, as nested tuples, without names, attributes or other coordinates of
    arrays."""
    if isinstance(value, Mapping):
        return frozenset((name, content(item)) for name, item in value.items())
    if has_fields(value):
        return type(value).__name__, tuple(content(getattr(value, name)) for name, *_ in declared(value))
    if is_array(value):
        labels = [(dim, _labels(value[dim].values)) for dim in value.dims if dim in value.coords]
        return value.dims, value.values.tobytes(), repr(labels)
    if callable(value) and type(value).__hash__ is None:
        return id(value)  # a function of a class that compares its objects has no content to compare here
    return tuple(map(content, value)) if isinstance(value, tuple | list) else value


def _labels(values: Any) -> list[Any]:
    """Return labels as a list, times in nanoseconds and texts as plain ones: files store no more of them."""
    listed: list[Any] = (values.astype("M8[ns]") if values.dtype.kind == "M" else values).tolist()
    return list(map(str, listed)) if values.dtype.kind == "O" else listed
