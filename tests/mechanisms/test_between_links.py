"""Names of forces and torques between two links, with one digit a link and with two."""

import pytest

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
