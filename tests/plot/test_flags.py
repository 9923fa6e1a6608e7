"""Truth values of plots and drawings: a text or a name in place of one is refused, not taken as true."""

import re

import numpy as np
import pytest

import linksweep as ls

PRESS = ls.example("press")
GRID = ls.peaks(ls.grid(PRESS, {"coupler.length": [0.20, 0.22], "ground": [0.19, 0.20]}), ["F32", "F12"], theta2=24)
SAMPLE = ls.peaks(ls.sample(PRESS, {"coupler.length": (0.20, 0.24), "ground": (0.19, 0.20)}, n=4), ["F32"], theta2=24)
FLAGS = {
    "maximize": lambda flag: ls.plot.heat_map(GRID, "F32_peak", maximize=flag),
    "front": lambda flag: ls.plot.scatter(SAMPLE, x="F32_peak", y="ground", front=flag),
    "forces": lambda flag: ls.plot.mechanism(PRESS, forces=flag),
    "machine": lambda flag: ls.save_drawing(PRESS, "nowhere.svg", machine=flag),
}


@pytest.mark.parametrize("name", FLAGS)
@pytest.mark.parametrize("value", ["no", "F32_peak", 1, None, [True], np.array([True, False])], ids=repr)
def test_what_is_no_truth_value_is_refused(name, value, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ValueError, match=f"^{name} = {re.escape(repr(value))}: must be True or False$"):
        FLAGS[name](value)
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("choice", [np.argmin, np.argmax])
def test_the_best_of_a_map_is_the_least_or_the_largest_by_its_flag(choice):
    row, column = np.unravel_index(choice(GRID.F32_peak.values), GRID.F32_peak.shape)
    ax = ls.plot.heat_map(GRID, "F32_peak", x="ground", y="coupler.length", maximize=np.bool_(choice is np.argmax))
    (star,) = [line for line in ax.lines if line.get_marker() == "*"]
    assert star.get_xydata().tolist() == [[[0.19, 0.20][column], [0.20, 0.22][row]]]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"bins": "abc"}, "bins = 'abc': must be a whole number, 1 or more"),
        ({"bins": 1}, "bins = 1: must be 2 or more"),
        ({"statistic": "abc"}, "statistic = 'abc': must be one of best, mean, worst"),
    ],
)
def test_bins_of_a_map_without_bins_are_checked(options, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        ls.plot.heat_map(GRID, "F32_peak", **options)
