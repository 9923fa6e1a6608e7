"""Plots show the numbers: units, peaks, gaps, positions; and no text or curve hides another."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from drawn import boxes, closed_figures, curves, line, page_hides_nothing, pixels, plt, size_of, texts  # noqa: F401
from long import long_but

import linksweep as ls
import linksweep.plot.accessor
from linksweep import plot
from linksweep.plot.kit.with_peaks import with_peaks

BAR = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
LOAD = ls.Load("coupler", force=(0.0, -80.0), at=(0.10, 15.0))
PINS = ("F12", "F32", "F43", "F14")


def four_bar(a, b, c, d, **options):
    bars = [ls.Bar(length=length, **BAR) for length in (a, b, c)]
    return ls.FourBar(*bars, ground=d, **options)


def press(**options):
    return ls.Scene(four_bar(0.08, 0.22, 0.18, 0.20, **options), 30.0, gravity=(0.0, -9.81), loads=[LOAD])


SCENES = {
    "press": press(),
    "crossed": press(branch="crossed"),
    "turned": press(ground_angle=30.0),
    "triple rocker": ls.Scene(four_bar(0.08, 0.12, 0.11, 0.22), -20.0, alpha2=100.0, gravity=(0.0, -9.81)),
}


@pytest.fixture(scope="module")
def cycles():
    return {name: ls.sweep(scene) for name, scene in SCENES.items()}


@pytest.mark.parametrize("name", ["press", "crossed", "turned"])
def test_forces_marks_the_exact_peak_of_each_pin(cycles, name):
    ds, worst = cycles[name], ls.peaks(SCENES[name])
    ax = plot.forces(ds)
    assert ax.get_ylabel() == "pin force [N]"
    assert ax.get_xlabel().endswith("[°]")
    assert ax.get_xlim() == (0.0, 360.0)
    assert set(np.diff(ax.get_xticks())) == {45.0}
    for pin in PINS:
        (angle,), (value,) = line(ax, f"_peak {pin}").get_data()
        assert value == pytest.approx(float(worst[f"{pin}_peak"]), rel=1e-10)
        assert angle == pytest.approx(float(worst[f"{pin}_peak_at"]), abs=2e-7)
        text = next(row for text in texts(ax) for row in text.split("\n") if f"_{{{pin[1:]}}}" in row)
        assert f"{value:#.4g} N at {round(angle, 2):.5g}°" in text


def test_forces_are_closed_at_360_degrees_and_read_from_magnitudes_or_components(cycles):
    ds = cycles["press"]
    ax = plot.forces(ds, "F32")
    angles, values = ax.lines[0].get_data()
    assert angles[-1] == 360.0
    assert values[-1] == values[0]
    np.testing.assert_array_max_ulp(values[:-1], size_of(with_peaks(ds), "F32"), maxulp=2)
    np.testing.assert_array_max_ulp(values[:-1][np.isin(angles[:-1], ds.theta2)], size_of(ds, "F32"), maxulp=2)
    for names in (["F32"], ["F32x", "F32y"]):
        drawn = plot.forces(ls.sweep(SCENES["press"], of=names), "F32").lines[0].get_ydata()
        np.testing.assert_allclose(drawn, values, rtol=1e-14)
    assert "F_{32}" in ax.get_ylabel()


def test_angles_in_any_order_are_drawn_in_order_and_a_part_of_a_turn_is_not_closed():
    ax = plot.forces(ls.sweep(SCENES["press"], theta2=[50.0, 10.0, 30.0]), ["F12"])
    drawn = ax.lines[0].get_xdata()
    assert (np.diff(drawn) > 0.0).all() and {10.0, 30.0, 50.0} <= {*drawn}
    assert ax.get_xlim() == (10.0, 50.0)


@pytest.mark.parametrize("angles", [90, [10.0, 30.0, 50.0]])
def test_a_constant_torque_is_drawn_with_its_value(angles):
    """A massless press whose crank is braked by 5 N m at all angles."""
    links = [ls.Link(length, 0.0, 0.0) for length in (0.08, 0.22, 0.18)]
    scene = ls.Scene(ls.FourBar(*links, ground=0.20), 30.0, loads=[ls.Load("crank", torque=-5.0)])
    ax = plot.torque(ls.sweep(scene, angles))
    assert ax.get_ylim()[0] < 0.0 and 5.0 < ax.get_ylim()[1] < 7.0
    assert texts(ax) == ["constant 5.000 N m"]


def test_the_torque_of_one_angle_is_drawn_with_its_value():
    ds = ls.sweep(SCENES["press"], theta2=[30.0])
    ax = plot.torque(ds)
    assert ax.get_ylim()[0] < float(ds.T12[0]) < ax.get_ylim()[1]
    assert texts(ax) == [f"{float(ds.T12[0]):.4g} N m at 30°"]


def test_gaps_stay_gaps_with_their_reason(cycles):
    ds = cycles["triple rocker"]
    bad = ds.status.values != 0
    assert 0 < bad.sum() < bad.size
    last, first = ds.theta2.values[np.flatnonzero(np.diff(bad.astype(int)))] + (0.0, 0.5)
    for ax in (plot.forces(ds), plot.torque(ds)):
        curve = next(curve for curve in ax.lines if len(curve.get_xdata()) > bad.size)
        sampled = np.isin(curve.get_xdata(), ds.theta2)
        np.testing.assert_array_equal(np.isnan(curve.get_ydata()[sampled]), bad)
        ((start, stop),) = [(p.get_x(), p.get_x() + p.get_width()) for p in ax.patches]
        assert last <= start < last + 0.5 and first - 0.5 < stop <= first  # a peak without bound is at the toggle
        assert [text.get_text() for text in ax.texts] == ["cannot assemble"]


def test_masked_angles_are_a_gap_without_a_result(cycles):
    """Masking a whole Dataset masks the status, too, whose reasons are lost."""
    ds = cycles["press"].where(cycles["press"].theta2 < 180.0)
    for ax in (plot.forces(ds), plot.torque(ds)):
        ((start, stop),) = [(p.get_x(), p.get_x() + p.get_width()) for p in ax.patches]
        assert (start, stop) == (179.5, 360.0)
        assert [text.get_text() for text in ax.texts] == ["no result"]


def test_unbounded_forces_are_marked_as_off_the_scale(cycles):
    ds = cycles["triple rocker"]
    ax = plot.forces(ds)
    largest = {pin: np.nanmax(size_of(ds, pin)) for pin in PINS}
    assert min(largest.values()) > 100.0 * ax.get_ylim()[1]
    assert np.nanmedian(size_of(ds, "F12")) > 0.2 * ax.get_ylim()[1]  # usual values fill the axis
    (text,) = texts(ax)
    assert text.startswith("off scale:")
    for pin in PINS:
        assert line(ax, f"_peak {pin}").get_ydata()[0] == ax.get_ylim()[1]
    assert text.count("∞ N") == len(PINS)


def test_a_short_pulse_far_from_a_gap_is_shown_whole():
    pulse = ls.Load("rocker", torque=lambda theta2: np.where(np.abs(theta2 - 40.0) < 4.0, 500.0, 0.0))
    ds = ls.sweep(ls.Scene(four_bar(0.08, 0.12, 0.11, 0.22), -20.0, loads=[pulse]))
    usual = size_of(ds, "F43")[np.abs(ds.theta2.values - 40.0) < 4.0].max()
    assert plot.forces(ds).get_ylim()[1] > usual > 1000.0


@pytest.mark.parametrize("drive", ["crank", "coupler", "rocker"])
def test_torque_marks_both_extremes(drive):
    scene = ls.Scene(four_bar(0.08, 0.22, 0.18, 0.20), 30.0, loads=[LOAD], drive=drive)
    ds = ls.sweep(scene, theta2=97)
    name = {"crank": "T12", "coupler": "T13", "rocker": "T14"}[drive]
    ax = plot.torque(ds)
    assert f"_{{{name[1:]}}}" in ax.get_ylabel()
    assert ax.get_ylabel().endswith("[N m]")
    marks = [mark for mark in ax.lines if mark.get_label() == f"_peak {name}"]
    worst = ls.peaks(scene)
    text = "\n".join(texts(ax)).replace("−", "-")
    for word, limit in zip(("min", "max"), ax.get_ylim(), strict=True):
        value, at = float(worst[f"{name}_{word}"]), float(worst[f"{name}_{word}_at"])
        places = [mark.get_xdata()[0] for mark in marks if np.sign(mark.get_ydata()[0]) == np.sign(limit)]
        assert any(place == pytest.approx(at, abs=2e-7) for place in places)
        number = f"{value:#.4g}".rstrip(".").replace("inf", "∞")  # at the dead centres of this drive
        assert f"{word} {number}" in text


@pytest.mark.parametrize("count", [360, 719, 1000])
def test_all_dead_centres_are_marked_and_the_axis_does_not_follow_the_grid(count):
    """Crank and coupler lie in one line there: cos θ2 = ±((b ± a)² + d² − c²)/(2·d·(b ± a)). The usual size is that of
    the angles without the fifths of the arcs beside."""
    scene = ls.Scene(four_bar(0.08, 0.22, 0.18, 0.20), 30.0, loads=[LOAD], drive="rocker")
    long, short = (np.degrees(np.arccos((side**2 + 0.20**2 - 0.18**2) / (0.4 * side))) for side in (0.30, 0.14))
    first, second = long, 180.0 + short
    away = np.concatenate(
        [
            np.arange(0.0, 0.8 * first, 0.1),
            np.arange(0.8 * first + 0.2 * second, 0.2 * first + 0.8 * second, 0.1),
            np.arange(0.8 * second + 0.2 * 360.0, 360.0, 0.1),
        ]
    )
    samples = ls.sweep(scene, away)
    ds = ls.sweep(scene, count)
    ax = plot.forces(ds)
    assert ax.get_ylim()[1] == pytest.approx(1.3 * max(size_of(samples, pin).max() for pin in PINS), rel=0.05)
    for pin in PINS:
        marks = [mark.get_xdata()[0] for mark in ax.lines if mark.get_label() == f"_peak {pin}"]
        np.testing.assert_allclose(marks, [first, second], rtol=0.0, atol=2e-7)
    ax = plot.torque(ds)
    assert ax.get_ylim()[1] == pytest.approx(1.36 * float(abs(samples.T14).max()), rel=0.05)  # 0.18 of the span beyond
    marks = [mark.get_xydata()[0] for mark in ax.lines if mark.get_label() == "_peak T14"]
    low, high = ax.get_ylim()
    expected = [(first, high), (second, high), (first, low), (second, low)]
    np.testing.assert_allclose(sorted(map(tuple, marks)), sorted(expected), rtol=0.0, atol=2e-7)


def test_bearing_diagram_has_equal_scales_and_its_ticks_at_their_angles(cycles):
    ds = cycles["press"]
    ax = plot.bearing(ds, "F43")
    assert ax.get_aspect() == 1.0
    assert all(label.endswith("[N]") for label in (ax.get_xlabel(), ax.get_ylabel()))
    at = ls.sweep(SCENES["press"], theta2=np.arange(12) * 30.0)
    np.testing.assert_allclose(line(ax, "_ticks").get_data(), [at.F43x, at.F43y], rtol=1e-12)
    locus = np.array(line(ax, "_locus F43").get_data())
    np.testing.assert_array_equal(locus[:, 0], locus[:, -1])
    ds = with_peaks(ds)
    x, y = np.ravel(line(ax, "_peak F43").get_data())  # one of two samples 1e-9 degrees apart, as sizes are rounded
    (k,) = np.flatnonzero((ds.F43x == x) & (ds.F43y == y))
    assert np.hypot(x, y) == pytest.approx(float(np.max(size_of(ds, "F43"))), rel=1e-14)
    assert {"$\\theta_2$ = 0°", "90°", "180°", "270°"} < set(texts(ax))
    direction = np.degrees(np.arctan2(ds.F43y[k], ds.F43x[k])).item()
    assert any(f"direction {direction:.1f}°".replace("-", "−") in text for text in texts(ax))


def test_ticks_of_a_coarse_sweep_lie_on_the_drawn_curve():
    ds = with_peaks(ls.sweep(SCENES["press"], theta2=23))  # no sample at 30 degrees
    ax = plot.bearing(ds, "F12")
    (x, y), (locus_x, locus_y) = line(ax, "_ticks").get_data(), line(ax, "_locus F12").get_data()
    angles = np.append(ds.theta2.values, 360.0)
    assert len(x) == 12
    np.testing.assert_allclose(x, np.interp(np.arange(12) * 30.0, angles, locus_x))
    np.testing.assert_allclose(y, np.interp(np.arange(12) * 30.0, angles, locus_y))


@pytest.mark.parametrize("pin", PINS)
def test_link_axes_keep_the_magnitude(cycles, pin):
    ground, link = (
        np.hypot(*line(plot.bearing(cycles["press"], pin, frame=frame), f"_locus {pin}").get_data())
        for frame in ("ground", "link")
    )
    np.testing.assert_allclose(link, ground, rtol=1e-12)


@pytest.mark.parametrize(("pin", "massless"), [("F14", 2), ("F43", 1)])
def test_the_force_on_a_massless_link_without_loads_lies_along_it(pin, massless):
    links = [ls.Bar(length=length, **BAR) for length in (0.08, 0.22, 0.18)]
    links[massless] = ls.Link(length=links[massless].length, mass=0.0, inertia=0.0)
    scene = ls.Scene(ls.FourBar(*links, ground=0.20), 30.0, loads=[ls.Load("rocker", torque=-12.0)] * (massless == 1))
    ds = ls.sweep(scene, of=[f"{pin}x", f"{pin}y"])  # without the link's angle
    x, y = line(plot.bearing(ds, pin, frame="link"), f"_locus {pin}").get_data()
    assert np.abs(y).max() < 1e-12 * np.abs(x).max()


def test_crank_axes_at_90_degrees_and_the_reaction(cycles):
    ds = cycles["press"].sel(theta2=[60.0, 90.0, 120.0])
    x, y = line(plot.bearing(ds, "F32", frame="link"), "_locus F32").get_data()
    at = np.flatnonzero(np.isin(with_peaks(ds).theta2, ds.theta2))
    x, y = x[at], y[at]
    np.testing.assert_allclose((x[1], y[1]), (ds.F32y[1], -ds.F32x[1]), rtol=1e-12)
    x, y = line(plot.bearing(ds, "F23"), "_locus F23").get_data()
    np.testing.assert_array_equal((x[at], y[at]), (-ds.F32x, -ds.F32y))


@pytest.mark.parametrize("name", SCENES)
def test_mechanism_is_drawn_to_scale(name):
    scene = SCENES[name]
    ax = plot.mechanism(scene, theta2=60.0, point=(0.1, 15.0))
    four = scene.mechanism
    assert ax.get_aspect() == 1.0
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("x [m]", "y [m]")
    A, B, C, D = np.transpose(line(ax, "_pins").get_data())
    np.testing.assert_allclose(B, 0.08 * np.array([0.5, np.sqrt(0.75)]))
    lengths = [np.linalg.norm(q - p) for p, q in ((A, B), (B, C), (D, C), (A, D))]
    np.testing.assert_allclose(lengths, [four.crank.length, four.coupler.length, four.rocker.length, four.ground])
    across = np.cross(np.append(D - B, 0.0), np.append(C - B, 0.0))[2]
    assert (across > 0.0) == (four.branch == "open")
    P = np.ravel(line(ax, "_point").get_data())
    turned = np.array([complex(*(P - B)) / complex(*(C - B))])
    np.testing.assert_allclose(turned, 0.1 / four.coupler.length * np.exp(1j * np.radians(15.0)))
    curve = np.transpose(line(ax, "_coupler curve").get_data())
    assert np.nanmin(np.linalg.norm(curve - P, axis=1)) < 1e-12
    assert np.isnan(curve).any() == (name == "triple rocker")
    assert {"A", "B", "C", "D", "P"} == {text for text in texts(ax) if not text.startswith("load ")}


def test_mechanism_shows_the_pin_forces_of_its_angle(cycles):
    ds = cycles["press"]
    ax = plot.mechanism(ds, ds.T12.idxmax("theta2"), forces=True)
    here = ds.isel(theta2=ds.T12.argmax("theta2"))
    for pin in PINS:
        assert any(f"{np.hypot(here[f'{pin}x'], here[f'{pin}y']).item():#.4g} N" in text for text in texts(ax))


def test_mechanism_of_a_chosen_branch_is_that_branch():
    both = ls.sweep(press(branch="both"), theta2=12)
    for branch in ("open", "crossed"):
        chosen = plot.mechanism(both.sel(branch=branch), 45.0)
        alone = plot.mechanism(press(branch=branch), 45.0)
        np.testing.assert_array_equal(line(chosen, "_pins").get_data(), line(alone, "_pins").get_data())


def test_a_mechanism_that_cannot_be_assembled_is_refused(cycles):
    with pytest.raises(ValueError, match=r"theta2 = 100 degree: .* cannot be assembled there; .* such as 86\.5"):
        plot.mechanism(cycles["triple rocker"], 100.0)
    with pytest.raises(ValueError, match="must be one crank angle"):
        plot.mechanism(cycles["press"], [10.0, 20.0])


def coupler_lengths(count):
    return xr.DataArray(np.linspace(0.2, 0.26, count), dims="coupler_length", attrs={"units": "m"})


def designs(count):
    lengths = coupler_lengths(count)
    return ls.sweep(ls.Scene(four_bar(0.08, lengths.assign_coords(coupler_length=lengths), 0.18, 0.2), 30.0), 36)


@pytest.mark.parametrize("draw", [plot.forces, plot.torque, plot.bearing, plot.mechanism, plot.cycle])
def test_many_designs_are_refused_with_a_remedy(draw):
    ds = designs(7)
    with pytest.raises(ValueError, match=r"coupler_length \(7\).*ds\.isel\({'coupler_length': 0}\)"):
        draw(ds)
    draw(ds.isel(coupler_length=0))


def test_a_few_designs_of_one_signal_get_a_line_each():
    ds = designs(3)
    for ax, values in ((plot.torque(ds), ds.T12), (plot.forces(ds, "F32"), np.hypot(ds.F32x, ds.F32y))):
        labels = [text.get_text() for text in ax.get_legend().get_texts()]
        assert labels[0].startswith("coupler_length = 0.2")
        lines = [row for row in ax.lines if row.get_label() in labels]  # with samples at the peaks of each
        drawn = [row.get_ydata()[:-1][np.isin(row.get_xdata()[:-1], ds.theta2)] for row in lines]
        np.testing.assert_array_max_ulp(np.array(drawn), values.values, maxulp=2)


@pytest.mark.parametrize("name", long_but(SCENES, "press"))
def test_nothing_on_the_page_hides_anything(cycles, name):
    figure = cycles[name].linksweep.cycle()
    assert [bool(ax.get_title(loc="left")) for ax in figure.axes] == [True] * 4
    assert figure.get_size_inches()[0] < 7.3  # within the margins of A4
    page_hides_nothing(figure)


@pytest.mark.parametrize("name", SCENES)
def test_the_legend_hides_no_curve(cycles, name):
    ax = plot.forces(cycles[name])
    ax.figure.canvas.draw()
    legend = ax.get_legend().get_window_extent()
    assert not any(legend.count_contains(pixels(curve)) for curve in ax.lines)


def test_the_page_shows_the_most_loaded_pin(cycles):
    ds = with_peaks(cycles["press"])
    worst = max(PINS, key=lambda pin: size_of(ds, pin).max())
    angle = ds.theta2.values[size_of(ds, worst).argmax()]
    mechanism, _, bearing, _ = plot.cycle(ds).axes
    assert f"{round(angle, 2):.5g}°" in mechanism.get_title(loc="left")
    assert line(bearing, f"_locus {worst}").get_xdata().size == ds.sizes["theta2"] + 1


def test_functions_draw_on_given_axes_and_the_accessor_delegates(cycles):
    ds = cycles["press"]
    _, ax = plt.subplots()
    for draw in (ds.linksweep.forces, ds.linksweep.torque, ds.linksweep.bearing, ds.linksweep.mechanism):
        assert draw(ax=ax) is ax
    assert len(plt.get_fignums()) == 1
    assert ds.linksweep.scene == SCENES["press"]


OF_SCENES = {"animate", "balance", "mechanism", "moment_diagram", "moment_diagrams", "over_speed"}
"""Plots that take a scene."""


def test_every_plot_of_a_dataset_is_a_method_of_the_accessor():
    """One line in linksweep/plot/__init__.pyi adds a plot to ``ls.plot``, its dir and the accessor."""
    methods = {name for name in vars(linksweep.plot.accessor.Cycle) if name in plot.__all__}
    assert {*plot.__all__} - methods == OF_SCENES - {"animate", "mechanism"}  # which take results, too
    assert dir(plot) == sorted(plot.__all__)
    path = Path(plot.__file__).with_suffix(".pyi")
    assert len(plot.__all__) == path.read_text(encoding="utf-8").count("from linksweep.plot.")


def test_missing_quantities_are_named(cycles):
    ds = cycles["press"]
    kinematics = ds[["theta3", "status"]]
    for draw, word in ((plot.forces, "F12"), (plot.torque, "T12"), (plot.bearing, "F32x"), (plot.cycle, "F12")):
        with pytest.raises(ValueError, match=f"sweep with of=.*{word}"):
            draw(kinematics)
    with pytest.raises(ValueError, match="of = 'F33': must be one of F12"):
        plot.bearing(ds, "F33")
    with pytest.raises(ValueError, match=r"frame = 'lnk'.*did you mean"):
        plot.bearing(ds, frame="lnk")
    with pytest.raises(ValueError, match="no dimension theta2"):
        plot.forces(ds.isel(theta2=0))


@pytest.mark.parametrize("wrong", [ls.example("press"), "cycle.nc", None])
@pytest.mark.parametrize("name", sorted({*plot.__all__} - OF_SCENES))
def test_anything_but_a_dataset_is_refused(name, wrong):
    arguments = {"heat_map": ("F32_peak",), "motor_load": (ls.Motor(speeds=(0.0, 600.0), torques=(4.0, 1.0)),)}
    words = {"scatter": {"x": "F32_peak", "y": "T12_peak"}}
    with pytest.raises(ValueError, match=r"^ds = .*: must be a Dataset, as from ls\."):
        getattr(plot, name)(wrong, *arguments.get(name, ()), **words.get(name, {}))


def test_a_film_of_peaks_is_refused():
    with pytest.raises(ValueError, match=r"scene has no dimension theta2: take what ls.sweep returns"):
        plot.animate(ls.peaks(ls.example("press"), theta2=36))


def test_import_does_not_import_matplotlib():
    code = "import sys, linksweep.plot.accessor; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
