"""What acts on a mechanism, one protocol for all; equality by content; and what an array says of its unit."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.base.validate import parameter
from linksweep.mechanisms.rows.load_forms import LoadForm
from linksweep.scene.file import toml as file
from linksweep.scene.grid import crank_grid
from linksweep.scene.loads.action import Action
from linksweep.scene.loads.kinds import ACTIONS

PRESS = ls.example("press")
ENGINE = ls.example("engine")
WIDTHS = xr.DataArray([0.1, 0.2], {"design": [1, 2]}, "design")


@dataclass(frozen=True, eq=False)
class Brake(Action):
    """A new kind of load, which the package has never heard of: a torque on the crank, on in one of two turns."""

    torque: float = parameter("torque")
    on: float = parameter("angle")

    form = LoadForm("crank", force=False, torque=True, link_axes=False)
    period = 720.0
    there = 0.0

    def misfits(self, path, mechanism):
        return [] if isinstance(mechanism, ls.FourBar) else [f"{path} is a Brake: must be on a FourBar"]

    def jumps(self, mechanism):
        return (self.on,)

    def sampled(self, path, revolution):
        brought = replace(self)
        angles = np.asarray(revolution.grid.angles)
        gripping = np.mod(angles - self.on, 720.0) < 360.0
        object.__setattr__(brought, "there", xr.DataArray(-self.torque * gripping, {"theta2": angles}, "theta2"))
        return brought

    def parameters(self, name, machine):
        return {f"{name}_torque": self.there}


@pytest.fixture
def _known_to_files(monkeypatch):
    """As one more of ACTIONS is."""
    monkeypatch.setitem(file.SCHEMA, Brake, file._fields(Brake))
    monkeypatch.setitem(file._LOADS.classes, "Brake", Brake)


@pytest.mark.usefixtures("_known_to_files")
def test_a_new_kind_of_load_is_one_class():
    """Period, jumps, torque and file of a load that only this test knows, beside one of the package."""
    own = ls.Load("rocker", torque=-12.0)
    braked, free = (ls.Scene(PRESS.mechanism, omega2=30.0, loads=loads) for loads in ([own, Brake(5.0, 100.5)], [own]))
    assert braked.period == 720.0 and braked.jumps() == (100.5,)
    found = ls.sweep(braked, 720, ["T12"]).T12
    without = ls.sweep(free, np.arange(720.0), ["T12"]).T12
    on = (found.theta2 > 100.5) & (found.theta2 <= 460.0)
    np.testing.assert_allclose(found - without, xr.where(on, 5.0, 0.0), atol=1e-11)
    assert file.parse_scene(file.write_scene(braked)) == braked


def test_a_new_kind_of_load_is_judged_like_the_others():
    with pytest.raises(ValueError, match=r"^loads\[2\].torque = nan N m: must be finite$"):
        ls.Scene(PRESS.mechanism, omega2=30.0, loads=[ls.Load("rocker", torque=-12.0), Brake(math.nan, 0.0)])
    with pytest.raises(ValueError, match=r"^loads\[1\] is a Brake: must be on a FourBar$"):
        ls.Scene(ENGINE.mechanism, omega2=30.0, loads=Brake(5.0, 0.0))


def test_all_loads_of_the_package_are_actions():
    assert all(issubclass(kind, Action) for kind in ACTIONS)
    assert len(ACTIONS) == len({kind.__name__ for kind in ACTIONS}) == 6


def test_jumps_of_all_loads_are_those_of_the_scene():
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
def test_a_scene_without_change_is_its_own_sample(scene):
    assert scene.at(crank_grid(8, scene.period)) is scene


def test_a_scene_that_changes_is_brought_to_the_angles():
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
def test_what_holds_the_same_is_equal(make):
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
    """As gravity may; of a slider too, whose force may also be one number along its guide."""
    for link in ("coupler", "slider"):
        given = ls.Load(link, force=np.array([3.0, -80.0]), at=np.array([0.1, 15.0]))
        assert given == ls.Load(link, force=(3.0, -80.0), at=(0.1, 15.0))
    with pytest.raises(ValueError, match=r"loads\[1\].force = array\(\[1., 2., 3.\]\): must be a pair"):
        ls.Scene(PRESS.mechanism, omega2=1.0, loads=ls.Load("coupler", force=np.array([1.0, 2.0, 3.0])))


# --------------------------------------------------------------------------------- units that arrays say


def said(values, units) -> xr.DataArray:
    return xr.DataArray(values, dims="design", attrs={"units": units})


@pytest.mark.parametrize("units", ["m", "metre", "meters", "", None])
def test_a_unit_that_is_the_parameters_own_changes_nothing(units):
    lengths = said([0.20, 0.21], units)
    found = ls.sweep(replace(PRESS, mechanism=replace(PRESS.mechanism, ground=lengths)), 8)
    plain = ls.sweep(replace(PRESS, mechanism=replace(PRESS.mechanism, ground=lengths.drop_attrs())), 8)
    xr.testing.assert_identical(found, plain)


def test_results_are_parameters_in_their_own_units():
    """UDUNITS spelling, as results say it: a speed of one machine drives another."""
    found = ls.sweep(PRESS, 8, ["omega3", "F32x", "T12", "theta3"]).isel(theta2=[1], drop=True).rename(theta2="at")
    loads = [ls.Load("coupler", force=(found.F32x, 0.0), at=(0.1, found.theta3), torque=found.T12)]
    assert ls.Scene(PRESS.mechanism, omega2=found.omega3, loads=loads).omega2.units == "rad s-1"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"omega2": said([900.0], "rpm")}, 'omega2 has attrs["units"] = "rpm": must be in rad/s; convert its values'),
        ({"omega2": said([15.0], "Hz")}, 'omega2 has attrs["units"] = "Hz": must be in rad/s'),
        ({"alpha2": said([15.0], "rad s-1")}, 'alpha2 has attrs["units"] = "rad s-1": must be in rad/s^2'),
        ({"gravity": (0.0, said([-386.0], "in/s^2"))}, 'gravity[2] has attrs["units"] = "in/s^2": must be in m/s^2'),
        ({"loads": ls.Load("crank", torque=said([1.0], "lbf in"))}, 'loads[1].torque has attrs["units"] = "lbf in": '),
        (
            {"loads": ls.Load("crank", (1.0, 0.0), (0.1, said([1.0], "rad")))},
            'loads[1].at[2] has attrs["units"] = ',
        ),
        (
            {"loads": ls.Spring(("ground", said([300.0], "mm"), 0.0), ("crank", 0.0, 0.0), 10.0, 0.1)},
            'loads[1].from_[2] has attrs["units"] = "mm": must be in m; convert its values, and say units="m"',
        ),
        (
            {"mechanism": replace(PRESS.mechanism, crank=replace(PRESS.mechanism.crank, length=said([8.0], "cm")))},
            'crank.length has attrs["units"] = "cm": must be in m',
        ),
        (
            {"mechanism": replace(PRESS.mechanism, ground=said([0.2], "cubit-ish"))},
            'ground has attrs["units"] = ',
        ),
    ],
)
def test_another_unit_is_refused(changes, message):
    with pytest.raises(ValueError) as refused:  # noqa: PT011
        replace(PRESS, **changes)
    assert str(refused.value).startswith(message)
    assert "\n" not in str(refused.value)
