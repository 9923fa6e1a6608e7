"""Section forces of links: closed forms, and the other part of each link as an independent reference.

The reference adds up what acts on the part of a link before a section: forces of pins, slides, cylinders and loads, the
torque of the drive, weight, and inertia by Gauss's quadrature of the motion that `sweep` returns. The package adds up
what acts beyond it, and knows the first pin's force nowhere.
"""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from linksweep.mechanisms.beams.sections import shank_and_eyes

STEEL = {"width": 0.03, "thickness": 0.012, "density": 7850.0}
SHARES = xr.DataArray([0.0, 0.13, 0.4, 0.71, 0.999, 1.0], dims="section")
GAUSS = np.polynomial.legendre.leggauss(3)
LINKAGES = ["press", "watt-1", "watt-2", "stephenson-1", "stephenson-3", "knuckle-press", "crank-shaper", "whitworth"]
LINKAGES += ["drag-link-press", "pump-jack", "jansen-leg", "klann-leg", "wipers", "scissor-lift", "scotch-yoke"]
LINKAGES += ["excavator", "geared-five-bar", "quick-return", "engine"]


def beams(scene):
    """Return the scene with bars for links, third pins moved onto their lines, and places at sections."""
    machine = scene.mechanism
    bars = {role: ls.Bar(machine.parts[role].length, **STEEL) for role in machine.topology.links}
    bars = {role: bar for role, bar in bars.items() if role in machine.parts}
    loads = [load for load in scene.loads if isinstance(load, ls.Load)]
    scene = replace(scene, mechanism=replace(machine, **bars), section=SHARES, loads=loads)
    third = getattr(machine, "points", {}).items()
    moved = {pin: (distance, 180.0 * (k % 2)) for k, (pin, (distance, _)) in enumerate(third)}
    if not moved:
        return scene
    straight = replace(scene, mechanism=replace(scene.mechanism, points=moved))
    closes = bool((ls.sweep(straight, 24, of=[]).status == 0).any())
    return straight if closes else scene


def test_a_bar_that_turns_is_pulled_by_its_outer_part():
    """N = m ω² (L² − x²)/2L, of a bar on a fixed pin that turns at ω, without weight and with a light second bar."""
    crank = ls.Bar(0.3, **STEEL)
    thread = {"width": 1e-6, "thickness": 1e-6, "density": 0.0}
    machine = ls.FourBar(crank, ls.Bar(0.8, **thread), ls.Bar(0.7, **thread), ground=0.6)
    scene = ls.Scene(machine, omega2=50.0, section=SHARES)
    axial = ls.sweep(scene, 7, of=["axial_force2"]).axial_force2
    x = SHARES * 0.3
    expected = crank.mass * 50.0**2 * (0.3**2 - x**2) / (2.0 * 0.3)
    assert float(abs(axial - expected).max()) < 1e-12 * float(expected.max())


def test_a_level_bar_bends_under_its_weight_as_on_two_pins():
    """M = w L²/8 at the middle, of a coupler that lies level between equal cranks at rest."""
    bar = ls.Bar(0.4, **STEEL)
    arm = ls.Bar(0.1, width=0.01, thickness=0.01, density=0.0)
    scene = ls.Scene(ls.FourBar(arm, bar, arm, ground=0.4), omega2=0.0, gravity=(0.0, -9.81), section=0.5)
    moment = ls.sweep(scene, theta2=[90.0], of=["bending_moment3"]).bending_moment3
    assert abs(float(moment[0])) == pytest.approx(bar.mass * 9.81 * 0.4 / 8.0, rel=1e-13)
    assert float(moment[0]) > 0.0  # its lower side, on the right of its line of pins, is in tension


def test_the_larger_stress_is_that_of_the_fibre_that_bears_more():
    cycle = ls.sweep(beams(ls.example("press")), 24, of=["stress3", "stress3_left", "stress3_right"])
    larger = np.maximum(abs(cycle.stress3_left), abs(cycle.stress3_right))
    assert float(abs(cycle.stress3 / larger - 1.0).max()) < 1e-13


@pytest.mark.parametrize("name", long_but(LINKAGES, "press", "watt-2", "crank-shaper", "whitworth", "excavator"))
def test_the_other_part_of_each_link_exerts_the_opposite(name):
    scene = beams(ls.example(name))
    assert scene.mechanism.beams
    for role in scene.mechanism.beams:
        compare(scene, role)


@pytest.mark.parametrize("gears", [{}, {"wheel": ls.Gears(pressure_angle=20.0)}])
@pytest.mark.parametrize(("ratio", "wheel"), [("-2", "D-E-H"), ("-3/2", "E-D-H"), ("3", "D-E")])
def test_gears_bear_on_the_pivots_of_crank_and_wheel(ratio, wheel, gears):
    """Also where these lie between pins: nothing bends an overhang that bears no load."""
    rod = {"width": 0.02, "thickness": 0.02, "density": 7850.0}
    lengths = {"crank": 0.06, "coupler": 0.2, "rod": 0.2, "wheel": 0.05}
    machine = ls.Linkage(
        f"crank A-B-K, coupler B-C, rod C-E, wheel {wheel} : {ratio} crank",
        ground={"A": (0.0, 0.0), "D": (0.2, 0.0)},
        points={pin: (0.04, 180.0) for pin in "KH" if pin in f"K{wheel}"},
        gears=gears,
        **{role: ls.Bar(length, **rod) for role, length in lengths.items()},
    )
    loads = [ls.Load("rod", force=(10.0, -50.0), at=(0.1, 0.0))]
    scene = ls.Scene(machine, omega2=20.0, gravity=(0.0, -9.81), loads=loads, section=SHARES)
    for role in machine.beams:
        compare(scene, role)
    massless = replace(machine.crank, density=0.0)
    without_mass = replace(scene, mechanism=replace(machine, crank=massless), section=0.3)
    overhang = ls.sweep(without_mass, 24, of=["axial_force2", "shear_force2", "bending_moment2"])
    assert max(float(abs(overhang[name]).max()) for name in overhang if name != "status") < 1e-12


@pytest.mark.parametrize("angles", [(0.0, 180.0), (12.0, 160.0)])
def test_third_pins_beyond_both_ends_bear_on_the_link(angles, monkeypatch):
    """Also beside the line of pins, as derivatives to their angles have it: but such a link is refused as a beam."""
    lengths = {"crank": 0.08, "coupler": 0.22, "rocker": 0.18, "rod": 0.22, "output": 0.15, "tail": 0.2, "end": 0.2}
    rod = {"width": 0.02, "thickness": 0.02, "density": 7850.0}
    machine = ls.Linkage(
        "crank A-B, coupler B-C, rocker D-C-E-H, rod E-F, output G-F, tail H-K, end M-K",
        ground={"A": (0, 0), "D": (0.20, 0), "G": (0.42, 0.05), "M": (0.1, -0.3)},
        points={"E": (0.24, angles[0]), "H": (0.10, angles[1])},
        **{name: ls.Bar(length, **rod) for name, length in lengths.items()},
    )
    assert ("rocker" in machine.beams) == (angles[0] == 0.0)
    monkeypatch.setattr(type(machine), "beam_problem", lambda machine, role: "")
    shares = SHARES[1:-1] if angles[0] else SHARES  # through such a pin, rounding decides on which side its force acts
    compare(ls.Scene(replace(machine), omega2=20.0, gravity=(0.0, -9.81), section=shares), "rocker")


def test_a_link_is_a_shank_with_eyes():
    """N = μω²(L² − x²)/2 + m ω² L of a turning link: a thin rod of μ = 2 kg/m with m = 0.3 kg at its end, and more at
    its first pin."""
    length, shank, first, second = 0.3, 0.6, 0.5, 0.3
    mass = shank + first + second
    x = (0.5 * shank + second) * length / mass
    inertia = (shank / 3.0 + second) * length**2 - mass * x * x
    crank = ls.Link(length, mass, inertia, cg_distance=x, section=ls.Tube(0.02))
    thread = {"width": 1e-6, "thickness": 1e-6, "density": 0.0}
    machine = ls.FourBar(crank, ls.Bar(0.8, **thread), ls.Bar(0.7, **thread), ground=0.6)
    axial = ls.sweep(ls.Scene(machine, omega2=50.0, section=SHARES), 5, of=["axial_force2"]).axial_force2
    at = SHARES * length
    expected = 50.0**2 * (shank / length * (length**2 - at**2) / 2.0 + second * length)
    assert float(abs(axial - expected).max()) < 1e-12 * float(expected.max())


@pytest.mark.parametrize(("x", "inertia"), [(-0.05, 1e-3), (0.3, 1e-3), (0.1, 0.05)])
def test_mass_beyond_the_pins_bends_no_shank(x, inertia):
    """A coupler whose mass lies beyond its pins is loaded by pin forces, and by one eye's at either end, alone."""
    distance, angle = abs(x), 0.0 if x > 0.0 else 180.0
    rod = ls.Link(0.2, 0.4, inertia, cg_distance=distance, cg_angle=angle, section=ls.Tube(0.02))
    machine = ls.FourBar(ls.Bar(0.08, **STEEL), rod, ls.Bar(0.2, **STEEL), ground=0.22)
    scene = ls.Scene(machine, omega2=25.0, section=xr.DataArray([0.0, 0.5, 1.0], dims="section"))
    cycle = ls.sweep(scene, 24, of=["shear_force3", "bending_moment3", "axial_force3"])
    for name in ("shear_force3", "axial_force3"):
        assert float(np.ptp(cycle[name].broadcast_like(cycle.bending_moment3).values, axis=0).max()) == 0.0
    bend = cycle.bending_moment3
    assert float(abs(bend[0] - 2.0 * bend[1] + bend[2]).max()) < 1e-12 * float(abs(cycle.shear_force3).max())


@pytest.mark.parametrize(("x", "inertia"), [(0.1, 1e-3), (0.02, 1e-4), (-0.05, 1e-3), (0.3, 1e-3), (0.1, 0.05)])
def test_shank_and_eyes_have_the_mass_of_their_link(x, inertia):
    length, mass = 0.2, 0.4
    shank, eye, moment, own = shank_and_eyes(length, mass, inertia, x)
    first = mass - shank - eye
    of_first = mass * x - 0.5 * shank * length - eye * length - moment
    left = inertia + mass * x * x - (shank / 3.0 + eye) * length**2 - 2.0 * length * moment - own
    assert shank >= 0.0 and moment >= 0.0
    assert of_first == pytest.approx(min(mass * x, 0.0), abs=1e-16)  # beyond it on the other side, else at its pin
    if 0.0 < x < length and shank > 0.0:
        assert min(first, eye) > -0.25 * mass and max(abs(own), abs(left)) < 1e-17
    else:
        assert shank == 0.0 and left >= -1e-17 and own >= -1e-17


@pytest.mark.parametrize("distance", [0.1, 0.3])
def test_a_link_is_bent_by_its_mass_beside_its_line_and_beyond_its_pins(distance):
    rod = ls.Link(0.25, 0.4, 1.5e-3, cg_distance=distance, cg_angle=20.0, section=ls.Tube(0.02))
    machine = ls.FourBar(ls.Bar(0.08, **STEEL), rod, ls.Bar(0.2, **STEEL), ground=0.22)
    compare(ls.Scene(machine, omega2=25.0, alpha2=40.0, gravity=(1.0, -9.81), section=SHARES), "coupler")


def test_loads_act_where_they_stand():
    bar = ls.Link(0.25, 0.4, 2e-3, cg_distance=0.1, cg_angle=20.0, section=ls.Tube(0.02))
    machine = ls.FourBar(ls.Bar(0.08, **STEEL), bar, ls.Bar(0.2, **STEEL), ground=0.22)
    loads = [
        ls.Load("coupler", force=(30.0, -80.0), at=(0.10, 15.0), torque=3.0),
        ls.Load("coupler", force=(10.0, 5.0), at=(0.05, 180.0), frame="link"),
        ls.Load("rocker", torque=-12.0, at=(0.15, 20.0)),
        ls.Load("crank", force=(3.0, 4.0), at=(0.02, 0.0), origin="cg"),
    ]
    scene = ls.Scene(machine, omega2=25.0, alpha2=40.0, gravity=(1.0, -9.81), loads=loads, section=SHARES)
    for role in ("crank", "rocker"):
        compare(scene, role)


def compare(scene, role, count=24):
    """Compare the section forces of a link with those of its other part."""
    k = scene.mechanism.topology.number(role)
    names = [f"axial_force{k}", f"shear_force{k}", f"bending_moment{k}"]
    cycle, expected = ls.sweep(scene, count, of=names), before(scene, role, count)
    force = max(float(abs(part).max()) for part in expected[:2])
    sizes = (force, force, force * scene.mechanism.parts[role].length)
    for name, reference, size in zip(names, expected, sizes, strict=True):
        error = float(abs(cycle[name] + reference).max())
        assert not cycle[name].isnull().all()
        assert error <= 1e-12 * size, (role, name, error, size)


def before(scene, role, count):
    """Return what acts on the part of a link before each section: along, across, and moment about the section."""
    machine = scene.mechanism
    joined, bar, _k = machine.topology, machine.parts[role], machine.topology.number(role)
    grid = scene.grid(count)
    actions, line, start = list(actions_on(scene, role, grid, count)), line_of(scene, role, count), 0.0
    thirds = [machine.points[pin][0] * np.cos(np.radians(machine.points[pin][1])) for pin in joined.links[role][2:]]
    start, end = min([0.0, *thirds]), max([bar.length, *thirds])
    x = start + scene.section * (end - start)
    totals = list(inertia_before(scene, role, count, x))
    for place, force, torque in actions:
        s, c = along(place, line)
        acts = (s < x - 1e-9) | (s < start + 1e-9)
        axial, shear = along(force, line)
        for n, part in enumerate((axial, shear, (s - x) * shear - c * axial + torque)):
            totals[n] = totals[n] + xr.where(acts, part, 0.0)
    return totals


def actions_on(scene, role, grid, count):
    """Yield place (from the link's first pin, in ground axes), force and torque of all that acts on a link."""
    machine, joined = scene.mechanism, scene.mechanism.topology
    k, first = joined.number(role), joined.links[role][0]
    contacts = {joint: joint.partition(":")[0] for joint in joined.pins}
    contacts |= {name: pins_of_slide(joined, name) for name in joined.slides}
    dict.fromkeys(joined.pins.values(), "")
    for joint, pair in {**joined.pins, **joined.slides}.items():
        if k not in pair:
            continue
        i, j = pair
        other, sign = i + j - k, 1.0 if j == k else -1.0
        torque = f"T{i}{j}" if joint in joined.slides and " past " not in joint else ""
        cycle = ls.sweep(scene, count, of=[f"F{other}{k}x", f"F{other}{k}y", *filter(None, [torque])])
        place = from_pin(scene, pin_at(scene, contacts[joint], count), first, count)
        yield place, (cycle[f"F{other}{k}x"], cycle[f"F{other}{k}y"]), sign * cycle[torque] if torque else 0.0
    pushing = [*joined.struts, *([scene.drive] if scene.drive in joined.cylinders else [])]
    for cylinder in pushing:
        P, Q = (pin_at(scene, pin, count) for pin in joined.cylinders[cylinder])
        size = np.hypot(Q[0] - P[0], Q[1] - P[1])
        push = ls.sweep(scene, count, of=[f"force_{cylinder}"])[f"force_{cylinder}"]
        for pin, way, at in zip(joined.cylinders[cylinder], (-1.0, 1.0), (P, Q), strict=True):
            if joined.members[pin][0] == role:
                place = from_pin(scene, at, first, count)
                yield place, tuple(way * push * (q - p) / size for p, q in zip(P, Q, strict=True)), 0.0
    if scene.drive == role:
        torque = machine.drives[role]
        yield (0.0, 0.0), (0.0, 0.0), ls.sweep(scene, count, of=[torque])[torque]
    for wheel in joined.gears:
        if role in ("crank", wheel):
            yield from teeth_on(scene, role, wheel, count)
    line = line_of(scene, role, count)
    for load in scene.at(grid).loads:
        if load.link == role:
            yield from action_of(load, machine.parts[role], line)


def teeth_on(scene, role, wheel, count):
    """Yield what the gears of a wheel exert on a link about its pivot: the moment of their force at the pitch point,
    or without a pressure angle a torque, whose power is that of the other with the opposite sign."""
    machine, joined = scene.mechanism, scene.mechanism.topology
    ratio, k, first = float(joined.gears[wheel]), joined.number(wheel), joined.links[role][0]
    (wheel_pivot,) = {*joined.links[wheel]} & {*joined.ground}
    pivot, way = ("A", 1.0) if role == "crank" else (wheel_pivot, -1.0)
    place = from_pin(scene, pin_at(scene, pivot, count), first, count)
    if wheel not in machine.gears or machine.gears[wheel].pressure_angle is None:
        torque = ls.sweep(scene, count, of=[f"T{k}2"])[f"T{k}2"]
        yield place, (0.0, 0.0), torque if role == "crank" else -torque / ratio
        return
    cycle = ls.sweep(scene, count, of=[f"F{k}2x", f"F{k}2y"])
    fx, fy = way * cycle[f"F{k}2x"], way * cycle[f"F{k}2y"]
    (dx, dy), share = pin_at(scene, wheel_pivot, count), ratio / (ratio - 1.0)  # the pitch point divides A→D so
    x, y = from_pin(scene, (share * dx, share * dy), pivot, count)
    yield place, (fx, fy), x * fy - y * fx


def action_of(load, part, line):
    (cos, sin), (distance, angle) = line, load.at
    x, y = distance * np.cos(np.radians(angle)), distance * np.sin(np.radians(angle))
    if load.origin == "cg":
        x, y = (
            x + part.cg_distance * np.cos(np.radians(part.cg_angle)),
            y + part.cg_distance * np.sin(np.radians(part.cg_angle)),
        )
    fx, fy = load.force or (0.0, 0.0)
    if load.frame == "link":
        fx, fy = fx * cos - fy * sin, fx * sin + fy * cos
    place = (x * cos - y * sin, x * sin + y * cos)
    yield place, (fx, fy), 0.0 if load.torque is None else load.torque


def pins_of_slide(joined, slide):
    """Return the pin at which the force of a slide acts."""
    if " past " in slide:
        return slide.partition(" past ")[2]
    guide, _, role = slide.partition(":")
    (pin,) = [pin for name, (pin, on) in joined.on_guides.items() if on == guide and role in ("", name)]
    return pin


def pin_at(scene, pin, count):
    """Return the position of a pin from the crank's pivot."""
    machine = scene.mechanism
    if pin in machine.topology.ground:
        if isinstance(machine, ls.Linkage):
            (x, y), (x0, y0) = machine.ground[pin], next(iter(machine.ground.values()))
            return x - x0, y - y0
        angle = np.radians(machine.frame_angle)
        return (0.0, 0.0) if pin == "A" else (machine.ground * np.cos(angle), machine.ground * np.sin(angle))
    cycle = ls.sweep(scene, count, of=[f"{pin}x", f"{pin}y"])
    return cycle[f"{pin}x"], cycle[f"{pin}y"]


def from_pin(scene, place, pin, count):
    """Return a place from a pin."""
    x, y = pin_at(scene, pin, count)
    return place[0] - x, place[1] - y


def line_of(scene, role, count):
    """Return cosine and sine of a link's line of pins."""
    k = scene.mechanism.topology.number(role)
    cycle = ls.sweep(scene, count, of=[f"theta{k}"] if k > 2 else [])
    angle = np.radians(cycle[f"theta{k}"] if k > 2 else cycle["theta2"])
    return np.cos(angle), np.sin(angle)


def along(vector, line):
    """Return the components of a vector along and across a line."""
    (x, y), (cos, sin) = vector, line
    return x * cos + y * sin, y * cos - x * sin


def inertia_before(scene, role, count, x):
    """Return the inertia and weight of a link before each section: of its first eye, and of its shank."""
    link, k = scene.mechanism.parts[role], scene.mechanism.topology.number(role)
    first, shank, spin, (at, beside) = masses_of(link)
    cycle = ls.sweep(scene, count, of=[f"aG{k}x", f"aG{k}y", f"omega{k}", f"alpha{k}"])
    line, length = line_of(scene, role, count), link.length
    gx, gy = scene.gravity
    b, c = along((gx - cycle[f"aG{k}x"], gy - cycle[f"aG{k}y"]), line)
    end = np.minimum(np.maximum(x, 0.0), length)
    omega, alpha, axial, shear, moment = cycle[f"omega{k}"], cycle[f"alpha{k}"], 0.0, 0.0, 0.0
    pieces = [(0.5 * end * (1.0 + node), shank / length * 0.5 * end * w) for node, w in zip(*GAUSS, strict=True)]
    for s, mass in [(0.0, first), *pieces]:
        normal, across = b + omega**2 * (s - at), c - alpha * (s - at)
        axial, shear = axial + mass * normal, shear + mass * across
        moment = moment + mass * ((s - x) * across - beside * normal)
    return axial, shear, moment - spin * end / length * alpha


def masses_of(link):
    """Return the mass of a link's first eye and of its shank, that one's moment of inertia about its own line, and the
    centre of gravity along and beside the line of pins, which lies between the pins."""
    if isinstance(link, ls.Bar):
        return 0.0, link.mass, link.mass * link.width**2 / 12.0, (0.5 * link.length, 0.0)
    cos, sin = np.cos(np.radians(link.cg_angle)), np.sin(np.radians(link.cg_angle))
    along_pins = link.cg_distance * cos
    shank, second, *_ = shank_and_eyes(link.length, link.mass, link.inertia, along_pins)
    return link.mass - shank - second, shank, 0.0, (along_pins, link.cg_distance * sin)
