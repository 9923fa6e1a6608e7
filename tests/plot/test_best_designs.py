"""Heat maps of samples, in bins, and the best of parallel coordinates: by what was asked for."""

import re
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from drawn import closed_figures, plt  # noqa: F401

import linksweep as ls

FLAGS = {"flag_values": np.arange(4, dtype=np.int8), "flag_meanings": "ok partial_revolution cannot_assemble unbounded"}
N = 500
RANDOM = np.random.default_rng(5)
CRANK, COUPLER = RANDOM.uniform(0.04, 0.06, N), RANDOM.uniform(0.2, 0.3, N)
FORCE, ANGLE = RANDOM.uniform(100.0, 200.0, N), RANDOM.uniform(20.0, 60.0, N)
SAMPLE = xr.Dataset(
    {
        "F32_peak": ("design", FORCE, {"units": "N"}),
        "transmission_angle_min": ("design", ANGLE, {"units": "degree"}),
        "transmission_angle_max": ("design", ANGLE + 30.0, {"units": "degree"}),
        "transmission_angle_peak": ("design", ANGLE + 30.0, {"units": "degree"}),
        "status": ("design", np.zeros(N, dtype=np.int8), FLAGS),
    },
    {
        "design": np.arange(N) + 7,
        "crank.length": ("design", CRANK, {"units": "m"}),
        "coupler.length": ("design", COUPLER, {"units": "m"}),
    },
)
PRESS = ls.example("press")


def legend(ax) -> list[str]:
    return [text.get_text() for text in ax.get_legend().get_texts()]


def cells(ax, shape) -> np.ndarray:
    return ax.collections[0].get_array().reshape(shape).filled(np.nan)


@pytest.mark.parametrize(
    ("statistic", "maximize", "reduce"),
    [
        ("best", False, np.min),
        ("mean", False, np.mean),
        pytest.param("best", True, np.max, marks=pytest.mark.long),
        pytest.param("worst", False, np.max, marks=pytest.mark.long),
        ("worst", True, np.min),
    ],
)
def test_a_bin_has_the_statistic_of_its_designs(statistic, maximize, reduce):
    ax = SAMPLE.linksweep.heat_map("F32_peak", bins=4, statistic=statistic, maximize=maximize)
    drawn, edges = cells(ax, (4, 4)), [np.linspace(v.min(), v.max(), 5) for v in (CRANK, COUPLER)]
    for row in range(4):
        for col in range(4):
            inside = np.ones(N, dtype=bool)
            for values, ends, k in ((CRANK, edges[0], row), (COUPLER, edges[1], col)):
                inside &= (values >= ends[k]) & ((values < ends[k + 1]) if k < 3 else True)
            assert drawn[row, col] == pytest.approx(reduce(FORCE[inside]), rel=1e-14)
    np.testing.assert_allclose(ax.collections[0].get_coordinates()[0, :, 0], edges[1])
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("coupler length [m]", "crank length [m]")
    assert plt.gcf().axes[1].get_ylabel() == f"{statistic} $F_{{32}}$ peak [N]"


def test_the_star_is_the_best_design_or_the_best_bin():
    ax = SAMPLE.linksweep.heat_map("F32_peak", x="crank.length", y="coupler.length")
    k = FORCE.argmin()
    assert ax.lines[0].get_xydata().tolist() == [[CRANK[k], COUPLER[k]]]
    assert legend(ax)[0].startswith(f"least: {FORCE[k]:.1f} N at crank length {CRANK[k]:.4g} m")
    ax = SAMPLE.linksweep.heat_map("F32_peak", bins=4, statistic="mean", maximize=True)
    drawn = cells(ax, (4, 4))
    assert legend(ax)[0].startswith(f"largest mean: {np.nanmax(drawn):.1f} N at ")


def test_bins_without_designs_and_without_sound_ones_are_told_apart():
    ds = SAMPLE.isel(design=slice(4)).assign_coords({
        "crank.length": ("design", [0.04, 0.04, 0.06, 0.06]), "coupler.length": ("design", [0.2, 0.3, 0.2, 0.2]),
    })  # fmt: skip
    ds["status"] = ("design", np.array([0, 2, 3, 1], dtype=np.int8), FLAGS)
    ds["F32_peak"] = ("design", [120.0, 1.0, 2.0, 130.0], {"units": "N"})
    ax = ds.linksweep.heat_map("F32_peak", bins=2)
    np.testing.assert_array_equal(cells(ax, (2, 2)), [[120.0, np.nan], [130.0, np.nan]])
    assert legend(ax)[1:] == ["cannot assemble", "no design"]
    assert legend(ax)[0].startswith("least: 120.0 N")


def test_a_result_may_be_an_axis_and_contours_are_means_in_bins():
    ax = SAMPLE.linksweep.heat_map("F32_peak", x="transmission_angle_min", y="crank.length", contours=True, bins=5)
    assert ax.get_xlabel() == "transmission angle min [°]"
    ax = SAMPLE.linksweep.heat_map("F32_peak", contours="transmission_angle_min", bins=3)
    assert legend(ax)[1] == "transmission angle min [°]"


def test_a_grid_and_a_sample_are_drawn_as_they_come():
    designs = ls.grid(PRESS, {"coupler.length": ("20 cm", "24 cm", 4), "rocker.length": ("16 cm", "20 cm", 3)})
    ds = ls.peaks(designs, of=["F32"], theta2=36)
    ax = ds.linksweep.heat_map("F32_peak", x="coupler.length")
    np.testing.assert_array_equal(cells(ax, (3, 4)), ds.F32_peak.transpose("rocker.length", "coupler.length"))
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("coupler length [m]", "rocker length [m]")
    drawn = ls.sample(PRESS, {"coupler.length": (0.2, 0.24), "rocker.length": (0.16, 0.2)}, n=64)
    ds = ls.peaks(drawn, of=["F32"], theta2=36)
    assert np.nanmin(cells(ds.linksweep.heat_map("F32_peak", bins=3), (3, 3))) == float(ds.F32_peak.min())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"x": "crank.lenth"}, "x: nothing is named 'crank.lenth'; did you mean \"crank.length\"?"),
        ({"bins": 0}, "bins = 0: must be a whole number"),
        ({"bins": 1}, "bins = 1: must be 2 or more"),
        ({"statistic": "least"}, "statistic = 'least': must be one of best, mean, worst"),
        ({"x": "crank.length", "y": "crank.length"}, "x and y are both 'crank.length': give two parameters"),
        ({"x": "transmission_angle_min"}, "y is missing: state two of the parameters over design"),
    ],
)
def test_what_is_no_map_of_a_sample_is_refused(options, message):
    with pytest.raises(ValueError, match=r".") as refused:
        SAMPLE.linksweep.heat_map("F32_peak", **options)
    assert str(refused.value).startswith(message)
    same = SAMPLE.assign_coords({"crank.length": 0.0 * SAMPLE["crank.length"]})
    with pytest.raises(ValueError, match=r"^crank.length is the same for all designs"):
        same.linksweep.heat_map("F32_peak")


def best_of(ax) -> tuple[str, list[int]]:
    text, _, numbers = legend(ax)[1].partition(": design ")
    return text, [int(number) for number in numbers.split(", ")]


def test_the_best_lines_are_best_by_what_is_asked_to_be_least_or_largest():
    lines = SAMPLE.linksweep.parallel_coordinates
    small, wide = np.argsort(FORCE)[:5] + 7, np.argsort(-ANGLE)[:5] + 7
    assert best_of(lines()) == ("best (least $F_{32}$ peak)", small.tolist())
    assert best_of(lines(minimize="F32_peak")) == best_of(lines(color="F32_peak")) == best_of(lines())
    ax = lines(maximize="transmission_angle_min", color="F32_peak")
    assert best_of(ax) == ("best (largest transmission angle min)", wide.tolist())
    assert plt.gcf().axes[1].get_ylabel() == "$F_{32}$ peak [N]"
    assert best_of(lines(["F32_peak", "transmission_angle_min"], maximize=True))[1] == wide.tolist()


def test_angles_are_shown_by_their_ends():
    names = [tick.get_text() for tick in SAMPLE.linksweep.parallel_coordinates().get_xticklabels()]
    assert names[2:] == ["$F_{32}$ peak\n[N]", "transmission\nangle min\n[°]", "transmission\nangle max\n[°]"]


def test_a_front_and_a_screening_know_what_was_asked_for():
    front = ls.pareto(SAMPLE, minimize=["F32_peak"], maximize=["transmission_angle_min"])
    assert (front.attrs["minimize"], front.attrs["maximize"]) == ("F32_peak", "transmission_angle_min")
    front = ls.pareto(front, maximize=["transmission_angle_min", "F32_peak"])
    assert front.attrs == {"maximize": "transmission_angle_min, F32_peak"}
    assert best_of(front.linksweep.parallel_coordinates())[0] == "best (largest transmission angle min)"
    lengths = {"coupler.length": (0.2, 0.24)}
    kept = ls.screen(PRESS, lengths, n=16, maximize="transmission_angle_min", of=["F32"], theta2=36)
    assert kept.attrs["maximize"] == "transmission_angle_min" and "minimize" not in kept.attrs
    with pytest.raises(ValueError, match=r"^state minimize or maximize, not both"):
        SAMPLE.linksweep.parallel_coordinates(minimize="F32_peak", maximize="F32_peak")
    with pytest.raises(ValueError, match=r"^minimize: nothing is named 'F33_peak'"):
        SAMPLE.linksweep.parallel_coordinates(minimize="F33_peak")


def test_a_map_over_narrow_ranges_tells_its_designs_apart():
    """The best design's numbers lead back to it, and nothing lies on the legend or on another number."""
    coupler, crank = (np.linspace(*ends, 9) for ends in ((0.2, 0.20001), (0.08, 0.080001)))
    study = ls.peaks(ls.grid(PRESS, {"coupler.length": coupler, "crank.length": crank}), of=["F32"], theta2=90)
    ax = ls.plot.heat_map(study, "F32_peak")
    best = study.F32_peak.argmin(["coupler.length", "crank.length"])
    value, *places = map(float, re.findall(r"[0-9]+\.[0-9]+", legend(ax)[0]))
    across, up = ax.get_xlabel(), ax.get_ylabel()
    places = dict(zip((across.split(" [")[0], up.split(" [")[0]), places, strict=True))
    assert abs(coupler - places["coupler length"]).argmin() == int(best["coupler.length"])
    assert abs(crank - places["crank length"]).argmin() == int(best["crank.length"])
    second = np.sort(study.F32_peak.values.ravel())[1]
    assert abs(value - float(study.F32_peak.min())) < 0.5 * (second - float(study.F32_peak.min()))
    ax.figure.canvas.draw()
    inside = [label for label in ax.get_xticklabels() if coupler[0] <= label.get_position()[0] <= coupler[-1]]
    ticks = [label.get_window_extent() for label in inside]
    assert len(ticks) > 2 and all(one.x1 < other.x0 for one, other in pairwise(ticks))
    axes = [axis for each in ax.figure.axes for axis in (each.xaxis, each.yaxis)]
    assert {axis.get_offset_text().get_text() for axis in axes} == {""}
    marks = [float(label.get_text()) for label in ax.get_yticklabels()]
    np.testing.assert_allclose(marks, ax.get_yticks(), rtol=1e-9)
