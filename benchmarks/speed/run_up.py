"""Time run-ups of one design and of many, and compare the end of one with a general multibody program."""

from __future__ import annotations

from dataclasses import replace
from time import process_time

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.cases import GENERAL, Size, few, scene
from benchmarks.rivals import exudyn_on_motor
from benchmarks.timing import FASTER, SHARE, Row, race

MOTOR = ls.DCMotor(stall_torque=12.0, no_load_speed=40.0)
ON_CRANK = exudyn_on_motor.OnCrank(MOTOR.stall_torque, MOTOR.no_load_speed)
AT_REST = replace(GENERAL, omega2=0.0, alpha2=0.0)
STEPS = 40_000
"""Steps of the multibody program; half as many are run beside them, to extrapolate."""
AGREEMENT = 1e-8
"""Error of the crank's angle [rad], and of its speed relative to that without load."""
ONE, PEER = "ls.run_up", "exudyn, {} and {} steps"


def rows(size: Size) -> list[Row]:
    one = scene(replace(GENERAL, alpha2=0.0))
    lengths = xr.DataArray(np.linspace(0.20, 0.24, size.designs), dims="design")
    several = replace(one, mechanism=replace(one.mechanism, coupler=replace(one.mechanism.coupler, length=lengths)))
    many = f"{ONE}, {size.designs} designs"
    timed = race({ONE: lambda: _run(one), many: lambda: _run(several)}, few(size), clock=process_time)
    return [timed.row(SHARE, many, ONE), _against_exudyn(one, size)]


def _run(machine: ls.Scene) -> xr.Dataset:
    return ls.run_up(machine, MOTOR, until=0.95, of=["F32"], threads=1)


def _against_exudyn(one: ls.Scene, size: Size) -> Row:
    """Return the row of the multibody program, which says so where it cannot run."""
    run = _run(one)
    peer, time = PEER.format(STEPS // 2, STEPS), float(run.time[-1])

    def theirs() -> np.ndarray:
        return exudyn_on_motor.end_of_run(AT_REST, ON_CRANK, time, STEPS)

    try:
        angle, speed = theirs()
    except Exception as problem:  # another program may raise anything
        return Row(ONE, peer, FASTER, note=f"not measured: {str(problem).splitlines()[0]}")
    ours = np.radians(float(run.angle[-1])), float(run.speed[-1])
    error = max(abs(angle - ours[0]), abs(speed - ours[1]) / MOTOR.no_load_speed)
    timed = race({ONE: lambda: _run(one), peer: theirs}, replace(few(size), burst=0.0), clock=process_time)
    return timed.row(FASTER, ONE, peer, error=error, allowed=AGREEMENT)
