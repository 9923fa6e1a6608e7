"""The reference of the slider-crank obeys the laws of mechanics, on random scenes."""

from dataclasses import replace
from itertools import product

import numpy as np
import oracle
import pytest
from laws import all_close, close, derivative, dot, history, kinetic_energy
from oracle import FourBarData, torque_name
from oracle_slider_crank import (
    DRIVEN,
    DRIVES,
    KINDS,
    LINKS,
    Jammed,
    TwoSolutions,
    largest_torque,
    links,
    mirrored,
    motion,
    random_data,
    random_theta2,
    solve,
    toggle_margin,
    wedging,
)
from references import BRANCHES, FORCES, LinkData, cross, largest_force, load_force, load_point, mp, turn

CASES = [
    pytest.param((seed, kind, branch, drive, rubs), id=f"{kind}-{branch}-{drive}-{'friction' if rubs else 'smooth'}")
    for seed, (kind, branch, drive, rubs) in enumerate(product(KINDS, BRANCHES, DRIVES, (True, False)))
]


def random_case(seed, kind, branch, drive, rubs, jammed=False):
    """A scene of the case and a crank angle away from its toggles."""
    rng = np.random.default_rng(seed)
    friction = float(rng.uniform(0.1, 0.8)) if rubs else 0.0
    data = random_data(rng, kind=kind, branch=branch, drive=drive, friction=friction)
    return data, random_theta2(rng, data, jammed=jammed)


@pytest.mark.parametrize("case", CASES)
def test_loop_closes_on_the_right_side(case):
    data, theta2 = random_case(*case)
    result, s = solve(data, theta2), turn(data.slide_angle)
    assert (data.rod.length > data.crank.length + abs(data.offset)) == (case[1] == "full_turn")
    assert toggle_margin(data, theta2) > 0.1
    B, C = (mp.mpc(result[f"{pin}x"], result[f"{pin}y"]) for pin in "BC")
    assert close(B, data.crank.length * turn(theta2), data.crank.length)
    assert close(C - B, data.rod.length * turn(result["theta3"]), data.rod.length)
    assert close(C, (result["x_slider"] + 1j * mp.mpf(data.offset)) * s, abs(C))
    assert (dot(s, C - B) > 0) == (data.branch == "open") and -180 < result["theta3"] <= 180
    # acute: the sine alone says which of the two angles between the lines
    sine = abs(dot(s, C - B)) / data.rod.length
    assert close(mp.sin(mp.radians(result["transmission_angle"])), sine, 1)
    assert 0 <= result["transmission_angle"] <= 90


@pytest.mark.parametrize("case", CASES[::2])
def test_rates_are_derivatives_of_position(case):
    data, theta2 = random_case(*case)
    at, now, result = history(motion, data, theta2), motion(data, theta2), solve(data, theta2)
    for name in LINKS:

        def angle(move, name=name):
            return mp.arg(move.line[name] / now.line[name])

        def centre(move, name=name):
            return move.G[name]

        omega, alpha = derivative(at, angle), derivative(at, angle, 2)
        assert close(now.omega[name], omega, abs(omega))
        assert close(now.alpha[name], alpha, abs(alpha) + omega**2)
        velocity, acceleration = derivative(at, centre), derivative(at, centre, 2)
        assert close(now.vG[name], velocity, abs(velocity))
        assert close(now.aG[name], acceleration, abs(acceleration))
    s, speed = turn(data.slide_angle), abs(now.vG["slider"])
    assert close(result["v_slider"] * s, velocity, speed)
    assert close(result["a_slider"] * s, acceleration, abs(acceleration))
    all_close(result, {"omega3": now.omega["rod"], "alpha3": now.alpha["rod"]}, 0)


@pytest.mark.parametrize("case", CASES)
def test_power_balance(case):
    """Drive power = d(kinetic energy)/dt - power of gravity and loads + friction loss, with numerical derivatives."""
    data, theta2 = random_case(*case)
    at, now, result = history(motion, data, theta2), motion(data, theta2), solve(data, theta2)
    terms = [derivative(at, lambda move: kinetic_energy(links(data), move)), result["friction_power"]]
    for name, link in links(data).items():
        weight = mp.mpf(link.mass) * mp.mpc(*data.gravity)
        terms.append(-dot(weight, derivative(at, lambda move, name=name: move.G[name])))
    for load in data.loads:
        terms.append(-dot(load_force(now, load), derivative(at, lambda move, load=load: load_point(move, load))))
        terms.append(-load.torque * now.omega[load.link])
    assert close(result["power"], sum(terms), max(map(abs, terms)))
    assert close(result["power"], result[torque_name(data)] * now.omega[DRIVEN[data.drive]], abs(result["power"]))


@pytest.mark.parametrize("case", CASES)
def test_the_machine_as_a_whole(case):
    """Ground forces, guide's moment, drive, weights and loads make up the rate of momentum, and its moment about A."""
    data, theta2 = random_case(*case)
    result, now = solve(data, theta2), motion(data, theta2)
    F14 = mp.mpc(result["F14x"], result["F14y"])
    force = mp.mpc(result["F12x"], result["F12y"]) + F14
    moment = cross(now.pin["C"], F14) + result["T14"] + result[torque_name(data)]
    for load in data.loads:
        P = load_force(now, load)
        force += P
        moment += cross(load_point(now, load), P) + load.torque
    for name, link in links(data).items():
        inertia_force = mp.mpf(link.mass) * (now.aG[name] - mp.mpc(*data.gravity))
        force -= inertia_force
        moment -= cross(now.G[name], inertia_force) + mp.mpf(link.inertia) * now.alpha[name]
    assert close(force, 0, largest_force(result))
    assert close(moment, 0, largest_torque(result, data))


@pytest.mark.parametrize("case", CASES)
def test_friction_opposes_the_motion(case):
    """F14 lies on the edge of the friction cone that brakes, on whichever side the slider presses."""
    data, theta2 = random_case(*case)
    result, s, mu = solve(data, theta2), turn(data.slide_angle), mp.mpf(data.friction)
    F14, v = (mp.mpc(result[f"{name}x"], result[f"{name}y"]) for name in ("F14", "vG4"))
    N, size = dot(1j * s, F14), result["F14"]
    assert close(dot(s, F14), -mu * abs(N) * mp.sign(dot(s, v)), size)
    assert close(F14, (result["friction_force"] + 1j * result["normal_force"]) * s, size)
    assert close(result["friction_power"], mu * abs(N) * abs(v), size * abs(v))
    assert (result["friction_power"] > 0) == (data.friction > 0) and (result["friction_force"] == 0) == (mu == 0)


@pytest.mark.parametrize("case", CASES[::2])
def test_no_sudden_friction(case):
    """As mu -> 0 every force and torque leaves its frictionless value in proportion to mu."""
    data, theta2 = random_case(*case)
    small = mp.mpf("1e-25")
    smooth, once, twice = (solve(replace(data, friction=mu), theta2) for mu in (0, small, 2 * small))
    for name in (*(pin + axis for pin in FORCES for axis in "xy"), "T14", torque_name(data), "friction_power"):
        scale = abs(smooth[name]) + largest_force(smooth) + largest_torque(smooth, data)
        scale *= 1 + abs(smooth["v_slider"])
        change = once[name] - smooth[name]
        assert abs(change) <= 1e3 * small * scale
        assert abs(twice[name] - smooth[name] - 2 * change) <= 1e6 * small**2 * scale
    assert once["friction_power"] > 0


@pytest.mark.parametrize("share", ["0.3", "0.999999", "1.000001", "4"])
@pytest.mark.parametrize("case", CASES[1::2])
def test_wedging(case, share):
    """Jammed where, and only where, either edge of the friction cone turns the free link the same way.

    A unit guide force on the braking edge for N > 0 must turn it about its pin to one side, for N < 0 to the other.
    """
    data, theta2 = random_case(*case)
    smooth, g = solve(data, theta2), mp.radians(mp.mpf(data.slide_angle))
    free = {"crank": mp.radians(smooth["theta3"]), "coupler": mp.radians(mp.mpf(theta2))}[data.drive]
    phi = mp.atan(mp.mpf(share) / abs(mp.tan(free - g)))
    data = replace(data, friction=mp.tan(phi))
    lean = mp.sign(smooth["v_slider"]) * phi
    edges = [g + mp.pi / 2 + lean, g - mp.pi / 2 - lean]
    one, other = (mp.sign(mp.sin(edge - free)) for edge in edges)
    assert (one == other) == (mp.mpf(share) > 1)
    assert close(wedging(data, motion(data, theta2)), mp.mpf(share), 1)
    if one == other:
        with pytest.raises((Jammed, TwoSolutions)):
            solve(data, theta2)
    else:
        result = solve(data, theta2)
        angle = mp.atan2(result["F14y"], result["F14x"])
        assert any(close(mp.expj(angle), mp.expj(edge), 1) for edge in edges)


SAME = ("x_slider", "v_slider", "a_slider", "transmission_angle", "power", "friction_power", "friction_force", *FORCES)
OPPOSITE = ("theta3", "omega3", "alpha3", "T14", "normal_force")


@pytest.mark.parametrize("case", CASES)
def test_mirror(case):
    data, theta2 = random_case(*case)
    result, mirror = solve(data, theta2), solve(mirrored(data), -theta2)
    same, opposite = list(SAME), [*OPPOSITE, torque_name(data)]
    for name in (name for name in result if name[-1] in "xy"):
        (same if name[-1] == "x" else opposite).append(name)
    sizes = {name: abs(result[name]) for name in (*same, *opposite)}
    assert all(close(mirror[name], result[name], sizes[name]) for name in same)
    assert all(close(mirror[name], -result[name], sizes[name]) for name in opposite)


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize("drive", DRIVES)
def test_limit_of_a_four_bar_with_an_endless_rocker(branch, drive):
    """A rocker of length R straight under C, all its mass there: the difference fades as 1/R."""
    rng = np.random.default_rng(7)
    data = random_data(rng, branch=branch, drive=drive, friction=0.0, scale=1.0, loads=3)
    loads = tuple(one for one in data.loads if one.link != "slider")
    data = replace(data, slide_angle=0.0, slider_cg_distance=0.0, loads=loads)
    theta2 = random_theta2(rng, data)
    result, named = solve(data, theta2), {"rod": "coupler"}
    loads = tuple(replace(one, link=named.get(one.link, one.link)) for one in data.loads)
    state = {name: getattr(data, name) for name in ("omega2", "alpha2", "gravity", "drive", "branch")}
    errors = []
    for R in (mp.mpf("1e20"), mp.mpf("1e21")):
        D = mp.mpc(result["Cx"], result["Cy"] - R)
        rocker = LinkData(R, data.slider_mass, 0.0, cg_distance=R)
        ground = {"ground": abs(D), "ground_angle": mp.degrees(mp.arg(D))}
        bars = oracle.solve(FourBarData(data.crank, data.rod, rocker, **ground, **state, loads=loads), theta2)
        names = ("Bx", "Cx", "Cy", "omega3", "alpha3", "aG3x", "aG3y", "aG4x", "F12x", "F12y", "F32x", "F32y", "F43x")
        names = (*names, "F43y", "F14y", torque_name(data))
        errors.append([abs(bars[name] - result[name]) / (1 + abs(result[name])) for name in names])
    assert 0 < max(errors[0]) < 1e-16
    assert mp.mpf("9.9") < max(errors[0]) / max(errors[1]) < mp.mpf("10.1")
    assert len(data.loads) >= 1


def test_random_scenes_cover_what_they_promise():
    """Every kind, drive, branch, frame, origin and link; offsets and speeds of both signs; scales; jammed samples."""
    rng = np.random.default_rng(0)
    scenes = [random_data(rng) for _ in range(400)]
    assert {(s.drive, s.branch) for s in scenes} == set(product(DRIVES, BRANCHES))
    used = {(load.link, load.frame, load.origin) for s in scenes for load in s.loads}
    assert used == set(product(LINKS, ("ground", "link"), ("pin", "cg")))
    assert {len(s.loads) for s in scenes} == {0, 1, 2, 3, 4}
    assert {np.sign(s.omega2) for s in scenes} == {-1, 1} and {np.sign(s.offset) for s in scenes} == {-1, 0, 1}
    full = {(s.rod.length > s.crank.length + abs(s.offset), np.sign(s.offset)) for s in scenes}
    assert full == set(product((True, False), (-1, 0, 1)))
    assert min(s.friction for s in scenes) == 0 < 0.75 < max(s.friction for s in scenes) <= 0.8
    assert min(s.rod.length for s in scenes) < 2e-5 and max(s.rod.length for s in scenes) > 50
    assert {s.slide_angle == 0 for s in scenes} == {s.gravity == (0, 0) for s in scenes} == {True, False}
    assert random_data(np.random.default_rng(5)) == random_data(np.random.default_rng(5))
    moves = [motion(s, random_theta2(rng, s)) for s in scenes]
    jams = [wedging(s, move) for s, move in zip(scenes, moves, strict=True)]
    assert 20 < sum(jam > 1 for jam in jams) < 100 and min(abs(jam - 1) for jam in jams) > 0.05
    moving = [abs(cross(m.line["crank"], m.line["rod"])) for s, m in zip(scenes, moves, strict=True) if s.friction]
    assert min(moving) > 0.1
