"""Attacks: attempts to break linksweep, each a module that can be run for a second or for an hour.

A module has ``TITLE`` (a sentence), ``ROUNDS`` (of a long run), ``SMALL`` (rounds of the test that runs with every
change; 0 where even one takes long) and ``attack(random, rounds) -> Outcome``. Every module of this folder is
registered automatically.
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from typing import NamedTuple

import numpy as np


class Outcome(NamedTuple):
    """Number of attempts, and a sentence about each failure."""

    tried: int
    failures: list[str]


class Attack(NamedTuple):
    """An attack: a module of this folder."""

    name: str
    title: str
    rounds: int
    small: int
    run: Callable[[np.random.Generator, int], Outcome]


def attacks() -> list[Attack]:
    """Return every attack of this folder, sorted by the name of its module."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__) if not module.name.startswith("_"))
    modules = [importlib.import_module(f"{__name__}.{name}") for name in names]
    return [Attack(n, m.TITLE, m.ROUNDS, m.SMALL, m.attack) for n, m in zip(names, modules, strict=True)]
