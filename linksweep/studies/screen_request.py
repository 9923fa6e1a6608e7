"""The request of a screening: its parts checked, histograms' edges drawn from the first designs, and its manifest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from linksweep.base.validate import count_problems, is_quantity, limits_in, name_problems, quote, refuse
from linksweep.base.version import installed_version
from linksweep.results.compute import by_name, requested
from linksweep.results.peaks import quantity_of
from linksweep.results.scene_peaks import requests_named
from linksweep.scene.at_sections import link_of
from linksweep.scene.designs.drawing import draw, seed_range_problems
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.designs.sampling import parameter_problems, with_designs
from linksweep.scene.designs.selection import design_sizes
from linksweep.studies.job import scene_digest
from linksweep.studies.screening import DIM, Screening, values_of

PILOT = 4096
"""Designs, the first ones, whose results decide between which edges histograms are drawn."""
EXTREMES = (0.5**53, 1.0 - 0.5**53)
"""The least and the largest level that can be drawn."""


def screening_of(
    scene: Any,
    parameters: Any,
    minimize: Any,
    maximize: Any,
    subject_to: Any,
    keep: Any,
    bins: Any,
    seed: Any,
    options: Mapping[str, Any],
) -> Screening:
    """Return the screening that is requested; edges are NaN until `ready` draws them. ValueError where it cannot be."""
    refuse([*parameter_problems(scene, parameters), *seed_range_problems(seed), *count_problems("keep", keep)])
    dims = [*design_sizes(scene), *scene.mechanism.both_branches]
    advice = "give one design, as of ls.scene_at, and let its numbers vary by `parameters`"
    refuse([f"scene: has designs along {', '.join(dims)}; {advice}"] if dims else [])
    small, large = requested("minimize", minimize, scene), requested("maximize", maximize, scene)
    refuse([f"maximize: {name} is to be small, too; name it once" for name in large if name in small])
    objectives = dict.fromkeys(small, 1.0) | dict.fromkeys(large, -1.0)
    limits = by_name("subject_to", _limits(subject_to), scene)
    along = [] if scene.section is not None else [name for name in (*small, *large, *limits) if link_of(name)]
    refuse([f"{name}: differs along its link; give the scene one place, as section=0.5" for name in along[:1]])
    edges = {}
    if isinstance(bins, Mapping):
        edges = {name: _edges(name, own) for name, own in by_name("bins", bins, scene).items()}
    refuse([] if isinstance(bins, Mapping) else count_problems("bins", bins))
    nothing = 'minimize: give what is asked for: minimize="F32_peak", maximize, subject_to or bins'
    refuse([] if objectives or limits or edges else [nothing])
    if not isinstance(bins, Mapping):
        edges = {name: np.full(int(bins) + 1, np.nan) for name in (*objectives, *limits) if name != "status"}
    return Screening(in_memory(scene), parameters, int(seed), objectives, limits, edges, int(keep), options)


def _limits(subject_to: Any) -> dict[str, tuple[float, float]]:
    """Return (least, most) of each limited result."""
    example = 'as in {"F32_peak": (None, 900.0)}'
    if subject_to is not None and not isinstance(subject_to, Mapping):
        refuse([f"subject_to = {quote(subject_to)}: must give (least, most) by name, {example}"])
    limits = {name: limits_in(ends) for name, ends in (subject_to or {}).items()}
    must = f"must be (least, most), numbers or one None, {example}"
    refuse([f"subject_to: {k} = {quote(subject_to[k])}: {must}" for k, limit in limits.items() if limit is None])
    return {str(name): limit for name, limit in limits.items() if limit is not None}


def _edges(name: str, edges: Any) -> np.ndarray:
    """Return the edges of a histogram."""
    try:
        array = np.empty(0) if is_quantity(edges) else np.asarray(edges, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    rising = array.ndim == 1 and array.size > 0 and np.isfinite(array).all() and (np.diff(array) > 0.0).all()
    refuse([] if rising else [f"bins: {name} = {quote(edges)}: must be rising numbers in its unit, edges of its bins"])
    return array


def ready(task: Screening, n: int, further: list[str]) -> tuple[Screening, dict[str, Any]]:
    """Return the screening with the edges of its histograms and the words of its status, and its manifest.

    The first designs are computed, and values at the ends of what can be drawn are shown to the scene: what it refuses
    is raised here.
    """
    ends = np.tile(EXTREMES, (len(task.parameters), 1))
    with_designs(task.scene, task.parameters, ends, np.arange(2), DIM)
    for name in task.results:
        requests_named(_parameter(task, name), [quantity_of(name)], task.scene)
    first = range(min(n, PILOT))
    pilot = task.peaks(first, task.quantities)
    if further:
        task.peaks(range(1), [*task.quantities, *further])
    results = [*map(str, pilot.variables)]
    refuse([line for name in task.names for line in name_problems(_parameter(task, name), name, results)])
    values = values_of(pilot, task.names)
    edges = {name: _between(values[name], len(own)) if np.isnan(own[0]) else own for name, own in task.edges.items()}
    words = tuple(str(pilot["status"].attrs["flag_meanings"]).split())
    task = replace(task, edges=edges, words=words)
    return task, _manifest(task, n, further)


def _manifest(task: Screening, n: int, further: list[str]) -> dict[str, Any]:
    """Return what a tally depends on, by argument: names in their order, which is that of its numbers.

    The edges of histograms are last, as they follow from the rest.
    """
    designs = draw(task.scene, task.parameters, designs=range(min(n, PILOT)), seed=task.seed)
    return {
        "n": n, "seed": task.seed, "scene": scene_digest(designs), "minimize": task.small, "maximize": task.large,
        "subject_to": [[name, *ends] for name, ends in task.limits.items()], "keep": task.keep, "of": further,
        "options": {word: np.asarray(value).tolist() for word, value in task.options.items()},
        "bins": [[name, *own.tolist()] for name, own in task.edges.items()], "version": installed_version(),
    }  # fmt: skip


def _parameter(task: Screening, name: str) -> str:
    """Return the parameter that names a result."""
    purposes = {1.0: "minimize", -1.0: "maximize"}
    return purposes.get(task.objectives.get(name, 0.0), "subject_to" if name in task.limits else "bins")


def _between(values: np.ndarray, count: int) -> np.ndarray:
    """Return evenly spaced edges from the least to the largest of the finite values."""
    finite = values[np.isfinite(values)]
    least, most = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    return np.unique(np.linspace(least, most, count))
