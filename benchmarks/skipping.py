"""What is not asked for, or is not there, is not paid for: kernels and calls against the full job."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import linksweep as ls
from linksweep.engine.plan import plan

from . import peers
from .cases import GENERAL, LENGTHS, LOADS, MASSES, NINE, Size, batch, scene, stacked
from .kernel import kernel_of, way
from .timing import SHARE, Row, race

ALL_NINE = "nine unknowns stored"
LOADED = "nine unknowns, two loads"
EXTRA = {
    "nine, shaking force and moment": ("Fsx", "Fsy", "Ms"),
    "nine, reduced inertia and its slope": ("reduced_inertia", "reduced_inertia_slope"),
    "nine, powers fed and regenerated": ("power_fed", "power_regenerated"),
}
"""What a designer asks besides, by the kernel that computes it too."""
HALF = replace(GENERAL, s=GENERAL.a / 2, p=GENERAL.b / 2, u=GENERAL.c / 2, delta2=0.0, delta3=0.0, delta4=0.0)

KERNELS = {
    ALL_NINE: (GENERAL, NINE, ()),
    "omega3, omega4": (GENERAL, ("omega3", "omega4"), ()),
    "T12": (GENERAL, ("T12",), ()),
    "F32x, F32y": (GENERAL, ("F32x", "F32y"), ()),
    "no gravity": (replace(GENERAL, gx=0.0, gy=0.0), NINE, ()),
    "alpha2 = 0": (replace(GENERAL, alpha2=0.0), NINE, ()),
    "centres of gravity mid-link": (HALF, NINE, ()),
    LOADED: (GENERAL, NINE, LOADS),
    **{name: (GENERAL, (*NINE, *extra), ()) for name, extra in EXTRA.items()},
}
"""Kernels by what they compute: design, names, loads."""

ROWS = (
    ("omega3, omega4", ALL_NINE, 0.35),
    ("T12", ALL_NINE, 0.75),
    ("F32x, F32y", ALL_NINE, None),
    ("no gravity", ALL_NINE, None),
    ("alpha2 = 0", ALL_NINE, None),
    ("centres of gravity mid-link", ALL_NINE, None),
    (ALL_NINE, LOADED, None),
    *((ALL_NINE, name, None) for name in EXTRA),
)


def rows(size: Size) -> list[Row]:
    return [*_kernels(size), *_batches(size)]


def _kernels(size: Size) -> list[Row]:
    calls, error, work = {}, {}, {}
    with way("compiled"):
        for name, (design, names, loads) in KERNELS.items():
            machine = scene(design, loads)
            sweep = partial(ls.sweep, machine, size.angles, names, threads=1)
            calls[name] = kernel_of(sweep).call
            error[name] = peers.difference(stacked(sweep(), names), _judge(machine, design, names, size.angles))
            work[name] = plan(machine.table, names, machine.inputs.forms).operations("theta2").total()
        timed = race(calls, size, size.angles)
    return [
        timed.row(SHARE, ours, theirs, goal, error=error[ours], note=f"{work[ours]} of {work[theirs]} operations")
        for ours, theirs, goal in ROWS
    ]


def _judge(machine: ls.Scene, design: peers.Design, names: tuple[str, ...], n_angles: int) -> peers.Array:
    """The same by numpy; where loads act, or more than forces is asked, by linksweep's own dense solver, LAPACK too."""
    if machine.loads or not {*names} <= {*NINE, "omega3", "omega4"}:
        return stacked(ls.sweep(machine, n_angles, names, solver="dense"), names)
    if names == ("omega3", "omega4"):
        return peers.numpy_rates(design, peers.grid(n_angles))
    return peers.numpy_lapack(design, peers.grid(n_angles))[[NINE.index(name) for name in names]]


def _batches(size: Size) -> list[Row]:
    """Many masses on one geometry against as many geometries: kinematics and unknowns, all stored."""
    designs = {"masses, one geometry": batch(size.batch, *MASSES), "geometries": batch(size.batch, *LENGTHS)}
    sweeps = {name: partial(ls.sweep, scene(q), size.turn, threads=1) for name, q in designs.items()}
    with way("compiled"):
        kernels = {name: kernel_of(sweep).call for name, sweep in sweeps.items()}
        error = {name: _batch_error(sweeps[name], q, size.turn) for name, q in designs.items()}
        labels = {name: f"{size.batch} {name}" for name in designs}
        calls = {f"{labels[name]}: kernel": call for name, call in kernels.items()}
        calls |= {f"{labels[name]}: ls.sweep": call for name, call in sweeps.items()}
        timed = race(calls, size, size.batch * size.turn)
    ours, theirs = labels.values()
    return [
        timed.row(SHARE, f"{ours}: {level}", f"{theirs}: {level}", error=max(error.values()))
        for level in ("kernel", "ls.sweep")
    ]


def _batch_error(sweep, designs: peers.Design, n_angles: int) -> float:
    cycle = sweep().transpose("design", "theta2")
    return peers.difference(stacked(cycle), peers.numpy_lapack(designs, peers.grid(n_angles)))
