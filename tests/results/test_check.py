"""check: Grashof class, limits and toggles, against links that are turned by hand and against 60-digit arithmetic."""

from collections.abc import Iterable

import numpy as np
import pytest
import xarray as xr
from oracle import KINDS, close_loop, random_lengths
from oracle import FourBarData as Data
from references import LinkData as Bar
from references import Unassemblable, log_uniform, mp, turn

import linksweep as ls
from linksweep.chains.finding import ASSEMBLY
from linksweep.chains.on_crank.rrr import GRASHOF, TOGGLES

ROLES = ("crank", "coupler", "rocker")


def four_bar(lengths: Iterable, **options) -> ls.Scene:
    """Massless links of these lengths, crank, coupler, rocker, ground: numbers or DataArrays."""
    *moving, ground = lengths
    links = {role: ls.Link(length, 0.0, 0.0) for role, length in zip(ROLES, moving, strict=True)}
    return ls.Scene(ls.FourBar(**links, ground=ground, **options), omega2=1.0)


def batch(designs: np.ndarray, **options) -> ls.Scene:
    return four_bar([xr.DataArray(column, dims="design") for column in designs.T], **options)


def words(flag: xr.DataArray) -> list[str]:
    meanings = flag.attrs["flag_meanings"].split()
    assert flag.attrs["flag_values"].tolist() == list(range(len(meanings)))
    return [meanings[k] for k in flag.values.reshape(-1)]


def designs_of_all_kinds(seed: int, each: int) -> tuple[np.ndarray, list[str]]:
    """Random lengths at all scales, and the class that they were drawn from."""
    rng = np.random.default_rng(seed)
    kinds = [kind for kind in (*KINDS, "rocker_crank") for _ in range(each)]
    return np.array([np.array(random_lengths(rng, kind)) * log_uniform(rng, 1e-6, 1e3) for kind in kinds]), kinds


# ------------------------------------------------------------------------------------- Grashof's class


def turns_fully(turning: float, next_to_it: float, opposite: float, other_neighbour: float) -> bool:
    """Return whether one link turns all the way round against its neighbour, the other two held together by a pin.

    The chain is turned by hand: at every half degree the distance between the free ends must be one that the two
    remaining links span.
    """
    angle = np.radians(np.arange(0.0, 360.0, 0.5))
    distance = np.abs(next_to_it - turning * np.exp(1j * angle))
    return bool(((distance < opposite + other_neighbour) & (distance > abs(opposite - other_neighbour))).all())


def class_by_turning(crank: float, coupler: float, rocker: float, ground: float) -> str:
    """Return the Grashof class, from which links turn fully against their neighbours."""
    crank_turns = turns_fully(crank, ground, coupler, rocker)
    rocker_turns = turns_fully(rocker, ground, coupler, crank)
    coupler_turns = turns_fully(coupler, crank, rocker, ground) and turns_fully(coupler, rocker, crank, ground)
    return {
        (True, False, False): "crank_rocker",
        (True, True, False): "double_crank",
        (False, True, False): "rocker_crank",
        (False, False, True): "double_rocker",
        (False, False, False): "triple_rocker",
    }[crank_turns, rocker_turns, coupler_turns]


def test_grashof_class_is_what_turns_when_turned():
    designs, kinds = designs_of_all_kinds(1, each=12)
    limits = words(ls.check(batch(designs)).grashof)
    assert limits == [class_by_turning(*lengths) for lengths in designs] == kinds
    assert set(limits) == {*GRASHOF} - {"change_point"}


@pytest.mark.parametrize(
    "lengths",
    [
        *[
            (a, b, a, b) for a, b in ((1, 2), (0.1, 0.3), (0.07, 0.11), (0.03, 0.01), (1e-9, 3e-9), (1e6, 3e6))
        ],  # parallelograms
        (0.1, 0.1, 0.3, 0.3),
        (0.3, 0.1, 0.1, 0.3),
        (0.2, 0.2, 0.2, 0.2),
        (1.0, 2.0, 3.0, 4.0),
        (0.1, 0.2, 0.3, 0.4),  # not in floats, but surely meant
        (0.06, 0.1, 0.17, 0.21),
    ],
)
def test_a_change_point_is_one_whatever_the_rounding(lengths):
    assert words(ls.check(four_bar(lengths)).grashof) == ["change_point"]
    longer = [lengths[0] * (1 + 1e-12), *lengths[1:]]
    assert words(ls.check(four_bar(longer)).grashof) != ["change_point"]


def test_a_parallelogram_folds_at_both_dead_points_and_closes_everywhere():
    scene = four_bar((0.1, 0.3, 0.1, 0.3), ground_angle=25.0)
    limits = ls.check(scene)
    assert words(limits.assembly) == ["everywhere"]
    assert limits.toggle_angle.values.tolist() == [25.0, 205.0, 205.0, 25.0]
    assert limits.arc_start.values[0] == 0.0
    assert limits.arc_end.values[0] == 360.0
    assert np.isnan([limits.arc_start.values[1], limits.arc_end.values[1]]).all()
    assert limits.transmission_angle_min == 0.0
    status = words(ls.sweep(scene, theta2=[25.0, 26.0, 205.0, 206.0], of=["status"]).status)
    assert status == ["toggle", "ok", "toggle", "ok"]


# --------------------------------------------------------------------------------------------- limits


def limits_in_60_digits(lengths: np.ndarray, ground_angle: float) -> dict[str, list[float]]:
    """Crank angles [degree] from x at which coupler and rocker lie in one line, by the cosine rule."""
    a, b, c, d = map(mp.mpf, lengths.tolist())
    result = {}
    for name, diagonal in (("folded", abs(b - c)), ("stretched", b + c)):
        cos = (a**2 + d**2 - diagonal**2) / (2 * a * d)
        if abs(cos) <= 1:
            result[name] = [float(mp.mpf(ground_angle) + sign * mp.degrees(mp.acos(cos))) for sign in (1, -1)]
    return result


def apart(x, y):
    """Difference of angles [degree], turns left out."""
    return np.abs(np.mod(np.asarray(x) - np.asarray(y) + 180.0, 360.0) - 180.0)


def test_limits_and_toggles_against_60_digits():
    designs, _ = designs_of_all_kinds(2, each=8)
    rng = np.random.default_rng(2)
    ground_angle = np.where(rng.integers(2, size=len(designs)), rng.uniform(-720.0, 720.0, len(designs)), 0.0)
    limits = ls.check(batch(designs, ground_angle=xr.DataArray(ground_angle, dims="design")))
    assert limits.toggle.values.tolist() == ["folded", "stretched", "stretched_mirrored", "folded_mirrored"]
    seen = set()
    for k, lengths in enumerate(designs):
        expected = limits_in_60_digits(lengths, ground_angle[k])
        one = limits.isel(design=k)
        for name in ("folded", "stretched"):
            angles = one.toggle_angle.sel(toggle=[name, f"{name}_mirrored"]).values
            assert np.isnan(angles).all() == (name not in expected)
            if name in expected:
                assert (apart(angles, expected[name]) < 1e-10).all()
                assert ((angles >= 0.0) & (angles < 360.0)).all()
        ends = np.concatenate([one.arc_start.values, one.arc_end.values])
        if expected:  # every arc ends in a toggle
            toggles = np.concatenate(list(expected.values()))
            assert all(apart(end, toggles).min() < 1e-10 for end in ends[np.isfinite(ends)])
        seen.add((words(one.assembly)[0], *expected))
    assert seen == {
        ("everywhere",),
        ("partly", "folded"),
        ("partly", "stretched"),
        ("partly", "folded", "stretched"),
    }


def closes(lengths: Iterable[float], theta2: float, ground_angle: float) -> bool:
    """Return whether the oracle's two circles cross."""
    *moving, ground = map(float, lengths)
    try:
        close_loop(Data(*(Bar(x, 0.0, 0.0) for x in moving), ground=ground, ground_angle=ground_angle), theta2)
    except Unassemblable:
        return False
    return True


def test_the_loop_closes_on_the_arcs_and_nowhere_else():
    designs, _ = designs_of_all_kinds(3, each=4)
    ground_angle = np.linspace(-200.0, 400.0, len(designs))
    scene = batch(designs, ground_angle=xr.DataArray(ground_angle, dims="design"))
    limits = ls.check(scene)
    step = 1e-9  # degree to either side of an end
    for k, lengths in enumerate(designs):
        one = limits.isel(design=k)
        arcs = [
            (float(start), float(end))
            for start, end in zip(one.arc_start, one.arc_end, strict=True)
            if np.isfinite(start)
        ]
        assert all(start < end <= start + 360.0 for start, end in arcs)
        for start, end in arcs:
            assert closes(lengths, (start + end) / 2, ground_angle[k])
            if words(one.assembly) == ["partly"]:
                inside, outside = (start + step, end - step), (start - step, end + step)
                assert all(closes(lengths, angle, ground_angle[k]) for angle in inside)
                assert not any(closes(lengths, angle, ground_angle[k]) for angle in outside)


def test_the_status_of_a_sweep_is_ok_on_the_arcs():
    designs, _ = designs_of_all_kinds(4, each=6)
    impossible = np.array([[1.0, 1.0, 1.0, 3.5], [1.0, 4.0, 1.0, 1.0]])
    scene = batch(np.concatenate([designs, impossible]), ground_angle=-37.0)
    limits = ls.check(scene)
    angles = np.arange(0.0, 360.0, 0.7)
    status = ls.sweep(scene, theta2=angles, of=["status"]).status
    reach = np.mod(xr.DataArray(angles, dims="theta2") - limits.arc_start, 360.0)
    inside = (reach < limits.arc_end - limits.arc_start).any("arc").transpose("design", "theta2")
    np.testing.assert_array_equal(inside, status == 0)
    assert words(limits.assembly)[-2:] == ["never", "never"]
    assert limits.isel(design=[-2, -1])[["arc_start", "arc_end", "toggle_angle"]].to_array().isnull().all()
    assert limits.transmission_angle_min[-2:].isnull().all()
    assert words(ls.peaks(scene, theta2=90).status) == [
        {"everywhere": "ok", "partly": "partial_revolution", "never": "cannot_assemble"}[word]
        for word in words(limits.assembly)
    ]


# ------------------------------------------------------------------------------- transmission angle


def test_least_transmission_angle_against_a_dense_search():
    designs, _ = designs_of_all_kinds(5, each=8)
    limits = ls.check(batch(designs)).transmission_angle_min.values
    theta2 = np.linspace(0.0, 360.0, 40_001)
    for (a, b, c, d), least in zip(designs, limits, strict=True):
        f = np.abs(d - a * np.exp(1j * np.radians(theta2)))
        closed = (f < b + c) & (f > abs(b - c))
        angle = np.degrees(np.arccos((b**2 + c**2 - f[closed] ** 2) / (2 * b * c)))
        searched = np.minimum(angle, 180.0 - angle).min()
        if closed.all():  # the search has samples at 0 and 180 degrees, where the angle is least
            assert least == pytest.approx(searched, abs=1e-9)
        else:
            assert least == 0.0
            assert searched < 3.0  # the last sample before a toggle


def test_least_transmission_angle_is_that_of_the_sweep():
    scene = ls.example("press")
    angles = ls.sweep(scene, theta2=720, of=["transmission_angle"]).transmission_angle
    assert float(ls.check(scene).transmission_angle_min) == pytest.approx(float(angles.min()), abs=1e-9)


# -------------------------------------------------------------------------------------------- Dataset


def test_a_batch_has_the_dims_and_labels_of_its_lengths_only():
    crank = xr.DataArray([0.06, 0.08, 0.1], {"crank": ["s", "m", "l"]}, "crank")
    turned = xr.DataArray([0.0, 90.0], {"angle": [0, 90]}, "angle")
    links = {"coupler": ls.Link(0.22, xr.DataArray([1.0, 2.0], dims="mass"), 0.0), "rocker": ls.Link(0.18, 0.5, 0.0)}
    mechanism = ls.FourBar(ls.Link(crank, 0.1, 0.0), **links, ground=0.2, ground_angle=turned, branch="both")
    limits = ls.check(ls.Scene(mechanism, omega2=lambda theta2: 2.0 + np.cos(np.radians(theta2))))
    assert dict(limits.sizes) == {"crank": 3, "angle": 2, "arc": 2, "toggle": 4}
    assert limits.arc_start.dims == ("crank", "angle", "arc")
    assert limits.grashof.dims == limits.assembly.dims == limits.transmission_angle_min.dims == ("crank",)
    assert limits.crank.values.tolist() == ["s", "m", "l"]
    alone = ls.check(four_bar((0.08, 0.22, 0.18, 0.2), ground_angle=90.0))
    one = limits.sel(crank="m", angle=90)
    for name in alone.data_vars:
        assert one[name].variable.equals(alone[name].variable)


def test_a_single_design_has_no_dims_but_its_tables():
    limits = ls.check(ls.example("press"))
    assert limits.grashof.dims == limits.assembly.dims == limits.transmission_angle_min.dims == ()
    assert limits.arc_start.dims == limits.arc_end.dims == ("arc",)
    assert limits.toggle_angle.dims == ("toggle",)
    assert limits.toggle.values.tolist() == list(TOGGLES)
    assert words(limits.grashof) + words(limits.assembly) == ["crank_rocker", "everywhere"]
    assert {limits[name].attrs.get("units") for name in limits.data_vars} == {None, "degree"}
    assert all(limits[name].attrs["long_name"] for name in limits.data_vars)
    assert limits.assembly.attrs["flag_meanings"].split() == list(ASSEMBLY)


def test_document_1_is_a_triple_rocker_between_its_stretched_limits():
    limits = ls.check(four_bar((0.08, 0.12, 0.11, 0.22)))
    assert words(limits.grashof) + words(limits.assembly) == ["triple_rocker", "partly"]
    limit = float(limits.toggle_angle.sel(toggle="stretched"))
    position = abs(mp.mpf("0.22") - mp.mpf("0.08") * turn(limit))
    assert abs(position - mp.mpf("0.23")) < 1e-15
    assert limits.arc_end.values[0] - 360.0 == pytest.approx(limit, abs=1e-12)
