"""Limits of a chain of dyads: toggles, angles at which friction wedges a slide, and angles at which it turns round."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import NamedTuple

from linksweep.chains.dyads import prp, rpp, rpr, rrp, rrr
from linksweep.chains.dyads.names import Names
from linksweep.chains.dyads.rrr import Rows
from linksweep.chains.motion import Motion
from linksweep.chains.topology import PRP, RPP, RPR, RRP, RRR, Step
from linksweep.engine.quantity import Limit

TOGGLES = {RRR: rrr.TOGGLE, RRP: rrp.TOGGLE, RPR: rpr.TOGGLE, PRP: prp.TOGGLE}
"""Limit of each dyad that does not close everywhere, in its own names."""
SLIDES: dict[type[Step], tuple[tuple[Limit, ...], ...]] = {
    RRP: (rrp.SLIDE,),
    RPR: (rpr.SLIDE,),
    PRP: (prp.SLIDE, prp.SECOND_SLIDE),
    RPP: (rpp.SLIDE, rpp.SLOT),
}
"""Limits of friction in each slide of a dyad, in its own names."""
GRIPS = {RRP: rrp.grip(), RPR: rpr.grip(), PRP: [*prp.grip(), *prp.edges()], RPP: rpp.edges()}
"""Rows of each dyad with a slide that may rub, in its own names."""
CONTACTS = {PRP: prp.BOTH, RPP: rpp.BOTH}
"""Limit of each dyad with two contacts that share a force, in its own names."""


class Limits(NamedTuple):
    """Limits of a chain and rows of their signals: those of its motion and, where they depend on the forces too, those
    of its contacts."""

    rows: Rows
    of_motion: tuple[Limit, ...]
    of_contacts: tuple[Limit, ...]


def limits(motion: Motion, rubbing: Collection[str], coupled: Callable[[Step], bool]) -> Limits:
    """Return the limits of a chain whose slides on these guides rub.

    The slides of a `coupled` dyad jam only together with the drive, whose limits those are.
    """
    rows: Rows = []
    toggles, of_slides, of_contacts = [], [], []
    for step in motion.topology.steps:
        names = motion.names[step.name]
        if type(step) in TOGGLES:
            toggles.append(_placed(TOGGLES[type(step)], step.name, names))
        of_each = zip(step.slides, SLIDES.get(type(step), ()), strict=True)
        limited = [limit for slide, of_slide in of_each if slide in rubbing for limit in of_slide]
        if coupled(step):
            of_slides += [_placed(limit, step.name, names) for limit in limited if limit.zeros == "jump"]
        elif limited:
            rows += names.placed(GRIPS[type(step)])
            of_slides += [_placed(limit, step.name, names) for limit in dict.fromkeys(limited)]
            of_contacts += [_placed(CONTACTS[type(step)], step.name, names)] if type(step) in CONTACTS else []
    return Limits(rows, (*toggles, *of_slides), tuple(of_contacts))


def _placed(limit: Limit, name: str, names: Names) -> Limit:
    """Return a dyad's limit under the names of its place in the chain."""
    signals, noise = (tuple(str(names[own]) for own in every) for every in (limit.signals, limit.noise))
    return Limit(name, signals, noise, limit.zeros)
