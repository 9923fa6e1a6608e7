"""The reference is checked: document 1's numbers, statics by hand, and laws that its own equations do not use."""

from dataclasses import replace
from itertools import product

import mpmath
import numpy as np
import pytest
from documents import PAGE_MATRIX, PAGE_RHS, PAGE_SOLUTION
from laws import TIGHT, close, derivative, dot, history, kinetic_energy
from oracle import (
    KINDS,
    LINKS,
    FourBarData,
    grashof_kind,
    largest_torque,
    links,
    motion,
    random_data,
    random_theta2,
    solve,
    toggle_margin,
    torque_name,
)
from references import (
    BRANCHES,
    FORCES,
    DeadPoint,
    LinkData,
    LoadData,
    Unassemblable,
    cross,
    largest_force,
    linear_solve,
    load_force,
    load_point,
    mp,
    turn,
)

# ---- document 1, Matrix Dynamic Analysis for Four Bar -----


def bar(length):
    """Uniform bar of 2 x 2 cm, 7750 kg/m^3."""
    mass = 7750 * length * 0.02 * 0.02
    return LinkData(length, mass, mass * (length**2 + 0.02**2) / 12, cg_distance=length / 2)


DOCUMENT_1 = FourBarData(bar(0.08), bar(0.12), bar(0.11), ground=0.22, omega2=-20.0, alpha2=100.0, gravity=(0.0, -9.81))

EXACT = {  # from the lengths, to these digits
    "theta3": "20.0105",
    "theta4": "117.4316",
    "omega3": "12.8188",
    "omega4": "-6.1967",
    "alpha3": "-39.822",
    "alpha4": "482.662",
    "vG4x": "0.3025",
    "vG4y": "0.1570",
    "F12x": "-22.2289",
    "F12y": "-6.2164",
    "F32x": "18.7217",
    "F32y": "6.5449",
    "F43x": "5.0578",
    "F43y": "1.7910",
    "F14x": "-2.6449",
    "F14y": "0.3267",
    "T12": "0.811366",
}

PRINTED = {  # F23 and F34 turned into F32 and F43
    "angle": {"theta3": 20.0, "theta4": 117.4},
    "omega": {"omega3": 12.82, "omega4": -6.20},
    "alpha": {"alpha3": -39.6, "alpha4": 482.5},
    "vG": {"vG2x": 0.5657, "vG2y": -0.5657, "vG3x": 0.8683, "vG3y": -0.4086, "vG4x": 0.3027},
    "aG": {
        "aG2x": -14.142,
        "aG2y": -8.485,
        "aG3x": -36.725,
        "aG3y": -22.609,
        "aG4x": -22.624,
        "aG4y": -14.124,
    },
    "force": {
        "F12x": -22.236,
        "F12y": -6.221,
        "F32x": 18.729,
        "F32y": 6.550,
        "F43x": 5.067,
        "F43y": 1.788,
        "F14x": -2.648,
        "F14y": 0.317,
    },
    "torque": {"T12": 0.81135},
}


def half_a_digit(text):
    """Half a unit of the last decimal of a printed number."""
    return mp.mpf(10) ** -len(text.partition(".")[2]) / 2


@pytest.mark.parametrize("name", EXACT)
def test_document_1_exact_from_the_lengths(name):
    value = solve(DOCUMENT_1, 45.0)[name]
    assert abs(value - mp.mpf(EXACT[name])) <= half_a_digit(EXACT[name])


@pytest.mark.parametrize("group", PRINTED)
def test_document_1_as_printed(group):
    """The page rounds angles to 0.1 degree: a number may be off by 0.05 degree, in rad, of the largest alike.

    Of vectors, the longest. Its A_G4, 0.2 % longer than its own alpha4 makes it, needs nearly all of that.
    """
    result = solve(DOCUMENT_1, 45.0)
    largest = {
        "angle": mp.degrees(1),
        "omega": abs(mp.mpf(DOCUMENT_1.omega2)),
        "alpha": result["alpha4"],
        "vG": mp.hypot(result["vG3x"], result["vG3y"]),
        "aG": mp.hypot(result["aG3x"], result["aG3y"]),
        "force": largest_force(result),
        "torque": largest_torque(result, DOCUMENT_1),
    }
    tolerance = mp.radians(mp.mpf("0.05")) * largest[group]
    off = {name: result[name] - mp.mpf(value) for name, value in PRINTED[group].items()}
    assert all(abs(error) <= tolerance for error in off.values()), off


def test_document_1_link_properties():
    """Masses to 0.001 kg, inertias to 0.001 kg cm^2."""
    printed = {"crank": (0.248, 1.405), "coupler": (0.372, 4.588), "rocker": (0.341, 3.552)}
    for name, (mass, inertia) in printed.items():
        link = getattr(DOCUMENT_1, name)
        assert link.mass == pytest.approx(mass, abs=0.5001e-3)
        assert link.inertia * 1e4 == pytest.approx(inertia, abs=0.5001e-3)


def test_document_1_printed_matrix_gives_the_printed_solution():
    """The page's 9x9 [N, cm] in F12, F23, F34, F14, T12 has the page's forces, to the last digit."""
    solution = linear_solve(PAGE_MATRIX, PAGE_RHS)
    residual = [sum(mp.mpf(m) * x for m, x in zip(row, solution, strict=True)) for row in PAGE_MATRIX]
    assert all(abs(left - right) < TIGHT for left, right in zip(residual, PAGE_RHS, strict=True))
    assert all(abs(x - value) <= 0.0005 for x, value in zip(solution, PAGE_SOLUTION, strict=True)), solution


# ---- by hand: a parallelogram at 60 degrees, coupler along x, crank and rocker turning together -----


def parallelogram(**changes):
    """Crank and rocker 2 m, coupler and ground 5 m, all massless and at rest unless changed."""
    crank, coupler = LinkData(2.0, 0.0, 0.0), LinkData(5.0, 0.0, 0.0, cg_distance=1.0, cg_angle=90.0)
    rocker = LinkData(2.0, 0.0, 0.0, cg_distance=1.0)
    return replace(FourBarData(crank, coupler, rocker, ground=5.0), **changes)


COS60, COS30 = mp.mpf(1) / 2, mp.sqrt(3) / 2
BY_HAND = [  # T12 balances each load's virtual work per radian of the crank
    (LoadData("crank", torque=7.0), -7),
    (LoadData("rocker", torque=7.0), -7),
    (LoadData("coupler", torque=7.0), 0),
    (LoadData("rocker", force=(0.0, 3.0), at=(2.0, 0.0), frame="link"), -6),
    (LoadData("rocker", force=(3.0, 0.0), at=(2.0, 0.0), frame="link"), 0),
    (LoadData("rocker", force=(0.0, 3.0), at=(2.0, 0.0)), -6 * COS60),
    (LoadData("rocker", force=(0.0, 3.0), at=(2.0, 90.0)), 6 * COS30),
    (LoadData("rocker", force=(0.0, 3.0), at=(2.0, 90.0), origin="cg"), 6 * COS30 - 3 * COS60),
    (LoadData("crank", force=(3.0, 0.0), at=(2.0, 0.0)), 6 * COS30),
    (LoadData("coupler", force=(0.0, 3.0), at=(4.0, 33.0)), -6 * COS60),
    (LoadData("coupler", force=(3.0, 0.0), at=(4.0, 33.0), frame="link", origin="cg"), 6 * COS30),
]


@pytest.mark.parametrize(("load", "torque"), BY_HAND)
@pytest.mark.parametrize("drive", ["crank", "rocker"])
def test_statics_by_hand(load, torque, drive):
    result = solve(parallelogram(loads=(load,), drive=drive), 60.0)
    assert abs(result["T12" if drive == "crank" else "T14"] - torque) < TIGHT


def test_pin_forces_by_hand():
    """A weight at the middle of the coupler: crank and rocker carry half each, the drive holds the sway."""
    result = solve(parallelogram(loads=(LoadData("coupler", force=(0.0, -8.0), at=(2.5, 0.0)),)), 60.0)
    # the free rocker takes force along itself only: 4 N up asks for 4/tan 60 sideways
    sway = 4 * COS60 / COS30
    expected = {"F43x": sway, "F43y": 4, "F14x": sway, "F14y": 4, "F32x": sway, "F32y": -4}
    expected |= {"F12x": -sway, "F12y": 4, "T12": 8}
    assert all(abs(result[name] - value) < TIGHT for name, value in expected.items())


def test_parallelogram_turns_as_one():
    """Coupler without rotation, every point of it on a circle like B's; centres of gravity by hand."""
    result = solve(parallelogram(omega2=3.0, alpha2=-4.0), 60.0)
    expected = {"theta3": 0, "theta4": 60, "transmission_angle": 60, "Cx": 6, "Cy": 2 * COS30, "Dx": 5}
    expected |= {"omega3": 0, "omega4": 3, "alpha3": 0, "alpha4": -4}
    expected |= {"G3x": 1, "G3y": 2 * COS30 + 1, "G4x": 5 + COS60, "G4y": COS30, "G2x": 0}
    expected |= {"vG3x": -6 * COS30, "vG3y": 6 * COS60}
    expected |= {"aG3x": -18 * COS60 + 8 * COS30, "aG3y": -18 * COS30 - 8 * COS60}
    assert all(abs(result[name] - value) < TIGHT for name, value in expected.items())


def test_singular_positions_are_refused():
    with pytest.raises(Unassemblable):
        solve(DOCUMENT_1, 180.0)  # 8 + 22 cm is more than 12 + 11
    with pytest.raises(Unassemblable):
        solve(parallelogram(), 0.0)  # the fold: it closes, but can leave on two branches
    with pytest.raises(Unassemblable):
        solve(parallelogram(ground_angle=10.0), 370.0)  # the same, with a rounded radicand above zero
    with pytest.raises(Unassemblable):
        solve(parallelogram(ground=2.0, coupler=LinkData(2.0, 0.0, 0.0)), 0.0)  # B falls on D
    with pytest.raises(DeadPoint):
        solve(parallelogram(drive="coupler"), 60.0)  # the coupler does not turn


def test_a_rocker_drive_has_dead_points_where_the_crank_drive_is_at_its_best():
    """Crank 1 and coupler 2 in line to C (3, 0), rocker 4 straight down to D (3, -4)."""
    links = [LinkData(x, 1.0, 1.0) for x in (1.0, 2.0, 4.0)]
    data = FourBarData(*links, ground=5.0, ground_angle=mp.degrees(mp.atan2(-4, 3)), omega2=1.0)
    result = solve(data, 0.0)
    assert abs(result["transmission_angle"] - 90) < TIGHT and abs(result["omega4"]) < TIGHT
    with pytest.raises(DeadPoint):
        solve(replace(data, drive="rocker"), 0.0)


# ---- laws of mechanics on random scenes -----

CASES = [pytest.param(i, *case, id="-".join(case)) for i, case in enumerate(product(KINDS, BRANCHES, LINKS))]


def random_case(seed, kind, branch, drive):
    """A scene of the case and a crank angle away from its toggles."""
    rng = np.random.default_rng(seed)
    data = random_data(rng, kind=kind, branch=branch, drive=drive)
    return data, random_theta2(rng, data)


def centre(name):
    return lambda move: move.G[name]


def point(load):
    return lambda move: load_point(move, load)


@pytest.mark.parametrize(("seed", "kind", "branch", "drive"), CASES)
def test_loop_closes_on_the_right_side(seed, kind, branch, drive):
    data, theta2 = random_case(seed, kind, branch, drive)
    result = solve(data, theta2)
    assert grashof_kind(data.crank.length, data.coupler.length, data.rocker.length, data.ground) == kind
    assert toggle_margin(data, theta2) > 0.1
    B, C, D = (mp.mpc(result[f"{pin}x"], result[f"{pin}y"]) for pin in "BCD")
    for vec, length, angle in [
        (B, data.crank.length, theta2),
        (C - B, data.coupler.length, result["theta3"]),
        (C - D, data.rocker.length, result["theta4"]),
        (D, data.ground, data.ground_angle),
    ]:
        assert close(vec, length * turn(angle), length)
    assert (cross(D - B, C - B) > 0) == (branch == "open")
    assert all(-180 < result[name] <= 180 for name in ("theta3", "theta4"))
    # acute: the sine alone says which of the two angles between the lines
    sine = abs(cross((C - B) / data.coupler.length, (C - D) / data.rocker.length))
    assert close(mp.radians(result["transmission_angle"]), mp.asin(sine), 1)


@pytest.mark.parametrize(("seed", "kind", "branch", "drive"), CASES[::3])
def test_rates_are_derivatives_of_position(seed, kind, branch, drive):
    data, theta2 = random_case(seed, kind, branch, drive)
    at, now = history(motion, data, theta2), motion(data, theta2)
    for name in LINKS:

        def angle(move, name=name):
            return mp.arg(move.line[name] / now.line[name])

        omega, alpha = derivative(at, angle), derivative(at, angle, 2)
        assert close(now.omega[name], omega, abs(omega))
        assert close(now.alpha[name], alpha, abs(alpha) + omega**2)
        velocity, acceleration = derivative(at, centre(name)), derivative(at, centre(name), 2)
        assert close(now.vG[name], velocity, abs(velocity))
        assert close(now.aG[name], acceleration, abs(acceleration))


@pytest.mark.parametrize(("seed", "kind", "branch", "drive"), CASES)
def test_power_balance(seed, kind, branch, drive):
    """Drive power = d(kinetic energy)/dt - power of gravity and loads; every derivative a numerical one."""
    data, theta2 = random_case(seed, kind, branch, drive)
    at, now = history(motion, data, theta2), motion(data, theta2)
    terms = [derivative(at, lambda move: kinetic_energy(links(data), move))]
    for name in LINKS:
        weight = mp.mpf(getattr(data, name).mass) * mp.mpc(*data.gravity)
        terms.append(-dot(weight, derivative(at, centre(name))))
    for load in data.loads:
        terms.append(-dot(load_force(now, load), derivative(at, point(load))))
        terms.append(-load.torque * now.omega[load.link])
    assert close(solve(data, theta2)["power"], sum(terms), max(map(abs, terms)))


@pytest.mark.parametrize(("seed", "kind", "branch", "drive"), CASES)
def test_the_machine_as_a_whole(seed, kind, branch, drive):
    """Ground forces, drive, weights and loads make up the rate of momentum, and of its moment about A."""
    data, theta2 = random_case(seed, kind, branch, drive)
    result, now = solve(data, theta2), motion(data, theta2)
    F14 = mp.mpc(result["F14x"], result["F14y"])
    force = mp.mpc(result["F12x"], result["F12y"]) + F14
    moment = cross(now.pin["D"], F14) + result[torque_name(data)]
    for load in data.loads:
        P = load_force(now, load)
        force += P
        moment += cross(load_point(now, load), P) + load.torque
    for name in LINKS:
        link = getattr(data, name)
        inertia_force = mp.mpf(link.mass) * (now.aG[name] - mp.mpc(*data.gravity))
        force -= inertia_force
        moment -= cross(now.G[name], inertia_force) + mp.mpf(link.inertia) * now.alpha[name]
    assert close(force, 0, largest_force(result))
    assert close(moment, 0, largest_torque(result, data))


def test_random_scenes_cover_what_they_promise():
    """Every drive, branch, frame, origin and link; both signs of omega2; lengths and speeds over decades."""
    rng = np.random.default_rng(0)
    scenes = [random_data(rng) for _ in range(400)]
    assert {(s.drive, s.branch) for s in scenes} == set(product(LINKS, BRANCHES))
    used = {(load.link, load.frame, load.origin) for s in scenes for load in s.loads}
    assert used == set(product(LINKS, ("ground", "link"), ("pin", "cg")))
    assert {len(s.loads) for s in scenes} == {0, 1, 2, 3, 4}
    assert {np.sign(s.omega2) for s in scenes} == {-1, 1}
    assert min(abs(s.omega2) for s in scenes) < 0.2 and max(abs(s.omega2) for s in scenes) > 500
    assert min(s.ground for s in scenes) < 1e-5 and max(s.ground for s in scenes) > 100
    assert {s.ground_angle == 0 for s in scenes} == {s.gravity == (0, 0) for s in scenes} == {True, False}
    assert random_data(np.random.default_rng(5)) == random_data(np.random.default_rng(5))


def test_precision_stays_in_the_oracle():
    """Callers' mpmath keeps its own precision; the oracle's numbers keep theirs."""
    before = mpmath.mp.prec
    result = solve(DOCUMENT_1, 45.0)
    assert mpmath.mp.prec == before
    with mpmath.workdps(20):
        assert close(result["F12"], mp.hypot(result["F12x"], result["F12y"]), result["F12"])
    assert largest_force(result) == max(result[name] for name in FORCES) == result["F12"]
