"""Random linkages of every family agree with multibody equations in 50 digits.

Ten of each, thirty every night; a thousand: ``python -m benchmarks.stress.linkages --designs 1000``.
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
from benchmarks.stress.linkages.topologies import ALL, COUPLED


@pytest.fixture(autouse=True)
def uncompiled():
    """Run uncompiled: equal numbers (see test_bits) without compile time."""
    with way("interpreted"):
        yield


@pytest.mark.parametrize("designs", long_but([10, 30], 10, nightly=[30]))
@pytest.mark.parametrize("name", ALL)
def test_linkages_reach_the_goals(name, designs):
    figures = [errors.errors_of(solution) for solution in front_door.solutions(name, designs, 2026, at_once=5)]
    total = front_door.joined(figures)
    assert front_door.missed(name, total) == []
    assert total.designs == designs
    assert len(total.force) > (0.4 if name in COUPLED else 0.6) * designs  # friction jams many of them


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


def test_the_command_prints_a_row_for_each_family(capsys):
    assert front_door.main(["--designs", "4", "--only", "Watt"]) == 0
    printed = capsys.readouterr().out
    rows = [line.split(" | ")[:2] for line in printed.splitlines() if line.startswith("| Watt")]
    assert rows == [[f"| {name}", "4"] for name in ALL if "Watt" in name]
    assert "Goals missed: none." in printed


OUT_OF_REACH = {
    "Watt I": {"C": ("coupler", "rocker"), "G": ("link", "arm")},
    "Stephenson III": {"C": ("coupler", "rocker"), "F": ("rod", "output")},
    "Jansen leg": {"C": ("j", "top"), "F": ("k", "c"), "G": ("f", "foot")},
}
"""By topology: links without which a pin cannot be reached; those of the others reach theirs."""


@pytest.mark.parametrize(
    ("name", "links"), [(name, links) for name, pins in OUT_OF_REACH.items() for links in pins.values()]
)
def test_status_where_a_pin_is_out_of_reach(name, links):
    """At a fifth of their lengths two links that met at 25 to 155 degrees meet nowhere."""
    (solution,) = front_door.solutions(name, 5, 3)
    linkages = solution.assembly.linkages
    shorter = {role: {**linkages.parts[role], "length": 0.2 * linkages.parts[role]["length"]} for role in links}
    scene = scene_of(replace(linkages, parts={**linkages.parts, **shorter}))
    cycle = ls.sweep(scene, [linkages.theta2], of=["F12"])
    assert np.all(cycle.status == 1) and np.all(np.isnan(cycle.F12))
