"""Springs and dampers: numbers by hand, 60-digit arithmetic, energy, bits."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import oracle
import oracle_slider_crank
import pytest
import references
import xarray as xr
from references import largest_force, log_uniform, mp, polar, turn

import linksweep as ls
from linksweep.engine import run
from linksweep.engine.trace.plan import plan
from linksweep.physics.algebra.arctangent import arctangent

CRANK = ls.Link(0.04, 0.25, 1.3e-4, cg_distance=0.013, cg_angle=70.0)
LONG = ls.Link(0.12, 0.4, 5e-4, cg_distance=0.05, cg_angle=12.0)
ROCKER = ls.Link(0.09, 0.33, 4e-4, cg_distance=0.06, cg_angle=-33.0)
FOUR_BAR = ls.FourBar(CRANK, LONG, ROCKER, ground=0.13, ground_angle=20.0)
SLIDER_CRANK = ls.SliderCrank(CRANK, LONG, slider_mass=0.5, offset=0.01, friction=0.1, slide_angle=-15.0)
INVERTED = ls.InvertedSliderCrank(CRANK, ROCKER, ground=0.13, block_mass=0.2, block_inertia=1e-4, offset=0.01)
MECHANISMS = {"four-bar": FOUR_BAR, "slider-crank": SLIDER_CRANK, "inverted": INVERTED}


def all_kinds(mechanism):
    """Return springs and dampers, linear and torsional, between several pairs of links."""
    crank, middle, last = mechanism.roles
    return [
        ls.Spring(("ground", 0.3, 0.1), (middle, 0.1, 15.0), rate=2000.0, free_length=0.05),
        ls.Spring((last, 0.02, 100.0), (crank, 0.05, -30.0), rate=900.0, free_length=0.0),
        ls.Damper((last, 0.05, 10.0), (middle, 0.1, 15.0), coefficient=20.0),
        ls.TorsionSpring("ground", last, rate=5.0, free_angle=80.0),
        ls.TorsionSpring(middle, last, rate=3.0, free_angle=-40.0),
        ls.TorsionDamper(crank, middle, coefficient=0.02),
    ]


def scene(mechanism=FOUR_BAR, loads=(), **changes):
    return ls.Scene(mechanism, **{"omega2": -31.0, "gravity": (0.3, -9.81)} | changes, loads=loads)


# ---- by hand: a parallelogram of weightless links, crank upright, so that B = (0, 1), C = (2, 1) -----

NOTHING = ls.Link(1.0, 0.0, 0.0)
PARALLELOGRAM = ls.FourBar(NOTHING, replace(NOTHING, length=2.0), NOTHING, ground=2.0)
BY_HAND = [
    # 5 m long, 2 m more than free: 20 N on C, towards (5, 5); the coupler is a strut and passes 12 N on to the crank
    (
        ls.Spring(("ground", 5.0, 5.0), ("rocker", 1.0, 0.0), rate=10.0, free_length=3.0),
        {"F43x": 12.0, "F43y": 0.0, "F14x": 0.0, "F14y": -16.0, "F12x": -12.0, "T12": 12.0, "load1_tension": 20.0},
    ),
    # pushes: 4 m too short for its free length
    (
        ls.Spring(("rocker", 1.0, 0.0), ("ground", 5.0, 5.0), rate=10.0, free_length=9.0),
        {"F43x": -24.0, "F43y": 0.0, "F14y": 32.0, "T12": -24.0, "load1_tension": -40.0, "load1_length": 5.0},
    ),
    # from B to the middle of ground, (1, 0): it pulls B by (1, -1)
    (
        ls.Spring(("coupler", 0.0, 0.0), ("ground", 1.0, 0.0), rate=1.0, free_length=0.0),
        {"F32x": 1.0, "F32y": -1.0, "F43x": 0.0, "F43y": 0.0, "F12x": -1.0, "F12y": 1.0, "T12": 1.0},
    ),
    # C goes to the left at 2 m/s, away from (5, 1)
    (
        ls.Damper(("ground", 5.0, 1.0), ("rocker", 1.0, 0.0), coefficient=4.0),
        {"load1_tension": 8.0, "F43x": 8.0, "F14x": 0.0, "T12": 8.0, "power": 16.0, "load1_power": -16.0},
    ),
    # wound by 30 degrees
    (
        ls.TorsionSpring("ground", "rocker", rate=6.0, free_angle=60.0),
        {"load1_twist": 30.0, "load1_to_torque": -np.pi, "T12": np.pi, "F43x": np.pi, "F43y": 0.0},
    ),
    # the coupler stands 90 degrees back of the crank: a torque couple, which the coupler takes at its ends
    (
        ls.TorsionSpring("crank", "coupler", rate=2.0, free_angle=-45.0),
        {"load1_twist": -45.0, "load1_to_torque": np.pi / 2, "F43y": np.pi / -4, "T12": np.pi / 2},
    ),
    (ls.TorsionDamper("ground", "crank", coefficient=3.0), {"T12": 6.0, "F12x": 0.0, "load1_power": -12.0}),
    (ls.TorsionDamper("crank", "rocker", coefficient=3.0), {"T12": 0.0, "load1_to_torque": 0.0}),
]


@pytest.mark.parametrize(("action", "expected"), BY_HAND)
def test_by_hand(action, expected):
    still = ls.Scene(PARALLELOGRAM, omega2=2.0, loads=action)
    cycle = ls.sweep(still, theta2=[90.0], of=list(expected))
    assert {name: float(cycle[name].squeeze()) for name in expected} == pytest.approx(expected, abs=1e-13)


def test_a_spring_of_no_length_has_no_force():
    """The crank pin passes through the spring's fixed end at 0 degrees: the forces are those without it."""
    through = ("ground", 0.04, 0.0), ("crank", 0.04, 0.0)
    loads = [ls.Spring(*through, rate=9.0, free_length=free) for free in (0.0, 0.1)] + [ls.Damper(*through, 3.0)]
    one, bare = (ls.sweep(scene(loads=some), theta2=[0.0], solver="fast") for some in (loads, ()))
    xr.testing.assert_equal(one, bare)
    assert one.status == 0


# ---- the reference: springs and dampers as loads evaluated at each angle, in 60 digits -----


def place(reference, move, end):
    """Return the position and velocity of an end."""
    if end[0] == "ground":
        return mp.mpc(*end[1:]), mp.mpc(0)
    link = end[0]
    point = move.first[link] + polar(end[1:]) * move.line[link]
    return point, move.vG[link] + 1j * move.omega[link] * (point - move.G[link])


def as_loads(reference, move, action):
    """Return the loads of an action on its moving links."""
    if isinstance(action, ls.Spring | ls.Damper):
        (p, vp), (q, vq) = (place(reference, move, end) for end in (action.from_, action.to))
        unit = (q - p) / abs(q - p)
        if isinstance(action, ls.Spring):
            pull = mp.mpf(action.rate) * (abs(q - p) - mp.mpf(action.free_length)) * unit
        else:
            pull = mp.mpf(action.coefficient) * ((vq - vp) * unit.conjugate()).real * unit
        ends = ((action.from_, pull), (action.to, -pull))
        return [references.LoadData(end[0], (F.real, F.imag), at=end[1:]) for end, F in ends if end[0] != "ground"]
    line, omega = {"ground": mp.mpc(1)} | move.line, {"ground": mp.mpf(0)} | move.omega
    if isinstance(action, ls.TorsionSpring):
        wound = mp.arg(line[action.to] / line[action.from_] / turn(action.free_angle))
        torque = mp.mpf(action.rate) * wound
    else:
        torque = mp.mpf(action.coefficient) * (omega[action.to] - omega[action.from_])
    ends = ((action.from_, torque), (action.to, -torque))
    return [references.LoadData(link, torque=M) for link, M in ends if link != "ground"]


def random_actions(rng, reference, data):
    """Draw actions between any two links, with forces and torques on the scale of the inertial ones."""
    crank, scale = data.crank, data.crank.length
    force = crank.mass * data.omega2**2 * scale
    links = ["ground", *reference.LINKS]

    def end(link):
        x, y, r = (float(rng.uniform(-2, 2)) * scale for _ in "xyr")
        return ("ground", x, y) if link == "ground" else (link, abs(r), float(rng.uniform(-180, 180)))

    def two():
        return [str(link) for link in rng.choice(links, 2, replace=False)]

    def size():
        return log_uniform(rng, 0.1, 10.0)

    free = float(rng.uniform(0, 2)) * scale * int(rng.integers(2))
    pace = abs(data.omega2)
    return [
        ls.Spring(*map(end, two()), rate=size() * force / scale, free_length=free),
        ls.Damper(*map(end, two()), coefficient=size() * force / scale / pace),
        ls.TorsionSpring(*two(), rate=size() * force * scale, free_angle=float(rng.uniform(-180, 180))),
        ls.TorsionDamper(*two(), coefficient=size() * force * scale / pace),
    ]


@cache
def cases():
    """Draw scenes of two machines with all four kinds of action, and a few angles of each."""
    rng = np.random.default_rng(11)
    result = []
    for k in range(80):
        reference, inputs, free = oracle, {}, {}
        if k % 2:
            reference, inputs, free = oracle_slider_crank, {"friction": float(rng.uniform(0, 0.3))}, {"jammed": False}
        data = reference.random_data(rng, loads=1, **inputs)
        angles = [reference.random_theta2(rng, data, **free) for _ in range(3)]
        result.append((reference, data, random_actions(rng, reference, data), angles))
    return result


def with_actions(reference, data, actions):
    plain = reference.to_scene(data)
    return replace(plain, loads=(*plain.loads, *actions))


def unknowns(reference, data):
    return (*(force + axis for force in references.FORCES for axis in "xy"), reference.torque_name(data))


def reference_solution(reference, data, actions, theta2):
    """Return the reference solution with the actions as loads."""
    move = reference.motion(data, theta2)
    loads = [load for action in actions for load in as_loads(reference, move, action)]
    return reference.solve(replace(data, loads=(*data.loads, *loads)), theta2)


def test_agrees_with_the_reference():
    """Every unknown to 1e-11 of the largest force, or of that times the longest link."""
    for reference, data, actions, angles in cases():
        names = unknowns(reference, data)
        cycle = ls.sweep(with_actions(reference, data, actions), theta2=angles, of=names)
        assert not cycle.status.any()
        for k, theta2 in enumerate(angles):
            result = reference_solution(reference, data, actions, theta2)
            force, torque = largest_force(result), reference.largest_torque(result, data)
            for name in names:
                error = abs(float(cycle[name][k]) - result[name]) / (torque if name[0] == "T" else force)
                assert error < 1e-11, (name, theta2, data, actions)


def test_dense_path_agrees_and_power_balances():
    for reference, data, actions, angles in cases()[:40]:
        loaded, names = with_actions(reference, data, actions), unknowns(reference, data)
        fast = ls.sweep(loaded, theta2=angles, of=[*names, "power_residual"])
        dense = ls.sweep(loaded, theta2=angles, of=names, solver="dense")
        assert abs(fast.power_residual).max() < 1e-12
        for some in (names[:-1], names[-1:]):
            largest = max(float(abs(fast[name]).max()) for name in some)
            assert all(abs(fast[name] - dense[name]).max() < 1e-10 * largest for name in some)


@pytest.mark.parametrize("mechanism", MECHANISMS.values(), ids=MECHANISMS)
def test_springs_and_dampers_on_any_mechanism(mechanism):
    loaded = scene(mechanism, all_kinds(mechanism))
    cycle = ls.sweep(loaded, 90)
    dense = ls.sweep(loaded, 90, solver="dense")
    assert abs(ls.sweep(loaded, 90, of=["power_residual"]).power_residual).max() < 1e-12
    for name in mechanism.unknowns("crank"):
        assert abs(cycle[name] - dense[name]).max() <= 1e-12 * abs(cycle[name]).max(), name


# ---- energy and other laws that the equations do not use -----


@pytest.mark.parametrize("mechanism", MECHANISMS.values(), ids=MECHANISMS)
def test_a_spring_does_no_work_in_a_cycle(mechanism):
    """Over a closed cycle, by its own power, and by the drive's work with and without it."""
    frictionless = replace(mechanism, friction=0.0) if mechanism.friction else mechanism
    springs = [load for load in all_kinds(mechanism) if isinstance(load, ls.Spring)]
    springs.append(ls.TorsionSpring("ground", mechanism.roles[2], rate=5.0, free_angle=150.0))
    for spring in springs:
        own = ls.sweep(scene(frictionless, spring), of=["load1_power", "power"])
        bare = ls.sweep(scene(frictionless), of=["power"])
        peak = abs(own.load1_power).max()
        assert abs(own.load1_power.mean()) <= 1e-10 * peak
        assert abs((own.power - bare.power).mean()) <= 1e-10 * peak
        np.testing.assert_allclose(bare.power - own.power, own.load1_power, rtol=0, atol=1e-11 * float(peak))


def test_a_damper_dissipates():
    """Its tension is proportional to the rate of length, and the drive supplies its loss."""
    damper = ls.Damper(("ground", 0.3, 0.1), ("coupler", 0.1, 15.0), coefficient=20.0)
    own = ls.sweep(scene(loads=damper), of=["load1_power", "load1_tension", "load1_length", "power"])
    harmonics = np.fft.fftfreq(720, 1 / 720)
    rate = -31.0 * np.fft.ifft(1j * harmonics * np.fft.fft(own.load1_length.values)).real
    np.testing.assert_allclose(own.load1_tension, 20.0 * rate, rtol=0, atol=1e-10 * float(abs(own.load1_tension).max()))
    assert (own.load1_power <= 0.0).all()
    bare = ls.sweep(scene(), of=["power"])
    assert float((own.power - bare.power).mean()) == pytest.approx(-float(own.load1_power.mean()), rel=1e-10)


def test_swapped_ends_give_equal_results():
    def turned(load):
        other = {"free_angle": -load.free_angle} if isinstance(load, ls.TorsionSpring) else {}
        return replace(load, from_=load.to, to=load.from_, **other)

    loads = all_kinds(FOUR_BAR)
    one, other = (ls.sweep(scene(loads=some), 72) for some in (loads, list(map(turned, loads))))
    for name in FOUR_BAR.unknowns("crank"):
        np.testing.assert_allclose(one[name], other[name], rtol=0, atol=1e-13 * float(abs(one[name]).max()))


def test_the_peak_beside_the_jump_of_a_torsion_spring():
    """Weightless links: the torque rises to rate·180 degrees at 250 degrees and falls to minus that."""
    spring = ls.TorsionSpring("ground", "crank", rate=2.0, free_angle=70.0)
    peaks = ls.peaks(ls.Scene(PARALLELOGRAM, omega2=1.0, loads=spring), of=["T12"])
    assert float(peaks.T12_max) == pytest.approx(2.0 * np.pi, rel=1e-8) and peaks.T12_max <= 2.0 * np.pi
    assert float(peaks.T12_min) == pytest.approx(-2.0 * np.pi, rel=1e-8)
    assert float(peaks.T12_max_at) == pytest.approx(250.0) and float(peaks.T12_min_at) == pytest.approx(250.0)


# ---- numbers, bits, plans -----


def test_arctangent_to_two_units_in_the_last_place():
    rng = np.random.default_rng(5)
    angle = rng.uniform(-np.pi, np.pi, 20_000)
    y, x = np.sin(angle), np.cos(angle) * 10 ** rng.uniform(-14, 14, angle.size)
    y[:5000], x[:5000] = rng.choice([-1.0, 1.0], (2, 5000))
    y[:5000] *= np.tan(np.pi / 8) * (1 + rng.uniform(-1, 1, 5000) * 1e-3)  # where one series takes over from the other
    exact = [mp.atan2(mp.mpf(b), mp.mpf(a)) for b, a in zip(y, x, strict=True)]
    result = [arctangent(float(b), float(a)) for b, a in zip(y, x, strict=True)]
    errors = [abs(value - z) / np.spacing(abs(float(z))) for value, z in zip(result, exact, strict=True)]
    assert max(errors) < 2.0


@pytest.mark.parametrize(("y", "x", "degrees"), [(0, 1, 0), (1, 1, 45), (1, 0, 90), (0, -1, 180), (-1, -1, -135)])
def test_arctangent_of_the_axes(y, x, degrees):
    assert arctangent(float(y), float(x)) == np.radians(degrees)


@pytest.mark.parametrize("more", ["power_residual", pytest.param(("power_residual", "load"), marks=pytest.mark.long)])
def test_compiled_and_interpreted_agree_to_the_bit(more, monkeypatch):
    loaded = scene(loads=all_kinds(FOUR_BAR))
    names = [name for name in loaded.table.quantity if name.startswith(more)]
    names += FOUR_BAR.unknowns("crank")
    cycles = []
    for after in (np.inf, -1):
        monkeypatch.setattr(run, "COMPILE_AFTER", after)
        cycles.append(ls.sweep(loaded, 37, of=names))
    xr.testing.assert_equal(*cycles)


def planned(loaded, *names):
    return " ".join(plan(loaded.table, names, loaded.inputs.forms).functions)


def test_a_scene_without_springs_plans_no_spring():
    bare, sprung = scene(loads=ls.Load("rocker", torque=1.0)), scene(loads=all_kinds(FOUR_BAR))
    made = re.compile("line_direction|spring_tension|twist|turning|load")
    assert set(made.findall(planned(bare, *FOUR_BAR.unknowns("crank")))) == set()
    assert "spring_tension" in planned(sprung, "T12")
    assert not made.findall(planned(sprung, "theta3", "alpha4"))
    slack = scene(loads=replace(all_kinds(FOUR_BAR)[0], rate=0.0))
    assert not made.findall(planned(slack, "T12"))


def test_design_dims():
    rates = xr.DataArray([0.0, 1000.0, 2000.0], dims="rate")
    spring = ls.Spring(("ground", 0.3, 0.1), ("coupler", 0.1, 15.0), rate=rates, free_length=0.05)
    cycle = ls.sweep(scene(loads=spring), 36, of=["T12", "theta3", "load1_length"])
    assert (cycle.T12.dims, cycle.theta3.dims, cycle.load1_length.dims) == (
        ("rate", "theta2"),
        ("theta2",),
        ("theta2",),
    )
    xr.testing.assert_allclose(cycle.T12[2] - cycle.T12[0], 2.0 * (cycle.T12[1] - cycle.T12[0]))
    one = ls.sweep(scene(loads=replace(spring, rate=2000.0)), 36, of=["T12"])
    np.testing.assert_array_equal(one.T12, cycle.T12[2])


@pytest.mark.parametrize("name", ["tension", "length", "twist", "to_torque", "power"])
def test_results_scale_with_the_units(name):
    """Other units of length, mass and time by powers of two: the same numbers to the bit."""
    long, heavy, slow = 4.0, 8.0, 0.5
    torque = heavy * long**2 / slow**2

    def machine(long=1.0, heavy=1.0, slow=1.0, torque=1.0):
        links = [
            ls.Link(x.length * long, x.mass * heavy, x.inertia * heavy * long**2, x.cg_distance * long, x.cg_angle)
            for x in (CRANK, LONG, ROCKER)
        ]
        spring, _, damper, wound, _, turned = all_kinds(FOUR_BAR)
        ends = [
            [(link, x * long, y * long if link == "ground" else y) for link, x, y in (k.from_, k.to)]
            for k in (spring, damper)
        ]
        loads = [
            ls.Spring(*ends[0], spring.rate * heavy / slow**2, spring.free_length * long),
            ls.Damper(*ends[1], damper.coefficient * heavy / slow),
            ls.TorsionSpring(wound.from_, wound.to, wound.rate * torque, wound.free_angle),
            ls.TorsionDamper(turned.from_, turned.to, turned.coefficient * torque * slow),
        ]
        return scene(ls.FourBar(*links, ground=0.13 * long), loads, omega2=-31.0 / slow, gravity=(0.0, 0.0))

    factor = {
        "tension": heavy * long / slow**2,
        "length": long,
        "twist": 1.0,
        "to_torque": torque,
        "power": torque / slow,
    }
    names = [known for known in machine().table.quantity if re.fullmatch(f"load._{name}", known)]
    one, other = (ls.sweep(m, 24, of=names) for m in (machine(), machine(long, heavy, slow, torque)))
    assert names
    for known in names:
        np.testing.assert_array_equal(other[known], one[known] * factor[name])
