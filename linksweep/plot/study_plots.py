"""Plots of a study's designs: two results against each other with the Pareto front, and parallel coordinates.

Of very many designs some are drawn, chosen at random, equal for each call; the legend states how many. The front and
the best, which are marked, are those of all designs.
"""

from __future__ import annotations

from collections.abc import Iterable
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from linksweep.analysis.design.pareto import variable_problems
from linksweep.base.validate import count_problems, flag_problems, refuse
from linksweep.plot.kit import scales
from linksweep.plot.kit.colors import BLACK, BLUE, VERMILION
from linksweep.plot.kit.designs import Column, Designs, by_chance, designs_of, in_words, whole
from linksweep.plot.kit.style import axes_or_new, grid, legend_above
from linksweep.results.compute import requested, require_dataset
from linksweep.results.front import front as front_of
from linksweep.results.front import stated_objective
from linksweep.results.origin.in_shown_units import in_shown_units
from linksweep.results.origin.machine_of_results import name_in_results

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DOTS = 20_000  # of a scatter: more are one blot
LINES = 1500  # of parallel coordinates
MOST_AXES = 12
ROOM = 0.04  # of an axis, beyond its scale


def scatter(
    ds: xr.Dataset,
    *,
    x: str,
    y: str,
    color: str | None = None,
    maximize: Iterable[str] = (),
    front: bool = True,
    ax: Axes | None = None,
) -> Axes:
    """Plot two results, or parameters, of every design against each other, with the Pareto front of the two.

    Parameters
    ----------
    ds : Dataset
        Results over designs, as from `linksweep.peaks`.
    x : str
        Name for the horizontal axis, such as "F32_peak" or "coupler.length".
    y : str
        Name for the vertical axis.
    color : str, default None
        Name of a third one, drawn by colour; None for one colour.
    maximize : iterable of str, default ()
        Those of x and y of which more is better; of the others less is.
    front : bool, default True
        True for the front: designs that no other beats in both, as `linksweep.pareto` selects them. A design as good as
        any of them lies on or beyond the steps.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with the designs that are ok, be it over part of a revolution; of more than 20 000, so many at random. A
        few designs far from the others are off the scale.

    Raises
    ------
    ValueError
        For unknown names, a `front` that is no truth value, and where no design is ok.

    Examples
    --------
    >>> import linksweep as ls
    >>> made = ls.sample(ls.example("press"), {"coupler.length": (0.2, 0.24), "rocker.length": (0.16, 0.2)}, n=64)
    >>> ax = ls.plot.scatter(ls.peaks(made, of=["F32", "T12"], theta2=360), x="F32_peak", y="T12_peak")
    >>> ax.get_xlabel(), ax.get_ylabel()
    ('$F_{32}$ peak [N]', '$T_{12}$ peak [N m]')
    """
    require_dataset(ds, "ls.peaks of several designs")
    x, y, color = (name_in_results(ds, name) for name in (x, y, color))
    better = [name_in_results(ds, name) for name in requested("maximize", maximize)]
    names = {"x": x, "y": y} | ({} if color is None else {"color": color})
    problems = [problem for path, name in names.items() for problem in variable_problems(ds, path, name)]
    problems += flag_problems("front", front)
    refuse(problems + [f"maximize: {name} is neither x nor y" for name in better if name not in (x, y)])
    designs = designs_of(in_shown_units(ds), names.values())
    best = _front(designs, (x, y), better) if front else np.array([], dtype=int)
    drawn = by_chance(designs.number, DOTS, best)
    across, up = designs.columns[x], designs.columns[y]
    ax = grid(axes_or_new(ax))
    _dots(ax, across.values[drawn], up.values[drawn], designs, drawn, color)
    if front:
        steps: dict[str, Any] = {"drawstyle": "steps-post", "linewidth": 1.2, "marker": "o", "markersize": 3.5}
        text = f"Pareto front: {whole(len(best))} design{'s' * (len(best) > 1)}"
        ax.plot(across.values[best], up.values[best], label=text, color=VERMILION, zorder=2.5, **steps)
    _scale(ax, "x", across, best)
    _scale(ax, "y", up, best)
    legend_above(ax).legend_handles[0].set_sizes([20.0])
    return ax


def _dots(ax: Axes, x: np.ndarray, y: np.ndarray, designs: Designs, drawn: np.ndarray, color: str | None) -> None:
    size = float(np.clip(400.0 / np.sqrt(len(drawn)), 2.0, 20.0))
    dots: dict[str, Any] = {"s": size, "linewidths": 0.0, "rasterized": True, "label": designs.counted(len(drawn))}
    if color is None:
        ax.scatter(x, y, color=BLUE, alpha=0.6, **dots)
        return
    third = designs.columns[color]
    limits = scales.span(third.values)
    cloud = ax.scatter(x, y, c=third.values[drawn], norm=scales.norm(limits), cmap="viridis", **dots)
    scales.color_bar(ax, cloud, third, limits)


def _front(designs: Designs, names: tuple[str, str], better: list[str]) -> np.ndarray:
    """Return the positions of the designs on the front, the best in the first of the two first."""
    costs = [designs.columns[name].values * (-1.0 if name in better else 1.0) for name in names]
    return front_of(np.stack(costs, axis=-1))


def _scale(ax: Axes, which: str, item: Column, keep: np.ndarray) -> None:
    """Scale and label of the axis x or y, on which the designs to be kept are seen in any case."""
    from matplotlib.ticker import LogLocator, NullFormatter

    low, high = scales.span(item.values)
    kept = item.values[keep]
    low, high = min([low, *kept]), max([high, *kept])
    if scales.many_sizes((low, high)):
        room = (high / low) ** ROOM
        ax.set(**{f"{which}scale": "log", f"{which}lim": (low / room, high * room)})
        axis = getattr(ax, f"{which}axis")
        axis.set_major_locator(LogLocator(subs=scales.ROUND))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    else:
        room = ROOM * (high - low) or 0.5
        ax.set(**{f"{which}lim": (low - room, high + room)})
    ax.set(**{f"{which}label": item.text})
    if item.words:
        ax.set(**{f"{which}ticks": range(len(item.words)), f"{which}ticklabels": item.words})


def parallel_coordinates(
    ds: xr.Dataset,
    of: Iterable[str] | None = None,
    *,
    minimize: str | None = None,
    maximize: str | bool = False,
    color: str | None = None,
    best: int = 5,
    ax: Axes | None = None,
) -> Axes:
    """Plot designs as lines from parameter to parameter to result, coloured by an objective, the best few marked.

    Parameters
    ----------
    ds : Dataset
        Results over designs, as from `linksweep.peaks`.
    of : iterable of str, default None
        Names for the axes, from left to right; None for the parameters that vary, then the peaks, of angles their least
        and largest values.
    minimize : str, default None
        Objective whose least value is the best; None for that which `linksweep.screen` or `linksweep.pareto` was asked
        for, else `color`, else the last of the names, or without names the first peak.
    maximize : str or bool, default False
        Objective whose largest value is the best; or True where the largest of the one above is.
    color : str, default None
        Name of what is drawn by colour; None for the objective.
    best : int, default 5
        Count of the best designs to mark.
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with the designs that are ok, be it over part of a revolution; of more than 1500, so many at random, better
        ones on top. Where a few designs lie far from the others, their lines leave the axis at an arrow.

    Raises
    ------
    ValueError
        For unknown names, for fewer than two or more than twelve of them, and where no design is ok.

    Examples
    --------
    >>> import linksweep as ls
    >>> made = ls.sample(ls.example("press"), {"coupler.length": (0.2, 0.24), "rocker.length": (0.16, 0.2)}, n=64)
    >>> ax = ls.plot.parallel_coordinates(ls.peaks(made, of=["F32", "T12"], theta2=360))
    >>> [tick.get_text() for tick in ax.get_xticklabels()][-1]
    '$T_{12}$ peak\\n[N m]'
    """
    require_dataset(ds, "ls.peaks of several designs")
    of_axes = _axis_names(ds) if of is None else [name_in_results(ds, name) for name in requested("of", of)]
    minimize, maximize, color = (name_in_results(ds, name) for name in (minimize, maximize, color))
    refuse(_problems(ds, of_axes, color, best))
    aim, largest = _objective(ds, of_axes, of is None, minimize, maximize, color)
    of_axes += [aim] if of is None and aim not in of_axes and len(of_axes) < MOST_AXES else []
    designs = designs_of(in_shown_units(ds), [*of_axes, aim, color or aim])
    objective = designs.columns[aim]
    order = np.argsort(-objective.values if largest else objective.values, kind="stable")
    drawn = by_chance(designs.number, LINES, order[:best])
    drawn = drawn[np.argsort(-np.argsort(order)[drawn])]  # better ones on top
    axes = [designs.columns[name] for name in of_axes]
    points = np.stack([_fractions(item) for item in axes], axis=-1)
    ax = axes_or_new(ax, figsize=(max(6.4, 1.25 * len(of_axes) + 1.4), 4.4))
    _lines(ax, points[drawn], designs.columns[color or aim], drawn, designs.counted(len(drawn)))
    if best:
        end = f"{'largest' if largest else 'least'} {in_words(aim)}"
        _mark(ax, points[order[:best]], f"best ({end}): {designs.labels_at(order[:best])}")
    for place, item in enumerate(axes):
        _axis(ax, place, item)
    ax.set_xticks(range(len(axes)), [_in_lines(item.text) for item in axes])
    ax.tick_params(axis="x", length=0.0)
    ax.set(xlim=(-0.3, len(axes) - 0.7), ylim=(-1.2 * ROOM, 1.0 + 1.2 * ROOM), yticks=[])
    ax.spines[:].set_visible(False)
    legend_above(ax)
    return ax


def _in_lines(text: str) -> str:
    """Return the heading of an axis in short lines, its unit in the last."""
    words, bracket, unit = text.partition(" [")
    return "\n".join([*wrap(words, 16), *([bracket.strip() + unit] if bracket else [])])


def _problems(ds: xr.Dataset, names: list[str], color: Any, best: Any) -> list[str]:
    problems = [problem for name in names for problem in variable_problems(ds, "of", name)]
    problems += [] if color is None else variable_problems(ds, "color", color)
    if not 2 <= len(names) <= MOST_AXES:
        problems.append(f"of: there are {len(names)}, {names}; must be from 2 to {MOST_AXES}")
    return problems + ([] if best == 0 else count_problems("best", best))


def _objective(
    ds: xr.Dataset, of_axes: list[str], by_default: bool, minimize: Any, maximize: Any, color: Any
) -> tuple[str, bool]:
    """Return the name of the objective, and whether its largest value is the best."""
    names = {"minimize": minimize} | ({} if isinstance(maximize, bool) else {"maximize": maximize})
    chosen = {path: name for path, name in names.items() if name is not None}
    refuse([p for path, name in chosen.items() for p in variable_problems(ds, path, name, numbers="fiu")])
    refuse(["state minimize or maximize, not both: the best is so by one of them"] if len(chosen) > 1 else [])
    if chosen:
        ((path, name),) = chosen.items()
        return name, path == "maximize" or maximize is True
    if maximize is False and color is None and (stated := stated_objective(ds)):
        return stated
    first = next((name for name in of_axes if name.endswith("_peak")), of_axes[-1])
    return color or (first if by_default else of_axes[-1]), bool(maximize)


def _axis_names(ds: xr.Dataset) -> list[str]:
    """Return the parameters that vary, labels of dims only where no parameter says more, and the peaks; of angles the
    least and largest values, since none is better for being far from zero."""
    labels = [str(name) for name in ds.dims if name in ds.coords and ds[name].dtype.kind not in "iu"]
    parameters = [str(name) for name, item in ds.coords.items() if item.dims and name not in ds.dims]
    known = {ds[name].values.tobytes() for name in parameters}
    labels = [name for name in labels if ds[name].values.tobytes() not in known]
    peaks = [str(name) for name in ds.data_vars if str(name).endswith("_peak")]
    angles = {name: name.removesuffix("_peak") for name in peaks if ds[name].attrs.get("units") == "degree"}
    ends = {name: [f"{base}_min", f"{base}_max"] for name, base in angles.items() if f"{base}_min" in ds}
    return [*labels, *parameters, *(each for name in peaks for each in ends.get(name, [name]))]


def _limits(item: Column) -> tuple[float, float]:
    low, high = scales.span(item.values)
    return (low, high) if low < high else (low - 0.5, high + 0.5)


def _fractions(item: Column, values: np.ndarray | None = None) -> np.ndarray:
    """Return heights on an axis that runs from 0 to 1; of values off its scale, just beyond the end."""
    limits, values = _limits(item), item.values if values is None else values
    low, high = np.log(limits) if scales.many_sizes(limits) else limits
    values = np.log(np.maximum(values, limits[0] / 2.0)) if scales.many_sizes(limits) else values
    return np.clip((values - low) / (high - low), -ROOM, 1.0 + ROOM)


def _lines(ax: Axes, points: np.ndarray, objective: Column, drawn: np.ndarray, text: str) -> None:
    """Draw a line for each design, coloured by the objective."""
    from matplotlib.collections import LineCollection

    limits = scales.span(objective.values)
    places = np.broadcast_to(np.arange(points.shape[1]), points.shape)
    alpha = float(np.clip(30.0 / np.sqrt(len(drawn)), 0.25, 0.9))
    style: dict[str, Any] = {"linewidths": 0.8, "alpha": alpha, "rasterized": True, "label": text, "zorder": 1.5}
    lines = LineCollection(list(np.stack([places, points], axis=-1)), norm=scales.norm(limits), cmap="viridis", **style)
    lines.set_array(objective.values[drawn])
    ax.add_collection(lines, autolim=False)
    scales.color_bar(ax, lines, objective, limits)


def _mark(ax: Axes, points: np.ndarray, text: str) -> None:
    """Draw the best as lines that stand out, with their labels in the legend."""
    for k, row in enumerate(points):
        ax.plot(row, color=VERMILION, linewidth=1.5, zorder=2.2, label=f"_best {k + 1}" if k else text)


def _axis(ax: Axes, place: int, item: Column) -> None:
    """Draw an upright axis with its numbers, and an arrow where lines go off its scale."""
    from matplotlib.patheffects import withStroke

    halo: list[Any] = [withStroke(linewidth=2.5, foreground=ax.get_facecolor())]
    ticks = np.arange(len(item.words)) if item.words else scales.levels(_limits(item))
    heights = _fractions(item, ticks)
    ax.plot([place, place], [0.0, 1.0], color=BLACK, linewidth=0.9, zorder=2.4)
    ax.plot(np.full(len(ticks), place), heights, "_", color=BLACK, markersize=6.0, zorder=2.4)
    style: dict[str, Any] = {"va": "center", "fontsize": "small", "zorder": 2.6, "path_effects": halo}
    for tick, height in zip(ticks, heights, strict=True):
        text = item.words[round(tick)] if item.words else f"{tick:g}".replace("-", "−")
        ax.annotate(text, (place, height), (5.0, 0.0), textcoords="offset points", **style)
    for end, marker, off in ((0.0, "v", item.values < _limits(item)[0]), (1.0, "^", item.values > _limits(item)[1])):
        if off.any():
            ax.plot([place], [end], marker, color=BLACK, markersize=5.0, zorder=2.4, label=f"_beyond {item.name}")
