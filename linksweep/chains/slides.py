"""Place and forces of dyads with two slides: a slider with a slot (RPP), two sliders that share a pin (PRP)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from linksweep.chains.dyads import prp, rpp
from linksweep.chains.dyads.names import of_force, of_link, of_pin, sliding_of
from linksweep.chains.rows.bodies import Source
from linksweep.chains.topology import PRP, RPP, Side
from linksweep.engine.quantity import Quantity

if TYPE_CHECKING:
    from linksweep.chains.forces import Forces
    from linksweep.chains.motion import Motion


def place_RPP(motion: Motion, step: RPP) -> None:
    """Add rows of the place of a slider with a slot."""
    slider, k, centre = step.slider, motion.number(step.slider), f"{step.slider}_"
    guide = motion.guide(step.guide)
    motion.rates(centre)
    motion.slider(slider, centre, guide, motion.topology.hosts[step.guide])
    motion.close(
        step,
        rpp.between_pin_and_guide(),
        {},
        {},
        motion.on_guide(step.guide, guide),
        motion.pin("B", step.pin) | of_pin("C", centre) | of_link(4, k) | motion.load(4, k, f"L{k}"),
        {f"slot_{part}": f"{slider} slot_{part}" for part in ("cos", "sin", "friction")},
        sliding_of("slider", slider),
        of_force("F14", f"hold_{slider}") | of_force("F42", f"push_{slider}_{step.pin}"),
    )
    motion.measure(step, f"acute angle between guide and slot of the {slider}")
    motion.slides_on(step, slider, "slider", step.guide)
    place = f"position from {motion.topology.ground[0]} of the point where the slot of the {slider} crosses its guide"
    motion.quantities += [Quantity(f"{centre}{axis}", "m", f"{place}, along {axis}") for axis in "xy"]


def force_RPP(forces: Forces, step: RPP) -> None:
    """Add rows of the forces of a slider with a slot."""
    slider, host = step.slider, forces.topology.members[step.pin][0]
    forces.act(slider)
    in_slot = (f"{slider} slot", rpp.SLOT_CONTACT, "ratio_in_slot")
    forces.contact(step, rpp, (step.guide, rpp.CONTACT, "ratio_slider"), in_slot)
    forces.push(Side(slider, step.pin))
    forces.slide(slider, step.guide, f"hold_{slider}", step.name, rpp.CONTACT)
    forces.between(slider, host, f"push_{slider}_{step.pin}", step.name, rpp.SLOT_CONTACT)


def place_PRP(motion: Motion, step: PRP) -> None:
    """Add rows of the place of two sliders that share a pin."""
    first, second, X = step.first, step.second, step.pin
    numbers = motion.number(first), motion.number(second)
    sliders = (first, step.first_guide), (second, step.second_guide)
    guides = [motion.guide(guide) for _, guide in sliders]
    motion.rates(X)
    for (slider, guide), names in zip(sliders, guides, strict=True):
        motion.slider(slider, X, names, motion.topology.hosts[guide])
    motion.close(
        step,
        prp.between_guides(),
        prp.CERTAIN,
        prp.CERTAIN_BEYOND,
        motion.on_guide(step.first_guide, guides[0]),
        second_of(motion.on_guide(step.second_guide, guides[1], "P")),
        of_pin("C", X) | sliding_of("slider", first) | sliding_of("second", second),
        *(of_link(d, k) | motion.load(d, k, f"L{k}") for d, k in zip((3, 4), numbers, strict=True)),
        of_force("F13", f"hold_{first}") | of_force("F14", f"hold_{second}") | of_force("F43", f"push_{second}_{X}"),
    )
    motion.measure(step, f"acute angle between the guides of {first} and {second}")
    motion.slides_on(step, first, "slider", step.first_guide)
    motion.slides_on(step, second, "second", step.second_guide)


def force_PRP(forces: Forces, step: PRP) -> None:
    """Add rows of the forces of two sliders that share a pin."""
    for slider in step.roles:
        forces.act(slider)
    second = (step.second_guide, prp.SECOND_CONTACT, "ratio_second")
    forces.contact(step, prp, (step.first_guide, prp.CONTACT, "ratio_slider"), second)
    forces.meet(step.first, step.second, step.pin)
    forces.slide(step.first, step.first_guide, f"hold_{step.first}", step.name, prp.CONTACT)
    forces.slide(step.second, step.second_guide, f"hold_{step.second}", step.name, prp.SECOND_CONTACT, ("PCx", "PCy"))


def second_of(names: Mapping[str, Source]) -> dict[str, Source]:
    """Return the names of a guide as the second of its dyad."""
    own = ("guide", "offset", "friction")
    return {f"second_{name}" if name.startswith(own) else name: source for name, source in names.items()}
