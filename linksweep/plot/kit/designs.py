"""Designs of a study as plots take them: names in words, one number a design, which are ok, how much a scale shows."""

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
    """The designs that are ok, of `total` in all, with what was asked of them."""

    columns: dict[str, Column]
    labels: dict[str, np.ndarray]
    total: int

    @property
    def number(self) -> int:
        return len(next(iter(self.columns.values())).values)

    def said(self, at: np.ndarray) -> str:
        """Which designs these are, as `scene_at` takes them: of one dim all of its labels, of several the first."""
        if len(self.labels) == 1:
            ((dim, values),) = self.labels.items()
            return f"{dim} {', '.join(label(value) for value in values[at].tolist())}"
        return ", ".join(f"{dim} = {label(values[at[:1]].tolist()[0])}" for dim, values in self.labels.items())

    def counted(self, shown: int) -> str:
        """How many of the designs are on the paper, and how many there are."""
        ok = f"designs{'' if self.number == self.total else ' that are ok'}"
        if shown == self.number:
            return f"{whole(shown)} {ok}"
        return f"{whole(shown)} of {whole(self.number)} {ok}, chosen by chance"


def designs_of(ds: xr.Dataset, names: Iterable[str]) -> Designs:
    """The designs whose status is ok or partial_revolution and that have a finite number for each of the names.

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
    """What is wrong with a name that must stand for one number of each design, or one word where these will do."""
    if problems := name_problems(path, name, map(str, ds.variables)):
        return problems
    if numbers and ds[name].dtype.kind not in "fiub":
        return [f"{path}: {name} holds {ds[name].dtype} values, which must be numbers"]
    over = [dim for dim in indices() if dim in ds[name].dims]
    advice = f'ls.peaks(scene, of=["{name}"]) has one number for each design; take those'
    return [f"{path}: {name} depends on {over[0]}, and must not; {advice}"] if over else []


def none_ok(ds: xr.Dataset, names: Iterable[str]) -> str:
    """What to say when there is nothing to draw, and what the designs' status is."""
    nothing = f"no design is ok and has a finite {' and '.join(names)}"
    if "status" not in ds.variables:
        return nothing
    meanings = str(ds["status"].attrs.get("flag_meanings", "")).split()
    counts = {word: int((ds["status"] == code).sum()) for code, word in enumerate(meanings)}
    found = ", ".join(f"{count} {word}" for word, count in counts.items() if count)
    return f'{nothing} (status: {found}); to see what is finite all the same, give ds.drop_vars("status")'


def column(item: xr.DataArray, values: np.ndarray) -> Column:
    name = str(item.name)
    if item.dtype.kind in "fiub":
        return Column(name, heading(item), values.astype(float))
    words, numbered = np.unique(values.astype(str), return_inverse=True)
    return Column(name, heading(item), numbered.reshape(-1).astype(float), tuple(words.tolist()))


def heading(item: xr.DataArray) -> str:
    """A name in words with its unit: F32_peak in N as "$F_{32}$ peak [N]"."""
    units = str(item.attrs.get("units", "")).replace("degree", "°")
    return in_words(str(item.name)) + ("" if units in ("", "1") else f" [{units}]")


def in_words(name: str) -> str:
    """F32_peak as "$F_{32}$ peak", coupler.cg_angle as "coupler cg angle"; paths with numbers in them as they are."""
    if "[" in name:
        return name
    first, _, rest = name.replace(".", "_").partition("_")
    return f"{symbol(first) or first} {rest.replace('_', ' ')}".strip()


def label(value: Any) -> str:
    """A label as one types it, as far as a reader wants it."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def whole(count: int) -> str:
    """100 000 rather than 100000."""
    return f"{count:_}".replace("_", "\N{THIN SPACE}")


def span(values: np.ndarray) -> tuple[float, float]:
    """The scale that shows designs as they usually are: all of them, unless a few lie far from the rest.

    Near toggles peaks grow without bound, and one such design would flatten all the others. What is farther from the
    middle nine tenths than these are wide is off the scale.
    """
    low, high = float(values.min()), float(values.max())
    least, most = (float(end) for end in np.quantile(values, (0.05, 0.95)))
    width = most - least
    return (least if low < least - width else low), (most if high > most + width else high)


def many_sizes(limits: tuple[float, float]) -> bool:
    """Whether a scale is better logarithmic: from small to large numbers, all above zero."""
    return 0.0 < DECADE * limits[0] < limits[1]


def norm(limits: tuple[float, float]) -> Any:
    """Numbers to colours."""
    from matplotlib.colors import LogNorm, Normalize

    return (LogNorm if many_sizes(limits) else Normalize)(*limits)


def levels(limits: tuple[float, float]) -> np.ndarray:
    """A few round numbers on a scale."""
    from matplotlib.ticker import LogLocator, MaxNLocator

    locator: Any = LogLocator(subs=ROUND) if many_sizes(limits) else MaxNLocator(6)
    found = locator.tick_values(*limits)
    return found[(found >= limits[0]) & (found <= limits[1])]


def color_bar(ax: Axes, colored: Any, shown: Column, limits: tuple[float, float]) -> None:
    """The colour bar, with a pointed end where values are off its scale, and round numbers."""
    round_numbers: dict[str, Any] = {"ticks": levels(limits), "format": "%g"} if many_sizes(limits) else {}
    if shown.words:
        round_numbers = {"ticks": range(len(shown.words)), "format": lambda value, _: shown.words[round(value)]}
    bar = ax.figure.colorbar(colored, ax=ax, label=shown.text, extend=beyond(shown.values, limits), **round_numbers)
    bar.minorticks_off()
    if bar.solids is not None:
        bar.solids.set(alpha=1.0)


def beyond(values: np.ndarray, limits: tuple[float, float]) -> str:
    """At which ends of a scale there is something beyond it, in matplotlib's words for colour bars."""
    below, above = (values < limits[0]).any(), (values > limits[1]).any()
    return {(False, False): "neither", (True, False): "min", (False, True): "max"}.get(
        (bool(below), bool(above)), "both"
    )


def by_chance(count: int, most: int, keep: np.ndarray) -> np.ndarray:
    """Positions of at most so many out of many, those to be kept among them; the same ones each time."""
    if count <= most:
        return np.arange(count)
    others = np.setdiff1d(np.arange(count), keep)
    chosen = np.random.default_rng(0).choice(others, max(most - len(keep), 0), replace=False)
    return np.union1d(chosen, keep)
