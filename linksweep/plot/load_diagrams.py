"""The bearing load diagram: the locus that a pin's force draws over a revolution."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from linksweep.analysis.pins.bearings import FRAMES
from linksweep.base.validate import choice_problems, refuse
from linksweep.files.netcdf import scene_of
from linksweep.mechanisms.drawing import Drawing, Frame
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import force_color
from linksweep.plot.kit.drawings import drawing_of_results
from linksweep.plot.kit.locus import BEYOND, SIZE, draw_cross, draw_locus, set_limits
from linksweep.plot.kit.shape import angle_of
from linksweep.plot.kit.style import axes_or_new, panels
from linksweep.plot.kit.with_peaks import with_peaks
from linksweep.results.sweep import sweep

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def bearing(ds: xr.Dataset, of: str = "F32", *, frame: str = "ground", ax: Axes | None = None) -> Axes:
    """Plot the bearing load diagram of a pin: the force's components [N] against each other over a revolution.

    Parameters
    ----------
    ds : Dataset
        Cycle from `linksweep.sweep` with the components of the force (F32x, F32y), of one design.
    of : str, default "F32"
        Force Fij, of link i on link j, or the pin in which it acts, "B".
    frame : {"ground", "journal", "bearing", "link"}, default "ground"
        Axes of the components: of the ground, or of the link that has the journal or the bearing, that turn with it (x
        along its line of pins, of a slider along its guide); "link" is link j. `linksweep.bearings` states which link
        has the journal; where links slide on each other, j counts as it.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with equal scales; dots on the locus every 30 degrees of the crank, of many turns fewer, an arrow from
        the origin to the peak.

    Raises
    ------
    ValueError
        For what is no name of a force in the Dataset, for an unknown frame, and for more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.sweep(ls.example("press")).linksweep.bearing("F32", frame="link").get_xlabel()
    '$F_{32}$ along the crank, A→B [N]'
    """
    refuse(choice_problems("frame", frame, (*FRAMES, "link")))
    of = signals.force_named(ds, of)
    ds = with_peaks(ds)
    angles, x, y = _locus(ds, of, frame)
    drawing = drawing_of_results(ds)
    link = drawing.link_of(of, frame)
    ax, units = axes_or_new(ax, figsize=SIZE), signals.unit(signals.components(ds, of)[0], "N")
    magnitude = signals.magnitude(ds, of)
    size, nothing = signals.revolution(ds, magnitude)[1], signals.reasons(ds, magnitude)
    draw_locus(ax, of, angles, x, y, units, size=size, nothing=nothing)
    ax.set(xlabel=f"{_axis(drawing, of, link, 'x')} [{units}]", ylabel=f"{_axis(drawing, of, link, 'y')} [{units}]")
    return ax


def bearings(ds: xr.Dataset, *, frame: str = "ground") -> Figure:
    """Plot the bearing load diagrams of all pins in one figure, each like `bearing` in a panel of its own.

    Parameters
    ----------
    ds : Dataset
        Cycle from `linksweep.sweep` with the components of the pin forces, of one design.
    frame : {"ground", "journal", "bearing"}, default "ground"
        Axes of the components, as `bearing` takes them.

    Returns
    -------
    matplotlib Figure
        Figure 7.1 inches wide, two panels in a row; scales differ from pin to pin. With three pins, a fourth panel has
        all to one scale.

    Raises
    ------
    ValueError
        For an unknown frame, for more than one design, and without any pin's components in the Dataset.

    Examples
    --------
    >>> import linksweep as ls
    >>> figure = ls.sweep(ls.example("press")).linksweep.bearings(frame="journal")
    >>> [ax.get_title(loc="left") for ax in figure.axes][0]
    'Load of pin A: $F_{12}$'
    """
    refuse(choice_problems("frame", frame, FRAMES))
    drawing, ds = drawing_of_results(ds), with_peaks(ds)
    forces = [force for force in drawing.pin_forces if signals.has_pin(ds, force)]
    refuse([] if forces else ["ds has no pin force: give what ls.sweep returns, with components such as F32x and F32y"])
    rows = (len(forces) + 1) // 2
    with panels(rows, 2, figsize=(7.1, 3.4 * rows), squeeze=False) as (figure, grid):
        for force, panel in zip(forces, grid.flat, strict=False):
            bearing(ds, force, frame=frame, ax=panel)
            panel.set_title(f"Load of {drawing.joint_text(force)}: {signals.symbol(force)}", loc="left")
        if len(forces) % 2:
            _to_one_scale(grid[-1, -1], ds, {force: _locus(ds, force, frame) for force in forces})
    return figure


def _to_one_scale(ax: Axes, ds: xr.Dataset, loci: dict[str, tuple[np.ndarray, ...]]) -> None:
    """Draw the loci of all pins to one scale."""
    sizes = {force: np.hypot(x, y) for force, (_, x, y) in loci.items()}
    units = signals.unit(signals.components(ds, next(iter(loci)))[0], "N")
    rows = [(loci[force][0], size) for force, size in sizes.items()]
    usual = signals.scale(rows, [signals.peak(*row) for row in rows])
    draw_cross(ax)
    for force, (_, x, y) in loci.items():
        text = f"{signals.symbol(force)} ({drawing_of_results(ds).joint_text(force)})"
        ax.plot(x, y, color=force_color(force), label=text)
    points = np.concatenate([[x, y] for _, x, y in loci.values()], axis=1)
    set_limits(ax, *points[:, np.hypot(*points) <= BEYOND * usual])
    ax.set_title(f"All to one scale [{units}]", loc="left")
    ax.legend(fontsize="small", frameon=False)


def _locus(ds: xr.Dataset, pin: str, frame: str) -> tuple[np.ndarray, ...]:
    """Return crank angles [degree] and the components of a force in the axes of a frame."""
    angles, x, y = signals.revolution(ds, *signals.components(ds, pin))
    drawing = drawing_of_results(ds)
    link = drawing.link_of(pin, frame)
    if link != 1:
        refuse([] if link in drawing.frames else [f"frame = {frame!r}: link {link} has no axes; take the ground's"])
        x, y = _in_axes(ds, drawing.frames[link], x, y)
    return angles, x, y


def _in_axes(ds: xr.Dataset, frame: Frame, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the components of a force in the axes of a frame."""
    scene, name = scene_of(ds, whole=False), frame.angle
    if name not in ds and name in scene.table.quantity:
        ds = ds.assign({str(name): sweep(scene, ds[signals.INDEX].values, of=[str(name)])[name]})
    angles = xr.DataArray(angle_of(scene, ds, frame), dims=signals.INDEX)
    angle = np.radians(signals.revolution(ds, angles)[1])
    cos, sin = np.cos(angle), np.sin(angle)
    return cos * x + sin * y, cos * y - sin * x


def _axis(drawing: Drawing, pin: str, link: int, axis: str) -> str:
    force = signals.symbol(pin)
    if link == 1:
        return f"{force[:-2]}{axis}}}$, ground axes"
    frame = drawing.frames[link]
    return f"{force} along the {frame.along}" if axis == "x" else f"{force} across the {frame.across}"
