"""Choices and objects that a constructor refuses, and several problems at once: a line for each, with its path."""

import numpy as np
import pytest
import xarray as xr
from refusals import BAR, FOUR_BAR, LOAD, TURNED, array, four_bar, load, refusal, scene

import linksweep as ls


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda: four_bar(branch="opne"),
            "branch = 'opne': must be one of open, crossed, both; did you mean \"open\"?",
        ),
        (
            lambda: four_bar(branch="Crossed"),
            "branch = 'Crossed': must be one of open, crossed, both; did you mean \"cro",
        ),
        (lambda: four_bar(branch=1), "branch = 1: must be one of open, crossed, both"),
        (lambda: four_bar(branch=None), "branch = None: must be one of open, crossed, both"),
        (lambda: scene(drive="crnk"), "drive = 'crnk': must be one of crank, coupler, rocker; did you mean \"crank\"?"),
        (lambda: scene(drive=[]), "drive = []: must be one of crank, coupler, rocker"),
        (lambda: scene(drive="ground"), "drive = 'ground': must be one of crank, coupler, rocker"),
        (
            lambda: scene(drive=["crank"]),
            "drive = ['crank']: must be one of crank, coupler, rocker; did you mean \"crank",
        ),
        (
            lambda: load(link="copuler"),
            "loads[2].link = 'copuler': must be one of crank, coupler, rocker; did you mean \"",
        ),
        (lambda: load(link="slider"), "loads[2].link = 'slider': must be one of crank, coupler, rocker"),
        (lambda: load(link=3), "loads[2].link = 3: must be one of crank, coupler, rocker"),
        (
            lambda: load(frame="gruond"),
            "loads[2].frame = 'gruond': must be one of ground, link; did you mean \"ground\"?",
        ),
        (lambda: load(frame="world"), "loads[2].frame = 'world': must be one of ground, link"),
        (lambda: load(origin="CG"), "loads[2].origin = 'CG': must be one of pin, cg; did you mean \"cg\"?"),
        (lambda: load(origin=(0, 0)), "loads[2].origin = (0, 0): must be one of pin, cg"),
        (
            lambda: load(force=None, torque=None),
            "loads[2] has neither force nor torque: give force=(Fx, Fy), torque=..., or both",
        ),
        # things of the wrong kind
        (lambda: four_bar(crank=0.08), "crank = 0.08: must be a Link, Bar or Disk"),
        (lambda: four_bar(rocker=None), "rocker = None: must be a Link, Bar or Disk"),
        (
            lambda: four_bar(coupler=ls.Link),
            "coupler = <class 'linksweep.mechanisms.links.Link'>: must be a Link, Bar or",
        ),
        (lambda: scene(mechanism="FourBar"), "mechanism = 'FourBar': must be a FourBar"),
        (
            lambda: scene(mechanism=BAR),
            "mechanism = Bar(length=0.08, width=0.02, thickness=0.02, density=7750.0): must",
        ),
        (
            lambda: scene(loads=3),
            "loads = 3: must be a Load, GasPressure, ",
        ),
        (
            lambda: scene(loads=None),
            "loads = None: must be a Load, GasPressure, ",
        ),
        (
            lambda: scene(loads="coupler"),
            "loads = 'coupler': must be a Load, GasPressure, ",
        ),
        (
            lambda: scene(loads={"link": "crank"}),
            "loads = {'link': 'crank'}: must be a Load, GasPressure, ",
        ),
        (
            lambda: scene(loads=np.ones(2)),
            "loads = array([1., 1.]): must be a Load, GasPressure, ",
        ),
        (
            lambda: scene(loads=array(1.0)),
            "loads = <xarray.DataArray (design: 1)> Size: 8B array([1.]) Dimen...: must be",
        ),
        (lambda: scene(loads=[LOAD, "torque"]), "loads[2] = 'torque': must be a Load"),
        (lambda: scene(loads=[(0.0, 1.0)]), "loads[1] = (0.0, 1.0): must be a Load"),
        # pairs
        (lambda: scene(gravity=-9.81), "gravity = -9.81: must be a pair (gx, gy) in m/s^2"),
        (lambda: scene(gravity=(0.0, 0.0, -9.81)), "gravity = (0.0, 0.0, -9.81): must be a pair (gx, gy) in m/s^2"),
        (lambda: scene(gravity=None), "gravity = None: must be a pair (gx, gy) in m/s^2"),
        (lambda: scene(gravity="0, -9.81"), "gravity = '0, -9.81': must be a pair (gx, gy) in m/s^2"),
        (
            lambda: scene(gravity=np.array([0, -9.81, 0])),
            "gravity = array([ 0. , -9.81, 0. ]): must be a pair (gx, gy) in m/s^2",
        ),
        (
            lambda: load(force=-80.0),
            "loads[2].force = -80.0: must be a pair (Fx, Fy) in N, each a number, a DataArray or a function of theta2",
        ),
        (
            lambda: load(force=np.sin),
            "loads[2].force = <ufunc 'sin'>: must be a pair (Fx, Fy) in N, each a number, a Da",
        ),
        (
            lambda: load(force=lambda x: x),
            "loads[2].force = <function <lambda>.<locals>.<lambda>>: must be a pair (Fx, Fy",
        ),
        (lambda: load(force=(1.0,)), "loads[2].force = (1.0,): must be a pair (Fx, Fy) in N, each a number"),
        (
            lambda: load(force=array(0.0, 1.0)),
            "loads[2].force = <xarray.DataArray (design: 2)> Size: 16B array([0., 1.]",
        ),
        (lambda: load(at=0.1), "loads[2].at = 0.1: must be a pair (distance in m, angle in degrees)"),
        (lambda: load(at=None), "loads[2].at = None: must be a pair (distance in m, angle in degrees)"),
    ],
)
def test_refused_choices_and_objects(change, message):
    (line,) = refusal(change)
    assert line.startswith(message)


# ------------------------------------------------------------------------------------ several at a time


def test_all_problems_of_a_mechanism_are_reported_together():
    assert refusal(
        ls.FourBar,
        crank=None,
        coupler=ls.Link("8 kg", np.nan, 1.0, cg_distance=-0.1),
        rocker=ls.Disk(0.0, 0.1, 0.1, True),
        ground=[0.2],
        branch="opn",
        ground_angle=np.inf,
    ) == [
        "crank = None: must be a Link, Bar or Disk",
        'coupler.length = "8 kg": kg is a unit of mass, not of length; accepted: m, mm, cm, km, um, in, ft',
        "coupler.mass = nan kg: must be finite and at least 0",
        f"coupler.cg_distance = -0.1 m: must be at least 0{TURNED}",
        "rocker.length = 0 m: must be greater than 0",
        "rocker.density = True: must be a number in kg/m^3, not a truth value",
        'ground = [0.2] is a bare array: name its dimensions, as in xarray.DataArray(values, dims="design")',
        "branch = 'opn': must be one of open, crossed, both; did you mean \"open\"?",
        "ground_angle = inf degree: must be finite",
    ]


def test_all_problems_of_a_scene_are_reported_together():
    assert refusal(
        ls.Scene,
        FOUR_BAR,
        omega2=None,
        alpha2=True,
        gravity=(np.nan, "9.81"),
        drive="croupler",
        loads=[ls.Load("coupler"), ls.Load("rokcer", force=(1.0, 1j), at=(-1.0, np.nan), frame="x", torque="1 Nm")],
    ) == [
        "alpha2 = True: must be a number in rad/s^2, not a truth value",
        "gravity[1] = nan m/s^2: must be finite",
        'gravity[2] = "9.81": has no unit; write "9.81 m/s^2", or 9.81 without the quotes, which is in m/s^2',
        "omega2: missing; give FourBar a number in rad/s",
        "drive = 'croupler': must be one of crank, coupler, rocker; did you mean \"coupler\"?",
        "loads[1] has neither force nor torque: give force=(Fx, Fy), torque=..., or both",
        "loads[2].link = 'rokcer': must be one of crank, coupler, rocker; did you mean \"rocker\"?",
        "loads[2].force[2] = 1j: must be a number in N, or an xarray.DataArray of them",
        f"loads[2].at[1] = -1 m: must be at least 0{TURNED}",
        "loads[2].at[2] = nan degree: must be finite",
        "loads[2].frame = 'x': must be one of ground, link",
        'loads[2].torque = "1 Nm": "Nm" runs its units together; write them with a space, "N m"',
    ]


def test_an_array_in_place_of_a_link_is_refused():
    load = ls.Load(xr.DataArray([0.1, 0.2], dims="n"), force=(0.0, 1.0))
    (line,) = refusal(ls.Scene, FOUR_BAR, omega2=1.0, loads=[load])
    assert line.startswith("loads[1].link = <xarray.DataArray")
    assert line.endswith(": must be one of crank, coupler, rocker")
