"""Frozen dataclasses: how a constructor stores normalised values, how a copy is made, a cache beside an object, and
what is said where a field is assigned to.

Only these functions write to a frozen object, and only before it is returned to anyone.
"""

from __future__ import annotations

import functools
import operator
import sys
import weakref
from collections.abc import Callable
from dataclasses import FrozenInstanceError, fields, replace
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

from linksweep.base.fields import declared, has_fields, is_plain
from linksweep.base.public.clear_calls import naming_parameters, unknown_parameter
from linksweep.base.validate import is_array, quote

if TYPE_CHECKING or sys.version_info >= (3, 12):
    from functools import cached_property as cached_property
else:

    class cached_property(functools.cached_property):
        """A property that is kept, as from Python 3.12 on: before, it took a lock, and four times as long."""

        def __get__(self, owner: Any, _class: type | None = None) -> Any:
            if owner is None:
                return self
            value = vars(owner)[self.attrname] = self.func(owner)
            return value


Owner = TypeVar("Owner")
Result = TypeVar("Result")


def normalise(owner: Any, **values: Any) -> None:
    """Store normalised values in the fields of a frozen dataclass. Only for its `__post_init__`."""
    for name, value in values.items():
        object.__setattr__(owner, name, value)


def unvalidated(cls: type[Owner], **values: Any) -> Owner:
    """Return an object with these fields, skipping the constructor. Only for values known to be valid, or discarded."""
    made = object.__new__(cls)
    normalise(made, **values)
    return made


def with_values(owner: Owner, **values: Any) -> Owner:
    """Copy with replaced fields, validated; the object itself where it already has these values."""
    other = {name: value for name, value in values.items() if not _same(getattr(owner, name), value)}
    return replace(owner, **other) if other else owner  # type: ignore[type-var]


def with_sound(owner: Owner, **values: Any) -> Owner:
    """Copy with replaced fields, skipping validation. Only for values derived from an already valid object."""
    if all(_same(getattr(owner, name), value) for name, value in values.items()):
        return owner
    return unvalidated(type(owner), **field_values(owner) | values)


def bare(value: Any) -> Any:
    """Return a number, or an object with its numbers, without labels: arrays become Variables of xarray, which align
    nothing and are faster."""
    return with_arrays(value, lambda array: array.variable)


def with_arrays(value: Any, convert: Callable[[Any], Any]) -> Any:
    """Return a number, or an object with its numbers, with its arrays converted; itself where it has none."""
    if type(value) is float:
        return value
    if has_fields(value):
        if is_plain(value):
            return value
        return with_sound(value, **{name: with_arrays(getattr(value, name), convert) for name, *_ in declared(value)})
    if isinstance(value, tuple | list):
        return tuple(with_arrays(item, convert) for item in value)
    return convert(value) if is_array(value) else value


def field_values(owner: Any) -> dict[str, Any]:
    """Return the fields of a dataclass by name."""
    return {item.name: getattr(owner, item.name) for item in fields(owner)}


def cached_beside(function: Callable[..., Result]) -> Callable[..., Result]:
    """Cache the results of a function of a frozen object and hashable arguments, for as long as the object lives."""
    caches: dict[int, dict[tuple[Any, ...], Result]] = {}

    @wraps(function)
    def cached(owner: Any, *arguments: Any) -> Result:
        if id(owner) not in caches:
            caches[id(owner)] = {}
            weakref.finalize(owner, caches.pop, id(owner), None)
        cache = caches[id(owner)]
        if arguments not in cache:
            cache[arguments] = function(owner, *arguments)
        return cache[arguments]

    return cached


def cached_copy(copied: Callable[[Owner], Owner]) -> Callable[[Owner], Owner]:
    """Cache the copy that a function makes of a frozen object, in the object.

    Where it returns the object itself nothing is kept: an object that held itself would outlive its last use, until the
    garbage collector finds it.
    """
    name = f"_{copied.__name__}"

    @wraps(copied)
    def cached(owner: Owner) -> Owner:
        kept: Owner | None = vars(owner).get(name)
        if kept is not None:
            return kept
        made = copied(owner)
        if made is not owner:
            vars(owner)[name] = made
        return made

    return cached


def with_clear_calls(cls: Any) -> Any:
    """Let a frozen dataclass name its parameters where it is called with others, or a field is assigned to."""
    assignment = cls.__setattr__

    def assign(self: Any, name: str, value: Any) -> None:
        try:
            assignment(self, name, value)
        except FrozenInstanceError:
            unchanged = f"{cls.__name__} objects do not change; make a new one, dataclasses.replace(old, {name}=...)"
            problem = unknown_parameter(cls, name, value) or f"{name} = {quote(value)}: {unchanged}"
            raise FrozenInstanceError(problem) from None

    cls.__init__, cls.__setattr__ = naming_parameters(cls.__init__, called=cls, unnamed=1), assign
    return cls


def _same(old: Any, new: Any) -> bool:
    """Return whether two values are the same object, or tuples of the same objects."""
    return old is new or (isinstance(new, tuple) and len(old) == len(new) and all(map(operator.is_, old, new)))
