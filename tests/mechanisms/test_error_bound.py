"""error_bound: never below the true rounding error of the pin forces, and seldom far above; free unless requested."""

from dataclasses import replace

import numpy as np
import oracle
import oracle_slider_crank
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from linksweep.engine.trace.plan import plan
from linksweep.scene.parameters import free, replaced

COMPONENTS = tuple(f"{pin}{axis}" for pin in ("F12", "F32", "F43", "F14") for axis in "xy")
REFERENCES = {"four-bar": oracle, "slider-crank": oracle_slider_crank}


def true_error(reference, data, theta2: float, cycle) -> float:
    """Largest error of a component against 60 digits, relative to the largest component."""
    exact = reference.solve(data, theta2)
    exact = [exact[name] for name in COMPONENTS]
    errors = [abs(float(cycle[name].values.flat[0]) - value) for name, value in zip(COMPONENTS, exact, strict=True)]
    return float(max(errors) / max(map(abs, exact)))


@pytest.mark.parametrize("count", long_but([30, 120], 30))
@pytest.mark.parametrize("machine", REFERENCES)
def test_it_holds_and_is_not_far_off(machine, count):
    reference, rng = REFERENCES[machine], np.random.default_rng(51)
    ratios = []
    for _ in range(count):
        data = reference.random_data(rng)
        theta2 = reference.random_theta2(rng, data)
        cycle = ls.sweep(reference.to_scene(data), theta2=[theta2], of=[*COMPONENTS, "error_bound"])
        if int(cycle.status.values.flat[0]) == 0:
            error, bound = true_error(reference, data, theta2, cycle), float(cycle.error_bound.values.flat[0])
            assert error <= bound
            ratios.append(bound / max(error, 2.0**-53))
    assert len(ratios) > count * 2 / 3
    assert np.quantile(ratios, 0.9) < 1000


def test_it_holds_near_toggles():
    """A rocker that nearly folds: the closure keeps its digits there, and the bound knows."""
    rng, bounds = np.random.default_rng(52), []
    for margin in (1e-2, 1e-4, 1e-6, 1e-8):
        for _ in range(6):
            data = oracle.random_data(rng)
            toggle = ls.check(oracle.to_scene(data)).toggle_angle.values
            toggle = toggle[np.isfinite(toggle)]
            for side in (-1.0, 1.0) if len(toggle) else ():
                theta2 = float(toggle[0] + side * np.degrees(margin))
                cycle = ls.sweep(oracle.to_scene(data), theta2=[theta2], of=[*COMPONENTS, "error_bound"])
                if int(cycle.status.values.flat[0]) == 0:
                    error, bound = true_error(oracle, data, theta2, cycle), float(cycle.error_bound.values.flat[0])
                    assert error <= bound
                    bounds.append(bound)
    assert len(bounds) > 10
    assert max(bounds) < 1e-10


@pytest.mark.parametrize("name", ["press", "engine", "quick-return"])
@pytest.mark.parametrize("angle", [-90.0, 0.0, 90.0, 180.0])
def test_a_frame_at_right_angles_is_as_good(name, angle):
    """Its cosine or sine is 0, and products with it drop out: what is left must not be taken for a difference that
    cancels."""
    scene = ls.example(name)
    turned = "slide_angle" if name == "engine" else "ground_angle"
    scene = replace(scene, mechanism=replace(scene.mechanism, **{turned: angle}))
    bound = ls.sweep(scene, theta2=36, of=["error_bound"]).error_bound
    assert float(bound.min()) > 0.0 and float(bound.max()) < 1e-12


@pytest.mark.parametrize("name", ["engine", "watt-2", "quick-return"])
def test_it_is_the_same_alone_and_among_other_designs(name):
    """Also of numbers that are 0 or 1, whose products are left out alone."""
    scene, rng = ls.example(name), np.random.default_rng(3)
    paths = [path for path in free(scene) if path.endswith((".mass", ".cg_angle", ".cg_distance"))][:6]
    numbers = rng.choice([0.0, 1.0, 0.37, 0.81], (len(paths), 6))
    own = [xr.DataArray(row, dims="design") for row in numbers]
    together = ls.sweep(replaced(scene, dict(zip(paths, own, strict=True))), 17, of=["error_bound"]).error_bound
    for k, column in enumerate(numbers.T):
        alone = ls.sweep(replaced(scene, dict(zip(paths, column, strict=True))), 17, of=["error_bound"]).error_bound
        np.testing.assert_array_equal(together.isel(design=k), alone)


def test_nobody_else_pays_for_it():
    scene = ls.example("press")
    request = plan(scene.table, ("F32",), scene.inputs.forms)
    with_bound = plan(scene.table, ("F32", "error_bound"), scene.inputs.forms)
    assert request.operations("theta2").total() < 150 < with_bound.operations("theta2").total()
