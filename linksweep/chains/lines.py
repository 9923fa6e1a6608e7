"""Place and forces of a link whose line passes a known pin (RPR), by a block with mass or without."""

from __future__ import annotations

from typing import TYPE_CHECKING

from linksweep.chains.dyads import rpr
from linksweep.chains.dyads.names import (
    NOTHING,
    Vector,
    block_sliding_of,
    direction_of,
    frame_of,
    full,
    of_force,
    of_link,
)
from linksweep.chains.rows.bodies import Source, xy
from linksweep.chains.shape import ORIGIN, Frame
from linksweep.chains.topology import RPR, Side
from linksweep.physics.algebra import planar
from linksweep.physics.closures import pins

if TYPE_CHECKING:
    from linksweep.chains.forces import Forces
    from linksweep.chains.motion import Motion


def place_RPR(motion: Motion, step: RPR) -> None:
    """Add rows of the place of a link whose line passes a known pin, and of the block that it carries there."""
    link, block, k = step.link, step.block, motion.number(step.link.role)
    special, slider = motion.on_crank_and_ground(step), step.block or step.link.role
    line, exact, pushed = xy(f"line{k}"), full(f"exact_line{k}"), f"push_{slider}_{step.pin}"
    numbers = {} if motion.plain else _offset(motion, step) | {"friction": f"{step.guide}_friction"}
    motion.link(link.role, Frame(link.pin, exact, direction_of(step.guide)), {link.pin})
    _line_of_pins(motion, step, line)
    if block:
        motion.slider(block, step.pin, {"guide_cos": line[0], "guide_sin": line[1]}, link.role)
    motion.close(
        step,
        rpr.on_crank_and_ground(step.name in motion.shape.turned) if special else rpr.between_pins(),
        rpr.CERTAIN_ON_CRANK if special else rpr.CERTAIN,
        rpr.CERTAIN_BEYOND,
        {} if motion.plain else frame_of("ground", link.pin),
        numbers | motion.pin("B", step.pin) | motion.pin("D", link.pin) | of_link(4, k),
        motion.load(4, k, f"L{k}_{link.pin}"),
        motion.load(3, motion.number(block), f"L{motion.number(block)}") if block else NOTHING,
        dict(zip(full("line_"), exact, strict=True)),
        {"r3x": line[0], "r3y": line[1]},
        {} if motion.plain else block_sliding_of(slider),
        of_force("F43", f"line_force_{slider}"),
        of_force("F32", pushed),
        of_force("F14", f"hold_{link.role}"),
    )
    motion.measure(step, f"acute angle between the line {link.pin}-{step.pin} and the normal of the {link.role}")
    of_slide = ("slide", "slide_velocity", "slide_acceleration")
    motion.slides_of(step, slider, of_slide, f"{link.role}'s line", f"the foot of {link.pin} on it")


def force_RPR(forces: Forces, step: RPR) -> None:
    """Add rows of the forces of such a link and its block."""
    slider, host = step.block or step.link.role, step.block or forces.topology.members[step.pin][0]
    forces.act_about(step.link)
    if step.block:
        forces.act(step.block)
    forces.contact(step, rpr, (step.guide, rpr.CONTACT, "ratio_slide"))
    forces.push(Side(slider, step.pin))
    forces.release(step.link)
    slide = rpr.CONTACT if step.block else rpr.CONTACT._replace(moment="")
    forces.between(step.link.role, host, f"line_force_{slider}", step.name, slide)


def _line_of_pins(motion: Motion, step: RPR, line: Vector) -> None:
    """Add rows of a link's axes from the direction of its guide."""
    role, k = step.link.role, motion.number(step.link.role)
    if step.guide not in motion.shape.inclined:
        motion.row(planar.along, xy(f"r{k}"), f"{role}_length", *line)
        return
    second = motion.topology.links[role][1]
    motion.row(pins.quotient, full(f"quotient_of_line{k}"), *motion.own(role, second), *direction_of(step.guide))
    motion.row(pins.turned, xy(f"r{k}"), *xy(f"quotient_of_line{k}"), *line)
    motion.certain |= dict.fromkeys(xy(f"quotient_of_line{k}"), f"{role}_length")


def _offset(motion: Motion, step: RPR) -> dict[str, Source]:
    """Return the names of the guide's offset from the known pin of its link."""
    offset = (f"{step.guide}_offset", f"{step.guide}_offset_lo")
    own = motion.own(step.link.role, step.link.pin)
    if own != ORIGIN:
        from_pin = (f"offset_{step.name}", f"offset_{step.name}_lo")
        motion.row(pins.offset_from, from_pin, *offset, *direction_of(step.guide), *own)
        offset = from_pin
    return dict(zip(("offset", "offset_lo"), offset, strict=True))
