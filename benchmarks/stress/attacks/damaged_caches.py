"""Damage a cached kernel, or let others write it: it is compiled afresh, cached again, and gives its number."""

from __future__ import annotations

import math
import os
import stat
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest import mock

import numpy as np

from benchmarks.stress.attacks import Outcome
from linksweep.engine.kernel import compile as kernels

TITLE = "a kept kernel damaged, planted by others or replaced by a folder, link or pipe: compiled afresh"
ROUNDS, SMALL = 300, 10

NOBODY = 65534
SOURCE = "from math import sqrt\n\n\ndef kernel(x):\n    x[0] = sqrt(x[0])\n"


def cut(path: Path, random: np.random.Generator) -> None:
    path.write_bytes(path.read_bytes()[: random.integers(path.stat().st_size)])


def flip(path: Path, random: np.random.Generator) -> None:
    content = bytearray(path.read_bytes())
    content[random.integers(len(content))] ^= 1 << int(random.integers(8))
    path.write_bytes(content)


def garbage(path: Path, random: np.random.Generator) -> None:
    path.write_bytes(random.bytes(int(random.integers(100_000))))


def writable(path: Path, random: np.random.Generator) -> None:
    path.chmod(0o600 | int(random.choice([stat.S_IWGRP, stat.S_IWOTH])))


def folder(path: Path, random: np.random.Generator) -> None:
    path.unlink()
    path.mkdir()


def link(path: Path, random: np.random.Generator) -> None:
    path.rename(path.with_suffix(".elsewhere"))
    path.symlink_to(path.with_suffix(random.choice([".elsewhere", ".missing"])))


def pipe(path: Path, random: np.random.Generator) -> None:
    path.unlink()
    os.mkfifo(path)


def foreign(path: Path, random: np.random.Generator) -> None:
    os.chown(random.choice([path, path.parent]), NOBODY, NOBODY)


def full(path: Path, random: np.random.Generator) -> None:
    path.parent.chmod(0o500)


DAMAGES: tuple[Callable[[Path, np.random.Generator], None], ...] = (cut, flip, garbage, writable, folder, link, pipe)


def attack(random: np.random.Generator, rounds: int) -> Outcome:
    damages = (*DAMAGES, foreign) if os.geteuid() == 0 else (*DAMAGES, full)
    failures = []
    for count in range(rounds):
        damage = damages[count % len(damages)]
        try:
            failures += [f"{damage.__name__}: {problem}" for problem in _problems(damage, random)]
        except Exception as error:
            failures.append(f"{damage.__name__}: {type(error).__name__}: {error}")
    return Outcome(rounds, failures)


def _problems(damage: Callable[[Path, np.random.Generator], None], random: np.random.Generator) -> list[str]:
    with TemporaryDirectory() as cache, mock.patch.dict(os.environ, {"LINKSWEEP_CACHE_DIR": f"{cache}/kernels"}):
        first = _root_of_two()
        (path,) = Path(cache, "kernels").glob("kernel_*")
        damage(path, random)
        again = _root_of_two()
        left = list(Path(cache, "kernels").glob("*.tmp"))
    wrong = [] if first == again == math.sqrt(2) else [f"√2 is {first}, then {again}"]
    return wrong + [f"{path.name} is left behind" for path in left]


def _root_of_two() -> float:
    """Compile a kernel, or load it from the cache, as a new process would."""
    x = np.array([2.0])
    kernels.compiled.__wrapped__(SOURCE, kinds=("f8*",))(x)
    return float(x[0])
