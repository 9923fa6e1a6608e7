"""Designs of a linkage side by side, alone, in another order, in parts of a turn, and on both branches: equal bits."""

from dataclasses import replace

import numpy as np
import pytest
from random_linkages import assert_equal, changed, random_case, swept, unwarned

import linksweep as ls

pytestmark = unwarned
NAMES = ("pins in other orders", "shaper with two slides", "held cylinder")
some = pytest.mark.parametrize("name", NAMES)


def chosen(scene: ls.Scene, which) -> ls.Scene:
    def number(path, value, kind):
        return value.isel(design=which) if "design" in getattr(value, "dims", ()) else value

    return changed(scene, number)


def unlabelled(cycle):
    return cycle.drop_vars(list(cycle.coords))


@some
def test_order_of_designs_and_each_alone(name):
    scene, theta2 = random_case(name, 3)
    every = unlabelled(swept(scene, theta2))
    for which in (slice(None, None, -1), [1], [2, 0]):
        result = unlabelled(swept(chosen(scene, which), theta2))
        assert_equal(result, every.isel(design=which))


@some
def test_parts_of_a_turn(name):
    scene, theta2 = random_case(name)
    angles = theta2 + np.array([-1.0, 0.0, 0.5, 2.0])
    whole = swept(scene, angles)
    for part in ([1], [3, 2], slice(None, None, -1)):
        assert_equal(swept(scene, angles[part]), whole.isel(theta2=part))


def test_both_branches_are_open_and_crossed():
    scene, theta2 = random_case("Watt II")
    both, alone = (
        {branch: replace(scene, mechanism=replace(scene.mechanism, branch={"F": branch})) for branch in words}
        for words in (["both"], ["open", "crossed"])
    )
    together = swept(both["both"], theta2)
    for branch, single in alone.items():
        assert_equal(unlabelled(swept(single, theta2)), unlabelled(together.sel(branch_F=branch)))


def test_a_parallelogram_copies_the_rocker():
    """Both levers of the second loop turn alike; the rod's direction stays."""
    links = {
        role: ls.Link(length, 1.0, 0.01) for role, length in {"crank": 0.1, "coupler": 0.3, "rocker": 0.25}.items()
    }
    links |= {"rod": ls.Link(0.4, 1.0, 0.01), "copy": ls.Link(0.25, 1.0, 0.01)}
    ground = {"A": (0.0, 0.0), "D": (0.32, 0.0), "G": (0.72, 0.0)}
    text = "crank A-B, coupler B-C, rocker D-C, rod C-F, copy G-F"
    machine = ls.Linkage(text, ground=ground, branch={"F": "open"}, **links)
    cycle = ls.sweep(ls.Scene(machine, 3.0), 12, of=["theta4", "theta6", "omega4", "omega6", "theta5", "status"])
    assert not cycle.status.any()
    np.testing.assert_allclose(cycle.theta6, cycle.theta4, atol=1e-12)
    np.testing.assert_allclose(cycle.omega6, cycle.omega4, atol=1e-12)
    np.testing.assert_allclose(cycle.theta5, 0.0, atol=1e-12)
