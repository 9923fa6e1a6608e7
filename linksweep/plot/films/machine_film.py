"""The film of one machine: its links, or its car, above the curves of its forces."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from linksweep.mechanisms.drawing import Drawing, Track
from linksweep.plot import track as track_plot
from linksweep.plot.curves import forces, headroom, torque
from linksweep.plot.films.frames import (
    TINY,
    Scale,
    draw_frame,
    draw_scale,
    fit,
    follower,
    frames_of,
    panels,
    readings,
    renewed,
    way,
)
from linksweep.plot.kit import signals
from linksweep.plot.kit.shape import part_of
from linksweep.plot.kit.style import show_lengths
from linksweep.plot.machine import ARROW, draw_ground
from linksweep.results.origin.in_shown_units import results_in_shown_units
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import shown_units

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from linksweep.plot.kit.film import Film


EFFORT = 0.7  # of the height of the forces' curves: the drive's


def film_of_crank(scene: Scene, drawing: Drawing, angles: Any, frames: int, point: Any, title: str) -> Film:
    """Return the film of a machine with a crank."""
    from linksweep.plot.kit.film import Film

    drive = scene.mechanism.drives[scene.drive]
    outputs = [*(f"{force}{axis}" for force in drawing.forces for axis in "xy"), drive]
    cycle = sweep(scene, angles, of=[*outputs, "omega2"])
    signals.require_one_design(cycle[name] for name in outputs)
    shots = frames_of(scene, drawing, way(cycle, cycle["omega2"], frames), point, part_of(cycle))
    system, at = shown_units(scene.units), [shot.angle for shot in shots]
    efforts = signals.spread(results_in_shown_units(sweep(scene, at, of=[drive]))[drive], len(shots))
    figure, machine, (curves, effort) = panels(1.0, EFFORT)
    forces(cycle, ax=curves)
    torque(cycle, ax=effort)
    curves.set_xlabel("")
    top = curves.get_ylim()[1] / headroom(len(drawing.forces)) * system.size("N")
    draw_ground(machine, scene, drawing, shots[0].shape)
    longest = ARROW * max(np.ptp(machine.dataLim.intervalx), np.ptp(machine.dataLim.intervaly))
    scale = Scale(top, longest)
    fit(machine, drawing, shots, scale, system)
    draw_scale(machine, scale, system)
    say = readings(machine, "$\\theta_2$ =", {name: signals.symbol(name) for name in drawing.forces})
    follow, follow_drive = follower(curves, list(drawing.forces)), follower(effort, [drive])
    moving: list[Artist] = []

    def draw(k: int) -> list[Artist]:
        shot, sizes = shots[k], {name: float(np.hypot(*force)) for name, force in shots[k].forces.items()}
        renewed(machine, moving, partial(draw_frame, machine, drawing, shot, scale))
        sizes = {name: system.value(size if size > TINY * top else 0.0, "N") for name, size in sizes.items()}
        texts = {name: f"{signals.number(size)} {system.unit('N')}" for name, size in sizes.items()}
        marks = [*follow(shot.angle, sizes), *follow_drive(shot.angle, {drive: efforts[k]})]
        return [*moving, *say(shot.angle, texts), *marks]

    return Film(figure, draw, len(shots), title)


def film_of_track(scene: Scene, track: Track, angles: Any, frames: int, title: str) -> Film:
    """Return the film of a car on a track."""
    from linksweep.plot.kit.film import Film

    names, index = [track.force, track.speed], {scene.mechanism.index: signals.INDEX}
    system = shown_units(scene.units)
    cycle = results_in_shown_units(sweep(scene, angles, of=names)).rename(index)
    signals.require_one_design(cycle[name] for name in names)
    at = way(cycle, cycle[track.speed], frames, to_and_fro=False)
    shots = results_in_shown_units(sweep(scene, at, of=names)).rename(index)
    force, speed = (np.broadcast_to(shots[name].values, len(at)) for name in names)
    figure, ax, (curve,) = panels(1.0)
    radius, largest = float(getattr(scene.mechanism, track.radius)), float(np.nanmax(cycle[track.force].values))
    track_plot.draw_track(ax, cycle, track.force, radius)
    show_lengths(ax, system)
    track_plot.draw_force(curve, cycle, scene)
    write = readings(ax, "$\\theta$ =", {track.force: "$F_N$", track.speed: "speed"})
    follow = follower(curve, [track.force])
    moving: list[Artist] = []

    def draw(k: int) -> list[Artist]:
        renewed(ax, moving, partial(_car, ax, at[k], radius, force[k] / largest))
        now = {track.force: (force[k], system.unit("N")), track.speed: (speed[k], system.unit("m/s"))}
        values = {name: f"{signals.number(value)} {unit}" for name, (value, unit) in now.items()}
        return [*moving, *write(at[k], values), *follow(at[k], {track.force: force[k]})]

    return Film(figure, draw, len(at), title)


def _car(ax: Axes, angle: float, radius: float, share: float) -> None:
    track_plot.draw_car(ax, radius, angle)
    track_plot.press(ax, angle, radius * (1.0 + track_plot.BAND * share), radius, linewidth=1.6, mutation_scale=11.0)
