"""Time requests that leave quantities or effects out, kernels and calls, against the full job."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import partial

import linksweep as ls
from benchmarks.cases import GENERAL, LENGTHS, LOADS, MASSES, NINE, Size, batch, scene, stacked
from benchmarks.rivals import peers
from benchmarks.speed.kernel import kernel_of, way
from benchmarks.speed.mechanisms import slider_crank
from benchmarks.timing import SHARE, Call, Row, race
from linksweep.engine.trace.plan import plan

EVERYTHING = "everything"
ALL_NINE = "nine unknowns stored"
FRICTION = "slider-crank with friction"
SECTION = "nine, section forces and stress of the coupler at one place"
KINEMATICS = ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4")
EXTRA = {
    "nine, shaking force and moment": ("Fsx", "Fsy", "Ms"),
    "nine, reduced inertia and its slope": ("reduced_inertia", "reduced_inertia_slope"),
    "nine, powers fed and regenerated": ("power_fed", "power_regenerated"),
    "nine, velocity ratio, mechanical advantage": ("velocity_ratio", "mechanical_advantage"),
    "nine, rotation of pins B, C, loads in link axes": ("omega_B", "omega_C", "F32x_link2", "F32y_link2"),
}
"""Further requests of a designer, computed in one kernel with the nine."""
HALF = replace(GENERAL, s=GENERAL.a / 2, p=GENERAL.b / 2, u=GENERAL.c / 2, delta2=0.0, delta3=0.0, delta4=0.0)

ALL = (*KINEMATICS, *NINE)
REQUESTS = {
    EVERYTHING: (GENERAL, ALL, LOADS),
    "kinematics only": (GENERAL, KINEMATICS, LOADS),
    "T12 only": (GENERAL, ("T12",), LOADS),
    "one pin: F32x, F32y": (GENERAL, ("F32x", "F32y"), LOADS),
    "no loads": (GENERAL, ALL, ()),
    "no gravity": (replace(GENERAL, gx=0.0, gy=0.0), ALL, LOADS),
    "alpha2 = 0": (replace(GENERAL, alpha2=0.0), ALL, LOADS),
    "balanced crank": (replace(GENERAL, s=0.0), ALL, LOADS),
    "centres of gravity mid-link": (HALF, ALL, LOADS),
}
"""Calls of ls.sweep by the request: design, names, loads."""
KERNELS = {
    ALL_NINE: (GENERAL, NINE, ()),
    "omega3, omega4": (GENERAL, ("omega3", "omega4"), ()),
    "T12, no loads": (GENERAL, ("T12",), ()),
    **{name: (GENERAL, (*NINE, *extra), ()) for name, extra in EXTRA.items()},
}
"""Kernels by the request: design, names, loads."""

ROWS = (
    ("omega3, omega4", ALL_NINE, 0.35),
    ("T12, no loads", ALL_NINE, 0.75),
    *((ALL_NINE, name, None) for name in EXTRA),
)


def rows(size: Size) -> list[Row]:
    requests = [(name, EVERYTHING, None) for name in REQUESTS if name != EVERYTHING]
    return [
        *_compared(REQUESTS, requests, lambda sweep: sweep, size),
        *_compared(KERNELS, ROWS, lambda sweep: kernel_of(sweep).call, size),
        _friction(size),
        _section(size),
        *_batches(size),
    ]


def _compared(jobs: Mapping, compared: Iterable[tuple], to_time: Callable[[Call], Call], size: Size) -> list[Row]:
    """Time the jobs against each other, by their calls of ls.sweep, or as `to_time` transforms those."""
    calls, error, work = {}, {}, {}
    with way("compiled"):
        for name, (design, names, loads) in jobs.items():
            machine = scene(design, loads)
            sweep = partial(ls.sweep, machine, size.angles, of=names, threads=1)
            calls[name] = to_time(sweep)
            error[name] = peers.difference(stacked(sweep(), names), _reference(machine, design, names, size.angles))
            work[name] = plan(machine.table, names, machine.inputs.forms).instructions("theta2")
        timed = race(calls, size, size.angles)
    return [
        timed.row(SHARE, ours, theirs, goal, error=error[ours], note=f"{work[ours]} of {work[theirs]} instructions")
        for ours, theirs, goal in compared
    ]


def _friction(size: Size) -> Row:
    """Time all unknowns of a slider-crank on a guide without friction against one with it."""
    machines = {"zero friction": slider_crank(friction=0.0), FRICTION: slider_crank(friction=0.1)}
    calls, error, work = {}, {}, {}
    with way("compiled"):
        for name, machine in machines.items():
            unknowns = machine.mechanism.unknowns(machine.drive)
            sweep = partial(ls.sweep, machine, size.angles, of=unknowns, threads=1)
            calls[name] = kernel_of(sweep).call
            error[name] = peers.difference(stacked(sweep(), unknowns), stacked(sweep(solver="dense"), unknowns))
            work[name] = plan(machine.table, unknowns, machine.inputs.forms).instructions("theta2")
        timed = race(calls, size, size.angles)
    ours, theirs = machines
    return timed.row(SHARE, ours, theirs, error=error[ours], note=f"{work[ours]} of {work[theirs]} instructions")


def _section(size: Size) -> Row:
    """Time the nine unknowns of a four-bar of bars against the nine, section forces and stress at one place."""
    lengths = (GENERAL.a, GENERAL.b, GENERAL.c)
    crank, coupler, rocker = (ls.Bar(length, width=0.02, thickness=0.02, density=7750.0) for length in lengths)
    machine = ls.FourBar(crank, coupler, rocker, ground=GENERAL.d)
    bars = ls.Scene(machine, omega2=30.0, alpha2=5.0, gravity=(0.0, -9.81), section=0.5)
    requests = {ALL_NINE: NINE, SECTION: (*NINE, "axial_force3", "shear_force3", "bending_moment3", "stress3")}
    calls, work = {}, {}
    with way("compiled"):
        for name, names in requests.items():
            sweep = partial(ls.sweep, bars, size.angles, of=names, threads=1)
            calls[name] = kernel_of(sweep).call
            work[name] = plan(bars.table, names, bars.inputs.forms).instructions("theta2")
        nine = ls.sweep(bars, size.angles, of=requests[SECTION], threads=1)
        error = peers.difference(
            stacked(nine, NINE), stacked(ls.sweep(bars, size.angles, of=NINE, solver="dense"), NINE)
        )
        timed = race(calls, size, size.angles)
    return timed.row(SHARE, ALL_NINE, SECTION, error=error, note=f"{work[ALL_NINE]} of {work[SECTION]} instructions")


def _reference(machine: ls.Scene, design: peers.Design, names: tuple[str, ...], n_angles: int) -> peers.Array:
    """Return the variables by numpy; with loads, or if more than forces is requested, by linksweep's dense solver."""
    if machine.loads or not {*names} <= {*NINE, "omega3", "omega4"}:
        return stacked(ls.sweep(machine, n_angles, of=names, solver="dense"), names)
    if names == ("omega3", "omega4"):
        return peers.numpy_rates(design, peers.grid(n_angles))
    return peers.numpy_lapack(design, peers.grid(n_angles))[[NINE.index(name) for name in names]]


def _batches(size: Size) -> list[Row]:
    """Time many masses, or speeds, on one geometry against as many geometries: kinematics and unknowns, all stored."""
    designs = {
        "masses, one geometry": batch(size.batch, *MASSES),
        "speeds, one geometry": batch(size.batch, "omega2"),
        "geometries": batch(size.batch, *LENGTHS),
    }
    sweeps = {name: partial(ls.sweep, scene(q), size.turn, threads=1) for name, q in designs.items()}
    with way("compiled"):
        kernels = {name: kernel_of(sweep).call for name, sweep in sweeps.items()}
        error = {name: _batch_error(sweeps[name], q, size.turn) for name, q in designs.items()}
        labels = {name: f"{size.batch} {name}" for name in designs}
        calls = {f"{labels[name]}: kernel": call for name, call in kernels.items()}
        calls |= {f"{labels[name]}: ls.sweep": call for name, call in sweeps.items()}
        timed = race(calls, size, size.batch * size.turn)
    *ours, theirs = labels
    return [
        timed.row(
            SHARE, f"{labels[name]}: {level}", f"{labels[theirs]}: {level}", error=max(error[name], error[theirs])
        )
        for name in ours
        for level in ("kernel", "ls.sweep")
    ]


def _batch_error(sweep, designs: peers.Design, n_angles: int) -> float:
    cycle = sweep().transpose("design", "theta2")
    return peers.difference(stacked(cycle), peers.numpy_lapack(designs, peers.grid(n_angles)))
