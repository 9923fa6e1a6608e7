"""The machine drawn in a position: bars, pins, block, ground, the crank's circle and the curve of a point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.conversion import to_float64
from linksweep.base.degrees import cos_sin
from linksweep.files.netcdf import scene_of
from linksweep.mechanisms.drawing import Block, Drawing, Guide
from linksweep.plot.kit import machine_parts, signals
from linksweep.plot.kit.colors import BLACK, GREY, SKY, force_color
from linksweep.plot.kit.drawings import drawing_of
from linksweep.plot.kit.style import axes_or_new, grid
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CURVE = 720  # positions along the coupler curve
ARROW = 0.3  # of the drawing's extent: the longest force
BLOCK = 0.13  # of the bars' lengths together: half a side of the block


class Shape(NamedTuple):
    """A machine in a position, lengths in [m]: its pins, and the curves of point and block."""

    pins: dict[str, np.ndarray]
    curve: np.ndarray  # (2, angles) of the coupler point, closed
    point: np.ndarray
    block: np.ndarray  # (2, angles): the places of the block's pin, the last one the present
    along: np.ndarray  # (2, angles): the direction of the block's sides


def mechanism(
    scene: xr.Dataset | Scene,
    theta2: float = 45.0,
    *,
    ax: Axes | None = None,
    point: tuple[float, float] | None = None,
    forces: bool = False,
) -> Axes:
    """Draw the machine in the position of one crank angle, to scale [m].

    Parameters
    ----------
    scene : Scene or Dataset
        Scene of one design, or a Dataset from `linksweep.sweep` that holds it.
    theta2 : float, default 45.0
        Crank angle [degree].
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.
    point : tuple of float, default None
        Point of the coupler (rod) whose curve is drawn: (distance from pin B [m], angle from the line B→C [degree]);
        for an inverted slider-crank a point of the rocker, from D. None for the link's centre of gravity.
    forces : bool, default False
        True for arrows of the force in each joint, to one scale.

    Returns
    -------
    matplotlib Axes
        Axes with equal scales.

    Raises
    ------
    ValueError
        Where the machine cannot be assembled at that angle, and for more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.plot.mechanism(ls.example("press"), theta2=30.0, forces=True).get_xlabel()
    'x [m]'
    """
    scene = scene if isinstance(scene, Scene) else scene_of(scene, whole=False)
    drawing = drawing_of(scene.mechanism)
    angle = _angle(theta2)
    places = positions(scene, drawing, [angle])
    _require_assembled(places, angle)
    shape = shape_of(scene, drawing, places, point)
    acting = _joint_forces(scene, drawing, angle) if forces else {}
    ax = axes_or_new(ax)
    draw_ground(ax, scene, drawing, shape)
    _offset(ax, scene, drawing)
    draw_links(ax, drawing, shape)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.2)
    _forces(ax, acting, {name: shape.pins[drawing.start_of(name)] for name in acting})
    _names(ax, shape, "P" if point else f"$G_{drawing.carrier.number}$")
    ax.set(xlabel="x [m]", ylabel="y [m]")
    ax.set_title(f"$\\theta_2$ = {signals.angle_text(angle)}", loc="left")
    return ax


def _angle(theta2: Any) -> float:
    try:
        return float(to_float64(theta2, "angle"))
    except (TypeError, ValueError):
        raise ValueError(f"theta2 = {theta2!r}: must be one crank angle, in degrees") from None


def positions(scene: Scene, drawing: Drawing, angles: Sequence[float]) -> xr.Dataset:
    """Return the positions of the pins over the revolution and, behind them, at these angles, with their status."""
    set_aside: dict[str, Any] = dict(drawing.ideal)
    machine = replace(scene.mechanism, **set_aside)
    geometry = Scene(machine, omega2=0.0, drive="crank")
    outputs = [f"{pin}{axis}" for pin in drawing.moving for axis in "xy"]
    outputs += [name for name in drawing.angles if name in geometry.table.quantity]
    turn = np.arange(CURVE) * (360.0 / CURVE)
    cycle = sweep(geometry, theta2=[*turn, *angles], of=outputs)
    signals.require_one_design(cycle.values())
    return cycle


def _require_assembled(cycle: xr.Dataset, angle: float) -> None:
    """Raise ValueError where the mechanism has no position at the last angle of a cycle."""
    angles = cycle[signals.INDEX].values
    status = signals.spread(cycle.status, len(angles))
    if status[-1]:
        possible = angles[:-1][status[:-1] == 0]
        off = np.abs((possible - angle + 180.0) % 360.0 - 180.0)
        nearest = f"choose another, such as {possible[np.argmin(off)]:.5g}" if possible.size else "nor at any other"
        raise ValueError(f"theta2 = {angle:.6g} degree: the mechanism {_meaning(cycle)} there; {nearest}")


def _meaning(cycle: xr.Dataset) -> str:
    """Return the meaning of the last status, to follow a subject."""
    word = cycle.status.attrs["flag_meanings"].split()[int(cycle.status.values.ravel()[-1])]
    phrases = {
        "cannot_assemble": "cannot be assembled",
        "toggle": "is at a toggle",
        "dead_centre": "is at a dead centre",
    }
    phrases |= {"jammed": "is jammed by friction", "jammed_two_solutions": "is jammed by friction, with two solutions"}
    phrases |= {"no_cycle": "does not turn fully, as the cycle in its cylinder must"}
    return phrases.get(word, word.replace("_", " "))


def _joint_forces(scene: Scene, drawing: Drawing, angle: float) -> dict[str, np.ndarray]:
    """Return the components (x, y) of the force in each joint at the angle [N]. Raises ValueError where there are
    none."""
    sample = sweep(scene, theta2=[angle], of=[f"{force}{axis}" for force in drawing.forces for axis in "xy"])
    signals.require_one_design(sample.values())
    if sample.status.any():
        raise ValueError(f"theta2 = {angle:.6g} degree: no pin forces there, the mechanism {_meaning(sample)}")
    return {
        force: np.array([part.values.reshape(-1)[0] for part in signals.components(sample, force)])
        for force in drawing.forces
    }


def shape_of(scene: Scene, drawing: Drawing, cycle: xr.Dataset, point: Any) -> Shape:
    """Return the machine's shape at the last angle of a cycle, with the curves over the others."""
    machine, carrier = scene.mechanism, drawing.carrier
    count = cycle.sizes[signals.INDEX]
    moving = {pin: np.array([signals.spread(cycle[f"{pin}{axis}"], count) for axis in "xy"]) for pin in drawing.moving}
    fixed = drawing.fixed(machine)
    link = getattr(machine, carrier.role)
    distance, turned = point or (link.cg_distance, link.cg_angle)
    x, y = _axes(machine, drawing, cycle, carrier.number)
    along, across = (_one(distance) * _one(part) for part in cos_sin(turned))
    start = moving[carrier.pin] if carrier.pin in moving else fixed[carrier.pin][:, None]
    path = start + along * np.array([x, y]) + across * np.array([-y, x])
    curve = np.append(path[:, :-1], path[:, :1], axis=1)
    pins = dict(sorted({**fixed, **{pin: places[:, -1] for pin, places in moving.items()}}.items()))
    if drawing.block is None:
        return Shape(pins, curve, path[:, -1], np.empty((2, 0)), np.empty((2, 0)))
    sides = _axes(machine, drawing, cycle, drawing.block.number)
    return Shape(pins, curve, path[:, -1], moving[drawing.block.pin], sides)


def _axes(machine: Any, drawing: Drawing, cycle: xr.Dataset, link: int) -> np.ndarray:
    """Return the direction of a link's own x axis at each angle of the cycle, (2, angles)."""
    name = drawing.frames[link].angle
    angle = cycle[name].values if name in cycle else np.full(cycle.sizes[signals.INDEX], _one(getattr(machine, name)))
    return np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])


def _one(number: Any) -> float:
    if isinstance(number, xr.DataArray):
        signals.require_one_design([number])
    return float(number)


def draw_ground(ax: Axes, scene: Scene, drawing: Drawing, shape: Shape) -> None:
    """Draw all that stands: the frame's line or the guide, a support under each ground pin, the curves of pin B and
    point."""
    machine: Any = scene.mechanism
    grid(ax)
    standing = np.array([shape.pins[pin] for pin in drawing.fixed(machine)])
    if len(standing) > 1:
        machine_parts.centre_line(ax, standing)
    if drawing.guide is not None:
        _guide(ax, drawing.guide(machine), shape, _half_side(drawing, shape))
    machine_parts.supports(ax, standing)
    machine_parts.crank_circle(ax, _one(machine.crank.length))
    ax.plot(*shape.curve, color=SKY, linewidth=1.4, zorder=2.0, label="_coupler curve")


def _guide(ax: Axes, guide: Guide, shape: Shape, half: float) -> None:
    """Draw the guide's centre line, and its sides along the block's travel."""
    low, high = _travel(shape, guide.foot)
    ends = min(low - 2.0 * half, 0.0), max(high + 2.0 * half, 0.0)
    machine_parts.centre_line(ax, np.array([guide.foot + end * guide.along for end in ends]))
    machine_parts.rails(ax, guide.foot + low * guide.along, guide.foot + high * guide.along, guide.along, half)


def _offset(ax: Axes, scene: Scene, drawing: Drawing) -> None:
    """Draw the distance of a guide from the crank's bearing."""
    from linksweep.plot.kit.labels import label

    foot = np.zeros(2) if drawing.guide is None else drawing.guide(scene.mechanism).foot
    offset = float(np.hypot(*foot))
    if offset > 0.0:
        ax.plot(*np.array([np.zeros(2), foot]).T, color=GREY, linewidth=0.8, zorder=2.0, label="_offset")
        label(ax, *(0.5 * foot), (f"offset {offset:.4g} m", GREY))


def _travel(shape: Shape, origin: np.ndarray) -> tuple[float, float]:
    """Return the ends of the block's travel along its line [m], from a point."""
    places = np.sum((shape.block - origin[:, None]) * shape.along, axis=0)
    return float(np.nanmin(places)), float(np.nanmax(places))


def _half_side(drawing: Drawing, shape: Shape) -> float:
    """Return half a side of the block [m]."""
    lengths = [shape.pins[end] - shape.pins[start] for start, end in drawing.bars.values()]
    return BLOCK * sum(float(np.hypot(*length)) for length in [*lengths, shape.pins.get("D", np.zeros(2))])


def draw_links(ax: Axes, drawing: Drawing, shape: Shape) -> None:
    """Draw all that moves: the block, bars from pin to pin with their numbers, the point tied to its link, the pins
    on top."""
    ends = {number: np.array([shape.pins[pin] for pin in pair]) for number, pair in drawing.bars.items()}
    covered = [shape.point]
    if drawing.block is not None:
        covered.append(shape.pins[drawing.block.pin])
        if drawing.block.on is not None:
            number, pivot = drawing.block.on
            ends[number] = _slideway(ax, drawing, shape, number, shape.pins[pivot])
        bars = [ends[number] for number in drawing.bars]
        _block(ax, drawing.block, shape, _half_side(drawing, shape), np.array(bars))
    start, end = ends[drawing.carrier.number]
    machine_parts.plate(ax, np.array([start, shape.point, end]), behind=drawing.carrier.number not in drawing.bars)
    for number, pair in ends.items():
        if number in drawing.bars:
            machine_parts.bar(ax, number, pair)
        machine_parts.number_of_bar(ax, number, pair, np.array(covered))
    machine_parts.pins(ax, np.array(list(shape.pins.values())))
    machine_parts.point(ax, shape.point)


def _block(ax: Axes, block: Block, shape: Shape, half: float, bars: np.ndarray) -> None:
    """Draw the block with its number, where no bar covers that; `bars` has the ends of each."""
    centre, (x, y) = shape.pins[block.pin], shape.along[:, -1]
    machine_parts.block(ax, centre, np.array([x, y]), half)
    places = centre + 0.7 * half * np.array([(x, y), (-x, -y), (-y, x), (y, -x)])
    along_bars = bars[:, :1] + np.linspace(0.0, 1.0, 50)[:, None] * (bars[:, 1:] - bars[:, :1])
    free = np.linalg.norm(places[:, None] - along_bars.reshape(-1, 2), axis=2).min(axis=1)
    machine_parts.number_at(ax, block.number, places[np.argmax(free)])


def _slideway(ax: Axes, drawing: Drawing, shape: Shape, number: int, pivot: np.ndarray) -> np.ndarray:
    """Draw a link that carries a block, as long as the block's travel; return its ends."""
    along, half = shape.along[:, -1], _half_side(drawing, shape)
    across = np.array([-along[1], along[0]])
    foot = pivot + across * (across @ (shape.pins["B"] - pivot))
    low, high = _travel(shape, pivot)
    ends = np.array([foot + place * along for place in (min(low - 1.4 * half, 0.0), max(high + 1.4 * half, 0.0))])
    machine_parts.bar(ax, number, np.array([pivot, foot]), behind=True)
    machine_parts.bar(ax, number, ends, behind=True)
    return ends


def _names(ax: Axes, shape: Shape, point: str) -> None:
    from linksweep.plot.kit.labels import label

    for name, position in shape.pins.items():
        label(ax, *position, (name, BLACK), fontweight="bold")
    label(ax, *shape.point, (point, BLACK))


def _forces(ax: Axes, forces: dict[str, np.ndarray], starts: dict[str, np.ndarray]) -> None:
    """Draw an arrow from each joint, to one scale, with its value [N]."""
    from linksweep.plot.kit.labels import arrow, label

    extent = max(np.ptp(ax.dataLim.intervalx), np.ptp(ax.dataLim.intervaly))
    largest = max((float(np.hypot(*vector)) for vector in forces.values()), default=0.0)
    for name, vector in forces.items():
        size = float(np.hypot(*vector))
        if size > 0.0:
            start = starts[name]
            tip = start + vector * (ARROW * extent / largest)
            arrow(ax, start, tip, force_color(name))
            label(ax, *tip, (f"{signals.symbol(name)} {signals.number(size)} N", force_color(name)))
