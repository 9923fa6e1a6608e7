"""Time steady cycles of a machine on its motor: many designs against one, and one against a sweep of as many angles."""

from __future__ import annotations

from time import process_time

import xarray as xr

import linksweep as ls
from benchmarks.cases import GENERAL, LENGTHS, MASSES, Size, batch, few, scene
from benchmarks.speed.run_up import MOTOR
from benchmarks.timing import SHARE, Row, race

BRAKE = ls.TorsionDamper("ground", "crank", 0.1)
ONE, SWEEP = "ls.steady_cycle", "ls.sweep of as many angles"


def rows(size: Size) -> list[Row]:
    one, several = (scene(q, (BRAKE,)) for q in (GENERAL, batch(size.batch, *LENGTHS, *MASSES)))
    many = f"{ONE}, {size.batch} designs"

    def cycle(machine: ls.Scene) -> xr.Dataset:
        return ls.steady_cycle(machine, MOTOR, flywheel=0.2, theta2=size.turn, threads=1)

    calls = {ONE: lambda: cycle(one), many: lambda: cycle(several), SWEEP: lambda: ls.sweep(one, size.turn)}
    timed = race(calls, few(size), clock=process_time)
    ds = cycle(one)
    missed = abs(float(ds["energy_residual"] / ds["motor_work"]))
    return [timed.row(SHARE, many, ONE), timed.row(SHARE, ONE, SWEEP, error=missed)]
