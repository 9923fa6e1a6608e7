"""Loads of every kind on one protocol; equality by content; units that arrays have in their attributes."""

import math
import re
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.base.fields import choice, parameter
from linksweep.base.frozen import with_sound
from linksweep.reports.scene_tables import loads as loads_in_words
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.file.writing import write_scene
from linksweep.scene.grid import crank_grid
from linksweep.scene.loads.action import LOADS, Action
from linksweep.scene.loads.load import LoadForm
from linksweep.scene.parameters import free

PRESS = ls.example("press")
ENGINE = ls.example("engine")
WIDTHS = xr.DataArray([0.1, 0.2], {"design": [1, 2]}, "design")


@dataclass(frozen=True, eq=False, repr=False)
class Brake(Action):
    """Load type unknown to the package: a torque against the crank, on in one of two turns."""

    torque: float = parameter("torque", at_least=0.0)
    on: float = parameter("angle")
    lining: str = choice("dry", "wet")
    there: xr.DataArray = field(default=None, init=False, repr=False)  # over the angles of a sweep

    form = LoadForm("crank", force=False, torque=True, link_axes=False)
    period = 720.0

    def misfits(self, path, mechanism):
        return [] if isinstance(mechanism, ls.FourBar) else [f"{path} is a Brake: must be on a FourBar"]

    def jumps(self, mechanism):
        return (self.on,)

    def sampled(self, path, revolution):
        angles = np.asarray(revolution.grid.angles)
        gripping = np.mod(angles - self.on, 720.0) < 360.0
        return with_sound(self, there=-self.torque * xr.DataArray(gripping, {"theta2": angles}, "theta2"))

    def parameters(self, name, machine):
        return {f"{name}_torque": self.there}


@pytest.fixture
def _registered(monkeypatch):
    """Register the load for one test."""
    monkeypatch.setitem(LOADS, "Brake", Brake)


def braked(**numbers) -> ls.Scene:
    loads = [ls.Load("rocker", torque=-12.0), Brake(**{"torque": 5.0, "on": 100.5} | numbers)]
    return ls.Scene(PRESS.mechanism, omega2=30.0, loads=loads)


def test_a_new_kind_of_load_is_swept():
    """Period, jumps and torque of a load that only this test knows, beside one of the package."""
    free = replace(braked(), loads=[ls.Load("rocker", torque=-12.0)])
    assert braked().period == 720.0 and braked().jumps() == (100.5,)
    result = ls.sweep(braked(), 720, of=["T12"]).T12
    without = ls.sweep(free, np.arange(720.0), of=["T12"]).T12
    on = (result.theta2 > 100.5) & (result.theta2 <= 460.0)
    np.testing.assert_allclose(result - without, xr.where(on, 5.0, 0.0), atol=1e-11)


def test_exact_peaks_of_a_new_kind_of_load():
    """In one of the two turns the drive gives 5 N m more: the maximum is 5 N m higher, the minimum unchanged."""
    free = ls.peaks(replace(braked(), loads=[ls.Load("rocker", torque=-12.0)]), of=["T12"])
    peaks = ls.peaks(braked(on=free.T12_max_at.item() - 1.0), of=["T12"])
    np.testing.assert_allclose(peaks.T12_max, free.T12_max + 5.0, rtol=1e-10)
    np.testing.assert_allclose(peaks.T12_min, free.T12_min, rtol=1e-10)
    np.testing.assert_allclose(peaks.T12_max_at, free.T12_max_at, atol=1e-5)


@pytest.mark.usefixtures("_registered")
def test_a_new_kind_of_load_round_trips_through_files():
    torques = xr.DataArray([5.0, 6.0], {"pad": [1, 2]}, "pad")
    for scene in (braked(), braked(torque=torques), braked(lining="wet")):
        assert parse_scene(write_scene(scene)) == scene
    table = '[[loads]]\ntype = "Brake"\ntorque = "5000 N mm"\non = "0.25 rev"\n'
    text = write_scene(PRESS).partition("[[loads]]")[0]
    assert parse_scene(text + table).loads == (Brake(5.0, 90.0),)
    for wrong, message in {
        'torque = "5000 N mm"\n': 'loads[1].torque: missing; write torque = "12 N m", or a number in N m',
        " mm": 'loads[1].torque = "5000 N": N is a unit of force, not of torque',
    }.items():
        with pytest.raises(ValueError, match=re.escape(message)):
            parse_scene(text + table.replace(wrong, ""))
    with pytest.raises(ValueError, match=r"must be one of Load, .*, Brake"):
        parse_scene(text + table.replace('"Brake"', '"Clutch"'))


def test_a_new_kind_of_load_varies_like_the_others():
    """Its numeric fields may vary in a study, with units converted; its choices may not."""
    assert {path for path in free(braked()) if path.startswith("loads[2]")} == {"loads[2].torque", "loads[2].on"}
    drawn = ls.sample(braked(), {"loads[2].torque": ("4000 N mm", "6 N m")}, n=8)
    torque = drawn.arrays["loads[2].torque"]
    assert torque.min() >= 4.0 and torque.max() <= 6.0 and torque.std() > 0.1
    assert ls.peaks(drawn, of=["T12"], theta2=72).sizes == {"design": 8}


def test_a_report_describes_a_new_kind_of_load():
    assert "Brake (torque 5\u202fN m, on 100.5°, lining dry)" in str(loads_in_words(braked()))


def test_a_new_kind_of_load_is_checked_like_the_others():
    with pytest.raises(ValueError, match=r"^loads\[2\].torque = nan N m: must be finite and at least 0$"):
        ls.Scene(PRESS.mechanism, omega2=30.0, loads=[ls.Load("rocker", torque=-12.0), Brake(math.nan, 0.0)])
    with pytest.raises(ValueError, match=r"^loads\[1\] is a Brake: must be on a FourBar$"):
        ls.Scene(ENGINE.mechanism, omega2=30.0, loads=Brake(5.0, 0.0))


def test_all_loads_of_the_package_are_actions():
    """Each registered load is public under its own name."""
    assert all(issubclass(kind, Action) and getattr(ls, name) is kind for name, kind in LOADS.items())
    assert {*LOADS} == {"Load", "GasPressure", "Spring", "Damper", "TorsionSpring", "TorsionDamper"} <= {*ls.__all__}


def test_a_scene_collects_the_jumps_of_all_loads():
    """Dead centres of a cycle in line with the guide, and where a torsion spring between ground and crank flips."""
    engine = ls.SliderCrank(ls.Link(0.04, 1.0, 0.0), ls.Link(0.14, 1.0, 0.0), 0.5)
    loads = [ls.TorsionSpring("crank", "ground", 2.0, 30.0), ls.GasPressure(0.09, ls.OttoCycle(9.0, 5e6))]
    assert ls.Scene(engine, omega2=100.0, loads=loads).jumps() == (150.0, 0.0, 180.0)
    rubbing = replace(engine, friction=0.1, rod=ls.Link(WIDTHS + 1.0, 1.0, 0.0), offset=0.01)
    both = ls.Scene(rubbing, omega2=100.0, loads=loads[1:]).jumps()
    assert len(both) == len(rubbing.jumps()) == 2  # friction and gas jump at the same dead centres


@pytest.mark.parametrize(
    "scene",
    [
        PRESS,
        replace(PRESS, loads=[ls.Load("coupler", force=(WIDTHS, 0.0)), ls.TorsionDamper("crank", "coupler", 0.2)]),
        ls.Scene(ENGINE.mechanism, omega2=100.0, loads=[ls.GasPressure(0.09, 3e5)]),
    ],
)
def test_a_constant_scene_is_its_own_sample(scene):
    assert scene.at(crank_grid(8, scene.period)) is scene


def test_loads_that_vary_are_sampled_at_the_angles():
    saw = lambda theta2: np.mod(theta2, 360.0) / 4.0  # noqa: E731
    changing = replace(PRESS, loads=[ls.Load("coupler", force=(0.0, saw)), ls.Load("rocker", torque=2.0)])
    sampled = changing.at(crank_grid(4, 360.0))
    assert sampled.loads[0].force[1].values.tolist() == [0.0, 22.5, 45.0, 67.5]
    assert sampled.loads[1] is changing.loads[1] and sampled.omega2 is changing.omega2


# ----------------------------------------------------------------------------------- equality by content

MADE = {
    "load": lambda n: ls.Load("coupler", force=(n, -80.0), at=(0.1, 15.0)),
    "gas": lambda n: ls.GasPressure(0.09, ls.OttoCycle(9.0, 5e6 + n)),
    "otto": lambda n: ls.OttoCycle(9.0 + n, 5e6),
    "diesel": lambda n: ls.DieselCycle(18.0, 2.0 + n),
    "spring": lambda n: ls.Spring(("ground", n, 0.0), ("rocker", 0.1, 0.0), 2000.0, 0.05),
    "damper": lambda n: ls.Damper(("ground", 0.3, 0.0), ("rocker", 0.1, 0.0), n),
    "torsion spring": lambda n: ls.TorsionSpring("ground", "rocker", n),
    "torsion damper": lambda n: ls.TorsionDamper("ground", "rocker", n),
    "link": lambda n: ls.Link(n, 1.0, 0.0),
    "bar": lambda n: ls.Bar(n, 0.1, 0.1, 7800.0),
    "disk": lambda n: ls.Disk(n, 0.1, 0.1, 7800.0),
    "four-bar": lambda n: replace(PRESS.mechanism, ground_angle=n),
    "slider-crank": lambda n: replace(ENGINE.mechanism, slide_angle=n),
    "inverted": lambda n: replace(ls.example("quick-return").mechanism, offset=n),
    "loop": lambda n: ls.LoopTrack(radius=n, mass=700.0),
    "scene": lambda n: replace(PRESS, omega2=n),
}


@pytest.mark.parametrize("make", MADE.values(), ids=MADE.keys())
def test_equal_contents_compare_equal(make):
    named = WIDTHS.rename("width").assign_attrs(comment="as measured")
    assert make(0.1) == make(0.1) and hash(make(0.1)) == hash(make(0.1))
    assert make(WIDTHS) == make(named) and hash(make(WIDTHS)) == hash(make(named))
    others = [0.1, 0.2, WIDTHS + 0.1, WIDTHS.rename(design="other"), WIDTHS.assign_coords(design=[1, 3]), WIDTHS[:1]]
    assert all(make(WIDTHS) != make(other) for other in others)
    assert make(0.1) != make(0.2) and make(0.1) != "make"
    bare = WIDTHS.drop_vars("design")
    assert make(bare) == make(bare.copy()) and make(bare) != make(bare.rename(design="other"))


def test_other_classes_are_not_equal():
    assert ls.TorsionDamper("ground", "crank", 2.0) != ls.TorsionSpring("ground", "crank", 2.0)
    assert ls.Link(0.1, 1.0, 0.0) != ls.Disk(0.1, 1.0, 0.0, 0.0)


def test_a_pair_may_be_a_bare_array():
    """Gravity and force, also of a slider, whose force may be one number along its guide."""
    for link in ("coupler", "slider"):
        inputs = ls.Load(link, force=np.array([3.0, -80.0]), at=np.array([0.1, 15.0]))
        assert inputs == ls.Load(link, force=(3.0, -80.0), at=(0.1, 15.0))
    with pytest.raises(ValueError, match=r"loads\[1\].force = array\(\[1., 2., 3.\]\): must be a pair"):
        ls.Scene(PRESS.mechanism, omega2=1.0, loads=ls.Load("coupler", force=np.array([1.0, 2.0, 3.0])))


# --------------------------------------------------------------------------------- units that arrays say


def in_unit(values, units) -> xr.DataArray:
    return xr.DataArray(values, dims="design", attrs={"units": units})


@pytest.mark.parametrize("units", ["m", "metre", "meters", "", None])
def test_a_units_attribute_in_the_parameters_own_unit_is_accepted(units):
    lengths = in_unit([0.20, 0.21], units)
    cycle = ls.sweep(replace(PRESS, mechanism=replace(PRESS.mechanism, ground=lengths)), 8)
    plain = ls.sweep(replace(PRESS, mechanism=replace(PRESS.mechanism, ground=lengths.drop_attrs())), 8)
    xr.testing.assert_identical(cycle, plain)


def test_results_may_be_parameters():
    """Units in UDUNITS spelling are accepted: the speed of one machine drives another."""
    cycle = ls.sweep(PRESS, 8, of=["omega3", "F32x", "T12", "theta3"]).isel(theta2=[1], drop=True).rename(theta2="at")
    loads = [ls.Load("coupler", force=(cycle.F32x, 0.0), at=(0.1, cycle.theta3), torque=cycle.T12)]
    assert ls.Scene(PRESS.mechanism, omega2=cycle.omega3, loads=loads).omega2.units == "rad/s"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"omega2": in_unit([900.0], "rpm")},
            'omega2 has attrs["units"] = "rpm": must be in rad/s; convert its values',
        ),
        ({"omega2": in_unit([15.0], "Hz")}, 'omega2 has attrs["units"] = "Hz": must be in rad/s'),
        ({"alpha2": in_unit([15.0], "rad s-1")}, 'alpha2 has attrs["units"] = "rad s-1": must be in rad/s^2'),
        ({"gravity": (0.0, in_unit([-386.0], "in/s^2"))}, 'gravity[2] has attrs["units"] = "in/s^2": must be in m/s^2'),
        (
            {"loads": ls.Load("crank", torque=in_unit([1.0], "lbf in"))},
            'loads[1].torque has attrs["units"] = "lbf in": ',
        ),
        (
            {"loads": ls.Load("crank", (1.0, 0.0), (0.1, in_unit([1.0], "rad")))},
            'loads[1].at[2] has attrs["units"] = ',
        ),
        (
            {"loads": ls.Spring(("ground", in_unit([300.0], "mm"), 0.0), ("crank", 0.0, 0.0), 10.0, 0.1)},
            'loads[1].from_[2] has attrs["units"] = "mm": must be in m; convert its values, and say units="m"',
        ),
        (
            {"mechanism": replace(PRESS.mechanism, crank=replace(PRESS.mechanism.crank, length=in_unit([8.0], "cm")))},
            'crank.length has attrs["units"] = "cm": must be in m',
        ),
        (
            {"mechanism": replace(PRESS.mechanism, ground=in_unit([0.2], "cubit-ish"))},
            'ground has attrs["units"] = ',
        ),
    ],
)
def test_another_unit_is_refused(changes, message):
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        replace(PRESS, **changes)
    assert str(refused.value).startswith(message)
    assert "\n" not in str(refused.value)
