"""Use odd names of dims and odd labels: either the scene refuses them, or every kind of file restores them."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

import linksweep as ls
from benchmarks.stress.attacks import Outcome

TITLE = "odd names and labels are refused in words, or come back from every kind of file"
ROUNDS = 2000
SMALL = 16

Random = np.random.Generator
SIGNS = (*map(chr, range(128)), "é", "e\u0301", "\u00a0", "\u2003", "🙂", "\ud800", "θ", "\u212b", "\ufeff")
OBJECTS = (None, 1, 2.5, True, "a", "", b"a", 2**70, 1j, (1, 2), pd.NA, pd.Timestamp(0), np.str_("b"))
DTYPES = ("f2", "f4", "f8", "longdouble", ">f8", "i1", ">i4", "u8", "?", "c16", "S1", "U1", "M8[s]", "M8[ns]", "m8[s]")


def attack(random: Random, rounds: int) -> Outcome:
    failures = []
    for k in range(rounds):
        name, labels = (_name(random), np.arange(2.0)) if k % 2 else ("case", _labels(random))
        failures += [f"round {k}, {name!r}, {labels!r}: {failure}" for failure in _kept(name, labels)]
    return Outcome(rounds, failures)


def _name(random: Random) -> str:
    """Return a name of few signs, most of them plain, or of nearly as many as a file can hold."""
    if random.integers(10) == 0:
        return "é" * int(random.integers(126, 130)) + "x" * int(random.integers(2))
    before, after = ("".join(random.choice(list("abc 1_"), random.integers(3))) for _ in range(2))
    return before + str(random.choice(SIGNS)) + after


def _labels(random: Random) -> Any:
    """Return two labels: of one dtype, of any kind, texts of odd signs, or an index of pandas."""
    kind = random.integers(4)
    if kind == 0:
        return random.integers(0, 100, 2).astype(str(random.choice(DTYPES)))
    if kind == 1:
        labels = np.empty(2, object)
        labels[:] = [OBJECTS[k] for k in random.integers(len(OBJECTS), size=2)]
        return labels
    if kind == 2:
        return np.array([f"a{SIGNS[k]}b" for k in random.integers(len(SIGNS), size=2)])
    return [
        pd.date_range(f"{random.choice([1500, 1999, 2500])}", periods=2, unit="s"),
        pd.date_range("2020", periods=2, tz="Europe/Berlin"),
        pd.period_range("2020", periods=2, freq="M"),
        pd.interval_range(0, 2),
        pd.CategoricalIndex(["a", "b"]),
    ][random.integers(5)]


def _kept(name: str, labels: Any) -> Iterator[str]:
    """Yield the problems of a scene over a dim of this name and these labels."""
    try:
        omega2 = xr.DataArray([10.0, 20.0], {name: (name, labels)}, name)
    except Exception:  # xarray itself refuses it
        return
    try:
        scene = replace(ls.example("press"), omega2=omega2)
    except ValueError as refused:
        if not str(refused).startswith("omega2 has "):
            yield f"refused as {refused}"
        return
    with tempfile.TemporaryDirectory() as folder:
        ways = {
            "study.nc": lambda path: ls.study(scene, path, of=["T12"], theta2=4),
            "sweep.nc": lambda path: ls.save(ls.sweep(scene, 4, of=["T12"]), path),
            "scene.toml": lambda path: ls.save(scene, path),
        }
        for way, write in ways.items():
            path = Path(folder) / way
            try:
                write(path)
                same = ls.load_scene(path) == scene
            except Exception as error:
                yield f"{way}: {type(error).__name__}: {error}"
            else:
                yield from [] if same else [f"{way}: the scene comes back another"]
