"""The heat map of a study: one result over two of its design dims."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.design.pareto import variable_problems
from linksweep.base.validate import name_problems, quote, refuse
from linksweep.plot.kit import scales, signals
from linksweep.plot.kit.colors import BLACK, GREY, SHADE
from linksweep.plot.kit.designs import column, heading, in_words, none_ok
from linksweep.plot.kit.style import axes_or_new, legend_above
from linksweep.results.compute import require_dataset
from linksweep.results.front import has_peaks
from linksweep.results.origin.in_shown_units import in_shown_units

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

    def text_at(self, place: float) -> str:
        value = self.words[round(place)] if self.words else f"{place:.4g}"
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
    ax: Axes | None = None,
) -> Axes:
    """Plot a result over two design dims in colours, the best design marked, those without peaks hatched.

    Parameters
    ----------
    ds : Dataset
        Results over designs, as from `linksweep.peaks`.
    of : str
        Result, such as "F32_peak", that depends on two dims.
    x : str, default None
        Dim along the horizontal axis, or a parameter over it ("crank.length"); None for the second dim, as the
        parameter whose values are its labels.
    y : str, default None
        Dim along the vertical axis, or a parameter over it; None for the first dim, likewise.
    maximize : bool, default False
        True where the largest value is the best, False where the least is.
    contours : bool or str, default False
        True for lines of equal value; the name of another result, "transmission_angle_min", for lines of that.
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
        For unknown names, for a result over other than two dims, and where no design is ok.

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
    ds = in_shown_units(ds)
    across, up = _sides(ds, of, x, y)
    _require_on_map(ds, contours, across, up)
    values = _field(ds[of], across, up)
    ok = np.isfinite(values) & (_field(~has_peaks(ds), across, up) == 0.0)
    refuse([] if ok.any() else [none_ok(ds, [of])])
    ax = axes_or_new(ax)
    limits = scales.span(values[ok])
    colored = np.ma.masked_where(~ok, values)
    mesh = ax.pcolormesh(across.edges, up.edges, colored, cmap="viridis", norm=scales.norm(limits), rasterized=True)
    scales.color_bar(ax, mesh, column(ds[of], values[ok]), limits)
    handles = [_best(ax, ds[of], across, up, np.where(ok, values, np.nan), maximize)]
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
    refuse(variable_problems(ds, "of", name, numbers="fiub"))
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
    over = f"{name} depends on {', '.join(dims) or 'no dim'}: a heat map takes a result over two dims; "
    if len(dims) > 2:
        return over + f"choose one of the others, such as ds.isel({dims[0]}=0)"
    return over + "plot.scatter and plot.parallel_coordinates show a sample"


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


def _best(ax: Axes, item: xr.DataArray, across: Side, up: Side, values: np.ndarray, maximize: bool) -> Any:
    """Draw a star on the best design; return its handle, with value and place."""
    row, col = np.unravel_index(np.nanargmax(values if maximize else -values), values.shape)
    at = float(across.places[col]), float(up.places[row])
    text = f"{'largest' if maximize else 'least'}: {signals.number(values[row, col])} {item.attrs.get('units', '')}"
    where = f"{text.strip()} at {across.text_at(at[0])}, {up.text_at(at[1])}"
    style: dict[str, Any] = {"markersize": 13.0, "color": "white", "markeredgecolor": BLACK, "zorder": 3.0}
    (star,) = ax.plot([at[0]], [at[1]], "*", label=where, clip_on=False, **style)
    return star


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
    ax.set(xlabel=across.text, ylabel=up.text)
    if across.words:
        ax.set_xticks(across.places, across.words)
    if up.words:
        ax.set_yticks(up.places, up.words)
