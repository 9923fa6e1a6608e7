"""Laws that any four-bar obeys, on random scenes: what is known of one answer from another, or from a simpler machine.

Mirror, rotation, units, superposition, time reversal, statics, the parallelogram, massless links, the slider that a
long rocker becomes, and the drive that takes over another's torque.
"""

from dataclasses import replace
from itertools import pairwise, product

import numpy as np
import pytest
import xarray as xr
from oracle import (
    BRANCHES,
    LINKS,
    NUMBER,
    FourBarData,
    LoadData,
    load_force,
    load_point,
    motion,
    mp,
    random_data,
    random_load,
    random_theta2,
    to_scene,
    toggle_margin,
    torque_name,
)

import linksweep as ls

SEEDS = [pytest.param(*case, id="-".join(map(str, case))) for case in product(BRANCHES, LINKS, range(3))]
random_scenes = pytest.mark.parametrize(("branch", "drive", "seed"), SEEDS)
ANGLES = ("theta3", "theta4")
PINS = ("F12", "F32", "F43", "F14")
VECTORS = ("B", "C", "aG2", "aG3", "aG4", *PINS)
COMPONENTS = tuple(vector + axis for vector in VECTORS for axis in "xy")
RATES = ("omega3", "omega4", "alpha3", "alpha4")
EVERYTHING = (*ANGLES, *RATES, "transmission_angle", *COMPONENTS, *PINS, "power")


def random_case(branch: str, drive: str, seed: int, **given) -> tuple[FourBarData, np.ndarray]:
    """A scene and five crank angles away from its toggles."""
    rng = np.random.default_rng([seed, BRANCHES.index(branch), LINKS.index(drive)])
    data = random_data(rng, branch=branch, drive=drive, **given)
    return data, np.array([random_theta2(rng, data) for _ in range(5)])


def swept(data: FourBarData, theta2, names=EVERYTHING) -> xr.Dataset:
    """All that can be asked for, by position along theta2 instead of by angle; the drive's torque is called T."""
    torque = torque_name(data)
    cycle = ls.sweep(to_scene(data), theta2, outputs=(*names, torque))
    assert not cycle.status.any()
    return cycle.rename({torque: "T"}).drop_vars(["status", "theta2"])


def links_changed(data: FourBarData, change) -> dict:
    return {name: change(getattr(data, name)) for name in LINKS}


def assert_equal(found: xr.Dataset, expected: xr.Dataset) -> None:
    for name in expected.data_vars:
        np.testing.assert_array_equal(found[name].values, expected[name].values, err_msg=name)


def kind(name: str) -> str:
    """What a quantity is compared with: F12x and F43 alike are F."""
    return name.rstrip("xy0123456789")


def sizes(cycle: xr.Dataset, data: FourBarData) -> dict[str, np.ndarray | float]:
    """The largest of each kind at each angle; torques are measured by the largest force times the longest link."""
    largest = np.maximum.reduce
    omega = largest([np.full(5, abs(data.omega2)), abs(cycle.omega3), abs(cycle.omega4)])
    alpha = largest([np.full(5, data.omega2**2 + abs(data.alpha2)), abs(cycle.alpha3), abs(cycle.alpha4)])
    force, longest = largest([cycle[pin] for pin in PINS]), longest_link(data)
    found = {"theta": 180.0, "transmission_angle": 180.0, "omega": omega, "alpha": alpha, "aG": alpha * longest}
    found |= {"B": longest, "C": longest, "F": force, "T": force * longest}
    return found | {"power": force * longest * omega}


def assert_close(found: xr.Dataset, expected: xr.Dataset, data: FourBarData) -> None:
    """Within 1e-11 of the largest of its kind; `data` is the scene of what is expected."""
    size = sizes(expected, data)
    for name in expected.data_vars:
        error = np.abs(found[name].values - expected[name].values) / size[kind(name)]
        assert np.all(error < 1e-11), (name, error)


def longest_link(data: FourBarData) -> float:
    return max(data.ground, *(getattr(data, name).length for name in LINKS))


# ---- symmetries -----


def mirrored(data: FourBarData) -> FourBarData:
    """The same scene seen in a mirror that lies along x."""
    return replace(
        data,
        **links_changed(data, lambda link: replace(link, cg_angle=-link.cg_angle)),
        branch={"open": "crossed", "crossed": "open"}[data.branch],
        ground_angle=-data.ground_angle,
        omega2=-data.omega2,
        alpha2=-data.alpha2,
        gravity=(data.gravity[0], -data.gravity[1]),
        loads=tuple(
            replace(
                load,
                force=(load.force[0], -load.force[1]),
                at=(load.at[0], -load.at[1]),
                torque=-load.torque,
            )
            for load in data.loads
        ),
    )


@random_scenes
def test_mirror(branch, drive, seed):
    """Angles, rates, torques and y turn their signs, the branch swaps; not a bit changes otherwise."""
    data, theta2 = random_case(branch, drive, seed)
    turned = (*ANGLES, *RATES, "T", *(name for name in COMPONENTS if name.endswith("y")))
    expected = swept(data, theta2).map(lambda value: -value if value.name in turned else value)
    assert_equal(swept(mirrored(data), -theta2), expected)


def rotated(data: FourBarData, angle: float) -> FourBarData:
    """The scene turned about A, with its gravity and the loads that are given in ground axes."""

    def turned(vector):
        z = complex(*vector) * np.exp(1j * np.radians(angle))
        return z.real, z.imag

    return replace(
        data,
        ground_angle=data.ground_angle + angle,
        gravity=turned(data.gravity),
        loads=tuple(replace(load, force=turned(load.force)) if load.frame == "ground" else load for load in data.loads),
    )


@random_scenes
def test_rotation(branch, drive, seed):
    data, theta2 = random_case(branch, drive, seed)
    angle = float(np.random.default_rng(seed).uniform(-300, 300))
    expected = swept(data, theta2)
    for name in ANGLES:
        expected[name] = (expected[name] + angle + 180.0) % 360.0 - 180.0
    for vector in VECTORS:
        z = (expected[f"{vector}x"] + 1j * expected[f"{vector}y"]) * np.exp(1j * np.radians(angle))
        expected[f"{vector}x"], expected[f"{vector}y"] = z.real, z.imag
    assert_close(swept(rotated(data, angle), theta2 + angle), expected, data)


def rescaled(data: FourBarData, length: float, mass: float, time: float) -> FourBarData:
    """The same machine in units that are smaller by these factors."""
    force = mass * length / time**2
    return replace(
        data,
        **links_changed(
            data,
            lambda link: replace(
                link,
                length=link.length * length,
                mass=link.mass * mass,
                inertia=link.inertia * (mass * length**2),
                cg_distance=link.cg_distance * length,
            ),
        ),
        ground=data.ground * length,
        omega2=data.omega2 / time,
        alpha2=data.alpha2 / time**2,
        gravity=tuple(g * (length / time**2) for g in data.gravity),
        loads=tuple(
            replace(
                load,
                force=tuple(f * force for f in load.force),
                at=(load.at[0] * length, load.at[1]),
                torque=load.torque * (force * length),
            )
            for load in data.loads
        ),
    )


def in_units(cycle: xr.Dataset, length: float, mass: float, time: float) -> xr.Dataset:
    force = mass * length / time**2
    factors = {"theta": 1.0, "transmission_angle": 1.0, "omega": 1 / time, "alpha": 1 / time**2}
    factors |= {"B": length, "C": length, "aG": length / time**2}
    factors |= {"F": force, "T": force * length, "power": force * length / time}
    return cycle.map(lambda value: value * factors[kind(value.name)])


@random_scenes
@pytest.mark.parametrize("units", [(2.0**-30, 1.0, 1.0), (1.0, 2.0**21, 1.0), (1.0, 1.0, 2.0**9), (8, 0.25, 16)])
def test_change_of_units_by_powers_of_two_changes_no_digit(branch, drive, seed, units):
    data, theta2 = random_case(branch, drive, seed)
    assert_equal(swept(rescaled(data, *units), theta2), in_units(swept(data, theta2), *units))


@random_scenes
@pytest.mark.parametrize("units", [(3.7, 1.0, 1.0), (1.0, 3.7, 1.0), (1.0, 1.0, 3.7)])
def test_change_of_units(branch, drive, seed, units):
    data, theta2 = random_case(branch, drive, seed)
    changed = rescaled(data, *units)
    assert_close(swept(changed, theta2), in_units(swept(data, theta2), *units), changed)


@random_scenes
def test_time_reversal(branch, drive, seed):
    """A film run backwards shows the same forces: velocities turn, accelerations do not; bit for bit."""
    data, theta2 = random_case(branch, drive, seed)
    turned = ("omega3", "omega4", "power")
    expected = swept(data, theta2).map(lambda value: -value if value.name in turned else value)
    assert_equal(swept(replace(data, omega2=-data.omega2), theta2), expected)


@random_scenes
def test_superposition_of_loads(branch, drive, seed):
    """Forces and torque are affine in the loads."""
    rng = np.random.default_rng(seed)
    data, theta2 = random_case(branch, drive, seed, loads=0)
    force = data.coupler.mass * data.omega2**2 * longest_link(data)
    first, second = (random_load(rng, force, longest_link(data)) for _ in range(2))
    twice = replace(first, force=tuple(2.5 * f for f in first.force), torque=2.5 * first.torque)
    names = [name for name in COMPONENTS if name.startswith("F")]
    none, one, other, both = (
        swept(replace(data, loads=loads), theta2, names) for loads in ((), (first,), (second,), (twice, second))
    )
    expected = none + 2.5 * (one - none) + (other - none)
    size = max(float(abs(cycle[name]).max()) for cycle in (none, one, other, both) for name in names)
    for name in (*names, "T"):
        error = abs(both[name] - expected[name]) / (size * longest_link(data) if name == "T" else size)
        assert error.max() < 1e-12, (name, error)


# ---- statics -----


def virtual_work(data: FourBarData, theta2: float):
    """Work of weights and loads per radian of the crank, and turn of the driven link, by numerical differentiation."""
    now = motion(data, theta2)

    def rate(of):
        return mp.diff(lambda angle: of(motion(data, mp.degrees(angle))), mp.radians(theta2))

    def turn_of(link):
        return rate(lambda move: mp.arg(move.line[link] / now.line[link]))

    work = mp.mpf(0)
    for name in LINKS:
        weight = mp.mpf(getattr(data, name).mass) * mp.mpc(*data.gravity)
        work += (weight.conjugate() * rate(lambda move, name=name: move.G[name])).real
    for load in data.loads:
        step = rate(lambda move, load=load: load_point(move, load))
        work += (load_force(now, load).conjugate() * step).real + load.torque * turn_of(load.link)
    return work, turn_of(data.drive)


@random_scenes
def test_a_machine_at_rest_is_balanced_by_virtual_work(branch, drive, seed):
    """Only positions enter the expected torque."""
    moving, theta2 = random_case(branch, drive, seed, loads=2)
    data = replace(moving, omega2=0.0, alpha2=0.0)
    rest = swept(data, theta2[:2])
    for name in (*RATES, "aG2x", "aG3y", "aG4x", "power"):
        assert not rest[name].any(), name
    for k, angle in enumerate(theta2[:2]):
        work, turn = virtual_work(data, float(angle))
        size = max(float(rest[pin][k]) for pin in PINS) * longest_link(data)
        assert float(rest["T"][k]) == pytest.approx(float(-work / turn), rel=0.0, abs=1e-11 * size)


def parallelogram(**changes) -> ls.Scene:
    """Crank and rocker 0.2 m, coupler and ground 0.5 m; by default massless and at rest."""
    links = {name: ls.Link(length, 0.0, 0.0) for name, length in zip(LINKS, (0.2, 0.5, 0.2), strict=True)}
    frame = {"ground": 0.5, "branch": "open"}
    frame |= {name: changes.pop(name) for name in (*LINKS, "ground", "branch", "ground_angle") if name in changes}
    return ls.Scene(ls.FourBar(**links | frame), **{"omega2": 0.0} | changes)


def test_weight_on_a_parallelogram_by_hand():
    """Half of 8 N rests on each side; the free rocker takes force along itself only, the drive holds the sway."""
    theta2 = np.array([20.0, 60.0, 90.0, 135.0, 160.0])
    cycle = ls.sweep(parallelogram(loads=ls.Load("coupler", force=(0.0, -8.0), at=(0.25, 0.0))), theta2)
    sway = 4.0 / np.tan(np.radians(theta2))
    expected = {"F43x": sway, "F43y": 4.0, "F14x": sway, "F14y": 4.0, "F32x": sway, "F32y": -4.0}
    expected |= {"F12x": -sway, "F12y": 4.0, "T12": 8.0 * 0.2 * np.cos(np.radians(theta2))}
    for name, value in expected.items():
        np.testing.assert_allclose(cycle[name], np.broadcast_to(value, 5), rtol=0.0, atol=1e-13, err_msg=name)


# ---- parallelogram -----

OPPOSITE_SIDES = [(2.0, 5.0), (0.08, 0.2), (0.1, 0.3), (0.07, 0.13), (1 / 3, 0.7)]


def with_mass(length: float) -> ls.Link:
    return ls.Link(length, 1.0, 0.01 * length**2, cg_distance=0.4 * length)


def heavy_parallelogram(short: float, long: float, **changes) -> ls.Scene:
    links = {name: with_mass(x) for name, x in zip(LINKS, (short, long, short), strict=True)}
    return parallelogram(**links, ground=long, omega2=3.0, alpha2=-4.0, gravity=(0.0, -9.81), **changes)


@pytest.mark.parametrize("ground_angle", [0.0, 33.3])
@pytest.mark.parametrize(("branch", "first"), [("open", 0.0), ("open", 180.0)])
def test_parallelogram_turns_as_one(branch, first, ground_angle):
    """The coupler without rotation, the rocker with the crank, on one branch all the way round."""
    theta2 = first + ground_angle + np.arange(10.0, 171.0, 20.0)
    cycle = ls.sweep(parallelogram(omega2=3.0, alpha2=-4.0, branch=branch, ground_angle=ground_angle), theta2)
    same = {"theta3": ground_angle, "omega3": 0.0, "omega4": 3.0, "alpha3": 0.0, "alpha4": -4.0}
    same["theta4"] = (theta2 + 180.0) % 360.0 - 180.0
    for name, value in same.items():
        np.testing.assert_allclose(cycle[name], np.broadcast_to(value, 9), rtol=0.0, atol=1e-11, err_msg=name)


@pytest.mark.parametrize("ground_angle", [0.0, 10.0, 33.3])
@pytest.mark.parametrize(("short", "long"), OPPOSITE_SIDES)
def test_fold_of_a_parallelogram_is_a_toggle(short, long, ground_angle):
    """Flat, it can leave on two branches: no rates, no forces, whatever its lengths are rounded to."""
    fold = ground_angle + np.array([0.0, 180.0, -180.0, 360.0])
    cycle = ls.sweep(heavy_parallelogram(short, long, ground_angle=ground_angle), fold)
    assert set(cycle.status.values) == {cycle.status.attrs["flag_meanings"].split().index("toggle")}
    assert cycle.T12.isnull().all()


CHANGE_POINTS = [  # in mm, where two links together are as long as the other two; and the angle at which they lie flat
    ((221, 98, 115, 204), 0.0),
    ((100, 200, 150, 150), 0.0),
    ((103, 210, 190, 297), 180.0),
    ((33, 270, 61, 298), 180.0),
]


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize(("lengths", "flat"), CHANGE_POINTS)
def test_change_point_is_a_toggle(lengths, flat, branch):
    """In metres the lengths no longer add up to the last bit; what happens there is the same."""
    crank, coupler, rocker, ground = (length / 1000 for length in lengths)
    bars = ls.FourBar(*map(with_mass, (crank, coupler, rocker)), ground=ground, branch=branch)
    cycle = ls.sweep(ls.Scene(bars, omega2=3.0), [flat, flat + 360.0])
    assert set(cycle.status.values) == {cycle.status.attrs["flag_meanings"].split().index("toggle")}
    assert cycle.F32x.isnull().all()


@pytest.mark.parametrize(("short", "long"), OPPOSITE_SIDES)
def test_coupler_of_a_parallelogram_cannot_drive(short, long):
    """It does not turn, so no torque on it can balance anything."""
    cycle = ls.sweep(heavy_parallelogram(short, long, drive="coupler"), np.arange(10.0, 171.0, 20.0))
    assert set(cycle.status.values) == {cycle.status.attrs["flag_meanings"].split().index("dead_centre")}
    assert cycle.T13.isnull().all()


# ---- massless links -----


def massless(branch: str, seed: int, load: LoadData) -> xr.Dataset:
    data, theta2 = random_case(branch, "crank", seed, scale=1.0)
    data = replace(data, **links_changed(data, lambda link: replace(link, mass=0.0, inertia=0.0)), loads=(load,))
    return swept(data, theta2)


def pin_force(cycle: xr.Dataset, pin: str) -> np.ndarray:
    return (cycle[f"{pin}x"] + 1j * cycle[f"{pin}y"]).values


def direction(cycle: xr.Dataset, link: str) -> np.ndarray:
    return np.exp(1j * np.radians(cycle[f"theta{NUMBER[link]}"].values))


massless_scenes = pytest.mark.parametrize(("branch", "seed"), list(product(BRANCHES, range(4))))


@massless_scenes
def test_torque_on_the_rocker_of_massless_links(branch, seed):
    """The coupler is a two-force rod: it pushes along itself, with M/(c sin μ)."""
    data, _ = random_case(branch, "crank", seed, scale=1.0)
    cycle = massless(branch, seed, LoadData("rocker", torque=3.0))
    F43, F32, F12, F14 = (pin_force(cycle, pin) for pin in ("F43", "F32", "F12", "F14"))
    size = abs(F43)
    arm = data.rocker.length * np.sin(np.radians(cycle.transmission_angle.values))
    np.testing.assert_allclose(size, 3.0 / arm, rtol=1e-12)
    assert np.all(abs((F43 * direction(cycle, "coupler").conj()).imag) < 1e-12 * size)
    for other in (F32, -F12, F14):
        np.testing.assert_array_equal(other, F43)
    np.testing.assert_allclose(cycle["T"], -3.0 * cycle.omega4 / data.omega2, rtol=1e-12)


@massless_scenes
def test_force_on_the_coupler_of_massless_links(branch, seed):
    """The rocker is a two-force rod; the coupler's three forces add to nothing and meet in a point."""
    data, _ = random_case(branch, "crank", seed, scale=1.0)
    cycle = massless(branch, seed, LoadData("coupler", (2.0, -5.0), at=(0.3, 40.0)))
    F43, F32, F12, F14 = (pin_force(cycle, pin) for pin in ("F43", "F32", "F12", "F14"))
    size = np.maximum(abs(F43), abs(F32))
    assert np.all(abs((F43 * direction(cycle, "rocker").conj()).imag) < 1e-12 * size)
    np.testing.assert_array_equal(F14, F43)
    np.testing.assert_array_equal(F12, -F32)
    P, coupler = complex(2.0, -5.0), direction(cycle, "coupler")
    assert np.all(abs(F43 + P - F32) < 1e-12 * size)
    about_B = data.coupler.length * coupler.conj() * F43 + 0.3 * np.exp(-1j * np.radians(40)) * coupler.conj() * P
    assert np.all(abs(about_B.imag) < 1e-12 * size)


# ---- a long rocker as a slider -----


def almost_slider(rocker: float, theta2: np.ndarray, load: float) -> dict[str, np.ndarray]:
    """Slider-crank with its slider of 2 kg on the tip of a rocker that hangs from far above x = 1.1 m."""
    bars = ls.FourBar(
        crank=ls.Link(0.3, 0.0, 0.0),
        coupler=ls.Link(1.0, 0.0, 0.0),
        rocker=ls.Link(rocker, 2.0, 0.0, cg_distance=rocker),
        ground=np.hypot(1.1, rocker),
        ground_angle=float(np.degrees(np.arctan2(rocker, 1.1))),
        branch="crossed",
    )
    push = ls.Load("rocker", force=(load, 0.0), at=(rocker, 0.0))
    names = ("Cx", "theta3", "omega3", "alpha3", "aG4x", "F43x", "F43y", "F32x", "F14y", "F14x", "T12")
    cycle = ls.sweep(ls.Scene(bars, omega2=5.0, alpha2=3.0, loads=push), theta2, outputs=names)
    return {name: cycle[name].values for name in names}


def slider_crank(theta2: np.ndarray, load: float) -> dict[str, np.ndarray]:
    """Closed form: massless crank a and rod b, slider m on the x axis under a force along x, no friction."""
    a, b, m, omega, alpha = 0.3, 1.0, 2.0, 5.0, 3.0
    sin, cos = np.sin(np.radians(theta2)), np.cos(np.radians(theta2))
    sin3 = -a * sin / b
    cos3 = np.sqrt(1.0 - sin3**2)
    omega3 = -omega * a * cos / (b * cos3)
    alpha3 = (-a * alpha * cos + a * omega**2 * sin + b * omega3**2 * sin3) / (b * cos3)
    acceleration = -a * (alpha * sin + omega**2 * cos) - b * (alpha3 * sin3 + omega3**2 * cos3)
    F43x = load - m * acceleration
    F43y = F43x * sin3 / cos3
    return {
        "Cx": a * cos + b * cos3,
        "theta3": np.degrees(np.arctan2(sin3, cos3)),
        "omega3": omega3,
        "alpha3": alpha3,
        "aG4x": acceleration,
        "F43x": F43x,
        "F43y": F43y,
        "F32x": F43x,
        "F14y": F43y,
        "F14x": np.zeros_like(sin),
        "T12": -a * (cos * F43y - sin * F43x),
    }


def test_a_long_rocker_is_a_slider():
    """What the arc of the rocker leaves falls with its length."""
    theta2 = np.arange(0.0, 360.0, 7.5)
    expected = slider_crank(theta2, -40.0)
    rockers = (1e2, 1e3, 1e4, 1e5)
    off = [almost_slider(rocker, theta2, -40.0) for rocker in rockers]
    for name, value in expected.items():
        errors = [np.abs(found[name] - value).max() for found in off]
        assert errors[-1] < 1e-4 * max(1.0, abs(value).max()), name
        for before, after in pairwise(errors):
            assert 9.0 < before / after < 11.0, (name, errors)


# ---- one drive's torque given to another -----


def case_of_two_drives(seed: int, drives: tuple[str, str]) -> tuple[FourBarData, np.ndarray]:
    """A scene driven by the first, and crank angles where either could drive."""
    rng = np.random.default_rng(seed)
    data = random_data(rng, drive=drives[0])
    tried = rng.uniform(-180, 540, 400)
    held = [x for x in tried if all(toggle_margin(replace(data, drive=drive), x) > 0.1 for drive in drives)]
    return data, np.array(held[:5])


def as_load(link: str, cycle: xr.Dataset) -> ls.Load:
    """The torque that was found for a drive, as a known torque on its link."""
    return ls.Load(link, torque=cycle[f"T1{NUMBER[link]}"])


def largest_force(cycle: xr.Dataset) -> float:
    return max(float(abs(cycle[f"{pin}{axis}"]).max()) for pin in PINS for axis in "xy")


other_drives = pytest.mark.parametrize(("driver", "other"), [(a, b) for a, b in product(LINKS, LINKS) if a != b])


@other_drives
@pytest.mark.parametrize("seed", range(3))
def test_a_known_torque_leaves_nothing_for_another_drive(driver, other, seed):
    """The torque found for one drive, given as a load, asks no torque of another, at the same pin forces."""
    data, theta2 = case_of_two_drives(seed, (driver, other))
    scene = to_scene(data)
    driven = ls.sweep(scene, theta2)
    idle = ls.sweep(replace(scene, drive=other, loads=(*scene.loads, as_load(driver, driven))), theta2)
    size = largest_force(driven)
    assert theta2.size == 5
    assert not idle.status.any()
    for name in (name for name in COMPONENTS if name.startswith("F")):
        assert abs(idle[name] - driven[name]).max() < 1e-11 * size, name
    assert abs(idle[f"T1{NUMBER[other]}"]).max() < 1e-11 * size * longest_link(data)


@other_drives
def test_two_drives_share_the_work(driver, other):
    """One drives against a known brake on the other, then the other against what was found: the brake comes back."""
    data, theta2 = case_of_two_drives(5, (driver, other))
    scene = to_scene(data)
    free = ls.sweep(scene, theta2)[f"T1{NUMBER[driver]}"]
    brake = free.copy(data=float(abs(free).max()) * np.linspace(-1.0, 1.0, theta2.size))
    found = ls.sweep(replace(scene, loads=(*scene.loads, ls.Load(other, torque=brake))), theta2)
    back = ls.sweep(replace(scene, drive=other, loads=(*scene.loads, as_load(driver, found))), theta2)
    error = abs(back[f"T1{NUMBER[other]}"] - brake).max()
    assert theta2.size == 5
    assert error < 1e-11 * largest_force(found) * longest_link(data)
