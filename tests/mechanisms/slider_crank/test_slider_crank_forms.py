"""A slider-crank has one answer: from behind, turned, in other units, from a file, with P in any form."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but
from oracle import torque_name
from oracle_slider_crank import DRIVES, SliderCrankData, mirrored, random_data, random_theta2, to_scene
from references import BRANCHES, LinkData, LoadData

import linksweep as ls
from linksweep.engine import run
from linksweep.engine.trace.plan import Plan, plan
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.file.writing import write_scene

KINEMATICS = ("theta3", "omega3", "alpha3", "x_slider", "v_slider", "a_slider")
FORCES = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y")
OTHERS = ("F12", "F43", "normal_force", "friction_force", "friction_power", "T14", "power", "Cx", "Cy", "aG3x", "aG3y")

random_scenes = pytest.mark.parametrize(
    ("branch", "drive", "seed"),
    [(branch, drive, seed) for branch in BRANCHES for drive in DRIVES for seed in range(4)],
)


def random_case(branch: str, drive: str, seed: int, **parameters) -> tuple[SliderCrankData, np.ndarray]:
    rng = np.random.default_rng(seed)
    data = random_data(rng, branch=branch, drive=drive, **({"friction": 0.25} | parameters))
    return data, np.array([random_theta2(rng, data, jammed=False) for _ in range(4)])


def swept(data: SliderCrankData, theta2: np.ndarray) -> xr.Dataset:
    """Without labels; the drive's torque is named T."""
    torque = torque_name(data)
    cycle = ls.sweep(to_scene(data), theta2, of=(*KINEMATICS, *FORCES, *OTHERS, torque))
    assert not cycle.status.any()
    return cycle.drop_vars(("status", "theta2")).rename({torque: "T"}).broadcast_like(cycle.status)


def assert_equal(result: xr.Dataset, expected: xr.Dataset) -> None:
    for name in expected:
        np.testing.assert_array_equal(result[name], expected[name], err_msg=name)


@random_scenes
def test_mirror(branch, drive, seed):
    """Angles, turns, the offset and y change their signs; not a bit changes otherwise."""
    data, theta2 = random_case(branch, drive, seed)
    opposite = (
        "theta3",
        "omega3",
        "alpha3",
        "T",
        "T14",
        "normal_force",
        *(n for n in (*FORCES, *OTHERS) if n[-1] == "y"),
    )
    expected = swept(data, theta2).map(lambda value: -value if value.name in opposite else value)
    assert_equal(swept(mirrored(data), -theta2), expected)


@random_scenes
def test_time_reversal(branch, drive, seed):
    """Without friction a film run backwards shows the same forces, bit for bit."""
    data, theta2 = random_case(branch, drive, seed, friction=0.0)
    turned = ("omega3", "v_slider", "power")
    expected = swept(data, theta2).map(lambda value: -value if value.name in turned else value)
    assert_equal(swept(replace(data, omega2=-data.omega2), theta2), expected)


def rescaled(data: SliderCrankData, length: float, mass: float, time: float) -> SliderCrankData:
    """Return the machine in units that are smaller by these factors."""
    force = mass * length / time**2

    def link(one: LinkData) -> LinkData:
        inertia = one.inertia * (mass * length**2)
        return LinkData(one.length * length, one.mass * mass, inertia, one.cg_distance * length, one.cg_angle)

    def load(one: LoadData) -> LoadData:
        at, pair = (one.at[0] * length, one.at[1]), tuple(f * force for f in one.force)
        return replace(one, force=pair, at=at, torque=one.torque * (force * length))

    return replace(
        data,
        **{name: link(getattr(data, name)) for name in ("crank", "rod")},
        slider_mass=data.slider_mass * mass,
        slider_cg_distance=data.slider_cg_distance * length,
        offset=data.offset * length,
        omega2=data.omega2 / time,
        alpha2=data.alpha2 / time**2,
        gravity=tuple(g * (length / time**2) for g in data.gravity),
        loads=tuple(map(load, data.loads)),
    )


@random_scenes
@pytest.mark.parametrize("units", [(2.0**-30, 1.0, 1.0), (1.0, 2.0**21, 1.0), (1.0, 1.0, 2.0**9), (8, 0.25, 16)])
def test_change_of_units_by_powers_of_two_changes_no_digit(branch, drive, seed, units):
    data, theta2 = random_case(branch, drive, seed)
    length, mass, time = units
    force = mass * length / time**2
    power = force * length / time
    factors = {"theta3": 1.0, "omega3": 1 / time, "alpha3": 1 / time**2, "power": power, "friction_power": power}
    factors |= {"x_slider": length, "v_slider": length / time, "a_slider": length / time**2, "Cx": length, "Cy": length}
    factors |= {"aG3x": length / time**2, "aG3y": length / time**2, "T": force * length, "T14": force * length}
    expected = swept(data, theta2).map(lambda value: value * factors.get(value.name, force))
    assert_equal(swept(rescaled(data, *units), theta2), expected)


@random_scenes
def test_rotation(branch, drive, seed):
    """Turned about A with guide, gravity and what is in ground axes: vectors turn, nothing else changes."""
    data, theta2 = random_case(branch, drive, seed)
    angle = float(np.random.default_rng(seed).uniform(-300, 300))
    unit = np.exp(1j * np.radians(angle))

    def turned(vector):
        z = complex(*vector) * unit
        return z.real, z.imag

    loads = tuple(replace(one, force=turned(one.force)) if one.frame == "ground" else one for one in data.loads)
    changed = replace(data, slide_angle=data.slide_angle + angle, gravity=turned(data.gravity), loads=loads)
    expected, result = swept(data, theta2), swept(changed, theta2 + angle)
    expected["theta3"] = (expected.theta3 + angle + 180.0) % 360.0 - 180.0
    for vector in ("F12", "F32", "F43", "F14", "C", "aG3"):
        z = (expected[f"{vector}x"] + 1j * expected[f"{vector}y"]) * unit
        expected[f"{vector}x"], expected[f"{vector}y"] = z.real, z.imag
    force = max(float(abs(expected[name]).max()) for name in FORCES)
    for name in expected:
        size = force if name in (*FORCES, "F12", "F43", "normal_force", "friction_force") else abs(expected[name]).max()
        size = max(abs(expected.aG3x).max(), abs(expected.aG3y).max()) if name.startswith("aG") else size
        size = max(abs(expected.Cx).max(), abs(expected.Cy).max()) if name.startswith("C") else size
        np.testing.assert_allclose(result[name], expected[name], rtol=1e-10, atol=1e-11 * float(size), err_msg=name)


# ---- the external force P -----


def engine(P=-900.0, friction=0.2, **changes) -> ls.Scene:
    """An engine with nothing that is zero or one, P on its slider."""
    crank, rod = ls.Link(0.05, 0.8, 7e-4, 0.02, 30.0), ls.Link(0.16, 0.6, 2e-3, 0.06, -8.0)
    guide = {"offset": 0.01, "slide_angle": 12.0, "friction": friction} | changes
    loads = [ls.Load("slider", force=(P, 20.0), frame="link"), ls.Load("rod", torque=0.3)]
    return ls.Scene(ls.SliderCrank(crank, rod, 0.5, **guide), 40.0, -90.0, (0.4, -9.81), loads)


@pytest.mark.parametrize("way", long_but([-1, np.inf], np.inf))
def test_the_force_on_the_slider_is_the_same_in_every_form(way, monkeypatch):
    """A number, a function, an array over the sweep's angles: equal bits, for a constant and for one that changes."""
    monkeypatch.setattr(run, "COMPILE_AFTER", way)
    theta2 = np.arange(36) * 10.0

    def constant(angle):
        return np.full(np.shape(angle), -900.0)

    def indicator(angle):
        return -400.0 - 300.0 * np.cos(np.radians(angle))

    for P in (constant, indicator):
        array = xr.DataArray(P(theta2), {"theta2": theta2}, "theta2")
        by_function, by_array = ls.sweep(engine(P), theta2), ls.sweep(engine(array), theta2)
        assert_equal(by_array, by_function)
        one_by_one = [ls.sweep(engine(float(P(angle))), [angle]) for angle in theta2]
        for name in FORCES:
            np.testing.assert_array_equal(by_array[name], [one[name].item() for one in one_by_one], err_msg=name)


# ---- what is not there is not paid for -----


def planned(scene: ls.Scene, *names: str) -> Plan:
    return plan(scene.table, names, scene.inputs.forms)


def test_no_friction_no_friction_operations():
    """No comparison, no choice, no second division at any angle; nor is friction's coefficient read."""
    unknowns = engine().mechanism.unknowns("crank")
    smooth, rough = planned(engine(friction=0.0), *unknowns), planned(engine(), *unknowns)
    assert not {"<", "where", "abs"} & smooth.operations("theta2").keys()
    assert smooth.operations("theta2")["/"] == 1
    assert "friction" in rough.inputs and "friction" not in smooth.inputs
    assert {"<", "where"} <= rough.operations("theta2").keys()
    assert rough.operations("theta2").total() <= smooth.operations("theta2").total() + 24
    for name in ("friction_force", "friction_power"):
        assert planned(engine(friction=0.0), name).operations("theta2").total() == 0
    friction = [function for function in rough.functions if "direction_of_sliding" in function]
    assert friction and not set(friction) & set(smooth.functions)


def test_friction_is_computed_beside_what_it_cannot_change():
    """Ten coefficients share the kinematics and the frictionless forces of one geometry."""
    coefficients = xr.DataArray(np.linspace(0.0, 0.5, 10), dims="mu")
    scene = engine(friction=coefficients)
    result = planned(scene, *scene.mechanism.unknowns("crank"))
    assert result.operations("mu", "theta2").total() < 0.4 * result.operations("theta2").total()
    cycle = ls.sweep(scene, 36)
    assert all(cycle[name].dims == ("theta2",) for name in KINEMATICS)
    for k, mu in enumerate(coefficients.values):
        alone = ls.sweep(engine(friction=float(mu)), 36)
        for name in FORCES:
            np.testing.assert_array_equal(cycle[name].isel(mu=k), alone[name], err_msg=name)


# ---- files -----


def test_a_slider_crank_in_a_file(tmp_path):
    text = """
omega2 = "1500 rpm"
drive = "coupler"

[mechanism]
type = "SliderCrank"
slider_mass = "500 g"
offset = "-5 mm"
friction = 0.1
branch = "crossed"
slide_angle = 90

[mechanism.crank]
type = "Disk"
length = "45 mm"
radius = "6 cm"
thickness = "2 cm"
density = "7800 kg/m^3"

[mechanism.rod]
length = 0.15
mass = 0.6
inertia = 2.2e-3

[[loads]]
link = "slider"
force = ["-2 kN", 0]
frame = "link"
"""
    crank, rod = ls.Disk(0.045, 0.06, 0.02, 7800.0), ls.Link(0.15, 0.6, 2.2e-3)
    mechanism = ls.SliderCrank(crank, rod, 0.5, offset=-0.005, friction=0.1, branch="crossed", slide_angle=90.0)
    load = ls.Load("slider", force=(-2000.0, 0.0), frame="link")
    assert parse_scene(text) == ls.Scene(mechanism, omega2=50 * np.pi, loads=[load], drive="coupler")


@pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")  # few angles, through a spline all the same
@pytest.mark.parametrize("branch", [*BRANCHES, "both"])
def test_a_file_gives_the_scene_back(branch, tmp_path):
    """As TOML; and inside the NetCDF file of a sweep, P there as the sweep took it, at its own angles."""
    offsets = xr.DataArray([-0.01, 0.0, 0.02], {"offset": [-0.01, 0.0, 0.02]}, "offset")
    pressure = xr.DataArray([-3.0, -900.0, 1 / 3], {"theta2": [0.0, 120.0, 240.0]}, "theta2")
    scene = engine(pressure, offset=offsets, branch=branch)
    assert parse_scene(write_scene(scene)) == scene
    cycle = ls.sweep(scene, 24)
    ls.save(cycle, tmp_path / "cycle.nc")
    again = ls.load_scene(tmp_path / "cycle.nc")
    assert replace(again, loads=scene.loads) == scene
    xr.testing.assert_identical(ls.sweep(again, 24).drop_attrs(), cycle.drop_attrs())
