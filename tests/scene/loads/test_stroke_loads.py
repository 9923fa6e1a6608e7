"""Loads over the position of a link: against closed forms, against the same loads over the crank angle with its breaks
worked out by hand, and against virtual work; designs, files, reports."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.files.netcdf import scene_of
from linksweep.reports.page import page
from linksweep.scene.file.reading import parse_scene, read_scene
from linksweep.scene.file.writing import write_scene
from linksweep.studies.job import scene_digest

A, B = 0.04, 0.14
PUSH = 50e3
OF = ["F32", "T12", "T12_mean"]


def machine(offset=0.01, branch="open", **changes) -> ls.SliderCrank:
    words = {"slider_mass": 0.5, "offset": offset, "slide_angle": 20.0, "branch": branch} | changes
    return ls.SliderCrank(ls.Link(A, 1.0, 1e-3, 0.01), ls.Link(B, 0.5, 1e-3, 0.05), **words)


def table(values, positions) -> xr.DataArray:
    return xr.DataArray(values, {"position": positions}, "position")


LAST_12_MM = table([-PUSH, 0.0], [0.0, 0.012])


def press(mechanism=None, force=LAST_12_MM, omega2=10.0, **words) -> ls.Scene:
    words = {"over": "slider.to_end", "while_": "closing", "interpolation": "step"} | words
    return ls.Scene(mechanism or machine(), omega2=omega2, loads=[ls.Load("slider", force=force, **words)])


def force_of(scene, theta2) -> np.ndarray:
    return ls.sweep(scene, theta2, of=["T12"])["loads[1].force[1]"].values


def position(theta2, offset=0.01, sign=1.0):
    """Return the slider's position along its guide, by the closed form of an offset slider-crank."""
    turned = np.radians(np.asarray(theta2) - 20.0)
    return A * np.cos(turned) + sign * np.sqrt(B**2 - (offset - A * np.sin(turned)) ** 2)


def angle_at(x, offset, side):
    """Crank angle [degree] at a position, by the cosine rule in the triangle of crank, rod and the slider's radius."""
    reach = math.hypot(x, offset)
    between = math.degrees(math.acos((A * A + reach * reach - B * B) / (2.0 * A * reach)))
    return 20.0 + math.degrees(math.atan2(offset, x)) + side * between


# ----------------------------------------------------------------------------------------- where it acts


@pytest.mark.parametrize("offset", [0.0, 0.01, -0.03])
@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize("omega2", [10.0, -10.0])
def test_a_press_pushes_over_the_last_12_mm_whatever_the_offset(offset, branch, omega2):
    theta2 = np.arange(0.0, 360.0, 0.05) + 0.013
    sign = 1.0 if branch == "open" else -1.0
    x = position(theta2, offset, sign)
    end = math.sqrt((A + B) ** 2 - offset**2)
    step = np.radians(1e-4)
    rate = (position(theta2 + 1e-4, offset, sign) - position(theta2 - 1e-4, offset, sign)) / (2 * step) * omega2
    expected = np.where((end - sign * x < 0.012) & (sign * rate > 0.0), -PUSH, 0.0)
    force = force_of(press(machine(offset, branch), omega2=omega2), theta2)
    np.testing.assert_array_equal(force, expected)
    assert 0.02 < np.mean(expected != 0.0) < 0.3


def test_stroke_opening_closing_and_both():
    theta2 = np.arange(360) + 0.5
    closing, opening, both = (force_of(press(while_=way), theta2) for way in ("closing", "opening", None))
    np.testing.assert_array_equal(closing + opening, both)
    assert np.any(closing)
    assert np.any(opening)
    assert not np.any((closing != 0.0) & (opening != 0.0))


@pytest.mark.parametrize("kind", ["linear", "pchip", None])
def test_a_table_over_the_position_interpolates_and_holds_its_end_values(kind):
    theta2 = np.arange(0.0, 360.0, 3.7)
    positions, values = [0.11, 0.13, 0.15, 0.17], [0.0, 100.0, 100.0, -50.0]
    force = force_of(
        press(force=table(values, positions), over="slider.position", while_=None, interpolation=kind), theta2
    )
    x = position(theta2)
    if kind == "pchip":
        assert force.min() >= -50.0 - 1e-9
        assert force.max() <= 100.0 + 1e-9
        at_125 = force_of(
            press(force=table(values, positions), over="slider.position", while_=None), [angle_at(0.13, 0.01, 1)]
        )
        np.testing.assert_allclose(at_125, 100.0, atol=1e-6)
    else:
        np.testing.assert_allclose(force, np.interp(x, positions, values), atol=1e-9)
    np.testing.assert_allclose(force[x < 0.11], 0.0, atol=1e-9)
    np.testing.assert_allclose(force[x > 0.17], -50.0, atol=1e-9)


def test_a_function_of_the_position_equals_the_table_of_its_values():
    jump = lambda left: np.where(left < 0.012, -PUSH, 0.0)  # noqa: E731
    by_function = press(force=jump, interpolation=None, breaks=[0.012])
    theta2 = np.arange(0.0, 360.0, 0.3)
    np.testing.assert_array_equal(force_of(by_function, theta2), force_of(press(), theta2))
    peaks, expected = (ls.peaks(scene, OF) for scene in (by_function, press()))
    for name in expected.data_vars:
        assert float(peaks[name]) == pytest.approx(float(expected[name]), rel=1e-12)


def test_a_constant_force_acts_on_one_stroke():
    theta2 = np.arange(0.0, 360.0, 0.7)
    v = ls.sweep(press(), theta2, of=["v_slider"]).v_slider.values
    force = force_of(press(force=-300.0, over="slider.position", interpolation=None), theta2)
    np.testing.assert_array_equal(force, np.where(v > 0.0, -300.0, 0.0))


def test_a_torque_follows_the_rocker():
    four_bar = replace(ls.example("press").mechanism, ground_angle=45.0)  # its rocker swings across ±180 degrees
    torque = table([0.0, -12.0, 5.0], [160.0, 180.0, 200.0])
    words = {"over": "rocker.angle", "while_": "clockwise"}
    scene = ls.Scene(four_bar, omega2=30.0, loads=[ls.Load("rocker", torque=torque, **words)])
    cycle = ls.sweep(scene, 360, of=["theta4", "omega4", "T12"])
    angle = np.mod(cycle.theta4.values, 360.0)
    assert np.ptp(cycle.theta4.values) > 300.0  # it does
    expected = np.where(cycle.omega4.values < 0.0, np.interp(angle, [160.0, 180.0, 200.0], [0.0, -12.0, 5.0]), 0.0)
    np.testing.assert_allclose(cycle["loads[1].torque"].values, expected, atol=1e-9)


def test_a_cylinder_pushes_while_it_extends():
    arm = ls.example("quick-return").mechanism
    load = ls.Load("block", force=(-700.0, 0.0), frame="link", over="block.position", while_="extending")
    cycle = ls.sweep(ls.Scene(arm, omega2=5.0, loads=[load]), 360, of=["slide_velocity", "T12"])
    expected = np.where(cycle.slide_velocity.values > 0.0, -700.0, 0.0)
    np.testing.assert_array_equal(cycle["loads[1].force[1]"].values, expected)


# ----------------------------------------------------------------------------------------- peaks and means


@pytest.mark.parametrize("offset", [0.0, 0.01, -0.03])
def test_peaks_equal_those_of_a_load_over_the_angle_with_breaks(offset):
    """The push begins where 12 mm are left and ends at the dead centre, both in closed form."""
    first = angle_at(math.sqrt((A + B) ** 2 - offset**2) - 0.012, offset, -1)
    last = 20.0 + math.degrees(math.asin(offset / (A + B)))
    over_angle = lambda t: np.where(np.mod(t - first, 360.0) < np.mod(last - first, 360.0), -PUSH, 0.0)  # noqa: E731
    by_hand = ls.Scene(machine(offset), 10.0, loads=[ls.Load("slider", force=over_angle, breaks=[first, last])])
    peaks, expected = ls.peaks(press(machine(offset)), OF), ls.peaks(by_hand, OF)
    for name in ("F32_peak", "T12_max", "T12_min", "T12_mean"):
        assert float(peaks[name]) == pytest.approx(float(expected[name]), rel=1e-9), name
    apart = abs(float(peaks.T12_max_at) - first % 360.0)
    assert min(apart, 360.0 - apart) < 1e-6


def test_the_mean_torque_does_the_work_of_the_push():
    """F·12 mm a turn, and nothing else does work: virtual work."""
    for branch, sign in (("open", 1.0), ("crossed", -1.0)):
        peaks = ls.peaks(press(machine(0.02, branch), force=sign * LAST_12_MM), ["T12_mean"])
        assert float(peaks.T12_mean) == pytest.approx(PUSH * 0.012 / (2.0 * np.pi), rel=1e-9)
    ramp = table([-PUSH, 0.0], [0.0, 0.012])  # falls in a straight line: half the work
    peaks = ls.peaks(press(force=ramp, interpolation="linear"), ["T12_mean"])
    assert float(peaks.T12_mean) == pytest.approx(0.5 * PUSH * 0.012 / (2.0 * np.pi), rel=1e-9)


def test_power_balances():
    residual = ls.sweep(press(friction := machine(friction=0.1)), 720, of=["power_residual", "power"])
    assert friction.friction == 0.1
    assert float(abs(residual.power_residual).max()) < 1e-9 * float(abs(residual.power).max())


@pytest.mark.parametrize(
    ("name", "words", "drawn"),
    [
        ("press", {"over": "rocker.angle", "while_": "counter-clockwise"}, ("theta4", -200.0)),
        ("quick-return", {"over": "block.position", "while_": "retracting"}, ("slide", 300.0)),
    ],
)
def test_exact_peaks_include_the_corners_of_stroke_loads(name, words, drawn):
    """Evaluate other machines on both sides of each crank angle at which the load jumps, located by bisection."""
    quantity, force = drawn
    example = replace(ls.example(name), loads=[])
    fine = ls.sweep(example, 3600, of=[quantity])[quantity]
    middle = float(fine.min() + 0.4 * (fine.max() - fine.min()))
    load = ls.Load("rocker", torque=table([0.0, force], [middle - 1.0, middle]), interpolation="step", **words)
    scene = replace(example, loads=[load])
    loaded = ls.sweep(scene, 3600, of=["T12"])["loads[1].torque"].values != 0.0
    for k in np.flatnonzero(loaded != np.roll(loaded, 1)):
        low, high = (k - 1) * 0.1, k * 0.1
        for _ in range(40):
            half = 0.5 * (low + high)
            on = ls.sweep(scene, [half], of=["T12"])["loads[1].torque"].values[0] != 0.0
            low, high = (half, high) if on == loaded[k - 1] else (low, half)
        apart = [abs((angle - half + 180.0) % 360.0 - 180.0) for angle in scene.jumps()]
        assert np.nanmin(apart) < 1e-9


def test_a_study_of_offsets_is_each_design_by_itself():
    offsets = xr.DataArray([-0.03, 0.0, 0.02], dims="design")
    rods = xr.DataArray([0.12, 0.16], dims="rod")
    many = ls.SliderCrank(ls.Link(A, 1.0, 1e-3), ls.Link(rods, 0.5, 1e-3), slider_mass=0.5, offset=offsets)
    peaks = ls.peaks(press(many), [*OF, "F12_rms"])
    cycle = ls.sweep(press(many), 90, of=["T12"])
    for i, j in np.ndindex(3, 2):
        mechanism = replace(many, offset=float(offsets[i]), rod=replace(many.rod, length=float(rods[j])))
        alone = ls.peaks(press(mechanism), [*OF, "F12_rms"])
        for name in alone.data_vars:
            assert float(peaks[name].isel(design=i, rod=j)) == float(alone[name]), name
        np.testing.assert_array_equal(cycle.T12.isel(design=i, rod=j), ls.sweep(press(mechanism), 90, of=["T12"]).T12)


def test_a_machine_that_moves_over_part_of_a_turn():
    short = machine(offset=0.11)
    peaks = ls.peaks(press(short, force=table([-100.0, 0.0], [0.0, 0.005])), ["F14"])
    assert int(peaks.status) in (1, 3)
    cycle = ls.sweep(press(short), 360, of=["status", "F14"])
    assert set(cycle.status.values.tolist()) == {0, 1}
    np.testing.assert_array_equal(np.isnan(cycle.F14), cycle.status != 0)


def test_contributions_of_a_breakdown_add_up():
    shares = ls.breakdown(press(), "T12", theta2=[10.0, 100.0])
    whole = ls.sweep(press(), [10.0, 100.0], of=["T12"]).T12
    np.testing.assert_allclose(shares.T12.sum("source"), whole, rtol=1e-9)


# ------------------------------------------------------------------------------------------ through files

FILE = """\
omega2 = 10
[mechanism]
type = "SliderCrank"
slider_mass = 0.5
crank = {length = 0.04, mass = 1, inertia = 1e-3}
rod = {length = 0.14, mass = 0.5, inertia = 1e-3}
[[loads]]
link = "slider"
over = "slider.to_end"
while_ = "closing"
interpolation = "step"
"""


@pytest.mark.parametrize(
    "force",
    [
        'force = {dim = "position", values = ["-50 kN", 0], position = [0, "12 mm"]}',
        'force = {dim = "position", values = [-50000.0, 0.0], coords = {position = [0.0, 0.012]}}',
        'force = {csv = "p.csv", unit = "kN"}',
    ],
)
def test_stroke_loads_round_trip_through_scene_files(tmp_path, force):
    (tmp_path / "p.csv").write_text("position,P\n0,-50\n0.012,0\n")
    (tmp_path / "scene.toml").write_text(FILE + force + "\n")
    made = read_scene(tmp_path / "scene.toml")
    expected = press(ls.SliderCrank(ls.Link(A, 1.0, 1e-3), ls.Link(B, 0.5, 1e-3), slider_mass=0.5))
    assert float(ls.peaks(made, ["T12"]).T12_max) == float(ls.peaks(expected, ["T12"]).T12_max)
    assert parse_scene(write_scene(made)) == made


def test_results_and_studies_store_the_whole_load(tmp_path):
    many = press(machine(xr.DataArray([0.0, 0.01, 0.02], dims="design")))
    study = ls.study(many, tmp_path / "study.nc", of=["T12"])
    assert ls.load_scene(tmp_path / "study.nc") == many
    np.testing.assert_array_equal(study.T12_max, ls.peaks(many, ["T12"]).T12_max)
    second = ls.scene_at(study, design=1)
    assert float(ls.peaks(second, ["T12"]).T12_max) == float(study.T12_max[1])


def test_different_stroke_loads_are_not_equal():
    made = [
        press(),
        press(while_="opening"),
        press(while_=None),
        press(over="slider.position"),
        press(force=2.0 * LAST_12_MM),
        press(force=LAST_12_MM.assign_coords(position=[0.0, 0.011])),
    ]
    assert len({*made}) == len({scene_digest(one) for one in made}) == len(made)


def test_a_function_of_the_position_cannot_be_stored(tmp_path):
    made = [press(force=lambda x, f=f: f * x, interpolation=None) for f in (1.0, 2.0)]
    assert scene_digest(made[0]) != scene_digest(made[1])
    with pytest.raises(ValueError, match=r"^loads\[1\] has a function of a position: give it as a DataArray"):
        made[0].to_toml()
    ls.save(ls.peaks(made[0], ["T12"]), tmp_path / "peaks.nc")
    with pytest.raises(
        ValueError, match=r"loads\[1\].force\[1\]: was a function of a position; give it as a DataArray"
    ):
        ls.load_scene(tmp_path / "peaks.nc")


@pytest.mark.parametrize("torque", [None, 3.0, table([2.0, 5.0], [0.0, 0.1])])
def test_a_cycle_holds_the_samples_of_a_function_of_the_position(torque):
    """The machine of a cycle is drawn with its loads there: beside those of a table with the function's values."""
    by_table, by_function = (
        press(force=force, torque=torque, interpolation=None)
        for force in (table([-PUSH, 0.0], [0.0, 0.1]), lambda x: PUSH * (x / 0.1 - 1.0))
    )
    cycle = ls.sweep(by_function, 90, of=["T12"])
    drawn = scene_of(cycle, whole=False)
    assert drawn.loads[0].over is None
    expected = ls.sweep(by_table, 90, of=["T12"]).T12
    np.testing.assert_allclose(ls.sweep(drawn, 90, of=["T12"]).T12, expected, rtol=0.0, atol=1e-9)
    assert cycle.linksweep.mechanism(45.0) is not None


def test_the_report_names_the_position():
    assert "over slider.to_end, while closing" in page(press())


# ----------------------------------------------------------------------------------------------- messages

REFUSED = [
    (
        {"over": "slider.postion"},
        "loads[1].over = 'slider.postion': must be one of slider.position, slider.to_end; did",
    ),
    ({"while_": "closed"}, "loads[1].while_ = 'closed': must be one of closing, opening; did you mean"),
    ({"over": None}, "loads[1].while_ = 'closing': give the position that it means, as in over="),
    (
        {"interpolation": "periodic cubic"},
        "loads[1].interpolation = 'periodic cubic': must be one of linear, pchip, step",
    ),
    (
        {"force": xr.DataArray([0.0, 1.0, 2.0], {"theta2": [0.0, 120.0, 240.0]}, "theta2")},
        "loads[1].force[1] depends on theta2, but the load on a position: give it dims=",
    ),
    (
        {"force": xr.DataArray([1.0, 2.0], dims="position")},
        "loads[1].force[1] has dims ('position',): must be over its",
    ),
    (
        {"force": xr.DataArray([[1.0, 2.0]], {"position": [0.0, 1.0]}, ("case", "position"))},
        "loads[1].force[1] has dims ('case', 'position'): must be over its positions alone",
    ),
    ({"force": table([1.0], [0.0])}, "loads[1].force[1] has position = [0.0]: must hold two or more different finite"),
    ({"force": table([1.0, 2.0], [0.1, 0.1])}, "loads[1].force[1] has position = [0.1, 0.1]: must hold two or more"),
]


@pytest.mark.parametrize(("words", "message"), REFUSED)
def test_refusals_of_stroke_loads(words, message):
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        press(**words)
    assert str(refused.value).startswith(message)


def test_a_position_needs_one_branch():
    with pytest.raises(
        ValueError, match=r"^loads\[1\].over = 'slider.to_end': is a position of one branch; give branch="
    ):
        press(machine(branch="both"))


def test_a_function_that_fails_is_refused():
    with pytest.raises(ValueError, match=r"^loads\[1\].force\[1\]: the function failed on an array of positions"):
        ls.sweep(press(force=lambda x: 1.0 if x > 0.1 else 0.0, interpolation=None), 8)
    with pytest.raises(ValueError, match=r"^loads\[1\].force\[1\] = nan N .* must be finite"):
        ls.sweep(press(force=lambda x: np.nan * x, interpolation=None), 8)
