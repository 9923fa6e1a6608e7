"""From the text of a linkage to its dyads, written by hand from sketches; or to sentences that state what to change."""

from fractions import Fraction

import pytest

from linksweep.chains.topology import GROUND, PRP, RPP, RPR, RRP, RRR, Gear, Side, topology

SLIDE = (("slide", GROUND),)
FOUR_BAR = "crank A-B, rod B-C, rocker D-C"


def of(links: str, ground: str = "AD", hosts=SLIDE, ratios=(), struts=()):
    """Return the topology of a sound text."""
    machine, problems = topology(links, tuple(ground), hosts if "slide" in links else (), ratios, frozenset(struts))
    assert problems == ()
    return machine


def meet(first: str, second: str, pin: str) -> RRR:
    """Return two links, each as "rod B", that meet at a pin."""
    return RRR(Side(*first.split()), Side(*second.split()), pin)


RAM = RRP(Side("rod", "E"), "ram", "F", "slide")

MACHINES = {
    "Watt I": (
        "crank A-B, coupler B-C-E, rocker D-C-F, rod E-G, output F-G",
        "AD",
        [meet("coupler B", "rocker D", "C"), meet("rod E", "output F", "G")],
    ),
    "Watt II": (
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F",
        "ADG",
        [meet("coupler B", "rocker D", "C"), meet("rod E", "output G", "F")],
    ),
    "Stephenson I": (
        "crank A-B-E, coupler B-C, rocker D-C-F, rod E-G, link F-G",
        "AD",
        [meet("coupler B", "rocker D", "C"), meet("rod E", "link F", "G")],
    ),
    "Stephenson III": (
        "crank A-B, coupler B-C-E, rocker D-C, rod E-F, output G-F",
        "ADG",
        [meet("coupler B", "rocker D", "C"), meet("rod E", "output G", "F")],
    ),
    "knuckle-joint press": (
        "crank A-B, rod B-C, upper D-C, lower C-E, ram E on slide",
        "AD",
        [meet("rod B", "upper D", "C"), RRP(Side("lower", "C"), "ram", "E", "slide")],
    ),
    "crank-shaper, Whitworth quick return": (
        "crank A-B, arm D-E past B, rod E-F, ram F on slide",
        "AD",
        [RPR(Side("arm", "D"), "", "B", "arm"), RAM],
    ),
    "block with mass": (
        "crank A-B, block B on arm, arm D-E, rod E-F, ram F on slide",
        "AD",
        [RPR(Side("arm", "D"), "block", "B", "arm"), RAM],
    ),
    "drag-link press": (
        "crank A-B, coupler B-C, rocker D-C-E, rod E-F, ram F on slide",
        "AD",
        [meet("coupler B", "rocker D", "C"), RAM],
    ),
    "pump jack": (
        "crank A-B, pitman B-C, beam D-C-E",
        "AD",
        [meet("pitman B", "beam D", "C")],
    ),
    "Jansen leg": (
        "crank A-B, upper B-C, triangle D-C-E, lower B-F, strut D-F, link E-G, foot F-G-H",
        "AD",
        [meet("upper B", "triangle D", "C"), meet("lower B", "strut D", "F"), meet("link E", "foot F", "G")],
    ),
    "Klann leg": (
        "crank A-B, coupler B-C-E, rocker D-C, leg E-F-H, upper G-F",
        "ADG",
        [meet("coupler B", "rocker D", "C"), meet("leg E", "upper G", "F")],
    ),
    "pair of wipers": (
        "crank A-B, rod B-C, left D-C-E, bar E-F, right G-F",
        "ADG",
        [meet("rod B", "left D", "C"), meet("bar E", "right G", "F")],
    ),
    "scissor lift": (
        "crank A-B-M, arm C-M-E, foot C on slide, table B-F, roller E on table",
        "A",
        [RRP(Side("arm", "M"), "foot", "C", "slide"), RPR(Side("table", "B"), "roller", "E", "table")],
    ),
    "scotch yoke": ("crank A-B, yoke on slide past B", "A", [RPP("yoke", "slide", "B")]),
    "geared five-bar": (
        "crank A-B, wheel2 D-E : -3/2 crank, rod B-C, arm E-C",
        "AD",
        [Gear(Side("wheel2", "D"), Fraction(-3, 2)), meet("rod B", "arm E", "C")],
    ),
    "two sliders at a pin": (
        "crank A-B, ram C on slide, block C on crank",
        "A",
        [PRP("ram", "block", "C", "slide", "crank")],
    ),
    "last first": (
        "crank A-B, ram F on slide, rod F-E, rocker C-D-E, coupler C-B",
        "AD",
        [meet("rocker D", "coupler B", "C"), RRP(Side("rod", "E"), "ram", "F", "slide")],
    ),
}

EXCAVATOR = (
    "boom A-B-E-F, c1 P~B, stick E-M-G-H-K, c2 F~G, rocker K-J, c3 H~J, link J-L, bucket M-L-T",
    "AP",
    [meet("stick E", "c2 F", "G"), meet("rocker K", "c3 H", "J"), meet("link J", "bucket M", "L")],
)


@pytest.mark.parametrize("name", MACHINES)
def test_dyads_of(name):
    links, ground, steps = MACHINES[name]
    assert list(of(links, ground).steps) == steps


def test_cylinders_of_given_length_are_links_and_the_one_that_follows_is_none():
    links, ground, steps = EXCAVATOR
    machine = of(links, ground, struts=("c2", "c3"))
    assert list(machine.steps) == steps
    assert machine.roles == ("boom", "stick", "rocker", "link", "bucket")
    assert machine.members["G"] == ("stick",) and "G" not in machine.pins
    assert machine.support["J"] == "rocker" and machine.support["G"] == "stick"
    assert any("degrees of freedom" in problem for problem in topology(links, tuple(ground))[1])


def test_a_cylinder_of_given_length_may_end_at_a_slider():
    machine = of("crank A-B, c1 B~C, ram C on slide", "A", struts=("c1",))
    assert list(machine.steps) == [RRP(Side("c1", "B"), "ram", "C", "slide")]
    assert machine.support["C"] == "ram"


def test_a_guide_may_be_on_a_link_beside_its_line_of_pins():
    machine, none = topology("crank A-B, arm D-E, block B on groove", ("A", "D"), (("groove", "arm"),))
    assert none == () and machine.steps == (RPR(Side("arm", "D"), "block", "B", "groove"),)
    assert machine.hosts == {"groove": "arm"} and machine.slides == {"groove": (4, 3)}


def test_links_are_numbered_in_the_order_of_the_text_without_cylinders():
    machine = of("crank A-B, c1 D~C, rod B-C, ram C on slide", "AD")
    assert [machine.number(role) for role in (GROUND, "crank", "rod", "ram")] == [1, 2, 3, 4]
    assert machine.crank == "crank"


def test_forces_are_of_the_ground_or_of_the_later_link_and_the_first_named_carries_a_shared_pin():
    machine = of(*MACHINES["Jansen leg"][:2])
    assert machine.members["D"] == (GROUND, "triangle", "strut")
    assert machine.members["F"] == ("lower", "strut", "foot")
    assert machine.pins == {
        "A": (1, 2), "B:upper": (3, 2), "B:lower": (5, 2), "C": (4, 3), "D:triangle": (1, 4), "D:strut": (1, 6),
        "E": (7, 4), "F:strut": (6, 5), "F:foot": (8, 5), "G": (8, 7),
    }  # fmt: skip
    assert machine.journals == {
        "A": 2, "B:upper": 2, "B:lower": 2, "C": 3, "D:triangle": 4, "D:strut": 6,
        "E": 4, "F:strut": 5, "F:foot": 5, "G": 7,
    }  # fmt: skip
    carried = {"B": "crank", "C": "upper", "E": "triangle", "F": "lower", "G": "link", "H": "foot"}
    assert machine.support == {"A": GROUND, "D": GROUND, **carried}
    assert machine.points == {"E": "triangle", "H": "foot"}


def test_forces_in_slides_are_named_by_their_guides():
    assert of(*MACHINES["crank-shaper, Whitworth quick return"][:2]).slides == {"slide": (1, 5), "arm past B": (3, 2)}
    assert of(*MACHINES["block with mass"][:2]).slides == {"arm": (4, 3), "slide": (1, 6)}
    assert of(*MACHINES["scotch yoke"][:2]).slides == {"slide": (1, 3), "yoke past B": (3, 2)}
    shared = of("crank A-B, rod B-C, ram C on slide, link C-E, tail E on slide", "A")
    assert shared.slides == {"slide:ram": (1, 4), "slide:tail": (1, 6)}
    assert shared.pins["C:ram"] == (4, 3) and shared.pins["C:link"] == (5, 3)


def test_a_ratio_may_stand_among_the_gears():
    links = "crank A-B, wheel2 D-E : crank, rod B-C, arm E-C"
    assert of(links, ratios=(("wheel2", "1/2"),)).gears == {"wheel2": Fraction(1, 2)}


def test_spaces_and_lines_mean_nothing():
    spaced = of("crank A - B,\n  wheel2 D-E:-2 crank , rod B-C,arm  E -C")
    assert spaced.links == of("crank A-B, wheel2 D-E : -2 crank, rod B-C, arm E-C").links


@pytest.mark.parametrize(
    ("links", "ground", "names"),
    [
        ("crank A-B, f B-C-E, g C-F, h E-G, rocker D-F-G", "AD", "f, g, h, rocker"),
        ("crank D-F-G, g C-F, h E-G, f B-C-E, rocker A-B", "DA", "g, h, f, rocker"),
        ("crank A-B, f B-C-E, g C-F, h E-G, rocker D-F-G-H, bar H-K, ram K on slide", "AD", "f, g, h, rocker"),
    ],
)
def test_stephenson_2_closes_by_no_dyads_from_either_crank(links, ground, names):
    hosts = SLIDE if "slide" in links else ()
    line = f"links: {names} close only together: no dyad finds them; give them another joint or crank"
    assert topology(links, tuple(ground), hosts)[1] == (line,)
