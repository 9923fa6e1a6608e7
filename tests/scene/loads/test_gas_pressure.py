"""Gas pressure in a cylinder: points by hand, work in closed form, and every form of input."""

import dataclasses
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from refusals import array

import linksweep as ls
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.file.writing import write_scene

A, B, BORE, R, P1, P3, GAMMA = 0.04, 0.14, 0.09, 9.0, 1.0e5, 5.0e6, 1.4
AREA = math.pi * BORE**2 / 4
STROKE_VOLUME = AREA * 2 * A  # without offset
ENGINE = ls.SliderCrank(ls.Link(A, 0.0, 0.0), ls.Link(B, 0.0, 0.0), slider_mass=0.0)
OTTO = ls.OttoCycle(R, P3, intake_pressure=P1)
DIESEL = ls.DieselCycle(18.0, 2.2, intake_pressure=P1)


def scene(pressure=OTTO, engine=ENGINE, omega2=100.0, crankcase=P1, bore=BORE, **more) -> ls.Scene:
    gas = ls.GasPressure(bore, pressure, crankcase)
    return ls.Scene(engine, omega2=omega2, loads=[gas], **more)


def height(engine: ls.SliderCrank, theta2: float) -> float:
    """Return the slider's position along the guide, from a triangle: independent of the package."""
    turned = math.radians(theta2 - engine.slide_angle)
    sign = 1.0 if engine.branch == "open" else -1.0
    a, b, e = engine.crank.length, engine.rod.length, engine.offset
    return a * math.cos(turned) + sign * math.sqrt(b**2 - (e - a * math.sin(turned)) ** 2)


# --------------------------------------------------------------------------------------- the cycles


def test_otto_at_known_points():
    p = OTTO.pressure(ENGINE, [0.0, 60.0, 179.0, 180.0, 300.0, 400.0, 540.0, 600.0, 719.999]).values
    clearance = STROKE_VOLUME / (R - 1)
    volume_60 = clearance + AREA * (A + B - height(ENGINE, 60.0))
    volume_600 = clearance + AREA * (A + B - height(ENGINE, 600.0))
    largest = clearance * R
    assert p[0] == P3
    assert p[1] == pytest.approx(P3 * (clearance / volume_60) ** GAMMA, rel=1e-12)
    assert p[2] == pytest.approx(P3 * R**-GAMMA, rel=1e-3)
    assert p[3:7].tolist() == [P1] * 4  # blow-down, exhaust, intake, and where compression begins
    assert p[7] == pytest.approx(P1 * (largest / volume_600) ** GAMMA, rel=1e-12)
    assert p[8] == pytest.approx(P1 * R**GAMMA, rel=1e-6)


def test_diesel_burns_at_constant_pressure_until_the_cutoff():
    angles = np.arange(0.0, 180.0, 0.5)
    p = DIESEL.pressure(ENGINE, angles).values
    volume = np.array([1 + 17.0 * (A + B - height(ENGINE, angle)) / (2 * A) for angle in angles])
    peak = P1 * 18.0**GAMMA
    np.testing.assert_allclose(p[volume <= 2.2], peak, rtol=1e-14)
    np.testing.assert_allclose(p[volume > 2.2], peak * (2.2 / volume[volume > 2.2]) ** GAMMA, rtol=1e-12)


def test_a_diesel_with_a_peak_pressure_is_the_mixed_cycle():
    peak = 1.3 * P1 * 18.0**GAMMA
    mixed = replace(DIESEL, peak_pressure=peak)
    p = mixed.pressure(ENGINE, [719.9999, 0.0, 5.0]).values
    assert p[0] == pytest.approx(P1 * 18.0**GAMMA, rel=1e-6)
    assert p[1:].tolist() == [peak, peak]


def test_two_strokes_take_one_turn():
    two = replace(OTTO, strokes=2)
    assert scene(two).period == 360.0
    p = two.pressure(ENGINE, [0.0, 60.0, 180.0, 300.0, 360.0]).values
    assert p[0] == p[4] == P3
    assert p[1] == OTTO.pressure(ENGINE, [60.0]).item()
    assert p[2] == P1
    assert p[3] == pytest.approx(OTTO.pressure(ENGINE, [660.0]).item(), rel=1e-14)


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("offset", [-0.03, 0.0, 0.02])
@pytest.mark.parametrize("slide_angle", [0.0, 90.0, -70.0])
def test_dead_centres_are_where_the_slider_turns(branch, offset, slide_angle):
    engine = replace(ENGINE, branch=branch, offset=offset, slide_angle=slide_angle)
    angles = np.arange(0.0, 720.0, 0.01)
    away = np.abs([height(engine, angle) for angle in angles[angles < 360.0]])
    top, bottom = angles[np.argmax(away)], angles[np.argmin(away)]
    p = OTTO.pressure(engine, angles).values
    fired = angles[np.argmax(p)] % 360.0
    assert abs((fired - top + 180.0) % 360.0 - 180.0) < 0.011
    blow_down = angles[np.argmin(np.diff(p, append=p[0]))] % 360.0
    assert abs((blow_down - bottom + 180.0) % 360.0 - 180.0) < 0.011


@pytest.mark.parametrize(
    ("branch", "slide_angle", "ahead"), [("open", 0, 0), ("open", -1, 359), ("crossed", 30, 210), ("crossed", -170, 10)]
)
@pytest.mark.parametrize("offset", [-0.03, 0.02])
def test_it_fires_at_the_top_dead_centre_of_the_guides_angle_in_one_turn(branch, slide_angle, ahead, offset):
    """An offset moves it on, of a crossed branch back, also below 0; a turn away, valves are open."""
    engine = replace(ENGINE, branch=branch, offset=offset, slide_angle=slide_angle)
    on = math.degrees(math.asin(offset / (A + B)))
    top = ahead + (on if branch == "open" else -on)
    just_after = OTTO.pressure(engine, [(top + 1e-6) % 720.0, (top + 360.0 + 1e-6) % 720.0]).values
    np.testing.assert_allclose(just_after, [P3, P1], rtol=1e-6)


# ------------------------------------------------------------------------------------ work and torque


def indicated(cycle, engine) -> float:
    """Return the work per cycle [J] of a massless engine without friction: the integral of -T12 over theta2."""
    result = ls.sweep(scene(cycle, engine), 14400, of=["T12"])
    return -float(result.T12.mean()) * math.radians(cycle.strokes * 180.0)


def otto_work(swept: float, r: float, gamma: float) -> float:
    heat = (P3 - P1 * r**gamma) * swept / (r - 1) / (gamma - 1)
    return (1 - r ** (1 - gamma)) * heat


ENGINES = [ENGINE, replace(ENGINE, offset=0.03, slide_angle=35.0), replace(ENGINE, branch="crossed", offset=-0.02)]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("strokes", [2, 4])
@pytest.mark.parametrize(("r", "gamma"), [(9.0, 1.4), (6.0, 1.3)])
def test_otto_work_in_closed_form(engine, strokes, r, gamma):
    e = engine.offset
    stroke = math.sqrt((A + B) ** 2 - e**2) - math.sqrt((B - A) ** 2 - e**2)
    work = indicated(ls.OttoCycle(r, P3, P1, gamma, strokes), engine)
    assert work == pytest.approx(otto_work(AREA * stroke, r, gamma), rel=2e-4)


def test_diesel_work_in_closed_form():
    r, cut = 18.0, 2.2
    heat = GAMMA / (GAMMA - 1) * P1 * r**GAMMA * STROKE_VOLUME / (r - 1) * (cut - 1)
    efficiency = 1 - r ** (1 - GAMMA) * (cut**GAMMA - 1) / (GAMMA * (cut - 1))
    assert indicated(DIESEL, ENGINE) == pytest.approx(efficiency * heat, rel=2e-4)


def test_a_crank_that_turns_the_other_way_gains_the_same_work():
    forward, back = (ls.sweep(scene(omega2=omega2), 1440, of=["T12", "power"]) for omega2 in (100.0, -100.0))
    assert float(back.power.mean()) == pytest.approx(float(forward.power.mean()), rel=1e-10)
    np.testing.assert_allclose(
        back.T12.values[1:], -forward.T12.values[:0:-1], atol=1e-9 * abs(forward.T12).max().item()
    )
    both = ls.sweep(scene(omega2=xr.DataArray([100.0, -100.0], dims="way")), 1440, of=["T12"])
    np.testing.assert_array_equal(both.T12.isel(way=1).values, back.T12.values)


@pytest.mark.parametrize(("branch", "sign"), [("open", -1.0), ("crossed", 1.0)])
def test_pressure_pushes_the_slider_away_from_the_head(branch, sign):
    engine = replace(ENGINE, branch=branch, slide_angle=30.0)
    by_hand = ls.Load("slider", force=(sign * (7e5 - P1) * AREA, 0.0), frame="link")
    cycle = ls.sweep(scene(7e5, engine), 24)
    expected = ls.sweep(ls.Scene(engine, omega2=100.0, loads=[by_hand]), 24)
    for name in ("F12x", "F43y", "F14y", "T12"):
        np.testing.assert_allclose(cycle[name], expected[name], rtol=1e-13, atol=1e-9)
    assert ls.sweep(scene(P1, engine), 24, of=["T12"]).T12.max() == 0.0


def test_power_balance_with_masses_friction_and_gas():
    residual = ls.sweep(ls.example("engine"), 720, of=["power_residual"]).power_residual
    assert float(abs(residual).max()) < 1e-12


def test_peaks_see_both_sides_of_the_jumps():
    """The rod's force at top dead centre, massless: the gas force of the peak pressure, though no sample is near."""
    engine = replace(ENGINE, offset=0.01)
    peaks = ls.peaks(scene(OTTO, engine), of=["F43"])
    slope = 0.01 / (A + B)
    assert float(peaks.F43_peak) == pytest.approx((P3 - P1) * AREA / math.sqrt(1 - slope**2), rel=1e-7)
    assert float(peaks.F43_peak_at) == pytest.approx(math.degrees(math.asin(slope)), abs=1e-5)


# ----------------------------------------------------------------------------- forms of a pressure


def test_a_pressure_as_constant_array_or_function_gives_equal_bits():
    constant = ls.sweep(scene(7.3e5), 36)
    angles = np.arange(36) * 10.0
    for inputs in (
        lambda theta2: 7.3e5,
        xr.DataArray(np.full(36, 7.3e5), {"theta2": angles}, "theta2"),
        xr.DataArray(np.full(5, 7.3e5), {"theta2": [0.0, 70.0, 100.0, 200.0, 290.0]}, "theta2"),
        xr.DataArray([7.3e5] * 36, dims="theta2"),
    ):
        cycle = ls.sweep(scene(inputs), 36)
        for name in constant.data_vars:
            np.testing.assert_array_equal(cycle[name].values, constant[name].broadcast_like(cycle[name]).values)


def test_a_cycle_and_its_samples_give_equal_results():
    angles = np.arange(720.0)
    sampled = xr.DataArray(OTTO.pressure(ENGINE, angles).values, {"theta2": angles}, "theta2")
    assert scene(sampled).period == 720.0
    np.testing.assert_array_equal(ls.sweep(scene(sampled), 720).T12, ls.sweep(scene(), 720).T12)


def test_design_dims():
    bore = xr.DataArray([0.08, 0.09], dims="bore_size")
    ratio = xr.DataArray([8.0, 9.0, 10.0], dims="ratio")
    length = xr.DataArray([0.12, 0.14], dims="rod_length")
    study = scene(replace(OTTO, compression_ratio=ratio), replace(ENGINE, rod=ls.Link(length, 0.0, 0.0)), bore=bore)
    cycle = ls.sweep(study, 72, of=["T12", "theta3"])
    assert set(cycle.T12.dims) == {"bore_size", "ratio", "rod_length", "theta2"}
    assert set(cycle.theta3.dims) == {"rod_length", "theta2"}
    one = ls.sweep(scene(), 72, of=["T12"])
    np.testing.assert_allclose(cycle.T12.isel(bore_size=1, ratio=1, rod_length=1), one.T12, rtol=1e-13, atol=1e-9)
    assert set(ls.peaks(study, of=["F12"]).F12_peak.dims) == {"bore_size", "ratio", "rod_length"}


def test_a_design_that_does_not_turn_changes_no_other():
    offset = xr.DataArray([0.0, 0.11], dims="offset_size")
    engine = replace(ENGINE, offset=offset, friction=0.1)
    result, one = ls.sweep(scene(OTTO, engine), 72), ls.sweep(scene(OTTO, replace(ENGINE, friction=0.1)), 72)
    np.testing.assert_array_equal(result.T12.isel(offset_size=0), one.T12)
    assert (result.status.isel(offset_size=1) != 0).all()
    peaks = ls.peaks(scene(OTTO, engine), of=["F12"])
    assert float(peaks.F12_peak[0]) == float(ls.peaks(scene(OTTO, replace(ENGINE, friction=0.1)), of=["F12"]).F12_peak)


def test_functions_of_theta2_and_designs_that_share_their_jumps():
    """Samples beside a jump are shared by all frictions, and a function is evaluated once at each."""
    loads = [ls.GasPressure(BORE, OTTO, P1), ls.Load("rod", torque=lambda theta2: 5.0 * np.cos(np.radians(theta2)))]
    friction = xr.DataArray([0.05, 0.2], dims="friction_size")
    study = ls.Scene(replace(ENGINE, friction=friction), omega2=100.0, loads=loads)
    peaks = ls.peaks(study, of=["F43"], theta2=180)
    for k in (0, 1):
        one = ls.peaks(replace(study, mechanism=replace(ENGINE, friction=float(friction[k]))), of=["F43"], theta2=180)
        assert float(peaks.F43_peak[k]) == float(one.F43_peak)


# -------------------------------------------------------------------------------------------- the files


@pytest.mark.parametrize(
    "pressure",
    [
        OTTO,
        DIESEL,
        replace(DIESEL, peak_pressure=9e6, strokes=2),
        replace(OTTO, compression_ratio=xr.DataArray([8.0, 9.5], {"r": [8.0, 9.5]}, "r")),
        3e5,
        xr.DataArray([1e5, 5e5, 2e5, 1e5], {"theta2": [0.0, 200.0, 400.0, 600.0]}, "theta2"),
        lambda theta2: 2e5 + 1e5 * np.cos(np.radians(theta2)),
    ],
)
@pytest.mark.filterwarnings("ignore::linksweep.OvershootWarning")  # few angles, through a spline all the same
def test_files_give_the_scene_back(pressure, tmp_path):
    inputs = scene(pressure, drive="coupler")
    if not callable(pressure):
        assert parse_scene(write_scene(inputs)) == inputs
    cycle = ls.sweep(inputs, 60)
    ls.save(cycle, tmp_path / "cycle.nc")
    again = ls.load_scene(tmp_path / "cycle.nc")
    assert isinstance(again.loads[0], ls.GasPressure)
    xr.testing.assert_identical(ls.sweep(again, cycle.theta2).drop_attrs(), cycle.drop_attrs())


def test_the_example_engine():
    engine = ls.example("engine")
    assert engine.period == 720.0
    assert engine.loads[0].pressure.peak_pressure == 6e6
    cycle = ls.sweep(engine)
    assert cycle.theta2.values.tolist() == list(range(720))
    assert int(cycle.status.max()) == 0
    assert float(cycle.T12.mean()) < 0.0  # the engine drives


# -------------------------------------------------------------------------------------------- messages

FOUR_BAR = ls.example("press").mechanism
TWO = array(1.2, 1.4, design=[1, 2])
SHORT = replace(ENGINE, rod=ls.Link(0.05, 0.0, 0.0), offset=0.02)
REFUSED = [
    ({"engine": FOUR_BAR}, "loads[1] is a GasPressure on a FourBar, which has no cylinder: give another"),
    (
        {"engine": ls.example("knuckle-press").mechanism},
        "loads[1].pressure is a cycle, which takes a SliderCrank, not a Linkage: give its pressure over theta2",
    ),
    (
        {"engine": replace(ENGINE, branch="both")},
        'loads[1] is a GasPressure, whose cylinder has one head: give branch="open" or "crossed"',
    ),
    (
        {"engine": SHORT},
        "loads[1].pressure is a cycle, which takes full turns of the crank: rod.length must be greater ",
    ),
    ({"bore": 0.0}, "loads[1].bore = 0 m: must be greater than 0"),
    ({"bore": np.sin}, "loads[1].bore = <ufunc 'sin'>: must be a number in m, not a function"),
    (
        {"pressure": "60 ber"},
        'loads[1].pressure = "60 ber": "ber" is not an accepted unit of pressure',
    ),
    ({"pressure": math.nan}, "loads[1].pressure = nan Pa: must be finite"),
    ({"crankcase": math.inf}, "loads[1].crankcase = inf Pa: must be finite"),
    (
        {"pressure": replace(OTTO, compression_ratio=1.0)},
        "loads[1].pressure.compression_ratio = 1: must be greater than",
    ),
    ({"pressure": replace(OTTO, gamma=0.9)}, "loads[1].pressure.gamma = 0.9: must be greater than 1"),
    ({"pressure": replace(OTTO, strokes=3)}, "loads[1].pressure.strokes = 3: must be 4 or 2"),
    ({"pressure": replace(OTTO, strokes=True)}, "loads[1].pressure.strokes = True: must be 4 or 2"),
    (
        {"pressure": replace(OTTO, peak_pressure=1e6)},
        "loads[1].pressure.peak_pressure = 1000000 Pa: must be at least 2.1674e+06 Pa, what compression alone gives",
    ),
    (
        {"pressure": replace(OTTO, peak_pressure=np.cos)},
        "loads[1].pressure.peak_pressure = <ufunc 'cos'>: must be a number in Pa, not a function",
    ),
    (
        {"pressure": replace(DIESEL, cutoff_ratio=20.0)},
        "loads[1].pressure.cutoff_ratio = 20: must be at most the compr",
    ),
    (
        {"pressure": replace(OTTO, gamma=array(1.3, 1.4), peak_pressure=array(5e6, 6e6, 7e6))},
        "loads[1].pressure.gamma has 2 values along design, but loads[1].pressure.peak_pressure has 3: one dimension",
    ),
]


@pytest.mark.parametrize(("changes", "message"), REFUSED)
def test_refusals_of_gas_pressure(changes, message):
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        scene(**changes)
    assert str(refused.value).startswith(message)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"cycle": ls.OttoCycle("10", "60 bar")}, 'cycle.compression_ratio = "10": has no unit; write 10 without'),
        ({"engine": replace(ENGINE, branch="both")}, 'engine.branch = "both": must be "open" or "crossed"; a cylinder'),
        ({"engine": FOUR_BAR}, "engine is a FourBar, which has no cylinder: give another machine"),
        ({"engine": 3}, "engine is a int: must be a SliderCrank"),
        (
            {"theta2": [[0.0, 1.0], [2.0, 3.0]]},
            "theta2 = [[0.0, 1.0], [2.0, 3.0]]: must be a count of angles, or a list",
        ),
        ({"theta2": 90.0}, "theta2 = 90.0: a count is a whole number; for one angle write [90.0]"),
        ({"turning": -300.0}, "turning = -300.0: must be 1 or -1, the sign of omega2"),
        ({"turning": xr.DataArray([1.0, 0.0], dims="way")}, "turning = <xarray.DataArray (way: 2)>"),
        (
            {
                "cycle": replace(OTTO, gamma=TWO),
                "engine": replace(ENGINE, offset=0.01 * TWO.assign_coords(design=[2, 1])),
            },
            "cycle.gamma has labels along design that are not those of engine.offset: make them equal, or rename",
        ),
    ],
)
def test_refusals_of_the_pressure_of_a_cycle(changes, message):
    request = {"cycle": OTTO, "engine": ENGINE, "theta2": [0.0]} | changes
    with pytest.raises(ValueError, match=f"^{re.escape(message)}"):
        request.pop("cycle").pressure(**request)


def test_a_count_of_angles_is_of_the_whole_cycle():
    np.testing.assert_array_equal(OTTO.pressure(ENGINE, 4).theta2, [0.0, 180.0, 360.0, 540.0])


FILE = Path(ls.__file__).parent / "scene" / "examples" / "engine.toml"
REFUSED_IN_A_FILE = [
    (
        '"OttoCycle"',
        '"OtoCycle"',
        ":28: loads[1].pressure.type = 'OtoCycle': must be one of OttoCycle, DieselCycle; did",
    ),
    ('"60 bar"', '"60 N"', ':28: loads[1].pressure.peak_pressure = "60 N": N is a unit of force, not of pressure;'),
    ('"60 bar"', '"6 bar"', ":28: loads[1].pressure.peak_pressure = 600000 Pa: must be at least"),
    (
        "compression_ratio",
        "compresion_ratio",
        ':28: loads[1].pressure.compresion_ratio: unknown key; did you mean "comp',
    ),
    ('bore = "86 mm"\n', "", ':25: loads[1].bore: missing; write bore = "8 cm", or a number in m'),
    ("bore =", "boer =", ':27: loads[1].boer: unknown key; did you mean "bore"?'),
]


@pytest.mark.parametrize(("old", "new", "message"), REFUSED_IN_A_FILE)
def test_refusals_in_a_file_name_the_line(old, new, message):
    text = FILE.read_text(encoding="utf-8")
    assert text.count(old) == 1
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        parse_scene(text.replace(old, new), "engine.toml")
    assert str(refused.value).startswith("engine.toml" + message)
    assert "\n" not in str(refused.value)


def test_a_cycle_is_frozen():
    with pytest.raises(dataclasses.FrozenInstanceError):
        OTTO.gamma = 1.3
