"""The figures of a report, drawn for half the width of an A4 page, and embedded in it."""

from __future__ import annotations

import io
from base64 import b64encode
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep import plot
from linksweep.analysis.balance.orders import orders
from linksweep.analysis.pins.breakdown import breakdown
from linksweep.mechanisms.drawing import Drawing
from linksweep.plot.cycle_page import most_loaded
from linksweep.plot.kit import signals
from linksweep.plot.kit.shape import part_of
from linksweep.plot.kit.style import SMALL
from linksweep.plot.machine import draw_machine
from linksweep.reports.markup import Markup, symbol, tag
from linksweep.reports.results_of_page import STEPS, Results
from linksweep.results.sweep import sweep
from linksweep.tables.cells import fixed

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LOOK: list[Any] = ["default", SMALL | {"svg.hashsalt": "linksweep"}]
"""Matplotlib's own settings, whatever the user's are, and those of this page."""
SIZE, SQUARE = (3.55, 2.45), (3.55, 3.1)  # inches
ORDERS = 6


class Picture(NamedTuple):
    """A panel: its title, its size [inches], and the function that draws it into `ax`."""

    title: str
    size: tuple[float, float]
    draw: Callable[..., Any]


def of_the_cycle(results: Results) -> Markup:
    """Return the pictures of a cycle: the machine where a pin is loaded most, pin forces, the drive, and that load's
    sources."""
    track, drawing = results.scene.mechanism.track, results.scene.mechanism.drawing
    if track and results.moves:
        return _wide(track.title, plot.loop, results)
    return pictures(_of_cycle(results, drawing)) if drawing and results.moves else Markup()


def of_bearings_and_shaking(results: Results) -> Markup:
    """Return the load diagrams of all pins, and the path and the orders of the shaking force."""
    drawing = results.scene.mechanism.drawing
    if not drawing or not results.moves:
        return Markup()
    return pictures([*_of_bearings(results, drawing), *_of_shaking(results), *_of_links(results)])


def _of_cycle(results: Results, drawing: Drawing) -> Iterator[Picture]:
    ds = results.cycle
    force, where = worst(results, drawing)
    bounded = np.isfinite(results.peaks[f"{force}_peak"])
    what = f"Largest pin force: {symbol(force)} at" if bounded else "Beside infinite pin forces:"
    title = f"{what} θ₂ = {fixed(where, 1)}°"
    yield Picture(title, SIZE, partial(draw_machine, results.scene, part_of(ds), where, forces=True))
    yield Picture("Forces in the joints", SIZE, partial(plot.forces, ds))
    kind = signals.drive_kind(signals.drive_name(ds)).capitalize()
    yield Picture(kind, SIZE, partial(plot.torque, ds))
    if not bounded:  # there, it is the nearness of the toggle that loads the pin
        return
    shares = breakdown(results.scene, force, theta2=ds[signals.INDEX].values[::STEPS])
    title = f"Where the load of {drawing.joint_text(force)} comes from: {symbol(force)}"
    yield Picture(title, SIZE, lambda ax: legend_below(plot.breakdown(shares, force, ax=ax)))


def _of_bearings(results: Results, drawing: Drawing) -> Iterator[Picture]:
    for force in drawing.pin_forces:
        title = f"Load of {drawing.joint_text(force)}: {symbol(force)}"
        yield Picture(title, SQUARE, partial(plot.bearing, results.cycle, force))


def _of_links(results: Results) -> Iterator[Picture]:
    """Yield the moment diagrams of links whose strength is computed."""
    for link in () if results.strength is None else map(str, results.strength["link"].values):
        title = f"Bending moment of the {link}"
        yield Picture(title, SIZE, lambda ax, link=link: _plain(plot.moment_diagram(results.scene, link, ax=ax)))


def _plain(ax: Axes) -> None:
    """Leave out the legend and the title on the right, which takes the place of the picture's."""
    legend = ax.get_legend()
    if legend is not None:
        legend.remove()
    ax.set_title("", loc="right")


def _of_shaking(results: Results) -> Iterator[Picture]:
    if "Fs_peak" not in results.peaks or float(results.peaks["Fs_peak"]) == 0.0:
        return
    cycle = results.cycle.isel({signals.INDEX: slice(STEPS * int(results.inertia_period))})
    yield from of_shaking(cycle, results.whole)


def of_shaking(ds: xr.Dataset, whole: bool = True) -> Iterator[Picture]:
    """Yield the path of the shaking force and, of a whole revolution, its orders."""
    yield Picture("Shaking force", SQUARE, partial(plot.hodograph, ds))
    if whole:
        harmonics = orders(ds, ["Fsx", "Fsy"], n=ORDERS)
        yield Picture("Orders of the shaking force", SQUARE, partial(plot.orders, harmonics))


def worst(results: Results, drawing: Drawing) -> tuple[str, float]:
    """Return the largest pin force and its crank angle [degree], the exact one where that has a position to draw."""
    peaks = results.peaks
    force = max(drawing.pin_forces, key=lambda name: float(peaks[f"{name}_peak"]))
    at = float(peaks[f"{force}_peak_at"])
    if np.isfinite(peaks[f"{force}_peak"]) and not sweep(results.scene, [at], of=["status"])["status"].any():
        return force, at
    return most_loaded(results.cycle)


def legend_below(ax: Axes) -> None:
    """Move the legend below the axes, where it hides nothing, in the most columns that the figure has room for."""
    legend, entries, figure = ax.get_legend(), ax.get_legend_handles_labels(), ax.figure
    for columns in (3, 2, 1):
        if legend is not None:
            legend.remove()
        legend = figure.legend(*entries, loc="outside lower center", ncols=columns, fontsize="small", frameon=False)
        if legend.get_window_extent().width <= figure.bbox.width:
            return


def pictures(panels: Iterable[Picture]) -> Markup:
    from matplotlib import style

    with style.context(LOOK):
        return tag("div", *(_drawn(picture) for picture in panels), class_="figures")


def _drawn(picture: Picture) -> Markup:
    from matplotlib.figure import Figure

    figure = Figure(figsize=picture.size, layout="constrained")
    ax = figure.add_subplot()
    picture.draw(ax=ax)
    ax.set_title(picture.title, loc="left")
    return _image(figure, picture.title)


def _wide(title: str, draw: Callable[[Any], Figure], results: Results) -> Markup:
    """Return a figure with panels of its own."""
    import matplotlib.pyplot as plt
    from matplotlib import style

    with style.context(LOOK):
        figure = draw(results.cycle)
        made = _image(figure, title)
        plt.close(figure)
    return tag("div", made, class_="wide")


def _image(figure: Figure, title: str) -> Markup:
    """Return a figure as SVG within the page, byte for byte equal for equal results."""
    drawn = io.BytesIO()
    figure.savefig(drawn, format="svg", metadata={"Date": None, "Creator": None})
    data = b64encode(drawn.getvalue()).decode("ascii")
    return tag("img", src=f"data:image/svg+xml;base64,{data}", alt=title)
