"""Plots of studies show the studies' numbers: every cell, dot and line, the best, omitted designs, and units."""

import numpy as np
import pytest
import xarray as xr
from drawn import closed_figures, plt  # noqa: F401
from matplotlib.colors import LogNorm
from matplotlib.patches import PathPatch

import linksweep as ls
from linksweep.plot.kit.designs import whole
from linksweep.plot.kit.scales import span

MEANINGS = "ok partial_revolution cannot_assemble unbounded"
FLAGS = {"flag_values": np.arange(4, dtype=np.int8), "flag_meanings": MEANINGS}
CRANK, COUPLER = np.array([0.04, 0.05, 0.07]), np.array([0.2, 0.21, 0.23, 0.26])


def grid(values, status=None, **more) -> xr.Dataset:
    """Return a study over crank (3) and coupler (4) made by hand."""
    dims = ("crank", "coupler")
    status = np.zeros((3, 4), dtype=np.int8) if status is None else np.array(status, dtype=np.int8)
    variables = {"F32_peak": (dims, np.array(values, dtype=float), {"units": "N"}), "status": (dims, status, FLAGS)}
    coords = {
        "crank": CRANK,
        "crank.length": ("crank", CRANK, {"units": "m"}),
        "coupler": COUPLER,
        "coupler.length": ("coupler", COUPLER, {"units": "m"}),
        "rpm": ("crank", [100.0, 200.0, 300.0]),
    }
    return xr.Dataset({**variables, **{name: (dims, item) for name, item in more.items()}}, coords)


def sample(n, seed=0, **more) -> xr.Dataset:
    """Return a study of n designs made by hand: two lengths, two peaks between 100 and 200."""
    random = np.random.default_rng(seed)
    coords = {
        "design": np.arange(n) + 10,
        "crank.length": ("design", random.uniform(0.04, 0.06, n), {"units": "m"}),
        "coupler.length": ("design", random.uniform(0.2, 0.3, n), {"units": "m"}),
    }
    peaks = {
        "F32_peak": ("design", random.uniform(100.0, 200.0, n), {"units": "N"}),
        "F32_peak_at": ("design", random.uniform(0.0, 360.0, n), {"units": "degree"}),
        "T12_peak": ("design", random.uniform(100.0, 200.0, n), {"units": "N m"}),
        "status": ("design", np.zeros(n, dtype=np.int8), FLAGS),
    }
    return xr.Dataset(peaks | more, coords)


VALUES = np.arange(12.0).reshape(3, 4)[::-1] + 20.0


def mesh(ax):
    return ax.collections[0]


def legend(ax) -> list[str]:
    return [text.get_text() for text in ax.get_legend().get_texts()]


def colour_bar(ax):
    return next(other for other in ax.figure.axes if other is not ax)


def test_a_heat_map_shows_every_design_at_its_parameters():
    ax = ls.plot.heat_map(grid(VALUES), "F32_peak")
    np.testing.assert_array_equal(mesh(ax).get_array().reshape(3, 4), VALUES)
    corners = mesh(ax).get_coordinates()
    np.testing.assert_allclose(corners[0, :, 0], [0.195, 0.205, 0.22, 0.245, 0.275])
    np.testing.assert_allclose(corners[:, 0, 1], [0.035, 0.045, 0.06, 0.08])
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("coupler length [m]", "crank length [m]")
    assert colour_bar(ax).get_ylabel() == "$F_{32}$ peak [N]"
    assert mesh(ax).get_clim() == (20.0, 31.0)
    assert len(plt.get_fignums()) == 1


@pytest.mark.parametrize(
    ("maximize", "at", "message"), [(False, (2, 0), "least: 20.00 N"), (True, (0, 3), "largest: 31.00 N")]
)
def test_the_best_design_of_a_heat_map_is_marked(maximize, at, message):
    ax = grid(VALUES).linksweep.heat_map("F32_peak", maximize=maximize)
    (star,) = ax.lines
    assert star.get_xydata().tolist() == [[COUPLER[at[1]], CRANK[at[0]]]]
    assert legend(ax) == [f"{message} at coupler length {COUPLER[at[1]]:g} m, crank length {CRANK[at[0]]:g} m"]


def test_axes_can_be_chosen_and_are_in_order():
    shuffled = grid(VALUES).isel(crank=[1, 2, 0], coupler=[3, 0, 2, 1])
    ax = ls.plot.heat_map(shuffled, "F32_peak", x="rpm")
    np.testing.assert_array_equal(mesh(ax).get_array().reshape(4, 3), VALUES.T)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("rpm", "coupler length [m]")
    np.testing.assert_allclose(mesh(ax).get_coordinates()[0, :, 0], [50.0, 150.0, 250.0, 350.0])
    ax = ls.plot.heat_map(shuffled, "F32_peak", y="coupler.length")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("crank length [m]", "coupler length [m]")


def test_words_and_positions_along_the_axes():
    ds = grid(VALUES).drop_vars(["crank", "crank.length", "rpm"]).assign_coords(crank=["b", "a", "c"])
    ax = ls.plot.heat_map(ds, "F32_peak")
    assert [tick.get_text() for tick in ax.get_yticklabels()] == ["a", "b", "c"]
    np.testing.assert_array_equal(mesh(ax).get_array().reshape(3, 4), VALUES[[1, 0, 2]])
    assert legend(ax)[0].endswith(", crank c")
    bare = ds.drop_vars(["crank", "coupler", "coupler.length"])
    ax = ls.plot.heat_map(bare, "F32_peak")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("coupler", "crank")
    assert ax.get_xlim() == (-0.5, 3.5)


def test_designs_that_are_not_ok_are_hatched_by_their_status():
    values = VALUES.copy()
    values[0, :2] = 1.0  # better than any, but it cannot be assembled
    values[0, 3], values[1, 3], values[2, 1], values[2, 3] = np.nan, np.nan, np.inf, np.nan
    status = [[2, 2, 1, 1], [0, 0, 0, 2], [0, 3, 0, 0]]
    ax = ls.plot.heat_map(grid(values, status), "F32_peak")
    cells = mesh(ax).get_array().reshape(3, 4)
    ok = np.array([[0, 0, 1, 0], [1, 1, 1, 0], [1, 0, 1, 0]], dtype=bool)
    np.testing.assert_array_equal(~np.ma.getmaskarray(cells), ok)
    np.testing.assert_array_equal(cells[ok].data, values[ok])
    assert legend(ax)[1:] == ["partial revolution", "cannot assemble", "unbounded", "no value"]
    assert ax.lines[0].get_xydata().tolist() == [[COUPLER[0], CRANK[2]]]
    patches = {patch.get_label(): patch for patch in ax.patches if isinstance(patch, PathPatch)}
    cells = np.array([[(x, y) for x in COUPLER] for y in CRANK])
    codes = {"_partial_revolution": 1, "_cannot_assemble": 2, "_unbounded": 3}
    for label, patch in patches.items():
        covered = patch.get_path().contains_points(cells.reshape(-1, 2)).reshape(3, 4)
        expected = ~ok & (np.array(status) == codes.get(label, 0))
        np.testing.assert_array_equal(covered, expected)
        assert (label == "_no value") == (not patch.get_hatch())
    assert len({patch.get_hatch() for patch in patches.values()}) == 4
    left = ls.plot.heat_map(grid(VALUES).where(VALUES < 30.0), "F32_peak")  # omitted by the user
    assert legend(left)[1:] == ["no value"]


def test_a_status_over_several_dims_and_over_none():
    ds = grid(VALUES)
    worst = xr.zeros_like(ds.status).expand_dims(rpm2=2).copy()
    worst[0, 0, 0], worst[1, 0, 0] = 1, 2
    ax = ls.plot.heat_map(ds.assign(status=worst.assign_attrs(FLAGS)), "F32_peak")
    assert np.ma.getmaskarray(mesh(ax).get_array()).reshape(3, 4).tolist() == (VALUES == 28.0).tolist()
    assert not np.ma.getmaskarray(mesh(ls.plot.heat_map(ds.drop_vars("status"), "F32_peak")).get_array()).any()


def test_outliers_are_off_the_scale_and_several_decades_are_logarithmic():
    usual = np.linspace(100.0, 200.0, 96)
    assert span(usual) == (100.0, 200.0)
    low, high = span(np.append(usual, [1e30]))
    assert low == 100.0 and 190.0 < high < 200.0
    assert span(np.append(usual, -1e30))[0] > 100.0
    values = VALUES.copy()
    values[0, 0] = 1e9
    ds = grid(values)
    many = xr.concat(
        [ds.assign_coords(crank=CRANK + k, **{"crank.length": ("crank", CRANK + k)}) for k in range(8)], "crank"
    )
    many["F32_peak"][3:] = np.tile(VALUES, (7, 1))
    ax = ls.plot.heat_map(many, "F32_peak")
    assert mesh(ax).get_clim()[1] < 32.0 and mesh(ax).colorbar.extend == "max"
    ax = ls.plot.heat_map(grid(10.0 ** (VALUES - 20.0)), "F32_peak")
    assert isinstance(mesh(ax).norm, LogNorm) and mesh(ax).get_clim() == (1.0, 1e11)


def test_contours_lie_where_their_values_are():
    plane = 1000.0 * COUPLER[None, :] + 100.0 * CRANK[:, None]  # linear in both, so that lines are exact
    ax = ls.plot.heat_map(grid(VALUES, angle=plane), "F32_peak", contours="angle")
    lines = ax.collections[1]
    assert len(lines.levels) > 2 and legend(ax)[1] == "angle"
    for level, path in zip(lines.levels, lines.get_paths(), strict=True):
        x, y = path.vertices.T
        np.testing.assert_allclose(1000.0 * x + 100.0 * y, level)
    own = ls.plot.heat_map(grid(plane), "F32_peak", contours=True)
    np.testing.assert_array_equal(own.collections[1].levels, lines.levels)
    assert len(legend(own)) == 1  # the colour bar states it
    assert len(ls.plot.heat_map(grid(VALUES * 0.0 + 5.0), "F32_peak", contours=True).collections) >= 1


def test_a_scatter_shows_every_design_and_the_front():
    ds = sample(200)
    ax = ls.plot.scatter(ds, x="F32_peak", y="T12_peak")
    np.testing.assert_array_equal(ax.collections[0].get_offsets(), np.stack([ds.F32_peak, ds.T12_peak], axis=-1))
    points = [(float(x), float(y)) for x, y in zip(ds.F32_peak, ds.T12_peak, strict=True)]
    front = sorted(p for p in points if not any(q[0] <= p[0] and q[1] <= p[1] and q != p for q in points))
    assert [tuple(point) for point in ax.lines[0].get_xydata().tolist()] == front
    assert ax.lines[0].get_drawstyle() == "steps-post"
    assert legend(ax) == ["200 designs", f"Pareto front: {len(front)} designs"]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$F_{32}$ peak [N]", "$T_{12}$ peak [N m]")
    assert len(plt.get_fignums()) == 1


def test_a_scatter_may_maximize():
    ds = sample(50)
    ax = ds.linksweep.scatter(x="crank.length", y="T12_peak", maximize="crank.length")
    drawn = ax.lines[0].get_xydata()
    front = ls.pareto(ds, minimize=["T12_peak"], maximize=["crank.length"])
    assert sorted(map(tuple, drawn)) == sorted(zip(front["crank.length"].values, front.T12_peak.values, strict=True))
    assert (np.diff(drawn[:, 0]) <= 0.0).all()
    assert not ls.plot.scatter(ds, x="F32_peak", y="T12_peak", front=False).lines


def test_colours_and_omitted_designs_of_a_scatter():
    ds = sample(30)
    ds["status"][:5] = [2, 2, 3, 2, 1]
    ds["T12_peak"][4] = np.nan
    ds["F32_peak"][5] = np.inf
    ax = ls.plot.scatter(ds, x="F32_peak", y="T12_peak", color="crank.length")
    np.testing.assert_array_equal(ax.collections[0].get_array(), ds["crank.length"][6:])
    assert len(ax.collections[0].get_offsets()) == 24
    assert colour_bar(ax).get_ylabel() == "crank length [m]"
    assert legend(ax)[0] == "24 designs that are ok"


def test_a_scatter_keeps_the_front_on_its_scale_and_may_be_logarithmic():
    ds = sample(100)
    ds["F32_peak"][7], ds["T12_peak"][7] = 1.0, 1e6  # alone out there, but on the front
    ax = ls.plot.scatter(ds, x="F32_peak", y="T12_peak")
    assert ax.get_xscale() == ax.get_yscale() == "log"
    assert ax.get_xlim()[0] < 1.0 and ax.get_ylim()[1] > 1e6
    ds["F32_peak"][8], ds["T12_peak"][7] = 1e6, 150.0
    assert ls.plot.scatter(ds, x="F32_peak", y="T12_peak").get_xlim()[1] < 1000.0


def test_a_scatter_of_very_many_designs_is_thinned_with_a_note():
    ds = sample(100_000)
    ax = ls.plot.scatter(ds, x="F32_peak", y="T12_peak")
    points = {tuple(point) for point in ax.collections[0].get_offsets().data}
    assert len(points) == 20_000
    assert points <= set(zip(ds.F32_peak.values, ds.T12_peak.values, strict=True))
    assert {tuple(point) for point in ax.lines[0].get_xydata()} <= points
    front = ls.pareto(ds, minimize=["F32_peak", "T12_peak"])
    np.testing.assert_array_equal(ax.lines[0].get_xdata(), front.F32_peak)
    assert legend(ax)[0] == f"{whole(20_000)} of {whole(100_000)} designs, chosen by chance"
    lines = ls.plot.parallel_coordinates(ds)
    assert len(lines.collections[0].get_segments()) == 1500
    assert legend(lines)[0] == f"1\N{THIN SPACE}500 of {whole(100_000)} designs, chosen by chance"
    best = ds.design.values[np.argsort(ds.F32_peak.values)[:5]]
    assert legend(lines)[1] == f"best (least $F_{{32}}$ peak): design {', '.join(map(str, best))}"


def axis_names(ax) -> list[str]:
    return [tick.get_text() for tick in ax.get_xticklabels()]


def test_parallel_coordinates_pass_each_axis_at_the_designs_value():
    ds = sample(40)
    ax = ls.plot.parallel_coordinates(ds)
    names = ["crank.length", "coupler.length", "F32_peak", "T12_peak"]
    assert axis_names(ax) == ["crank length\n[m]", "coupler length\n[m]", "$F_{32}$ peak\n[N]", "$T_{12}$ peak\n[N m]"]
    values = np.stack([ds[name].values for name in names], axis=-1)
    heights = (values - values.min(axis=0)) / np.ptp(values, axis=0)
    worst_first = np.argsort(-ds.F32_peak.values)
    drawn = np.array(ax.collections[0].get_segments())
    np.testing.assert_allclose(drawn[:, :, 1], heights[worst_first], atol=1e-12)
    np.testing.assert_array_equal(drawn[0, :, 0], range(4))
    np.testing.assert_array_equal(ax.collections[0].get_array(), ds.F32_peak.values[worst_first])
    assert colour_bar(ax).get_ylabel() == "$F_{32}$ peak [N]"
    marked = [line.get_ydata() for line in ax.lines[:5]]
    np.testing.assert_allclose(marked, heights[worst_first[::-1][:5]], atol=1e-12)
    assert len(plt.get_fignums()) == 1


def test_numbers_on_the_axes_are_at_their_heights():
    ds = sample(40)
    ax = ls.plot.parallel_coordinates(ds, ["F32_peak", "T12_peak"], best=0)
    low, high = float(ds.F32_peak.min()), float(ds.F32_peak.max())
    ticks = [note for note in ax.texts if note.xy[0] == 0]
    assert len(ticks) > 2
    for note in ticks:
        assert note.xy[1] == pytest.approx((float(note.get_text()) - low) / (high - low))


def test_axes_of_parallel_coordinates():
    ds = sample(40)
    ax = ds.linksweep.parallel_coordinates(["T12_peak", "coupler.length"], color="F32_peak", maximize=True, best=2)
    order = np.argsort(-ds.F32_peak.values)
    assert legend(ax) == ["40 designs", f"best (largest $F_{{32}}$ peak): design {order[0] + 10}, {order[1] + 10}"]
    np.testing.assert_array_equal(ax.collections[0].get_array(), ds.F32_peak.values[order[::-1]])
    assert (
        ls.plot.parallel_coordinates(ds, ["T12_peak", "F32_peak"], best=0).get_legend().get_texts()[-1].get_text()
        == "40 designs"
    )


def test_parallel_coordinates_of_several_dims_words_and_far_away_designs():
    ds = grid(VALUES).expand_dims(branch=["open", "crossed"])
    ax = ls.plot.parallel_coordinates(ds, ["branch", "crank.length", "F32_peak"])
    assert len(ax.collections[0].get_segments()) == 24
    assert {note.get_text() for note in ax.texts if note.xy[0] == 0} == {"open", "crossed"}
    assert legend(ax)[1] == "best (least $F_{32}$ peak): branch = open, crank = 0.07, coupler = 0.2"
    far = sample(100)
    far["F32_peak"][3] = 1e9
    ax = ls.plot.parallel_coordinates(far)
    assert [line.get_label() for line in ax.lines if line.get_label().startswith("_beyond")] == ["_beyond F32_peak"]
    heights = np.array(ax.collections[0].get_segments())[:, 2, 1]
    assert heights.max() == pytest.approx(1.04) and (np.sort(heights)[:-5] <= 1.0).all()


def test_plots_of_a_computed_study_on_given_axes():
    may_be = {"coupler.length": (0.2, 0.24), "rocker.length": (0.16, 0.2)}
    study = ls.peaks(ls.sample(ls.example("press"), may_be, n=16), of=["F32", "T12"], theta2=36)
    figure, (left, right) = plt.subplots(1, 2)
    assert ls.plot.scatter(study, x="F32_peak", y="T12_peak", ax=left) is left
    assert ls.plot.parallel_coordinates(study, ax=right) is right
    assert axis_names(right)[:2] == ["coupler length\n[m]", "rocker length\n[m]"]
    figure.canvas.draw()
    assert plt.get_fignums() == [figure.number]


GRID, SAMPLE = grid(VALUES), sample(8)
OVER_ANGLE = xr.Dataset({"F32": (("design", "theta2"), np.ones((2, 3)))})


@pytest.mark.parametrize(
    ("draw", "message"),
    [
        (lambda: ls.plot.heat_map(3, "F32_peak"), "ds = 3: must be a Dataset, as from ls.peaks of several designs"),
        (lambda: ls.plot.heat_map(GRID, "F32_peek"), "of: nothing is named 'F32_peek'; did you mean \"F32_peak\"?"),
        (
            lambda: ls.plot.heat_map(GRID, "F32_peak", x="crank.lenght"),
            "x: nothing is named 'crank.lenght'; did you mean",
        ),
        (
            lambda: ls.plot.heat_map(GRID, "F32_peak", x="crank", y="rpm"),
            "x = 'crank' and y = 'rpm' both lie along crank",
        ),
        (
            lambda: ls.plot.heat_map(SAMPLE.isel(design=0), "F32_peak"),
            "F32_peak depends on no dim: a heat map takes a result over two dims, or a sample",
        ),
        (
            lambda: ls.plot.heat_map(GRID.expand_dims(rpm3=2), "F32_peak"),
            "F32_peak depends on rpm3, crank, coupler: a heat map takes a result over two dims, or a sample; "
            "choose one of the others, such as ds.isel({'rpm3': 0})",
        ),
        (
            lambda: ls.plot.heat_map(GRID.isel(crank=[0]), "F32_peak"),
            "crank.length has [0.04] along crank: must be two",
        ),
        (lambda: ls.plot.heat_map(GRID.isel(crank=[0, 0]), "F32_peak"), "crank.length has [0.04, 0.04] along crank"),
        (lambda: ls.plot.heat_map(GRID, "F32_peak", contours="angle"), "contours: nothing is named 'angle'"),
        (
            lambda: ls.plot.heat_map(GRID.assign(angle=GRID.F32_peak.expand_dims(k=2)), "F32_peak", contours="angle"),
            "contours: angle depends on k as well, and the map does not",
        ),
        (
            lambda: ls.plot.heat_map(grid(VALUES, np.full((3, 4), 2)), "F32_peak"),
            "no design is ok and has a finite F32_peak (status: 12 cannot_assemble); to plot all that is finite",
        ),
        (
            lambda: ls.plot.heat_map(GRID.where(GRID.F32_peak < 0.0), "F32_peak"),
            "no design is ok and has a finite F32_peak (status: 12 no value)",
        ),
        (
            lambda: ls.plot.heat_map(GRID.assign(word=GRID.F32_peak.astype(str)), "word"),
            "of: word holds <U32 values, which must be numbers",
        ),
        (lambda: ls.plot.heat_map(OVER_ANGLE, "F32"), "of: F32 depends on theta2, and must not; ls.peaks"),
        (
            lambda: ls.plot.scatter(SAMPLE, x="F32", y="T12_peak"),
            "x: nothing is named 'F32'; did you mean \"F32_peak\"?",
        ),
        (lambda: ls.plot.scatter(SAMPLE, x="F32_peak", y="T12_peak", color=3), "color: nothing is named 3"),
        (
            lambda: ls.plot.scatter(SAMPLE, x="F32_peak", y="T12_peak", maximize=["crank.length"]),
            "maximize: crank.length is neither x nor y",
        ),
        (
            lambda: ls.plot.scatter(SAMPLE.isel(design=0), x="F32_peak", y="T12_peak"),
            "ds holds one design: give it a dimension of designs",
        ),
        (
            lambda: ls.plot.scatter(SAMPLE.assign(T12_peak=SAMPLE.T12_peak * np.nan), x="F32_peak", y="T12_peak"),
            "no design is ok and has a finite F32_peak and T12_peak (status: 8 ok)",
        ),
        (
            lambda: ls.plot.parallel_coordinates(SAMPLE, ["F32_peak"]),
            "of: there are 1, ['F32_peak']; must be from 2",
        ),
        (lambda: ls.plot.parallel_coordinates(SAMPLE, ["F32_peak", "no"]), "of: nothing is named 'no'"),
        (lambda: ls.plot.parallel_coordinates(SAMPLE, best=-1), "best = -1: must be a whole number"),
        (lambda: ls.plot.parallel_coordinates(SAMPLE, color="colour"), "color: nothing is named 'colour'"),
    ],
)
def test_refusals_come_before_a_figure_is_made(draw, message):
    with pytest.raises(ValueError) as error:  # noqa: PT011
        draw()
    assert str(error.value).startswith(message)
    assert not plt.get_fignums()
