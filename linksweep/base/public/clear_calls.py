"""Name the parameters of a public function, constructor or method where a call does not fit them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import is_dataclass
from functools import wraps
from inspect import Parameter, signature
from typing import Any, TypeVar, cast

from linksweep.base.fields import ANYTHING, FieldKind, declared
from linksweep.base.validate import did_you_mean, quote

Function = TypeVar("Function", bound=Callable[..., Any])

IN_ORDER = {Parameter.POSITIONAL_ONLY, Parameter.POSITIONAL_OR_KEYWORD}
"""Kinds of parameters whose values need no name."""
OF_MANY = {Parameter.VAR_POSITIONAL, Parameter.VAR_KEYWORD}
"""Kinds of parameters that take any number of values, also none."""


def naming_parameters(function: Callable[..., Any], called: Any, unnamed: int = 0) -> Callable[..., Any]:
    """Return a function that names the parameters of what its user called where the call does not fit them.

    `called` is the function itself, or the class whose constructor it is; `unnamed` first values are not the user's.
    """

    @wraps(function)
    def clear(*values: Any, **named: Any) -> Any:
        try:
            return function(*values, **named)
        except TypeError:
            if problems := [*_call_problems(called, len(values) - unnamed, named)]:
                raise TypeError("\n".join(problems)) from None
            raise

    return clear


def clear_method(method: Function) -> Function:
    """Decorate a method, so that it names its parameters where a call does not fit them."""
    return cast(Function, naming_parameters(method, called=method, unnamed=1))


def passing_options_to(receiver: Callable[..., Any]) -> Callable[[Function], Function]:
    """Decorate a function whose further named values are options of another, so that it refuses names of neither."""

    def decorate(function: Function) -> Function:
        own = [name for name, each in _parameters(function).items() if each.kind is not Parameter.VAR_KEYWORD]
        options = [name for name, each in _parameters(receiver).items() if each.kind is Parameter.KEYWORD_ONLY]
        known = dict.fromkeys([*own, *options])

        @wraps(function)
        def checked(*values: Any, **named: Any) -> Any:
            if problems := [_unknown(function, *each, known) for each in named.items() if each[0] not in known]:
                raise TypeError("\n".join(problems))
            return function(*values, **named)

        return cast(Function, checked)

    return decorate


def unknown_parameter(called: Any, name: str, value: Any) -> str:
    """Return the problem of a name that is no parameter of what is called; empty for one that is."""
    known = _parameters(called)
    if name in known or any(each.kind is Parameter.VAR_KEYWORD for each in known.values()):
        return ""
    return _unknown(called, name, value, known)


def _unknown(called: Any, name: str, value: Any, known: Iterable[str]) -> str:
    advice = did_you_mean(name, known) or f"; it has {', '.join(known) or 'none'}"
    return f"{name} = {quote(value)}: {called.__name__} has no such parameter{advice}"


def _call_problems(called: Any, count: int, named: Mapping[str, Any]) -> Iterator[str]:
    """Yield a line for parameters that are unknown, there twice or missing in a call with `count` unnamed values."""
    parameters = _parameters(called)
    in_order = [name for name, each in parameters.items() if each.kind in IN_ORDER]
    if count > len(in_order) and not any(each.kind is Parameter.VAR_POSITIONAL for each in parameters.values()):
        yield _too_many(called, count, in_order)
    for name, value in named.items():
        if name in in_order[:count]:
            yield f"{name} = {quote(value)}: stands twice, in its place and by its name; leave one out"
        elif problem := unknown_parameter(called, name, value):
            yield problem
    needed = [name for name, each in parameters.items() if each.default is each.empty and each.kind not in OF_MANY]
    missing = [name for name in needed if name not in {*in_order[:count], *named}]
    kinds = {name: kind for name, kind, _ in declared(called)} if is_dataclass(called) else {}
    yield from (f"{name}: missing; must be {kinds[name].requirement}" for name in missing if _is_declared(name, kinds))
    if undeclared := [name for name in missing if not _is_declared(name, kinds)]:
        yield f"{', '.join(undeclared)}: missing; {called.__name__} needs {', '.join(needed)}"


def _too_many(called: Any, count: int, in_order: list[str]) -> str:
    values = "1 value" if count == 1 else f"{count} values"
    most = f"at most {len(in_order)}, {', '.join(in_order)}" if in_order else "none"
    others = ", ".join(name for name, each in _parameters(called).items() if each.kind is Parameter.KEYWORD_ONLY)
    with_names = f"; the others have names, {others}" if others else ""
    return f"{values} without a name: {called.__name__} takes {most}{with_names}"


def _is_declared(name: str, kinds: Mapping[str, FieldKind]) -> bool:
    return kinds.get(name, ANYTHING) is not ANYTHING


def _parameters(called: Any) -> dict[str, Parameter]:
    """Return the parameters that a user states: of a method, all but the object or class."""
    return {name: each for name, each in signature(called).parameters.items() if name not in ("self", "cls")}
