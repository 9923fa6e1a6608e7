"""Every result that is a Dataset: pint-xarray reads its units, and its file keeps to the CF conventions it states."""

import importlib.util
import inspect
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls

PRESS, N = ls.example("press"), 24
STEEL, BEARING = ls.material("S355"), ls.Bearing(diameter=0.02, length=0.03, friction=0.1, capacity=5e4)
MOTOR = ls.InductionMotor("1500 rpm", "15 N m", rated_torque="6 N m", rated_speed="1425 rpm", inertia=0.004)
DRAGGED = replace(PRESS, loads=[ls.TorsionDamper("ground", "crank", coefficient=0.5)])
DESIGNS = ls.sample(PRESS, {"ground": (0.19, 0.21)}, n=3)

RESULTS = {
    "bearings": lambda path: ls.bearings(PRESS, {"B": BEARING}, theta2=N),
    "breakdown": lambda path: ls.breakdown(PRESS, "F32", theta2=N),
    "check": lambda path: ls.check(PRESS),
    "choose_bearings": lambda path: ls.choose_bearings(PRESS, life="10000 h"),
    "compare": lambda path: ls.compare(PRESS, PRESS, of=["F32_peak"], theta2=N),
    "contact_loss": lambda path: ls.contact_loss(PRESS, 5e-5, theta2=N),
    "coupler_curve": lambda path: ls.coupler_curve(PRESS, (0.10, 15.0), theta2=N),
    "duty": lambda path: ls.duty(PRESS),
    "flywheel": lambda path: ls.flywheel(PRESS, fluctuation=0.02, theta2=N),
    "geometry": lambda path: ls.geometry(PRESS),
    "load_spectrum": lambda path: ls.load_spectrum(ls.bearings(PRESS, theta2=N), classes=5),
    "motor_load": lambda path: ls.motor_load(PRESS, ls.Motor([0.0, 1e4], [1e6, 0.0], inertia=0.01), theta2=N),
    "open_study": lambda path: ls.study(DESIGNS, path / "opened.nc", of=["F32"], theta2=N).load(),
    "orders": lambda path: ls.orders(ls.sweep(PRESS, N, of=["Fsx"]), ["Fsx"], n=3),
    "pareto": lambda path: ls.pareto(ls.peaks(DESIGNS, of=["F32"], theta2=N), minimize="F32_peak"),
    "peaks": lambda path: ls.peaks(DESIGNS, theta2=N),
    "pin_friction": lambda path: ls.pin_friction(PRESS, {"B": BEARING}, theta2=N),
    "position_equation": lambda path: ls.position_equation(PRESS, 45.0),
    "regressor": lambda path: ls.regressor(PRESS, ["T12"], theta2=N),
    "run_down": lambda path: ls.run_down(DRAGGED, of=["F32"]),
    "run_up": lambda path: ls.run_up(PRESS, MOTOR, ratio=5.0, of=["F32"]),
    "screen": lambda path: ls.screen(PRESS, {"ground": (0.19, 0.21)}, n=3, minimize="F32_peak", theta2=N),
    "sensitivities": lambda path: ls.sensitivities(PRESS, "F32_peak", to=["ground"]),
    "size_links": lambda path: ls.size_links(PRESS, STEEL, safety=2.0),
    "size_pins": lambda path: ls.size_pins(PRESS, allowable={"shear": 6e7}, eye=0.02),
    "speed_limit": lambda path: ls.speed_limit(PRESS, "F32", below=1e5),
    "speed_separation": lambda path: ls.speed_separation(PRESS, theta2=N),
    "steady_cycle": lambda path: ls.steady_cycle(PRESS, MOTOR, ratio=5.0, flywheel=0.2, theta2=N),
    "strength": lambda path: ls.strength(PRESS, STEEL),
    "study": lambda path: ls.study(DESIGNS, path / "study.nc", of=["F32"], theta2=N).load(),
    "sweep": lambda path: ls.sweep(PRESS, N),
    "system": lambda path: ls.system(PRESS, 45.0),
    "tolerance": lambda path: ls.tolerance(PRESS, {"ground": "js9"}, of="F32_peak", n=4),
}
SLOW = {"size_links"}
APART = {"study", "open_study", "screen", "tolerance", "pareto", "run_up", "steady_cycle"}
"""Results that need a file or scenes of one design, or take seconds each."""
FILES = (
    "bearings",
    "check",
    "choose_bearings",
    "orders",
    "peaks",
    "screen",
    "sensitivities",
    "strength",
    "study",
    "sweep",
)
"""Results whose files are checked, of each form one. That of pin friction has coordinates named "loads[3].torque": CF
advises against brackets."""
CHECKER = """
import sys
from compliance_checker.runner import CheckSuite, ComplianceChecker

CheckSuite.load_all_available_checkers()
for file in sys.argv[1:]:
    ComplianceChecker.run_checker(file, ["cf:1.11"], 0, "strict", "-")
"""


@pytest.fixture(scope="module")
def results(tmp_path_factory) -> dict[str, xr.Dataset]:
    path = tmp_path_factory.mktemp("results")
    return {name: make(path) for name, make in RESULTS.items() if name not in SLOW}


def test_every_function_that_returns_a_dataset_is_tried():
    functions = {name: getattr(ls, name) for name in ls.__all__ if inspect.isfunction(getattr(ls, name))}
    returns = {name: str(inspect.signature(each).return_annotation) for name, each in functions.items()}
    assert {name for name, kind in returns.items() if "Dataset" in kind} <= {*RESULTS}


@pytest.mark.long
def test_pint_xarray_takes_every_result(results):
    """Units are spelled so that pint and UDUNITS both read them: `ds.pint.quantify()` works."""
    pytest.importorskip("pint_xarray")
    for plain in results.values():
        quantities = plain.pint.quantify()
        assert {name for name, values in quantities.items() if values.pint.units is not None} == {
            name for name, values in plain.items() if "units" in values.attrs
        }
        for name, values in quantities.pint.dequantify(format="~").items():
            np.testing.assert_array_equal(values.values, plain[name].values)


@pytest.mark.long
def test_no_design_lies_along_a_dim_that_a_result_has(results):
    """Arithmetic along both would take the diagonal; screening alone refuses scenes of many designs."""
    dims = {str(dim) for name, result in results.items() if name != "screen" for dim in result.dims}
    for dim in (dims | {"section", "cylinder", "main"}) - {"theta2", "branch", "design"}:
        with pytest.raises(
            ValueError, match=f'omega2 has a dimension "{dim}": that is the name of a result; rename it'
        ):
            replace(PRESS, omega2=xr.DataArray([10.0, 20.0], dims=dim))


@pytest.mark.parametrize(("name", "result"), [("peaks", "F32_peak"), ("flywheel", "speed"), ("size_pins", "diameter")])
def test_no_dim_of_designs_replaces_a_result(name, result, monkeypatch):
    with pytest.raises(ValueError, match=f'"?{result}"?: (that )?is the name of a result'):
        of_designs_along(result, name, monkeypatch)


@pytest.mark.long
def test_results_do_not_depend_on_the_name_of_the_dim_of_designs(results, monkeypatch):
    """Each result has the values that it has over a dim "k", or the dim's name is refused, and never is replaced."""
    for name in results.keys() - APART:
        plain = of_designs_along("k", name, monkeypatch)
        for result in map(str, plain.data_vars):
            try:
                values = of_designs_along(result, name, monkeypatch)[result]
            except ValueError:  # also xarray's MergeError
                continue
            np.testing.assert_array_equal(values, plain[result])


def of_designs_along(dim: str, name: str, monkeypatch) -> xr.Dataset:
    """Return a result of two speeds over a dim with labels."""
    scene = replace(PRESS, omega2=xr.DataArray([28.0, 30.0], {dim: [7, 8]}, dim))
    dragged = replace(scene, loads=DRAGGED.loads)
    for designs, of in (("PRESS", scene), ("DESIGNS", scene), ("DRAGGED", dragged)):
        monkeypatch.setitem(globals(), designs, of)
    return RESULTS[name](None)


@pytest.mark.long
def test_every_file_passes_a_cf_checker(results, tmp_path):
    """IOOS's compliance-checker, test cf:1.11.

    Its check of monotonic labels fails on labels that are texts, which it says itself.
    """
    if importlib.util.find_spec("compliance_checker") is None:
        pytest.skip("compliance-checker is not installed")
    for name in FILES:
        ls.save(results[name], tmp_path / f"{name}.nc")
    files = [f"{name}.nc" for name in FILES]
    checker = [sys.executable, "-W", "ignore", "-c", CHECKER, *files]
    done = subprocess.run(checker, cwd=tmp_path, capture_output=True, text=True)
    assert done.stdout.count("All tests passed!") == len(files), done.stdout + done.stderr


def parts_along(ds: xr.Dataset, dim: str) -> list[xr.Dataset]:
    """Return parts of a result: its mean along a dim, no place there, and one with its label, as a dim and without."""
    first = [ds.isel({dim: 0}), ds.isel({dim: [0]}), ds.isel({dim: 0}, drop=True)] if ds.sizes[dim] else []
    return [ds.mean(dim, keep_attrs=True), ds.isel({dim: slice(0)}), *first]


@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # numpy's, of means of nothing
@pytest.mark.parametrize("name", sorted({*RESULTS} - SLOW))
def test_every_part_of_a_result_prints(results, name):
    whole = results[name]
    for part in [each for dim in whole.dims for each in parts_along(whole, str(dim))]:
        for of_part in [part, *(each for dim in part.dims for each in parts_along(part, str(dim)))]:
            assert repr(of_part.linksweep) or not all(of_part.sizes.values())
            assert of_part.linksweep._repr_html_()


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("strength", {"link": "coupler"}), ("bearings", {"pin": "B"}), ("choose_bearings", {"pin": "B"}),
        ("breakdown", {"source": "gravity", "theta2": 30.0}), ("compare", {"balance": "after"}),
        ("orders", {"order": 1}), ("check", {"arc": 0}),
    ],
)  # fmt: skip
def test_one_place_of_a_result_shows_each_number_there(results, name, place):
    part = results[name].isel(place) if name == "check" else results[name].sel(place)
    rows = [line.split()[:2] for line in repr(part.linksweep).splitlines()]
    numbers = {key: float(each) for key, each in part.items() if each.ndim == 0 and "flag_values" not in each.attrs}
    finite = {key: value for key, value in numbers.items() if not key.endswith("_at") and np.isfinite(value)}
    assert finite and all([key, f"{value:.6g}"] in rows for key, value in finite.items())


def test_one_angle_of_systems_prints_as_its_own():
    both, one = ls.system(PRESS, [0.0, 45.0]), ls.system(PRESS, [45.0])
    assert repr(both.sel(theta2=45.0).linksweep) == repr(one.linksweep)
    assert repr(one.linksweep).splitlines()[1].split()[:4] == ["sum", "Fx", "on", "2"]


def test_a_run_that_comes_to_nothing_prints_without_its_steps():
    """0.001 N m does not start the press."""
    run = ls.run_up(PRESS, ls.Motor([0.0, 100.0], [1e-3, 0.0]), of=["F32"])
    assert repr(run.isel(step=0).linksweep) == repr(run.linksweep).splitlines()[0]
