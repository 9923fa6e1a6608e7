"""The multibody reference of linkages is checked: beside the other references, by differences, energy and balance."""

import re
from dataclasses import replace
from decimal import Decimal

import numpy as np
import oracle
import oracle_inverted_slider_crank as inverted
import oracle_slider_crank as slider
import pytest
from references import BRANCHES, mp

from benchmarks.stress.decimals import fifty_digits
from benchmarks.stress.linkages import multibody, scenes
from benchmarks.stress.linkages.machine import Linkages, Load
from benchmarks.stress.linkages.results import named, power_terms
from benchmarks.stress.linkages.topologies import FAMILIES, TOPOLOGIES

TIGHT = mp.mpf("1e-28")


# ---- beside the references of single machines


def as_linkage(text, data, motion, links, theta2, *, ground=0.0, **own):
    """Return the data of another reference, its frame along x, as a linkage; its solved pins are the start."""
    fixed = {"A": (0.0, 0.0)} | ({"D": (ground, 0.0)} if ground else {})
    pins = {pin: np.array([complex(place)]) for pin, place in motion.pin.items()}
    if "block" in links:
        pins["E"] = np.array([complex(motion.pin["D"] + data.rocker.length * motion.line["rocker"])])
    loads = tuple(Load(**vars(load)) for load in data.loads)
    state = {name: getattr(data, name) for name in ("omega2", "alpha2", "gravity")}
    parts = {role: vars(link) for role, link in links.items()}
    return Linkages(text, fixed, parts, pins, theta2, loads=loads, **state, **own)


def assert_agree(linkages, expected, **also):
    """Compare all results that both name, and those that differ in name."""
    values = named(multibody.solve(linkages))
    pairs = {name: name for name in expected if name in values} | also
    assert {"F12x", "F32y", "F43", "Bx"} <= {*pairs}
    assert {"omega3", "alpha3"} <= {*pairs} or {"omega4", "alpha4"} <= {*pairs}
    assert sum(name[0] == "T" for name in pairs) == 1 + linkages.text.count(" on ")
    largest = max(abs(expected[name]) for name in oracle.FORCES)
    for name, its_name in pairs.items():
        scale = largest + abs(expected[its_name])
        tight = mp.mpf("1e-15") if name.startswith("theta") else TIGHT
        assert abs(mp.mpf(str(values[name][0])) - expected[its_name]) <= tight * scale, name


@pytest.mark.parametrize("seed", range(6))
def test_four_bar(seed):
    rng = np.random.default_rng(seed)
    data = replace(oracle.random_data(rng, scale=1.0, loads=3), ground_angle=0.0)
    theta2 = oracle.random_theta2(rng, data)
    own = {"ground": data.ground, "drive": data.drive}
    motion = oracle.motion(data, theta2)
    linkages = as_linkage("crank A-B, coupler B-C, rocker D-C", data, motion, oracle.links(data), theta2, **own)
    assert_agree(linkages, oracle.solve(data, theta2))


def slider_crank(data, theta2):
    guide = {"through": (0.0, data.offset), "angle": 0.0, "friction": data.friction}
    own = {"drive": slider.DRIVEN[data.drive], "guides": {"slide": guide}}
    motion = slider.motion(data, theta2)
    return as_linkage("crank A-B, rod B-C, slider C on slide", data, motion, slider.links(data), theta2, **own)


@pytest.mark.parametrize("seed", range(8))
def test_slider_crank_with_friction(seed):
    rng = np.random.default_rng(seed)
    drawn = slider.random_data(rng, scale=1.0, loads=2, friction=0.3, branch=BRANCHES[seed % 2])
    data = replace(drawn, slide_angle=0.0)
    theta2 = slider.random_theta2(rng, data, jammed=False)
    same = {name: name for name in ("x_slider", "v_slider", "a_slider")}
    renamed = {"F14n": "normal_force", "F14t": "friction_force"}
    assert_agree(slider_crank(data, theta2), slider.solve(data, theta2), **same, **renamed)


@pytest.mark.parametrize(("seed", "jammed"), [(seed, jammed) for seed in range(4) for jammed in (True, False)])
def test_jammed_slider_crank(seed, jammed):
    """Both references name one status, where the slider wedges and where it does not."""
    rng = np.random.default_rng(seed)
    data = replace(slider.random_data(rng, scale=1.0, friction=0.9, drive="crank"), slide_angle=0.0)
    theta2 = slider.random_theta2(rng, data, jammed=jammed)
    raised = {slider.Jammed: multibody.JAMMED, slider.TwoSolutions: multibody.JAMMED_TWO_SOLUTIONS}
    expected = multibody.OK
    try:
        slider.solve(data, theta2)
    except tuple(raised) as problem:
        expected = raised[type(problem)]
    assert multibody.solve(slider_crank(data, theta2)).status[0] == expected
    assert bool(expected) == jammed


@pytest.mark.parametrize("seed", range(8))
def test_inverted_slider_crank_with_friction(seed):
    rng = np.random.default_rng(seed)
    drawn = inverted.random_data(rng, scale=1.0, loads=2, friction=0.2, drive=("crank", "rocker")[seed % 2])
    data = replace(drawn, ground_angle=0.0)
    theta2 = inverted.random_rubbing_theta2(rng, data)
    guide = {"of": "rocker", "through": (0.0, data.offset), "friction": data.friction}
    own = {"ground": data.ground, "drive": data.drive, "guides": {"rocker": guide}}
    motion = inverted.motion(data, theta2)
    text = "crank A-B, block B on rocker, rocker D-E"
    linkages = as_linkage(text, data, motion, inverted.links(data), theta2, **own)
    sliding = {"x_block": "slide", "v_block": "slide_velocity", "a_block": "slide_acceleration"}
    assert_agree(linkages, inverted.solve(data, theta2), F43n="F43n", F43t="friction_force", **sliding)


# ---- laws


def solved(name, seed, n=6):
    """Return linkages of a topology away from toggles and jamming, with masses, loads, and friction in its slides."""
    return scenes.drawn(FAMILIES[name], np.random.default_rng(seed), n)


@pytest.mark.parametrize("seed", [2])
@pytest.mark.parametrize("name", FAMILIES)
def test_energy_is_conserved(name, seed):
    solution = solved(name, seed)
    terms, ok = power_terms(solution), solution.status == 0
    with fifty_digits():
        balance = abs(sum(terms))[ok]
        assert len(balance) > 1
        assert np.all(balance <= np.max([abs(term) for term in terms], axis=0)[ok] * Decimal("1e-44"))


@pytest.mark.parametrize("name", TOPOLOGIES)
def test_rates_are_derivatives(name):
    """Derivatives of positions and of rates to the crank's angle, by central differences."""
    solution, step = solved(name, 5), 2.0**-16
    linkages = solution.assembly.linkages
    before, after = (multibody.solve(replace(linkages, theta2=linkages.theta2 + h)).frames for h in (-step, step))
    omega2, alpha2 = (np.asarray(of, dtype=float) for of in (linkages.omega2, linkages.alpha2))
    for body in linkages.bodies:
        at, (first, second) = solution.frames[body.role], (frames[body.role] for frames in (before, after))
        with fifty_digits():
            moved = [second.G.x - first.G.x, second.G.y - first.G.y, first.u.cross(second.u)]
            changed = [second.v.x - first.v.x, second.v.y - first.v.y, second.omega - first.omega]
        rates = np.array([at.v.x, at.v.y, at.omega], dtype=float) / omega2
        slopes = (np.array([at.a.x, at.a.y, at.alpha], dtype=float) - alpha2 * rates) / omega2**2
        per_rad = 1.0 / np.radians(2.0 * step)
        size = 1.0 + np.abs(rates).max(axis=0) ** 3 + np.abs(slopes).max(axis=0)
        assert np.all(abs(np.array(moved, dtype=float) * per_rad - rates) < 1e-9 * size), body.role
        assert np.all(abs(np.array(changed, dtype=float) / omega2 * per_rad - slopes) < 1e-8 * size), body.role


def unbalanced(solution, role):
    """Return what is left of a body's mass times acceleration less its loads and its forces by the pairs of links."""
    values, k = named(solution), solution.assembly.linkages.number[role]
    mass, parts = solution.assembly.part(role, "mass"), []
    for axis, a, load in zip("xy", solution.frames[role].a, solution.loads[role][:2], strict=True):
        pairs = [(i, j) for i in range(1, 9) for j in range(1, 9) if f"F{i}{j}{axis}" in values]
        parts.append(a * mass - load - sum(values[f"F{i}{j}{axis}"] * ((j == k) - (i == k)) for i, j in pairs))
    return parts


def largest_force(solution):
    return max(np.max(abs(values)) for force, values in named(solution).items() if re.fullmatch(r"F\d\d", force))


@pytest.mark.parametrize("name", [name for name, topology in TOPOLOGIES.items() if not {*"~:"} & {*topology.text}])
def test_named_forces_move_each_body(name):
    solution = solved(name, 7)
    with fifty_digits():
        left = [part for body in solution.assembly.linkages.bodies for part in unbalanced(solution, body.role)]
        assert np.all(abs(np.array(left))[:, solution.status == 0] < largest_force(solution) * Decimal("1e-40"))


@pytest.mark.parametrize("seed", [5, 7])
def test_teeth_push_at_their_pressure_angle(seed):
    """All that pivots and pins leave of the forces on two wheels is the teeth's, inclined to the line of pivots."""
    solution = solved("geared five-bar", seed)
    linkages = solution.assembly.linkages
    with fifty_digits():
        on_crank, on_wheel = (unbalanced(solution, role) for role in ("crank", "wheel"))
        least = largest_force(solution) * Decimal("1e-40")
        assert all(np.all(abs(x + y) < least) for x, y in zip(on_crank, on_wheel, strict=True))
    x, y = (np.array(part, dtype=float) for part in on_wheel)
    D = linkages.pins["D"]  # from A
    force = (x + 1j * y) / (D / abs(D))  # along and across the line of pivots
    np.testing.assert_allclose(
        np.degrees(np.arctan2(force.real, abs(force.imag))), linkages.gears["wheel"]["pressure_angle"]
    )
    # the wheel turns twice as fast backwards: its teeth meet the crank's at a third of the distance from D
    gears, _driver = solution.multipliers[-2:]
    np.testing.assert_allclose(-force.imag * abs(D) / 3.0, gears.astype(float))


def test_branches_are_sides():
    """The pin of a dyad is left of the line between its known pins if open; a pin on a guide is ahead of its rod."""
    for seed in range(4):
        linkages = solved("six-bar with a slider", seed).assembly.linkages
        A = {pin: complex(z) for pin, z in ((pin, z[0]) for pin, z in linkages.pins.items())}
        left = ((A["C"] - A["B"]) * (A["D"] - A["B"]).conjugate()).imag > 0
        assert left == (linkages.branch["C"] == "open")
        direction = np.exp(1j * np.radians(linkages.guides["slide"]["angle"][0]))
        ahead = ((A["F"] - A["E"]) * direction.conjugate()).real > 0
        assert ahead == (linkages.branch["F"] == "open")
