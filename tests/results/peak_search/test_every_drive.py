"""Peaks of plain machines by every drive, with numbers that make forces vanish: none is below a sample or far above."""

import itertools

import numpy as np
import pytest
from long import long_but

import linksweep as ls

ROD, ARM = ls.Link(0.35, 1.0, 0.01, 0.1), ls.Link(0.3, 1.0, 0.02, 0.1, 3.0)
SAMPLES = 5760


def engine(crank: ls.Link, offset: float, friction: float) -> ls.SliderCrank:
    return ls.SliderCrank(crank, ROD, slider_mass=2.0, offset=offset, friction=friction)


def shaper(crank: ls.Link, offset: float, friction: float) -> ls.InvertedSliderCrank:
    return ls.InvertedSliderCrank(crank, ARM, 0.4, 0.5, offset=offset, friction=friction)


def press(crank: ls.Link, _offset: float, _friction: float) -> ls.FourBar:
    return ls.FourBar(crank, ROD, ARM, ground=0.4)


MACHINES = {
    "slider-crank by its crank": (engine, "crank", "rod"),
    "slider-crank by its rod": (engine, "coupler", "rod"),
    "inverted slider-crank by its crank": (shaper, "crank", "rocker"),
    "inverted slider-crank by its rocker": (shaper, "rocker", "rocker"),
    "inverted slider-crank by its cylinder": (shaper, "cylinder", "rocker"),
    "four-bar by its crank": (press, "crank", "rocker"),
    "four-bar by its rocker": (press, "rocker", "rocker"),
}
NOTHING = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
NUMBERS = tuple(itertools.product((1.0,), (0.0, 0.02), (0.0, 0.1), (0.0, -9.81), (0.0,), (0.0, 20.0)))
"""Mass of the crank, offset, friction, gravity, acceleration and torque."""


def exceeded_or_too_high(scene: ls.Scene) -> list[str]:
    """Return the names of finite peaks that a sample exceeds, or that exceed all samples by a hundredth of the largest
    pin force."""
    peaks, samples, wrong = ls.peaks(scene), ls.peaks(scene, theta2=SAMPLES), []
    size = max(float(samples[f"{pin}_peak"]) for pin in ("F12", "F32", "F43", "F14"))
    for name in (str(name) for name in peaks.data_vars if f"{name}_at" in peaks):
        sign = -1.0 if name.endswith("_min") else 1.0
        excess = sign * (float(peaks[name]) - float(samples[name]))
        if np.isfinite(excess) and not -1e-9 * size <= excess <= 1e-2 * size:
            wrong.append(name)
    return wrong


@pytest.mark.parametrize("kind", MACHINES)
@pytest.mark.parametrize("numbers", long_but([NOTHING, NUMBERS], NOTHING))
def test_peaks_by_every_drive(kind, numbers):
    machine, drive, loaded = MACHINES[kind]
    for mass, offset, friction, gravity, alpha2, torque in [numbers] if numbers is NOTHING else numbers:
        crank = ls.Link(0.1, mass, 0.01 * mass, 0.03, 20.0)
        loads = [ls.Load(loaded, torque=torque)] if torque else []
        scene = ls.Scene(machine(crank, offset, friction), 30.0, alpha2, (0.0, gravity), loads, drive=drive)
        assert exceeded_or_too_high(scene) == []
