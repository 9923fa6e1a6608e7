"""The one sentence in which public functions state that a machine lacks a capability, and which machines have it."""

from __future__ import annotations

from linksweep.mechanisms.mechanism import MECHANISMS, Mechanism

CAPABILITIES = {
    "bodies": "links:",
    "pins": "pins:",
    "drives": "crank:",
    "cylinder": "cylinder:",
    "position_equation": "position equation in document 2 (ME 470):",
    "stroke_findings": "closed form of its stroke or swing; take ls.peaks of its position, or",
    "drawing": "drawing of links (plot.loop draws a track):",
    "track": "track:",
    "balancing_moments": "closed form of balance; take ls.best_counterweights, or",
}
"""Attributes that `Mechanism` leaves empty and a machine may offer: its name in words, and another way to results."""


def offers(kind: type[Mechanism], capability: str) -> bool:
    """Return whether machines of a kind offer a capability: they replace the empty attribute of `Mechanism`."""
    attribute = getattr(kind, capability)
    return bool(attribute) and attribute is not getattr(Mechanism, capability)


def lack(machine: Mechanism | type[Mechanism], capability: str) -> str:
    """Return "a LoopTrack, which has no pins: give another machine, …"; empty where it offers the capability."""
    kind = machine if isinstance(machine, type) else type(machine)
    others = ", ".join(name for name, other in MECHANISMS.items() if offers(other, capability))
    sentence = f"a {kind.__name__}, which has no {CAPABILITIES[capability]} give another machine ({others})"
    return "" if offers(kind, capability) else sentence
