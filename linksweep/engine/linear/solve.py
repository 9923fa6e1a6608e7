"""Solve the square systems of many samples, in blocks of lanes: by numpy while they are few, then compiled."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from linksweep.base.memory import require_memory
from linksweep.engine import run
from linksweep.engine.kernel.machine_code import INTEGERS, ROW
from linksweep.engine.kernel.translate import translated
from linksweep.engine.linear import elimination, lanes
from linksweep.engine.patience import Patience
from linksweep.engine.threads import over_threads

AT_ONCE = 4040
"""Samples of one call: their numbers stay in cache. Rows are an odd number of its lines long and so begin in different
sets: rows of 4096 samples competed for one."""
BLOCKS = "f8[:, :, :]"
KINDS = (BLOCKS, "i8[:, :]", ROW, INTEGERS, BLOCKS, BLOCKS, BLOCKS)
"""Arguments of the functions of `elimination`."""
SAMPLES_PER_THREAD = 10_000
"""Samples that pay for another thread: about a millisecond."""
PATIENCE = defaultdict[str, Patience](Patience)
"""Count, for each function of `elimination` by its name, of what was interpreted: beyond some it is compiled."""


class Structure(NamedTuple):
    """Square systems of one form: `terms` (term, 4) and `coefficients` (term) as `elimination` takes them, and which
    unknowns are torques."""

    terms: np.ndarray
    coefficients: np.ndarray
    torques: np.ndarray


def unknowns(structure: Structure, values: Sequence[np.ndarray], refined: bool = False) -> np.ndarray:
    """Return the unknowns (unknown, sample) of the systems whose terms take `values`, each of shape (sample).

    They are NaN where a matrix is singular. `refined` adds one step of iterative refinement.
    """
    n = len(structure.torques)
    return _run("solve_refined" if refined else "solve", structure, values, (n, n + 1))


def condition(structure: Structure, values: Sequence[np.ndarray]) -> np.ndarray:
    """Return the 1-norm condition number (sample) of each equilibrated matrix; inf where it is singular."""
    n = len(structure.torques)
    return _run("condition", structure, values, (1, 2 * n + 1))[0]


def _run(name: str, structure: Structure, values: Sequence[np.ndarray], widths: tuple[int, int]) -> np.ndarray:
    """Return what a function of `elimination` writes; `widths` are its rows of results and the matrix's columns."""
    (rows, columns), samples = widths, len(values[0])
    require_memory(f"{rows * samples} numbers (results × designs × angles): ask for fewer", 8.0 * rows * samples)
    result = np.empty((rows, samples))
    interpret = PATIENCE[name].should_interpret(10 * samples, run.COMPILE_AFTER)  # numpy is slower than the interpreter
    function: Callable = getattr(elimination, name)
    function = function if interpret else translated(function, KINDS)
    width = min(AT_ONCE, samples) if interpret else lanes.LANES
    room = min(AT_ONCE, -(-samples // width) * width)

    def work(first: int, last: int) -> None:
        read, written = np.zeros((len(values), room)), np.empty((rows, room))
        matrix = np.empty((len(structure.torques), columns, width))
        numbers = np.empty((elimination.WORK_ROWS, max(columns, len(structure.terms)), width))
        for start in range(first * AT_ONCE, min(last * AT_ONCE, samples), AT_ONCE):
            count = min(AT_ONCE, samples - start)
            for row, value in zip(read, values, strict=True):
                row[:count] = value[start : start + count]
            blocks, of_blocks = (array.reshape(len(array), -1, width) for array in (read, written))
            with np.errstate(all="ignore"):
                function(blocks, *structure, matrix, numbers, of_blocks)
            result[:, start : start + count] = written[:, :count]

    over_threads(work, -(-samples // AT_ONCE), 1 + samples // SAMPLES_PER_THREAD)
    return result
