"""The machine drawn in a position: bars, pins, block, ground, the crank's circle and the curve of a point."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.base.checked_number import one_pair
from linksweep.base.conversion import to_float64
from linksweep.base.fields import POLAR_POINT
from linksweep.base.validate import choice_problems, flag_problems, refuse
from linksweep.files.netcdf import scene_from
from linksweep.mechanisms.drawing import Block, Drawing, Rail
from linksweep.plot.kit import machine_parts, signals
from linksweep.plot.kit.colors import BLACK, GREY, LOAD, SKY, force_color
from linksweep.plot.kit.drawings import drawing_of
from linksweep.plot.kit.load_parts import draw_loads
from linksweep.plot.kit.load_symbols import LoadSymbol, loads_at
from linksweep.plot.kit.shape import Shape, Slide, block_corners, half_side, part_of, positions, shape_of, slideway
from linksweep.plot.kit.style import axes_or_new, grid, show_lengths
from linksweep.results.peak_search.paths import Part
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import UnitSystem, shown_units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ARROW = 0.3  # of the drawing's extent: the longest force


def mechanism(
    scene: xr.Dataset | Scene,
    theta2: float = 45.0,
    *,
    ax: Axes | None = None,
    point: tuple[float, float] | None = None,
    link: str | None = None,
    forces: bool = False,
) -> Axes:
    """Draw the machine in the position of one crank angle, to scale [m], with its loads and centres of gravity.

    Parameters
    ----------
    scene : Scene or Dataset
        Scene of one design, or a Dataset from `linksweep.sweep` that holds it: then the curve is over its angles, where
        they are no whole turn.
    theta2 : float, default 45.0
        Crank angle [degree].
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.
    point : tuple of float, default None
        Point of a link whose curve is drawn: (distance from its first pin [m], angle from its line of pins [degree]).
        None for the link's centre of gravity.
    link : str, default None
        Role of that link; None for the coupler or rod, of an inverted slider-crank the rocker.
    forces : bool, default False
        True for arrows of the force in each joint, to one scale with those of the loads. Of more than eight forces,
        those below half of the largest have no value.

    Returns
    -------
    matplotlib Axes
        Axes with equal scales. The arrow of a load ends where the force acts, that of gas at its piston; an arc with
        an arrowhead about its point is a torque, a zigzag a spring, a pot a damper. Circles in black and white quarters
        are the centres of gravity of links that have a mass.

    Raises
    ------
    ValueError
        Where the machine cannot be assembled at that angle, for a point that is none, for more than one design, and for
        `forces` that are no truth value.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.plot.mechanism(ls.example("press"), theta2=30.0, forces=True).get_xlabel()
    'x [m]'
    """
    part = part_of(scene) if isinstance(scene, xr.Dataset) else None
    return draw_machine(scene_from(scene, whole=False), part, theta2, ax, point, link, forces)


def draw_machine(
    scene: Scene,
    part: Part | None,
    theta2: float,
    ax: Axes | None = None,
    point: tuple[float, float] | None = None,
    link: str | None = None,
    forces: bool = False,
) -> Axes:
    """Draw a machine as `mechanism` does, with the curve of its point over a part of the turn, or all of it."""
    refuse(flag_problems("forces", forces))
    point = None if point is None else one_pair("point", point, POLAR_POINT)
    drawing = drawing_with_point(scene, link)
    angle = crank_angle(theta2)
    cycle = positions(scene, drawing, [angle], part)
    require_assembled(cycle, angle, scene.period_of_motion)
    shape = shape_of(scene, drawing, cycle, point)
    acting = _joint_forces(scene, drawing, angle) if forces else {}
    (loads,) = loads_at(scene, drawing, cycle, [angle])
    ax = axes_or_new(ax)
    draw_ground(ax, scene, drawing, shape)
    system = shown_units(scene.units)
    _offsets(ax, scene, drawing, system)
    ends = draw_links(ax, drawing, shape)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.2)
    scale = _scale(ax, [*acting.values(), *(load.force for load in loads if load.force is not None)])
    _loads(ax, draw_loads(ax, loads, ends, half_side(drawing, shape), scale), system)
    _forces(ax, acting, {name: shape.pins[drawing.start_of(name)] for name in acting}, scale, system)
    _names(ax, shape)
    if point is not None or not drawing.carrier.end:
        _name(ax, shape.point, "P" if point is not None else f"$G_{drawing.carrier.number}$")
    show_lengths(ax, system)
    ax.set_title(f"$\\theta_2$ = {signals.angle_text(angle)}", loc="left")
    return ax


def drawing_with_point(scene: Scene, link: str | None) -> Drawing:
    """Return the drawing of a scene's machine, with the curve of a point of this link."""
    drawing = drawing_of(scene.mechanism)
    numbers = {body.role: body.number for body in scene.mechanism.bodies}
    refuse(choice_problems("link", link, numbers) if link is not None else [])
    return drawing if link is None else drawing.with_point_on(link, numbers[link])


def crank_angle(theta2: Any) -> float:
    """Return one crank angle [degree]; raise ValueError for anything else."""
    try:
        return float(to_float64(theta2, "angle"))
    except (TypeError, ValueError):
        raise ValueError(f"theta2 = {theta2!r}: must be one crank angle, in degrees") from None


def require_assembled(cycle: xr.Dataset, angle: float, period: float) -> None:
    """Raise ValueError where the mechanism has no position at the last angle of a cycle."""
    angles = cycle[signals.INDEX].values
    status = signals.spread(cycle.status, len(angles))
    if status[-1]:
        possible = angles[:-1][status[:-1] == 0]
        off = np.abs((possible - angle + 0.5 * period) % period - 0.5 * period)
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


def draw_ground(ax: Axes, scene: Scene, drawing: Drawing, shape: Shape) -> None:
    """Draw all that stands: the frame's line, guides, a support under each ground pin, the curves of pin B and
    point."""
    grid(ax)
    standing = np.array([shape.pins[pin] for pin in drawing.fixed(scene.mechanism)])
    if len(standing) > 1:
        machine_parts.centre_line(ax, standing)
    for block, slide in zip(drawing.blocks, shape.slides, strict=True):
        if block.guide is not None:
            _guide(ax, block.guide(scene.mechanism), slide, half_side(drawing, shape))
    machine_parts.supports(ax, standing)
    for pin, radius in drawing.wheels(scene.mechanism):
        machine_parts.circle(ax, shape.pins[pin], radius, "pitch circle")
    first, second = (shape.pins[pin] for pin in drawing.bars[2][:2])
    machine_parts.circle(ax, first, float(np.hypot(*(second - first))), "crank circle")
    ax.plot(*shape.curve, color=SKY, linewidth=1.4, zorder=2.0, label="_coupler curve")


def _guide(ax: Axes, guide: Rail, slide: Slide, half: float) -> None:
    """Draw the guide's centre line, and its sides along the block's travel."""
    low, high = slide.travel(guide.point)
    ends = low - 2.0 * half, high + 2.0 * half
    if guide.offset:
        ends = min(ends[0], 0.0), max(ends[1], 0.0)
    machine_parts.centre_line(ax, np.array([guide.point + end * guide.along for end in ends]))
    machine_parts.rails(ax, guide.point + low * guide.along, guide.point + high * guide.along, guide.along, half)


def _offsets(ax: Axes, scene: Scene, drawing: Drawing, system: UnitSystem) -> None:
    """Draw the distances of guides from the crank's bearing."""
    from linksweep.plot.kit.labels import label

    for guide in (block.guide(scene.mechanism) for block in drawing.blocks if block.guide is not None):
        distance = float(np.hypot(*guide.point))
        if guide.offset and distance > 0.0:
            ax.plot(*np.array([np.zeros(2), guide.point]).T, color=GREY, linewidth=0.8, zorder=2.0, label="_offset")
            label(ax, *(0.5 * guide.point), (f"offset {system.value(distance, 'm'):.4g} {system.unit('m')}", GREY))


def draw_links(ax: Axes, drawing: Drawing, shape: Shape) -> dict[int, np.ndarray]:
    """Draw all that moves: blocks, links from pin to pin with their numbers, cylinders, the point tied to its link, the
    pins and centres of gravity on top. Return the ends of each link as drawn."""
    ends = {number: np.array([shape.pins[pin] for pin in pins]) for number, pins in drawing.bars.items()}
    half, bars = half_side(drawing, shape), list(ends.values())
    blocks = (shape.pins[block.pin] for block in drawing.blocks)
    covered = np.array([shape.point, *shape.centres.values(), *blocks])
    for block, slide in zip(drawing.blocks, shape.slides, strict=True):
        if block.on is not None:
            number = block.on[0]
            ends.setdefault(number, _slideway(ax, block, slide, shape, half))
        _block(ax, block, shape.pins[block.pin], slide, half, bars)
    start, end = ends[drawing.carrier.number][:2]
    machine_parts.tie(ax, np.array([start, shape.point, end]), behind=drawing.carrier.number not in drawing.bars)
    for number, corners in ends.items():
        if number in drawing.bars:
            machine_parts.link(ax, number, corners)
        own = np.array([*corners[:2], *(place for link, place in shape.centres.items() if link == number)])
        machine_parts.number_of_link(ax, number, corners, own, covered)
    for (barrel, rod), shortest in zip(drawing.telescopes, shape.shortest, strict=True):
        machine_parts.telescope(ax, shape.pins[barrel], shape.pins[rod], shortest)
    machine_parts.pins(ax, np.array(list(shape.lettered.values())))
    for number, place in shape.centres.items():
        if number in ends and number != drawing.carrier.number:
            machine_parts.stay(ax, place, ends[number])
    centres = np.array([*shape.centres.values()]).reshape(-1, 2)
    machine_parts.centres(ax, centres)
    if not (centres == shape.point).all(axis=1).any():
        machine_parts.point(ax, shape.point)
    return ends


def _block(ax: Axes, block: Block, centre: np.ndarray, slide: Slide, half: float, bars: list[np.ndarray]) -> None:
    """Draw a block with its number, where no bar covers that; `bars` has the pins of each."""
    (x, y) = slide.along[:, -1]
    machine_parts.block(ax, block_corners(centre, np.array([x, y]), half))
    if block.number is None:
        return
    places = centre + 0.7 * half * np.array([(x, y), (-x, -y), (-y, x), (y, -x)])
    along = np.linspace(0.0, 1.0, 50)[:, None]
    covered = np.concatenate([a + along * (b - a) for pins in bars for a, b in pairwise(pins)])
    free = np.linalg.norm(places[:, None] - covered, axis=2).min(axis=1)
    machine_parts.number_at(ax, block.number, places[np.argmax(free)])


def _slideway(ax: Axes, block: Block, slide: Slide, shape: Shape, half: float) -> np.ndarray:
    """Draw a link that carries a block, as long as the block's travel; return its ends."""
    number = block.on[0] if block.on else 0
    pivot, foot, ends = slideway(block, slide, shape, half)
    machine_parts.bar(ax, number, np.array([pivot, foot]), behind=True)
    machine_parts.bar(ax, number, ends, behind=True)
    return ends


def _names(ax: Axes, shape: Shape) -> None:
    for name, position in shape.lettered.items():
        _name(ax, position, name, fontweight="bold")


def _name(ax: Axes, position: np.ndarray, name: str, **style: Any) -> None:
    from linksweep.plot.kit.labels import label

    label(ax, *position, (name, BLACK), **style)


def _scale(ax: Axes, forces: list[np.ndarray]) -> float:
    """Return the length of a unit of force [m/N] with which the largest of forces has the longest arrow."""
    extent = max(np.ptp(ax.dataLim.intervalx), np.ptp(ax.dataLim.intervaly))
    largest = max((float(np.hypot(*vector)) for vector in forces), default=0.0)
    return float(ARROW * extent / largest) if largest > 0.0 else 0.0


def _forces(
    ax: Axes, forces: dict[str, np.ndarray], starts: dict[str, np.ndarray], scale: float, system: UnitSystem
) -> None:
    """Draw an arrow from each joint, to one scale, with its value."""
    from linksweep.plot.kit.labels import arrow, label

    sizes = [float(np.hypot(*vector)) for vector in forces.values()]
    for (name, vector), size, labelled in zip(forces.items(), sizes, signals.labelled(sizes), strict=True):
        if size > 0.0:
            tip = starts[name] + vector * scale
            arrow(ax, starts[name], tip, force_color(name))
        if size > 0.0 and labelled:
            label(ax, *tip, (f"{signals.symbol(name)} {_measure(size, 'N', system)}", force_color(name)))


def _loads(ax: Axes, drawn: list[tuple[LoadSymbol, np.ndarray]], system: UnitSystem) -> None:
    """Write the name of each load at its place, of a force or a torque with the value."""
    from linksweep.plot.kit.labels import label

    for load, place in drawn:
        label(ax, *place, (_load_text(load, system), LOAD))


def _load_text(load: LoadSymbol, system: UnitSystem) -> str:
    """Return the text of a load: "load 1: 80 N", "load 2: −12 N m", "load 3: spring"."""
    if load.torque is not None:
        return f"{load.name}: {_measure(float(load.torque), 'N m', system)}"
    if load.force is None:
        return f"{load.name}: {load.kind}"
    words = f"{load.name}: gas" if load.kind == "gas" else f"{load.name}:"
    return f"{words} {_measure(float(np.hypot(*load.force)), 'N', system)}"


def _measure(value: float, unit: str, system: UnitSystem) -> str:
    return f"{signals.number(system.value(value, unit))} {system.unit(unit)}"
