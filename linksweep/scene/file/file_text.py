"""The TOML of a scene, laid out as people write it: the motion, the mechanism, each link, each load; a value a line."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

Words = Mapping[str, Any]


def document_text(raw: Words) -> str:
    """Return the text of a scene's document, nested as TOML nests it.

    Examples
    --------
    >>> print(document_text({"omega2": 1e-5, "mechanism": {"type": "LoopTrack", "radius": 30.0}}))
    omega2 = 1e-05
    <BLANKLINE>
    [mechanism]
    type = "LoopTrack"
    radius = 30.0
    <BLANKLINE>
    """
    return "\n".join([head + _lines(tuple(words)) % tuple(map(_value, words.values())) for head, words in _tables(raw)])


def _tables(raw: Words) -> Iterator[tuple[str, Words]]:
    """Yield the header and the words of each table; what is nested deeper stands in one line."""
    mechanism = raw["mechanism"]
    links = {key: value for key, value in mechanism.items() if isinstance(value, dict) and "type" in value}
    yield "", {key: value for key, value in raw.items() if key not in ("mechanism", "loads")}
    yield "[mechanism]\n", {key: value for key, value in mechanism.items() if key not in links}
    yield from ((f"[mechanism.{role}]\n", link) for role, link in links.items())
    yield from (("[[loads]]\n", load) for load in raw.get("loads", ()))


@lru_cache(maxsize=256)
def _lines(keys: tuple[str, ...]) -> str:
    """Return the lines of these keys, with "%s" for each value."""
    return "".join(f"{_key(key).replace('%', '%%')} = %s\n" for key in keys)


def _value(value: Any) -> str:
    if type(value) is float or type(value) is int:
        return repr(value)
    if type(value) is str:
        return _word(value)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_key(key)} = {_value(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    return _other(value)


def _other(value: Any) -> str:
    return _by_library("a", value).removeprefix("a = ")


_word = lru_cache(maxsize=1024)(_other)


@lru_cache(maxsize=1024)
def _key(key: str) -> str:
    return key if re.fullmatch(r"[\w-]+", key, re.ASCII) else _by_library(key, 0).removesuffix(" = 0")


def _by_library(key: str, value: Any) -> str:
    import tomli_w  # here: only those who write texts and dates need it

    return tomli_w.dumps({key: value}).removesuffix("\n")
