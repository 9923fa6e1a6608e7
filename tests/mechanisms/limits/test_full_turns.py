"""An ideal air cycle takes full turns of the crank: designs of a study without any have no peaks."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.engine.trace.plan import plan
from linksweep.results.compute import surely_ok
from linksweep.scene.grid import crank_grid

ENGINE = ls.SliderCrank(ls.Link(0.04, 0.0, 0.0), ls.Link(0.14, 0.0, 0.0), slider_mass=0.5)
OTTO = ls.OttoCycle(9.0, 5.0e6, intake_pressure=1.0e5)
DIESEL = ls.DieselCycle(18.0, 2.2, intake_pressure=1.0e5)


def scene(pressure=OTTO, engine=ENGINE, **more) -> ls.Scene:
    return ls.Scene(engine, omega2=100.0, loads=[ls.GasPressure(0.09, pressure, 1.0e5)], **more)


@pytest.mark.parametrize("drive", ["crank", "coupler"])
@pytest.mark.parametrize("friction", [0.0, 0.05])
@pytest.mark.parametrize(("cycle", "branch"), [(OTTO, "open"), (DIESEL, "crossed")])
def test_a_design_that_does_not_turn_has_no_cycle(cycle, branch, friction, drive):
    """Nothing of it is ok: its status says so wherever it closes, and no number comes out."""
    engine = replace(ENGINE, offset=xr.DataArray([0.0, 0.11], dims="e"), branch=branch, friction=friction)
    study = scene(cycle, engine, drive=drive)
    angles = np.arange(5.0, 720.0, 10.0)  # no dead centre of the coupler drive, and none so near that it jams
    closes = np.abs(0.11 - 0.04 * np.sin(np.radians(angles))) < 0.14
    assert 0 < closes.sum() < closes.size
    for solver in ("fast", "dense"):
        results = ls.sweep(study, angles, solver=solver).isel(e=1)
        meanings = np.array(results.status.attrs["flag_meanings"].split())
        np.testing.assert_array_equal(meanings[results.status.values], np.where(closes, "no_cycle", "cannot_assemble"))
        numbers = [name for name in results.data_vars if name != "status" and "theta2" in results[name].dims]
        assert numbers and all(np.isnan(results[name]).all() for name in numbers)
    torque = {"crank": "T12", "coupler": "T13"}[drive]
    summaries = [f"{torque}_mean", "F32_rms"] if drive == "crank" else []  # beside dead centres they have no end
    peaks = ls.peaks(study, of=["F12", "F32", "F43", "F14", torque, *summaries]).isel(e=1)
    assert all(np.isnan(peaks[name]) for name in peaks.data_vars if name != "status")
    assert peaks.status.attrs["flag_meanings"].split()[int(peaks.status)] == "partial_revolution"


def test_other_pressures_need_no_full_turn():
    engine = replace(ENGINE, offset=xr.DataArray([0.0, 0.11], dims="e"))
    result, one = ls.sweep(scene(7e5, engine), 72).isel(e=1), ls.sweep(scene(7e5, replace(ENGINE, offset=0.11)), 72)
    assert set(result.status.values) == set(one.status.values) == {0, 1}
    np.testing.assert_array_equal(result.T12, one.T12)


def test_at_the_brink_of_full_turns_each_design_is_whole_or_none():
    """To the last bit of the lengths: wherever the status is ok there are numbers, and then at every angle."""
    rng = np.random.default_rng(5)
    crank, offset = rng.uniform(0.01, 0.1, (2, 40))
    ulps = np.arange(40) % 9 - 4
    rod = crank + offset + ulps * np.spacing(crank + offset)
    parameters = [xr.DataArray(values, dims="design") for values in (crank, rod, offset)]
    engine = ls.SliderCrank(ls.Link(parameters[0], 1.0, 0.0), ls.Link(parameters[1], 1.0, 0.0), 0.5, parameters[2])
    result, whole = ls.sweep(scene(OTTO, engine), 24), ls.check(scene(OTTO, engine)).assembly == 0
    assert 0 < int(whole.sum()) < 40
    ok = result.status == 0
    np.testing.assert_array_equal(np.isfinite(result.T12), ok)
    np.testing.assert_array_equal(ok.any("theta2"), whole)


def test_only_a_cycle_is_charged_for_the_status_of_full_turns():
    def made(study: ls.Scene) -> str:
        return " ".join(plan(study.table, ("status", "T12"), study.at(crank_grid(8, 720.0)).inputs.forms).functions)

    by_hand = ls.Scene(ENGINE, omega2=100.0, loads=[ls.Load("slider", force=3.0)])
    assert "no_cycle_status" in made(scene(OTTO))
    assert "no_cycle_status" not in made(scene(7e5)) and made(scene(7e5)) == made(by_hand)


def test_lengths_alone_say_that_every_design_takes_its_cycle_round():
    lengths = xr.DataArray([0.12, 0.14], dims="rod_length")
    turning = scene(OTTO, replace(ENGINE, rod=ls.Link(lengths, 1.0, 0.0)))
    assert surely_ok(turning)
    assert not surely_ok(replace(turning, drive="coupler"))
    assert not surely_ok(scene(OTTO, replace(ENGINE, rod=ls.Link(lengths - 0.08, 1.0, 0.0))))
    assert not surely_ok(scene(OTTO, replace(ENGINE, friction=4.0)))
