"""Before and after balancing: shaking force and moment, torque, and the pin that was loaded most."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import xarray as xr

from linksweep.base.validate import count_problems, refuse
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import BLUE, VERMILION
from linksweep.plot.kit.drawings import joints_of
from linksweep.plot.kit.locus import draw_cross
from linksweep.plot.kit.style import crank_angles, grid, panels
from linksweep.plot.kit.with_peaks import marked_peaks, with_peaks
from linksweep.results.compute import require_scene
from linksweep.results.origin.in_shown_units import in_shown_units
from linksweep.results.sweep import sweep
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import shown_units
from linksweep.tables.of_balance import BALANCED, zero_of_rounding

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STYLES: dict[str, dict[str, Any]] = {
    "before": {"color": BLUE, "linewidth": 3.0, "alpha": 0.45},  # broad: seen where the other lies on it
    "after": {"color": VERMILION},
}
SHAKING = ("Fs", "Ms")


def balance(before: Scene, after: Scene, *, theta2: int = 720) -> Figure:
    """Plot two scenes on one page, as before and after balancing.

    Parameters
    ----------
    before : Scene
        Scene of one design.
    after : Scene
        Scene of one design of the same kind of mechanism.
    theta2 : int, default 720
        Count of crank angles over the cycle.

    Returns
    -------
    matplotlib Figure
        Four panels: the shaking force's hodograph, shaking moment about A, the drive's torque, and the force in the pin
        that was loaded most before.

    Raises
    ------
    ValueError
        For a mechanism without pins, a theta2 that is no count, and for more than one design.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> figure = ls.plot.balance(scene, ls.with_counterweights(scene, ls.counterweights(scene, radius=0.06)))
    >>> [ax.get_title(loc="left") for ax in figure.axes]
    ['Shaking force', 'Shaking moment about A', 'Drive torque', 'Load of pin C']
    """
    require_scene(before)
    require_scene(after)
    refuse(count_problems("theta2", theta2))
    drawing = joints_of(before.mechanism)
    drive = before.mechanism.drives[before.drive]
    pins = drawing.pin_forces
    scenes = {"before": before, "after": after}
    cycles = {name: _cycle(scene, theta2, ["Fsx", "Fsy", "Ms", drive, *pins]) for name, scene in scenes.items()}
    largest = {name: _largest(scene, [*SHAKING, drive, *pins]) for name, scene in scenes.items()}
    for name, size in largest["before"].items():
        largest["after"][name] = zero_of_rounding(largest["after"][name], BALANCED * size)
    unit = {name: str(item.attrs.get("units", "")) for name, item in cycles["before"].items()}
    worst = max(pins, key=lambda pin: largest["before"][pin])
    with panels(2, 2, figsize=(7.1, 6.0)) as (figure, ((above, beside), (below, last))):
        _hodograph(above, cycles, largest)
        _over_angle(beside, cycles, largest, "Ms", "Shaking moment about A", f"$M_s$ [{unit['Ms']}]")
        kind = signals.drive_kind(drive).capitalize()
        _over_angle(below, cycles, largest, drive, kind, f"{signals.symbol(drive)} [{unit[drive]}]".strip())
        title = f"Load of {drawing.joint_text(worst)}"
        _over_angle(last, cycles, largest, worst, title, f"{signals.symbol(worst)} [{unit[worst]}]")
    return figure


def _cycle(scene: Scene, theta2: int, names: list[str]) -> xr.Dataset:
    return with_peaks(sweep(scene, theta2, of=names), *SHAKING)


def _largest(scene: Scene, names: list[str]) -> dict[str, float]:
    """Return the exact largest magnitude of each quantity in the cycle, in the unit in which it is shown."""
    worst = in_shown_units(marked_peaks(scene, SHAKING, None), shown_units(scene.units))
    return {name: float(worst[f"{name}_peak"]) for name in names}


def _hodograph(ax: Axes, cycles: dict[str, xr.Dataset], largest: dict[str, dict[str, float]]) -> None:
    """Draw the shaking force's components against each other."""
    draw_cross(ax)
    for name, cycle in cycles.items():
        _, x, y = signals.revolution(cycle, cycle["Fsx"], cycle["Fsy"])
        ax.plot(x, y, label=_legend_text(name, largest[name]["Fs"]), **STYLES[name])
    unit = signals.unit(cycle["Fsx"], "N")
    ax.set(xlabel=f"$F_{{sx}}$ [{unit}]", ylabel=f"$F_{{sy}}$ [{unit}]")
    ax.set_title("Shaking force", loc="left")
    _legend(ax)


def _over_angle(
    ax: Axes, cycles: dict[str, xr.Dataset], largest: dict[str, dict[str, float]], name: str, title: str, label: str
) -> None:
    grid(ax)
    for when, cycle in cycles.items():
        angles, values = signals.revolution(cycle, cycle[name])
        ax.plot(angles, values, label=_legend_text(when, largest[when][name]), **STYLES[when])
    crank_angles(ax, angles)
    ax.set_ylabel(label)
    ax.set_title(title, loc="left")
    _legend(ax)


def _legend_text(when: str, largest: float) -> str:
    """Return the legend of a curve, with its largest value."""
    return f"{when}, up to {signals.number(largest)}"


def _legend(ax: Axes) -> None:
    """Draw the legend above the curves, in room made for it."""
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + 0.16 * (high - low), auto=True)
    style: dict[str, Any] = {"facecolor": "white", "edgecolor": "none", "handlelength": 1.8, "columnspacing": 1.0}
    ax.legend(loc="upper center", ncols=2, fontsize="small", **style)
