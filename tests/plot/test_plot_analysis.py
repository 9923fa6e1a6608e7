"""Plots of analyses in awkward cases: unbounded peaks, limits off the axis, zero forces."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from drawn import closed_figures, line, texts  # noqa: F401

import linksweep as ls
from linksweep.plot.kit import signals
from linksweep.plot.kit.with_peaks import with_peaks

PRESS = ls.example("press")
LINKS = [ls.Link(length, 1.0, 0.01, cg_distance=length / 2.0) for length in (0.08, 0.12, 0.11)]
SWING = ls.Scene(ls.FourBar(*LINKS, ground=0.22), 20.0, gravity=(0.0, -9.81))  # turns between two toggles


def test_the_torque_with_a_flywheel_is_the_mean_torque():
    figure = ls.plot.torque_with_flywheel(ls.flywheel(ls.example("engine"), fluctuation=0.02))
    above, below = figure.axes
    angles, torque = line(above, "without flywheel").get_data()
    cycle = ls.sweep(ls.example("engine"), solver="dense")
    np.testing.assert_allclose(torque[:-1], cycle.T12, rtol=1e-9, atol=1e-9 * np.ptp(torque))
    constant = next(drawn for drawn in above.lines if drawn.get_label().startswith("with it, constant: −"))
    mean = np.trapezoid(torque, angles) / 720.0
    np.testing.assert_allclose(constant.get_ydata(), mean, rtol=2e-4)  # samples beside jumps miss the rest
    np.testing.assert_allclose(constant.get_ydata(), ls.duty(ls.example("engine")).effort_mean, rtol=1e-10)
    assert f"{abs(constant.get_ydata()[0]):.4g} N m" in constant.get_label()
    gains, loses = (area.get_paths()[0].vertices[:, 1] for area in above.collections)
    assert gains.max() <= mean + 1.0 < mean + 100.0 < loses.max()  # the machine asks for less, and for more
    assert "max 317.30 rad/s" in texts(below)  # 314.16 · (1 + 0.02/2)


def test_a_flywheel_that_does_not_turn_fully_is_refused():
    wheel = ls.flywheel(SWING, fluctuation=0.02)
    with pytest.raises(ValueError, match="ds has no speed at some angle: it stalls, or does not turn fully"):
        ls.plot.flywheel(wheel)


def test_a_cycle_on_its_motor_has_its_exact_extremes():
    """An engine that runs through half the no-load speed of its motor, at which this gives the most power."""
    engine = ls.example("engine")
    brake = ls.TorsionDamper("ground", "crank", 0.3)
    engine = replace(engine, omega2=-30.0, loads=[*engine.loads, brake], units="in, lbf, rpm")
    cycle = ls.steady_cycle(engine, ls.DCMotor(60.0, 160.0), ratio=5.0, flywheel=0.05, theta2=360)
    fine = ls.steady_cycle(engine, ls.DCMotor(60.0, 160.0), ratio=5.0, flywheel=0.05, theta2=2880)
    rpm, pound_inch, hp = 30.0 / np.pi, 1.0 / (4.4482216152605 * 0.0254), 1.0 / 745.6998715822702
    curves = abs(fine.omega2) * rpm, fine.motor_torque * pound_inch, fine.motor_power * hp
    speed, torque, power = ls.plot.steady_cycle(cycle).axes
    for ax, of in zip((speed, torque, power), curves, strict=True):
        for end, k in (("max", int(np.argmax(of.values))), ("min", int(np.argmin(of.values)))):
            (at,), (value,) = line(ax, f"_{end}").get_data()
            assert at == pytest.approx(float(of.theta2[k]), abs=0.3)
            assert value == pytest.approx(float(of[k]), rel=1e-5)
            assert f"{end} {value:#.5g}".replace("-", "−") in " ".join(texts(ax))
    assert power.get_ylabel() == "motor power [hp]"
    assert line(power, "_max").get_ydata()[0] == pytest.approx(60.0 * 160.0 / 4.0 * hp, rel=1e-12)
    time = (1.0 / abs(fine.omega2)).mean()
    mean = next(drawn for drawn in speed.lines if drawn.get_label().startswith("mean 295.2"))
    assert mean.get_ydata()[0] == pytest.approx(float(rpm / time), rel=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda ds: ds.drop_vars("speed_max"), "ds has no cycle on a motor: take what ls.steady_cycle returns"),
        (lambda ds: ds.assign(status=ds.status.copy(data=2)), "ds has no speed: on its motor the machine stalls"),
        (lambda ds: ds.expand_dims(design=2), "there are several designs, over design"),
        (lambda ds: ds.expand_dims({"coupler.length": 2}), r"such as ds.isel\({'coupler.length': 0}\)"),
        (lambda ds: ds.isel(theta2=slice(5, 9)), "ds has a part of the cycle: take all angles of ls.steady_cycle"),
    ],
)
def test_refused_cycles_on_a_motor(change, message):
    with pytest.raises(ValueError, match=message):
        ls.plot.steady_cycle(change(ls.steady_cycle(PRESS, ls.DCMotor(10.0, 160.0), ratio=5.0, theta2=24)))


def test_a_cycle_of_constant_speed_has_no_extremes():
    """A disk whose damper takes all that the motor gives: 6 (1 − ω/160) = 0.3 ω."""
    weightless = [ls.Link(length, 0.0, 0.0, 0.0) for length in (0.08, 0.22, 0.18)]
    disk = ls.FourBar(replace(weightless[0], inertia=0.5), *weightless[1:], ground=0.2)
    scene = ls.Scene(disk, 1.0, loads=[ls.TorsionDamper("ground", "crank", 0.3)])
    speed, torque, _ = ls.plot.steady_cycle(ls.steady_cycle(scene, ls.DCMotor(6.0, 160.0), theta2=24)).axes
    omega = 6.0 / (0.3 + 6.0 / 160.0)
    np.testing.assert_allclose(line(speed, "_speed").get_ydata(), omega, rtol=1e-12)
    assert texts(speed) == texts(torque) == []
    assert speed.get_ylim() == pytest.approx((0.0, 1.2 * omega))


def test_the_torque_of_a_run_backwards_is_seen_on_top_of_its_speed():
    motor = ls.DCMotor(stall_torque=10.0, no_load_speed=160.0, inertia=0.004)
    run = ls.run_up(replace(PRESS, omega2=-30.0), motor, ratio=5.0, until=0.2)
    ax, beside = ls.plot.run_up(run).figure.axes
    assert (ax.lines[0].get_linestyle(), beside.lines[0].get_linestyle()) == ("-", "-.")


@pytest.mark.parametrize(
    ("run", "sentence"),
    [
        (lambda: ls.run_up(PRESS, ls.DCMotor(0.1, 160.0)), "The motor does not start it"),
        (lambda: ls.run_up(SWING, ls.DCMotor(10.0, 160.0), ratio=5.0), "It breaks off: the machine does not turn"),
        (lambda: ls.run_down(PRESS, flywheel=0.3), "It keeps turning: over a cycle"),
    ],
)
def test_a_run_that_comes_to_nothing_says_so(run, sentence):
    ax = run().linksweep.run_up()
    assert sentence in " ".join(text.get_text() for each in ax.figure.axes for text in each.texts).replace("\n", " ")
    assert (ax.get_legend() is not None) == (len(ax.lines[0].get_xdata()) > 1)


@pytest.mark.parametrize("frame", ["ground", "journal"])
def test_three_pins_have_a_fourth_panel(frame):
    cycle = with_peaks(ls.sweep(ls.example("engine"), theta2=90))
    figure = cycle.linksweep.bearings(frame=frame)
    *panels, together = figure.axes
    assert together.get_title(loc="left") == "All to one scale [N]"
    for panel, force in zip(panels, ("F12", "F32", "F43"), strict=True):
        label = next(drawn for drawn in together.lines if f"_{{{force[1:]}}}" in drawn.get_label())
        np.testing.assert_array_equal(label.get_xydata(), line(panel, f"_locus {force}").get_xydata())
        size = np.hypot(*label.get_data())[:-1]
        np.testing.assert_allclose(size, np.hypot(cycle[f"{force}x"], cycle[f"{force}y"]), rtol=1e-12)
    assert len(ls.sweep(PRESS, theta2=90).linksweep.bearings().axes) == 4  # of four pins each has its own


def test_unbounded_contributions_leave_the_others_visible():
    shares = ls.breakdown(SWING, "F32")
    ax = ls.plot.breakdown(shares)
    whole = np.abs(line(ax, "sum").get_ydata())
    assert np.nanmax(whole) > 20.0 * ax.get_ylim()[1]
    assert np.nanmedian(whole) > 0.05 * ax.get_ylim()[1]
    assert ax.get_title(loc="left") == "off scale beside a gap"
    assert [text.get_text() for text in ax.texts] == ["cannot assemble"]
    assert ls.plot.breakdown(ls.breakdown(PRESS, "F32")).get_title(loc="left") == ""


@pytest.mark.parametrize(
    ("below", "message"),
    [(2000.0, "kept up to "), (100.0, "kept at none")],
    ids=["beyond the axis", "not even at rest"],
)
def test_a_limit_off_the_axis_is_stated_in_the_legend(below, message):
    ax = ls.plot.over_speed(PRESS, "F32", speeds=np.linspace(5.0, 30.0, 6), below=below)
    legend = [text.get_text() for text in ax.get_legend().get_texts()]
    assert message in legend[-1] and legend[-1].startswith(f"limit, {below:#.4g}".rstrip("."))
    assert texts(ax) == []
    assert ax.get_xlim() == (5.0, 30.0)
    assert ax.get_ylim()[1] > max(below, line(ax, "peak of $F_{32}$").get_ydata().max())


@pytest.mark.parametrize(("speeds", "marks"), [((-50.0, -30.0, -10.0), [-1.0]), ((-50.0, 0.0, 50.0), [-1.0, 1.0])])
def test_a_limit_is_marked_in_each_direction_of_the_crank(speeds, marks):
    """Weight, loads and inertia forces are the same in both."""
    limit = float(ls.speed_limit(PRESS, "F32", below=500.0).omega2_limit)
    ax = ls.plot.over_speed(PRESS, "F32", speeds=speeds, below=500.0)
    dots = sorted(mark.get_xdata()[0] for mark in ax.lines if mark.get_label() == "_limit")
    np.testing.assert_allclose(dots, limit * np.array(marks))
    assert f"up to ±{limit:.5g} rad/s" in ax.get_legend().get_texts()[-1].get_text()


def test_the_peak_at_one_speed_is_a_dot():
    ax = ls.plot.over_speed(PRESS, "F32", speeds=[30.0])
    assert line(ax, "peak of $F_{32}$").get_marker() == "o"
    assert ax.get_xlim()[0] < 30.0 < ax.get_xlim()[1]


def test_speeds_at_which_a_force_has_no_bound_are_left_out():
    """At rest without weight and loads there is no force; with inertia there is no bound beside the toggles."""
    ax = ls.plot.over_speed(replace(SWING, gravity=(0.0, 0.0)), "F32", speeds=[0.0, 10.0, 20.0])
    assert ax.get_ylim() == (0.0, 1.0)
    assert ax.get_title(loc="left") == "grows without bound at speeds without a curve"


def test_load_diagrams_without_any_result_say_why():
    beyond = np.linspace(150.0, 210.0, 7)  # crank pin 0.29 m and more from D, coupler and rocker 0.23 m long
    cycle, shaking = ls.sweep(SWING, beyond), ls.sweep(SWING, beyond, of=["Fsx", "Fsy"])
    for ax in (cycle.linksweep.bearing("F32"), *cycle.linksweep.bearings().axes[:4], ls.plot.hodograph(shaking)):
        assert [text.get_text() for text in ax.texts] == ["cannot assemble"]


@pytest.mark.parametrize(
    ("name", "symbol"),
    [("Fs", "F_{s}"), ("F32x", "F_{32x}"), ("F1_12", "F_{1,12}"), ("F1_12y", "F_{1,12y}"), ("F_main1", "F_{main1}")],
)
def test_a_force_of_later_links_has_a_comma(name, symbol):
    assert signals.force_symbol(name) == f"${symbol}$"


def test_hodographs_and_orders_of_a_main_bearing_name_its_force():
    cycle = ls.MultiCylinder(ls.example("engine"), [0, 360], positions=[0.0, 0.1]).sweep(
        90, of=["F_main1x", "F_main1y"]
    )
    ax = ls.plot.hodograph(cycle, "F_main1")
    assert ax.get_xlabel() == "force $F_{main1x}$ [N]"
    assert "$F_{main1}$ = " in "\n".join(texts(ax))
    (text,) = ls.plot.orders(ls.orders(cycle, "F_main1y", n=4)).get_legend().get_texts()
    assert text.get_text().startswith("$F_{main1y}$, largest")


def test_an_unbounded_force_is_written_as_infinity_in_its_load_diagram():
    written = "\n".join(texts(ls.sweep(SWING).linksweep.bearing("F12")))
    assert "= ∞ N" in written
    assert "e+" not in written
    at = float(ls.peaks(SWING, of=["F12"]).F12_peak_at)
    beside = ls.sweep(SWING, [at, at + 1e-6, at - 1e-6], of=["F12x", "F12y"]).dropna("theta2").isel(theta2=0)
    direction = np.degrees(np.arctan2(beside.F12y, beside.F12x))
    assert f"direction {float(direction):.1f}°".replace("-", "−") in written


def test_the_torque_of_several_cylinders_names_the_plot_of_their_speed():
    twin = ls.MultiCylinder(ls.example("engine"), crank_angles=[0, 360])
    with pytest.raises(ValueError, match="several cylinders: draw its speed"):
        ls.plot.torque_with_flywheel(ls.flywheel(twin, fluctuation=0.02))


def test_unbounded_peaks_are_still_plotted():
    with pytest.raises(ValueError, match="F32 grows without bound at every speed"):
        ls.plot.over_speed(SWING, "F32", speeds=[10.0, 20.0])


def test_a_balanced_force_is_drawn_as_zero():
    balanced = ls.with_counterweights(PRESS, ls.counterweights(PRESS, radius=0.06))
    figure = ls.plot.balance(PRESS, balanced, theta2=90)
    before, after = (text.get_text() for text in figure.axes[0].get_legend().get_texts())
    largest = float(ls.sweep(PRESS, theta2=90, of=["Fs"]).Fs.max())
    assert before == f"before, up to {largest:#.4g}"
    assert after == "after, up to 0"
    figure.canvas.draw()
    for ax in figure.axes:
        frame, legend = ax.get_window_extent(), ax.get_legend().get_window_extent()
        assert frame.x0 < legend.x0 and legend.x1 < frame.x1


@pytest.mark.parametrize("size", [1.0, 1e-15, 1e15], ids=["bench", "watch", "crane"])
def test_rounding_is_what_is_small_beside_the_force_before(size):
    """Forces of inertia are proportional to the density, and the balanced one is 0, however heavy the machine is."""
    bars = [ls.Bar(length, 0.02, 0.02, 8000.0 * size) for length in (0.08, 0.22, 0.18)]
    scene = ls.Scene(ls.FourBar(*bars, ground=0.2), omega2=30.0)
    figure = ls.plot.balance(scene, ls.with_counterweights(scene, ls.counterweights(scene, radius=0.06)), theta2=90)
    force, moment, *_ = ([text.get_text() for text in ax.get_legend().get_texts()] for ax in figure.axes)
    bench = replace(scene, mechanism=ls.FourBar(*(replace(bar, density=8000.0) for bar in bars), ground=0.2))
    largest = size * float(ls.peaks(bench, of=["Fs"]).Fs_peak)
    assert force == [f"before, up to {signals.number(largest)}", "after, up to 0"]
    assert not any(text.endswith("up to 0") for text in moment)


@pytest.mark.parametrize("loads", [(), ls.example("press").loads], ids=["by inertia", "at the load"])
def test_the_largest_moment_is_marked_between_the_sections(loads):
    scene = replace(ls.example("press"), loads=loads)
    ax = ls.plot.moment_diagram(scene, "coupler")
    shares = np.linspace(0.0, 1.0, 2001)
    dense = replace(scene, section=xr.DataArray(shares, {"section": shares}, "section"))
    largest = ls.peaks(dense, of=["bending_moment3"]).bending_moment3_peak.max()
    (marked,) = line(ax, "_worst").get_ydata()
    np.testing.assert_allclose(abs(marked), largest, rtol=2e-4 if loads else 1e-6)
    assert f"{abs(marked):.4g} N m" in ax.get_title("right")


def test_the_largest_moment_before_a_jump_is_that_of_the_load_by_hand():
    """A coupler without mass is a beam on two supports: F·a·b/L across it, largest just before the load ends."""
    thread = {"width": 1e-3, "thickness": 1e-3, "density": 0.0}
    links = (ls.Bar(length, **thread) for length in (0.1, 0.25, 0.2))
    push = xr.DataArray([0.0, -2000.0, 0.0], {"theta2": [0.0, 30.0, 60.0]}, "theta2")
    load = ls.Load("coupler", force=(0.0, push), at=(0.1, 0.0), interpolation="step")
    scene = ls.Scene(ls.FourBar(*links, ground=0.22), omega2=1.0, loads=[load])
    across = np.cos(np.radians(ls.sweep(scene, np.linspace(30.0, 60.0, 301), of=["theta3"]).theta3))
    assert int(abs(across).argmax("theta2")) == 300  # else the moment would not be largest before the jump
    expected = 2000.0 * float(abs(across).max()) * 0.1 * 0.15 / 0.25
    ax = ls.plot.moment_diagram(scene, "coupler")
    (marked,) = line(ax, "_worst").get_ydata()
    assert abs(marked) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("other", [None, "servo", 3.0, ls.Motor], ids=repr)
def test_a_motor_is_plotted_beside_its_load_and_nothing_else(other):
    load = ls.motor_load(ls.example("press"), ls.Motor([0.0, 600.0], [4.0, 1.0]), ratio=10.0, theta2=24)
    with pytest.raises(ValueError, match=r"^motor = .*: must be a Motor, InductionMotor, DCMotor or GovernedMotor$"):
        ls.plot.motor_load(load, other)


def test_the_band_of_tolerances_is_about_the_mean_of_all():
    """With limits on one side it is the peak of a crank midway between them; 3 sigma are those of an even spread.

    Ticks of a range of a few ten millinewton, at 354 N, have room beside each other.
    """
    crank, span = PRESS.mechanism.crank.length, 21e-6
    ax = ls.plot.tornado(ls.tolerance(PRESS, {"crank.length": ls.Tolerance(0.0, span)}, of="F32_peak", n=0))
    band = ax.patches[0].get_x() + np.array([0.0, ax.patches[0].get_width()])
    designs = ls.grid(PRESS, {"crank.length": [crank, crank + span / 2.0, crank + span]})
    first, middle, last = ls.peaks(designs, of=["F32"]).F32_peak.values
    assert band.mean() == pytest.approx(middle, abs=1e-3 * (last - first))
    assert band[1] - band[0] == pytest.approx(6.0 * (last - first) / np.sqrt(12.0), rel=1e-3)
    ax.figure.canvas.draw()
    labels = [label.get_window_extent() for label in ax.get_xticklabels() if label.get_text()]
    assert len(labels) > 2 and all(one.x1 < other.x0 for one, other in pairwise(labels))
    assert ax.xaxis.get_offset_text().get_text() == ""
