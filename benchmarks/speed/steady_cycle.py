"""Time steady cycles on a motor: many designs against one, with gas and friction; one against a sweep of angles, and
against a general multibody program that comes to the same cycle."""

from __future__ import annotations

from dataclasses import replace
from time import process_time

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.cases import GENERAL, LENGTHS, MASSES, Size, batch, few, scene
from benchmarks.rivals.exudyn_on_motor import OnCrank, speeds_of_a_turn
from benchmarks.speed.run_up import MOTOR
from benchmarks.timing import FASTER, SHARE, Row, race

BRAKE = ls.TorsionDamper("ground", "crank", 0.1)
WHEEL = 0.01
"""Inertia of the flywheel beside the multibody program [kg m²]: small, so that the speed changes by a third."""
STEPS, TURNS = 20_000, 5
"""Steps of the multibody program, and turns in which it comes to the cycle, from a speed 8 % off."""
AGREEMENT = 1e-9
"""Error of the speed over the cycle, relative to it."""
STARTER = ls.DCMotor(stall_torque=60.0, no_load_speed=300.0)
ONE, SWEEP, PEER = "ls.steady_cycle", "ls.sweep of as many angles", "exudyn, {} and {} steps"


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
        _against_exudyn(one, size),
    ]


def _against_exudyn(one: ls.Scene, size: Size) -> Row:
    """Return the row of the multibody program, which says so where it cannot run."""

    def ours() -> xr.Dataset:
        return ls.steady_cycle(one, MOTOR, flywheel=WHEEL, theta2=size.turn, threads=1)

    cycle, peer = ours(), PEER.format(STEPS // 2, STEPS)
    q, drive = (
        replace(GENERAL, I2=GENERAL.I2 + WHEEL),
        OnCrank(MOTOR.stall_torque, MOTOR.no_load_speed, BRAKE.coefficient),
    )
    angles, duration = np.radians(cycle["theta2"].values), (TURNS + 1.5) * float(cycle["cycle_time"])

    def theirs() -> np.ndarray:
        return speeds_of_a_turn(q, drive, duration, STEPS, TURNS, angles)

    try:
        speeds = theirs()
    except Exception as problem:  # another program may raise anything
        return Row(ONE, peer, FASTER, note=f"not measured: {str(problem).splitlines()[0]}")
    error = float(abs(speeds / cycle["omega2"].values - 1.0).max())
    timed = race({ONE: ours, peer: theirs}, replace(few(size), burst=0.0), clock=process_time)
    return timed.row(FASTER, ONE, peer, error=error, allowed=AGREEMENT)


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
