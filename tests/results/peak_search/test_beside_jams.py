"""Peaks and means of motion beside angles at which friction jams a machine: these count no more than in a sweep.

A slider-crank that its crank drives moves where the rod's slope is below atan(1/μ), and one that its rod drives where
the crank's slope is.
"""

import math

import numpy as np
import pytest
import xarray as xr
from references import mp

import linksweep as ls
from linksweep.results.peak_search.rises import sector_peaks

A, B, SPEED, FRICTION = 0.05, 0.15, 20.0, 5.0
ROD_SLOPE = math.degrees(math.atan(1.0 / FRICTION))
PER_TURN = 3600


def engine(friction=FRICTION, drive="crank", offset=0.0, crank=A) -> ls.Scene:
    links = ls.Link(crank, 1.2, 1e-3), ls.Link(B, 0.6, 2e-3, cg_distance=0.05)
    machine = ls.SliderCrank(*links, slider_mass=0.5, offset=offset, friction=friction)
    return ls.Scene(machine, SPEED, gravity=(0.0, -9.81), drive=drive)


def velocity(angle):
    """Velocity of the slider by the crank's angle [rad], from x = a·cos θ + √(b² − a²·sin² θ)."""
    sin, cos = mp.sin(angle), mp.cos(angle)
    return -SPEED * A * (sin + A * sin * cos / mp.sqrt(B**2 - (A * sin) ** 2))


def jam_of_crank():
    """Crank's angle [rad] at which the rod's slope is that of a jam."""
    return mp.asin(B / A / mp.sqrt(1 + mp.mpf(FRICTION) ** 2))


def test_largest_velocity_is_that_where_the_slider_jams():
    peaks, jam = ls.peaks(engine(), of=["v_slider", "theta3", "x_slider"]), jam_of_crank()
    expected = max(abs(velocity(jam)), abs(velocity(mp.pi - jam)))
    assert float(peaks.v_slider_max) == pytest.approx(float(expected), rel=1e-10)
    assert float(peaks.v_slider_min) == pytest.approx(-float(expected), rel=1e-10)
    assert float(peaks.v_slider_max_at) == pytest.approx(360.0 - math.degrees(jam), abs=1e-7)
    assert float(peaks.v_slider_min_at) == pytest.approx(math.degrees(jam), abs=1e-7)
    assert (float(peaks.theta3_max), float(peaks.theta3_min)) == pytest.approx((ROD_SLOPE, -ROD_SLOPE), rel=1e-10)
    assert (float(peaks.x_slider_max), float(peaks.x_slider_min)) == pytest.approx((B + A, B - A), rel=1e-13)


def test_largest_velocity_of_a_part_that_ends_in_a_jam():
    peaks, jam = ls.peaks(engine(), of=["v_slider"], between=(10.0, 90.0)), jam_of_crank()
    assert float(peaks.v_slider_min) == pytest.approx(float(velocity(jam)), rel=1e-10)
    assert float(peaks.v_slider_max) == pytest.approx(float(velocity(mp.radians(10))), rel=1e-13)
    assert (int(peaks.v_slider_min_at_end), int(peaks.v_slider_max_at_end)) == (0, 1)


def test_means_are_over_the_time_of_motion():
    with mp.workdps(20):
        jam = jam_of_crank()
        square = mp.quad(lambda x: velocity(x) ** 2, [0, jam]) + mp.quad(
            lambda x: velocity(x) ** 2, [mp.pi - jam, mp.pi]
        )
    peaks = ls.peaks(engine(), of=["v_slider_rms", "v_slider_mean"])
    assert float(peaks.v_slider_rms) == pytest.approx(float(mp.sqrt(square / (2 * jam))), rel=1e-10)
    assert float(peaks.v_slider_mean) == pytest.approx(0.0, abs=1e-12)
    samples = ls.sweep(engine(), 36000, of=["v_slider"]).v_slider
    assert float(peaks.v_slider_rms) == pytest.approx(float(np.sqrt((samples**2).mean())), rel=1e-3)


def test_free_designs_keep_their_bits_beside_jammed_ones():
    """The motion of designs that differ in friction alone is one: it counts wherever one of them moves."""
    of = ["T12", "theta3", "v_slider_rms"]
    free, rough, rougher = (ls.peaks(engine(friction, offset=0.01), of) for friction in (0.1, 5.0, 9.0))
    beside = ls.peaks(engine(xr.DataArray([0.1, 9.0], dims="mu"), offset=0.01), of)
    jammed = ls.peaks(engine(xr.DataArray([9.0, 5.0, 200.0], dims="mu"), offset=0.01), of)
    for name in ("T12_max", "T12_max_at", "T12_min", "T12_min_at"):
        np.testing.assert_array_equal(beside[name], [free[name], rougher[name]])
    for name in ("theta3_max", "theta3_max_at", "theta3_min", "v_slider_rms"):
        np.testing.assert_array_equal(beside[name], free[name], err_msg=name)
    for name in ("theta3_max", "theta3_max_at", "theta3_min"):
        np.testing.assert_array_equal(jammed[name], rough[name], err_msg=name)
    assert float(rougher.theta3_max) < float(rough.theta3_max) < float(free.theta3_max)


@pytest.mark.parametrize("drive", ["crank", "coupler"])
def test_designs_have_the_same_bits_alone(drive):
    lengths, friction = np.linspace(0.03, 0.08, 8), np.tile([0.1, 0.4, 3.0, 8.0], 2)
    of = ["F32", "theta3", "v_slider", "a_slider", "omega3_rms"]
    every = ls.peaks(engine(xr.DataArray(friction, dims="d"), drive, crank=xr.DataArray(lengths, dims="d")), of)
    for k, (length, mu) in enumerate(zip(lengths, friction, strict=True)):
        alone = ls.peaks(engine(float(mu), drive, crank=float(length)), of)
        for name in alone.data_vars:
            np.testing.assert_array_equal(alone[name], every[name][k], err_msg=name)


def random_scene(seed: int, kind: str, drive: str) -> ls.Scene:
    random = np.random.default_rng(seed)
    first, second, third = random.uniform(0.03, 0.2, 3)
    offset, friction = third * random.uniform(-0.5, 0.5), random.uniform(0.1, 2.5)
    links = ls.Link(first, 1.0, 1e-3), ls.Link(second, 0.5, 1e-3, cg_distance=0.5 * second)
    if kind == "slider-crank":
        branch = str(random.choice(["open", "crossed"]))
        machine = ls.SliderCrank(*links, 0.5, offset, friction, branch, slide_angle=random.uniform(-90.0, 90.0))
    else:
        machine = ls.InvertedSliderCrank(
            *links, first * random.uniform(0.5, 2.0), 0.5, offset=offset, friction=friction
        )
    speed = float(random.choice([-1.0, 1.0])) * random.uniform(1.0, 30.0)
    return ls.Scene(machine, speed, random.uniform(-9.0, 9.0), (0.0, -9.81), drive=drive)


MOTION = {"slider-crank": ["theta3", "x_slider", "v_slider"], "inverted": ["theta4", "slide", "slide_velocity"]}
DRIVEN = [("slider-crank", "crank"), ("slider-crank", "coupler"), ("inverted", "crank"), ("inverted", "rocker")]


@pytest.mark.parametrize(("kind", "drive"), DRIVEN)
def test_peaks_of_random_machines_are_those_of_dense_sweeps(kind, drive):
    jammed = 0
    for seed in range(12):
        scene, names = random_scene(seed, kind, drive), MOTION[kind]
        peaks, cycle = ls.peaks(scene, of=names), ls.sweep(scene, PER_TURN, of=names)
        jams = cycle.status >= 4
        jammed += int(jams.any() and not jams.all())
        for name in names:
            at = [float(peaks[f"{name}_{end}_at"]) for end in ("max", "min")]
            around = np.add.outer(at, np.outer([-1.0, 1.0], np.geomspace(1e-9, 0.1, 17)).ravel()).ravel()
            samples = np.concatenate([cycle[name].values, ls.sweep(scene, np.unique(around), of=names)[name].values])
            size = np.nanmax(np.abs(samples))
            assert np.nanmax(samples) <= float(peaks[f"{name}_max"]) + 1e-12 * size, (seed, name)
            assert np.nanmin(samples) >= float(peaks[f"{name}_min"]) - 1e-12 * size, (seed, name)
            for end, sample in (("max", np.nanmax(samples)), ("min", np.nanmin(samples))):
                value = float(peaks[f"{name}_{end}"])
                if math.isinf(value):
                    assert abs(sample) > 1e3 * np.nanmedian(np.abs(samples)), (seed, name)
                else:  # beside a toggle motion varies as the root of the angle
                    assert value == pytest.approx(sample, rel=1e-4, abs=1e-4 * size), (seed, name)
    assert jammed >= 4


def test_poles_outside_of_jams_remain():
    """The output stands still at its dead centres, where the slider-crank moves on."""
    peaks = ls.peaks(engine(), of=["mechanical_advantage"])
    assert float(peaks.mechanical_advantage_peak) == math.inf and int(peaks.status) == 3


def test_largest_values_in_sectors_are_those_of_a_dense_sweep():
    (values,), _ = sector_peaks(engine(offset=0.01), ("v_slider",), 6)
    samples = ls.sweep(engine(offset=0.01), 360000, of=["v_slider"]).v_slider.values.reshape(6, -1)
    np.testing.assert_allclose(values[0], np.fmax.reduce(samples, axis=1), atol=1e-4)


def test_a_mean_has_no_derivative_where_ends_of_a_jam_move():
    of = ["v_slider_rms"]
    statuses = [ls.sensitivities(engine(mu), of=of, to=["crank.length"]).v_slider_rms_status for mu in (0.1, FRICTION)]
    assert [int(status) for status in statuses] == [0, 2]


def test_a_motor_beside_a_linkage_with_friction_and_a_load_over_the_angle():
    def torque(theta2):
        return 5.0 * np.cos(np.radians(theta2))

    press = ls.example("knuckle-press")
    rough = ls.Scene(press.mechanism, 5.0, loads=[ls.Load("crank", torque=torque)])
    motor = ls.Motor([0.0, 1e4], [1e6, 1e6], inertia=0.01)
    load = ls.motor_load(rough, motor, theta2=PER_TURN)
    assert float(load.torque_margin_min) == pytest.approx(float(load.torque_margin.min()), rel=1e-9)
    assert float(load.torque_margin_min) <= float(load.torque_margin.min())


@pytest.mark.parametrize("angle", [30.0, 17.3])
def test_values_end_where_friction_jams_two_guides_that_become_parallel(angle):
    """A pin slides in a fixed guide at the height 0.3 and in one of the crank, turned by an angle from it, a past B:
    x = Px + (0.3 − Py)/tan(θ2 + angle). Within atan(friction) of parallel the slide that friction holds is jammed."""
    guides = {
        "g0": ls.Guide(through=(0.0, 0.3), friction=0.2),
        "g1": ls.Guide(of="crank", through=(0.0, 0.05), angle=angle),
    }
    machine = ls.Linkage(
        "crank A-B, s1 D on g0, s2 D on g1",
        ground={"A": (0.0, 0.0)},
        guides=guides,
        crank=ls.Link(0.1, 1.0, 0.01, 0.05),
        s1=ls.Slider(1.0),
        s2=ls.Slider(1.0),
    )
    scene = ls.Scene(machine, omega2=10.0)

    def x_at(theta2: np.ndarray) -> np.ndarray:
        turned = np.radians(theta2)
        x, y = -0.05 * np.sin(turned), 0.05 * np.cos(turned)
        return x + (0.3 - y) / np.tan(np.radians(theta2 + angle))

    dense = ls.sweep(scene, 7200, of=["Dx"])
    np.testing.assert_allclose(dense.Dx, np.where(dense.status == 0, x_at(dense.theta2.values), np.nan), rtol=1e-10)
    edges = np.add.outer([-angle, 180.0 - angle], math.degrees(math.atan(0.2)) * np.array([-1.0, 1.0])).ravel()
    for part in (None, (10.0, 370.0)):
        peaks = ls.peaks(scene, of=["Dx", "reduced_inertia"], between=part)
        assert float(peaks.Dx_max) == pytest.approx(x_at(edges).max(), rel=1e-7)
        assert float(peaks.Dx_min) == pytest.approx(x_at(edges).min(), rel=1e-7)
        assert np.isfinite(peaks.reduced_inertia_max)
