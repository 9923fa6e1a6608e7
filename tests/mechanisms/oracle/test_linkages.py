"""Random linkages of every topology agree with multibody equations in 50 digits.

Ten of each, fifty with the long tests; a thousand: ``python -m benchmarks.stress.linkages --designs 1000``.
"""

from dataclasses import replace

import numpy as np
import pytest
from long import long_but

import linksweep as ls
from benchmarks.speed.kernel import way
from benchmarks.stress.linkages import __main__ as front_door
from benchmarks.stress.linkages import errors
from benchmarks.stress.linkages.scene import scene_of
from benchmarks.stress.linkages.topologies import TOPOLOGIES


@pytest.fixture(autouse=True)
def uncompiled():
    """Run uncompiled: equal numbers (see test_bits) without compile time."""
    with way("interpreted"):
        yield


def solutions(name, seed, designs=4):
    return front_door.solutions(name, designs, seed, at_once=2)


@pytest.mark.parametrize("designs", long_but([10, 50], 10))
@pytest.mark.parametrize("name", TOPOLOGIES)
def test_linkages_reach_the_goals(name, designs):
    figures = [errors.errors_of(solution) for solution in front_door.solutions(name, designs, 2026, at_once=5)]
    total = front_door.joined(figures)
    assert front_door.missed(name, total) == []
    assert total.designs == designs
    assert len(total.force) > 0.6 * designs


@pytest.mark.parametrize("wrong_by", [3e-12, -3e-12])
def test_the_suite_detects_wrong_forces(monkeypatch, wrong_by):
    sweep = ls.sweep

    def slightly_wrong(*arguments, **options):
        cycle = sweep(*arguments, **options)
        return cycle.assign(F32x=cycle.F32x * (1.0 + wrong_by), F32y=cycle.F32y * (1.0 + wrong_by))

    monkeypatch.setattr(ls, "sweep", slightly_wrong)
    missed = " ".join(front_door.missed("Watt II", front_door.checked("Watt II", 20, 1)))
    assert "force" in missed and "bound" in missed
    assert "motion" not in missed


def test_the_command_prints_a_row_for_each_topology(capsys):
    assert front_door.main(["--designs", "4", "--only", "Watt"]) == 0
    printed = capsys.readouterr().out
    assert [line.split(" | ")[1] for line in printed.splitlines() if line.startswith("| Watt")] == ["4"] * 2
    assert "Goals missed: none." in printed


def reached(solution, shorter):
    """Return status and place of what failed, with the links of one dyad shorter."""
    linkages = solution.assembly.linkages
    parts = {
        role: {**part, "length": part["length"] * (0.2 if role in shorter else 1.0)}
        for role, part in linkages.parts.items()
    }
    scene = scene_of(replace(linkages, parts=parts))
    cycle = ls.sweep(scene, [linkages.theta2], of=["status", "status_at"])
    return cycle.status.values.ravel(), cycle.status_at


@pytest.mark.parametrize(("shorter", "pin"), [(("coupler", "rocker"), "C"), (("rod", "output"), "F")])
def test_status_names_the_pin_that_is_out_of_reach(shorter, pin):
    (solution,) = front_door.solutions("Watt II", 5, 3)
    status, at = reached(solution, shorter)
    assert np.all(status == 1)
    meaning = dict(zip(at.flag_values, at.flag_meanings.split(), strict=True))
    assert {meaning[value] for value in at.values.ravel()} == {pin}
