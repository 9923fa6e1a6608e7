"""Curves of a cycle over the crank angle: forces in the joints and the torque of the drive, their peaks marked.

Angles without a result are a gap in the lines, shaded, with the reason. Where forces grow without bound, beside a gap
or at a dead centre, the axis ends at a usual size.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.mechanisms.drawing import Drawing
from linksweep.plot.kit import signals
from linksweep.plot.kit.colors import (
    BLACK,
    BLUE,
    FORCE_COLORS,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SHADE,
    VERMILION,
    force_color,
)
from linksweep.plot.kit.drawings import drawing_of_results
from linksweep.plot.kit.style import axes_or_new, crank_angles, grid
from linksweep.plot.kit.with_peaks import with_peaks
from linksweep.results.compute import requested
from linksweep.results.origin.in_shown_units import units_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SOLID, DASHED, DOTTED = "-", (0.0, (5.0, 2.0)), (0.0, (1.5, 1.5))
BROKEN = {SOLID: DASHED, DASHED: DOTTED}
"""Line of a curve that would hide another of its own kind."""
WIDTH = 0.005
"""Width of a line, in sizes of its curve."""
STYLES = ((BLUE, SOLID), (VERMILION, DASHED), (GREEN, SOLID), (PURPLE, DASHED), (ORANGE, DOTTED), (BLACK, DOTTED))
ROOM = 1.0 / 30.0  # of the angle axis: what an upright word takes
ONE_LINE, COLUMNS = 4, 3  # curves whose legend stands in one line; columns of a longer one
ROW = 0.1  # of the largest force: room for a further line of the legend
LETTERS = 50  # of a legend in one line, at the usual spacing
CONSTANT = "constant"  # name of a signal's only value, in place of "max" and "min"
HEADROOM = 1.3  # of the largest value, for the legend and the labels of peaks


class Curve(NamedTuple):
    """A line of a plot over the revolution."""

    name: str
    text: str  # in the legend
    angles: np.ndarray
    values: np.ndarray
    style: dict[str, Any]
    name_at_peak: str  # at its peak


class Mark(NamedTuple):
    """A peak to be marked on a curve, its name, and whether it gets a label besides its dot."""

    peak: signals.Peak
    curve: Curve
    name_at_peak: str
    labelled: bool = True


def forces(ds: xr.Dataset, of: Iterable[str] | None = None, *, ax: Axes | None = None) -> Axes:
    """Plot the magnitudes of forces in the joints [N] over the crank angle [degree], each peak with value and angle.

    Parameters
    ----------
    ds : Dataset
        Cycle from `linksweep.sweep` with magnitudes (F32) or components (F32x, F32y), of one design; for a single force
        also of up to six designs along one dimension, a line each.
    of : iterable of str, default None
        Forces, such as ["F32", "F43"]; None for those of all pins, and of the guide, that are in the Dataset.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with a legend. Of more than eight peaks, those below half of the largest have a dot, and no value. Angles
        without a result are a gap in the lines, shaded. Where forces grow without bound, beside a gap or at a dead
        centre, the axis ends at a usual size, and peaks beyond it are marked at the upper edge as off the scale.

    Raises
    ------
    ValueError
        For forces that the Dataset does not hold, and for more designs than a plot can show.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.sweep(ls.example("press")).linksweep.forces(["F12", "F32"]).get_ylabel()
    'pin force [N]'
    """
    samples, ds = ds, with_peaks(ds)
    names = force_names(ds, of)
    by_name = {name: signals.magnitude(ds, name) for name in names}
    if len(names) > 1:
        signals.require_one_design(by_name.values())
    curves = _curves(samples, ds, by_name, signals.magnitude)
    peaks = [(peak, curve) for curve in curves for peak in signals.peaks(curve.angles, curve.values)]
    top = signals.scale([(curve.angles, curve.values) for curve in curves], [peak for peak, _ in peaks])
    ax = axes_or_new(ax)
    _draw(ax, curves)
    ax.set_ylim(0.0, headroom(len(curves)) * top or 1.0)
    units = signals.unit(by_name[names[0]], "N")
    title = f"{kind_of(drawing_of_results(ds), names)} force"
    title += f" {signals.symbol(names[0])}" if len(names) == 1 else ""
    ax.set_ylabel(f"{title} [{units}]")
    widest = shade_gaps(ax, ds, by_name[names[0]])
    crank_angles(ax, curves[0].angles)
    runaway = any(peak.value > HEADROOM * top for peak, _ in peaks)
    _legend(ax, curves, widest, runaway)
    peaks = [(peak, curve) for peak, curve in peaks if peak.value > 0.0]
    labelled = signals.labelled([peak.value for peak, _ in peaks])
    marks = [Mark(*mark, mark[1].name_at_peak, label) for mark, label in zip(peaks, labelled, strict=True)]
    _mark(ax, marks, units)
    return ax


def torque(ds: xr.Dataset, *, ax: Axes | None = None) -> Axes:
    """Plot the torque [N m] or force [N] of the drive over the crank angle [degree], largest and smallest marked.

    Parameters
    ----------
    ds : Dataset
        Cycle from `linksweep.sweep` with the drive's torque or force, of one design, or of up to six along one
        dimension, a line each.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with gaps as in `forces`. A constant is marked once, with its value.

    Raises
    ------
    ValueError
        Without the drive's torque or force in the Dataset, and for more designs than a plot can show.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.sweep(ls.example("press")).linksweep.torque().get_ylabel()
    'drive torque $T_{12}$ [N m]'
    """
    samples, ds = ds, with_peaks(ds)
    name = signals.drive_name(ds)
    units = signals.unit(ds[name], "N m")
    curves = _curves(samples, ds, {name: ds[name]}, lambda one, name: one[name])
    marks = [Mark(peak, curve, end) for curve in curves for end, peak in _extremes(curve)]
    every = [mark.peak for mark in marks]
    size = signals.scale([(curve.angles, curve.values) for curve in curves], every)
    ax = axes_or_new(ax)
    ax.axhline(0.0, color=GREY, linewidth=0.8, zorder=2.0)
    _draw(ax, curves)
    _span(ax, every, size)
    ax.set_ylabel(f"{signals.drive_kind(name)} {signals.symbol(name)}".rstrip() + f" [{units}]")
    widest = shade_gaps(ax, ds, ds[name])
    crank_angles(ax, curves[0].angles)
    if len(curves) > 1:
        _legend(ax, curves, widest, any(abs(peak.value) > size for peak in every))
    _mark(ax, marks, units)
    return ax


def force_names(ds: xr.Dataset, names: Iterable[str] | None) -> list[str]:
    if names is not None:
        chosen = list(dict.fromkeys(signals.force_named(ds, name) for name in requested("of", names)))
        if chosen:
            return chosen
    forces = drawing_of_results(ds).forces
    chosen = [name for name in forces if signals.has_pin(ds, name)]
    if not chosen:
        known = f"[..., {', '.join(map(repr, forces))}]"
        raise ValueError(f"the Dataset has no pin force: sweep with of={known}; of a MultiCylinder, sweep its engine")
    return chosen


def headroom(count: int) -> float:
    """Return the upper end of the axis relative to the largest force, with room for a legend of this many curves."""
    return HEADROOM + (0.0 if count <= ONE_LINE else ROW * ((count - 1) // COLUMNS))


def kind_of(drawing: Drawing, names: Iterable[str]) -> str:
    """Return the kind of forces in words: "pin", "guide", "pin and guide"."""
    kinds = dict.fromkeys("pin" if drawing.at_pin(name) else drawing.joint_of[name] for name in names)
    slides = [kind for kind in kinds if kind != "pin"]
    return " and ".join(dict.fromkeys("slide" if kind in slides and len(slides) > 1 else kind for kind in kinds))


def _curves(
    samples: xr.Dataset,
    ds: xr.Dataset,
    by_name: dict[str, xr.DataArray],
    signal_of: Callable[[xr.Dataset, str], xr.DataArray],
) -> list[Curve]:
    """Return the lines to draw, with their exact peaks: one for each signal of `ds`, or of one signal for each design.

    `samples` is the cycle of several designs, each of which has peaks of its own.
    """
    curves: list[Curve] = []
    joints = drawing_of_results(ds).joint_of
    for name, signal in by_name.items():
        for design, place in signals.designs(signal, units_of(ds)).items():
            one = with_peaks(samples.isel(place)) if place else ds
            color, dashes = STYLES[len(curves) % len(STYLES)]
            color = force_color(name) if len(by_name) > len(FORCE_COLORS) else color
            text = design or f"{signals.symbol(name)} ({joints.get(name, 'drive')})"
            style = {"color": color, "linestyle": dashes}
            symbol_at_peak = signals.symbol(name) if len(by_name) > 1 else ""
            angles, row = signals.revolution(one, signal_of(one, name))
            curves.append(Curve(name, text, angles, row, style, symbol_at_peak))
    return curves


def _draw(ax: Axes, curves: Sequence[Curve]) -> None:
    grid(ax)
    for k, curve in enumerate(curves):
        dashes = curve.style["linestyle"]
        seen = BROKEN.get(dashes, dashes) if any(_on_top(curve, other) for other in curves[:k]) else dashes
        ax.plot(curve.angles, curve.values, label=curve.text, **curve.style | {"linestyle": seen})


def _on_top(curve: Curve, other: Curve) -> bool:
    """Return whether a curve hides another: they differ by less than the width of a line."""
    finite = np.abs(other.values[np.isfinite(other.values)])
    if len(curve.values) != len(other.values) or not finite.size:
        return False
    near = np.isclose(curve.values, other.values, rtol=WIDTH, atol=WIDTH * np.median(finite), equal_nan=True)
    return bool(near.all())


def _span(ax: Axes, extremes: Sequence[signals.Peak], size: float) -> None:
    """Set the limits of a signed signal, with zero and room for labels."""
    values = [float(np.clip(peak.value, -size, size)) for peak in extremes]
    low, high = min([0.0, *values]), max([0.0, *values])
    room = 0.18 * ((high - low) or 1.0)
    ax.set_ylim(low - room, high + room)


def _extremes(curve: Curve) -> list[tuple[str, signals.Peak]]:
    """Return the largest and the smallest values, each with its name; of a constant, or at one angle, the value."""
    high, low = (signals.peaks(curve.angles, sign * curve.values) for sign in (1.0, -1.0))
    if high and high[0].value == -low[0].value:
        return [(CONSTANT if np.isfinite(curve.values).sum() > 1 else "", high[0])]
    return [*(("max", peak) for peak in high), *(("min", peak._replace(value=-peak.value)) for peak in low)]


def shade_gaps(ax: Axes, ds: xr.Dataset, signal: xr.DataArray) -> signals.Gap | None:
    """Shade the angles without a result, with the reason; return the widest. Several designs have gaps of their own."""
    status = ds.get("status", signal)
    if any(dim != signals.INDEX for dim in status.dims):
        return None
    gaps = signals.gaps(ds, signal)
    for gap in gaps:
        ax.axvspan(gap.start, gap.stop, facecolor=SHADE, linewidth=0.0, zorder=0.4)
    gaps.sort(key=lambda gap: gap.start - gap.stop)
    room, reasons = ROOM * np.ptp(ds[signals.INDEX].values), set()
    for gap in gaps:
        if gap.width >= room or gap.reason not in reasons:
            _reason(ax, gap, room)
        reasons.add(gap.reason)
    return gaps[0] if gaps else None


def _reason(ax: Axes, gap: signals.Gap, room: float) -> None:
    """Write the reason why there is no result in the gap, or beside it where there is no room [degree]."""
    from linksweep.plot.kit.labels import label

    width, middle = gap.width, 0.5 * (gap.start + gap.stop)
    if width < room:
        label(ax, middle, float(np.mean(ax.get_ylim())), (gap.reason, GREY))
        return
    style: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": "small", "color": GREY}
    style["rotation"] = "horizontal" if width >= 6.0 * room else "vertical"
    style["bbox"] = {"facecolor": SHADE, "linewidth": 0.0, "pad": 1.0}
    ax.text(middle, 0.5, gap.reason, transform=ax.get_xaxis_transform(), **style)


def _legend(ax: Axes, curves: Sequence[Curve], gap: signals.Gap | None, runaway: bool) -> None:
    """Draw the legend above the curves; where a curve runs through that room, in the gap beside it, or where there
    is room."""
    compact = {"fontsize": "small", "handlelength": 2.2, "columnspacing": 1.2, "handletextpad": 0.5, "frameon": False}
    texts = [curve.text for curve in curves]
    if not runaway:
        columns = (len(curves) if len(curves) <= ONE_LINE else COLUMNS) if max(map(len, texts)) < 22 else 2
        tight = {"handlelength": 1.8, "columnspacing": 0.8} if len("".join(texts)) > LETTERS else {}
        ax.legend(loc="upper center", ncols=columns, borderaxespad=0.2, **compact | tight)
    elif gap is not None and gap.width > np.ptp(ax.get_xlim()) / 4.0:
        middle = (0.5 * (gap.start + gap.stop), 0.01)
        place = {"bbox_to_anchor": middle, "bbox_transform": ax.get_xaxis_transform()}
        columns = 2 if gap.width > np.ptp(ax.get_xlim()) / 2.2 else 1
        ax.legend(loc="lower center", ncols=columns, **place, **compact)
    else:
        ax.legend(loc="best", ncols=1, **compact)


def _mark(ax: Axes, marks: Sequence[Mark], units: str) -> None:
    """Draw a dot on each peak with its value and angle; an arrowhead at the edge for one that is off the scale.

    Peaks that lie close together, as those of two pins of one link often do, share a label with a line for each.
    """
    from linksweep.plot.kit.labels import label

    limits = ax.get_ylim()
    reach = (0.05 * np.ptp(ax.get_xlim()), 0.1 * np.ptp(limits))
    groups: list[list[tuple[float, float, Mark]]] = []
    for mark in sorted(marks, key=lambda mark: -mark.peak.value):
        x, y = mark.peak.angle, float(np.clip(mark.peak.value, *limits))
        edge = "^" if mark.peak.value > y else "v"
        dot = {"color": mark.curve.style["color"], "markersize": 4.5, "clip_on": False}
        ax.plot([x], [y], edge if y != mark.peak.value else "o", label=f"_peak {mark.curve.name}", **dot)
        if not mark.labelled:
            continue
        near = (g for g in groups if abs(g[-1][0] - x) < reach[0] and abs(g[-1][1] - y) < reach[1])
        group = next(near, None)
        groups.append([(x, y, mark)]) if group is None else group.append((x, y, mark))
    for group in groups:
        x, y, first = group[0]
        heading = [] if y == first.peak.value else [("off scale:", GREY)]
        label(ax, x, y, *heading, *((_label_text(mark, units), mark.curve.style["color"]) for *_, mark in group))


def _label_text(mark: Mark, units: str) -> str:
    place = "" if mark.name_at_peak == CONSTANT else f"at {signals.angle_text(mark.peak.angle)}"
    return f"{mark.name_at_peak} {signals.number(mark.peak.value)} {units} {place}".strip()
