"""Designs of a study for plots: names in words, one number for each design, the designs that are ok."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import xarray as xr

from linksweep.base.validate import refuse
from linksweep.plot.kit.signals import label_text, symbol
from linksweep.results.front import has_peaks


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
            return f"{dim} {', '.join(map(label_text, values[at].tolist()))}"
        return ", ".join(f"{dim} = {label_text(values[at[:1]].tolist()[0])}" for dim, values in self.labels.items())

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


def none_ok(ds: xr.Dataset, names: Iterable[str]) -> str:
    """Return the message where there is nothing to draw, with the counts of each status."""
    nothing = f"no design is ok and has a finite {' and '.join(names)}"
    if "status" not in ds.variables:
        return nothing
    meanings = str(ds["status"].attrs.get("flag_meanings", "")).split()
    counts = {word: int((ds["status"] == code).sum()) for code, word in enumerate(meanings)}
    counts["no value"] = int(ds["status"].isnull().sum())  # as of `Dataset.where`
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
    first, *rest = name.replace(".", "_").split("_")
    if rest and symbol(f"{first}_{rest[0]}"):
        first = f"{first}_{rest.pop(0)}"
    return " ".join([symbol(first) or first, *rest])


def whole(count: int) -> str:
    """Format a count in groups of three digits: 100 000."""
    return f"{count:_}".replace("_", "\N{THIN SPACE}")


def by_chance(count: int, most: int, keep: np.ndarray) -> np.ndarray:
    """Choose positions of at most `most` out of `count` at random, those to be kept among them; equal for each call."""
    if count <= most:
        return np.arange(count)
    others = np.setdiff1d(np.arange(count), keep)
    chosen = np.random.default_rng(0).choice(others, max(most - len(keep), 0), replace=False)
    return np.union1d(chosen, keep)
