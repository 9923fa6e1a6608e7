"""Time the other mechanisms against the four-bar: all unknowns of each, by its own kernel."""

from __future__ import annotations

from functools import partial

import linksweep as ls
from benchmarks.cases import GENERAL, Size, scene, stacked
from benchmarks.rivals import peers
from benchmarks.speed.kernel import kernel_of, way
from benchmarks.timing import SHARE, Row, race
from linksweep.engine.trace.plan import plan

FOUR_BAR = "four-bar"


def slider_crank(friction: float) -> ls.Scene:
    """Return a slider-crank of GENERAL's crank and coupler, with the rocker's mass on an offset, turned guide."""
    bars = scene(GENERAL).mechanism
    guide = {"slider_mass": GENERAL.m4, "offset": 0.02, "slide_angle": 10.0}
    mechanism = ls.SliderCrank(bars.crank, bars.coupler, friction=friction, **guide)
    return ls.Scene(mechanism, GENERAL.omega2, GENERAL.alpha2, (GENERAL.gx, GENERAL.gy))


def inverted_slider_crank() -> ls.Scene:
    """Return an inverted slider-crank of that crank, its pin in a block that slides along an offset rocker."""
    bars = scene(GENERAL).mechanism
    mechanism = ls.InvertedSliderCrank(bars.crank, bars.rocker, GENERAL.d, GENERAL.m3, GENERAL.I3, offset=0.02)
    return ls.Scene(mechanism, GENERAL.omega2, GENERAL.alpha2, (GENERAL.gx, GENERAL.gy))


SCENES = {
    FOUR_BAR: scene(GENERAL),
    "slider-crank": slider_crank(friction=0.0),
    "slider-crank with friction": slider_crank(friction=0.1),
    "inverted slider-crank": inverted_slider_crank(),
}
GOALS = {"slider-crank": 1.0, "slider-crank with friction": 1.5, "inverted slider-crank": None}


def rows(size: Size) -> list[Row]:
    calls, error, work = {}, {}, {}
    with way("compiled"):
        for name, machine in SCENES.items():
            unknowns = machine.mechanism.unknowns(machine.drive)
            sweep = partial(ls.sweep, machine, size.angles, of=unknowns, threads=1)
            calls[name] = kernel_of(sweep).call
            dense = stacked(sweep(solver="dense"), unknowns)
            error[name] = peers.difference(stacked(sweep(), unknowns), dense)
            work[name] = plan(machine.table, unknowns, machine.inputs.forms).instructions("theta2")
        timed = race(calls, size, size.angles)
    return [
        timed.row(SHARE, name, FOUR_BAR, goal, error=error[name], note=f"{work[name]} of {work[FOUR_BAR]} instructions")
        for name, goal in GOALS.items()
    ]
