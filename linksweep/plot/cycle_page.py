"""Draw a cycle on a page: the machine, forces, drive, and the bearing of the pin that is loaded most."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from linksweep.plot.curves import force_names, forces, kind_of, torque
from linksweep.plot.kit import signals
from linksweep.plot.kit.drawings import drawing_of_results
from linksweep.plot.kit.style import panels
from linksweep.plot.kit.with_peaks import with_peaks
from linksweep.plot.load_diagrams import bearing
from linksweep.plot.machine import mechanism
from linksweep.plot.track import loop
from linksweep.results.origin.machine_of_results import machine_of_results

if TYPE_CHECKING:
    from matplotlib.figure import Figure

A4_WIDTH = 7.1  # inches between the margins of an A4 page


def cycle(ds: xr.Dataset) -> Figure:
    """Plot a cycle on half an A4 page: the mechanism where a pin is loaded most, forces, drive, that pin's bearing.

    Of a car in a loop, what `loop` plots.

    Parameters
    ----------
    ds : Dataset
        From `linksweep.sweep`, with pin forces and torque, of one design.

    Returns
    -------
    matplotlib Figure
        7.1 inches wide; save it with ``figure.savefig("cycle.png", dpi=200)``.

    Raises
    ------
    ValueError
        For more than one design, and when there is no result at any angle.

    Examples
    --------
    >>> import linksweep as ls
    >>> figure = ls.sweep(ls.example("press")).linksweep.cycle()
    >>> [ax.get_title(loc="left") for ax in figure.axes[1:]]
    ['Pin forces', 'Load of pin C: $F_{43}$', 'Drive torque']
    """
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    machine = machine_of_results(ds)
    if machine and machine.track:
        return loop(ds)
    samples, ds = ds, with_peaks(ds)
    pin, angle = most_loaded(ds)
    bounded = not np.isinf(signals.magnitude(ds, pin)).any()
    angle = angle if bounded else most_loaded(samples)[1]
    drawing = drawing_of_results(ds)
    layout = ConstrainedLayoutEngine(w_pad=0.08, h_pad=0.08, wspace=0.02, hspace=0.02)
    with panels(2, 2, figsize=(A4_WIDTH, 6.4), layout=layout) as (figure, grid):
        mechanism(ds, theta2=angle, ax=grid[0, 0], forces=True)
        forces(ds, ax=grid[0, 1])
        bearing(ds, pin, ax=grid[1, 0])
        torque(ds, ax=grid[1, 1])
        where = "Largest pin force, at" if bounded else "Beside infinite pin forces, at"
        where += f" $\\theta_2$ = {signals.angle_text(angle)}"
        kind = kind_of(drawing, force_names(ds, None)).capitalize()
        drive = signals.drive_kind(signals.drive_name(ds)).capitalize()
        titles = (where, f"{kind} forces", f"Load of {drawing.joint_text(pin)}: {signals.symbol(pin)}", drive)
        for panel, title in zip(grid.flat, titles, strict=True):
            panel.set_title(title, loc="left")
    return figure


def most_loaded(ds: xr.Dataset) -> tuple[str, float]:
    """Return the pin force that is largest, and the crank angle [degree] where it is."""
    peaks = {}
    for name in force_names(ds, None):
        if not drawing_of_results(ds).at_pin(name):
            continue
        largest = signals.peak(*signals.revolution(ds, signals.magnitude(ds, name)))
        if largest is None:
            raise ValueError("there is no result at any angle of the Dataset: see its status, and linksweep.check")
        peaks[name] = largest
    name = max(peaks, key=lambda force: peaks[force].value)
    return name, peaks[name].angle
