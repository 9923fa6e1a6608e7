"""A screening as a task: the designs, the request, and the tally of some of the designs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from linksweep.base.validate import refuse
from linksweep.base.version import installed_version
from linksweep.engine.threads import limits_threads
from linksweep.results.front import has_peaks
from linksweep.results.peaks import peaks, quantity_of
from linksweep.scene.designs.drawing import draw
from linksweep.scene.scene import Scene
from linksweep.studies.tally import Tally, best, bin_counts, within_limits

DIM = "design"


@dataclass(frozen=True, eq=False)
class Screening:
    """Designs drawn from `parameters`, and what is asked of them.

    `objectives` have the sign −1 where they are to be large; `limits` are (least, most); `edges` are those of the
    histograms; `words` of the status are in the order of its codes.
    """

    scene: Scene
    parameters: Mapping[str, Any]
    seed: int
    objectives: Mapping[str, float]
    limits: Mapping[str, tuple[float, float]]
    edges: Mapping[str, np.ndarray]
    keep: int
    options: Mapping[str, Any]
    words: tuple[str, ...] = ()
    version: str = installed_version()

    @property
    def bins(self) -> int:
        """Number of bins of all histograms."""
        return sum(len(edges) + 1 for edges in self.edges.values())

    @property
    def small(self) -> list[str]:
        """Names of the objectives that are to be small."""
        return [name for name, sign in self.objectives.items() if sign > 0.0]

    @property
    def large(self) -> list[str]:
        """Names of the objectives that are to be large."""
        return [name for name, sign in self.objectives.items() if sign < 0.0]

    @property
    def names(self) -> list[str]:
        """Names of all results that the screening looks at."""
        return list(dict.fromkeys([*self.objectives, *self.limits, *self.edges]))

    @property
    def results(self) -> list[str]:
        """Names of the results that `linksweep.peaks` makes: neither parameters nor the status."""
        return [name for name in self.names if name not in self.parameters and name != "status"]

    @cached_property
    def quantities(self) -> list[str]:
        """Names of the quantities whose peaks are computed for all designs."""
        return list(dict.fromkeys(map(quantity_of, self.results)))

    def peaks(self, designs: Iterable[int], of: list[str]) -> xr.Dataset:
        """Return the peaks of some designs."""
        drawn = draw(self.scene, self.parameters, designs=designs, seed=self.seed, dim=DIM)
        return peaks(drawn, of, **self.options)

    def tally(self, first: int, last: int) -> Tally:
        """Return the tally of the designs from `first` to before `last`."""
        ds = self.peaks(range(first, last), self.quantities)
        values, status = values_of(ds, self.names), values_of(ds, ["status"])["status"]
        within_each = within_limits(values, self.limits)
        within = np.broadcast_to(has_peaks(ds), status.shape).copy()
        for inside in within_each.values():
            within &= inside
        costs = np.stack([sign * values[name] for name, sign in self.objectives.items()] or [status], axis=-1)
        costs = costs[:, : len(self.objectives)]
        designs = np.flatnonzero(within & np.isfinite(costs).all(axis=1))
        designs = designs[best(costs[designs], self.keep)]
        bins = [bin_counts(values[name], edges) for name, edges in self.edges.items()]
        counts = [int(np.count_nonzero(inside)) for inside in (within, *within_each.values())]
        return Tally(
            np.bincount(status, minlength=len(self.words)),
            np.array(counts),
            np.concatenate([*bins, np.empty(0, dtype=np.int64)]),
            first + designs,
            costs[designs],
        )


@limits_threads
def tally_there(task: Screening, first: int, last: int, *, threads: int) -> Tally:
    """Return a tally on a worker of a cluster, which must have the version of linksweep that made the task."""
    here = installed_version()
    other = f"a worker has linksweep {here}, and this is {task.version}: install the same on all"
    refuse([] if here == task.version else [other])
    return task.tally(first, last)


def values_of(ds: xr.Dataset, names: Iterable[str]) -> dict[str, np.ndarray]:
    """Return one value of each name for each design, also of those on which it does not depend."""
    return {name: np.broadcast_to(ds[name].values, ds.sizes[DIM]) for name in names}
