"""Name the parameters of a public function or constructor where a call does not fit them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import is_dataclass
from functools import wraps
from inspect import Parameter, signature
from typing import Any

from linksweep.base.fields import ANYTHING, FieldKind, declared
from linksweep.base.validate import did_you_mean, quote

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


def unknown_parameter(called: Any, name: str, value: Any) -> str:
    """Return the problem of a name that is no parameter of what is called; empty for one that is."""
    known = _parameters(called)
    if name in known or any(each.kind is Parameter.VAR_KEYWORD for each in known.values()):
        return ""
    advice = did_you_mean(name, known) or f"; it has {', '.join(known)}"
    return f"{name} = {quote(value)}: {called.__name__} has no such parameter{advice}"


def _call_problems(called: Any, count: int, named: Mapping[str, Any]) -> Iterator[str]:
    """Yield a line for parameters that are unknown, there twice or missing in a call with `count` unnamed values."""
    parameters = _parameters(called)
    in_order = [name for name, each in parameters.items() if each.kind in IN_ORDER]
    if count > len(in_order) and not any(each.kind is Parameter.VAR_POSITIONAL for each in parameters.values()):
        others = ", ".join(name for name, each in parameters.items() if each.kind is Parameter.KEYWORD_ONLY)
        most = f"{called.__name__} takes at most {len(in_order)}, {', '.join(in_order)}"
        yield f"{count} values without a name: {most}" + (f"; the others have names, {others}" if others else "")
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


def _is_declared(name: str, kinds: Mapping[str, FieldKind]) -> bool:
    return kinds.get(name, ANYTHING) is not ANYTHING


def _parameters(called: Any) -> dict[str, Parameter]:
    """Return the parameters that a user states: of a method, all but the object."""
    return {name: each for name, each in signature(called).parameters.items() if name != "self"}
