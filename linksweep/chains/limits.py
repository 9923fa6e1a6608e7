"""Limits of a chain of dyads: toggles, angles at which friction wedges a slide, and angles at which it turns round."""

from __future__ import annotations

from collections.abc import Collection

from linksweep.chains.dyads import prp, rpp, rpr, rrp, rrr
from linksweep.chains.dyads.names import Names
from linksweep.chains.dyads.rrr import Rows
from linksweep.chains.motion import Motion
from linksweep.chains.topology import PRP, RPP, RPR, RRP, RRR, Step
from linksweep.engine.quantity import Limit

TOGGLES = {RRR: rrr.TOGGLE, RRP: rrp.TOGGLE, RPR: rpr.TOGGLE, PRP: prp.TOGGLE}
"""Limit of each dyad that does not close everywhere, in its own names."""
GRIPS = {RRP: rrp.grip(), RPR: rpr.grip(), PRP: prp.grip()}
"""Rows of each dyad with a slide that may rub, in its own names."""


def limits(motion: Motion, rubbing: Collection[str]) -> tuple[Rows, tuple[Limit, ...]]:
    """Return the limits of a chain whose slides on these guides rub, and rows of their signals."""
    rows: Rows = []
    toggles, of_slides = [], []
    for step in motion.topology.steps:
        names = motion.names[step.name]
        if type(step) in TOGGLES:
            toggles.append(_placed(TOGGLES[type(step)], step.name, names))
        limited = [limit for slide, of_slide in _slides(step) if slide in rubbing for limit in of_slide]
        if limited:
            rows += names.placed(GRIPS.get(type(step), ()))
            of_slides += [_placed(limit, step.name, names) for limit in limited]
    return rows, (*toggles, *of_slides)


def _slides(step: Step) -> list[tuple[str, tuple[Limit, ...]]]:
    """Return the slides of a dyad, by their guides, and the limits of friction in each."""
    if isinstance(step, RRP | RPR):
        return [(step.guide, rrp.SLIDE if isinstance(step, RRP) else rpr.SLIDE)]
    if isinstance(step, RPP):
        return [(step.guide, rpp.SLIDE), (f"{step.slider}_slot", rpp.SLOT)]
    if isinstance(step, PRP):
        return [(step.first_guide, prp.SLIDE), (step.second_guide, prp.SECOND_SLIDE)]
    return []


def _placed(limit: Limit, name: str, names: Names) -> Limit:
    """Return a dyad's limit under the names of its place in the chain."""
    signals, noise = (tuple(str(names[own]) for own in every) for every in (limit.signals, limit.noise))
    return Limit(name, signals, noise, limit.zeros)
