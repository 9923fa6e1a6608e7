"""Name the parameters of a public function or constructor where a call does not fit them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import is_dataclass
from functools import wraps
from inspect import Parameter, signature
from typing import Any

from linksweep.base.fields import ANYTHING, declared
from linksweep.base.validate import quote


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
    known = signature(called).parameters
    if name in known or any(each.kind is Parameter.VAR_KEYWORD for each in known.values()):
        return ""
    return f"{name} = {quote(value)}: {called.__name__} has no such parameter; it has {', '.join(known)}"


def _call_problems(called: Any, count: int, named: Mapping[str, Any]) -> Iterator[str]:
    """Yield a line for each parameter that is unknown, there twice or missing in a call with `count` unnamed values."""
    parameters = signature(called).parameters
    in_order = [name for name, each in parameters.items() if each.kind is Parameter.POSITIONAL_OR_KEYWORD]
    if count > len(in_order) and not any(each.kind is Parameter.VAR_POSITIONAL for each in parameters.values()):
        others = ", ".join(name for name, each in parameters.items() if each.kind is Parameter.KEYWORD_ONLY)
        most = f"{called.__name__} takes at most {len(in_order)}, {', '.join(in_order)}"
        yield f"{count} values without a name: {most}" + (f"; the others have names, {others}" if others else "")
    for name, value in named.items():
        if name in in_order[:count]:
            yield f"{name} = {quote(value)}: stands twice, in its place and by its name; leave one out"
        elif problem := unknown_parameter(called, name, value):
            yield problem
    kinds = {name: kind for name, kind, _ in declared(called)} if is_dataclass(called) else {}
    needed = [name for name, each in parameters.items() if each.default is each.empty and each.kind not in OF_MANY]
    for name in needed:
        if name not in {*in_order[:count], *named}:
            kind = kinds.get(name, ANYTHING)
            known = f"{called.__name__} needs {', '.join(needed)}"
            yield f"{name}: missing; {known if kind is ANYTHING else f'must be {kind.requirement}'}"


OF_MANY = {Parameter.VAR_POSITIONAL, Parameter.VAR_KEYWORD}
"""Kinds of parameters that take any number of values, also none."""
