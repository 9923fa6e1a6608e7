"""Evaluate the signals of a plan for several designs side by side, one in each lane.

    prepare(inputs, constants)                              numbers of designs from their parameters
    sample(constants, x, rows)                              all signals at all samples of the turn
    evaluate(constants, table, x, value, far, signal, first, last)
                                                            one signal at one place in each lane `first` … `last`

The last takes the numbers of rows of a table: of the place, the value, the half turn and the signal's number.

Arrays have a row of lanes for each number, one after the other. `constants` begins with the widths of the near-toggles;
`x` of `sample` has the tangents of samples of each half turn, with one more on either side. Those before the middle
mirror those after it, and share all operations whose results are the same there, or opposite.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from linksweep.engine.interpreter.evaluate import evaluate
from linksweep.engine.kernel.instructions import REGISTER as LANES
from linksweep.engine.kernel.instructions import Instructions
from linksweep.engine.kernel.machine_code import INTEGER, ROW, TABLE, MachineCode, machine_code
from linksweep.engine.peaks.search import HALF, PLACED, SAMPLES
from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.operators import interpret
from linksweep.engine.trace.parity import parities
from linksweep.engine.trace.plan import Plan

Values = dict[Node, Any]
"""Values of nodes: numbers, arrays, or instructions that compute vectors."""
SOURCE = inspect.getsource(sys.modules[__name__]) + inspect.getsource(parities)
"""All that enters the machine code besides nodes and instructions."""
TANGENT, FAR = "half_tangent", "far_half"
"""Inputs that place a sample: the tangent of half its angle from the middle of its half turn, and which half."""
ALONG, END = "piece_tangent", "piece_end"
"""Inputs that place a sample on a piece of the turn instead, which a turn follows there and back: the tangent of half
the angle from the piece's start or end, and which of the two."""
NEAR_WIDTH, FAR_WIDTH = "near_toggle_near", "near_toggle_far"
"""Widths of the near-toggles in those middles."""


class Functions(NamedTuple):
    """The three functions, the number of their lanes, and that of the constants of a design."""

    lanes: int
    constants: int
    prepare: Callable[..., Any]
    sample: Callable[..., Any]
    evaluate: Callable[..., Any]

    @property
    def passed(self) -> list[Any]:
        """The three as a search takes them: compiled ones by their addresses."""
        return [each.address if isinstance(each, MachineCode) else each for each in self[2:]]


class Evaluators:
    """Evaluators of some of a plan's outputs, its signals."""

    def __init__(self, plan: Plan, signals: tuple[str, ...]) -> None:
        self.plan, self.signals = plan, [plan.outputs[signal] for signal in signals]
        place = {node.value: node for node in plan.nodes if node.operator == "input"}
        self.even = ALONG in place
        """True where signals are the same at opposite tangents: on the way there and back."""
        self.tangent, self.far = (place[ALONG], place[END]) if self.even else (place[TANGENT], place[FAR])
        work = [node for node in plan.nodes if node.operator not in ("input", "constant")]
        self.inputs = [node for node in place.values() if node not in (self.tangent, self.far)]
        self.of_designs = [node for node in work if not self._turns(node)]
        self.at_samples = [node for node in work if self._turns(node)]
        used = {x for node in self.at_samples for x in node.operands if x.operator != "constant" and not self._turns(x)}
        widths = [plan.outputs[NEAR_WIDTH], plan.outputs[FAR_WIDTH]]
        self.constants = [*widths, *sorted(used, key=lambda node: node.position)]
        self.fixed = [node for node in plan.nodes if node.operator == "constant"]

    def _turns(self, node: Node) -> bool:
        """Return whether a node depends on the place."""
        return self.plan.index in node.dims

    # ------------------------------------------------------------------------------------------ interpreted

    @cached_property
    def interpreted(self) -> Functions:
        """The functions by the interpreter, for one lane: its constants are the widths, and the parameters as such."""
        return Functions(1, 2 + len(self.inputs), self._prepare, self._sample, self._evaluate)

    def _prepare(self, inputs: np.ndarray, constants: np.ndarray) -> None:
        constants[2:] = inputs
        here = self._at(constants, np.zeros(1), 0.0)
        constants[:2] = [here[node].item() for node in self.constants[:2]]

    def _sample(self, constants: np.ndarray, x: np.ndarray, rows: np.ndarray) -> None:
        values = self._at(constants, x.reshape(2, PLACED)[:, 1:-1].ravel(), np.repeat([0.0, 1.0], 2 * HALF))
        for k, signal in enumerate(self.signals):
            rows[k : SAMPLES * len(self.signals) : len(self.signals)] = values[signal].ravel()

    def _evaluate(self, constants, table, x: int, value: int, far: int, signal: int, first: int, last: int) -> None:
        lanes = table[:, first:last]
        here = self._at(constants, lanes[x], lanes[far])
        every = [here[node].ravel() for node in self.signals]
        lanes[value] = np.choose(lanes[signal].astype(int), every)

    def _at(self, constants: np.ndarray, tangent: np.ndarray, far: Any) -> Values:
        """Return the values of all signals at places."""
        plan, axes = self.plan, [1] * len(self.plan.loops)
        values: Values = {
            node: np.full(axes, x) if node.dims else x for node, x in zip(self.inputs, constants[2:], strict=True)
        }
        places = {self.tangent: tangent, self.far: np.broadcast_to(far, tangent.shape)}
        values |= {node: place.reshape([*axes, -1]) for node, place in places.items()}
        return evaluate(plan, values, dict.fromkeys(plan.loops, 1) | {plan.index: len(tangent)})

    # --------------------------------------------------------------------------------------------- compiled

    @cached_property
    def compiled(self) -> Functions:
        """The functions as machine code, for `LANES` lanes."""
        text = self._text()
        return Functions(
            LANES,
            len(self.constants),
            machine_code(self._emit_prepare, (ROW, ROW), text),
            machine_code(self._emit_sample, (ROW, ROW, ROW), text),
            machine_code(self._emit_evaluate, (ROW, TABLE, *[INTEGER] * 6), text),
        )

    def _emit_prepare(self, builder: Any, inputs: Any, constants: Any) -> None:
        vectors = Instructions(builder)
        values = self._row(vectors, inputs, self.inputs)
        interpret([*self.fixed, *self.of_designs], values, vectors.operators)
        for k, node in enumerate(self.constants):
            vectors.store(values[node], constants.data, vectors.integer(k * LANES))

    def _emit_sample(self, builder: Any, constants: Any, x: Any, rows: Any) -> None:
        """Emit a loop over both half turns, and in it one over the samples from the middle on, each with its mirror."""
        vectors = Instructions(builder)
        integer, of, known = vectors.integer, builder.mul, self._row(vectors, constants, self.constants)
        size, half = integer(len(self.signals) * LANES), integer(HALF)
        with (
            vectors.loop(integer(0), integer(2)) as (turn, _),
            vectors.loop(integer(0), integer(HALF + 1)) as (k, _),
        ):
            at = builder.add(of(turn, integer(PLACED)), builder.add(integer(1 + HALF), k))
            place = {
                self.tangent: vectors.load(x.data, of(at, integer(LANES))),
                self.far: builder.uitofp(turn, vectors.double),
            }
            here = self._emitted(vectors, known | place)
            middle = builder.add(of(turn, integer(2 * HALF)), half)
            for there, sample in (
                (self._mirrored(vectors, here), builder.sub(middle, k)),
                (here, builder.add(middle, k)),
            ):
                for s, signal in enumerate(self.signals):
                    vectors.store(there[signal], rows.data, builder.add(of(sample, size), integer(s * LANES)))

    def _mirrored(self, vectors: Instructions, here: Values) -> Values:
        """Return the values at the opposite tangents; only operations that are neither even nor odd are repeated."""
        there = dict(here)
        for node in [self.tangent, *self.at_samples]:
            parity = self.parity[node]
            if parity < 0:
                there[node] = vectors.operators["negate"](here[node])
            elif parity == 0:
                interpret([node], there, vectors.operators)
        return there

    @cached_property
    def parity(self) -> dict[Node, int]:
        """1 for nodes with the same value at opposite tangents, −1 for those with opposite ones, else 0."""
        return parities(self.plan.nodes, {self.tangent: -1})

    def _emit_evaluate(
        self, builder: Any, constants: Any, table: Any, x: Any, value: Any, far: Any, signal: Any, first: Any, last: Any
    ) -> None:
        vectors = Instructions(builder)
        known, length = self._row(vectors, constants, self.constants), table.shape[1]
        with vectors.loop(first, last, LANES) as (lane, _):
            at = [builder.add(builder.mul(length, row), lane) for row in (x, far, signal, value)]
            tangent, half, number = (vectors.load(table.data, place) for place in at[:3])
            here = self._emitted(vectors, known | {self.tangent: tangent, self.far: half})
            chosen = here[self.signals[0]]
            for k, node in enumerate(self.signals[1:], 1):
                chosen = vectors.operators["where"](vectors.operators["=="](number, k), here[node], chosen)
            vectors.store(chosen, table.data, at[3])

    def _emitted(self, vectors: Instructions, values: Values) -> Values:
        """Return all values at a place, from those of the designs and of the place."""
        return interpret([*self.fixed, *self.at_samples], values, vectors.operators)

    def _row(self, vectors: Instructions, array: Any, nodes: list[Node]) -> Values:
        """Return the values of nodes that an array holds one after the other."""
        return {node: vectors.load(array.data, vectors.integer(k * LANES)) for k, node in enumerate(nodes)}

    def _text(self) -> str:
        """Return a text that differs wherever the functions do."""
        nodes = {node: k for k, node in enumerate(self.plan.nodes)}
        lines = [(node.operator, node.value, [nodes[x] for x in node.operands]) for node in nodes]
        roles = [[nodes[node] for node in role] for role in (self.inputs, self.constants, self.signals)]
        return f"{SOURCE} {HALF} {lines} {roles}"
