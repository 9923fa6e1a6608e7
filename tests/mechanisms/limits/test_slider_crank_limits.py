"""Angles at which a slider-crank closes or friction wedges it, and its limits: no friction, an endless rocker."""

import numpy as np
import pytest
import xarray as xr
from oracle_slider_crank import KINDS, random_lengths
from references import BRANCHES, log_uniform, mp

import linksweep as ls

SIDES = ["upper", "upper_beyond", "lower_beyond", "lower"]
JAMMED = [ls.SliderCrank.status_meanings.index(word) for word in ("jammed", "jammed_two_solutions")]


def bare(lengths, **options) -> ls.Scene:
    """Massless links of these lengths, crank, rod, offset: numbers or DataArrays."""
    crank, rod, offset = lengths
    bars = ls.Link(crank, 0.0, 0.0), ls.Link(rod, 0.0, 0.0)
    return ls.Scene(ls.SliderCrank(*bars, 0.0, offset=offset, **options), omega2=1.0)


def batch(designs: np.ndarray, **options) -> ls.Scene:
    columns = {name: xr.DataArray(values, dims="design") for name, values in options.items()}
    return bare([xr.DataArray(column, dims="design") for column in designs.T], **columns)


def words(flag: xr.DataArray) -> list[str]:
    meanings = flag.attrs["flag_meanings"].split()
    return [meanings[k] for k in flag.values.reshape(-1)]


def random_designs(seed: int, each: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lengths of both kinds at all scales, directions of the guide, coefficients of friction."""
    rng = np.random.default_rng(seed)
    designs = [np.array(random_lengths(rng, kind)) * log_uniform(rng, 1e-5, 1e2) for kind in KINDS * each]
    count = len(designs)
    slide_angle = np.where(rng.integers(2, size=count), rng.uniform(-720.0, 720.0, count), 0.0)
    return np.array(designs), slide_angle, rng.uniform(0.1, 2.0, count) * rng.integers(2, size=count)


def apart(x, y):
    """Difference of angles [degree], turns left out."""
    return np.abs(np.mod(np.asarray(x) - np.asarray(y) + 180.0, 360.0) - 180.0)


# ---- where it closes -----


def where_the_rod_stands_square(lengths: np.ndarray, slide_angle: float) -> list[float]:
    """Crank angles [degree] at which the crank's height over the guide's foot is e + b (upper) or e - b (lower).

    In 60 digits; NaN where the crank does not reach so high.
    """
    a, b, e = map(mp.mpf, lengths.tolist())
    result = []
    for height in (e + b, e - b):
        here = float(mp.degrees(mp.asin(height / a))) if abs(height) < a else np.nan
        result.append([slide_angle + here, slide_angle + 180.0 - here])
    (upper, upper_beyond), (lower, lower_beyond) = result
    return [upper, upper_beyond, lower_beyond, lower]


def test_toggles_and_arcs_against_60_digits():
    designs, slide_angle, _ = random_designs(2, each=20)
    limits = ls.check(batch(designs, slide_angle=slide_angle))
    assert limits.side.values.tolist() == SIDES
    seen = set()
    for k, lengths in enumerate(designs):
        expected, one = np.array(where_the_rod_stands_square(lengths, slide_angle[k])), limits.isel(design=k)
        np.testing.assert_array_equal(np.isnan(one.toggle_angle), np.isnan(expected))
        known = expected[np.isfinite(expected)]
        toggles = one.toggle_angle.values[np.isfinite(expected)]
        assert (apart(toggles, known) < 1e-10).all()
        assert ((toggles >= 0.0) & (toggles < 360.0)).all()
        ends = np.concatenate([one.arc_start, one.arc_end])
        ends = ends[np.isfinite(ends)]
        assert len(ends) == max(2, len(known))
        assert all(apart(end, known).min() < 1e-10 for end in ends if len(known))
        seen.add((words(one.assembly)[0], len(known)))
    assert seen == {("everywhere", 0), ("partly", 2), ("partly", 4)}


def test_closes_on_its_arcs_and_nowhere_else():
    """The sweep's status, just inside and just outside the ends of each arc and in its middle."""
    designs, slide_angle, _ = random_designs(3, each=8)
    limits = ls.check(batch(designs, slide_angle=slide_angle))
    for k, lengths in enumerate(designs):
        one, scene = limits.isel(design=k), bare(lengths, slide_angle=float(slide_angle[k]))
        for start, end in zip(one.arc_start.values, one.arc_end.values, strict=True):
            if np.isfinite(start):
                assert 0.0 <= start < 360.0 and start < end <= start + 360.0
                inside = [start + 1e-6, 0.5 * (start + end), end - 1e-6]
                assert words(ls.sweep(scene, inside, of=["status"]).status) == ["ok"] * 3
                if one.assembly != 0:
                    outside = ls.sweep(scene, [start - 1e-6, end + 1e-6], of=["status"]).status
                    assert words(outside) == ["cannot_assemble"] * 2


@pytest.mark.parametrize(("slide_angle", "upper", "lower"), [(0.0, 210.0, 330.0), (60.0, 270.0, 30.0)])
def test_a_rod_shorter_than_crank_and_offset_by_hand(slide_angle, upper, lower):
    """Crank 2, rod 2, guide 1 m up: the crank pin may hang 1 m below A, at 30 degree, and no lower."""
    limits = ls.check(bare((2.0, 2.0, 1.0), slide_angle=slide_angle))
    assert words(limits.assembly) == ["partly"]
    np.testing.assert_allclose(limits.toggle_angle, [np.nan, np.nan, upper, lower], rtol=1e-14)
    np.testing.assert_allclose(limits.arc_start, [lower, np.nan], rtol=1e-14)
    np.testing.assert_allclose(limits.arc_end, [lower + 240.0, np.nan], rtol=1e-14)
    assert limits.transmission_angle_min == limits.friction_to_jam == 0.0


def test_one_that_never_closes_spoils_no_other():
    designs = np.array([[1.0, 3.0, 0.5], [1.0, 2.0, 3.5], [1.0, 2.0, -3.5]])
    limits = ls.check(batch(designs, friction=np.full(3, 0.5)))
    assert words(limits.assembly) == ["everywhere", "never", "never"]
    for name in ("arc_start", "arc_end", "toggle_angle", "jam_angle", "transmission_angle_min", "friction_to_jam"):
        assert np.isnan(limits[name].values[1:]).all(), name
    status = ls.sweep(batch(designs), 90, of=["status"]).status
    assert [set(words(one)) for one in status] == [{"ok"}, {"cannot_assemble"}, {"cannot_assemble"}]
    with pytest.raises(ValueError, match=r"offset = -3\.5 m is 0\.5 m beyond the reach"):
        bare((1.0, 2.0, -3.5))


# ---- where friction wedges it -----


def edges_of_wedging(scene: ls.Scene) -> list[float]:
    """Crank angles [degree] between which the sweep's status goes from ok to jammed, or back."""

    def refined(low: float, high: float) -> list[float]:
        angles = np.linspace(low, high, 721)
        status = ls.sweep(scene, angles, of=["status"]).status.values
        turns = np.flatnonzero((status[:-1] != status[1:]) & np.isin(status[:-1] + status[1:], JAMMED))
        if high - low < 1e-9:
            return [0.5 * (low + high)] if turns.size else []
        return [edge for k in turns for edge in refined(angles[k], angles[k + 1])]

    return refined(0.123, 360.123)


@pytest.mark.parametrize("branch", BRANCHES)
def test_jam_angles_are_where_the_status_turns(branch):
    designs, slide_angle, friction = random_designs(4, each=12)
    limits = ls.check(batch(designs, slide_angle=slide_angle, friction=friction))
    counts = set()
    for k, lengths in enumerate(designs):
        one = limits.jam_angle.isel(design=k).values
        scene = bare(lengths, slide_angle=float(slide_angle[k]), friction=float(friction[k]), branch=branch)
        edges, angles = edges_of_wedging(scene), one[np.isfinite(one)]
        assert len(angles) == len(edges)
        assert all(apart(angle, edges).min() < 1e-7 for angle in angles)
        counts.add(len(edges))
    assert counts == {0, 2, 4}


def test_jam_angles_against_60_digits():
    """μ·|tan ψ| = 1: the crank's height over the guide is then b/√(1 + μ²)."""
    designs, slide_angle, friction = random_designs(5, each=12)
    limits = ls.check(batch(designs, slide_angle=slide_angle, friction=friction)).jam_angle.values
    for k, (a, b, e) in enumerate(designs.tolist()):
        short = np.array([a, float(b / mp.sqrt(1 + mp.mpf(friction[k]) ** 2)), e])
        expected = np.array(where_the_rod_stands_square(short, slide_angle[k]))
        expected[:] = expected if friction[k] else np.nan
        np.testing.assert_array_equal(np.isnan(limits[k]), np.isnan(expected))
        finite = np.isfinite(expected)
        flat = abs(np.cos(np.radians(expected - slide_angle[k])))  # 0 where the crank just reaches so high
        assert (apart(limits[k], expected) * flat < 1e-10)[finite].all()


def test_the_friction_that_jams():
    """A little less jams at no angle, a little more at the crank's worst, square to the guide."""
    designs, slide_angle, _ = random_designs(6, each=10)
    limits = ls.check(batch(designs, slide_angle=slide_angle))
    for k, lengths in enumerate(designs):
        least = float(limits.friction_to_jam[k])
        assert (least == 0.0) == (limits.assembly[k] != 0)
        if least:
            square, scene = slide_angle[k] + np.array([90.0, 270.0]), bare(lengths, slide_angle=float(slide_angle[k]))
            flattest = ls.sweep(scene, square, of=["transmission_angle"]).transmission_angle.min().item()
            assert limits.transmission_angle_min[k].item() == pytest.approx(flattest, rel=1e-10)
            assert least == pytest.approx(np.tan(np.radians(flattest)), rel=1e-10)
            angles = np.concatenate([square, np.linspace(0, 360, 97)])
            for share, jams in ((1 - 1e-9, False), (1 + 1e-9, True)):
                scene = bare(lengths, slide_angle=float(slide_angle[k]), friction=share * least)
                status = ls.sweep(scene, angles, of=["status"]).status.values
                assert np.isin(status, JAMMED).any() == jams
                assert np.isfinite(ls.check(scene).jam_angle).any() == jams


def test_findings_have_only_the_dims_of_their_numbers():
    friction = xr.DataArray([0.0, 0.8, 5.0], {"mu": [0.0, 0.8, 5.0]}, "mu")
    limits = ls.check(bare((1.0, 3.0, 0.2), friction=friction))
    assert limits.assembly.dims == () and limits.toggle_angle.dims == ("side",) and limits.arc_start.dims == ("arc",)
    assert limits.jam_angle.dims == ("mu", "side")
    assert np.isnan(limits.jam_angle[:2]).all() and np.isfinite(limits.jam_angle.sel(mu=5.0)).all()


# ---- what it tends to -----


def machine(friction: float = 0.0, drive: str = "crank", branch: str = "open", **guide) -> ls.Scene:
    crank, rod = ls.Link(0.05, 0.8, 7e-4, 0.02, 30.0), ls.Link(0.16, 0.6, 2e-3, 0.06, -8.0)
    mechanism = ls.SliderCrank(crank, rod, 0.5, friction=friction, branch=branch, **guide)
    return ls.Scene(mechanism, 40.0, -90.0, (0.4, -9.81), loads(), drive)


def loads(rod: str = "rod", slider: str = "slider", at: float = 0.0) -> list[ls.Load]:
    """On every link; those of the slider act on its pin, `at` so far from the first pin of the link it is."""
    return [
        ls.Load("crank", force=(3.0, -8.0), at=(0.03, 50.0), torque=0.4),
        ls.Load(rod, force=(-6.0, 9.0), at=(0.1, 10.0), frame="link"),
        ls.Load(slider, force=(-70.0, 20.0), at=(at, 0.0)),
    ]


MOVING = np.array([20.0, 65.0, 130.0, 200.0, 250.0, 310.0])
FORCES = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y")
KINEMATICS = ("theta3", "omega3", "alpha3")


@pytest.mark.parametrize("branch", BRANCHES)
@pytest.mark.parametrize("drive", ["crank", "coupler"])
def test_little_friction_is_little_change(drive, branch):
    """Away from the dead centres every force and torque leaves its frictionless value in proportion to μ."""
    scenes = [machine(mu, drive, branch, offset=0.02, slide_angle=12.0) for mu in (0.0, 1e-6, 2e-6)]
    names = [*FORCES, scenes[0].mechanism.drives[drive]]
    smooth, once, twice = (ls.sweep(scene, MOVING, of=names)[names].to_array() for scene in scenes)
    change, size = once - smooth, abs(smooth).max()
    assert 0.0 < abs(change).max() < 1e-4 * size
    assert abs(twice - smooth - 2.0 * change).max() < 1e-9 * size
    assert (abs(change).max("theta2") > 1e-9 * size).all()


@pytest.mark.parametrize("branch", BRANCHES)
def test_a_four_bar_with_an_endless_rocker_is_a_slider_crank(branch):
    """Rocker of length R straight under the guide, all its mass at C: the difference fades as 1/R."""
    offset, names = 0.02, (*KINEMATICS, *FORCES, "T12", "Cx", "Cy")
    scene = machine(offset=offset, branch=branch)
    limit = ls.sweep(scene, MOVING, of=names)
    foot, crank, rod = 0.15 if branch == "open" else -0.15, scene.mechanism.crank, scene.mechanism.rod
    differences = []
    for R in (1e3, 1e4, 1e5):
        rocker = ls.Link(R, 0.5, 0.0, cg_distance=R)
        D = complex(foot, offset - R)
        ground = {"ground": abs(D), "ground_angle": float(np.degrees(np.angle(D))), "branch": branch}
        bars = ls.FourBar(crank, rod, rocker, **ground)
        four_bar = ls.Scene(bars, 40.0, -90.0, (0.4, -9.81), loads("coupler", "rocker", at=R))
        cycle = ls.sweep(four_bar, MOVING, of=names)
        differences.append({name: abs(cycle[name] - limit[name]).max().item() for name in names})
    near, nearer, nearest = differences
    sizes = {name: abs(limit[name]).max().item() for name in names} | {"F14x": abs(limit.F14y).max().item()}
    assert max(nearest[name] / sizes[name] for name in names) < 1e-4
    assert {name: near[name] / nearer[name] for name in names} == pytest.approx(dict.fromkeys(names, 10), rel=0.02)
    assert {name: nearer[name] / nearest[name] for name in names} == pytest.approx(dict.fromkeys(names, 10), rel=0.02)
