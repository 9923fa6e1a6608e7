"""Wheels that gears turn p/q as fast as the crank: cycles of q turns, beside closed forms and dense samples."""

from dataclasses import replace
from fractions import Fraction

import mpmath
import numpy as np
import pytest

import linksweep as ls
from benchmarks.stress import six_bars
from benchmarks.stress.linkages.__main__ import checked, missed
from linksweep.scene.grid import cos_sin_of_multiple

BAR = {"width": 0.02, "thickness": 0.01, "density": 7800}
WHEEL = ls.Link(0.05, 0.3, 4e-4, 0.02, 30.0)
LOADS = (ls.Load("right", torque=-2.0), ls.Load("wheel", torque=-3.0))


def five_bar(ratio="3/2", phase=20.0, left=0.18, right=0.17, loads=LOADS):
    """Return a geared five-bar that turns fully, its wheel at D, with torques on the wheel and on the right link."""
    machine = ls.Linkage(
        f"crank A-B, wheel D-E : {ratio} crank, left B-C, right E-C",
        ground={"A": (0.0, 0.0), "D": (0.2, 0.02)},
        gears={"wheel": ls.Gears(phase=phase)},
        crank=ls.Bar(0.05, **BAR),
        wheel=WHEEL,
        left=ls.Bar(left, **BAR),
        right=ls.Bar(right, **BAR),
    )
    return ls.Scene(machine, 20.0, gravity=(0.0, -9.81), loads=loads)


def two_slides(ratio, phase=0.0, mass=2.0, gravity=0.0):
    """Return a slider that the crank moves along x, and one that the wheel moves along y: closed forms."""
    machine = ls.Linkage(
        f"crank A-B, wheel D-E : {ratio} crank, cross on level past B, tower on upright past E",
        ground={"A": (0.0, 0.0), "D": (0.3, 0.0)},
        guides={"level": ls.Guide(), "upright": ls.Guide(through=(0.3, 0.0), angle=90.0)},
        gears={"wheel": ls.Gears(phase=phase)},
        crank=ls.Link(0.05, 0.0, 0.0),
        wheel=ls.Link(0.04, 0.0, 0.0),
        cross=ls.Slider(0.0),
        tower=ls.Slider(mass),
    )
    return ls.Scene(machine, omega2=10.0, gravity=(0.0, -gravity))


# ---- ratios in, ratios refused


@pytest.mark.parametrize("ratio", ["-3/2", "-6/4", -1.5, Fraction(-3, 2)])
def test_forms_of_a_ratio_are_one(ratio):
    text = "crank A-B, wheel D-E : crank"
    parts = {"crank": ls.Link(0.05, 0.0, 0.0), "wheel": WHEEL}
    made = ls.Linkage(text, ground={"A": (0, 0), "D": (0.2, 0)}, gears={"wheel": ls.Gears(ratio)}, **parts)
    in_text = ls.Linkage("crank A-B, wheel D-E : -3/2 crank", ground={"A": (0, 0), "D": (0.2, 0)}, **parts)
    a, b = (
        ls.sweep(ls.Scene(machine, omega2=3.0), 10, of=["Ex", "Ey", "omega3", "T12"]) for machine in (made, in_text)
    )
    assert a.theta2.values[-1] == 648.0
    assert a.drop_attrs().equals(b.drop_attrs()) and a.omega3 == -4.5


def test_a_scene_file_has_the_ratio(tmp_path):
    scene = five_bar("2/3")
    ls.save(scene, tmp_path / "five.toml")
    text = (tmp_path / "five.toml").read_text()
    assert "wheel D-E : 2/3 crank" in text
    again = ls.load_scene(tmp_path / "five.toml")
    assert again == scene and again.period == 1080.0
    other = text.replace("2/3 crank", "crank").replace("phase = 20.0", 'phase = 20.0, ratio = "2/3"')
    (tmp_path / "five.toml").write_text(other)
    assert ls.load_scene(tmp_path / "five.toml").period == 1080.0
    ls.save(ls.peaks(scene, of=["T12"]), tmp_path / "peaks.nc")
    assert ls.load_scene(tmp_path / "peaks.nc") == scene


@pytest.mark.parametrize(
    ("ratio", "words"),
    [
        (0.333, r'gears.wheel.ratio = "0.333": must be a whole number or a fraction such as -3/2, and not 0'),
        ("0/3", r'gears.wheel.ratio = "0/3": must be a whole number or a fraction'),
        (
            "1/101",
            r"gears.wheel.ratio = 1/101: must be a whole number, or a fraction of whole numbers up to 99, as 1/99",
        ),
        ("-199/2", r"gears.wheel.ratio = -199/2: must be a whole number, or a fraction of whole numbers up to 99"),
    ],
)
def test_other_ratios_are_refused(ratio, words):
    with pytest.raises(ValueError, match=words):
        ls.Linkage(
            "crank A-B, wheel D-E : crank",
            ground={"A": (0, 0), "D": (0.2, 0)},
            gears={"wheel": ls.Gears(ratio)},
            crank=ls.Link(0.05, 0.0, 0.0),
            wheel=WHEEL,
        )


def test_the_cycle_is_that_of_all_wheels_and_loads():
    text = "crank A-B, one D-E : 1/{} crank, two F-G : 5/{} crank"
    ground = {"A": (0, 0), "D": (0.2, 0), "F": (0.4, 0)}
    parts = {"crank": ls.Link(0.05, 0.0, 0.0), "one": WHEEL, "two": WHEEL}
    machine = ls.Linkage(text.format(4, 6), ground=ground, **parts)
    assert ls.Scene(machine, omega2=1.0).period == 12 * 360.0
    fifth = ls.Load("one", torque=lambda theta2: np.cos(np.radians(theta2 / 5)))
    assert ls.Scene(machine, omega2=1.0, loads=[fifth]).period == 60 * 360.0
    with pytest.raises(ValueError, match="gears: all repeats only after 132 turns of the crank: take ratios"):
        ls.Linkage(text.format(11, 12), ground=ground, **parts)


# ---- the wheel's place


@pytest.mark.parametrize("ratio", [Fraction(3, 2), Fraction(-2, 3), Fraction(97, 99), Fraction(-99, 2)])
def test_cosines_of_multiples_beside_fifty_digits(ratio):
    angles = np.concatenate([np.random.default_rng(1).uniform(-2000.0, 2000.0, 100), np.arange(0.0, 1080.0, 30.0)])
    rows = cos_sin_of_multiple(angles, ratio)
    with mpmath.workdps(50):
        for cos, sin, cos_lo, sin_lo, angle in zip(*map(np.ndarray.tolist, (*rows, angles)), strict=True):
            turned = mpmath.mpf(angle) * ratio.numerator / ratio.denominator * mpmath.pi / 180
            assert abs(mpmath.mpf(cos) + mpmath.mpf(cos_lo) - mpmath.cos(turned)) < 2e-27
            assert abs(mpmath.mpf(sin) + mpmath.mpf(sin_lo) - mpmath.sin(turned)) < 2e-27


def test_the_wheel_is_exact_at_its_quarter_turns():
    cycle = ls.sweep(five_bar("3/2", phase=90.0), [0.0, 60.0, 120.0, 660.0, -60.0], of=["Ex", "Ey", "theta3"])
    assert cycle.Ex.values.tolist() == [0.2, 0.2 - 0.05, 0.2, 0.2 + 0.05, 0.2 + 0.05]
    assert cycle.Ey.values.tolist() == [0.02 + 0.05, 0.02, 0.02 - 0.05, 0.02, 0.02]
    assert cycle.theta3.values.tolist() == [90.0, 180.0, -90.0, 0.0, 0.0]


@pytest.mark.parametrize("name", ["1/2", "3/2", "-2/3", "5/4"])
def test_beside_the_reference(name):
    assert missed(f"geared five-bar, {name}", checked(f"geared five-bar, {name}", 10, 7)) == []


# ---- closed forms


@pytest.mark.parametrize(("ratio", "turns"), [("3/2", 2), ("-2/3", 3), ("1/4", 4)])
def test_two_slides_draw_a_lissajous_figure(ratio, turns):
    """x = a cos θ, y = e sin(i θ + φ), and the figure closes after q turns."""
    i, scene = float(Fraction(ratio)), two_slides(ratio, phase=25.0)
    cycle = ls.sweep(scene, 120 * turns, of=["x_cross", "x_tower", "v_tower", "a_tower", "T12", "power_residual"])
    assert cycle.theta2.values[-1] == 360.0 * turns - 3.0
    wheel = np.radians((i * cycle.theta2 + 25.0) % 360.0)
    np.testing.assert_allclose(cycle.x_cross, 0.05 * np.cos(np.radians(cycle.theta2 % 360.0)), rtol=0, atol=4e-17)
    np.testing.assert_allclose(cycle.x_tower, 0.04 * np.sin(wheel), rtol=0, atol=4e-17)
    np.testing.assert_allclose(cycle.v_tower, 0.04 * i * 10.0 * np.cos(wheel), rtol=0, atol=1e-15)
    np.testing.assert_allclose(cycle.a_tower, -0.04 * (i * 10.0) ** 2 * np.sin(wheel), rtol=0, atol=2e-14)
    np.testing.assert_allclose(cycle.T12, -(0.04**2) * (i * 10.0) ** 2 * i * np.sin(2.0 * wheel), rtol=0, atol=4e-16)
    assert abs(cycle.power_residual).max() < 1e-15


def test_peaks_and_means_of_a_closed_form():
    """T12 = −m e² i³ ω² sin(2φ)/2 + m g e i cos φ with φ = iθ: its extremes by a quadratic in sin φ."""
    scene, i, g = two_slides("3/2", gravity=9.81), 1.5, 9.81
    A, B = 2.0 * 0.04**2 * i**3 * 100.0, 2.0 * g * 0.04 * i
    peaks = ls.peaks(scene, of=["T12", "T12_mean", "T12_rms", "v_tower"])
    sines = np.roots([2.0 * A, -B, -A])  # dT/dφ = 0: −A cos 2φ − B sin φ = 0
    phi = np.concatenate([np.arcsin(sines[abs(sines) <= 1.0]), np.pi - np.arcsin(sines[abs(sines) <= 1.0])])
    torque = -0.5 * A * np.sin(2.0 * phi) + B * np.cos(phi)
    np.testing.assert_allclose(peaks.T12_max, torque.max(), rtol=1e-13)
    np.testing.assert_allclose(peaks.T12_min, torque.min(), rtol=1e-13)
    at = np.radians(i * peaks.T12_max_at.item())
    assert abs(np.exp(1j * (at - phi[torque.argmax()])) - 1.0) < 1e-6
    assert abs(peaks.T12_mean) < 1e-14
    np.testing.assert_allclose(peaks.T12_rms, np.hypot(0.5 * A, B) / np.sqrt(2.0), rtol=1e-13)


def test_a_load_on_the_crank_moves_the_peak_to_another_turn():
    """With gravity on the crank along x, and on the slider, the torque repeats after two turns."""
    scene = two_slides("3/2", phase=10.0)
    crank = ls.Link(0.05, 1.0, 0.0, 0.05)
    with_crank = ls.Scene(
        ls.Linkage(
            scene.mechanism.links,
            ground=scene.mechanism.ground,
            guides=scene.mechanism.guides,
            gears=scene.mechanism.gears,
            **{**scene.mechanism.parts, "crank": crank},
        ),
        omega2=10.0,
        gravity=(-9.81, -1.0),
    )
    theta2 = np.arange(0.0, 720.0, 1e-3)
    wheel = np.radians(1.5 * theta2 + 10.0)
    torque = -0.5 * 2.0 * 0.04**2 * 1.5**3 * 100.0 * np.sin(2.0 * wheel)
    torque += 2.0 * 0.04 * 1.5 * np.cos(wheel)
    torque += 0.05 * (np.cos(np.radians(theta2)) - 9.81 * np.sin(np.radians(theta2)))
    peaks = ls.peaks(with_crank, of=["T12"])
    for kind, dense in (("max", torque.max()), ("min", torque.min())):
        assert abs(peaks[f"T12_{kind}"].item() - dense) < 1e-9 * abs(dense)
    assert abs(peaks.T12_max_at.item() - theta2[torque.argmax()]) < 2e-3
    turns = {int(theta2[torque.argmax()] // 360), int(theta2[torque.argmin()] // 360)}
    assert 1 in turns  # one of the two lies beyond the first turn


def test_equal_rods_close_by_a_mirror():
    """With rods of one length C lies on the bisector of B and E."""
    cycle = ls.sweep(five_bar("3/2", right=0.18), 96, of=["Bx", "By", "Ex", "Ey", "Cx", "Cy"])
    theta2 = np.radians(cycle.theta2.values)
    B, E = 0.05 * np.exp(1j * theta2), 0.2 + 0.02j + 0.05 * np.exp(1j * (1.5 * theta2 + np.radians(20.0)))
    half = 0.5 * (E - B)
    C = B + half + 1j * half / abs(half) * np.sqrt(0.18**2 - abs(half) ** 2)
    np.testing.assert_allclose(cycle.Cx + 1j * cycle.Cy, C, rtol=0, atol=4e-16)


# ---- peaks, arcs, means over all turns


def test_no_peak_is_missed_and_no_arc_is_wrong():
    for seed in range(3):
        result = six_bars.check("geared by a fraction", 20, [seed, 3])
        assert (result.missed, result.wrong_arcs) == (0, 0)


def test_arcs_lie_in_any_turn():
    """The rods close in part of each turn, another one in the second than in the first."""
    scene = five_bar("1/2", right=0.1, left=0.1, loads=())
    checks = ls.check(scene)
    theta2 = np.arange(0.05, 720.0, 0.1)
    closes = ls.sweep(scene, theta2, of=["status"]).status.values == 0
    assert set(closes[theta2 < 360.0]) | set(closes[theta2 > 360.0]) == {True, False}
    starts = theta2[1:][closes[1:] & ~closes[:-1]]
    np.testing.assert_allclose(np.sort(checks.arc_start.values), starts, atol=0.1)
    assert (closes[theta2 < 360.0] != closes[theta2 > 360.0]).any()
    assert "may pass 720" in checks.arc_end.long_name
    peaks = ls.peaks(scene, of=["theta4"])
    cycle = ls.sweep(scene, theta2, of=["theta4"]).theta4
    assert peaks.theta4_max >= cycle.max() - 1e-9 and peaks.theta4_min <= cycle.min() + 1e-9


def test_narrow_loads_anywhere_on_a_long_arc():
    """A push over a hundredth of a degree on an arc of 581 degrees, near its start, middle and end."""
    for start in (300.0, 500.0, 850.0):
        pulse = ls.Load(
            "crank",
            torque=lambda theta2, a=start: np.where(abs(theta2 % 1440.0 - a) < 0.005, 500.0, 0.0),
            breaks=[start - 0.005, start + 0.005],
        )
        scene = replace(five_bar("1/4", left=0.11, right=0.11, loads=[pulse]), omega2=0.0, gravity=(0.0, 0.0))
        peaks = ls.peaks(scene, of=["T12"])
        assert peaks.T12_min.item() == -500.0
        assert abs(peaks.T12_min_at.item() - start) < 0.006


def test_means_are_over_all_turns():
    scene = five_bar("-2/3")
    peaks = ls.peaks(scene, of=["T12_mean", "T12_rms", "power_mean"])
    cycle = ls.sweep(scene, 3 * 720, of=["T12", "power"])
    np.testing.assert_allclose(peaks.T12_mean, cycle.T12.mean(), rtol=1e-11)
    np.testing.assert_allclose(peaks.T12_rms, np.sqrt((cycle.T12**2).mean()), rtol=1e-12)
    np.testing.assert_allclose(peaks.power_mean, cycle.power.mean(), rtol=1e-11)
    duty = ls.duty(scene)
    np.testing.assert_allclose(duty.work, cycle.T12.mean() * 6.0 * np.pi, rtol=1e-11)


# ---- analyses


def test_travel_is_that_of_all_turns():
    motion = ls.geometry(two_slides("3/2", phase=25.0), of=["x_tower", "x_cross"])
    np.testing.assert_allclose(motion.x_tower_travel, 0.08, rtol=1e-14)
    np.testing.assert_allclose((1.5 * motion.x_tower_max_at + 25.0) % 360.0, 90.0, atol=1e-5)
    arm = ls.geometry(five_bar("1/2"), of=["theta4"])
    cycle = ls.sweep(five_bar("1/2"), 72_000, of=["theta4"]).theta4
    np.testing.assert_allclose(arm.theta4_travel, cycle.max() - cycle.min(), rtol=1e-7)
    top, bottom = cycle.theta2[int(cycle.argmax("theta2"))], cycle.theta2[int(cycle.argmin("theta2"))]
    assert abs(arm.theta4_max_at - top) < 0.01 and abs(arm.theta4_min_at - bottom) < 0.01
    way = float((top - bottom) % 720.0)
    np.testing.assert_allclose(arm.theta4_time_ratio, max(way, 720.0 - way) / min(way, 720.0 - way), rtol=1e-3)


def test_a_coupler_curve_closes_after_all_turns():
    scene = five_bar("2/3")
    curve = ls.coupler_curve(scene, at=(0.1, 10.0), link="left", theta2=[0.0, 360.0, 720.0, 1080.0])
    assert curve.Px[3] == curve.Px[0] and curve.Py[3] == curve.Py[0]
    assert len(set(curve.Px.values.tolist())) == 3
    whole = ls.coupler_curve(scene, at=(0.1, 10.0), link="left", theta2=1080)
    assert whole.theta2.values[-1] == 1079.0


def test_orders_are_fractions():
    orders = ls.orders(ls.sweep(two_slides("3/2", phase=25.0), 144, of=["x_tower"]), "x_tower", n=3)
    np.testing.assert_allclose(orders.order, np.arange(7) / 2)
    np.testing.assert_allclose(orders.x_tower_amplitude, [0.0, 0.0, 0.0, 0.04, 0.0, 0.0, 0.0], atol=1e-16)


def test_orders_of_a_part_of_the_cycle_are_refused():
    scene = two_slides("3/2", phase=25.0)
    with pytest.raises(ValueError, match=r"covers 360 degrees, but motion and loads repeat after 720: .* theta2=1440"):
        ls.orders(ls.sweep(scene, np.arange(72) * 5.0, of=["x_tower"]), "x_tower", n=3)
    twice = ls.orders(ls.sweep(scene, np.arange(288) * 5.0, of=["x_tower"]), "x_tower", n=1)
    np.testing.assert_allclose(twice.order, np.arange(5) / 4)


def test_a_flywheel_evens_out_all_turns():
    scene = five_bar("3/2")
    wheel = ls.flywheel(scene, fluctuation=0.02, theta2=2880)
    assert wheel.theta2.values[-1] == 720.0 - 0.25
    torque = ls.sweep(scene, 2880, of=["reduced_torque"]).reduced_torque
    np.testing.assert_allclose(wheel.drive_torque, torque.mean(), rtol=1e-9)
    work = np.cumsum(torque - torque.mean()) * np.radians(0.25)
    np.testing.assert_allclose(wheel.energy_fluctuation, work.max() - work.min(), rtol=1e-2)


def test_film_picture_and_report_show_all_turns(tmp_path, monkeypatch):
    scene = five_bar("3/2")
    assert len(ls.plot.animate(scene, frames=6)) == 6
    ax = ls.plot.mechanism(scene, 500.0)
    curve = max((line.get_xydata() for line in ax.lines), key=len)
    assert len(curve) == 2 * 720 + 1
    monkeypatch.setattr("linksweep.reports.page.version", lambda name: "0")
    ls.report(scene, tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert "2 turns of the crank" in page
