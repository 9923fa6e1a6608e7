"""The repr of a scene, a machine or a load is the call that makes it, without parameters at their defaults."""

import pytest

import linksweep as ls

CONSTRUCTORS = {name: getattr(ls, name) for name in ls.__all__ if isinstance(getattr(ls, name), type)}
LEFT_OUT = ("=None", "=''", "=()", "branch", "frame", "origin", "drive", "profile", "alpha2")


@pytest.mark.parametrize("name", ["press", "engine", "loop"])
def test_repr_is_the_call_that_makes_an_equal_scene(name):
    scene = ls.example(name)
    assert eval(repr(scene), CONSTRUCTORS) == scene


@pytest.mark.parametrize("name", ["press", "engine", "quick-return", "loop"])
def test_repr_leaves_out_parameters_at_their_defaults(name):
    assert not [text for text in LEFT_OUT if text in repr(ls.example(name))]


def test_repr_shows_parameters_that_differ_from_their_defaults():
    link = ls.Link(0.2, mass=1.5, inertia=0.0, cg_angle=10.0)
    load = ls.Load("rocker", torque=2.0, breaks=(30.0,))
    assert repr(link) == "Link(length=0.2, mass=1.5, inertia=0.0, cg_angle=10.0)"
    assert repr(load) == "Load(link='rocker', torque=2.0, breaks=(30.0,))"
