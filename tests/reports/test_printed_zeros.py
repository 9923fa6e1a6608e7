"""Printed zeros: none has a minus, and rounding errors beside what they are the rounding of are 0."""

import re
from dataclasses import replace

import numpy as np
import pytest

import linksweep as ls
from linksweep.plot.kit.signals import angle_text
from linksweep.reports.markup import angle
from linksweep.tables.cells import digits, fixed

PRESS = ls.example("press")


@pytest.mark.parametrize("value", [-0.0, -7.4e-11, -0.004])
def test_a_zero_has_no_minus(value):
    assert fixed(value, 2) == "0.00" and fixed(value, 2, "+") == "+0.00"
    assert angle_text(value) == "0°"
    assert re.sub("<.*?>", "", angle(value)) == "0.0°"
    assert digits(-0.0) == "0" and digits(-0.5) == "-0.5" and fixed(-0.005001, 2) == "-0.01"


def test_sensitivities_of_what_does_not_depend_on_a_parameter_are_zero():
    """The swing of the rocker is a number of the four lengths: it does not turn with the ground."""
    rows = [line.split() for line in str(ls.sensitivities(PRESS, of="swing").linksweep).splitlines()[3:]]
    lengths = {"crank.length", "coupler.length", "rocker.length", "ground"}
    assert {row[0] for row in rows if row[1:3] != ["+0.000", "0"]} == lengths < {row[0] for row in rows}
    assert {"ground_angle", "gravity[2]", "crank.density"} <= {row[0] for row in rows}


def test_a_small_slope_of_a_stiff_parameter_is_no_rounding():
    """One pascal of pressure is little beside 1e5 Pa: the slope of a force to it is its share over the pressure."""
    engine = ls.example("engine")
    scene = replace(engine, omega2=0.0, gravity=(0.0, 0.0), loads=[ls.GasPressure(bore=0.086, pressure=6e6)])
    lines = str(ls.sensitivities(scene, of="F14_peak").linksweep).splitlines()
    (row,) = (line.split() for line in lines if line.startswith("loads[1].pressure"))
    peak = float(ls.peaks(scene, of=["F14"]).F14_peak)
    assert float(row[2]) == pytest.approx(peak / (6e6 - 101325.0), rel=1e-4)  # against the crankcase


def test_a_shaking_moment_that_cancels_is_zero():
    """Four cylinders in line whose cranks are each other's mirror images have no moment in the plane of motion."""
    four = ls.MultiCylinder(ls.example("engine"), crank_angles=[0, 540, 180, 360], positions=[0, 0.09, 0.18, 0.27])
    rows = {line.split()[0]: line.split()[1] for line in str(ls.peaks(four).linksweep).splitlines()}
    worst = ls.peaks(four)
    assert 0.0 < float(worst.Msy_peak) < 1e-9 * float(worst.T12_peak)
    assert rows["Msy_max"] == rows["Msy_min"] == "0"
    assert float(rows["T12_max"]) == pytest.approx(float(worst.T12_max), rel=1e-5)


@pytest.mark.parametrize("name", ["scissor-lift", "knuckle-press", "press"])
def test_angles_of_a_check_have_four_decimals(name):
    places = re.findall(
        r"(?:at|from:?|to) +(\S+)°", re.sub(r"to \S+° at", "at", str(ls.check(ls.example(name)).linksweep))
    )
    assert places and all(re.fullmatch(r"\d+\.\d{4}", place) for place in places)


def test_a_share_that_relieves_by_nothing_has_no_minus():
    shares = ls.breakdown(PRESS, "F32", theta2=[300.0])
    tiny = shares.F32.copy(data=np.where(shares.source.values[:, None] == "gravity", -1e-3, shares.F32.values))
    row = next(line for line in str(shares.assign(F32=tiny).linksweep).splitlines() if line.startswith("gravity"))
    assert row.endswith(" 0.0 %")
