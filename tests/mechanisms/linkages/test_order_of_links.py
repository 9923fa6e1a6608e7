"""The order of links in the text, and of pins in a link, decides names and axes alone: forces on each link stay."""

import itertools
import random
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but
from random_linkages import swept

import linksweep as ls
from linksweep.chains.topology import RRR

ORDERS = list(itertools.permutations(("coupler", "rocker", "rod", "output")))
PINS = ["coupler C-B", "rod F-E", "output F-G", *(f"rocker {'-'.join(pins)}" for pins in itertools.permutations("DCE"))]
THETA2 = np.array([10.0, 77.0, 160.0, 233.0, 310.0])
OTHER = {"open": "crossed", "crossed": "open"}
ARMS = ["-".join(pins) for pins in itertools.permutations("JKL")]
LOADED = ls.Load("output", torque=-12.0)


def watt() -> ls.Scene:
    """Return a Watt II six-bar, its centres of gravity beside the lines of pins."""
    lengths = {"crank": 0.08, "coupler": 0.22, "rocker": 0.18, "rod": 0.2, "output": 0.15}
    parts = {role: ls.Link(x, 9.0 * x, x**3, 0.4 * x, 300.0 * x) for role, x in lengths.items()}
    text = "crank A-B, coupler B-C, rocker D-C-E, rod E-F, output G-F"
    ground = {"A": (0.0, 0.0), "D": (0.20, 0.0), "G": (0.42, 0.05)}
    machine = ls.Linkage(text, ground=ground, points={"E": (0.12, -35.0)}, branch={"F": "crossed"}, **parts)
    return ls.Scene(machine, 30.0, 11.0, (0.3, -9.81), [LOADED])


def knuckle() -> ls.Scene:
    scene = ls.example("knuckle-press")
    return replace(scene, loads=[ls.Load("ram", force=(0.0, 3e5))])


def arm_past_a_pin() -> ls.Scene:
    """Return an arm on a ground pin, its guide at an angle to all its lines of pins, that pushes two rams."""
    lengths = {"crank": 0.2, "arm": 0.8, "rod": 1.8, "link": 1.9}
    parts = {role: ls.Link(x, 2.0 * x, x**3, 0.4 * x, 300.0 * x) for role, x in lengths.items()}
    text = "crank A-B, arm J-K-L past B, rod L-M, ram M on slide, link K-N, weight N on slide"
    guides = {"arm": ls.Guide((0.1, 0.3), 50.0, of="arm"), "slide": ls.Guide((0.0, 0.4), 10.0)}
    ground, points = {"A": (0.0, 0.0), "J": (-0.5, -0.6)}, {"L": (0.6, 75.0)}
    rams = {"ram": ls.Slider(3.0), "weight": ls.Slider(2.0)}
    machine = ls.Linkage(text, ground=ground, points=points, guides=guides, **parts, **rams)
    return ls.Scene(machine, 5.0, 2.0, (0.3, -9.81), [ls.Load("ram", force=(-100.0, 0.0))])


def reordered(scene: ls.Scene, order: tuple[str, ...]) -> ls.Scene:
    """Return a scene with the links of its text in another order; a pin of two links that change places turns sides."""
    machine = scene.mechanism
    written = {text.split()[0]: text for text in machine.links.split(", ")}
    links = ", ".join(written[role] for role in (machine.roles[0], *order))
    unsided = replace(machine, links=links, branch={})
    before = {step.pin: step.first.role for step in machine.topology.steps if isinstance(step, RRR)}
    branch = {step.name: machine.branch.get(step.name, "open") for step in unsided.topology.steps}
    for step in unsided.topology.steps:
        if isinstance(step, RRR) and step.first.role != before[step.pin]:
            branch[step.pin] = OTHER[branch[step.pin]]
    return replace(scene, mechanism=replace(unsided, branch=branch))


def turned(scene: ls.Scene, role: str, pins: str) -> ls.Scene:
    """Return a scene with the pins of a link in another order: its axes begin at another pin, and lie otherwise."""
    machine = scene.mechanism
    part, old = machine.parts[role], machine.topology.links[role]
    places = {old[0]: 0.0, old[1]: part.length} | {pin: polar(*machine.points[pin]) for pin in old[2:]}
    first, second, *others = pins.split("-")
    start, line = places[first], places[second] - places[first]

    def own(place: complex) -> tuple[float, float]:
        seen = (place - start) / line * abs(line)
        return float(abs(seen)), float(np.degrees(np.angle(seen)))

    distance, angle = own(polar(part.cg_distance, part.cg_angle))
    link = ls.Link(float(abs(line)), part.mass, part.inertia, distance, angle)
    points = {pin: place for pin, place in machine.points.items() if pin not in old[2:]}
    points |= {pin: own(places[pin]) for pin in others}
    links = machine.links.replace(f"{role} {'-'.join(old)}", f"{role} {pins}")
    guides = {
        name: turned_guide(guide, start, line) if guide.of == role else guide for name, guide in machine.guides.items()
    }
    return replace(scene, mechanism=replace(machine, links=links, points=points, guides=guides, **{role: link}))


def turned_guide(guide: ls.Guide, start: complex, line: complex) -> ls.Guide:
    """Return a link's guide in the link's axes from another start along another line."""
    through = (complex(*guide.through) - start) / line * abs(line)
    return replace(guide, through=(through.real, through.imag), angle=guide.angle - float(np.degrees(np.angle(line))))


def polar(distance: float, angle: float) -> complex:
    return distance * np.exp(1j * np.radians(angle))


def forces_on_links(scene: ls.Scene) -> dict[tuple[str, str], np.ndarray]:
    """Return the whole force (components along x and y) at each pin or slide on each of its links; and the torque."""
    joined, cycle = scene.mechanism.topology, swept(scene, THETA2)
    assert not cycle.status.any()
    role_of = {joined.number(role): role for role in joined.roles}
    whole: dict[tuple[str, str], np.ndarray] = {("", "torque"): np.array([cycle.T12.values])}
    for joint, (i, j) in {**joined.pins, **joined.slides}.items():
        force = np.array([cycle[f"F{i}{j}x"], cycle[f"F{i}{j}y"]])
        for number, sign in ((i, -1.0), (j, 1.0)):
            key = role_of.get(number, "ground"), joint.partition(":")[0]
            whole[key] = whole.get(key, 0.0) + sign * force
    return whole


def assert_equal_forces(scene: ls.Scene, expected: ls.Scene) -> None:
    result, reference = forces_on_links(scene), forces_on_links(expected)
    largest = max(float(abs(force).max()) for key, force in reference.items() if key[0])
    assert result.keys() == reference.keys()
    for key, force in reference.items():
        np.testing.assert_allclose(result[key], force, rtol=1e-11, atol=1e-13 * largest, err_msg=str(key))


@pytest.mark.parametrize("order", long_but(ORDERS, ORDERS[9], ORDERS[-1]))
def test_order_of_the_links_of_a_six_bar(order):
    assert_equal_forces(reordered(watt(), order), watt())


@pytest.mark.parametrize("seed", long_but(range(4), 1))
def test_order_of_links_that_share_a_pin(seed):
    """Whichever link carries pin C, the whole force on each of the three stays."""
    order = random.Random(seed).sample(("rod", "upper", "lower", "ram"), 4)
    assert_equal_forces(reordered(knuckle(), tuple(order)), knuckle())


@pytest.mark.parametrize("link", long_but(PINS, "rocker E-C-D", "rod F-E"))
def test_order_of_the_pins_of_a_link(link):
    assert_equal_forces(turned(watt(), *link.split()), watt())


@pytest.mark.parametrize("pins", long_but(ARMS, "L-K-J", "K-L-J"))
def test_order_of_the_pins_of_an_arm_past_a_pin(pins):
    """Both pins that push a ram keep their places, its known pin J named first, second or third."""
    assert_equal_forces(turned(arm_past_a_pin(), "arm", pins), arm_past_a_pin())


@pytest.mark.parametrize("pins", long_but(ARMS, "J-K-L", "K-L-J"))
def test_the_position_on_an_arm_counts_from_its_known_pin(pins):
    """From J along the guide to the crank's pin B, which lies ahead of it where the arm is open."""
    scene = turned(arm_past_a_pin(), "arm", pins)
    cycle, guide = swept(scene, THETA2), scene.mechanism.guides["arm"]
    from_J = polar(0.2, THETA2) - complex(*scene.mechanism.ground["J"])
    ahead = (from_J / polar(1.0, cycle.theta3.values + guide.angle)).real
    assert (ahead > 0.0).all()
    np.testing.assert_allclose(cycle.x_arm, ahead, rtol=1e-12)


# ---- links that turn about a ground pin, whichever of their pins that is


@pytest.mark.parametrize("pins", ["C-D-E", "E-C-D"])
def test_travel_of_links_whose_first_pin_is_not_the_one_on_the_ground(pins):
    expected, motion = ls.geometry(watt()), ls.geometry(turned(turned(watt(), "rocker", pins), "output", "F-G"))
    for name in ("theta4_travel", "theta6_travel"):
        assert float(motion[name]) == pytest.approx(float(expected[name]), rel=1e-12)


def test_a_load_over_the_angle_of_a_link_whose_second_pin_is_on_the_ground():
    """From F to G the angle is that from G to F, turned by 180 degrees."""
    angles = ls.sweep(watt(), 720, of=["theta6"]).theta6
    table = xr.DataArray([-20.0, 30.0], {"position": [float(angles.min()), float(angles.max())]}, "position")
    assert float(angles.max()) < 0.0  # so that the other angle, larger by 180 degrees, stays below 180
    over = {"over": "output.angle", "while_": "clockwise", "interpolation": "linear"}
    scene = replace(watt(), loads=[ls.Load("output", torque=table, **over)])
    opposite = table.assign_coords(position=table.position + 180.0)
    other = replace(turned(watt(), "output", "F-G"), loads=[ls.Load("output", torque=opposite, **over)])
    expected, torque = (ls.sweep(each, 360, of=["T12"]).T12 for each in (scene, other))
    np.testing.assert_allclose(torque, expected, rtol=0.0, atol=1e-11 * float(abs(expected).max()))


def test_the_curve_is_drawn_by_the_first_link_that_no_ground_pin_holds():
    scene = reordered(turned(watt(), "rocker", "C-D-E"), ("rocker", "coupler", "rod", "output"))
    curve, named = (ls.coupler_curve(scene, (0.1, 15.0), theta2=8, **link) for link in ({}, {"link": "coupler"}))
    np.testing.assert_array_equal(curve.Px, named.Px)
