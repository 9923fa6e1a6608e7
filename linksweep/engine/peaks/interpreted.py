"""Evaluate the signals of a plan by the interpreter, one design at a time: `engine.peaks.evaluators` for one lane."""

from __future__ import annotations

from typing import Any

import numpy as np

from linksweep.engine.interpreter.evaluate import evaluate
from linksweep.engine.peaks.lanewise import Values
from linksweep.engine.peaks.roles import Roles


class Interpreted:
    """The functions of evaluators without a kernel. Constants of a design are its widths and its parameters."""

    def __init__(self, roles: Roles) -> None:
        self.roles = roles

    def prepare(self, front: int, designs: int, sizes, parameters, parameter_at, constants: np.ndarray) -> None:
        digit = dict(zip(self.roles.dims, np.unravel_index(front, tuple(sizes)), strict=True))
        size = dict(zip(self.roles.dims, sizes, strict=True))
        for k, node in enumerate(self.roles.inputs):
            place = 0
            for dim in (dim for dim in self.roles.plan.loops if dim in node.dims):
                place = place * size[dim] + digit[dim]
            constants[2 + k] = parameters[parameter_at[k] + place]
        here = self._at(constants, np.zeros(1), 0.0)
        constants[:2] = [np.asarray(here[node]).item() for node in self.roles.constants[:2]]

    def enter(self, front: int, piece: int, sizes, parameters, parameter_at, constants: np.ndarray) -> None:
        designs = np.prod(sizes[1:], dtype=int)
        self.prepare(piece * designs + front, designs, sizes, parameters, parameter_at, constants)

    def share(self, constants: np.ndarray, x: np.ndarray) -> None:
        """Do nothing: all is computed for each design."""

    def sample(self, constants: np.ndarray, x: np.ndarray, rows: np.ndarray) -> None:
        (near, far), signals = x.reshape(2, -1), self.roles.signals
        places = near if self.roles.anywhere else np.stack([near[1:-1], far[1:-1]])
        half = far if self.roles.anywhere else np.repeat([0.0, 1.0], places.shape[1])
        values = self._at(constants, places.ravel(), half)
        for k, signal in enumerate(signals):
            rows[k : places.size * len(signals) : len(signals)] = np.ravel(values[signal])

    def evaluate(self, constants, table, x: int, value: int, far: int, signal: int, first: int, last: int) -> None:
        lanes = table[:, first:last]
        here = self._at(constants, lanes[x], lanes[far])
        every = np.stack([np.broadcast_to(np.ravel(here[node]), last - first) for node in self.roles.signals])
        number = lanes[signal].astype(int) if signal >= 0 else np.arange(last)
        lanes[value] = every[number, np.arange(last - first)]  # np.choose takes 64 signals at most

    def _at(self, constants: np.ndarray, tangent: np.ndarray, far: Any) -> Values:
        """Return the values of all signals at places."""
        plan, inputs, axes = self.roles.plan, self.roles.inputs, [1] * len(self.roles.plan.loops)
        values: Values = {
            node: np.full(axes, x) if node.dims else x for node, x in zip(inputs, constants[2:].tolist(), strict=True)
        }
        places = {self.roles.tangent: tangent, self.roles.far: np.broadcast_to(far, tangent.shape)}
        values |= {node: place.reshape([*axes, -1]) for node, place in places.items()}
        return evaluate(plan, values, dict.fromkeys(plan.loops, 1) | {plan.index: len(tangent)})
