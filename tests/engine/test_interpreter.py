"""The interpreter gives the bits of numpy's own operations, and of exact ones rounded once, for any plan."""

import numpy as np
import pytest
from fused import EVERY

from linksweep.base import cache
from linksweep.engine.interpreter import evaluate as evaluation
from linksweep.engine.interpreter import machine
from linksweep.engine.interpreter.evaluate import evaluate
from linksweep.engine.interpreter.machine import OPERANDS, OPERATORS, TILE
from linksweep.engine.interpreter.program import programs
from linksweep.engine.kernel import machine_code
from linksweep.engine.kernel.instructions import REGISTER
from linksweep.engine.kernel.machine_code import address
from linksweep.engine.trace.graph import Graph, Node
from linksweep.engine.trace.operators import interpret
from linksweep.engine.trace.plan import Plan

SPECIAL = (0.0, -0.0, 1.0, -1.5, 1e300, -1e-310, np.inf, -np.inf, np.nan)
DIMS = ((), ("theta2",), ("mass",), ("mass", "theta2"), ("length",))
SAMPLES = (1, 3, 8, TILE - 1, TILE, TILE + 1, 3 * TILE + 5)


def drawn_plan(draw: np.random.Generator, operations: int = 60) -> Plan:
    """Return a plan of random operations, each operator in it, on inputs of all dims and on constants."""
    graph = Graph()
    nodes = [graph.input(f"x{k}", DIMS[k % len(DIMS)]) for k in range(10)]
    plain = [graph.input(f"plain{k}", DIMS[k]) for k in range(4)]
    nodes += [graph.constant(float(draw.choice(SPECIAL))) for _ in range(3)]
    conditions = [graph.apply("<", nodes[0], nodes[1])]
    for k in range(operations):
        name = OPERATORS[k % len(OPERATORS)]
        among = plain if name == "product_low" else nodes  # numpy's way to it overflows before its result does
        operands = [among[i] for i in draw.integers(0, len(among), OPERANDS.get(name, 2))]
        if name == "<":
            conditions.append(graph.apply(name, *operands))
        elif name == "where":
            nodes.append(graph.apply(name, conditions[draw.integers(len(conditions))], *operands[1:]))
        else:
            nodes.append(graph.apply(name, *operands))
    results = [node for node in (*nodes, *conditions) if node.operands]
    chosen = draw.permutation(len(results))[:12]
    return Plan("theta2", {f"y{i}": results[i] for i in chosen} | {"first": nodes[0], "angle": nodes[1]}, ())


def drawn_values(draw: np.random.Generator, plan: Plan, sizes: dict[str, int]) -> dict[Node, np.ndarray | np.float64]:
    values: dict[Node, np.ndarray | np.float64] = {}
    for node in plan.nodes:
        if node.operator == "input":
            shape = [sizes[dim] if dim in node.dims else 1 for dim in (*plan.loops, plan.index)]
            numbers = draw.standard_normal(shape) * 10.0 ** draw.integers(-30, 30, shape)
            some = draw.random(shape) < (0.0 if node.value.startswith("plain") else 0.2)
            numbers[some] = draw.choice(SPECIAL, np.count_nonzero(some))
            values[node] = numbers if node.dims else np.float64(numbers.item())
    return values


@pytest.mark.parametrize("samples", SAMPLES)
def test_interpreted_as_by_numpy(samples):
    draw = np.random.default_rng(samples)
    for _ in range(20):
        plan, sizes = drawn_plan(draw), {"theta2": samples, "mass": 3, "length": 2}
        values = drawn_values(draw, plan, sizes)
        expected = interpret(plan.nodes, dict(values), EVERY)
        result = evaluate(plan, dict(values), sizes)
        for node in plan.outputs.values():
            theirs = np.broadcast_to(np.asarray(expected[node], dtype=np.float64), np.shape(result[node]))
            ours = np.asarray(result[node], dtype=np.float64)
            np.testing.assert_array_equal(np.isnan(ours), np.isnan(theirs))
            number = ~np.isnan(ours)
            np.testing.assert_array_equal(ours[number].view(np.int64), theirs[number].view(np.int64))


@pytest.mark.parametrize("samples", [0, 3])
def test_rows_have_room_for_a_vector(samples, monkeypatch):
    """A vector is read and written whole: also where a search near zero has no sample to evaluate."""
    draw, room = np.random.default_rng(7), []

    def recorded(array: np.ndarray) -> int:
        room.append(array.shape[-1])
        return address(array)

    monkeypatch.setattr(evaluation, "address", recorded)
    plan, sizes = drawn_plan(draw), {"theta2": samples, "mass": 3, "length": 2}
    result = evaluate(plan, drawn_values(draw, plan, sizes), sizes)
    assert min(room) >= REGISTER
    assert {np.shape(result[node])[-1] for node in plan.outputs.values() if "theta2" in node.dims} == {samples}


def test_registers_are_used_again():
    graph = Graph()
    value = graph.input("x", ("theta2",))
    for _ in range(100):
        value = (value * value).sqrt()
    (program,) = programs(Plan("theta2", {"y": value}, ()))
    assert program.registers == 1


def test_kept_code_is_used_again(tmp_path, monkeypatch):
    monkeypatch.setattr(cache, "cache_folder", lambda: tmp_path)
    machine._function.__wrapped__()
    (kept,) = tmp_path.iterdir()
    monkeypatch.setattr(machine_code, "_optimised", lambda *_: pytest.fail("compiled again"))
    machine._function.__wrapped__()
    kept.write_bytes(kept.read_bytes()[:-1])
    with pytest.raises(pytest.fail.Exception, match="compiled again"):
        machine._function.__wrapped__()
