"""Drives that load slides with friction, which decides the drive in turn: by hand, by named machines, by the dense
system, and by samples of exact peaks. The multibody reference is in `mechanisms/oracle/test_linkages.py`."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from benchmarks.accuracy.missed import ALLOWED, shortfall
from benchmarks.speed.kernel import way
from linksweep.physics import coupled_contacts
from linksweep.physics.algebra.affine import Affine

BAR = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
OK, JAMMED, TWO_SOLUTIONS = 0, 4, 6
A, D = (0.0, 0.0), (0.0, -0.25)
CRANK = 0.1
STROKE = np.arange(5.0, 360.0, 7.0)
JACK = "crank A-B, arm D-E past B, block F on arm, ram F on slide, jack J~F"


@pytest.fixture(autouse=True)
def uncompiled():
    """Run uncompiled: equal numbers without compile time."""
    with way("interpreted"):
        yield


def massless(length):
    return ls.Link(length, 0.0, 0.0)


def quick_return(friction, drive="arm", **scene):
    """Return a crank-shaper without its ram: a block without mass at B slides on the arm, which drives."""
    machine = ls.Linkage(
        "crank A-B, arm D-E past B",
        ground={"A": A, "D": D},
        crank=massless(CRANK),
        arm=massless(0.5),
        guides={"arm": ls.Guide(of="arm", friction=friction)},
    )
    return ls.Scene(machine, drive=drive, **{"omega2": 2.0, **scene})


def shaper(friction, drive="jack", loads=()):
    """Return a shaper whose ram a cylinder drives: three slides rub."""
    machine = ls.Linkage(
        JACK,
        ground={"A": A, "D": D, "J": (-1.0, 0.3)},
        crank=ls.Bar(CRANK, **BAR),
        arm=ls.Bar(0.5, **BAR),
        block=ls.Slider(0.3),
        ram=ls.Slider(2.0),
        guides={"slide": ls.Guide(through=(0.0, 0.2), friction=friction), "arm": ls.Guide(of="arm", friction=friction)},
    )
    return ls.Scene(machine, omega2=3.0, alpha2=1.0, gravity=(0.0, -9.81), drive=drive, loads=loads)


@pytest.mark.parametrize("friction", [0.0, 0.2, 0.7])
def test_by_hand(friction):
    """A torque M brakes the crank. The arm presses on the block with N across its line u and friction -σμN·sign(v):
    moments about A give N(r·u) + f(r × u) + M = 0, those about D the torque of the arm, N times the block's distance.

    Both signs of N are tried: the drive is that of the one which holds; none is a jam, two are two solutions.
    """
    torque = -5.0
    scene = quick_return(friction, loads=[ls.Load("crank", torque=torque)])
    cycle = ls.sweep(scene, STROKE, of=["T13", "F32n", "F32t"])
    status, drive, force, rubs = (
        np.broadcast_to(cycle[name], len(STROKE)) for name in ("status", "T13", "F32n", "F32t")
    )
    for k, angle in enumerate(np.radians(STROKE)):
        r = CRANK * np.array([np.cos(angle), np.sin(angle)])
        w = r - np.array(D)
        u = w / np.hypot(*w)
        along, across = r @ u, r[0] * u[1] - r[1] * u[0]
        sliding = np.sign(2.0 * (u @ np.array([-r[1], r[0]])))
        tried = [(sign, -torque / (along - sign * friction * sliding * across)) for sign in (1.0, -1.0)]
        held = [normal for sign, normal in tried if sign * normal > 0.0]
        assert status[k] == {1: OK, 0: JAMMED, 2: TWO_SOLUTIONS}[len(held) if friction else 1]
        if status[k] == OK:
            (normal,) = set(held)
            assert drive[k] == pytest.approx(normal * np.hypot(*w), rel=1e-12)
            assert abs(force[k]) == pytest.approx(abs(normal), rel=1e-12)
            assert abs(rubs[k]) == pytest.approx(friction * abs(normal), rel=1e-12)


def test_a_slide_that_bears_nothing_has_the_derivatives_of_its_friction():
    """A balanced crank at constant speed loads its block with nothing. When it accelerates, the block's force has the
    moment J·α about A, and friction is μ times its normal force."""
    inertia, friction = 0.02, 0.3
    scene = quick_return(friction, gravity=(0.0, -9.81))
    parts = {"crank": ls.Link(CRANK, 0.0, inertia), "arm": ls.Link(0.5, 2.0, 0.1, cg_distance=0.3)}
    scene = replace(scene, mechanism=replace(scene.mechanism, **parts))
    names = ("F32x", "F32y", "F32n", "F32t")
    cycle = ls.sensitivities(scene, of=[*names, "v_arm"], to=["alpha2"], theta2=STROKE)
    assert all(abs(cycle[name]).max() < 1e-12 for name in names)
    x, y, normal, rubs = (cycle[f"{name}_derivative"].isel(parameter=0) for name in names)
    angle = np.radians(STROKE)
    np.testing.assert_allclose(CRANK * (y * np.cos(angle) - x * np.sin(angle)), inertia, rtol=1e-12)
    np.testing.assert_allclose(rubs, -friction * normal * np.sign(cycle.v_arm), rtol=1e-12)


@pytest.mark.parametrize("friction", [0.05, 0.4, 1.2])
def test_named_machine_with_the_rocker_as_drive(friction):
    """The inverted slider-crank solves the same contact by the crank's own moments."""
    crank, rocker = ls.Bar(CRANK, **BAR), ls.Link(0.5, 1.2, 0.03, cg_distance=0.2, cg_angle=8.0)
    motion = {"omega2": 7.0, "alpha2": 12.0, "gravity": (0.0, -9.81)}
    load = ls.Load("crank", torque=-3.0)
    named = ls.InvertedSliderCrank(crank, rocker, ground=0.25, ground_angle=-90.0, block_mass=0.4, friction=friction)
    written = ls.Linkage(
        "crank A-B, block B on rocker, rocker D-E",
        ground={"A": A, "D": D},
        crank=crank,
        rocker=rocker,
        block=ls.Slider(0.4),
        guides={"rocker": ls.Guide(of="rocker", friction=friction)},
    )
    expected, cycle = (
        ls.sweep(ls.Scene(machine, drive="rocker", loads=[load], **motion), STROKE) for machine in (named, written)
    )
    np.testing.assert_array_equal(cycle.status, expected.status)
    assert {OK} < set(cycle.status.values) if friction > 0.4 else {OK} <= set(cycle.status.values)
    for name, own in {"T14": "T14", "F12x": "F12x", "F43n": "F43n", "F14x": "F14x", "F14y": "F14y"}.items():
        scale = float(abs(expected.F12x).max() + abs(expected.T14).max())
        np.testing.assert_allclose(cycle[own], expected[name], rtol=1e-11, atol=1e-12 * scale)


def test_nothing_presses_nothing_jams():
    """Without loads and masses on the crank the arm needs no block: no friction wedges a contact without force."""
    cycle = ls.sweep(quick_return(2.0, loads=[ls.Load("arm", torque=4.0)]), STROKE, of=["T13", "F32n"])
    assert np.all(cycle.status == OK)
    np.testing.assert_allclose(cycle.T13, -4.0, rtol=1e-13)
    np.testing.assert_allclose(cycle.F32n, 0.0, atol=1e-13)


@pytest.mark.parametrize("friction", [0.3, 2.0])
def test_a_crank_that_bears_nothing_jams_nothing(friction):
    """A crank without mass or load turns evenly: it needs no torque, and the arm's block presses on nothing. Rounding
    leaves a little that presses, and more the slower the jack, whose force is W/r."""
    scene = shaper(friction)
    block = replace(scene.mechanism.guides["arm"], friction=friction)
    slide = replace(scene.mechanism.guides["slide"], friction=0.3)
    machine = replace(scene.mechanism, crank=massless(CRANK), guides={"slide": slide, "arm": block})
    scene = ls.Scene(machine, omega2=3.0, gravity=(0.0, -9.81), drive="jack")
    limits = ls.check(scene)
    assert limits.sizes["jam"] == 0
    away = np.geomspace(1e-6, 3.0, 400)
    angles = np.concatenate([centre + sign * away for centre in limits.dead_centre_angle.values for sign in (-1, 1)])
    assert np.all(ls.sweep(scene, np.sort(angles), of=["status"]).status == OK)


@pytest.mark.parametrize(("drive", "friction"), [("jack", 0.05), ("jack", 0.15), ("arm", 0.15), ("arm", 0.6)])
def test_dense_system_and_single_requests_agree(drive, friction):
    """Jams included: every request has the status of the whole sweep, and the same drive."""
    scene = shaper(friction, drive, [ls.Load("crank", torque=-6.0), ls.Load("arm", force=(20.0, -5.0), at=(0.3, 0.0))])
    unknown = scene.mechanism.drives[drive]
    names = scene.mechanism.unknowns(drive)
    fast = ls.sweep(scene, STROKE, of=[*names, "power_residual", "error_bound"])
    ok = fast.status.values == OK
    assert 0.3 * len(ok) < ok.sum()
    dense = ls.sweep(scene, STROKE, of=names, solver="dense")
    alone = ls.sweep(scene, STROKE, of=[unknown])
    np.testing.assert_array_equal(alone.status, fast.status)
    np.testing.assert_array_equal(alone[unknown], fast[unknown])
    np.testing.assert_array_equal(dense.status, fast.status)
    scale = max(float(abs(fast[name]).max()) for name in names)
    for name in (name for name in names if fast[name].dims):  # others are zero whatever jams
        np.testing.assert_allclose(dense[name], fast[name], rtol=0, atol=1e-10 * scale)
        np.testing.assert_array_equal(np.isnan(fast[name]), ~ok)
    assert abs(fast.power_residual).max() < 1e-13
    assert 0.0 < fast.error_bound.max() < 1e-7


def test_friction_and_a_cylinder_that_moves_together():
    """The lever's torque decides the friction of the arm and the force of a cylinder, and depends on both."""
    machine = ls.Linkage(
        "crank A-B, arm D-E past B, held E~K, lever G-K",
        ground={"A": A, "D": D, "G": (0.6, 0.0)},
        crank=ls.Bar(CRANK, **BAR),
        arm=ls.Bar(0.5, **BAR),
        lever=ls.Bar(0.4, **BAR),
        held=ls.Cylinder(length=lambda theta2: 0.6 + 0.03 * np.cos(np.radians(theta2))),
        guides={"arm": ls.Guide(of="arm", friction=0.1)},
    )
    loads = [ls.Load("crank", torque=-5.0)]
    scene = ls.Scene(machine, omega2=3.0, alpha2=1.0, gravity=(0.0, -9.81), drive="lever", loads=loads)
    names = machine.unknowns("lever")
    fast, dense = (
        ls.sweep(scene, STROKE, of=[*names, "power_residual"], solver=solver) for solver in ("fast", "dense")
    )
    np.testing.assert_array_equal(dense.status, fast.status)
    assert 0.5 * len(STROKE) < (fast.status == OK).sum() < len(STROKE)
    assert abs(fast.power_residual).max() < 1e-13
    scale = max(float(abs(fast[name]).max()) for name in names)
    for name in names:
        np.testing.assert_allclose(dense[name], fast[name], rtol=0, atol=1e-10 * scale)


def test_without_friction_the_drive_is_that_of_work_alone():
    """As friction tends to 0, drive and forces tend to those without, in proportion to it."""
    plain, small, twice = (ls.sweep(shaper(mu), STROKE, of=["force_jack", "F12x"]) for mu in (0.0, 1e-7, 2e-7))
    for name in ("force_jack", "F12x"):
        change = (small[name] - plain[name]).values
        assert np.abs(change).max() > 0.0
        np.testing.assert_allclose((twice[name] - plain[name]).values, 2.0 * change, rtol=1e-2, atol=1e-6)


def test_the_drive_overcomes_friction():
    """The drive feeds what loads, inertia and friction take: power_residual is relative to these."""
    cycle = ls.sweep(shaper(0.1), STROKE, of=["power", "friction_power", "inertia_power", "gravity_power"])
    ok = cycle.status.values == OK
    assert np.all(cycle.friction_power.values[ok] < 0.0)
    total = cycle.power + cycle.friction_power + cycle.inertia_power + cycle.gravity_power
    np.testing.assert_allclose(total.values[ok], 0.0, atol=1e-12 * float(abs(cycle.power).max()))


# ------------------------------------------------------------------------------------------------ exact peaks


def turning(designs, seed, stages):
    """Return links on pivots within the crank's circle, each of whose lines passes a pin of the one before: the last
    one drives. All turn fully, so that no drive stands still; the friction of every slide depends on all others."""
    random = np.random.default_rng(seed)

    def number(low, high):
        return xr.DataArray(random.uniform(low, high, designs), dims="design")

    def link(length):
        return ls.Link(length, number(0.2, 2.0), number(1e-3, 5e-3), number(0.0, 0.1), number(-180.0, 180.0))

    text, ground, pin = "crank A-B", {"A": A}, "B"
    parts, guides = {"crank": link(CRANK)}, {}
    roles = [f"arm{chr(ord('a') + k)}" for k in range(stages)]
    for role, pivot, end in zip(roles, "DFH", "EGI", strict=False):
        text += f", {role} {pivot}-{end} past {pin}"
        ground[pivot] = (number(-0.04, 0.04), number(-0.04, 0.04))
        parts[role], pin = link(number(0.12, 0.2)), end
        guides[role] = ls.Guide(of=role, through=(0.0, number(-0.015, 0.015)), friction=number(0.0, 0.5))
    machine = ls.Linkage(text, ground=ground, guides=guides, **parts)
    loads = [ls.Load("crank", torque=number(-5.0, 5.0))]
    return ls.Scene(machine, number(-20.0, 20.0), number(-50.0, 50.0), (0.0, -9.81), loads, roles[-1])


@pytest.mark.parametrize("stages", long_but([1, 2, 3], 1))
def test_no_peak_is_missed(stages):
    """Reversals of the slides, and changes of side, are jumps and kinks of all forces and of the drive."""
    designs = 40
    scene = turning(designs, 3, stages)
    exact, samples = ls.peaks(scene), ls.peaks(scene, theta2=(np.arange(5760) + 0.3) / 16.0)
    assert (exact.status == OK).sum() > 0.8 * designs
    assert shortfall(exact, samples).max() <= ALLOWED


def test_shares_of_all_sources_add_up():
    scene = turning(2, 3, 1)
    shares, cycle = ls.breakdown(scene, ["T13", "F12x"], theta2=24), ls.sweep(scene, 24, of=["T13", "F12x"])
    for name in ("T13", "F12x"):
        np.testing.assert_allclose(shares[name].sum("source"), cycle[name], atol=1e-12 * float(abs(cycle[name]).max()))


def test_friction_in_pins_beside_that_in_the_slide():
    bearing = ls.Bearing(diameter=0.02, friction=0.1)
    names = ["power", "friction_power", "inertia_power", "gravity_power", "load_power"]
    cycle = ls.pin_friction(turning(2, 3, 1), {"A": bearing, "D": bearing}, theta2=36, of=names)
    assert np.all(cycle.convergence == 0) and np.all(cycle.friction_loss >= 0.0)
    assert np.all((cycle.efficiency > 0.0) & (cycle.efficiency < 1.0))
    total = sum(cycle[name] for name in names)
    np.testing.assert_allclose(total, 0.0, atol=1e-12 * float(abs(cycle.power).max()))


def test_peaks_are_unbounded_where_friction_wedges():
    """An arm that oscillates stands still twice a turn; friction wedges the block on both sides of these angles."""
    friction = 0.2
    scene = quick_return(friction, loads=[ls.Load("crank", torque=-5.0)])
    assert np.isinf(ls.peaks(scene, of=["T13"]).T13_peak)
    at_dead_centre, wedge = -np.degrees(np.arcsin(CRANK / 0.25)), np.degrees(np.arctan(friction))
    away = np.array([-wedge - 3.0, -wedge + 3.0, 0.0, wedge - 3.0, wedge + 3.0])
    status = [int(one) for one in ls.sweep(scene, at_dead_centre + away).status]
    assert status[0] == status[-1] == OK and status[2] == 3
    assert {status[1], status[3]} <= {JAMMED, TWO_SOLUTIONS}


# --------------------------------------------------------------------------------------------------- refusals


def chain(stages):
    """Return a chain of links past pins, as `turning`, with a block and a ram at its end, which a cylinder drives."""
    text, ground, pin = "crank A-B", {"A": A, "J": (-1.0, 0.0)}, "B"
    parts, roles = {"crank": ls.Bar(CRANK, **BAR)}, [f"arm{chr(ord('a') + k)}" for k in range(stages)]
    for role, pivot, end in zip(roles, "DHK", "EIL", strict=False):
        text += f", {role} {pivot}-{end} past {pin}"
        ground[pivot], parts[role], pin = (0.01, -0.02 * len(ground)), ls.Bar(0.15, **BAR), end
    return ls.Linkage(
        f"{text}, block F on {roles[-1]}, ram F on slide, jack J~F",
        ground=ground,
        guides={"slide": ls.Guide(through=(0.0, 0.1), friction=0.01)}
        | {role: ls.Guide(of=role, friction=0.01) for role in roles},
        block=ls.Slider(0.1),
        ram=ls.Slider(1.0),
        **parts,
    )


def test_more_slides_than_are_solved_together_are_refused():
    scene = ls.Scene(chain(2), omega2=1.0, drive="jack")
    assert ls.sweep(scene, [10.0, 100.0], of=["force_jack"]).sizes["theta2"] == 2
    with pytest.raises(
        ValueError, match=r'drive = "jack": it loads 5 slides with friction .*at most 4.*drive by "crank"'
    ):
        ls.Scene(chain(3), omega2=1.0, drive="jack")


# ---------------------------------------------------------------------------------------------------- the laws


def test_four_slides():
    """The friction of four slides, solved by trial of their signs, fulfils statics and Coulomb's law."""
    free, directions = [7.0, -3.0, 5.0, -11.0], [0.3, -0.2, 0.1, -0.3]
    slopes = [[((3 * i + 5 * j) % 7 - 3) / 20.0 for j in range(4)] for i in range(4)]
    *frictions, count = coupled_contacts.coupled_contacts(free, slopes, directions)
    assert count == 1.0
    normals = np.array(free) + np.array(slopes) @ frictions
    np.testing.assert_allclose(frictions, -np.array(directions) * abs(normals), rtol=1e-14)


def test_one_sign_holds_where_friction_does_not_wedge():
    """However small the normal forces: what counts as nothing does not depend on the signs that are assumed."""
    for free in (2.0**-44 * np.linspace(-3.0, 3.0, 61)).tolist():
        for slope, *directions in product((-0.6, 0.6), (0.7, -0.7), (0.7, -0.7)):
            *_, count = coupled_contacts.coupled_contacts([free, 5.0 * free], [[slope, 0.3], [-0.3, slope]], directions)
            assert count == 1.0


def test_what_the_error_of_a_slow_drive_leaves_is_nothing():
    """A contact bears nothing where a_i = b_i W/r: the error of r, relative to its size, is that of a slow drive."""
    work, rate = 3e-6, 1e-6
    noise = coupled_contacts.noise_of_drive(work, rate, 1.0, 5e-6, -2e-6)
    for error, nothing in ((2.0**-45, True), (2.0**-30, False)):
        with_error = (3.0, 1.0, work, rate + error, noise, [(rate, 1.0)])
        assert [x == 0.0 for x in coupled_contacts.without_drive(*with_error)] == [nothing, nothing]


def test_affine_numbers_are_exact_and_linear():
    x, y = Affine.unknown("x"), Affine.unknown("y")
    assert ((2 * x - 3 * (y + 1)) / 4 - x).coefficients("x", "y") == (-0.75, -0.5, -0.75)
    for not_linear in (lambda: x * y, lambda: 1 / x):
        with pytest.raises(TypeError, match="not linear"):
            not_linear()
