"""A study of as many designs as there are rounds: its process stays small, and its rows are those of designs alone."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.attacks import Outcome

TITLE = "a study of three million designs: bounded memory, and rows equal to designs alone, to the bit"
ROUNDS, SMALL = 3_000_000, 40

MOST_MEMORY = 1.5
"""Most memory of a process that computes a study of any size [GB]."""
ROWS = 40
CHUNKS = 4
"""Designs per chunk of a small study, at least; a large one has chunks of the default size."""
OF = ("F32", "T12")
SPREAD = {"crank.length": (0.03, 0.06), "coupler.length": (0.2, 0.3), "rocker.length": (0.18, 0.26)}
CHILD = "import sys; from benchmarks.stress.attacks.studies import run; run(sys.argv[1], *map(int, sys.argv[2:]))"


def attack(random: np.random.Generator, rounds: int) -> Outcome:
    with tempfile.TemporaryDirectory() as folder:
        path, seed = Path(folder, "study.nc"), int(random.integers(2**31))
        child = subprocess.run([sys.executable, "-c", CHILD, path, str(rounds), str(seed)], capture_output=True)
        if child.returncode:
            return Outcome(rounds, [f"the study ends with {child.returncode}: {child.stderr.decode()[-500:]}"])
        memory = json.loads(child.stdout)
        with ls.open_study(path) as study:
            rows = random.choice(rounds, min(ROWS, rounds // 4), replace=False)
            failures = [failure for row in rows.tolist() for failure in _different(study, row)]
    failures += [f"the process takes {memory:.2f} GB"] * (memory > MOST_MEMORY)
    return Outcome(rounds, failures)


def run(path: str, designs: int, seed: int) -> None:
    """Compute the study, and print the peak memory of this process [GB]."""
    from benchmarks.speed.growth import peak_memory  # here: not available on Windows

    scene = ls.sample(ls.example("press"), SPREAD, n=designs, seed=seed)
    ls.study(scene, path, of=OF, chunk=max(1, designs // CHUNKS) if designs < 1000 else None).close()
    print(peak_memory())


def _different(study: xr.Dataset, row: int) -> Iterator[str]:
    """Yield a sentence about each number of a row that differs from its design's alone."""
    alone = ls.peaks(ls.scene_at(study, design=row), OF)
    for name, number in alone.data_vars.items():
        there = study[name].isel(design=row).values
        if there.tobytes() != number.values.astype(there.dtype).tobytes():
            yield f"design {row}: {name} is {there} in the study, and {number.values} alone"
