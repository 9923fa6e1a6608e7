"""Names of forces and torques between two links, with one digit a link and with two."""

import pytest

import linksweep as ls
from linksweep.chains.between_links import force_name, is_pin, name_between, pair_of, reaction
from linksweep.plot.kit.designs import in_words
from linksweep.reports import markup

NAMES = {"F32": (3, 2), "F16": (1, 6), "F11_3": (11, 3), "F3_11": (3, 11), "F1_10": (1, 10)}


@pytest.mark.parametrize("name", NAMES)
def test_names_are_made_and_read(name):
    assert force_name(*NAMES[name]) == name
    assert pair_of(name) == NAMES[name]
    assert pair_of(reaction(name)) == NAMES[name][::-1]


def test_a_torque_is_named_like_a_force():
    assert name_between("T", 1, 6) == "T16"
    assert pair_of("T1_12") == (1, 12)


@pytest.mark.parametrize("name", ["Fs", "force_c1", "F32x", "F321", "theta3", "cylinder_force", "F11_3_peak"])
def test_other_names_have_no_pair(name):
    assert pair_of(name) is None
    assert reaction(name) == name


def test_names_in_words_and_symbols():
    assert in_words("F11_3_peak") == "$F_{11,3}$ peak"
    assert in_words("F32_peak") == "$F_{32}$ peak"
    assert markup.symbol("F11_3") == "F₁₁,₃"


def test_pins_are_named_by_letters():
    assert all(is_pin(joint) for joint in ("A", "C:lower", "P2"))
    assert not any(is_pin(joint) for joint in ("guide", "slide (at B)", "ram on slide"))


def test_vectors_to_pins_of_a_machine_of_many_links():
    """Five dyads that are alike: from the centre of gravity of link 4 to its pin with 3 it is as of 12 with 11."""
    pins, length = "CEFGH", {"rod": 0.3, "lever": 0.25}
    text = ", ".join(f"rod{k} B-{pin}, lever{k} D-{pin}" for k, pin in enumerate(pins))
    parts = {f"{name}{k}": ls.Link(length[name], 1.0, 0.01, cg_distance=0.1) for k in range(5) for name in length}
    ground = {"A": (0.0, 0.0), "D": (0.32, 0.0)}
    machine = ls.Linkage(f"crank A-B, {text}", ground=ground, crank=ls.Link(0.1, 1.0, 0.01), **parts)
    cycle = ls.sweep(ls.Scene(machine, omega2=3.0), [40.0], of=["R34x", "R34y", "R11_12x", "R11_12y"])
    assert cycle.R11_12x == cycle.R34x != 0.0 and cycle.R11_12y == cycle.R34y != 0.0
    names = ls.quantities(ls.Scene(machine, omega2=3.0)).names
    assert "R11_12x" in names and "R1112x" not in names
