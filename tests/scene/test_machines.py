"""Example machines: each turns, keeps its power balance, survives its file, and moves as compass and ruler say."""

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest
from compass import MACHINES, ahead, meet, polar

import linksweep as ls

TURN = np.arange(0.0, 360.0, 2.5)
DIG = np.arange(0.0, 41.0, 5.0)  # degrees of the excavator's boom
machines = pytest.mark.parametrize("name", sorted(MACHINES))


def angles(name):
    return DIG if name == "excavator" else TURN


def turning(z):
    """Return how far the direction of z turns to and fro [degree]."""
    return np.degrees(np.ptp(np.unwrap(np.angle(z))))


@machines
def test_a_machine_turns_and_balances_its_power(name):
    cycle = ls.sweep(ls.example(name), angles(name), of=["power_residual"])
    assert not cycle.status.any()
    assert abs(cycle.power_residual).max() < 1e-12


@machines
def test_a_machine_comes_back_from_a_file(name, tmp_path):
    scene = ls.example(name)
    ls.save(scene, tmp_path / "scene.toml")
    assert ls.load_scene(tmp_path / "scene.toml") == scene


@machines
def test_pins_lie_where_compass_and_ruler_find_them(name):
    expected = MACHINES[name](angles(name))
    cycle = ls.sweep(ls.example(name), angles(name), of=[f"{pin}{axis}" for pin in expected for axis in "xy"])
    size = max(abs(place).max() for place in expected.values())
    for pin, place in expected.items():
        assert abs(cycle[f"{pin}x"] + 1j * cycle[f"{pin}y"] - place).max() < 1e-14 * size, pin


@machines
def test_rates_are_slopes_over_the_crank_angle(name):
    """At constant speed: omega is the slope of theta times the crank's speed, and alpha that of omega."""
    scene, step = ls.example(name), 0.01
    grid = angles(name) + 1.0  # off the corners of the excavator's curves
    links = [name.removeprefix("alpha") for name in scene.mechanism.kinematics() if name.startswith("alpha")]
    names = [f"{rate}{k}" for k in links for rate in ("theta", "omega", "alpha")]
    before, at, after = (ls.sweep(scene, grid + d, of=names) for d in (-step, 0.0, step))
    for k in links:
        turned = (after[f"theta{k}"].values - before[f"theta{k}"].values + 180.0) % 360.0 - 180.0
        gained = after[f"omega{k}"].values - before[f"omega{k}"].values
        for rate, gain in ((at[f"omega{k}"], np.radians(turned)), (at[f"alpha{k}"], gained)):
            slope = scene.omega2 * gain / np.radians(2.0 * step)
            assert abs(rate.values - slope).max() < 1e-5 * abs(scene.omega2) ** (1 + rate.name.startswith("alpha")), (
                rate.name
            )


# ------------------------------------------------------------------------- the numbers of their design


def knuckle_stroke():
    """The knuckle is farthest out where crank and rod are stretched, and farthest in where one covers the other."""
    C = np.array([meet(0.552 + 0.36j, 0.36, 0.0, reach) for reach in (0.55, 0.43)])
    return np.ptp(ahead(C, 0.36, -1j, 0.552).imag)


STROKES = {
    "crank-shaper": ("ram", 2 * 0.6 * 0.1 / 0.3),
    "drag-link-press": ("ram", 2 * 0.12),
    "knuckle-press": ("ram", knuckle_stroke()),
    "scotch-yoke": ("yoke", 2 * 0.04),
    "whitworth": ("ram", 2 * 0.09),
}


@pytest.mark.parametrize("name", STROKES)
def test_stroke(name):
    slider, stroke = STROKES[name]
    worst = ls.peaks(ls.example(name), of=[f"x_{slider}"])
    assert float(worst[f"x_{slider}_max"] - worst[f"x_{slider}_min"]) == pytest.approx(stroke, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "quick"),
    [("crank-shaper", 180 - 2 * np.degrees(np.arcsin(1 / 3))), ("whitworth", 2 * np.degrees(np.arccos(5 / 12)))],
)
def test_angle_of_the_quick_return(name, quick):
    worst = ls.peaks(ls.example(name), of=["x_ram"])
    assert float(worst.x_ram_max_at - worst.x_ram_min_at) % 360.0 == pytest.approx(quick, abs=1e-5)


def test_a_pump_jack_of_a_hundred_inches():
    """API Spec 11E measures the stroke along the head's arc, and rounds it down to a standard one."""
    swing = turning(MACHINES["pump-jack"](np.arange(0.0, 360.0, 0.1))["E"] - (111 + 136j) * 0.0254)
    worst = ls.peaks(ls.example("pump-jack"), of=["theta4"])
    assert float(worst.theta4_max - worst.theta4_min) == pytest.approx(swing, abs=1e-4)
    assert 129 * np.radians(swing) == pytest.approx(100, rel=0.01)


def test_klanns_leg_stands_where_his_patent_puts_it():
    """Elbow 27, knee 35, hip 37 and foot 33 of US patent 6,260,862, with the crank at 180 degrees."""
    patent = {"C": 0.741 + 0.75j, "E": 0.232 + 0.866j, "F": 0.866 + 1.5j, "H": 0.0}
    leg = ls.sweep(ls.example("klann-leg"), [180.0], of=[f"{pin}{axis}" for pin in patent for axis in "xy"])
    for pin, place in patent.items():
        pin_place = complex(leg[f"{pin}x"].item(), leg[f"{pin}y"].item())
        assert abs(pin_place - 0.4 * (place - 1.599 - 0.75j)) < 0.4e-3, pin


def test_feet_walk_level():
    """A foot is level within 2 % (Jansen) and 6 % (Klann) of its stride while it carries its load, and lifts after."""
    for name, carrying, level, lift in (("jansen-leg", (297, 430), 0.02, 0.3), ("klann-leg", (20, 160), 0.06, 0.5)):
        foot = MACHINES[name](np.arange(*carrying, 0.5))["H"]
        path = MACHINES[name](TURN)["H"]
        assert np.ptp(foot.imag) < level * np.ptp(path.real), name
        assert np.ptp(path.imag) > lift * np.ptp(path.real), name


def test_hoekens_line_twice_as_long():
    """G pushes along 40 cm, level within a millimetre, for the half turn that its load lasts."""
    pushing = ls.sweep(ls.example("watt-1"), np.arange(90.0, 270.5, 0.5), of=["Gx", "Gy"])
    assert np.ptp(pushing.Gx.values) == pytest.approx(0.4)
    assert np.ptp(pushing.Gy.values) < 1e-3


def test_the_claw_pulls_a_film_by_one_perforation():
    pulling = ls.sweep(ls.example("stephenson-1"), np.arange(68.0, 148.5, 0.5), of=["Hx", "Hy"])
    assert np.ptp(pulling.Hy.values) == pytest.approx(7.62e-3, rel=1e-3)
    assert np.ptp(pulling.Hx.values) < 0.06e-3


def test_a_dwell_for_a_third_of_the_turn():
    waiting = ls.sweep(ls.example("stephenson-3"), np.arange(161.0, 281.5, 0.5), of=["theta6"])
    assert np.ptp(waiting.theta6.values) < 0.6


def test_a_scotch_yoke_in_closed_form():
    """Crank at constant speed: the pin passes on the plunger's pressure and the inertia of the yoke, a pure cosine."""
    cycle = ls.sweep(ls.example("scotch-yoke"), TURN, of=["T12", "a_yoke"])
    omega, sine, cosine = 6 * np.pi, np.sin(np.radians(TURN)), np.cos(np.radians(TURN))
    pressure = np.where(TURN < 180.0, 0.0, 3000.0)
    assert abs(cycle.a_yoke + 0.04 * omega**2 * cosine).max() < 1e-13
    torque = (6.0 * 0.04 * omega**2 * cosine - pressure) * 0.04 * sine
    assert abs(cycle.T12 - torque).max() < 1e-12


def cross(place, force):
    return (place.conj() * force).imag


def test_the_cylinders_of_boom_and_stick_hold_all_moments_about_their_pivots():
    """At rest: those of the weights, of the force on the teeth, and of the earth."""
    pins = MACHINES["excavator"](DIG)
    C, K, I, J = (pins[pin] for pin in "CKIJ")  # noqa: E741
    weights = [
        (1900.0, polar(0.0, C, 2.7, 8.0)),
        (950.0, polar(C, K, 0.9, 12.0)),
        (45.0, 0.5 * (polar(C, K, 2.52, 3.0) + I)),
        (60.0, 0.5 * (I + J)),
        (950.0, polar(K, J, 0.65, -85.0)),
    ]
    teeth = 1e3 * np.array([0, 44 - 16j, 41.5 - 18.5j, 24 - 12j, 0, 0, 0, 0, 0])
    earth = -1e3j * np.array([0, 2.4, 8.4, 14.4, 18, 18, 18, 18, 18])
    forces = [(place, -9.81j * mass) for mass, place in weights]
    forces += [(pins["T"], teeth), (polar(K, J, 0.7, -85.0), earth)]
    at_rest = ls.sweep(replace(ls.example("excavator"), omega2=0.0), DIG, of=["force_c1", "force_c2", "length_c1"])
    ends = {"c1": (0.45 - 0.5j, pins["B"], 0.0, forces), "c2": (polar(0.0, C, 3.05, 19.0), pins["E"], C, forces[1:])}
    for cylinder, (base, end, pivot, carried) in ends.items():
        lever = cross(end - pivot, (end - base) / abs(end - base))
        thrust = -sum(cross(place - pivot, force) for place, force in carried) / lever
        assert abs(at_rest[f"force_{cylinder}"] - thrust).max() < 1e-12 * abs(thrust).max()
    assert abs(at_rest.length_c1 - abs(pins["B"] - 0.45 + 0.5j)).max() < 1e-14


@machines
def test_a_scene_does_not_outlive_its_last_use(name):
    scene = ls.example(name)
    ls.sweep(scene, angles(name))
    last = weakref.ref(scene.at_one_angle.bare), weakref.ref(scene)
    gc.disable()  # nothing is left to it
    try:
        del scene
        assert [each() for each in last] == [None, None]
    finally:
        gc.enable()
