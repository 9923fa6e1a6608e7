"""Topologies of random linkages: their text, how they are sketched, and what may drive them."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import NamedTuple

from benchmarks.stress.linkages.sketch import Sketch


class Topology(NamedTuple):
    """The text of a linkage, a function that draws its pins, and its drives other than the crank."""

    text: str
    draw: Callable[[Sketch], None]
    drives: tuple[str, ...] = ()


class Family(NamedTuple):
    """Random linkages of a topology, driven by one of its links or cylinders, "" is the crank; with a pin near a toggle
    in `near`."""

    topology: Topology
    drive: str = ""
    near: str = ""


def four_bar(sketch: Sketch) -> None:
    sketch.crank()
    sketch.ground("D", "B")
    sketch.rrr("C", "B", "D")


def watt_1(sketch: Sketch) -> None:
    four_bar(sketch)
    sketch.carried("E", "B", "C")
    sketch.carried("F", "D", "C")
    sketch.rrr("G", "E", "F")


def watt_2(sketch: Sketch) -> None:
    four_bar(sketch)
    sketch.carried("E", "D", "C")
    sketch.ground("G", "E")
    sketch.rrr("F", "E", "G")


def stephenson_1(sketch: Sketch) -> None:
    four_bar(sketch)
    sketch.carried("E", "A", "B")
    sketch.carried("F", "D", "C")
    sketch.rrr("G", "E", "F")


def stephenson_3(sketch: Sketch) -> None:
    four_bar(sketch)
    sketch.carried("E", "B", "C")
    sketch.ground("G", "E")
    sketch.rrr("F", "E", "G")


def slider_six_bar(sketch: Sketch) -> None:
    four_bar(sketch)
    sketch.carried("E", "D", "C")
    sketch.rrp("F", "E", "slide")


def knuckle_press(sketch: Sketch) -> None:
    four_bar(sketch)
    sketch.rrp("E", "C", "slide")


def other_orders(sketch: Sketch) -> None:
    """Known pins are second or third of their links, and so are those that dyads find."""
    four_bar(sketch)
    sketch.carried("E", "C", "B")
    sketch.ground("F", "E")
    sketch.rrr("G", "E", "F")
    sketch.carried("H", "G", "F")


def block_on_coupler(sketch: Sketch) -> None:
    four_bar(sketch)
    sketch.ground("G", "C")
    sketch.rrp_on_link("F", "G", "coupler", "B", "C")


def arm_past_coupler(sketch: Sketch) -> None:
    four_bar(sketch)
    sketch.carried("E", "B", "C")
    sketch.ground("G", "E")
    sketch.line_through("arm", "G", "H", "E", "arm")


def shaper(sketch: Sketch) -> None:
    """A block of mass on the crank's pin slides along the arm."""
    sketch.crank()
    sketch.ground("D", "B")
    sketch.line_through("arm", "D", "E", "B", "arm")
    sketch.rrp("F", "E", "slide")


def shaper_with_two_slides(sketch: Sketch) -> None:
    """A second block joins the arm and the ram."""
    sketch.crank()
    sketch.ground("D", "B")
    sketch.line_through("arm", "D", "E", "B", "arm")
    sketch.on_line("F", "arm", "B")
    sketch.guide("slide", "F", sketch.across("arm"))


def scotch_yoke(sketch: Sketch) -> None:
    """A yoke, and a rod and lever on the crank's third pin."""
    sketch.crank()
    sketch.carried("C", "A", "B")
    sketch.yoke("yoke", "slide", "B")
    sketch.ground("D", "C")
    sketch.rrr("E", "C", "D")


def jansen_leg(sketch: Sketch) -> None:
    four_bar(sketch)
    sketch.carried("E", "D", "C")
    sketch.rrr("F", "B", "D")
    sketch.rrr("G", "E", "F")
    sketch.carried("H", "F", "G")


def held_at(sketch: Sketch, start: str) -> None:
    """Two sides that meet at K, from the rocker and from the ground; the one from `start` is a held cylinder."""
    four_bar(sketch)
    sketch.carried("E", "D", "C")
    sketch.ground("G", "E")
    sketch.rrr("K", "E", "G")
    sketch.cylinder("held", start, "K")


def held_cylinder(sketch: Sketch) -> None:
    """A stick on the rocker, held by a cylinder from the ground; another cylinder follows, or drives."""
    held_at(sketch, "G")
    sketch.ground("H", "C")


def geared_five_bar(sketch: Sketch, ratio: Fraction = Fraction(-2)) -> None:
    sketch.theta2 *= ratio.denominator  # over the turns after which all repeats
    sketch.crank()
    sketch.ground("D", "B")
    sketch.wheel("wheel", "D", "E", float(ratio))
    sketch.rrr("C", "B", "E")


TOPOLOGIES = {
    "Watt I": Topology("crank A-B, coupler B-C-E, rocker D-C-F, link E-G, arm F-G", watt_1, ("rocker",)),
    "Watt II": Topology("crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F", watt_2, ("rocker", "output")),
    "Stephenson I": Topology("crank A-B-E, coupler B-C, rocker D-C-F, left E-G, right F-G", stephenson_1, ("rocker",)),
    "Stephenson III": Topology(
        "crank A-B, coupler B-C-E, rocker D-C, rod E-F, output G-F", stephenson_3, ("rocker", "output")
    ),
    "six-bar with a slider": Topology(
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, ram F on slide", slider_six_bar, ("rocker",)
    ),
    "knuckle-joint press": Topology(
        "crank A-B, rod B-C, upper D-C, lower C-E, ram E on slide", knuckle_press, ("upper",)
    ),
    "pins in other orders": Topology(
        "crank A-B, coupler C-B-E, rocker C-D, left G-E, right H-G-F", other_orders, ("rocker", "right")
    ),
    "block on a coupler": Topology(
        "crank A-B, coupler B-C, rocker D-C, rod G-F, block F on coupler", block_on_coupler, ("rocker", "rod")
    ),
    "arm past a coupler": Topology(
        "crank A-B, coupler B-C-E, rocker D-C, arm G-H past E", arm_past_coupler, ("rocker", "arm")
    ),
    "shaper with a block of mass": Topology(
        "crank A-B, block B on arm, arm D-E, rod E-F, ram F on slide", shaper, ("arm",)
    ),
    "Whitworth": Topology("crank A-B, arm D-E past B, rod E-F, ram F on slide", shaper, ("arm",)),
    "shaper with two slides": Topology(
        "crank A-B, arm D-E past B, block F on arm, ram F on slide", shaper_with_two_slides, ("arm",)
    ),
    "scotch yoke": Topology("crank A-B-C, yoke on slide past B, rod C-E, lever D-E", scotch_yoke, ("lever",)),
    "Jansen leg": Topology("crank A-B, j B-C, top D-C-E, k B-F, c D-F, f E-G, foot F-G-H", jansen_leg, ("top", "c")),
    "held cylinder": Topology(
        "crank A-B, coupler B-C, rocker D-C-E, stick E-K, held G~K, jack H~C", held_cylinder, ("rocker", "jack")
    ),
    "geared five-bar": Topology("crank A-B, wheel D-E : -2 crank, left B-C, right E-C", geared_five_bar, ("wheel",)),
}

FAMILIES = {name: Family(topology) for name, topology in TOPOLOGIES.items()} | {
    f"{name}, {drive} drives": Family(topology, drive)
    for name, topology in TOPOLOGIES.items()
    for drive in topology.drives
}
"""Families of random linkages by name: the topologies, and those with another drive than the crank."""

PINS_NEAR_A_TOGGLE = {
    "Watt I": "CG", "Watt II": "CF", "Stephenson III": "F", "six-bar with a slider": "CF", "pins in other orders": "G",
    "knuckle-joint press": "E", "shaper with a block of mass": "F", "Whitworth": "F", "Jansen leg": "FG",
}  # fmt: skip
NEAR_A_TOGGLE = {
    f"{name}, near a toggle at {pin}": Family(TOPOLOGIES[name], near=pin)
    for name, pins in PINS_NEAR_A_TOGGLE.items()
    for pin in pins
}
"""Families of which a pin is near a toggle."""

GEARED_BY_FRACTIONS = {
    f"geared five-bar, {ratio}": Family(
        Topology(
            f"crank A-B, wheel D-E : {ratio} crank, left B-C, right E-C",
            partial(geared_five_bar, ratio=Fraction(ratio)),
            ("wheel",),
        ),
        drive,
    )
    for ratio, drive in {"1/2": "", "3/2": "", "-2/3": "", "5/4": "wheel"}.items()
}
"""Families whose motion repeats only after several turns of the crank."""

JACKS = {
    "six-bar with a slider": "F", "knuckle-joint press": "E", "block on a coupler": "F", "arm past a coupler": "H",
    "Whitworth": "F", "shaper with a block of mass": "F", "shaper with two slides": "F",
}  # fmt: skip
"""Pin of each topology that a cylinder pushes."""


def with_jack(name: str, pin: str) -> Family:
    """Return a topology driven by a cylinder from the ground to one of its pins."""
    text, draw, _ = TOPOLOGIES[name]

    def with_its_pin(sketch: Sketch) -> None:
        draw(sketch)
        sketch.ground("J", pin)

    return Family(Topology(f"{text}, jack J~{pin}", with_its_pin), "jack")


def held_arm(sketch: Sketch) -> None:
    """An arm on the ground, held at the rocker by a cylinder of given length."""
    held_at(sketch, "E")


COUPLED = {f"{name}, jack drives": with_jack(name, pin) for name, pin in JACKS.items()} | {
    "held arm, arm drives": Family(Topology("crank A-B, coupler B-C, rocker D-C-E, held E~K, arm G-K", held_arm), "arm")
}
"""Families whose drive loads one slide with friction or more, or a cylinder of given length, and depends on them."""

ALL = FAMILIES | NEAR_A_TOGGLE | GEARED_BY_FRACTIONS | COUPLED
AWAY_FROM_TOGGLES = {name: family for name, family in ALL.items() if name not in NEAR_A_TOGGLE}
"""All families; and those that are near toggles only by chance."""
