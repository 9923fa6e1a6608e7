"""The heat map of a study: one result over two of its design dims, or over two parameters of a sample, in bins."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.design.bins import STATISTICS, binned, bins_of
from linksweep.analysis.design.pareto import variable_problems
from linksweep.base.validate import choice_problems, count_problems, flag_problems, name_problems, quote, refuse
from linksweep.plot.kit import scales, signals
from linksweep.plot.kit.colors import BLACK, GREY, SHADE
from linksweep.plot.kit.designs import column, heading, in_words, none_ok
from linksweep.plot.kit.style import axes_or_new, legend_above
from linksweep.results.compute import require_dataset
from linksweep.results.front import has_peaks
from linksweep.results.origin.in_shown_units import in_shown_units
from linksweep.results.origin.machine_of_results import name_in_results

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HATCHES = {"partial_revolution": "////", "cannot_assemble": "xxxx", "unbounded": "...."}
LEFT_OUT = "no value"


class Side(NamedTuple):
    """An axis of the map: its dim, its designs in order, their places, and the cells' edges."""

    dim: str
    name: str
    text: str
    order: np.ndarray
    places: np.ndarray
    edges: np.ndarray
    words: tuple[str, ...]

    @property
    def digits(self) -> int:
        """Significant digits that tell neighbours apart."""
        return scales.digits(self.edges)

    def text_at(self, place: float) -> str:
        value = self.words[round(place)] if self.words else f"{place:.{self.digits}g}"
        unit = self.text.rpartition(" [")[2].rstrip("]") if self.text.endswith("]") else ""
        return f"{in_words(self.name)} {value} {unit}".strip()


def heat_map(
    ds: xr.Dataset,
    of: str,
    *,
    x: str | None = None,
    y: str | None = None,
    maximize: bool = False,
    contours: bool | str = False,
    bins: int = 24,
    statistic: str = "best",
    ax: Axes | None = None,
) -> Axes:
    """Plot a result over two design dims in colours, the best design marked, those without peaks hatched.

    Designs of a sample, which lie along one dim, are counted in bins of two parameters.

    Parameters
    ----------
    ds : Dataset
        Results over designs, as from `linksweep.peaks`.
    of : str
        Result, such as "F32_peak", that depends on two dims; or on one, that of a sample.
    x : str, default None
        Dim along the horizontal axis, or a parameter over it ("crank.length"); None for the second dim, as the
        parameter whose values are its labels. Of a sample a parameter, or another result; None for the second of two.
    y : str, default None
        Dim along the vertical axis, or a parameter over it; None for the first dim, likewise.
    maximize : bool, default False
        True where the largest value is the best, False where the least is.
    contours : bool or str, default False
        True for lines of equal value; the name of another result, "transmission_angle_min", for lines of that (of its
        mean in each bin).
    bins : int, default 24
        Count of bins along each axis, of a sample.
    statistic : str, default "best"
        Colour of a bin: the "best" of its designs, their "mean", or the "worst".
    ax : matplotlib Axes, default None
        Axes to draw into; None for a new figure.

    Returns
    -------
    matplotlib Axes
        Axes with a colour bar beside them. Where a few designs lie far from the others, as near toggles, they are off
        the scale, and the colour bar has a pointed end.

    Raises
    ------
    ValueError
        For unknown names, for a `maximize` that is no truth value, for a result over more than two dims or none, for a
        sample of which the two parameters are not stated, and where no design is ok.

    Examples
    --------
    >>> import linksweep as ls, numpy as np, xarray as xr
    >>> crank = ls.Link(xr.DataArray(np.linspace(0.1, 0.2, 8), dims="crank"), 1.0, 0.01)
    >>> coupler = ls.Link(xr.DataArray(np.linspace(0.4, 0.5, 8), dims="coupler"), 1.0, 0.01)
    >>> machines = ls.FourBar(crank, coupler, ls.Link(0.4, 1.0, 0.01), 0.4)
    >>> study = ls.peaks(ls.Scene(machines, omega2=30.0), of=["F32"], theta2=360)
    >>> ax = ls.plot.heat_map(study, "F32_peak")
    >>> ax.get_xlabel(), ax.get_ylabel()
    ('coupler length [m]', 'crank length [m]')
    """
    require_dataset(ds, "ls.peaks of several designs")
    refuse(flag_problems("maximize", maximize) + count_problems("bins", bins))
    refuse(choice_problems("statistic", statistic, STATISTICS) + (["bins = 1: must be 2 or more"] if bins == 1 else []))
    of, x, y, contours = (name_in_results(ds, name) for name in (of, x, y, contours))
    refuse(variable_problems(ds, "of", of, numbers="fiub"))
    ds = in_shown_units(ds)
    sample = ds if ds[of].ndim == 1 else None
    if sample is not None:
        ds = _in_bins(ds, of, x, y, bins, statistic, maximize, contours)
        y, x = (str(dim) for dim in ds[of].dims)
    across, up = _sides(ds, of, x, y)
    _require_on_map(ds, contours, across, up)
    values = _field(ds[of], across, up)
    ok = np.isfinite(values) & (_field(~has_peaks(ds), across, up) == 0.0)
    refuse([] if ok.any() else [none_ok(ds, [of])])
    ax = axes_or_new(ax)
    limits = scales.span(values[ok])
    colored = np.ma.masked_where(~ok, values)
    mesh = ax.pcolormesh(across.edges, up.edges, colored, cmap="viridis", norm=scales.norm(limits), rasterized=True)
    height = column(ds[of], values[ok])
    if sample is not None:
        height = height._replace(text=f"{statistic} {height.text}")
    scales.color_bar(ax, mesh, height, limits)
    star = _best_cell(across, up, np.where(ok, values, np.nan), maximize)
    if sample is not None and statistic == "best":
        star = _best_design(sample, of, across, up, maximize)
    kind = ("largest" if maximize else "least") + ("" if statistic == "best" else f" {statistic}")
    worth = f"{kind}: {signals.number(star[2], scales.digits(values[ok]))} {ds[of].attrs.get('units', '')}".strip()
    handles = [_star(ax, star, worth, across, up)]
    if contours is True:  # the colour bar has their unit
        _contours(ax, ds[of], across, up, ok)
    elif contours:
        handles.append(_contours(ax, ds[contours], across, up, ok))
    handles += _not_ok(ax, across, up, _reasons(ds, across, up, ok))
    _axes(ax, across, up)
    legend_above(ax, handles=handles)
    return ax


def _sides(ds: Any, name: Any, x: Any, y: Any) -> tuple[Side, Side]:
    """Return the axes x and y."""
    dims = [str(dim) for dim in ds[name].dims]
    refuse([] if len(dims) == 2 else [_other_dims(name, dims)])
    known = {**{dim: dim for dim in dims}, **_along(ds, dims)}
    names = {"x": x, "y": y}
    refuse([p for path, side in names.items() if side is not None for p in name_problems(path, side, known)])
    if x is None:
        x = next(dim for dim in reversed(dims) if y is None or dim != known[y])
    if y is None:
        y = next(dim for dim in dims if dim != known[x])
    refuse([] if known[x] != known[y] else [f"x = {x!r} and y = {y!r} both lie along {known[x]}: give one of them"])
    return _side(ds, x, known[x]), _side(ds, y, known[y])


def _other_dims(name: str, dims: list[str]) -> str:
    over = f"{name} depends on {', '.join(dims) or 'no dim'}: a heat map takes a result over two dims, or a sample"
    return over + (f"; choose one of the others, such as ds.isel({{{dims[0]!r}: 0}})" if dims else "")


def _in_bins(
    ds: xr.Dataset, of: str, x: Any, y: Any, bins: int, statistic: str, maximize: bool, contours: Any
) -> xr.Dataset:
    """Return the result of a sample, and that of its contours, over two parameters in bins."""
    (dim,) = ds[of].dims
    known = {str(name): item for name, item in ds.variables.items() if item.dims == (dim,) and item.dtype.kind in "fiu"}
    parameters = [str(name) for name in ds.coords if name in known and name != dim]
    chosen = {"y": y, "x": x}
    refuse([p for path, name in chosen.items() if name is not None for p in name_problems(path, name, known)])
    rest = [name for name in parameters if name not in (x, y)]
    if len(rest) != sum(name is None for name in chosen.values()):
        several = f"state two of the parameters over {dim}, {', '.join(parameters)}, or of the results"
        refuse([f"{path} is missing: {several}" for path, name in chosen.items() if name is None])
    named = {path: name if name is not None else rest.pop(0) for path, name in chosen.items()}
    refuse([] if named["x"] != named["y"] else [f"x and y are both {named['x']!r}: give two parameters"])
    constant = [name for name in named.values() if not float(ds[name].min()) < float(ds[name].max())]
    refuse([f"{name} is the same for all designs: give a parameter that varies" for name in constant])
    further = {contours: "mean"} if isinstance(contours, str) and contours in known and contours != of else {}
    across, up = (bins_of(ds[name], int(bins)) for name in (named["x"], named["y"]))
    return binned(ds, {of: statistic} | further, across, up, maximize)


def _along(ds: xr.Dataset, dims: list[str]) -> dict[str, str]:
    """Return the coordinates along one of the dims alone, with that dim."""
    one_dim = {str(name): str(item.dims[0]) for name, item in ds.coords.items() if item.ndim == 1}
    return {name: dim for name, dim in one_dim.items() if dim in dims}


def _side(ds: xr.Dataset, name: str, dim: str) -> Side:
    if name == dim:
        name = _parameter(ds, dim)
    item = ds[name].rename(name)  # of a dim without labels its positions
    item_column = column(item, item.values)
    order = np.argsort(item_column.values)
    places = item_column.values[order]
    if len(places) < 2 or not (np.diff(places) > 0.0).all():
        refuse([f"{name} has {quote(places.tolist())} along {dim}: must be two numbers or more, all different"])
    middles = 0.5 * (places[1:] + places[:-1])
    ends = 2.0 * places[[0, -1]] - middles[[0, -1]]
    return Side(dim, name, item_column.text, order, places, np.array([ends[0], *middles, ends[1]]), item_column.words)


def _parameter(ds: xr.Dataset, dim: str) -> str:
    """Return the parameter whose values are the labels of a dim, for it has a unit; else the dim."""
    others = [name for name, over in _along(ds, [dim]).items() if over == dim and name != dim]
    if dim not in ds.coords:
        return others[0] if len(others) == 1 else dim
    return next((name for name in others if np.array_equal(ds[name].values, ds[dim].values)), dim)


def _field(item: xr.DataArray, across: Side, up: Side) -> np.ndarray:
    """Return a result at the cells (y, x): the largest over other dims, repeated along a dim it does not depend on."""
    item = item.max([dim for dim in item.dims if dim not in (across.dim, up.dim)])
    shape = {up.dim: len(up.order), across.dim: len(across.order)}
    values = item.variable.set_dims(shape).transpose(*shape).values.astype(float)
    return values[np.ix_(up.order, across.order)]


def _reasons(ds: xr.Dataset, across: Side, up: Side, ok: np.ndarray) -> dict[str, np.ndarray]:
    """Return the cells without colour, by the word of their status, the worst over other dims."""
    item = ds.get("status", xr.DataArray(0))
    status, words = _field(item, across, up), str(item.attrs.get("flag_meanings", "")).split()
    cells_of = {word: (status == code) & ~ok for code, word in enumerate(words) if code}
    cells_of[LEFT_OUT] = ~ok & ~np.any([np.zeros(ok.shape, dtype=bool), *cells_of.values()], axis=0)
    return {word: cells for word, cells in cells_of.items() if cells.any()}


def _not_ok(ax: Axes, across: Side, up: Side, reasons: dict[str, np.ndarray]) -> list[Any]:
    """Draw grey cells, hatched by reason; return handles for the legend."""
    from matplotlib.patches import Patch, PathPatch

    handles = []
    for word, cells in reasons.items():
        hatch = HATCHES.get(word, "")
        style: dict[str, Any] = {"facecolor": SHADE, "edgecolor": GREY, "linewidth": 0.0, "hatch": hatch}
        patch = PathPatch(_outline(across.edges, up.edges, cells), label=f"_{word}", **style)
        ax.add_patch(patch)
        handles.append(Patch(label=word.replace("_", " "), **style))
    return handles


def _outline(x: np.ndarray, y: np.ndarray, cells: np.ndarray) -> Any:
    """Return one path of the cells' rectangles, each row's neighbours as one, so that a hatch runs through."""
    from matplotlib.path import Path

    steps = np.diff(cells.astype(np.int8), axis=1, prepend=0, append=0)
    (row, left), (_, right) = np.nonzero(steps == 1), np.nonzero(steps == -1)
    corners = [(x[left], y[row]), (x[right], y[row]), (x[right], y[row + 1]), (x[left], y[row + 1]), (x[left], y[row])]
    points = np.stack([np.stack(corner, axis=-1) for corner in corners], axis=1).reshape(-1, 2)
    codes = np.tile([Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY], len(row))
    return Path(points, codes)


def _best_cell(across: Side, up: Side, values: np.ndarray, maximize: bool) -> tuple[float, float, float]:
    """Return x, y and value of the best cell."""
    row, col = np.unravel_index(np.nanargmax(values if maximize else -values), values.shape)
    return float(across.places[col]), float(up.places[row]), float(values[row, col])


def _best_design(ds: xr.Dataset, of: str, across: Side, up: Side, maximize: bool) -> tuple[float, float, float]:
    """Return x, y and value of the best design of a sample."""
    values = np.where(has_peaks(ds) & np.isfinite(ds[of]), ds[of], np.nan)
    k = int(np.nanargmax(values if maximize else -values))
    return float(ds[across.name][k]), float(ds[up.name][k]), float(values[k])


def _star(ax: Axes, star: tuple[float, float, float], worth: str, across: Side, up: Side) -> Any:
    """Draw a star on the best design, or bin; return its handle, with what it is worth and its place."""
    x, y, _ = star
    where = f"{worth} at {across.text_at(x)}, {up.text_at(y)}"
    style: dict[str, Any] = {"markersize": 13.0, "color": "white", "markeredgecolor": BLACK, "zorder": 3.0}
    (drawn,) = ax.plot([x], [y], "*", label=where, clip_on=False, **style)
    return drawn


def _require_on_map(ds: xr.Dataset, contours: Any, across: Side, up: Side) -> None:
    if isinstance(contours, bool):
        return
    refuse(variable_problems(ds, "contours", contours, numbers="fiub"))
    extra = [str(dim) for dim in ds[contours].dims if dim not in (across.dim, up.dim)]
    refuse([f"contours: {contours} depends on {', '.join(extra)} as well, and the map does not"] if extra else [])


def _contours(ax: Axes, item: xr.DataArray, across: Side, up: Side, ok: np.ndarray) -> Any:
    """Draw lines of equal value with their numbers, where designs are ok; return their handle."""
    from matplotlib.lines import Line2D
    from matplotlib.patheffects import withStroke

    values = np.ma.masked_invalid(np.ma.masked_where(~ok, _field(item, across, up)))
    halo: list[Any] = [withStroke(linewidth=2.0, foreground=GREY)]
    lines = scales.levels(scales.span(values.compressed())) if values.count() else np.array([])
    if len(lines):
        drawn = ax.contour(across.places, up.places, values, lines, colors="white", linewidths=0.9)
        drawn.set_path_effects(halo)
        for number in ax.clabel(drawn, fontsize="small"):
            number.set_path_effects(halo)
    return Line2D([], [], color="white", linewidth=0.9, path_effects=halo, label=heading(item))


def _axes(ax: Axes, across: Side, up: Side) -> None:
    """Label both axes; a power of ten or an offset above them would lie on the legend."""
    from matplotlib.ticker import MaxNLocator

    ax.set(xlabel=across.text, ylabel=up.text)
    for axis, side in ((ax.xaxis, across), (ax.yaxis, up)):
        if side.words:
            axis.set_ticks(side.places, side.words)
        else:
            axis.set_major_formatter(scales.plain(side.edges))
    if across.digits > 5 and not across.words:
        ax.xaxis.set_major_locator(MaxNLocator(4, steps=[1, 2, 5, 10]))
