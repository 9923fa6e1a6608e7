"""Texts of linkages that cannot be: each problem a sentence that states what to change, all causes at once."""

import pytest

from linksweep.chains.topology import GROUND, topology

SLIDE = (("slide", GROUND),)
FOUR_BAR = "crank A-B, rod B-C, rocker D-C"


def problems(links: str, ground: str = "AD", hosts=(), ratios=(), struts=(), reserved=()) -> list[str]:
    return [*topology(links, tuple(ground), hosts, ratios, frozenset(struts), frozenset(reserved))[1]]


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


WHEEL = "a wheel is written as wheel D-E : -2 crank, a ratio that is a fraction as -5/2"


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
        ("wheel D-E :", WHEEL),
        ("wheel D-E : -2.5 crank", WHEEL),
        ("wheel D-E : 1/0 crank", WHEEL),
    ],
)
def test_a_part_that_cannot_be_read_is_quoted(part, sentence):
    machine, lines = topology(f"crank A-B, {part}, rod B-C", ("A",))
    assert machine is None and lines == (f'links: "{part}" cannot be read: {sentence}',)


def test_all_parts_that_cannot_be_read_are_quoted_at_once():
    assert len(problems("crank A, rod B-C, rod C-D, c1 D")) == 3


TAKEN = "has a meaning of its own in linksweep or Python: give the part another name"


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
            "crank A-B, P2 B-C, rocker D-C",
            'links: "P2" reads as a pin: give parts and guides names in lower case, such as rod or slide',
        ),
        (
            "crank A-B, rod B-F12, rocker D-F12",
            "links: pin F12 has the name of a quantity: name it by a letter, or by one such as P and a number",
        ),
        (
            f"{FOUR_BAR}, c1 Q2~C",
            "links: pin Q2 has the name of a quantity: name it by a letter, or by one such as P and a number",
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
            'links: "rockr", on which ram slides, is neither a guide nor a link; did you mean "rocker"? Else '
            "declare it in guides, by an ls.Guide",
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
            'gears.wheel.ratio = "0": must be a whole number or a fraction such as -3/2, and not 0',
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
        'gears.wheel.ratio = "1.5": must be a whole number or a fraction such as -3/2, and not 0'
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
    ]


@pytest.mark.parametrize(
    ("links", "hosts", "line"),
    [
        ("ram C on way", (), 'links: "way", on which ram slides, is neither a guide nor a link; declare it in'),
        ("ram C on slid", SLIDE, 'links: "slid", on which ram slides, is neither a guide nor a link; did you mean "sl'),
        (
            "ram C on slide",
            (("slide", "rodd"),),
            'guides.slide.of = "rodd": must be ground or a link with pins; did',
        ),
        ("ram Q on slide", SLIDE, "links: no link has pin Q of ram"),
        ("arm D-E past Q", (), "links: no link has pin Q of arm"),
        ("ground C-D", (), f'links: "ground" {TAKEN}'),
        ("status C-D", (), f'links: "status" {TAKEN}'),
    ],
)
def test_the_cause_alone_is_stated(links, hosts, line):
    """No mobility and no loose link, where both follow from a name that does not fit."""
    ground = "A" if "on" in links.split() else "AD"
    (only,) = problems(f"crank A-B, rod B-C, {links}", ground, hosts)
    assert only.startswith(line)


def test_a_wrong_mobility_is_stated_beside_an_undeclared_guide():
    assert problems("crank A-B, rod B-C, ram C on way, bar B-E", "A") == [
        'links: "way", on which ram slides, is neither a guide nor a link; declare it in guides, by an ls.Guide',
        "links: 2 degrees of freedom: one more crank, or one link less",
    ]


def test_names_may_have_capitals():
    assert problems("Crank A-B, ROD B-C, ram C on SLIDE", "A", (("SLIDE", GROUND),)) == []


@pytest.mark.parametrize(
    ("links", "hosts", "line"),
    [
        (
            "arm D-E past A",
            (),
            "links: ground and arm are joined twice (D:arm, arm past A), and stand still on each other",
        ),
        (
            "yoke on slide past D",
            SLIDE,
            "links: ground and yoke are joined twice (slide, yoke past D), and stand still",
        ),
    ],
)
def test_two_joints_between_the_same_links(links, hosts, line):
    """Their forces would have one name, such as F13x."""
    (only,) = problems(f"crank A-B, {links}, rod B-C, lever D-C", "AD", hosts)
    assert only.startswith(line) and only.endswith(": leave one out")
