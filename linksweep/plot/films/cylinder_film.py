"""The film of an engine of several cylinders: throws side by side, banks about one crank, forces as arrows at the pins.

Each cylinder is drawn as a slider-crank whose guide is turned by its bank, as it is seen along the crankshaft.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from linksweep.base.validate import refuse
from linksweep.plot.films import frames as film_frames
from linksweep.plot.kit import signals
from linksweep.plot.kit.drawings import drawing_of
from linksweep.plot.machine import ARROW, draw_ground
from linksweep.results.cylinders.multi_cylinder import MultiCylinder
from linksweep.results.origin.in_shown_units import in_shown_units
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import shown_units

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from linksweep.mechanisms.drawing import Drawing
    from linksweep.plot.kit.film import Film

WIDTH = 2.0  # inches of a throw's panel


def film_of_cylinders(machine: MultiCylinder, frames: int, title: str) -> Film:
    """Return a film over the engine's cycle: every cylinder with the forces in its pins, and the torque of them all."""
    from linksweep.plot.kit.film import Film

    system = shown_units(machine.engine.units)
    cycle = in_shown_units(machine.sweep(film_frames.SAMPLES, of=["T12"]), system)
    signals.require_one_design([cycle["T12"]])
    angles = np.arange(frames) * (machine.period / frames)
    drawing = drawing_of(machine.engine.mechanism)
    shots = [_frames(machine, k, drawing, angles) for k in range(len(machine.throws))]
    refuse([] if all(len(own) == frames for own in shots) else [film_frames.NOTHING])
    figure, panels, curve = _panels(machine)
    top = max(float(np.hypot(*force)) for own in shots for shot in own for force in shot.forces.values())
    for k, ax in enumerate(panels):
        draw_ground(ax, _turned(machine, k), drawing, shots[k][0].shape)
    scale = film_frames.Scale(top, ARROW * max(np.ptp(ax.dataLim.intervaly) for ax in panels))
    for ax in dict.fromkeys(panels):
        there = [k for k, other in enumerate(panels) if other is ax]
        every: list[film_frames.Frame] = [shot for k in there for shot in shots[k]]
        film_frames.fit(ax, drawing, every, scale, system)
        ax.set_title(", ".join(str(k + 1) for k in there), loc="right", fontsize="small")
        if not ax.get_subplotspec().is_first_col():  # type: ignore[union-attr]
            ax.tick_params(labelleft=False)
            ax.set_ylabel("")
    film_frames.draw_scale(panels[0], scale, system)
    curve.plot(cycle["theta2"], cycle["T12"])
    unit = system.unit("N m")
    curve.set(xlabel="crank angle $\\theta_2$ [°]", ylabel=f"torque $T_{{12}}$ [{unit}]", xlim=(0.0, machine.period))
    torque = np.interp(angles, cycle["theta2"], cycle["T12"], period=machine.period)
    write = film_frames.readings(curve, "$\\theta_2$ =", {"T12": signals.symbol("T12")})
    follow = film_frames.follower(curve, ["T12"])
    moving: list[list[Artist]] = [[] for _ in panels]

    def draw(k: int) -> list[Artist]:
        for ax, own, there in zip(panels, shots, moving, strict=True):
            film_frames.renewed(ax, there, partial(film_frames.draw_frame, ax, drawing, own[k], scale))
        now = float(torque[k])
        texts = write(float(angles[k]), {"T12": f"{signals.number(now)} {unit}"})
        return [*(artist for there in moving for artist in there), *texts, *follow(float(angles[k]), {"T12": now})]

    return Film(figure, draw, frames, title)


def _frames(machine: MultiCylinder, k: int, drawing: Drawing, angles: np.ndarray) -> list[film_frames.Frame]:
    """Return the frames of a cylinder at those crank angles of the engine that have a result, in the ground's axes."""
    throw = machine.throws[k]
    own = film_frames.frames_of(machine.cylinders[k], drawing, np.mod(angles + throw.ahead, machine.period), None)
    cos, sin = throw.bank
    return [frame.turned(np.array([(cos, -sin), (sin, cos)])) for frame in own]


def _turned(machine: MultiCylinder, k: int) -> Scene:
    """Return a scene whose guide is that of a cylinder, in axes of the ground; its loads are not."""
    mechanism: Any = machine.engine.mechanism
    turned = replace(mechanism, slide_angle=mechanism.slide_angle + machine.bank_angles[k])
    return replace(machine.engine, mechanism=turned)


def _panels(machine: MultiCylinder) -> tuple[Figure, list[Axes], Axes]:
    """Return a figure, the axes of each cylinder, which those on one throw share, and those of the torque."""
    from matplotlib.figure import Figure

    places = sorted({*machine.throw_positions})
    width, height = film_frames.SIZE
    figure = Figure((max(width, WIDTH * len(places)), height), film_frames.DPI, layout="constrained")
    grid = figure.add_gridspec(2, len(places), height_ratios=(2.0, 1.0))
    throws = {z: figure.add_subplot(grid[0, k]) for k, z in enumerate(places)}
    return figure, [throws[z] for z in machine.throw_positions], figure.add_subplot(grid[1, :])
