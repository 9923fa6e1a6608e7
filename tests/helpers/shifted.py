"""Derivatives of the references in 60-digit arithmetic: central differences, exact for so small a step."""

import re
from dataclasses import replace

from references import mp

STEP = mp.mpf("1e-24")
"""Step relative to a parameter: the difference is exact to some 1e-35."""


def shifted(data, path: str, away):
    """Return reference data with the number at a path of the scene moved."""
    name, _, rest = path.partition(".")
    if item := re.fullmatch(r"(\w+)\[(\d)\]", name):
        name, k = item[1], int(item[2]) - 1
        items = list(getattr(data, name))
        items[k] = shifted(items[k], rest, away) if rest else mp.mpf(items[k]) + away
        return replace(data, **{name: tuple(items)})
    value = getattr(data, name)
    return replace(data, **{name: shifted(value, rest, away) if rest else mp.mpf(value) + away})


def step_of(data, path: str):
    """Return the step of a parameter, 1e-24 of it or of 1."""
    value = data
    for part in path.split("."):
        item = re.fullmatch(r"(\w+)\[(\d)\]", part)
        value = getattr(value, item[1])[int(item[2]) - 1] if item else getattr(value, part)
    return STEP * (abs(mp.mpf(value)) or 1)


def derivative(function, data, path: str):
    """Return the derivative of a function of reference data to one number."""
    step = step_of(data, path)
    after, before = (function(shifted(data, path, sign * step)) for sign in (1, -1))
    return (after - before) / (2 * step)
