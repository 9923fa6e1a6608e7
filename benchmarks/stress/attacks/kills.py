"""Kill processes that save, or study: the file is one of the whole ones, a study ends as an equal file."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.attacks import Outcome

TITLE = "kill -9 while a file is saved or a study runs: byte-equal in the end, nothing left behind"
ROUNDS, SMALL = 400, 6

CHUNK = 4
LONGEST = 0.3
"""Longest time before a process is killed [s]."""


def attack(random: np.random.Generator, rounds: int) -> Outcome:
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "saved").mkdir()
        saves = _saves(Path(folder, "saved"), random, (rounds + 1) // 2)
        studies = _studies(Path(folder), random, rounds // 2)
    return Outcome(rounds, saves + studies)


def _saves(folder: Path, random: np.random.Generator, kills: int) -> list[str]:
    """Kill processes that write two files in turns to one path."""
    path = folder / "a.nc"
    versions = []
    for samples in (12, 24):
        _save(path, samples)
        versions.append(path.read_bytes())
    problems = []
    for _ in range(kills):
        _killed(_save_on, path, after=float(random.uniform(0.0, LONGEST)))
        problems += ["a saved file is neither the old nor the new one"] * (path.read_bytes() not in versions)
    _save(path, 12)
    return problems + _left(folder, path)


def _studies(folder: Path, random: np.random.Generator, kills: int) -> list[str]:
    """Kill a study again and again; compare each that ends, and begin another."""
    _study(folder / "reference.nc")
    reference, problems, number = (folder / "reference.nc").read_bytes(), [], 0
    while kills > 0:
        number += 1
        own = folder / str(number)
        own.mkdir()
        while kills > 0 and _killed(_study, own / "s.nc", after=float(random.uniform(0.0, LONGEST))):
            kills -= 1
        _study(own / "s.nc")
        problems += ["a study that was killed ends as another file"] * ((own / "s.nc").read_bytes() != reference)
        problems += _left(own, own / "s.nc")
    return problems


def _killed(work: Callable[[Path], None], path: Path, after: float) -> bool:
    """Start a process, kill it after some seconds; return whether it was still at work."""
    context = get_context("forkserver")
    context.set_forkserver_preload(["__main__", __name__])
    process = context.Process(target=_begin, args=(work, path, began := context.Event()))
    process.start()
    began.wait()
    time.sleep(after)
    process.kill()
    process.join()
    return bool(process.exitcode)


def _begin(work: Callable[[Path], None], path: Path, began: object) -> None:
    began.set()
    work(path)


def _save(path: Path, samples: int) -> None:
    ls.save(ls.sweep(ls.example("press"), samples, of=["T12"]), path)


def _save_on(path: Path) -> None:
    while True:
        for samples in (12, 24):
            _save(path, samples)


def _study(path: Path) -> None:
    speed = xr.DataArray(np.linspace(10.0, 40.0, 24), dims="speed")
    ls.study(replace(ls.example("press"), omega2=speed), path, of=["T12"], chunk=CHUNK, theta2=36).close()


def _left(folder: Path, path: Path) -> list[str]:
    return [f"{name} is left behind" for name in os.listdir(folder) if name != path.name]
