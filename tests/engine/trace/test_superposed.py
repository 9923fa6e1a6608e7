"""Superposed requests sum a few cycles for parameters that enter linearly: equal results, less work a design."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from benchmarks.cases import GENERAL, LENGTHS, LOADS, MASSES, batch, scene, stacked
from benchmarks.rivals import peers
from linksweep.engine.trace.plan import plan
from linksweep.engine.trace.superpose import superposed
from linksweep.scene.designs.selection import selected
from linksweep.scene.grid import crank_grid

TURN = 72
SWEPT = {
    "one mass": ("m3",),
    "masses and inertias": MASSES,
    "speeds": ("omega2",),
    "accelerations": ("alpha2",),
    "gravity": ("gx", "gy"),
    "masses and speeds": ("m3", "I4", "omega2"),
    "geometries": LENGTHS,
}


def plans(machine: ls.Scene, *names: str):
    """The plan of a request, and what superposition makes of it."""
    sampled = machine.at(crank_grid(TURN, 360.0))
    request = plan(sampled.table, names, sampled.inputs.forms)
    return request, superposed(request)


def work(request, *dims: str) -> int:
    """Operations for each sample of each design."""
    return request.operations("theta2", *dims).total()


@pytest.mark.parametrize("way", long_but(["interpreted", "compiled"], "interpreted"))
@pytest.mark.parametrize("swept", SWEPT)
def test_superposed_cycles_are_those_of_the_textbooks_matrix(swept, way, monkeypatch):
    if way == "compiled":
        monkeypatch.setattr("linksweep.engine.run.COMPILE_AFTER", -1)
    designs = batch(5, *SWEPT[swept])
    cycle = ls.sweep(scene(designs), TURN, solver="superposed").transpose("design", "theta2")
    assert peers.difference(stacked(cycle), peers.numpy_lapack(designs, peers.grid(TURN))) < 1e-13


@pytest.mark.parametrize("swept", SWEPT)
def test_superposed_peaks_are_the_largest_of_superposed_cycles(swept):
    machine = scene(batch(5, *SWEPT[swept]), LOADS)
    cycle = ls.sweep(machine, TURN, of=["F32", "T12"], solver="superposed")
    peaks = ls.peaks(machine, ["F32", "T12"], theta2=TURN, solver="superposed")
    np.testing.assert_allclose(peaks.F32_peak, cycle.F32.max("theta2"), rtol=1e-15)
    np.testing.assert_allclose(peaks.T12_peak, abs(cycle.T12).max("theta2"), rtol=1e-15)


def test_a_torque_over_speeds_is_one_product_and_one_sum():
    """T12 = −(T₀ + ω²T₁)."""
    request, fewer = plans(scene(batch(5, "omega2")), "T12")
    assert work(request, "design") > 20
    assert dict(fewer.operations("theta2", "design")) == {"*": 1, "+": 1, "negate": 1}


def test_linear_numbers_along_several_dims():
    """Along mass × speed the torque is a sum over masses of what is a sum over speeds."""
    masses, speeds = xr.DataArray([1.0, 2.0, 4.0], dims="mass"), xr.DataArray([5.0, 10.0], dims="speed")
    machine = scene(GENERAL)
    coupler = replace(machine.mechanism.coupler, mass=masses)
    machine = replace(machine, mechanism=replace(machine.mechanism, coupler=coupler), omega2=speeds)
    plain, summed = (ls.sweep(machine, TURN, of=["T12", "F43"], solver=solver) for solver in ("fast", "superposed"))
    xr.testing.assert_allclose(plain, summed, rtol=1e-13, atol=1e-10)
    request, fewer = plans(machine, "T12")
    assert work(fewer, "mass", "speed") < work(request, "mass", "speed") / 5


@pytest.mark.parametrize("name", ["engine", "quick-return"])
def test_other_machines_over_their_speed(name):
    """Friction chooses a sign by a force that is itself such a sum."""
    machine = ls.example(name)
    machine = replace(machine, omega2=machine.omega2 * xr.DataArray([0.3, 1.0, 2.0], dims="speed"))
    forces = machine.mechanism.unknowns(machine.drive)
    plain, summed = (ls.sweep(machine, TURN, of=forces, solver=solver) for solver in ("fast", "superposed"))
    for force in forces:
        largest = abs(plain[force]).max().item()
        np.testing.assert_allclose(summed[force], plain[force], rtol=0.0, atol=1e-13 * largest)


def test_parameters_that_do_not_enter_linearly_are_not_superposed():
    request, same = plans(scene(batch(5, *LENGTHS)), "F32x", "T12")
    assert same is request


def test_at_rest_only_what_stands_is_left():
    """At ω₂ = 0 the powers of the speed leave the weights alone."""
    machine = replace(scene(GENERAL), omega2=xr.DataArray([0.0, 1.0], dims="speed"), alpha2=0.0)
    summed = ls.sweep(machine, TURN, solver="superposed").isel(speed=0)
    alone = ls.sweep(replace(machine, omega2=0.0), TURN)
    for name in ("T12", "F32x", "F14y", "alpha3"):
        np.testing.assert_allclose(summed[name], alone[name], rtol=1e-13, atol=1e-13)


def test_parts_of_a_superposed_batch_have_its_bits():
    machine = scene(batch(6, "m3", "omega2"))
    whole, half = (
        ls.sweep(selected(machine, {"design": part}), TURN, solver="superposed") for part in (slice(6), slice(2, 5))
    )
    xr.testing.assert_identical(whole.isel(design=slice(2, 5)).drop_attrs(), half.drop_attrs())


def test_a_study_takes_the_word_along(tmp_path):
    machine = scene(batch(6, "m3"))
    words = {"of": ["F32"], "theta2": TURN, "solver": "superposed"}
    study = ls.study(machine, tmp_path / "study.nc", chunk=4, **words).load()
    np.testing.assert_array_equal(study.F32_peak, ls.peaks(machine, **words).F32_peak)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda s: ls.peaks(s, solver="superposed"), r'solver = "superposed": is for samples.*give theta2'),
        (lambda s: ls.peaks(s, theta2=9, solver="dense"), r"solver = 'dense': must be one of fast, superposed"),
        (lambda s: ls.sweep(s, 9, of=["error_bound"], solver="superposed"), r"of: error_bound is of what"),
    ],
)
def test_requests_that_cannot_be_superposed_are_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call(ls.example("press"))
