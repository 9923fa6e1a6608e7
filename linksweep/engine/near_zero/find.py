"""Find the dips and the zeros of a plan's outputs over the whole turn."""

from __future__ import annotations

import numpy as np

from linksweep.engine.kernel.machine_code import INTEGER, INTEGERS, ROW, TABLE
from linksweep.engine.near_zero import dips, samples, search
from linksweep.engine.peaks.laid_out import OF_DESIGNS, laid_out, over_blocks
from linksweep.engine.peaks.samples import HALF
from linksweep.engine.peaks.zeros import ZERO_ROWS
from linksweep.engine.run import Fields
from linksweep.engine.trace.plan import Plan

KINDS = (*[INTEGER] * 4, *OF_DESIGNS, "f8[:, :, :]", ROW, *[TABLE] * 3, INTEGERS, TABLE, INTEGERS, "f8[:, :, :]", ROW)
"""Kinds of the arguments of `search.find_near_zero`."""


def dips_and_zeros(
    plan: Plan, inputs: Fields, dim: str, kinds: np.ndarray, ends: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the narrow dips and the zeros of signals of these kinds, and where there may be more of them, as rows of
    `samples` (row, design, nth), NaN for none; and whether each design is left: one of which noise may take a
    dip beyond zero, or that has too many dips or zeros.

    Designs lie along `dim`; `ends` are those of the pieces of their turns. The plan has three signals for each kind.
    """
    divided = ends.shape[2] > len(samples.ENDS)
    designs = laid_out(plan, inputs, {dim: ends.shape[1]}, samples.HALF if divided else HALF, samples.EVENLY)
    run = designs.run(search.find_near_zero, KINDS)
    places, columns = 2 * (designs.half + samples.SPARE) + 1, samples.MOST * designs.lanes
    events = np.full((samples.EVENT_ROWS, designs.designs, samples.MOST), np.nan)
    left = np.zeros(designs.designs)

    def work(first: int, last: int) -> None:
        counts = np.zeros((2, designs.lanes), dtype=np.int64)
        run(
            first, last, designs.designs, designs.lanes, *designs.arguments(first, last, places), ends, kinds,
            *np.zeros((2, 1, len(kinds) * designs.lanes)), np.zeros((dips.DIP_ROWS, columns)), counts[0],
            np.zeros((ZERO_ROWS, columns)), counts[1], events, left,
        )  # fmt: skip

    over_blocks(work, designs.blocks, designs.designs)
    return events, left > 0.0
