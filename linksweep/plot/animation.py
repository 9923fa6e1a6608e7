"""The film of a machine that moves: the forces in its joints as arrows, and their place on their curves.

Frames lie at equal steps of time. Where toggles, or the lengths, end a revolution, the mechanism goes to and fro over
the longest part that there is; a car stops where it leaves the track. Angles that have no result are skipped.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.memory import require_memory
from linksweep.base.validate import count_problems, quote, refuse
from linksweep.files.netcdf import scene_of
from linksweep.mechanisms.drawing import Drawing, Track
from linksweep.plot import track as track_plot
from linksweep.plot.curves import HEADROOM, forces
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import BLACK, BLUE, FORCE_COLORS, GREY, force_color
from linksweep.plot.kit.drawings import drawing_of
from linksweep.plot.kit.style import small_type
from linksweep.plot.machine import ARROW, CURVE, Shape, draw_ground, draw_links, positions, shape_of
from linksweep.results.cylinders.multi_cylinder import MultiCylinder
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linksweep.plot.kit.film import Film

SAMPLES = 720  # of the curves, for a scene
SIZE, DPI = (6.0, 6.4), 90  # inches, and pixels to an inch
ENDS = ("cannot_assemble", "toggle", "no_cycle", "left_track", "stalled")  # statuses beyond which nothing moves
KNOWN = 24  # frames that the limits of the axes are made for
OFF_SCALE = 1.2  # of the longest arrow on the scale: arrows of forces beyond it
NAMED = 0.08  # of the longest arrow: shorter ones have no name
TINY = 1e-9  # of the largest force: less than that is rounding
NOTHING = "there are not two angles with a result, side by side: see the status of ls.sweep, and ls.check"
ROUND = (5.0, 2.0, 1.0)  # first digits of a scale's number


class Frame(NamedTuple):
    """A position of a machine: crank angle [degree], the places of its parts, the force in each joint (x, y) [N]."""

    angle: float
    shape: Shape
    forces: dict[str, np.ndarray]


def animate(
    scene: xr.Dataset | Scene | MultiCylinder, *, frames: int = 72, point: tuple[float, float] | None = None
) -> Film:
    """Make a film of a machine over its cycle: forces as arrows at the pins, and dots on the curves below.

    Parameters
    ----------
    scene : Scene, Dataset or MultiCylinder
        Scene of one design, or a Dataset from `linksweep.sweep` that holds it: then of its angles, where they are no
        whole cycle.
    frames : int, default 72
        Count of frames in a cycle, 25 a second.
    point : tuple of float, default None
        Point whose curve is drawn, (distance [m], angle [degree]) as `mechanism` takes it.

    Returns
    -------
    Film
        Film that a notebook shows as the last expression of a cell. ``film.save("machine.gif")`` and
        ``film.save("machine.html")`` write it. Arrows are to one scale, that of the curves below them; where forces
        grow without bound, they end a little beyond it.

    Raises
    ------
    ValueError
        For more than one design, and where there is no result at two angles or more.

    Examples
    --------
    >>> import linksweep as ls
    >>> film = ls.plot.animate(ls.example("press"), frames=24)
    >>> len(film)
    24
    """
    refuse(count_problems("frames", frames) or [f"frames = {frames}: must be 2 or more"] * (frames < 2))
    require_memory(f"frames = {quote(frames)}", float(frames * math.prod(SIZE) * DPI**2))
    if isinstance(scene, MultiCylinder):
        from linksweep.plot.cylinder_film import film_of_cylinders  # here: it imports this file

        refuse([f"point = {quote(point)}: must be left out for several cylinders"] if point is not None else [])
        with small_type():
            return film_of_cylinders(scene.in_memory, frames)
    one = scene if isinstance(scene, Scene) else scene_of(scene, whole=False)
    index = one.mechanism.index
    sound = isinstance(scene, Scene) or index in scene.dims
    refuse([] if sound else [f"scene has no dimension {index}: take what ls.sweep returns"])
    angles: Any = SAMPLES if isinstance(scene, Scene) else scene[index].values
    with small_type():
        if one.mechanism.track:
            return _of_track(one, one.mechanism.track, angles, frames)
        return _of_crank(one, drawing_of(one.mechanism), angles, frames, point)


# -------------------------------------------------------------------------------------------------- which angles


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


# ---------------------------------------------------------------------------------------- a mechanism with a crank


def _of_crank(scene: Scene, drawing: Drawing, angles: Any, frames: int, point: Any) -> Film:
    from linksweep.plot.kit.film import Film

    outputs = [f"{force}{axis}" for force in drawing.forces for axis in "xy"]
    cycle = sweep(scene, angles, of=[*outputs, "omega2"])
    signals.require_one_design(cycle[name] for name in outputs)
    shots = frames_of(scene, drawing, way(cycle, cycle["omega2"], frames), point)
    figure, machine, curves = panels()
    forces(cycle, ax=curves)
    top = curves.get_ylim()[1] / HEADROOM
    draw_ground(machine, scene, drawing, shots[0].shape)
    longest = ARROW * max(np.ptp(machine.dataLim.intervalx), np.ptp(machine.dataLim.intervaly))
    arrows = [arrows_of(shot, drawing, top, longest) for shot in shots]
    fit(machine, drawing, shots, arrows)
    scale(machine, top, longest)
    say = readings(machine, "$\\theta_2$ =", {name: signals.symbol(name) for name in drawing.forces})
    follow = follower(curves, list(drawing.forces))
    moving: list[Artist] = []

    def draw(k: int) -> list[Artist]:
        shot, sizes = shots[k], {name: float(np.hypot(*force)) for name, force in shots[k].forces.items()}
        renewed(machine, moving, partial(draw_frame, machine, drawing, shot.shape, arrows[k], longest))
        texts = {name: f"{signals.number(size if size > TINY * top else 0.0)} N" for name, size in sizes.items()}
        return [*moving, *say(shot.angle, texts), *follow(shot.angle, sizes)]

    return Film(figure, draw, len(shots))


def frames_of(scene: Scene, drawing: Drawing, angles: np.ndarray, point: Any) -> list[Frame]:
    """Return the frames at those of these angles that have a result."""
    cycle = sweep(scene, angles, of=[f"{force}{axis}" for force in drawing.forces for axis in "xy"])
    good = np.flatnonzero(signals.spread(cycle["status"], len(angles)) == 0)
    refuse([] if len(good) > 1 else [NOTHING])
    places = positions(scene, drawing, angles.tolist())
    parts = {force: _rows(cycle, force) for force in drawing.forces}
    frames = []
    for k in good:
        shape = shape_of(scene, drawing, places.isel({signals.INDEX: [*range(CURVE), CURVE + k]}), point)
        frames.append(Frame(float(angles[k]), shape, {force: rows[:, k] for force, rows in parts.items()}))
    return frames


def _rows(cycle: xr.Dataset, force: str) -> np.ndarray:
    """Return the components (x, y) at every angle, also of a force that does not depend on it."""
    return np.array([signals.spread(part, cycle.sizes[signals.INDEX]) for part in signals.components(cycle, force)])


def arrows_of(shot: Frame, drawing: Drawing, top: float, longest: float) -> dict[str, np.ndarray]:
    """Return start and end of the arrow of each force, (2, xy) [m]."""
    arrows = {}
    for name, force in shot.forces.items():
        size = float(np.hypot(*force))
        drawn = min(size, OFF_SCALE * top)
        start = shot.shape.pins[drawing.start_of(name)]
        arrows[name] = np.array([start, start + force * (longest / top * drawn / (size or 1.0))])
    return arrows


def draw_frame(ax: Axes, drawing: Drawing, shape: Shape, arrows: dict[str, np.ndarray], longest: float) -> None:
    """Draw all that moves."""
    draw_links(ax, drawing, shape)
    for name, ends in arrows.items():
        _arrow(ax, name, ends, NAMED * longest)
    for name, pin in shape.pins.items():
        ax.annotate(name, tuple(pin), (6.0, 6.0), **_beside(BLACK), fontweight="bold")


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


def fit(ax: Axes, drawing: Drawing, shots: list[Frame], arrows: list[dict[str, np.ndarray]]) -> None:
    """Set axes of equal scales that hold every frame, with room for names, and for the scale at the lower edge."""
    moving: list[Artist] = []
    for shot in shots[:: max(1, len(shots) // KNOWN)]:
        renewed(ax, moving, partial(draw_links, ax, drawing, shot.shape))
    renewed(ax, moving, lambda: None)
    ax.update_datalim(np.concatenate([ends for shot in arrows for ends in shot.values()]))
    (x0, y0), (x1, y1) = ax.dataLim.get_points()
    room = 0.06 * max(x1 - x0, y1 - y0)
    ax.update_datalim([(x0 - room, y0 - 2.5 * room), (x1 + room, y1 + room)])
    ax.margins(0.0)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel="x [m]", ylabel="y [m]")


def scale(ax: Axes, top: float, longest: float) -> None:
    """Draw the length of a round force in the lower left corner."""
    from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

    decade = 10.0 ** np.floor(np.log10(0.7 * top))
    force = next(digit * decade for digit in ROUND if digit * decade <= 0.7 * top)
    style: dict[str, Any] = {"frameon": False, "color": GREY, "borderpad": 0.8}
    ax.add_artist(AnchoredSizeBar(ax.transData, longest * force / top, f"{force:g} N", "lower left", **style))


# -------------------------------------------------------------------------------------------------- a car in a loop


def _of_track(scene: Scene, track: Track, angles: Any, frames: int) -> Film:
    from linksweep.plot.kit.film import Film

    names, index = [track.force, track.speed], {scene.mechanism.index: signals.INDEX}
    cycle = sweep(scene, angles, of=names).rename(index)
    signals.require_one_design(cycle[name] for name in names)
    at = way(cycle, cycle[track.speed], frames, to_and_fro=False)
    shots = sweep(scene, at, of=names).rename(index)
    force, speed = (np.broadcast_to(shots[name].values, len(at)) for name in names)
    figure, ax, curve = panels()
    radius, largest = float(getattr(scene.mechanism, track.radius)), float(np.nanmax(cycle[track.force].values))
    track_plot.draw_track(ax, cycle, track.force, radius)
    track_plot.draw_force(curve, cycle, scene)
    write = readings(ax, "$\\theta$ =", {track.force: "$F_N$", track.speed: "speed"})
    follow = follower(curve, [track.force])
    moving: list[Artist] = []

    def draw(k: int) -> list[Artist]:
        renewed(ax, moving, partial(_car, ax, at[k], radius, force[k] / largest))
        values = {track.force: f"{signals.number(force[k])} N", track.speed: f"{signals.number(speed[k])} m/s"}
        return [*moving, *write(at[k], values), *follow(at[k], {track.force: force[k]})]

    return Film(figure, draw, len(at))


def _car(ax: Axes, angle: float, radius: float, share: float) -> None:
    track_plot.draw_car(ax, radius, angle)
    track_plot.press(ax, angle, radius * (1.0 + track_plot.BAND * share), radius, linewidth=1.6, mutation_scale=11.0)


# ------------------------------------------------------------------------------------------- panels, readings, dots


def panels() -> tuple[Figure, Axes, Axes]:
    """Return a figure with axes for the machine above and for the curves below."""
    from matplotlib.figure import Figure

    figure = Figure(SIZE, DPI, layout="constrained")
    upper, lower = figure.subplots(2, 1, height_ratios=(2.0, 1.0))
    return figure, upper, lower


def readings(ax: Axes, angle: str, words: dict[str, str]) -> Callable[[float, dict[str, str]], list[Artist]]:
    """Write a line above the axes, the angle and the word of each value; return the function that writes the values."""
    style: dict[str, Any] = {"textcoords": "offset points", "va": "baseline"}
    places = np.linspace(0.0, 1.0, len(words) + 1, endpoint=False)
    texts = {}
    for place, (name, word) in zip(places, {"": angle, **words}.items(), strict=True):
        style["color"] = FORCE_COLORS.get(name, BLACK)
        title = ax.annotate(word, (place, 1.0), (0.0, 5.0), xycoords="axes fraction", **style)
        texts[name] = ax.annotate("", (1.0, 1.0), (4.0, 5.0), xycoords=(title, "axes fraction"), **style)

    def say(angle: float, values: dict[str, str]) -> list[Artist]:
        for name, text in {"": f"{angle:.1f}°".replace("-", "−"), **values}.items():
            texts[name].set_text(text)
        return list(texts.values())

    return say


def follower(ax: Axes, names: list[str]) -> Callable[[float, dict[str, float]], list[Artist]]:
    """Draw an upright line, and a dot on each curve; return the function that moves them."""
    cursor = ax.axvline(0.0, color=GREY, linewidth=1.0, zorder=1.9)  # below curves, so that labels stay where they are
    colors = [FORCE_COLORS.get(name, BLUE) for name in names]
    dots = ax.scatter(np.zeros(len(names)), np.zeros(len(names)), c=colors, s=24.0, zorder=2.8, edgecolors="white")

    def follow(angle: float, sizes: dict[str, float]) -> list[Artist]:
        cursor.set_xdata([angle, angle])
        dots.set_offsets([(angle, sizes[name]) for name in names])
        return [cursor, dots]

    return follow


def renewed(ax: Axes, moving: list[Artist], draw: Callable[[], None]) -> None:
    """Draw again all that moves, after removing the artists of the last frame."""
    for artist in moving:
        artist.remove()
    stays = set(ax.get_children())
    draw()
    moving[:] = [artist for artist in ax.get_children() if artist not in stays]
