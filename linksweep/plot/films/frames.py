"""Frames of a film: their angles, the places of parts, forces as arrows; the figure with readings and dots on curves.

Frames lie at equal steps of time. Where toggles, or the lengths, end a revolution, the mechanism goes to and fro over
the longest part that there is; a car stops where it leaves the track. Angles that have no result are skipped.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.validate import refuse
from linksweep.mechanisms.drawing import Drawing
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import BLACK, BLUE, GREY, LOAD, force_color
from linksweep.plot.kit.load_parts import draw_loads, tail
from linksweep.plot.kit.load_symbols import LoadSymbol, loads_at
from linksweep.plot.kit.shape import Shape, half_side, positions, shape_of
from linksweep.plot.kit.style import show_lengths
from linksweep.plot.machine import draw_links
from linksweep.results.peak_search.paths import Part
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import UnitSystem
from linksweep.tables.cells import fixed

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SAMPLES = 720  # of the curves, for a scene
SIZE, DPI = (6.0, 6.4), 90  # inches, and pixels to an inch
ENDS = ("cannot_assemble", "toggle", "no_cycle", "left_track", "stalled")  # statuses beyond which nothing moves
KNOWN = 24  # frames that the limits of the axes are made for
OFF_SCALE = 1.2  # of the longest arrow on the scale: arrows of forces beyond it
IN_A_ROW, LINE = 5, 13.0  # readings in a row, and points from row to row
NAMED = 0.08  # of the longest arrow: shorter ones have no name
TINY = 1e-9  # of the largest force: less than that is rounding
NOTHING = "there are not two angles with a result, side by side: see the status of ls.sweep, and ls.check"
ROUND = (5.0, 2.0, 1.0)  # first digits of a scale's number


class Frame(NamedTuple):
    """A position of a machine: crank angle [degree], the places of its parts, the force in each joint (x, y) [N], and
    the loads."""

    angle: float
    shape: Shape
    forces: dict[str, np.ndarray]
    loads: list[LoadSymbol]

    def turned(self, turn: np.ndarray) -> Frame:
        """Return the frame turned about the origin by a rotation matrix."""
        forces = {name: turn @ force for name, force in self.forces.items()}
        return Frame(self.angle, self.shape.turned(turn), forces, [load.turned(turn) for load in self.loads])


class Scale(NamedTuple):
    """Scale of arrows: the largest force on it [N], and the length of that force's arrow [m]."""

    top: float
    longest: float

    @property
    def length(self) -> float:
        """Length of a unit of force [m/N]."""
        return self.longest / self.top

    def drawn(self, force: np.ndarray) -> np.ndarray:
        """Return a force (x, y) [N], shortened where it is beyond the scale."""
        size = float(np.hypot(*force))
        return force * (min(size, OFF_SCALE * self.top) / (size or 1.0))


def way(cycle: xr.Dataset, rate: xr.DataArray, frames: int, to_and_fro: bool = True) -> np.ndarray:
    """Return the angles of the frames [degree], at equal steps of time: of a cycle, or of a part of one that is not
    whole.

    The part is the longest, to and fro, or else the first. `rate` is the speed at each angle: where it is negative, the
    cycle is run through backwards.
    """
    words = np.array(cycle["status"].attrs["flag_meanings"].split())
    angles, status, pace = signals.revolution(cycle, cycle["status"], rate)
    ended = np.isin(words[status.astype(int)], ENDS)
    period = period_of(cycle)
    if period and not ended.any():
        at = _at_equal_times(angles, pace, frames + 1)[:-1]
    elif to_and_fro:
        to = _at_equal_times(*_longest(angles, pace, ended, period), frames // 2 + 1)
        at = np.concatenate([to, to[-2:0:-1]])
    else:
        at = _at_equal_times(*_parts(angles, pace, ended)[0], frames)
    at = at % period if period else at
    return at[::-1] if np.nansum(pace) < 0.0 else at


def period_of(cycle: xr.Dataset) -> float | None:
    """Return the period [degree] that a Dataset's angles fill; None where they are no whole cycle."""
    return signals.full_turn(np.sort(cycle[signals.INDEX].values.astype(float)))


def _longest(
    angles: np.ndarray, pace: np.ndarray, ended: np.ndarray, period: float | None
) -> tuple[np.ndarray, np.ndarray]:
    """Return angles and speeds of the longest part; in a whole cycle it may go on beyond the end."""
    if period and not ended.all():
        first = int(np.argmax(ended))
        angles = np.concatenate([angles[first:-1], angles[:first] + period])
        pace, ended = (np.concatenate([row[first:-1], row[:first]]) for row in (pace, ended))
    return max(_parts(angles, pace, ended), key=lambda part: len(part[0]))


def _parts(angles: np.ndarray, pace: np.ndarray, ended: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return angles and speeds of each part of two angles or more between those where nothing moves."""
    edges = np.flatnonzero(np.diff(~ended, prepend=False, append=False)).reshape(-1, 2)
    parts = [(angles[start:stop], pace[start:stop]) for start, stop in edges if stop - start > 1]
    refuse([] if parts else [NOTHING])
    return parts


def _at_equal_times(angles: np.ndarray, rate: np.ndarray, count: int) -> np.ndarray:
    """Return angles between the first and the last at equal steps of time; of angle, where the speed is 0 or
    unknown."""
    pace = np.abs(rate[1:] + rate[:-1])
    steps = np.diff(angles)
    if np.isfinite(pace).all() and (pace > 0.0).all():
        steps = steps / pace
    time = np.concatenate([[0.0], np.cumsum(steps)])
    return np.interp(np.linspace(0.0, time[-1], count), time, angles)


def frames_of(scene: Scene, drawing: Drawing, angles: np.ndarray, point: Any, part: Part | None = None) -> list[Frame]:
    """Return the frames at those of these angles that have a result, with curves over a part of the turn or all of
    it."""
    cycle = sweep(scene, angles, of=[f"{force}{axis}" for force in drawing.forces for axis in "xy"])
    good = np.flatnonzero(signals.spread(cycle["status"], len(angles)) == 0)
    refuse([] if len(good) > 1 else [NOTHING])
    places = positions(scene, drawing, angles.tolist(), part)
    parts = {force: _rows(cycle, force) for force in drawing.forces}
    loads = loads_at(scene, drawing, places, angles.tolist())
    curve = places.sizes[signals.INDEX] - len(angles)
    frames = []
    for k in good:
        shape = shape_of(scene, drawing, places.isel({signals.INDEX: [*range(curve), curve + k]}), point)
        frames.append(Frame(float(angles[k]), shape, {force: rows[:, k] for force, rows in parts.items()}, loads[k]))
    return frames


def _rows(cycle: xr.Dataset, force: str) -> np.ndarray:
    """Return the components (x, y) at every angle, also of a force that does not depend on it."""
    return np.array([signals.spread(part, cycle.sizes[signals.INDEX]) for part in signals.components(cycle, force)])


def _arrows(shot: Frame, drawing: Drawing, scale: Scale) -> dict[str, np.ndarray]:
    """Return start and end of the arrow of each force, (2, xy) [m]."""
    starts = {name: shot.shape.pins[drawing.start_of(name)] for name in shot.forces}
    tips = {name: starts[name] + scale.length * scale.drawn(force) for name, force in shot.forces.items()}
    return {name: np.array([starts[name], tips[name]]) for name in starts}


def _loads(shot: Frame, scale: Scale) -> list[LoadSymbol]:
    """Return the loads with their forces as they are drawn."""
    forces = [None if load.force is None else scale.drawn(load.force) for load in shot.loads]
    return [load._replace(force=force) for load, force in zip(shot.loads, forces, strict=True)]


def draw_frame(ax: Axes, drawing: Drawing, shot: Frame, scale: Scale) -> None:
    """Draw all that moves."""
    links = draw_links(ax, drawing, shot.shape)
    for load, place in draw_loads(ax, _loads(shot, scale), links, half_side(drawing, shot.shape), scale.length):
        _name_load(ax, load, place)
    for name, ends in _arrows(shot, drawing, scale).items():
        _arrow(ax, name, ends, NAMED * scale.longest)
    for name, pin in shot.shape.lettered.items():
        ax.annotate(name, tuple(pin), (6.0, 6.0), **_beside(BLACK), fontweight="bold")


def _name_load(ax: Axes, load: LoadSymbol, place: np.ndarray) -> None:
    """Write the name of a load behind its arrow, or beside it."""
    style = _beside(LOAD) | {"va": "center"}
    if load.force is None:
        ax.annotate(load.name, tuple(place), (16.0, -16.0), **style)
        return
    behind = -14.0 * load.force / np.hypot(*load.force)
    ax.annotate(load.name, tuple(place), tuple(behind), **style | {"ha": "center"})


def _arrow(ax: Axes, name: str, ends: np.ndarray, named: float) -> None:
    """Draw the arrow of a force with its name outside its tip."""
    from linksweep.plot.kit.labels import arrow

    length = float(np.hypot(*(ends[1] - ends[0])))
    if length > 0.0:
        arrow(ax, ends[0], ends[1], force_color(name))
    if length > named:
        x, y = 11.0 * (ends[1] - ends[0]) / length
        style = _beside(force_color(name)) | {"ha": "center", "va": "center"}
        ax.annotate(signals.symbol(name), tuple(ends[1]), (x, y), **style)


def _beside(color: str) -> dict[str, Any]:
    from matplotlib.patheffects import withStroke

    halo = [withStroke(linewidth=2.0, alpha=0.7, foreground="white")]
    return {"textcoords": "offset points", "color": color, "path_effects": halo, "zorder": 3.0, "fontsize": "small"}


def fit(ax: Axes, drawing: Drawing, shots: list[Frame], scale: Scale, system: UnitSystem) -> None:
    """Set axes of equal scales that hold every frame, with room for names, and for the scale at the lower edge."""
    moving: list[Artist] = []
    for shot in shots[:: max(1, len(shots) // KNOWN)]:
        renewed(ax, moving, partial(draw_links, ax, drawing, shot.shape))
    renewed(ax, moving, lambda: None)
    for shot in shots:
        pushes = (tail(load, half_side(drawing, shot.shape), scale.length) for load in _loads(shot, scale) if load.acts)
        ax.update_datalim(np.concatenate([*_arrows(shot, drawing, scale).values(), *pushes]))
    (x0, y0), (x1, y1) = ax.dataLim.get_points()
    room = 0.06 * max(x1 - x0, y1 - y0)
    ax.update_datalim([(x0 - room, y0 - 2.5 * room), (x1 + room, y1 + room)])
    ax.margins(0.0)
    ax.set_aspect("equal", adjustable="datalim")
    show_lengths(ax, system)


def draw_scale(ax: Axes, scale: Scale, system: UnitSystem) -> None:
    """Draw the length of a round force in the lower left corner."""
    from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

    top, unit = system.value(scale.top, "N"), system.unit("N")
    decade = 10.0 ** np.floor(np.log10(0.7 * top))
    force = next(digit * decade for digit in ROUND if digit * decade <= 0.7 * top)
    style: dict[str, Any] = {"frameon": False, "color": GREY, "borderpad": 0.8}
    ax.add_artist(
        AnchoredSizeBar(ax.transData, scale.longest * force / top, f"{force:g} {unit}", "lower left", **style)
    )


def panels(*curves: float) -> tuple[Figure, Axes, list[Axes]]:
    """Return a figure with axes for the machine above and for curves below, of these shares of a curve's height."""
    from matplotlib.figure import Figure

    width, height = SIZE
    figure = Figure((width, height * (2.0 + sum(curves)) / 3.0), DPI, layout="constrained")
    upper, *lower = figure.subplots(1 + len(curves), 1, height_ratios=(2.0, *curves))
    return figure, upper, lower


def readings(ax: Axes, angle: str, words: dict[str, str]) -> Callable[[float, dict[str, str]], list[Artist]]:
    """Write the angle and the word of each value above the axes; return the function that writes the values."""
    style: dict[str, Any] = {"textcoords": "offset points", "va": "baseline"}
    rows = -(-(len(words) + 1) // IN_A_ROW)
    columns = -(-(len(words) + 1) // rows)
    texts = {}
    for k, (name, word) in enumerate({"": angle, **words}.items()):
        row, column = divmod(k, columns)
        style["color"] = force_color(name) if name.startswith("F") else BLACK
        above = 5.0 + LINE * (rows - 1 - row)
        title = ax.annotate(word, (column / columns, 1.0), (0.0, above), xycoords="axes fraction", **style)
        texts[name] = ax.annotate("", (1.0, 1.0), (4.0, above), xycoords=(title, "axes fraction"), **style)

    def say(angle: float, values: dict[str, str]) -> list[Artist]:
        for name, text in {"": f"{fixed(angle, 1)}°".replace("-", "−"), **values}.items():
            texts[name].set_text(text)
        return list(texts.values())

    return say


def follower(ax: Axes, names: list[str]) -> Callable[[float, dict[str, float]], list[Artist]]:
    """Draw an upright line, and a dot on each curve; return the function that moves them."""
    cursor = ax.axvline(0.0, color=GREY, linewidth=1.0, zorder=1.9)  # below curves, so that labels stay where they are
    colors = [force_color(name) if name.startswith("F") else BLUE for name in names]
    dots = ax.scatter(np.zeros(len(names)), np.zeros(len(names)), c=colors, s=24.0, zorder=2.8, edgecolors="white")

    def follow(angle: float, sizes: dict[str, float]) -> list[Artist]:
        cursor.set_xdata([angle, angle])
        dots.set_offsets([(angle, sizes[name]) for name in names])
        return [cursor, dots]

    return follow


def renewed(ax: Axes, moving: list[Artist], draw: Callable[[], Any]) -> None:
    """Draw again all that moves, after removing the artists of the last frame."""
    for artist in moving:
        artist.remove()
    stays = set(ax.get_children())
    draw()
    moving[:] = [artist for artist in ax.get_children() if artist not in stays]
