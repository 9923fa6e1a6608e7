"""Plots of mechanisms with a sliding link: drawn to scale, forces of their own joints, two turns, jammed arcs."""

import numpy as np
import pytest
import xarray as xr
from drawn import boxes, closed_figures, line, page_hides_nothing, plt, size_of, texts  # noqa: F401
from refusals import refusal

import linksweep as ls
from linksweep import plot
from linksweep.mechanisms import MECHANISMS
from linksweep.plot.kit.with_peaks import with_peaks

BAR = {"width": 0.02, "thickness": 0.02, "density": 7750.0}
GRAVITY = (0.0, -9.81)


def slider_crank(a=0.06, b=0.2, **options):
    return ls.SliderCrank(ls.Bar(a, **BAR), ls.Bar(b, **BAR), slider_mass=0.8, **options)


def engine(**options):
    crank, rod = ls.Disk(0.045, 0.06, 0.02, 7800.0), ls.Link(0.15, 0.6, 2.2e-3, cg_distance=0.05)
    return ls.SliderCrank(crank, rod, slider_mass=0.5, slide_angle=90.0, **options)


def pulse(theta2):
    """Return a gas force at the first of two upper dead centres."""
    return -2e4 * np.exp(-(((np.mod(theta2, 720.0) - 105.0) / 16.0) ** 2))


def shaper(**options):
    crank, rocker = ls.Disk(0.12, 0.2, 0.03, 7800.0), ls.Link(0.7, 18.0, 0.8, cg_distance=0.35)
    return ls.InvertedSliderCrank(crank, rocker, ground=0.36, block_mass=1.5, **options)


GAS = ls.Load("slider", force=(pulse, 0.0), frame="link")
SCENES = {
    "engine": ls.Scene(engine(friction=0.08), 300.0, gravity=GRAVITY, loads=[GAS]),
    "crossed": ls.Scene(
        slider_crank(offset=-0.05, branch="crossed", slide_angle=20.0, friction=0.1),
        40.0,
        gravity=GRAVITY,
        loads=[ls.Load("slider", force=(-50.0, 0.0))],
    ),
    "shaper": ls.Scene(shaper(ground_angle=-90.0), 6.0, gravity=GRAVITY, loads=[ls.Load("rocker", torque=-300.0)]),
    "offset rocker": ls.Scene(shaper(offset=0.05), 6.0, gravity=GRAVITY),
}
LIFT = ls.Load("slider", force=(0.0, 100.0))
JAMMED = ls.Scene(slider_crank(b=0.1, offset=0.03, friction=0.8), 20.0, gravity=GRAVITY, loads=[LIFT])


@pytest.fixture(scope="module")
def cycles():
    turns = {"engine": np.arange(0.0, 720.0, 1.0)}
    return {name: ls.sweep(scene, turns.get(name, 720)) for name, scene in SCENES.items()}


def points(ax, label):
    return np.transpose(line(ax, label).get_data())


def along(degrees):
    return np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])


def across(degrees):
    return along(degrees + 90.0)


@pytest.mark.parametrize("branch", ["open", "crossed"])
@pytest.mark.parametrize(("offset", "angle"), [(0.0, 90.0), (0.04, 0.0), (-0.05, 200.0)])
def test_slider_crank_is_drawn_to_scale(branch, offset, angle):
    scene = ls.Scene(slider_crank(offset=offset, slide_angle=angle, branch=branch), 10.0)
    ax = plot.mechanism(scene, theta2=60.0, point=(0.1, 15.0))
    assert ax.get_aspect() == 1.0
    A, B, C = points(ax, "_pins")
    np.testing.assert_allclose(A, 0.0)
    np.testing.assert_allclose(B, 0.06 * along(60.0))
    np.testing.assert_allclose(np.linalg.norm(C - B), 0.2)
    np.testing.assert_allclose(C @ across(angle), offset, atol=1e-15)
    assert ((C - B) @ along(angle) > 0.0) == (branch == "open")
    P = points(ax, "_point")[0]
    np.testing.assert_allclose(complex(*(P - B)) / complex(*(C - B)), 0.5 * np.exp(1j * np.radians(15.0)))
    assert np.linalg.norm(points(ax, "_coupler curve") - P, axis=1).min() < 1e-12
    text = {f"offset {abs(offset):g} m"} if offset else set()
    assert set(texts(ax)) == {"A", "B", "C", "P"} | text


@pytest.mark.parametrize(
    ("point", "message"),
    [
        ((-0.1, 0.0), "point[1] = -0.1 m: must be at least 0; for a point on the other side turn its angle"),
        ((np.nan, 0.0), "point[1] = nan m: must be finite and at least 0"),
        (0, "point = 0: must be a pair (distance in m, angle in degrees)"),
        ([], "point = []: must be a pair (distance in m, angle in degrees)"),
        ((0.1,), "point = (0.1,): must be a pair (distance in m, angle in degrees)"),
        ((xr.DataArray([0.1, 0.2], dims="k"), 0.0), "point[1]: has 1 dims: give one number"),
    ],
)
def test_a_point_that_is_none_is_refused(point, message):
    for draw in (plot.mechanism, plot.animate):
        (line,) = refusal(draw, ls.example("press"), point=point)
        assert line.startswith(message)


def test_a_point_is_named_by_texts_too():
    by_number, by_text = (plot.mechanism(SCENES["engine"], point=at) for at in ((0.1, 15.0), ("10 cm", "15 deg")))
    np.testing.assert_array_equal(points(by_text, "_point"), points(by_number, "_point"))


@pytest.mark.parametrize(("branch", "angle"), [("open", 90.0), ("crossed", 30.0)])
def test_the_piston_is_at_its_pin_and_the_guide_spans_its_stroke(branch, angle):
    mechanism = slider_crank(offset=0.03, slide_angle=angle, branch=branch)
    ax = plot.mechanism(ls.Scene(mechanism, 10.0), theta2=200.0)
    C = points(ax, "_pins")[2]
    corners = points(ax, "_block")
    np.testing.assert_allclose(corners[:4].mean(axis=0), C)
    sides = np.diff(corners, axis=0)
    half = np.abs((corners - C) @ along(angle))
    np.testing.assert_allclose(np.sort(np.abs(sides @ along(angle)))[:2], 0.0, atol=1e-15)
    cycle = ls.sweep(ls.Scene(mechanism, 10.0), 360)
    edges = [curve for curve in ax.lines if curve.get_label() == "_guide"]
    assert len(edges) == 2
    heights = []
    for edge in edges:
        ends = np.transpose(edge.get_data())
        np.testing.assert_allclose(*(ends @ across(angle)), rtol=1e-12)
        heights.append(ends[0] @ across(angle) - 0.03)
        reach = ends @ along(angle)
        assert reach.min() < cycle.x_slider.min() - half.max()
        assert reach.max() > cycle.x_slider.max() + half.max()
    np.testing.assert_allclose(sum(heights), 0.0, atol=1e-15)
    assert max(heights) > np.abs((corners - C) @ across(angle)).max()


@pytest.mark.parametrize(("branch", "offset"), [("open", 0.05), ("crossed", -0.02)])
def test_inverted_slider_crank_has_its_block_on_the_rocker(branch, offset):
    scene = ls.Scene(shaper(branch=branch, offset=offset), 6.0)
    ax = plot.mechanism(scene, theta2=70.0)
    A, B, D = points(ax, "_pins")
    np.testing.assert_allclose([A, B, D], [(0.0, 0.0), 0.12 * along(70.0), (0.36, 0.0)], atol=1e-15)
    corners = points(ax, "_block")
    np.testing.assert_allclose(corners[:4].mean(axis=0), B)
    base, tip = np.transpose([curve.get_data() for curve in ax.lines if curve.get_label() == "_link 4"][-1])
    way = (tip - base) / np.linalg.norm(tip - base)
    assert abs(np.cross([*way, 0.0], [*(B - base), 0.0])[2]) < 1e-15  # the block is on the rocker's line
    np.testing.assert_allclose(abs(np.cross([*way, 0.0], [*(D - base), 0.0])[2]), abs(offset))
    travel = np.hypot(*(0.12 * along(np.arange(360.0)) - D[:, None]))
    assert np.linalg.norm(tip - base) > np.sqrt(travel.max() ** 2 - offset**2)
    parallel = np.cross(np.append(corners[1] - corners[0], 0.0), [*way, 0.0])[2]
    assert abs(parallel) < 1e-15
    G = points(ax, "_centres")[2]  # of the rocker, after crank and block
    np.testing.assert_allclose(np.linalg.norm(G - D), 0.35)
    assert "$G_4$" in texts(ax)


def test_the_foot_of_a_leg_draws_the_curve_and_has_its_letter_alone():
    ax = plot.mechanism(ls.example("klann-leg"), theta2=100.0)
    assert sorted(texts(ax)) == [*"ABCDEFGH", "load 1: 150.0 N"]
    foot = ls.sweep(ls.example("klann-leg"), [100.0], of=["Hx", "Hy"])
    np.testing.assert_allclose(points(ax, "_point")[0], [foot.Hx.item(), foot.Hy.item()])


@pytest.mark.parametrize("name", SCENES)
def test_forces_are_those_of_the_joints(cycles, name):
    ds = with_peaks(cycles[name])
    ax = plot.forces(ds)
    joints = {"shaper": "ABsD", "offset rocker": "ABsD"}.get(name, "ABCg")
    legend = [text.get_text() for text in ax.get_legend().get_texts()]
    assert [text.split("(")[1][0] for text in legend] == list(joints)
    assert ax.get_ylabel() == f"pin and {'guide' if 'g' in joints else 'slide'} force [N]"
    for force in ("F12", "F32", "F43", "F14"):
        sizes = size_of(ds, force)
        (angle,), (value,) = line(ax, f"_peak {force}").get_data()
        assert value == pytest.approx(sizes.max(), rel=4.5e-16, abs=0.0)
        assert value == pytest.approx(sizes[ds.theta2.values == angle].item(), rel=4.5e-16, abs=0.0)
        text = next(row for text in texts(ax) for row in text.split("\n") if f"_{{{force[1:]}}}" in row)
        assert f"{np.format_float_positional(value, 4, unique=False, fractional=False).rstrip('.')} N" in text


@pytest.mark.parametrize(("drive", "torque"), [("crank", "T12"), ("coupler", "T13")])
def test_the_guides_moment_is_not_a_drive_torque(drive, torque):
    load = ls.Load("slider", force=(100.0, 0.0), at=(0.01, 90.0))
    ds = ls.sweep(ls.Scene(slider_crank(), 20.0, drive=drive, loads=[load]), 90)
    np.testing.assert_allclose(ds.T14, 1.0)  # 100 N at 10 mm
    ax = plot.torque(ds)
    assert f"_{{{torque[1:]}}}" in ax.get_ylabel()
    assert line(ax, f"_peak {torque}").get_ydata()[0] in (with_peaks(ds)[torque].max(), *ax.get_ylim())
    with pytest.raises(ValueError, match=f"no {torque}: sweep with of=.*'{torque}'"):
        plot.torque(ds[["T14", "status"]])


def test_torque_of_a_driven_rocker_is_its_T14(cycles):
    assert "_{12}" in plot.torque(cycles["shaper"]).get_ylabel()
    ds = ls.sweep(ls.Scene(shaper(), 6.0, drive="rocker", gravity=GRAVITY), theta2=np.arange(10.0, 80.0))
    assert "_{14}" in plot.torque(ds).get_ylabel()


def test_guide_axes_separate_normal_force_and_friction(cycles):
    for name in ("engine", "crossed"):
        scene, angles = SCENES[name], with_peaks(cycles[name]).theta2.values
        expected = ls.sweep(scene, angles, of=["friction_force", "normal_force"])
        ax = plot.bearing(cycles[name], "F14", frame="link")
        x, y = line(ax, "_locus F14").get_data()
        np.testing.assert_allclose(x[:-1], expected.friction_force, atol=1e-9 * np.abs(y).max())
        np.testing.assert_allclose(y[:-1], expected.normal_force, atol=1e-9 * np.abs(y).max())
        assert ax.get_xlabel() == "$F_{14}$ along the guide [N]"
        assert ax.get_ylabel() == "$F_{14}$ across the guide [N]"


def test_the_rods_axes_and_the_rockers():
    rod = ls.Link(0.2, mass=0.0, inertia=0.0)
    scene = ls.Scene(ls.SliderCrank(ls.Bar(0.06, **BAR), rod, slider_mass=0.8, friction=0.1), 30.0)
    x, y = line(plot.bearing(ls.sweep(scene), "F43", frame="link"), "_locus F43").get_data()
    assert np.abs(y).max() < 1e-12 * np.abs(x).max()  # a massless rod is pulled along itself
    ds = ls.sweep(SCENES["offset rocker"])
    x, y = line(plot.bearing(ds, "F34", frame="link"), "_locus F34").get_data()
    assert np.abs(x).max() < 1e-12 * np.abs(y).max()  # the block presses squarely on the rocker


def test_two_turns_are_one_cycle_of_a_four_stroke(cycles):
    ds = cycles["engine"]
    ax = plot.forces(ds)
    angles, values = ax.lines[0].get_data()
    assert (angles[0], angles[-1], len(angles)) == (0.0, 720.0, with_peaks(ds).sizes["theta2"] + 1)
    assert values[-1] == values[0]
    assert ax.get_xlim() == (0.0, 720.0)
    assert set(np.diff(ax.get_xticks())) == {90.0}
    assert 60.0 < line(ax, "_peak F43").get_xdata()[0] < 150.0  # ignition
    bearing = plot.bearing(ds, "F43")
    np.testing.assert_array_equal(points(bearing, "_ticks"), np.transpose([ds.F43x.values[::30], ds.F43y.values[::30]]))
    assert {"$\\theta_2$ = 0°", "90°", "450°", "630°"} < set(texts(bearing))


def test_an_ideal_cycle_is_drawn_over_its_own_period():
    gas = ls.GasPressure(bore=0.086, pressure=ls.OttoCycle(compression_ratio=10.0, peak_pressure=6e6))
    ds = ls.sweep(ls.Scene(engine(), 300.0, loads=[gas]))
    figure = plot.cycle(ds)
    assert figure.axes[1].get_xlim() == (0.0, 720.0)
    assert "Load of pin" in figure.axes[2].get_title(loc="left")
    page_hides_nothing(figure)


def test_half_of_two_turns_is_not_closed(cycles):
    half = cycles["engine"].isel(theta2=slice(0, 500))
    assert plot.forces(half).lines[0].get_xdata()[-1] == 499.0


def test_a_jammed_arc_is_shaded_and_labelled():
    ds = ls.sweep(JAMMED)
    jammed = ds.status.values == 4
    assert 0 < jammed.sum() < jammed.size
    assert not (ds.status.values[~jammed] != 0).any()
    ax = plot.forces(ds)
    last, first = ds.theta2.values[np.flatnonzero(np.diff(jammed.astype(int)))] + (0.0, 0.5)
    ((start, stop),) = [(patch.get_x(), patch.get_x() + patch.get_width()) for patch in ax.patches]
    assert last <= start < last + 0.5 and first - 0.5 < stop <= first  # forces without bound are marked where it jams
    assert [text.get_text() for text in ax.texts] == ["jammed"]


def test_a_jammed_mechanism_is_drawn_but_has_no_forces():
    ds = ls.sweep(JAMMED, 360)
    angle = ds.theta2.values[ds.status.values == 4][20]
    free = ls.Scene(slider_crank(b=0.1, offset=0.03), 20.0)
    pins = (points(plot.mechanism(scene, angle), "_pins") for scene in (JAMMED, free))
    np.testing.assert_array_equal(*pins)
    with pytest.raises(ValueError, match="no pin forces there, the mechanism is jammed by friction"):
        plot.mechanism(ds, angle, forces=True)


def test_a_narrow_gap_is_labelled_once():
    ds = ls.sweep(ls.Scene(engine(), 300.0, drive="coupler", loads=[ls.Load("crank", torque=-5.0)]))
    assert (ds.status.values == 3).sum() == 2
    for ax in (plot.forces(ds), plot.torque(ds)):
        assert texts(ax).count("dead centre") == 1
        ax.figure.canvas.draw()
        frame = ax.get_window_extent()
        assert all(frame.x0 <= box.x0 and box.x1 <= frame.x1 and box.y1 <= frame.y1 for box in boxes(ax))


@pytest.mark.parametrize("name", SCENES)
def test_nothing_on_the_page_hides_anything(cycles, name):
    figure = cycles[name].linksweep.cycle()
    assert figure.axes[2].get_title(loc="left").startswith("Load of pin ")
    page_hides_nothing(figure)


def test_one_design_of_many_is_drawn_by_its_own_slide_angle():
    angles = xr.DataArray([0.0, 40.0], dims="slide", coords={"slide": [0.0, 40.0]})
    loads = [ls.Load("slider", force=(-50.0, 0.0), frame="link")]
    many = ls.sweep(ls.Scene(slider_crank(slide_angle=angles), 20.0, loads=loads))
    with pytest.raises(ValueError, match=r"slide \(2\)"):
        plot.bearing(many, "F14", frame="link")
    x, y = line(plot.bearing(many.isel(slide=1), "F14", frame="link"), "_locus F14").get_data()
    assert np.abs(x).max() < 1e-9 * np.abs(y).max()  # without friction the guide pushes across itself


@pytest.mark.parametrize("kind", MECHANISMS.values())
def test_every_mechanism_can_be_drawn(kind):
    assert (kind.drawing is None) == (kind.track is not None)


def test_a_mechanism_without_a_drawing_has_plots_of_pin_forces_only(cycles, monkeypatch):
    monkeypatch.setattr(ls.SliderCrank, "drawing", None)
    assert plot.forces(cycles["crossed"]).get_ylabel() == "pin force [N]"  # without the guide, which is no pin
    plot.bearing(cycles["crossed"], "F32")
    for draw in (plot.mechanism, plot.cycle):
        with pytest.raises(ValueError, match="cannot draw a SliderCrank, which has no drawing of links"):
            draw(cycles["crossed"])
    with pytest.raises(ValueError, match="frame = 'journal': link 2 has no axes; take the ground's"):
        plot.bearing(cycles["crossed"], "F32", frame="journal")


def test_results_of_an_unregistered_mechanism_are_refused(cycles, monkeypatch):
    monkeypatch.delitem(MECHANISMS, "SliderCrank")
    for draw in (plot.forces, plot.bearing, plot.cycle):
        with pytest.raises(ValueError, match=r"ds: is of a SliderCrank; registered are FourBar, .*: register it"):
            draw(cycles["crossed"])


def test_a_car_in_a_loop_has_no_crank_to_plot_over():
    scene = ls.Scene(ls.LoopTrack(radius=30.0, mass=700.0), speed=100.0, thrust=10_000.0, gravity=GRAVITY)
    ds = ls.sweep(scene, 36)
    for draw in (plot.forces, plot.torque, plot.bearing, plot.mechanism):
        with pytest.raises(ValueError, match=r"cannot draw a LoopTrack, which has no drawing of links .plot\.loop"):
            draw(ds)
    with pytest.raises(ValueError, match="cannot draw a LoopTrack"):
        ls.save_drawing(scene, "loop.dxf", curves=[("crank", 0.02, 10.0)])
    assert [ax.get_ylabel() for ax in plot.cycle(ds).axes] == [ax.get_ylabel() for ax in plot.loop(ds).axes]


def test_forces_of_a_dataset_without_its_scene_are_drawn(cycles):
    lost = cycles["crossed"].drop_attrs(deep=False)
    ax = plot.forces(lost)
    assert len(ax.get_legend().get_texts()) == 4
    assert "_{12}" in plot.torque(lost).get_ylabel()


CLEAR = 7.5
"""Points from the middle of a digit to that of a symbol that leave it whole."""


@pytest.mark.parametrize("name", ["press", "quick-return"])
def test_no_symbol_hides_the_number_of_a_link(name):
    """In the demo's picture the number of the crank was half behind its centre of gravity."""
    figure = plot.cycle(ls.sweep(ls.example(name)))
    figure.canvas.draw()
    ax = figure.axes[0]
    symbols = np.concatenate([points(ax, label) for label in ("_pins", "_centres")])
    places = {text.get_text(): text.get_position() for text in ax.texts if text.get_text().isdigit()}
    assert {"2", "3", "4"} <= {*places}
    on_page = ax.transData.transform
    apart = np.linalg.norm(on_page(symbols)[:, None] - on_page([*places.values()]), axis=2)
    assert apart.min() > CLEAR * figure.dpi / 72.0
