"""Time steady cycles on a motor: many designs against one, with gas and friction, and one against a sweep of angles."""

from __future__ import annotations

from dataclasses import replace
from time import process_time

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.cases import GENERAL, LENGTHS, MASSES, Size, batch, few, scene
from benchmarks.speed.run_up import MOTOR
from benchmarks.timing import SHARE, Row, race

BRAKE = ls.TorsionDamper("ground", "crank", 0.1)
STARTER = ls.DCMotor(stall_torque=60.0, no_load_speed=300.0)
ONE, SWEEP = "ls.steady_cycle", "ls.sweep of as many angles"


def rows(size: Size) -> list[Row]:
    one, several = (scene(q, (BRAKE,)) for q in (GENERAL, batch(size.batch, *LENGTHS, *MASSES)))
    many, fired = f"{ONE}, {size.batch} designs", f"{ONE}, {size.batch} engines with gas and friction"
    engines = _engines(size.batch)

    def cycle(machine: ls.Scene, motor: ls.DCMotor = MOTOR) -> xr.Dataset:
        return ls.steady_cycle(machine, motor, flywheel=0.2, theta2=size.turn, threads=1)

    calls = {
        ONE: lambda: cycle(one),
        many: lambda: cycle(several),
        fired: lambda: cycle(engines, STARTER),
        SWEEP: lambda: ls.sweep(one, size.turn),
    }
    timed = race(calls, few(size), clock=process_time)
    return [
        timed.row(SHARE, many, ONE),
        timed.row(SHARE, fired, many, error=_missed(cycle(engines, STARTER))),
        timed.row(SHARE, ONE, SWEEP, error=_missed(cycle(one))),
    ]


def _engines(count: int) -> ls.Scene:
    """Return engines whose lengths and pistons differ by 10 %: each has its dead centres elsewhere."""
    rng, engine = np.random.default_rng(3), ls.example("engine")
    throw, rod, offset, piston = (
        xr.DataArray(middle * (1.0 + 0.1 * rng.random(count)), dims="design") for middle in (0.043, 0.145, 0.005, 0.45)
    )
    links = {"crank": replace(engine.mechanism.crank, length=throw), "rod": replace(engine.mechanism.rod, length=rod)}
    machine = replace(engine.mechanism, **links, offset=offset, slider_mass=piston)
    return replace(engine, mechanism=machine, loads=[*engine.loads, ls.TorsionDamper("ground", "crank", 0.2)])


def _missed(ds: xr.Dataset) -> float:
    """Return the energy that a motion misses, in the work of its motor; of designs, the largest."""
    return float(abs(ds["energy_residual"] / ds["motor_work"]).max())
