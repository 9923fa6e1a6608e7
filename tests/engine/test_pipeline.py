"""Loops in stages: every operation reads the values of its own vector, and no more wait in registers than there are."""

from collections import Counter

import pytest

import linksweep as ls
from linksweep.engine.kernel import pipeline, waiting
from linksweep.engine.trace.plan import plan

MACHINES = ("watt-2", "knuckle-press", "jansen-leg")


def loop(name: str) -> list:
    """Return the operations per angle of all unknowns of an example."""
    machine = ls.example(name)
    request = plan(machine.table, machine.mechanism.unknowns(machine.drive), machine.inputs.forms)
    return [node for node in request.nodes if "theta2" in node.dims and node.operands]


@pytest.mark.parametrize("name", MACHINES)
def test_operations_read_what_their_vector_has_stored(name):
    """Values are told apart by their operation and the number of their vector."""
    work = loop(name)
    stages, places, read, kept = pipeline.pipeline(work)
    assert {*stages} == {*work}
    in_memory: dict = {}
    at_end: dict = {}
    for number in range(12):
        known = {(x, stage): at_end.get((x, stage - 1)) for x, stage in kept}
        for node, stage in stages.items():
            vector = number - stage
            for x in read.get(node, ()):
                known[x, stage] = in_memory.get((places[x], (number - stage + stages[x]) % places[x].vectors))
            for x in node.read:
                assert x not in stages or vector < 0 or known[x, stage] == (x, vector)
            known[node, stage] = node, vector
            if node in places:
                in_memory[places[node], number % places[node].vectors] = node, vector
        at_end = known


@pytest.mark.parametrize("name", MACHINES)
def test_values_fit_into_the_registers(name):
    length, start = pipeline._schedule(loop(name))
    every = waiting.gaps(start)
    in_memory = waiting.in_memory(every, length)
    numbers = [gap for gap in every if gap.value.operator != "<"]  # conditions have registers of their own
    held = Counter(cycle % length for gap in numbers if gap not in in_memory for cycle in gap.cycles)
    assert max(held.values()) <= waiting.REGISTERS
    assert 0 < len({gap.value for gap in in_memory}) < len(start) / 4  # few values are stored
