"""Designs of a study for plots: names in words, one number for each design, the designs that are ok, the ends of a
scale."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.analysis.design.pareto import has_peaks
from linksweep.base.validate import name_problems, quote, refuse
from linksweep.mechanisms import indices
from linksweep.plot.kit.signals import symbol

if TYPE_CHECKING:
    from matplotlib.axes import Axes


ROUND = (1.0, 2.0, 5.0)  # numbers on a logarithmic scale
DECADE = 10.0  # how many times as large as the least the largest of a linear scale may be


class Column(NamedTuple):
    """One number for each design: of a result, a parameter, or a label; labels that are words are numbered."""

    name: str
    text: str  # what to write beside an axis, with the unit
    values: np.ndarray
    words: tuple[str, ...] = ()


class Designs(NamedTuple):
    """The designs that are ok, of `total` in all, with their columns and labels."""

    columns: dict[str, Column]
    labels: dict[str, np.ndarray]
    total: int

    @property
    def number(self) -> int:
        return len(next(iter(self.columns.values())).values)

    def labels_at(self, at: np.ndarray) -> str:
        """Return the labels of designs as `scene_at` takes them: of one dim all of its labels, of several dims the
        first design."""
        if len(self.labels) == 1:
            ((dim, values),) = self.labels.items()
            return f"{dim} {', '.join(label(value) for value in values[at].tolist())}"
        return ", ".join(f"{dim} = {label(values[at[:1]].tolist()[0])}" for dim, values in self.labels.items())

    def counted(self, drawn: int) -> str:
        """Return in words how many designs are drawn, of how many."""
        ok = f"designs{'' if self.number == self.total else ' that are ok'}"
        if drawn == self.number:
            return f"{whole(drawn)} {ok}"
        return f"{whole(drawn)} of {whole(self.number)} {ok}, chosen by chance"


def designs_of(ds: xr.Dataset, names: Iterable[str]) -> Designs:
    """Select the designs whose status is ok or partial_revolution and that have a finite number for each of the names.

    Raises ValueError where a name does not hold one number for each design, and where no design is ok.
    """
    names = list(dict.fromkeys(names))
    *together, first = xr.broadcast(*(ds[name] for name in names), has_peaks(ds))
    refuse([] if first.dims else ["ds holds one design: give it a dimension of designs"])
    columns = {name: column(ds[name], item.values.reshape(-1)) for name, item in zip(names, together, strict=True)}
    sound = np.all([np.isfinite(item.values) for item in columns.values()], axis=0) & first.values.reshape(-1)
    refuse([] if sound.any() else [none_ok(ds, names)])
    at = np.unravel_index(np.flatnonzero(sound), first.shape)
    labels = {str(dim): ds[dim].values[k] if dim in ds.coords else k for dim, k in zip(first.dims, at, strict=True)}
    kept = {name: item._replace(values=item.values[sound]) for name, item in columns.items()}
    return Designs(kept, labels, len(sound))


def require_study(ds: Any) -> None:
    refuse(
        [] if isinstance(ds, xr.Dataset) else [f"ds = {quote(ds)}: must be a Dataset over designs, as from ls.peaks"]
    )


def variable_problems(ds: xr.Dataset, path: str, name: Any, numbers: bool = False) -> list[str]:
    """Return the problems of a name that must stand for one number, or one word, for each design."""
    if problems := name_problems(path, name, map(str, ds.variables)):
        return problems
    if numbers and ds[name].dtype.kind not in "fiub":
        return [f"{path}: {name} holds {ds[name].dtype} values, which must be numbers"]
    over = [dim for dim in indices() if dim in ds[name].dims]
    advice = f'ls.peaks(scene, of=["{name}"]) has one number for each design; take those'
    return [f"{path}: {name} depends on {over[0]}, and must not; {advice}"] if over else []


def none_ok(ds: xr.Dataset, names: Iterable[str]) -> str:
    """Return the message where there is nothing to draw, with the counts of each status."""
    nothing = f"no design is ok and has a finite {' and '.join(names)}"
    if "status" not in ds.variables:
        return nothing
    meanings = str(ds["status"].attrs.get("flag_meanings", "")).split()
    counts = {word: int((ds["status"] == code).sum()) for code, word in enumerate(meanings)}
    statuses = ", ".join(f"{count} {word}" for word, count in counts.items() if count)
    return f'{nothing} (status: {statuses}); to plot all that is finite, pass ds.drop_vars("status")'


def column(item: xr.DataArray, values: np.ndarray) -> Column:
    name = str(item.name)
    if item.dtype.kind in "fiub":
        return Column(name, heading(item), values.astype(float))
    words, numbered = np.unique(values.astype(str), return_inverse=True)
    return Column(name, heading(item), numbered.reshape(-1).astype(float), tuple(words.tolist()))


def heading(item: xr.DataArray) -> str:
    """Return a name in words with its unit: F32_peak in N as "$F_{32}$ peak [N]"."""
    units = str(item.attrs.get("units", "")).replace("degree", "°")
    return in_words(str(item.name)) + ("" if units in ("", "1") else f" [{units}]")


def in_words(name: str) -> str:
    """Return F32_peak as "$F_{32}$ peak", coupler.cg_angle as "coupler cg angle"; a path with numbers as it is."""
    if "[" in name:
        return name
    first, _, rest = name.replace(".", "_").partition("_")
    return f"{symbol(first) or first} {rest.replace('_', ' ')}".strip()


def label(value: Any) -> str:
    """Format a label with six digits at most."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def whole(count: int) -> str:
    """Format a count in groups of three digits: 100 000."""
    return f"{count:_}".replace("_", "\N{THIN SPACE}")


def span(values: np.ndarray) -> tuple[float, float]:
    """Return the ends of a scale that shows all designs, but for a few that lie far from the others.

    Near toggles peaks grow without bound, and one such design would flatten all the others. A design
    is off the scale where it is farther from the middle nine tenths than these are wide.
    """
    low, high = float(values.min()), float(values.max())
    least, most = (float(end) for end in np.quantile(values, (0.05, 0.95)))
    width = most - least
    return (least if low < least - width else low), (most if high > most + width else high)


def many_sizes(limits: tuple[float, float]) -> bool:
    """Return whether a scale is better logarithmic: above zero, with a largest number many times the least."""
    return 0.0 < DECADE * limits[0] < limits[1]


def norm(limits: tuple[float, float]) -> Any:
    """Return matplotlib's map from numbers to colours."""
    from matplotlib.colors import LogNorm, Normalize

    return (LogNorm if many_sizes(limits) else Normalize)(*limits)


def levels(limits: tuple[float, float]) -> np.ndarray:
    """Return a few round numbers on a scale."""
    from matplotlib.ticker import LogLocator, MaxNLocator

    locator: Any = LogLocator(subs=ROUND) if many_sizes(limits) else MaxNLocator(6)
    ticks = locator.tick_values(*limits)
    return ticks[(ticks >= limits[0]) & (ticks <= limits[1])]


def color_bar(ax: Axes, colored: Any, item: Column, limits: tuple[float, float]) -> None:
    """Add a colour bar with round numbers, and with a pointed end where values are off its scale."""
    round_numbers: dict[str, Any] = {"ticks": levels(limits), "format": "%g"} if many_sizes(limits) else {}
    if item.words:
        round_numbers = {"ticks": range(len(item.words)), "format": lambda value, _: item.words[round(value)]}
    bar = ax.figure.colorbar(colored, ax=ax, label=item.text, extend=beyond(item.values, limits), **round_numbers)
    bar.minorticks_off()
    if bar.solids is not None:
        bar.solids.set(alpha=1.0)


def beyond(values: np.ndarray, limits: tuple[float, float]) -> str:
    """Return the ends of a scale beyond which there are values, in matplotlib's words for colour bars."""
    below, above = (values < limits[0]).any(), (values > limits[1]).any()
    return {(False, False): "neither", (True, False): "min", (False, True): "max"}.get(
        (bool(below), bool(above)), "both"
    )


def by_chance(count: int, most: int, keep: np.ndarray) -> np.ndarray:
    """Choose positions of at most `most` out of `count` at random, those to be kept among them; equal for each call."""
    if count <= most:
        return np.arange(count)
    others = np.setdiff1d(np.arange(count), keep)
    chosen = np.random.default_rng(0).choice(others, max(most - len(keep), 0), replace=False)
    return np.union1d(chosen, keep)
