"""Find the designs that stay clear of their limits all the way round: no toggle, near-toggle or wedging anywhere.

The signals of all limits are sampled for several designs side by side. Where none comes near to zero, all parts close
everywhere and move smoothly; the angles at which slides turn round are then found side by side, too.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from linksweep.engine.peaks.evaluators import ALONG, END, FAR, FAR_WIDTH, NEAR_WIDTH, PIECE, TANGENT
from linksweep.engine.peaks.find_peaks import clearances, zeros_of_pieces
from linksweep.engine.peaks.search import HALF
from linksweep.engine.quantity import Limit, Row, Table
from linksweep.engine.run import Field, Fields
from linksweep.engine.trace.plan import Plan
from linksweep.physics.algebra import planar
from linksweep.physics.algebra.arithmetic import Number
from linksweep.physics.closures import crank_angle
from linksweep.results.peak_search.between import ONE, number_of, one_by_one
from linksweep.results.peak_search.curves import WIDE
from linksweep.scene.pairs import Array
from linksweep.scene.scene import Scene

AT_ONCE = 8192
"""Designs sampled together, so that the memory for it does not grow with a study."""
NOISE = 1e6
"""Distance from zero, in units of the signal's noise, from which on a signal may be clear of it."""
STEP = 0.05
"""Least step of the samples of a turn that comes near no toggle [rad]."""
FASTEST = 3.0
"""Turns of a wheel per turn of the crank up to which these samples suffice."""
LENGTH = 30.0
"""Length of the pieces on which a slide's changes of direction are sampled [degree]: 48 samples tell those apart that
lie a degree from each other, as at a toggle joint that is stretched."""
STARTS = LENGTH * (np.arange(12.0) + 0.381966)
"""Their starts: off round angles, where machines have such changes [degree]."""
WIDTH = "turn_width"
"""Input that takes the place of the widths of near-toggles."""
ENDS, HALF_TURN = ("piece_from", "piece_to"), "far_half"
"""Inputs of a piece: its ends as tangents of half the angle from the middle of a half turn; and that half turn."""
ON_TURN, ON_PIECE = (TANGENT, FAR), (ALONG, END)
"""Inputs of a sample."""


def clear_designs(scene: Scene, limits: tuple[Limit, ...], designs: Array) -> tuple[Array, tuple[Array, Array, Array]]:
    """Return the rows of those designs of a mechanism alone that are clear of all limits but jumps; and the row, the
    angle [degree] and the limit's number of each of their jumps."""
    simple = limits and scene.steady and scene.period == scene.mechanism.period
    simple = simple and scene.mechanism.fastest <= FASTEST and _all_move(scene, limits, designs)
    every = np.arange(len(designs) if simple else 0)
    parts = np.split(every, range(AT_ONCE, len(every), AT_ONCE))
    rows, jumps = zip(*(_clear_rows(scene, limits, designs, part) for part in parts), strict=True)
    row, angle, limit = (np.concatenate(numbers) for numbers in zip(*jumps, strict=True))
    return np.concatenate(rows), (row, angle, limit)


def _all_move(scene: Scene, limits: tuple[Limit, ...], designs: Array) -> bool:
    """Return whether the signals of all limits change with the angle: not where parts of a linkage stand still."""
    names, one = [name for limit in limits for name in limit.signals], designs[:1]
    request, _ = _evaluated(scene, limits, one, names, {WIDTH: Field((ONE,), np.ones(len(one)))}, ON_TURN)
    return all(scene.mechanism.index in request.outputs[name].dims for name in names)


def _clear_rows(
    scene: Scene, limits: tuple[Limit, ...], designs: Array, rows: Array
) -> tuple[Array, tuple[Array, Array, Array]]:
    """Return the same of the designs in some of the rows."""
    parts = [(np.empty(0, dtype=int), np.empty(0), np.empty(0, dtype=int))]
    far = [f"clear_{limit.name}_{name}" for limit in limits if limit.zeros != "jump" for name in limit.signals]
    if far and len(rows):
        own = {WIDTH: Field((ONE,), np.ones(len(rows)))}
        least, dip = clearances(*_evaluated(scene, limits, designs[rows], far, own, ON_TURN), {ONE: len(rows)}, None)
        rows = rows[(least > 0.0).all(axis=0) & (dip > (WIDE / STEP) ** 2).all(axis=0)]
    for k, limit in enumerate(limits):
        for signal in limit.signals if limit.zeros == "jump" and len(rows) else ():
            row, angle = _changes_of_sign(scene, limits, designs[rows], signal)
            parts.append((rows[row], angle, np.full(len(row), k)))
    row, angle, part = (np.concatenate(numbers) for numbers in zip(*parts, strict=True))
    return rows, (row, angle, part)


def _changes_of_sign(scene: Scene, limits: tuple[Limit, ...], designs: Array, signal: str) -> tuple[Array, Array]:
    """Return the row of the design and the angle [degree] of each zero of a signal, which may lie close together."""
    half = np.floor(np.mod(STARTS + 0.5 * LENGTH + 90.0, 360.0) / 180.0)
    ends = [np.tan(np.radians(0.5 * (STARTS + length - 180.0 * half))) for length in (0.0, LENGTH)]
    own = {WIDTH: Field((ONE,), np.ones(len(designs)))}
    own |= {name: Field((PIECE,), values) for name, values in zip((*ENDS, HALF_TURN), (*ends, half), strict=True)}
    request, fields = _evaluated(scene, limits, designs, [signal], own, ON_PIECE)
    tangent, of_end = zeros_of_pieces(request, fields, ONE, np.full(len(designs), len(STARTS)), HALF, None)
    row, piece, nth = np.nonzero(np.isfinite(tangent))
    share = np.sin(np.arctan(tangent[row, piece, nth])) ** 2
    share = np.where(of_end[row, piece, nth] > 0.0, 1.0 - share, share)
    x = ends[0][piece] + (ends[1] - ends[0])[piece] * share
    middle = number_of(scene, scene.mechanism.near_toggle_angle, designs)[row]
    return row, np.mod(2.0 * np.degrees(np.arctan(x)) + 180.0 * half[piece] + middle, 360.0)


def _evaluated(
    scene: Scene,
    limits: tuple[Limit, ...],
    designs: Array,
    names: list[str],
    own: Fields,
    places: tuple[str, str],
) -> tuple[Plan, Fields]:
    """Return the plan of quantities of designs at samples of a turn, or of its pieces, and its inputs."""
    on_piece, index = places == ON_PIECE, scene.mechanism.index
    forms = ((places[0], (index, ONE, PIECE) if on_piece else (index, ONE)), (places[1], (index,)))
    table = _table(scene.table, limits, on_piece)
    return one_by_one(scene, designs, table, (*names, NEAR_WIDTH, FAR_WIDTH), own, forms)


@lru_cache(maxsize=64)
def _table(table: Table, limits: tuple[Limit, ...], on_piece: bool) -> Table:
    """Return the table between samples, with the distances of the limits' signals from zero."""
    rows = [Row(planar.identity, (width,), (WIDTH,)) for width in (NEAR_WIDTH, FAR_WIDTH)]
    rows += [Row(crank_angle.place_on_piece, (TANGENT,), (*ON_PIECE, *ENDS))] if on_piece else []
    for limit in (limit for limit in limits if limit.zeros != "jump"):
        distance = above_zero if limit.zeros == "toggle" else from_zero
        for name, noise in zip(limit.signals, limit.noise, strict=True):
            rows.append(Row(distance, (f"clear_{limit.name}_{name}",), (name, noise)))
    between = table.between_samples
    return replace(between, rows=(*between.rows, *rows))


def above_zero(signal: Number, noise: Number) -> Number:
    """Return the height of a signal above what may be noise."""
    return signal - NOISE * noise


def from_zero(signal: Number, noise: Number) -> Number:
    """Return the distance of a signal from what may be noise, to either side."""
    return abs(signal) - NOISE * noise
