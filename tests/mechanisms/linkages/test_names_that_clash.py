"""Names that a linkage's pins, links, sliders and guides have change no number; those that cannot be are refused."""

import re

import numpy as np
import pytest

import linksweep as ls

PINS = "ABCDMNH"
PARTS = ("crank", "rod", "rocker", "link", "lever")
SLIDING = ("crank", "yoke", "slide", "rod", "ram", "rail", "wheel")
AT = [20.0, 200.0]


def link(length: float) -> ls.Link:
    return ls.Link(length, 1.0, 0.01, cg_distance=0.1)


def six_bar(*names: str) -> ls.Scene:
    """Return a loaded six-bar whose pins, in the order of PINS, have these names."""
    A, B, C, D, M, N, H = names
    text = f"crank {A}-{B}, rod {B}-{C}-{M}, rocker {D}-{C}, link {M}-{N}, lever {H}-{N}"
    lengths = dict(zip(PARTS, (0.1, 0.45, 0.35, 0.5, 0.45), strict=True))
    parts = {name: link(length) for name, length in lengths.items()}
    ground = {A: (0.0, 0.0), D: (0.5, 0.1), H: (0.1, 0.9)}
    machine = ls.Linkage(text, ground=ground, points={M: (0.3, 30.0)}, **parts)
    load = ls.Load("rod", force=(50.0, 30.0), at=(0.2, 20.0))
    return ls.Scene(machine, omega2=5.0, gravity=(0.0, -9.81), loads=[load])


def yoke_and_ram(*names: str) -> ls.Scene:
    """Return a machine with a yoke, a slider and gears whose parts and guides, in the order of SLIDING, have these
    names."""
    crank, yoke, slide, rod, ram, rail, wheel = names
    text = f"{crank} A-B, {yoke} on {slide} past B, {rod} B-C, {ram} C on {rail}, {wheel} D-E : -2 {crank}"
    parts = {crank: link(0.1), yoke: ls.Slider(2.0, slot_angle=80.0, slot_friction=0.2), rod: link(0.4)}
    parts |= {ram: ls.Slider(1.0), wheel: link(0.1)}
    guides = {slide: ls.Guide(), rail: ls.Guide(through=(0.0, 0.05), angle=35.0, friction=0.1)}
    ground = {"A": (0.0, 0.0), "D": (0.3, -0.2)}
    machine = ls.Linkage(text, ground=ground, guides=guides, gears={wheel: ls.Gears(phase=30.0)}, **parts)
    return ls.Scene(machine, omega2=20.0, gravity=(0.0, -9.81))


def numbers(scene: ls.Scene) -> list[np.ndarray]:
    """Return all quantities at two angles, in their order."""
    names = [quantity.name for quantity in scene.table.quantities if quantity.name != "cond"]
    cycle = ls.sweep(scene, AT, of=[*names, "status"])
    return [np.asarray(cycle[name]) for name in (*names, "status")]


def assert_equal(renamed: ls.Scene, plain: ls.Scene) -> None:
    pairs = [*zip(numbers(renamed), numbers(plain), strict=True)]
    assert len(pairs) > 60 and not any(np.isnan(x).any() for _, x in pairs)
    assert all(np.array_equal(x, y) for x, y in pairs)


def renamed(harmless, **names: str) -> list[str]:
    return [names.get(name, name) for name in harmless]


@pytest.mark.parametrize("digit", "235")
@pytest.mark.parametrize("letter", ["E", "L", "N", "P", "S"])
@pytest.mark.parametrize("pin", ["C", "M"])
def test_pins_with_the_number_of_a_link(pin, letter, digit):
    """P2, S3, E2, … once were names of loads, inertia forces and sums of actions of links."""
    assert_equal(six_bar(*renamed(PINS, **{pin: letter + digit})), six_bar(*PINS))


@pytest.mark.parametrize("letter", ["F", "G", "Q", "R", "T"])
def test_pins_with_the_name_of_a_quantity_are_refused(letter):
    line = f"links: pin {letter}2 has the name of a quantity: name it by a letter, or by one such as P and a number"
    with pytest.raises(ValueError, match=line):
        six_bar(*renamed(PINS, C=f"{letter}2"))


@pytest.mark.parametrize(
    "names",
    [
        {"slide": "yoke_slot"},
        {"rail": "yoke_slot"},
        {"rail": "wheel_phase"},
        {"ram": "in_slot_yoke"},
        {"slide": "rail_offset", "ram": "rod_mass"},
        {"rod": "branch_C", "ram": "low_C"},
        {"yoke": "work_of_friction", "wheel": "ratio"},
    ],
    ids=str,
)
def test_parts_and_guides_with_names_of_rows(names):
    assert_equal(yoke_and_ram(*renamed(SLIDING, **names)), yoke_and_ram(*SLIDING))


@pytest.mark.parametrize(
    ("names", "name", "longest"),
    [
        ({"rod": "a", "ram": "mass"}, "a_mass", "mass"),
        ({"rod": "a", "ram": "inertia"}, "a_inertia", "inertia"),
        ({"rod": "v", "ram": "length"}, "v_length", "length"),
        ({"rod": "x", "yoke": "cg_x"}, "x_cg_x", "cg_x"),
        ({"rail": "slope", "ram": "cos"}, "slope_cos", "slope"),
    ],
    ids=str,
)
def test_two_parts_after_which_two_numbers_would_be_called(names, name, longest):
    """The refusal states which; the name that it proposes changes no number."""
    with pytest.raises(ValueError, match=f"two numbers would be called {name}, ") as refusal:
        numbers(yoke_and_ram(*renamed(SLIDING, **names)))
    (free,) = re.findall(f"rename {longest}, for example to (.*)", str(refusal.value))
    others = {own: free if other == longest else other for own, other in names.items()}
    assert_equal(yoke_and_ram(*renamed(SLIDING, **others)), yoke_and_ram(*SLIDING))


def test_numbers_of_loads_and_parts_of_one_name_are_refused():
    spring = ls.Spring(from_=("ground", 0.3, 0.0), to=("rod", 0.1, 0.0), rate=200.0, free_length=0.2)
    scene = yoke_and_ram(*renamed(SLIDING, wheel="load1_free"))
    with pytest.raises(ValueError, match='two numbers would be called load1_free_length, after "load1_free"'):
        ls.sweep(ls.Scene(scene.mechanism, omega2=20.0, loads=[spring]), AT)


def test_a_part_called_self_is_refused_in_words():
    parts = {"crank": link(0.1), "self": link(0.4), "rocker": link(0.3)}
    with pytest.raises(ValueError, match='links: "self" has a meaning of its own'):
        ls.Linkage("crank A-B, self B-C, rocker D-C", ground={"A": (0, 0), "D": (0.4, 0)}, **parts)
