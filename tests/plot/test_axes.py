"""Axes that plots draw into: anything else is refused by its kind, such as the array of axes of several panels."""

import inspect

import pytest
from drawn import closed_figures, plt  # noqa: F401

import linksweep as ls

PRESS, N = ls.example("press"), 24
MOTOR = ls.InductionMotor("1500 rpm", "15 N m", rated_torque="6 N m", rated_speed="1425 rpm", inertia=0.004)
CYCLE = ls.sweep(PRESS, N)
SAMPLE = ls.peaks(ls.sample(PRESS, {"coupler.length": (0.20, 0.24), "ground": (0.19, 0.20)}, n=4), ["F32"], theta2=N)
DRAWS = {
    "bearing": (CYCLE,),
    "breakdown": (ls.breakdown(PRESS, "F32", theta2=N),),
    "flywheel": (ls.flywheel(PRESS, fluctuation=0.02, theta2=N),),
    "forces": (CYCLE,),
    "heat_map": (SAMPLE, "F32_peak"),
    "hodograph": (ls.sweep(PRESS, N, of=["Fsx", "Fsy"]),),
    "mechanism": (PRESS,),
    "moment_diagram": (PRESS, "coupler"),
    "motor_load": (ls.motor_load(PRESS, MOTOR, ratio=5.0, theta2=N), MOTOR),
    "orders": (ls.orders(ls.sweep(PRESS, N, of=["Fsx"]), ["Fsx"], n=3),),
    "over_speed": (PRESS, "F32"),
    "parallel_coordinates": (SAMPLE,),
    "run_up": (ls.run_up(PRESS, MOTOR, ratio=5.0, of=["F32"]),),
    "scatter": (SAMPLE,),
    "tornado": (ls.tolerance(PRESS, {"ground": "js9"}, of="F32_peak", n=4),),
    "torque": (CYCLE,),
}
OPTIONS = {"scatter": {"x": "F32_peak", "y": "ground"}, "over_speed": {"speeds": [10.0, 20.0]}}


def test_every_plot_into_axes_is_tried():
    plots = {name: getattr(ls.plot, name) for name in ls.plot.__all__}
    assert {name for name, draw in plots.items() if "ax" in inspect.signature(draw).parameters} == {*DRAWS}


@pytest.mark.parametrize("name", DRAWS)
def test_what_is_no_axes_is_refused(name):
    figure, axes = plt.subplots(2)
    for other, kind in ((axes, "ndarray"), ([*axes], "list"), (figure, "Figure"), (plt, "module"), ("left", "str")):
        with pytest.raises(ValueError, match=rf"^ax is a {kind}: must be one Axes of matplotlib, as figure\.axes\[0\]"):
            getattr(ls.plot, name)(*DRAWS[name], ax=other, **OPTIONS.get(name, {}))
    assert getattr(ls.plot, name)(*DRAWS[name], ax=axes[1], **OPTIONS.get(name, {})) is axes[1]
