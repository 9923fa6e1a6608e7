"""Figures mark the exact peaks of the report's table, also at jumps."""

from dataclasses import replace

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from drawn import texts

import linksweep as ls
from linksweep.plot.kit.signals import angle_text, number
from linksweep.plot.kit.with_peaks import with_peaks
from linksweep.reports.results_of_page import results_of

mpl.use("Agg")


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def pump() -> ls.Scene:
    """Return a slider-crank with friction, whose forces jump at the dead centres: a sample has one side of each."""
    machine = ls.SliderCrank(
        ls.Bar(0.05, 0.02, 0.02, 7750), ls.Bar(0.2, 0.02, 0.02, 7750), 1.5, friction=0.15, offset=0.004
    )
    return ls.Scene(machine, omega2=40.0, gravity=(0.0, -9.81), loads=[ls.Load("slider", force=-300.0)])


def labels_at_peaks(ax, units: str) -> str:
    return "\n".join(texts(ax)).replace(f" {units}", "")


@pytest.mark.parametrize("count", [36, 90, 720])
def test_every_figure_marks_the_peaks_of_the_table(count):
    scene = pump()
    cycle, worst = ls.sweep(scene, count), ls.peaks(scene)
    assert float(cycle.T12.max()) < float(worst.T12_max)  # the samples miss it
    labels = labels_at_peaks(ls.plot.torque(cycle), "N m")
    assert f"max {number(float(worst.T12_max))} at" in labels
    assert f"min {number(float(worst.T12_min))} at" in labels
    labels = labels_at_peaks(ls.plot.forces(cycle), "N")
    for pin in ("F12", "F32", "F43", "F14"):
        assert f"$F_{{{pin[1:]}}}$ {number(float(worst[f'{pin}_peak']))} at" in labels
        if pin != "F14":
            assert f" = {number(float(worst[f'{pin}_peak']))}" in labels_at_peaks(ls.plot.bearing(cycle, pin), "N")
    shaking = ls.sweep(scene, count, of=["Fsx", "Fsy"])
    fs = number(float(ls.peaks(scene, of=["Fs"]).Fs_peak))
    assert f"$F_{{s}}$ = {fs}" in labels_at_peaks(ls.plot.hodograph(shaking), "N")


def double_rocker() -> ls.Scene:
    """Return a double rocker with toggles at ±arccos((a² + d² − (b + c)²)/(2·a·d)), where forces are unbounded."""
    links = (ls.Bar(length, 0.02, 0.02, 7750) for length in (0.2, 0.12, 0.15))
    return ls.Scene(ls.FourBar(*links, ground=0.25), omega2=5.0, gravity=(0.0, -9.81))


def tipper() -> ls.Scene:
    machine = ls.InvertedSliderCrank(
        ls.Link(1.5, 300.0, 90.0, 0.9), ls.Link(4.0, 80.0, 40.0, 1.0), 1.6, 30.0, ground_angle=-25.0
    )
    return ls.Scene(machine, omega2=0.05, gravity=(0.0, -9.81), drive="cylinder")


MACHINES = {
    "press": lambda: ls.example("press"),
    "engine": lambda: ls.example("engine"),
    "quick-return": lambda: ls.example("quick-return"),
    "pump": pump,
    "tipper": tipper,
}


@pytest.mark.parametrize("name", MACHINES)
def test_marks_over_a_part_are_the_peaks_of_fine_samples(name):
    """The reference over a part of a turn is 20 samples to a degree, with the angles of the marks among them."""
    scene, first, last = MACHINES[name](), 10.0, 60.0
    close = np.linspace(first, last, 1001)
    marked = [with_peaks(ls.sweep(scene, np.linspace(first, last, count))) for count in (36, 720)]
    at = np.concatenate([close, *(ds.theta2.values for ds in marked)])
    for force in ("F12", "F32", "F43", "F14"):
        sizes = [float(np.hypot(ds[f"{force}x"], ds[f"{force}y"]).max()) for ds in marked]
        reference = float(ls.peaks(scene, [force], theta2=np.unique(at))[f"{force}_peak"])
        assert sizes == pytest.approx([reference] * 2, rel=1e-12)
        sampled = float(ls.peaks(scene, [force], theta2=close)[f"{force}_peak"])
        assert sampled <= reference * (1.0 + 1e-12)


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("count", [36, 720])
def test_marks_over_a_part_equal_the_reports_table(name, count):
    scene, part = MACHINES[name](), (-35.0, 117.3)
    peaks = results_of(scene, part).peaks
    cycle = ls.sweep(scene, np.linspace(*part, count))
    labels = labels_at_peaks(ls.plot.forces(cycle), "N")
    for force in ("F12", "F32"):
        size, at = number(float(peaks[f"{force}_peak"])), angle_text(float(peaks[f"{force}_peak_at"]))
        assert f"$F_{{{force[1:]}}}$ {size} at {at}" in labels
    drive = scene.mechanism.drives[scene.drive]
    labels = labels_at_peaks(ls.plot.torque(cycle), "N m" if drive.startswith("T") else "N")
    for end in ("max", "min"):
        size, at = number(float(peaks[f"{drive}_{end}"])), angle_text(float(peaks[f"{drive}_{end}_at"]))
        assert f"{end} {size} at {at}" in labels


def test_a_part_that_ends_at_a_toggle_or_beyond():
    """A part that ends beside the toggle has its largest forces at its last angle."""
    scene = double_rocker()
    toggle = float(np.degrees(np.arccos((0.2**2 + 0.25**2 - 0.27**2) / (2.0 * 0.2 * 0.25))))
    beyond = ls.peaks(scene, ["F32", "T12"], between=(10.0, toggle + 20.0))
    assert np.isposinf(beyond.F32_peak) and float(beyond.F32_peak_at) == pytest.approx(toggle, abs=1e-6)
    assert int(beyond.status) == 3
    beside = ls.peaks(scene, ["F32"], between=(10.0, toggle - 1e-3))
    last = ls.sweep(scene, [toggle - 1e-3], of=["F32"]).F32
    assert float(beside.F32_peak) == pytest.approx(float(last[0]), rel=1e-9)
    assert float(beside.F32_peak_at) == toggle - 1e-3 and int(beside.F32_peak_at_end) == 2


@pytest.mark.parametrize("count", [36, 37, 720])
def test_unbounded_peaks_are_marked_at_their_toggles(count):
    scene = double_rocker()
    toggle = float(np.degrees(np.arccos((0.2**2 + 0.25**2 - 0.27**2) / (2.0 * 0.2 * 0.25))))
    cycle = ls.sweep(scene, count, of=[*scene.mechanism.dynamics("crank"), "Fsx", "Fsy"])
    where = {angle_text(toggle), angle_text(360.0 - toggle)}
    for drawn, units in (
        (ls.plot.forces, "N"),
        (ls.plot.torque, "N m"),
        (ls.plot.bearing, "N"),
        (ls.plot.hodograph, "N"),
    ):
        labels = labels_at_peaks(drawn(cycle), units)
        assert "∞" in labels and "off scale" in labels
        assert any(angle in labels for angle in where)
    ls.plot.cycle(cycle).draw_without_rendering()


def test_a_part_of_a_cycle_of_two_turns():
    """A four-stroke engine has gas pressure also in its second turn."""
    scene = ls.example("engine")
    whole = ls.peaks(scene, ["F32"])
    parts = [ls.peaks(scene, ["F32"], between=(first, first + 360.0)) for first in (0.0, 360.0)]
    assert max(float(part.F32_peak) for part in parts) == pytest.approx(float(whole.F32_peak), rel=1e-9)


def test_exact_peaks_are_added_between_the_samples():
    cycle = ls.sweep(pump(), 90)
    more = with_peaks(cycle)
    xr.testing.assert_equal(
        more.sel(theta2=cycle.theta2)[["T12", "F32x"]], cycle[["T12", "F32x"]].reset_coords(drop=True)
    )
    worst = ls.peaks(pump())
    assert float(np.hypot(more.F32x, more.F32y).max()) == pytest.approx(float(worst.F32_peak), rel=1e-9)
    assert with_peaks(more) is more


def test_changed_results_and_batches_are_drawn_without_exact_peaks():
    cycle = ls.sweep(pump(), 90)
    with xr.set_options(keep_attrs=True):
        doubled = cycle.assign(T12=2.0 * cycle.T12)
    lost = cycle.drop_attrs()
    speeds = ls.sweep(replace(pump(), omega2=xr.DataArray([20.0, 40.0], dims="speed")), 90)
    jumps = replace(pump(), loads=[ls.Load("slider", force=lambda a: np.where(np.mod(a, 360.0) < 180.0, 0.0, -300.0))])
    for ds in (doubled, lost, speeds, ls.sweep(jumps, 90)):
        assert with_peaks(ds) is ds
    ls.plot.cycle(ls.sweep(jumps, 90))


@pytest.mark.parametrize("from_sample", [1, 45, 89])
def test_one_altered_sample_leaves_a_cycle_without_exact_peaks(from_sample):
    cycle = ls.sweep(pump(), 90)
    later = xr.DataArray(np.arange(90) >= from_sample, dims="theta2")
    for altered in (
        cycle.assign(T12=xr.where(later, 0.5 * cycle.T12, cycle.T12).assign_attrs(cycle.T12.attrs)),
        cycle.assign(T12=cycle.T12.where(~later)),
    ):
        assert with_peaks(altered) is altered


def test_one_of_several_designs_is_marked_exactly():
    scene = replace(pump(), omega2=xr.DataArray([20.0, 40.0], {"speed": [1, 2]}, "speed"))
    labels = labels_at_peaks(ls.plot.torque(ls.sweep(scene, 90).isel(speed=1)), "N m")
    assert f"max {number(float(ls.peaks(pump()).T12_max))} at" in labels


def test_a_lap_marks_the_extremes_between_its_samples():
    """m (v²/R ± g), at the bottom and at the top."""
    car = ls.Scene(ls.LoopTrack(radius=30.0, mass=700.0), speed=100.0, gravity=(0.0, -9.81))
    figure = ls.sweep(car, 7).linksweep.loop()
    (ax,) = (ax for ax in figure.axes if ax.get_ylabel().startswith("force"))
    marks = {line.get_label(): line.get_xydata()[0] for line in ax.lines if line.get_label() in ("_max", "_min")}
    np.testing.assert_allclose(marks["_max"], [0.0, 700.0 * (1e4 / 30.0 + 9.81)], rtol=1e-12, atol=1e-6)
    np.testing.assert_allclose(marks["_min"], [180.0, 700.0 * (1e4 / 30.0 - 9.81)], rtol=1e-12, atol=1e-4)


def test_a_part_of_a_lap_marks_the_extremes_between_its_samples():
    car = ls.Scene(ls.LoopTrack(radius=30.0, mass=700.0), speed=100.0, gravity=(0.0, -9.81))
    figure = ls.sweep(car, [-100.0, -33.0, 50.0, 90.0]).linksweep.loop()
    (ax,) = (ax for ax in figure.axes if ax.get_ylabel().startswith("force"))
    marks = {line.get_label(): line.get_xydata()[0] for line in ax.lines if line.get_label() in ("_max", "_min")}
    np.testing.assert_allclose(marks["_max"], [0.0, 700.0 * (1e4 / 30.0 + 9.81)], rtol=1e-12, atol=1e-4)
    least = 700.0 * (1e4 / 30.0 + 9.81 * np.cos(np.radians(100.0)))
    np.testing.assert_allclose(marks["_min"], [-100.0, least], rtol=1e-9, atol=1e-4)


def lengths() -> ls.Scene:
    """Return a press with couplers of three lengths."""
    scene = ls.example("press")
    coupler = ls.Bar(xr.DataArray([0.2, 0.22, 0.24], dims="coupler"), 0.02, 0.02, 7750.0)
    return replace(scene, mechanism=replace(scene.mechanism, coupler=coupler))


def test_each_of_several_designs_has_its_exact_peak():
    scene = lengths()
    cycle, worst = ls.sweep(scene, 24), ls.peaks(scene, of=["F32", "T12"])
    ax = cycle.linksweep.forces(["F32"])
    marks = [line.get_xydata()[0] for line in ax.lines if line.get_label() == "_peak F32"]
    expected = np.transpose([worst.F32_peak_at, worst.F32_peak])
    np.testing.assert_allclose(sorted(map(tuple, marks)), sorted(map(tuple, expected)), rtol=1e-9, atol=2e-7)
    assert cycle.F32.max("theta2").values == pytest.approx(worst.F32_peak.values, rel=0.1)  # but no sample is a peak
    assert not np.isin(cycle.F32.max("theta2"), worst.F32_peak).any()
    curves = [line for line in ax.lines if line.get_label().startswith("coupler = ")]
    assert len(curves) == 3 and max(len(line.get_xdata()) for line in curves) > 25
    ax = cycle.linksweep.torque()
    tops = sorted(line.get_ydata()[0] for line in ax.lines if line.get_label() == "_peak T12")
    np.testing.assert_allclose(tops, sorted([*worst.T12_max.values, *worst.T12_min.values]), rtol=1e-9)


def test_a_hodograph_marks_the_exact_peak_of_its_vector():
    scene = ls.example("press")
    for of in ("Fs", "F43"):
        worst = ls.peaks(scene, of=[of])
        ax = ls.sweep(scene, 24, of=[f"{of}x", f"{of}y"]).linksweep.hodograph(of)
        (mark,) = [line.get_xydata()[0] for line in ax.lines if line.get_label() == f"_peak {of}"]
        assert np.hypot(*mark) == pytest.approx(float(worst[f"{of}_peak"]), rel=1e-9)


def test_before_and_after_balancing_state_exact_peaks():
    before = ls.example("press")
    after = ls.with_counterweights(before, ls.counterweights(before, radius=0.06))
    figure = ls.plot.balance(before, after, theta2=24)
    for scene, when in ((before, "before"), (after, "after")):
        worst = ls.peaks(scene, of=["Fs", "Ms", "T12", "F43"])
        legends = [" ".join(text.get_text() for text in ax.get_legend().get_texts()) for ax in figure.axes]
        for name, legend in zip(("Fs", "Ms", "T12", "F43"), legends, strict=True):
            peak = float(worst[f"{name}_peak"])
            balanced = when == "after" and name == "Fs"
            assert f"{when}, up to {number(0.0 if balanced else peak)}" in legend


def test_curves_before_and_after_balancing_reach_the_largest_force():
    """3000 N for a tenth of a degree, between all samples, on a crank without mass; half of it after."""
    angles = np.union1d(np.arange(0.0, 361.0, 20.0), [200.2, 200.25, 200.3])
    pulse = xr.DataArray(np.where(angles == 200.25, 3000.0, 0.0), {"theta2": angles}, "theta2")
    light = ls.FourBar(*(ls.Link(length, 0.0, 0.0) for length in (0.08, 0.22, 0.18)), ground=0.2)
    before, after = (
        ls.Scene(light, 30.0, loads=[ls.Load("crank", force=(part * pulse, 0.0), interpolation="linear")])
        for part in (1.0, 0.5)
    )
    pin = ls.plot.balance(before, after).axes[-1]
    assert pin.get_title(loc="left") == "Load of pin A"
    for when, largest in {"before, up to 3000": 3000.0, "after, up to 1500": 1500.0}.items():
        (curve,) = [line.get_ydata() for line in pin.lines if line.get_label() == when]
        assert curve.max() == pytest.approx(largest, rel=1e-9)


def pulse(size: float) -> xr.DataArray:
    """Return an array over theta2 that is 0 but between 200.1 and 200.4 degrees."""
    angles = np.array([0.0, 90.0, 180.0, 200.1, 200.2, 200.3, 200.4, 270.0])
    return xr.DataArray(np.where(np.abs(angles - 200.25) < 0.1, size, 0.0), {"theta2": angles}, "theta2")


def with_load(**load) -> ls.Scene:
    press = ls.example("press")
    return replace(press, loads=[*press.loads, ls.Load(**load, interpolation="linear")])


@pytest.mark.parametrize(("of", "theta2"), [("F32", 72), ("T12", 72), ("F32", np.linspace(150.0, 250.0, 21))])
def test_a_breakdown_reaches_the_exact_peak(of, theta2):
    scene = with_load(link="coupler", force=(0.0, pulse(-3000.0)), at=(0.1, 15.0))
    ax = ls.breakdown(scene, of, theta2=theta2).linksweep.breakdown()
    (whole,) = (line.get_xydata() for line in ax.lines if line.get_label() == "sum")
    assert np.abs(whole[:, 1]).max() == pytest.approx(float(ls.peaks(scene, of=[of])[f"{of}_peak"]), rel=1e-9)
    assert "load3 (coupler)" in [text.get_text() for text in ax.get_legend().get_texts()]
    assert tuple(whole[[0, -1], 0]) == ((0.0, 360.0) if isinstance(theta2, int) else (150.0, 250.0))


def test_a_breakdown_shows_a_load_that_is_narrow_away_from_the_peak():
    scene = with_load(link="rocker", torque=pulse(5.0))
    assert abs(float(ls.peaks(scene, of=["F43"]).F43_peak_at) - 200.25) > 90.0
    ax = ls.breakdown(scene, "F43", theta2=72).linksweep.breakdown()
    assert "load3 (rocker)" in [text.get_text() for text in ax.get_legend().get_texts()]


def test_a_part_of_a_breakdown_is_drawn_as_it_is():
    shares = ls.breakdown(ls.example("press"), "F32", theta2=72).isel(source=slice(0, 2))
    (whole,) = (line for line in shares.linksweep.breakdown().lines if line.get_label() == "sum")
    np.testing.assert_array_equal(whole.get_ydata()[:-1], shares.F32.sum("source"))
