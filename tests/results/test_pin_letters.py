"""The letter of a pin is its force, wherever quantities are named: "B" is F32, "B_peak" F32_peak."""

import inspect

import numpy as np
import pytest
import xarray as xr
from drawn import closed_figures, plt  # noqa: F401
from long import long_but

import linksweep as ls

PRESS, N = ls.example("press"), 24
LENGTHS = {"coupler.length": (0.2, 0.24), "rocker.length": (0.16, 0.2)}
STUDY = ls.peaks(ls.sample(PRESS, LENGTHS, n=8), of=["F32", "T12"], theta2=N)
CYCLE = ls.sweep(PRESS, N)
MADE = {"ground": "js9"}
MOTOR = ls.Motor([0.0, 1e4], [1e6, 0.0], inertia=0.01)

CALLS = {
    "sweep": lambda name, path: ls.sweep(PRESS, N, of=name),
    "peaks": lambda name, path: ls.peaks(PRESS, of=[name, f"{name}_rms"], theta2=N),
    "study": lambda name, path: ls.study(PRESS, path / f"{name}.nc", of=[name], theta2=N).load(),
    "screen": lambda name, path: ls.screen(
        PRESS, LENGTHS, n=4, minimize=f"{name}_peak", subject_to={f"{name}_peak": (None, 400.0)}, of=[name],
        bins={f"{name}_peak": [300.0, 400.0]}, theta2=N,
    ),
    "pareto": lambda name, path: ls.pareto(STUDY, minimize=f"{name}_peak", maximize=["T12_peak"]),
    "objective": lambda name, path: ls.objective(
        PRESS, LENGTHS, minimize=f"{name}_peak", subject_to={f"{name}_peak": (None, 400.0)}, of=[name], theta2=N
    )([[0.21], [0.17]]),
    "breakdown": lambda name, path: ls.breakdown(PRESS, name, theta2=N),
    "orders": lambda name, path: ls.orders(CYCLE, name, n=3),
    "speed_limit": lambda name, path: ls.speed_limit(PRESS, name, below=1e5),
    "sensitivities": lambda name, path: ls.sensitivities(PRESS, f"{name}_peak", to=["ground"]),
    "tolerance": lambda name, path: ls.tolerance(PRESS, MADE, of=f"{name}_peak", n=4),
    "compare": lambda name, path: ls.compare(PRESS, PRESS, of=[f"{name}_peak"], theta2=N),
    "best_counterweights": lambda name, path: ls.best_counterweights(
        PRESS, {f"{name}_rms": 1.0}, radius=0.06, most=0.5, theta2=N
    ),
    "pin_friction": lambda name, path: ls.pin_friction(
        PRESS, {"B": ls.Bearing(diameter=0.02, friction=0.1)}, of=[name], theta2=N
    ),
    "run_down": lambda name, path: ls.run_down(PRESS, until=0.99, turns=0.1, of=[name]),
    "run_up": lambda name, path: ls.run_up(PRESS, MOTOR, until=1e-3, of=[name]),
    "plot.bearing": lambda name, path: CYCLE.linksweep.bearing(name),
    "plot.forces": lambda name, path: CYCLE.linksweep.forces([name]),
    "plot.breakdown": lambda name, path: ls.breakdown(PRESS, "F32", theta2=N).linksweep.breakdown(name),
    "plot.heat_map": lambda name, path: STUDY.linksweep.heat_map(f"{name}_peak", contours=f"{name}_peak", bins=3),
    "plot.scatter": lambda name, path: STUDY.linksweep.scatter(x=f"{name}_peak", y="T12_peak", color=f"{name}_peak"),
    "plot.parallel_coordinates": lambda name, path: STUDY.linksweep.parallel_coordinates(
        [f"{name}_peak", "T12_peak"], minimize=f"{name}_peak", color=f"{name}_peak"
    ),
    "plot.over_speed": lambda name, path: ls.plot.over_speed(PRESS, name, speeds=[10.0, 20.0]),
    "plot.hodograph": lambda name, path: CYCLE.linksweep.hodograph(name),
    "plot.orders": lambda name, path: ls.orders(CYCLE, "F32", n=3).linksweep.orders(name),
    "plot.tornado": lambda name, path: ls.tolerance(PRESS, MADE, of="F32_peak", n=0).linksweep.tornado(f"{name}_peak"),
}  # fmt: skip
NO_PINS = {
    "geometry": "of findings about motion",
    "regressor": "of components, which a letter does not name: Bx is where B is",
    "speed_separation": "of components",
    "plot.torque": "of efforts of the drive",
}
"""Functions that name quantities among which there is no pin's load."""
NAMES = {"of", "minimize", "maximize", "subject_to", "color", "contours", "outputs"}
"""Parameters that name quantities."""


def numbers(result) -> str:
    """Return the numbers of a result, or of the lines and colours of its plots."""
    if isinstance(result, xr.Dataset):
        return repr([(str(name), values.values.tolist()) for name, values in result.items()])
    if not hasattr(np.ravel(result)[0], "lines"):
        return repr(result)
    lines = [line.get_xydata().tolist() for ax in np.ravel(result) for line in ax.lines]
    colors = [each.get_array() for ax in np.ravel(result) for each in ax.collections]
    lines += [bar.get_height() for ax in np.ravel(result) for bar in ax.patches if hasattr(bar, "get_height")]
    return repr(lines + [np.ma.asarray(each).tolist() for each in colors if each is not None])


@pytest.mark.parametrize("name", long_but(CALLS, "sweep", "screen", "pareto", "objective", "orders", "plot.scatter"))
def test_a_letter_gives_what_the_force_gives(name, tmp_path):
    by_letter, by_name = (numbers(CALLS[name](word, tmp_path)) for word in ("B", "F32"))
    assert by_letter == by_name and len(by_name) > 10


def test_every_function_that_names_quantities_is_tried():
    functions = {name: getattr(ls, name) for name in ls.__all__ if inspect.isfunction(getattr(ls, name))}
    functions |= {f"plot.{name}": getattr(ls.plot, name) for name in ls.plot.__all__}
    naming = {name for name, each in functions.items() if NAMES & {*inspect.signature(each).parameters}}
    assert naming - {*CALLS} - {*NO_PINS} == set()


def test_a_letter_that_several_joints_share_is_refused_with_their_names():
    scene = ls.example("knuckle-press")
    with pytest.raises(ValueError, match=r"^minimize: several links share pin C; name one of C:"):
        ls.screen(scene, {"crank.length": (0.05, 0.06)}, n=2, minimize="C_peak", theta2=N)
    letter = next(pin for pin in scene.mechanism.pins if ":" in pin)
    peaks = ls.peaks(ls.sample(scene, {"omega2": (5.0, 6.0)}, n=3), of=[letter], theta2=N)
    assert ls.pareto(peaks, minimize=[f"{letter}_peak"]).sizes["design"] == 1
