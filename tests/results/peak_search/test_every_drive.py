"""Peaks of plain machines by every drive: none is below a sample, or far above, also where forces vanish."""

import itertools

import numpy as np
import pytest
from long import long_but

import linksweep as ls

CRANK, ARM = ls.Link(0.1, 1.0, 0.01, 0.03, 20.0), ls.Link(0.3, 1.0, 0.02, 0.1, 3.0)
ROD, MASSLESS_ROD = ls.Link(0.35, 1.0, 0.01, 0.1), ls.Link(0.35, 0.0, 0.0)
SAMPLES = 5760


def engine(offset: float, friction: float) -> ls.SliderCrank:
    return ls.SliderCrank(CRANK, ROD, slider_mass=2.0, offset=offset, friction=friction)


def shaper(offset: float, friction: float) -> ls.InvertedSliderCrank:
    return ls.InvertedSliderCrank(CRANK, ARM, 0.4, 0.5, offset=offset, friction=friction)


def press(_offset: float, _friction: float) -> ls.FourBar:
    return ls.FourBar(CRANK, MASSLESS_ROD, ARM, ground=0.4)


MACHINES = {
    "slider-crank by its crank": (engine, "crank", "rod"),
    "inverted slider-crank by its crank": (shaper, "crank", "rocker"),
    "inverted slider-crank by its rocker": (shaper, "rocker", "rocker"),
    "inverted slider-crank by its cylinder": (shaper, "cylinder", "rocker"),
    "four-bar by its crank": (press, "crank", "rocker"),
    "four-bar by its rocker": (press, "rocker", "rocker"),
}
"""Makers of machines, the drive, and the link with the load; a rod's drive makes every force of an engine unbounded."""
NOTHING = (0.0, 0.0, 0.0, 0.0)
NUMBERS = tuple(itertools.product((0.0, 0.02), (0.0, 0.1), (0.0, -9.81), (0.0, 20.0)))
"""Offset, friction, gravity and torque."""


def excesses(scene: ls.Scene) -> list[float]:
    """Return how far finite peaks exceed the highest sample, relative to the largest pin force."""
    peaks, samples, known = ls.peaks(scene), ls.peaks(scene, theta2=SAMPLES), []
    size = max(float(samples[f"{pin}_peak"]) for pin in ("F12", "F32", "F43", "F14"))
    for name in (str(name) for name in peaks.data_vars if f"{name}_at" in peaks):
        sign = -1.0 if name.endswith("_min") else 1.0
        known.append(sign * (float(peaks[name]) - float(samples[name])) / size)
    return [excess for excess in known if np.isfinite(excess)]


@pytest.mark.parametrize("kind", MACHINES)
@pytest.mark.parametrize("numbers", long_but([(NOTHING,), NUMBERS], (NOTHING,)))
def test_peaks_by_every_drive(kind, numbers):
    machine, drive, loaded = MACHINES[kind]
    finite = []
    for offset, friction, gravity, torque in numbers:
        loads = [ls.Load(loaded, torque=torque)] if torque else []
        finite += excesses(ls.Scene(machine(offset, friction), 30.0, 0.0, (0.0, gravity), loads, drive=drive))
    assert len(finite) > 0 and min(finite) > -1e-9 and max(finite) < 1e-2


def test_two_summits_between_samples():
    """Whitworth's machine by its rocker: F14 has summits 1.2 degrees apart, of almost one height."""
    links = ls.Link(1.942, 0.485, 0.285, 0.13), ls.Link(1.779, 0.288, 0.103, 1.62)
    machine = ls.InvertedSliderCrank(*links, 1.779, 0.683, 0.06, offset=-0.11, branch="crossed")
    scene = ls.Scene(machine, 19.39, gravity=(0.0, -9.81), drive="rocker")
    peaks, turn = ls.peaks(scene, of=["F14"]), ls.sweep(scene, 360_000, of=["F14"]).F14
    assert float(peaks.F14_peak) == pytest.approx(float(turn.max()), rel=1e-10)
    assert float(peaks.F14_peak_at) == pytest.approx(float(turn.idxmax()), abs=1e-3)


def test_two_summits_within_a_tenth_of_a_near_toggle():
    """Whitworth's machine by its rocker, its near-toggle 0.12 degrees wide: F14 has summits 0.012 degrees apart."""
    crank = ls.Link(2.4954619826467166, 0.8162967627541136, 0.8943976452209275, 2.1770830915346955, 155.91768421936354)
    rocker = ls.Link(
        2.4902394770755567, 1.1628376664378928, 0.6830039397816392, 2.7931955446285293, -37.345099041271425
    )
    block = {"block_mass": 1.1856326366661498, "block_inertia": 0.1367441523965136}
    machine = ls.InvertedSliderCrank(
        crank, rocker, 2.4902394770755567, **block, offset=0.0010770272707495024, branch="crossed"
    )
    scene = ls.Scene(machine, -17.983369054876242, 42.16808470705908, (0.0, -9.81), drive="rocker")
    peak, near = ls.peaks(scene, of=["F14"]), ls.sweep(scene, np.linspace(-0.03, 0.0, 30_001), of=["F14"]).F14
    assert float(peak.F14_peak) == pytest.approx(float(near.max()), rel=1e-10)
    assert float(peak.F14_peak_at) == pytest.approx(360.0 + float(near.idxmax()), abs=1e-5)
