"""Plots of links as beams: the bending moment along each at its worst crank angle, within its envelope of the cycle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from linksweep.analysis.strength.strength import beams_of
from linksweep.base.validate import refuse
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import BLACK, BLUE, GREY, SKY
from linksweep.plot.kit.style import axes_or_new, grid, legend_above, panels
from linksweep.results.compute import require_scene
from linksweep.results.peaks import peaks
from linksweep.results.sweep import sweep
from linksweep.scene.at_sections import COUNT, marks, places
from linksweep.scene.designs.choose import design_labels
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import shown_units

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FINE = 41
"""Sections between the neighbours of the worst one: they miss its moment by a millionth at most."""


def moment_diagram(scene: Scene, link: str, *, ax: Axes | None = None) -> Axes:
    """Plot the bending moment along a link at its worst crank angle, and its envelope over the cycle.

    Parameters
    ----------
    scene : Scene
        Scene of one design.
    link : str
        Role of a link that is a beam.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with the link as a thick line, its pins as circles, and the moment over the distance from its first pin, in
        N m over mm unless other units were chosen. The envelope is the exact largest and least moment of each section;
        the largest of all is marked.

    Raises
    ------
    ValueError
        If the link is no beam, or the scene has several designs.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.plot.moment_diagram(ls.example("press"), "coupler").get_ylabel()
    'bending moment [N m]'
    """
    require_scene(scene)
    several = ", ".join(design_labels(scene))
    refuse([f"scene: has several designs, over {several}; give one, as of ls.scene_at"] if several else [])
    (role,) = beams_of(scene, [link])
    system = shown_units(scene.units)
    unit, size = (system.unit("m"), system.size("m")) if system.chosen else ("mm", 1e-3)
    name = f"bending_moment{2 + scene.mechanism.roles.index(role)}"
    coarse = _at_sections(scene, role)
    along = _at_sections(scene, role, _beside(coarse, _worst_moments(coarse, name).section))
    start, stop = (end / size for end in _ends(scene, role))
    x = start + (stop - start) * along.section.values
    worst = _worst_moments(along, name)
    moment, top, low = (system.value(each, "N m") for each in (worst.moment, worst.largest, worst.least))
    ax = grid(axes_or_new(ax))
    ax.fill_between(x, moment, color=SKY, alpha=0.5, linewidth=0.0)
    ax.plot(x, moment, color=BLUE, label=f"at $\\theta_2$ = {worst.angle:.1f}°")
    ax.plot(x, top, color=GREY, linestyle="--", linewidth=1.0, label="envelope of the cycle")
    ax.plot(x, low, color=GREY, linestyle="--", linewidth=1.0)
    ax.plot([start, stop], [0.0, 0.0], color=BLACK, linewidth=2.5, solid_capstyle="round")
    pins = np.array([0.0, float(scene.mechanism.parts[role].length), *scene.mechanism.third_pins_along(role)]) / size
    ax.plot(pins, np.zeros_like(pins), "o", color=BLACK, markerfacecolor="white", markersize=6.0)
    torque = system.unit("N m")
    ax.plot(x[worst.section], moment[worst.section], "o", color=BLUE, markersize=4.5, label="_worst")
    ax.set_title(f"{role}: {signals.number(moment[worst.section])} {torque}", loc="right")
    ax.set(xlabel=f"distance from the first pin [{unit}]", ylabel=f"bending moment [{torque}]")
    ax.margins(y=0.15)
    legend_above(ax, ncols=2)
    return ax


class WorstMoments(NamedTuple):
    """Bending moments of sections [N m] at the worst crank angle [degree], and their extremes over the cycle; `section`
    is the number of the section that bears the largest."""

    section: int
    angle: float
    moment: np.ndarray
    largest: np.ndarray
    least: np.ndarray


def _worst_moments(along: Scene, name: str) -> WorstMoments:
    """Return the moments of this name at the sections of a scene."""
    worst = peaks(along, of=[name])
    top, low = (worst[f"{name}_{end}"].broadcast_like(along.section).values for end in ("max", "min"))
    high = float(np.nanmax(top, initial=-np.inf)) >= -float(np.nanmin(low, initial=np.inf))
    end, values = ("max", top) if high else ("min", low)
    k = int(np.nanargmax(np.abs(values)))
    at = float(worst[f"{name}_{end}_at"].broadcast_like(along.section).values[k])
    moments = sweep(along, [at], of=[name])[name].isel(theta2=0, missing_dims="ignore")
    moment = moments.broadcast_like(along.section).values
    return WorstMoments(k, at, moment, top, low)


def moment_diagrams(scene: Scene) -> Figure:
    """Plot the moment diagrams of all links that are beams.

    Parameters
    ----------
    scene : Scene
        Scene of one design.

    Returns
    -------
    matplotlib Figure
        A panel for each link, as `moment_diagram` draws it.

    Raises
    ------
    ValueError
        If no link is a beam, or the scene has several designs.

    Examples
    --------
    >>> import linksweep as ls
    >>> len(ls.plot.moment_diagrams(ls.example("press")).axes)
    3
    """
    require_scene(scene)
    roles = beams_of(scene, None)
    with panels(len(roles), 1, figsize=(7.1, 2.3 * len(roles)), squeeze=False) as (figure, rows):
        for role, ax in zip(roles, rows.flat, strict=True):
            moment_diagram(scene, role, ax=ax)
    return figure


def _at_sections(scene: Scene, role: str, more: Sequence[float] = ()) -> Scene:
    """Return the scene with sections along a link, on either side of each force on it, and at `more` places."""
    at_forces = [float(share) for share in marks(scene, role)]
    return replace(scene, section=places(np.unique([*np.linspace(0.0, 1.0, COUNT), *at_forces, *more])))


def _beside(along: Scene, section: int) -> Sequence[float]:
    """Return places between the neighbours of a section: the moment bends between two of them."""
    shares = along.section.values
    ends = shares[max(section - 1, 0)], shares[min(section + 1, len(shares) - 1)]
    return np.linspace(*ends, FINE).tolist()


def _ends(scene: Scene, role: str) -> tuple[float, float]:
    numbers = scene.mechanism.beam_numbers()
    return float(numbers[f"{role}_beam_start"]), float(numbers[f"{role}_beam_end"])
