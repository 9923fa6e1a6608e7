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


def problems(links: str, ground: str = "AD", hosts=(), ratios=(), struts=(), reserved=()) -> list[str]:
    return [*topology(links, tuple(ground), hosts, ratios, frozenset(struts), frozenset(reserved))[1]]


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
    assert any("degrees of freedom" in problem for problem in problems(links, ground))


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
    assert problems(links, ground, hosts) == [line]


def loose(role: str, end: str) -> str:
    return f"links: {role} hangs loose: hold {end} by another link or on the ground, or leave {role} out"


HELD = "is held by one joint too many: leave out one of its pins or slides, or the link"
STUCK = "links: no degree of freedom: nothing can move; one link less, or one pin less on a link"
FREE = "links: 2 degrees of freedom: one more crank, or one link less"


@pytest.mark.parametrize(
    ("links", "lines"),
    [
        (f"{FOUR_BAR}, bar C-E", [FREE, loose("bar", "its pin E")]),
        (f"{FOUR_BAR}, rod2 B-C", [STUCK, f"links: rod2 {HELD}"]),
        (f"{FOUR_BAR}, bar B-D", [STUCK, f"links: bar {HELD}"]),
        (
            f"{FOUR_BAR}, bar B-D, rod2 B-C",
            [f"links: 2 constraints too many: {STUCK.partition('freedom: ')[2]}"]
            + [f"links: {role} {HELD}" for role in ("bar", "rod2")],
        ),
        (
            f"{FOUR_BAR}, plate B-D-E, bar C-E",
            [f"links: 2 constraints too many: {STUCK.partition('freedom: ')[2]}", f"links: plate {HELD}"],
        ),
        (f"{FOUR_BAR}, bar B-D, rod2 C-E", [f"links: bar {HELD}", loose("rod2", "its pin E")]),
        (
            "crank A-B, b B-C, c C-E, d D-E",
            [FREE, "links: b, c, d can move while the crank stands: hold one by another link"],
        ),
        (
            f"{FOUR_BAR}, bar P-Q",
            ["links: 4 degrees of freedom: 3 more cranks, or fewer links", loose("bar", "its pin P or Q")],
        ),
    ],
)
def test_wrong_mobility(links, lines):
    assert problems(links) == lines


def test_cylinders_that_hold_too_much():
    line = "links: both pins of c1 have their places without it: give it no length, or leave it out"
    assert problems(f"{FOUR_BAR}, c1 D~B", struts=("c1",)) == [STUCK, line]
    assert problems(f"{FOUR_BAR}, c1 C~D") == [
        "links: both pins of c1 are on rocker, so that its length is fixed: leave it out"
    ]


LINK = "a link is written by two pins or more, each a capital letter that digits may follow, as rod B-C"


@pytest.mark.parametrize(
    ("part", "sentence"),
    [
        ("", LINK),
        ("rod", LINK),
        ("rod B", LINK),
        ("rod b-c", LINK),
        ("rod B-", LINK),
        ("2rod B-C", LINK),
        ("B-C", LINK),
        ("ram on slide", "a slider is written as ram F on slide"),
        ("ram F-G on slide", "a slider is written as ram F on slide"),
        ("ram F on", "a slider is written as ram F on slide"),
        ("yoke on slide past b", "a yoke is written as yoke on slide past B"),
        ("arm D-E past", "a link past a pin is written as arm D-E past B"),
        ("arm past B", "a link past a pin is written as arm D-E past B"),
        ("c1 P~", "a cylinder is written as c1 P~B"),
        ("c1 P~Q~R", "a cylinder is written as c1 P~B"),
        ("wheel D-E :", "a wheel is written as wheel D-E : -2 crank"),
        ("wheel D-E : 1.5 crank", "a wheel is written as wheel D-E : -2 crank"),
        ("wheel D-E : 1/0 crank", "a wheel is written as wheel D-E : -2 crank"),
    ],
)
def test_a_part_that_cannot_be_read_is_quoted(part, sentence):
    machine, lines = topology(f"crank A-B, {part}, rod B-C", ("A",))
    assert machine is None and lines == (f'links: "{part}" cannot be read: {sentence}',)


def test_all_parts_that_cannot_be_read_are_quoted_at_once():
    assert len(problems("crank A, rod B-C, rod C-D, c1 D")) == 3


TAKEN = "has a meaning of its own in linksweep or Python: give the link another name"


@pytest.mark.parametrize(
    ("links", "line"),
    [
        (f"{FOUR_BAR}, rod C-E", 'links: "rod" is named twice: give each link, slider and cylinder its own name'),
        (f"{FOUR_BAR}, bar C-C", "links: bar names pin C twice: name each pin of a link once"),
        (f"{FOUR_BAR}, c1 C~C", "links: c1 names pin C twice: name each pin of a link once"),
        ("crank A-B, arm D-B past B", "links: arm passes its own pin B: name a pin of another link"),
        ("crank A-B, theta3 B-C, rocker D-C", f'links: "theta3" {TAKEN}'),
        ("crank A-B, power B-C, rocker D-C", f'links: "power" {TAKEN}'),
        ("crank A-B, ground B-C, rocker D-C", f'links: "ground" {TAKEN}'),
        ("crank A-B, lambda B-C, rocker D-C", f'links: "lambda" {TAKEN}'),
        ("crank A-B, title B-C, rocker D-C", f'links: "title" {TAKEN}'),
        (
            "crank A-B, ROD B-C, rocker D-C",
            'links: "ROD" reads as a pin: give links and guides names in lower case, such as rod or slide',
        ),
        (
            "crank A-B, rod B-F12, rocker D-F12",
            "links: pin F12 has the name of a quantity: name it by a letter, or by one such as P and a number",
        ),
        (
            "block C on slide, crank A-B, rod B-C",
            "links: block stands first: begin with the crank, a link such as crank A-B",
        ),
        (
            "rod B-C, crank A-B, rocker D-C",
            "links: rod, the first link, begins at pin B, and the ground at pin A: both must begin at the crank's "
            "pivot",
        ),
        ("crank A-B, rod B-C, rocker E-C", "ground.D: no link has this pin: name it in one, or leave it out"),
        (f"{FOUR_BAR}, c1 P~C", "links: no link has pin P of c1: name it in a link, as rod P-…"),
        ("crank A-B, arm D-E past P", "links: no link has pin P of arm: name it in a link, as rod P-…"),
        (f"{FOUR_BAR}, ram P on rocker", "links: no link has pin P of ram: name it in a link, as rod P-…"),
        (
            f"{FOUR_BAR}, bar C-E-H, x D-E-H",
            "points.H: two links name pin H third: write it first or second in one of them",
        ),
        (
            f"{FOUR_BAR}, link C-E, ram E on rockr",
            'links: "rockr", on which ram slides, is neither a guide nor a link; did you mean "rocker"?',
        ),
        (
            f"{FOUR_BAR}, link C-E, ram E on way",
            'links: "way", on which ram slides, is neither a guide nor a link; declare it in guides, by an ls.Guide',
        ),
        (f"{FOUR_BAR}, ram C on rocker", "links: ram slides on rocker and is pinned to it: name another pin"),
        (
            "crank A-B, wheel D-E : 2 rod, rod B-C, arm E-C",
            "links: wheel meshes with rod: give its ratio to the crank, crank",
        ),
        (
            "crank A-B, wheel B-E : 2 crank, rod B-C, rocker D-C",
            "links: wheel is turned by gears: one of its pins, and no other, must be on the ground",
        ),
        (
            "crank A-B, wheel D-E : crank, rod B-C, arm E-C",
            "gears.wheel.ratio is stated nowhere: state it once, in links or in gears",
        ),
        (
            "crank A-B, wheel D-E : 0 crank, rod B-C, arm E-C",
            'gears.wheel.ratio = "0": must be a whole number such as -2, and not 0',
        ),
    ],
)
def test_names_that_do_not_fit(links, line):
    assert line in problems(links, reserved=("title",))


def test_gears_that_do_not_fit():
    links = "crank A-B, wheel D-E : 2 crank, rod B-C, arm E-C"
    assert problems(links, ratios=(("wheel", "3"), ("cog", "2"))) == [
        "gears.cog: links has no such wheel: write cog D-E : crank",
        "gears.wheel.ratio is stated twice: state it once, in links or in gears",
    ]
    assert problems(links.replace("2 crank", "crank"), ratios=(("wheel", "1.5"),)) == [
        'gears.wheel.ratio = "1.5": must be a whole number such as -2, and not 0'
    ]


def test_guides_that_do_not_fit():
    assert problems(FOUR_BAR, hosts=(("slide", GROUND), ("arm", "rokcer"))) == [
        "guides.slide: nothing slides on it: leave it out",
        'guides.arm.of = "rokcer": must be ground or a link with pins; did you mean "rocker"?',
        "guides.arm: nothing slides on it: leave it out",
    ]
    assert problems("crank A-B, arm D-E past B", hosts=(("arm", GROUND),)) == [
        'guides.arm has the name of a link: write of="arm", or give it another name'
    ]
    assert problems("crank A-B, arm D-E past B", hosts=(("arm", "arm"),)) == []


def test_a_ground_without_pins():
    assert problems(FOUR_BAR, "") == ["ground: has no pin: begin with the pivot of the crank, A"]


def test_all_problems_are_stated_at_once():
    assert problems("crank A-B, theta3 B-C, bar C-E-E, ram F on sliide", hosts=SLIDE) == [
        f'links: "theta3" {TAKEN}',
        "links: bar names pin E twice: name each pin of a link once",
        "links: no link has pin F of ram: name it in a link, as rod F-…",
        "ground.D: no link has this pin: name it in one, or leave it out",
        'links: "sliide", on which ram slides, is neither a guide nor a link; did you mean "slide"?',
        "guides.slide: nothing slides on it: leave it out",
        "links: 6 degrees of freedom: 5 more cranks, or fewer links",
        loose("bar", "its pin E"),
        loose("ram", "its pin F"),
    ]
