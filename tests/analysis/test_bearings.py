"""bearings: frames, rotation, pressure and friction against their definitions; life against published examples."""

import re
from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from refusals import LOOP, refusal
from scipy.integrate import quad

import linksweep as ls

PRESS, ENGINE, SHAPER = (ls.example(name) for name in ("press", "engine", "quick-return"))
LIGHT = ls.Link(length=0.1, mass=0.0, inertia=0.0)
TURNING = ls.FourBar(LIGHT, ls.Link(0.3, 0.0, 0.0), ls.Link(0.25, 0.0, 0.0), ground=0.2)


def loaded(force, omega2=30.0, **bearing):
    """Return the main bearing's row of a massless machine whose only load is a force (Fx, 0) on the crank at A."""
    scene = ls.Scene(TURNING, omega2=omega2, loads=[ls.Load("crank", force=(force, 0.0))])
    return ls.bearings(scene, {"A": ls.Bearing(**bearing)}).sel(pin="A")


# ------------------------------------------------------------------------------------------------- life


def test_a_constant_load_is_its_own_equivalent():
    for kind in ("ball", "roller"):
        assert float(loaded(-800.0, kind=kind).equivalent_load) == pytest.approx(800.0, rel=1e-13)


@pytest.mark.parametrize(
    ("ratio", "factor"), [(0.0, 1.0), (0.2, 1.02), (0.4, 1.07), (0.6, 1.15), (0.8, 1.25), (1.0, 1.36)]
)
def test_shigleys_rotary_pump(ratio, factor):
    """Shigley, Rolling-Contact Bearings, variable loads: F = F̄ + A sin θ on a ball bearing, its table of factors."""
    row = loaded(lambda theta2: 1000.0 * (1.0 + ratio * np.sin(np.radians(theta2))))
    assert float(row.equivalent_load) == pytest.approx(1000.0 * (1.0 + 1.5 * ratio**2) ** (1.0 / 3.0), rel=1e-13)
    assert float(row.equivalent_load) / 1000.0 == pytest.approx(factor, abs=0.005)


def test_shigleys_roller_bearing():
    """Shigley, 8th ed., problem 11-3 as its manual solves it: 1.4 × 1650 lbf = 10.279 kN for 50 000 h at 480 rev/min,
    1440 million revolutions, take a straight roller bearing with a C10 of 91.1 kN."""
    speed = 480.0 * 2.0 * np.pi / 60.0
    row = loaded(10_279.0, omega2=speed, capacity=91_100.0, kind="roller")
    assert float(row.L10) == pytest.approx(1440.0, rel=2e-3)
    assert float(row.L10h) == pytest.approx(50_000.0, rel=2e-3)
    assert float(row.L10h) == pytest.approx(float(row.L10) * 1e6 / (480.0 * 60.0), rel=1e-12)


def test_a_swinging_pin_counts_the_angle_that_it_turns():
    """In a cycle the rocker turns by twice its swing; the coupler's pins also against the closed form."""
    bearings = ls.bearings(PRESS, theta2=7200)
    cycle = ls.sweep(PRESS, theta2=7200)
    np.testing.assert_allclose(bearings.rotation.sel(pin="D"), 2.0 * np.ptp(cycle.theta4.values), rtol=1e-6)
    at_c = np.unwrap(cycle.theta4 - cycle.theta3, period=360.0)
    turned = np.abs(np.diff(at_c, append=at_c[0])).sum()
    np.testing.assert_allclose(bearings.rotation.sel(pin="C"), turned, rtol=1e-6)
    np.testing.assert_allclose(bearings.rotation.sel(pin="A"), 360.0, rtol=1e-13)
    np.testing.assert_allclose(bearings.rotation_share.sum("theta2"), 1.0, rtol=1e-13)


def test_the_life_of_an_oscillating_bearing():
    """The oscillation factor that O. Menck and M. Stammler review: (C/F)^p·180°/swing million swings to and fro. The
    swing is that of a four-bar's rocker by the law of cosines; a load at D is borne there alone."""
    a, b, c, d = 0.1, 0.3, 0.25, 0.35
    light = [ls.Link(length, 0.0, 0.0) for length in (a, b, c)]
    scene = ls.Scene(ls.FourBar(*light, ground=d), omega2=30.0, loads=[ls.Load("rocker", force=(600.0, -800.0))])
    bearings = ls.bearings(scene, {"D": ls.Bearing(capacity=8e3)}, theta2=7200).sel(pin="D")
    ends = [np.degrees(np.arccos((c**2 + d**2 - f**2) / (2.0 * c * d))) for f in (b + a, b - a)]
    swings = 8.0**3 * 180.0 / (ends[0] - ends[1])  # million
    assert float(bearings.equivalent_load) == pytest.approx(1000.0, rel=1e-12)
    assert float(bearings.L10h) == pytest.approx(swings * 1e6 * 2.0 * np.pi / 30.0 / 3600.0, rel=1e-6)


def test_the_life_of_a_swinging_pin():
    """Linear damage: each small turn Δψ under F consumes |Δψ|/360 of (C/F)^p million revolutions."""
    bearings = ls.bearings(PRESS, {"C": ls.Bearing(capacity=2e4, kind="roller")}).sel(pin="C")
    cycle = ls.sweep(PRESS, theta2=72_000, of=["F43", "omega3", "omega4"])
    turns = np.abs(cycle.omega4 - cycle.omega3) / PRESS.omega2 / 72_000.0
    damage = float((turns / (1e6 * (2e4 / cycle.F43) ** (10.0 / 3.0))).sum())
    hours = 1.0 / damage * (2.0 * np.pi / PRESS.omega2) / 3600.0
    assert float(bearings.L10h) == pytest.approx(hours, rel=1e-8)


def test_the_spectrum_holds_all_of_the_rotation():
    bearings = ls.bearings(ENGINE, theta2=72_000)  # a sample on a jump counts as one side of it
    spectrum = ls.load_spectrum(bearings, classes=400)
    np.testing.assert_allclose(spectrum.share.sum("load_class"), 1.0, rtol=1e-12)
    assert (spectrum.class_load.max("load_class") < bearings.F.max("theta2")).all()
    again = (spectrum.class_load**3 * spectrum.share).sum("load_class") ** (1.0 / 3.0)
    np.testing.assert_allclose(again, bearings.equivalent_load, rtol=1e-3)


def test_a_pin_that_stands_still_leaves_the_spectra_of_others():
    scene = replace(PRESS, omega2=xr.DataArray([0.0, 20.0], dims="speed"))
    spectra = ls.load_spectrum(ls.bearings(scene, theta2=72), classes=5).share
    alone = ls.load_spectrum(ls.bearings(ls.scene_at(scene, speed=1), theta2=72), classes=5).share
    assert (spectra.sel(speed=0) == 0.0).all()
    np.testing.assert_array_equal(spectra.sel(speed=1), alone)
    np.testing.assert_allclose(alone.sum("load_class"), 1.0, rtol=1e-12)


def test_the_spectrum_of_a_sine_by_its_quarters():
    """F = 1 − cos θ stays below a quarter, a half, three quarters of its largest for 120, 180, 240 degrees."""
    row = loaded(lambda theta2: 1.0 - np.cos(np.radians(theta2)))
    share = ls.load_spectrum(row, classes=4).share
    np.testing.assert_allclose(share.cumsum("load_class")[:3] * 360.0, [120.0, 180.0, 240.0], atol=1.0)


# ------------------------------------------------------------------------------------------------- loads


@pytest.mark.parametrize("scene", [PRESS, ENGINE, SHAPER])
def test_the_magnitude_is_equal_in_every_frame(scene):
    bearings = ls.bearings(scene, theta2=36)
    np.testing.assert_allclose(np.hypot(bearings.Fx, bearings.Fy), xr.ones_like(bearings.Fx) * bearings.F, rtol=1e-12)


def test_frames_are_those_of_the_links():
    """Components are the force turned back by the angle of the link: pin C between coupler 3 and rocker 4."""
    bearings = ls.bearings(PRESS, theta2=36).sel(pin="C")
    cycle = ls.sweep(PRESS, theta2=36)
    force = cycle.F43x + 1j * cycle.F43y
    for frame, angle in {"ground": 0.0, "journal": cycle.theta3, "bearing": cycle.theta4}.items():
        turned = force * np.exp(-1j * np.radians(angle))
        seen = bearings.sel(frame=frame)
        np.testing.assert_allclose(seen.Fx + 1j * seen.Fy, turned, rtol=1e-12)


@pytest.mark.parametrize("frame", ["journal", "bearing"])
def test_the_gudgeon_pin_belongs_to_the_piston(frame):
    """Pin C of an engine: its journal stands with the piston, along the guide; the small end turns with the rod."""
    import matplotlib as mpl

    mpl.use("Agg")
    scene = replace(ENGINE, mechanism=replace(ENGINE.mechanism, slide_angle=30.0))
    bearings = ls.bearings(scene, theta2=36).sel(pin="C", frame=frame)
    cycle = ls.sweep(scene, theta2=36)
    angle = {"journal": 30.0, "bearing": cycle.theta3}[frame]
    turned = (cycle.F43x + 1j * cycle.F43y) * np.exp(-1j * np.radians(angle))
    np.testing.assert_allclose(bearings.Fx + 1j * bearings.Fy, turned, rtol=1e-12)
    axes = ls.sweep(scene, theta2=36).linksweep.bearing("F43", frame=frame)
    assert ("guide" if frame == "journal" else "rod") in axes.get_xlabel()
    mpl.pyplot.close(axes.figure)


def test_the_inertia_force_of_a_crank_is_constant_in_its_own_axes():
    """A crank with its weight off A and nothing else: the main bearing's load turns with it."""
    heavy = ls.Link(length=0.1, mass=2.0, inertia=0.01, cg_distance=0.05, cg_angle=30.0)
    scene = ls.Scene(ls.FourBar(heavy, ls.Link(0.3, 0.0, 0.0), ls.Link(0.25, 0.0, 0.0), ground=0.2), omega2=40.0)
    journal = ls.bearings(scene, theta2=72).sel(pin="A", frame="journal")
    expected = -2.0 * 0.05 * 40.0**2 * np.exp(1j * np.radians(30.0))
    np.testing.assert_allclose(journal.Fx + 1j * journal.Fy, np.full(72, expected), rtol=1e-12)


def test_rotation_and_components_are_quantities_like_others():
    """Peaks also accept their names, for all designs."""
    speeds = replace(PRESS, omega2=xr.DataArray([10.0, 20.0], dims="speed"))
    peaks = ls.peaks(speeds, of=["omega_C", "F43x_link4"])
    cycle = ls.bearings(speeds, theta2=3600).sel(pin="C")
    np.testing.assert_allclose(peaks.omega_C_peak, abs(cycle.rotation_speed).max("theta2"), rtol=1e-5)
    np.testing.assert_allclose(peaks.F43x_link4_max, cycle.Fx.sel(frame="bearing").max("theta2"), rtol=1e-5)


def test_pressure_and_friction():
    bearings = ls.bearings(PRESS, {"B": ls.Bearing(diameter=0.02, length=0.03, friction=0.1)}, theta2=36)
    b = bearings.sel(pin="B")
    cycle = ls.sweep(PRESS, theta2=36, of=["F32", "omega2", "omega3"])
    speed = cycle.omega2 - cycle.omega3
    np.testing.assert_allclose(b.rotation_speed, speed, rtol=1e-12)
    np.testing.assert_allclose(b.pressure, cycle.F32 / 6e-4, rtol=1e-12)
    np.testing.assert_allclose(b.pv, cycle.F32 / 6e-4 * np.abs(speed) * 0.01, rtol=1e-12)
    np.testing.assert_allclose(b.friction_loss, np.sin(np.arctan(0.1)) * 0.01 * cycle.F32 * np.abs(speed), rtol=1e-12)
    assert np.isnan(bearings.pressure.sel(pin="A")).all()
    assert np.isnan(bearings.L10).all()


def a_pulse_between_samples() -> xr.DataArray:
    """Return a load that is 3000 N at 200.25 degrees, and 0 at every half degree."""
    angles = np.union1d(np.arange(0.0, 361.0, 20.0), [200.2, 200.25, 200.3])
    return xr.DataArray(np.where(angles == 200.25, 3000.0, 0.0), {"theta2": angles}, "theta2")


def test_the_largest_pressure_is_that_of_the_largest_load():
    """3000 N on 20 mm x 30 mm is 5 MPa, whatever the samples have."""
    pulse = ls.Load("crank", force=(a_pulse_between_samples(), 0.0), interpolation="linear")
    bush = ls.Bearing(diameter=0.02, length=0.03)
    bearings = ls.bearings(ls.Scene(TURNING, omega2=30.0, loads=[pulse]), {"A": bush})
    at_a = bearings.sel(pin="A")
    assert float(at_a.pressure.max()) < 1.0
    assert float(at_a.pressure_peak) == pytest.approx(5e6, rel=1e-10)
    (head, row) = (re.split(r" {2,}", line.strip()) for line in str(bearings.linksweep).splitlines()[:2])
    assert row[head.index("pressure [MPa]")] == "5.000" and head[-1] == "PV of samples [MPa m/s]"
    engine = ls.MultiCylinder(ENGINE, crank_angles=[0.0], main_positions=[-0.05, 0.05])
    mains = ls.bearings(engine, {"main1": bush}, theta2=36).sel(main="main1")
    assert float(mains.pressure_peak) == pytest.approx(float(mains.F_peak) / 6e-4, rel=1e-14)


def column(ds: xr.Dataset, title: str) -> list[str]:
    """Return a column of a table without empty cells."""
    head, *rows = (re.split(r" {2,}", line.strip()) for line in str(ds.linksweep).splitlines())
    return [row[head.index(title)] for row in rows]


def test_the_mean_load_is_exact():
    """A triangle 0.1 degrees wide and 3000 N high, between two samples: 0 of these, 3000·0.05/360 N."""
    pulse = ls.Load("crank", force=(a_pulse_between_samples(), 0.0), interpolation="linear")
    bearings = ls.bearings(ls.Scene(TURNING, omega2=30.0, loads=[pulse]))
    assert float(bearings.F_mean.sel(pin="A")) == pytest.approx(3000.0 * 0.05 / 360.0, rel=1e-9)
    assert column(bearings, "mean [N]")[0] == "0.4167"


def test_the_mean_of_a_load_that_grows_without_bound_is_its_integral():
    """A coupler without mass bears M/(c·sin μ), μ between it and the rocker: one over the square root of the distance
    from the toggle, which has an integral. Its inertia bears the inverse square, which has none."""
    a, b, c, d, moment = 0.1, 0.12, 0.12, 0.2, 8.0
    end = np.arccos((a**2 + d**2 - (b + c) ** 2) / (2.0 * a * d))

    def force(theta2):
        cosine = (b**2 + c**2 - a**2 - d**2 + 2.0 * a * d * np.cos(theta2)) / (2.0 * b * c)
        return moment / (c * np.sqrt((1.0 - cosine) * (1.0 + cosine)))

    mean = quad(lambda u: force(end * (1.0 - u * u)) * 2.0 * u, 0.0, 1.0)[0]
    stuck = ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in (a, b, c)), ground=d)
    scene = ls.Scene(stuck, omega2=5.0, loads=[ls.Load("rocker", torque=-moment)])
    bearings = ls.bearings(scene)
    assert float(bearings.F_mean.sel(pin="C")) == pytest.approx(mean, rel=1e-6)
    assert column(bearings, "mean [N]")[2] == f"{mean:.4g}"
    heavy = ls.FourBar(LIGHT, *[ls.Bar(length, 0.02, 0.02, 7750.0) for length in (b, c)], ground=d)
    assert column(ls.bearings(ls.Scene(heavy, omega2=5.0)), "mean [N]") == ["inf"] * 4


def test_two_angles_are_the_ends_of_a_part_of_a_turn():
    """Loads, pressure and the table are those of the way between the ends, not of the two positions there."""
    bush = {"C": ls.Bearing(diameter=0.01, length=0.02)}
    bearings, way = ls.bearings(PRESS, bush, theta2=(-60, 160)), np.linspace(-60.0, 160.0, 22_001)
    force = ls.sweep(PRESS, way, of="F43").F43
    at_c = bearings.sel(pin="C")
    assert float(at_c.F_peak) == pytest.approx(float(force.max()), rel=1e-7)
    assert float(at_c.F_peak_at) == pytest.approx(float(force.idxmax()), abs=0.01)
    assert float(at_c.pressure.max()) == pytest.approx(float(force.max()) / 2e-4, rel=1e-4)
    assert float(at_c.F.mean()) == pytest.approx(float(force.mean()), rel=1e-3)
    (row,) = (line.split() for line in str(bearings.linksweep).splitlines() if line.startswith("C"))
    assert float(row[1]) == pytest.approx(float(force.max()), rel=1e-3)


def test_designs_are_batched():
    speeds = xr.DataArray([10.0, 20.0, 40.0], dims="speed")
    sizes = {"B": ls.Bearing(capacity=xr.DataArray([1e3, 2e3], dims="size"))}
    massless = ls.Scene(TURNING, omega2=speeds, loads=[ls.Load("rocker", torque=5.0)])
    bearings = ls.bearings(massless, sizes, theta2=36)
    assert bearings.L10.sel(pin="B").transpose("size", ...).shape[0] == 2
    hours = bearings.L10h.sel(pin="B").squeeze()
    np.testing.assert_allclose(hours.sel(speed=0) / hours.sel(speed=2), 4.0, rtol=1e-12)
    np.testing.assert_allclose(hours.isel(size=1) / hours.isel(size=0), 8.0, rtol=1e-12)


def test_angles_without_a_result_are_left_out():
    stuck = ls.FourBar(LIGHT, ls.Link(0.12, 0.0, 0.0), ls.Link(0.12, 0.0, 0.0), ground=0.2)
    bearings = ls.bearings(ls.Scene(stuck, omega2=1.0, loads=[ls.Load("crank", force=(7.0, 0.0))])).sel(pin="A")
    assert (bearings.status != 0).any()
    assert 0.0 < float(bearings.rotation) < 360.0
    assert float(bearings.equivalent_load) == pytest.approx(7.0, rel=1e-12)


@pytest.mark.parametrize("frame", ["ground", "journal", "bearing"])
def test_load_diagrams_show_the_forces_of_bearings(frame):
    figure = ls.sweep(PRESS, theta2=90).linksweep.bearings(frame=frame)
    bearings = ls.bearings(PRESS, theta2=90).sel(frame=frame)
    for ax, (pin, force) in zip(figure.axes, zip("ABCD", ("F12", "F32", "F43", "F14"), strict=True), strict=True):
        (locus,) = (line for line in ax.get_lines() if line.get_label() == f"_locus {force}")
        drawn, at = np.array(locus.get_xydata()), bearings.sel(pin=pin)
        samples = np.stack([at.Fx, at.Fy], axis=-1)  # the locus also has the positions of the exact peaks
        off = np.abs(drawn[:, np.newaxis] - samples).max(axis=-1)
        assert off.min(axis=0).max() < 1e-9 * np.abs(samples).max()
        assert np.all(np.diff(off.argmin(axis=0)) > 0)
        assert pin in ax.get_title(loc="left")
    plt.close(figure)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ls.bearings(LOOP), "which has no pins"),
        (lambda: ls.bearings(PRESS, {"E": ls.Bearing()}), "pins: nothing is named 'E'"),
        (lambda: ls.bearings(PRESS, {"A": 3.0}), "pins.A = 3.0: must be a Bearing"),
        (lambda: ls.bearings(PRESS, 3.0), "pins = 3.0: must be as"),
        (lambda: ls.bearings(PRESS, theta2=(340, 20)), "from 340 on to 20 is (340, 380)"),
        (lambda: ls.Bearing(diameter=-0.02), "diameter = -0.02 m: must be greater than 0"),
        (lambda: ls.Bearing(kind="needle"), "kind = 'needle': must be one of ball, roller"),
        (lambda: ls.load_spectrum(ls.sweep(PRESS, theta2=4)), "ds has no F, rotation_share, life_status: give what"),
        (lambda: ls.load_spectrum(ls.bearings(PRESS).isel(theta2=slice(0, 100))), "ds has a part of its angles"),
        (lambda: ls.load_spectrum(ls.bearings(PRESS).isel(theta2=5)), "ds has a part of its angles: give all that"),
    ],
)
def test_refusals(call, message):
    (line,) = refusal(call)
    assert message in line
