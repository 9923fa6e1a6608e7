"""The one sentence in which public functions state that a machine lacks a capability, and which machines have it."""

from __future__ import annotations

from linksweep.mechanisms.mechanism import MECHANISMS, Mechanism

CAPABILITIES = {
    "bodies": "links:",
    "pins": "pins:",
    "drives": "crank:",
    "engine_cylinder": "cylinder:",
    "position_equation": "position equation in document 2 (ME 470):",
    "stroke_findings": "closed form of its stroke or swing; take ls.peaks of its position, or",
    "drawing": "drawing of links (plot.loop draws a track):",
    "track": "track:",
    "balancing_moments": "closed form of balance; take ls.best_counterweights, or",
}
"""Attributes that `Mechanism` leaves empty and a machine may offer: its name in words, and another way to results."""


COMPUTED = ("engine_cylinder", "stroke_findings", "balancing_moments")
"""Attributes of `CAPABILITIES` that are computed from numbers: the class decides whether a machine has them."""


def offers(machine: Mechanism | type[Mechanism], capability: str) -> bool:
    """Return whether a machine, or a kind of machine, replaces the empty attribute of `Mechanism`."""
    kind = machine if isinstance(machine, type) else type(machine)
    attribute = getattr(kind if capability in COMPUTED else machine, capability)
    return bool(attribute) and attribute is not getattr(Mechanism, capability)


def lack(machine: Mechanism, capability: str) -> str:
    """Return "a LoopTrack, which has no pins: give another machine, …"; empty where it offers the capability."""
    others = ", ".join(name for name, other in MECHANISMS.items() if offers(other, capability))
    sentence = f"a {type(machine).__name__}, which has no {CAPABILITIES[capability]} give another machine ({others})"
    return "" if offers(machine, capability) else sentence
