"""Limits of a chain of dyads: toggles, angles at which friction wedges a slide, and angles at which it turns round."""

from __future__ import annotations

from collections.abc import Collection

from linksweep.engine.quantity import Limit
from linksweep.mechanisms.chain.motion import Motion
from linksweep.mechanisms.dyads import rpr, rrp, rrr
from linksweep.mechanisms.dyads.names import Names
from linksweep.mechanisms.dyads.rrr import Rows
from linksweep.mechanisms.topology import RPR, RRP, RRR

TOGGLES = {RRR: rrr.TOGGLE, RRP: rrp.TOGGLE, RPR: rpr.TOGGLE}
"""Limit of each dyad that does not close everywhere, in its own names."""
SLIDES = {RRP: (rrp.grip(), rrp.SLIDE), RPR: (rpr.grip(), rpr.SLIDE)}
"""Rows and limits of each dyad with a slide that may rub, in its own names."""


def limits(motion: Motion, rubbing: Collection[str]) -> tuple[Rows, tuple[Limit, ...]]:
    """Return the limits of a chain whose slides on these guides rub, and rows of their signals."""
    rows: Rows = []
    toggles, of_slides = [], []
    for step in motion.topology.steps:
        if isinstance(step, RRR | RRP | RPR):
            names = motion.names[step.name]
            toggles.append(_placed(TOGGLES[type(step)], step.name, names))
        if isinstance(step, RRP | RPR) and step.guide in rubbing:
            of_friction, limited = SLIDES[type(step)]
            rows += names.placed(of_friction)
            of_slides += [_placed(limit, step.name, names) for limit in limited]
    return rows, (*toggles, *of_slides)


def _placed(limit: Limit, name: str, names: Names) -> Limit:
    """Return a dyad's limit under the names of its place in the chain."""
    signals, noise = (tuple(str(names[own]) for own in every) for every in (limit.signals, limit.noise))
    return Limit(name, signals, noise, limit.zeros)
