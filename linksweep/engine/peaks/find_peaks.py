"""Find the peaks of a plan's outputs over the whole turn, between the samples too."""

from __future__ import annotations

from collections import defaultdict
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from linksweep.engine.blocks import block as new_block
from linksweep.engine.kernel.machine_code import INTEGER, INTEGERS, ROW, TABLE
from linksweep.engine.peaks import on_pieces, turns, zeros
from linksweep.engine.peaks.brackets import BEYOND, BRACKET_ROWS, EVALUATIONS, PEAK, PEAK_FAR, PEAK_X
from linksweep.engine.peaks.laid_out import OF_DESIGNS, ON_PIECES, LaidOut, laid_out, over_blocks
from linksweep.engine.peaks.roles import PIECE, WIDTHS
from linksweep.engine.peaks.turns import PEAK_ANGLE
from linksweep.engine.run import Fields, Sizes
from linksweep.engine.trace.plan import Plan

SIGNALS_AT_ONCE = 16
"""Signals searched together."""
PIECES_TOGETHER = 192
"""Pieces that are searched together, at least, in whole blocks of designs: their samples stay in the caches."""
OF_TURNS = (*[INTEGER] * 6, *OF_DESIGNS, TABLE, TABLE, ROW, TABLE)
OF_PIECES = (*[INTEGER] * 4, INTEGERS, *ON_PIECES, TABLE, TABLE, ROW, TABLE, TABLE, ROW, TABLE, TABLE)
OF_ZEROS = (*[INTEGER] * 4, INTEGERS, *ON_PIECES, TABLE, ROW, "f8[:, :, :]")
"""Kinds of the arguments of `turns.search`, `on_pieces.search` and `zeros.find_zeros`."""


class Peaks(NamedTuple):
    """The peaks of signals that have the same dims, as arrays over the signals and these: the largest values, their
    angles from the near-toggle [degree], bounds on how much higher they might be, and the numbers of evaluations."""

    signals: tuple[str, ...]
    dims: tuple[str, ...]
    value: np.ndarray
    angle: np.ndarray
    beyond: np.ndarray
    evaluations: np.ndarray


class PeaksOnPieces(NamedTuple):
    """The peaks of a signal on the pieces of designs, as arrays over these; places are half-angle tangents, 0 or 1 for
    the half turn about the start or the end, and the number of the piece."""

    value: np.ndarray
    tangent: np.ndarray
    end: np.ndarray
    beyond: np.ndarray
    evaluations: np.ndarray
    piece: np.ndarray


def find_peaks(
    plan: Plan, signals: tuple[str, ...], inputs: Fields, sizes: Sizes, smooth: bool, sparse: bool
) -> list[Peaks]:
    """Return the largest value of each signal over the turn, for every design; `smooth` tells that none has jumps or
    kinks, `sparse` that summits may lie between neighbouring samples."""
    requests = _requests(plan, signals)
    return [_peaks(request, laid_out(request, inputs, sizes), smooth, sparse) for request in requests]


@lru_cache(maxsize=64)
def _requests(plan: Plan, signals: tuple[str, ...]) -> list[Plan]:
    """Return plans of signals that have the same dims, and are searched together."""
    together = defaultdict(list)
    for signal in signals:
        together[plan.outputs[signal].dims].append(signal)
    return [
        plan.only((*some[first : first + SIGNALS_AT_ONCE], *WIDTHS))
        for some in together.values()
        for first in range(0, len(some), SIGNALS_AT_ONCE)
    ]


def _peaks(plan: Plan, designs: LaidOut, smooth: bool, sparse: bool) -> Peaks:
    """Return the peaks of a plan's signals, which all have the same dims."""
    signals, lanes, blocks = designs.signals, designs.lanes, designs.blocks
    run, columns = designs.run(turns.search, OF_TURNS), lanes * len(signals)
    best = new_block(EVALUATIONS + 1, columns * blocks)  # a column for each design of each signal, in whole blocks

    def work(first: int, last: int) -> None:
        run(
            first, last, designs.designs, lanes, smooth, sparse, *designs.arguments(first, last),
            np.empty((turns.STATE_ROWS, columns)), np.empty((BRACKET_ROWS, turns.ROOM)), designs.gathered, best,
        )  # fmt: skip

    over_blocks(work, blocks, designs.designs)
    stored = _of_designs(designs, best)
    return Peaks(signals, plan.loops, *(stored[row] for row in (PEAK, PEAK_ANGLE, BEYOND, EVALUATIONS)))


def find_peaks_on_pieces(
    plan: Plan,
    signals: tuple[str, ...],
    inputs: Fields,
    dim: str,
    counts: np.ndarray,
    half: int,
    levels: np.ndarray | None = None,
) -> dict[str, PeaksOnPieces]:
    """Return the largest value of each signal on all pieces of every design; its highest sample at least, where no peak
    can exceed its level (signal, design).

    Designs lie along `dim`, and have so many pieces (`counts`); `half` is how many samples there are on either side of
    the middle of each half turn that follows a piece.
    """
    peaks: dict[str, PeaksOnPieces] = {}
    counts = counts.astype(np.int64)
    for first in range(0, len(signals), SIGNALS_AT_ONCE):
        request = plan.only((*signals[first : first + SIGNALS_AT_ONCE], *WIDTHS))
        pieces = laid_out(request, inputs, {dim: len(counts), PIECE: int(counts.max())}, half)
        none = np.full((len(pieces.signals), len(counts)), -np.inf)
        highest = none if levels is None else levels[first : first + SIGNALS_AT_ONCE].astype(float)
        best = _best_on_pieces(pieces, counts, highest.ravel())
        rows = (PEAK, PEAK_X, PEAK_FAR, BEYOND, EVALUATIONS, on_pieces.OF_PIECE)
        peaks |= {signal: PeaksOnPieces(*(best[row, k] for row in rows)) for k, signal in enumerate(pieces.signals)}
    return peaks


def _best_on_pieces(pieces: LaidOut, counts: np.ndarray, highest: np.ndarray) -> np.ndarray:
    """Return the results of a search on pieces (row, signal, design)."""
    run = pieces.run(on_pieces.search, OF_PIECES)
    lanes, signals, (blocks, together) = pieces.lanes, len(pieces.signals), _blocks_of_pieces(pieces, len(counts))
    most = together * pieces.shape[0] * signals * lanes
    best = np.empty((on_pieces.OF_PIECE + 1, signals * len(counts)))

    def work(first: int, last: int) -> None:
        run(
            first, last, together, lanes, counts, *pieces.arguments_of_pieces(together),
            np.zeros((turns.STATE_ROWS, signals * lanes)), np.zeros((turns.STATE_ROWS, lanes)),
            highest, np.zeros((on_pieces.SUMMIT_ROWS, most)),
            np.zeros((BRACKET_ROWS, turns.ROOM)), pieces.gathered, np.zeros((on_pieces.OF_PIECE, most)), best,
        )  # fmt: skip

    over_blocks(work, blocks, len(counts))
    return best.reshape(len(best), signals, len(counts))


def _blocks_of_pieces(pieces: LaidOut, designs: int) -> tuple[int, int]:
    """Return the number of blocks of designs, and how many of them are searched together."""
    blocks = -(-designs // pieces.lanes)
    return blocks, min(blocks, -(-PIECES_TOGETHER // (pieces.shape[0] * pieces.lanes)))


def _of_designs(designs: LaidOut, best: np.ndarray) -> np.ndarray:
    """Return the results (row, signal, design dims) of designs, whose columns may fill whole blocks."""
    rows, signals = len(best), len(designs.signals)
    return best.reshape(rows, signals, -1)[..., : designs.designs].reshape(rows, signals, *designs.shape)


def zeros_of_pieces(plan: Plan, inputs: Fields, dim: str, counts: np.ndarray, half: int) -> np.ndarray:
    """Return the zeros of a plan's one signal on pieces (number, design, piece, nth), NaN for none: tangents, and 0 or
    1 for the half turn about the start or the end. The other arguments are as in `find_peaks_on_pieces`."""
    counts = counts.astype(np.int64)
    pieces = laid_out(plan, inputs, {dim: len(counts), PIECE: int(counts.max())}, half)
    run = pieces.run(zeros.find_zeros, OF_ZEROS)
    blocks, together = _blocks_of_pieces(pieces, len(counts))
    most, room = pieces.shape[0], zeros.MOST_ZEROS * together * pieces.shape[0] * pieces.lanes
    places = np.full((2, len(counts) * most, zeros.MOST_ZEROS), np.nan)

    def work(first: int, last: int) -> None:
        run(
            first, last, together, pieces.lanes, counts, *pieces.arguments_of_pieces(together),
            np.zeros((zeros.ZERO_ROWS, room)), pieces.gathered, places,
        )  # fmt: skip

    over_blocks(work, blocks, len(counts))
    return places.reshape(2, len(counts), most, zeros.MOST_ZEROS)
