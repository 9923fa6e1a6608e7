"""Translate functions of plain Python, which also run as they are, to machine code.

    def rise(samples, first, result):
        for k in range(first, len(samples) - 1):
            if samples[k] < samples[k + 1]:
                result[0] += samples[k + 1] - samples[k]

There are numbers, conditions, tuples of such, and arrays that lie in memory without gaps; + − × ÷ // %, comparisons,
`and`, `or`, `not`, `len`, `min`, `max`, `abs`, `int`, `float`; `if`, `while`, loops over ranges and over tuples; and
functions that call each other. A name has one type, that of the value it takes first. A call is translated in its
place, so there is no recursion. Nobody checks that an index is at least 0 and below the length, nor that no integer is
divided by 0.

What is written as instructions already, an object with a method `emit(builder, *arguments)` and a `text` that differs
wherever they do, is called like a function; so is a function that also is plain Python, but `written_by` another one.
"""

from __future__ import annotations

import ast
import builtins
import inspect
import sys
from collections.abc import Callable
from functools import cache, partial, reduce
from types import FunctionType, ModuleType
from typing import Any, NamedTuple, NoReturn

from linksweep.engine.kernel import values
from linksweep.engine.kernel.instructions import Instructions, call
from linksweep.engine.kernel.machine_code import Array, MachineCode, machine_code, write_call
from linksweep.engine.kernel.values import ARITHMETIC, COMPARISONS, Values, each

SOURCE = inspect.getsource(sys.modules[__name__]) + inspect.getsource(values)
"""All that enters the machine code besides functions and instructions."""


def written_by(write: Callable[..., Any]) -> Callable[[Callable], Any]:
    """Return a decorator: where calls of a function are translated, `write(instructions, *arguments)` writes them."""

    def mark(function: Callable) -> Callable:
        vars(function).update(
            emit=lambda builder, *arguments: write(Instructions(builder), *arguments),
            text=inspect.getsource(sys.modules[write.__module__]),
        )
        return function

    return mark


@cache
def translated(function: Callable, kinds: tuple[str, ...]) -> MachineCode:
    """Return a function as machine code, for these kinds of arguments; it returns an integer or nothing."""

    def emit(builder: Any, *arguments: Any) -> Any:
        return Translator(builder).of_call(function, arguments)

    emit.__name__ = function.__name__
    return machine_code(emit, kinds, f"{SOURCE} {'  '.join(_texts(function))}")


def _texts(function: Any) -> list[str]:
    """Return texts that differ wherever a function, or what it calls, does."""
    texts: dict[str, str] = {}
    waiting = [function]
    while waiting:
        code, names = (one := waiting.pop()).__code__, one.__globals__
        texts[f"{one.__module__}.{one.__name__}"] = (
            f"{code.co_code!r} {code.co_consts} {code.co_names} {code.co_varnames}"
        )
        for name in code.co_names:
            value = names.get(name)
            key = f"{getattr(value, '__module__', one.__module__)}.{name}"
            if hasattr(value, "emit"):
                texts[f"{one.__module__}.{name}"] = value.text
            elif isinstance(value, FunctionType) and value is not call and key not in texts:
                waiting.append(value)
            elif isinstance(value, int | float | tuple):
                texts[f"{one.__module__}.{name}"] = repr(value)
    return [f"{name}: {text}" for name, text in sorted(texts.items())]


class Frame(NamedTuple):
    """A call that is being translated: its function, the slots of its names, where it ends, and the slots of what it
    returns (a list of none or one)."""

    function: Any
    slots: dict[str, Any]
    end: Any
    result: list[Any]


class Translator(Values):
    """Translator of calls, in the place of a builder."""

    def __init__(self, builder: Any) -> None:
        super().__init__(builder)
        self.frames: list[Frame] = []
        self.loops: list[Any] = []
        """The blocks after the loops that are being translated."""

    @property
    def frame(self) -> Frame:
        return self.frames[-1]

    def of_call(self, function: Any, arguments: Any) -> Any:
        """Translate a call, and return what it returns."""
        (definition,) = ast.parse(inspect.getsource(function)).body
        frame = Frame(function, {}, self.builder.append_basic_block(), [])
        self.frames.append(frame)
        for parameter, value in zip(definition.args.args, arguments, strict=True):  # type: ignore[attr-defined]
            self._assign_name(parameter.arg, value)
        self._statements(definition.body)  # type: ignore[attr-defined]
        self._go(frame.end)
        self.builder.position_at_end(frame.end)
        self.frames.pop()
        return each(self.builder.load, frame.result[0]) if frame.result else None

    # ------------------------------------------------------------------------------------------ statements

    def _statements(self, statements: list[ast.stmt]) -> None:
        for statement in statements:
            translate = getattr(self, f"_{type(statement).__name__.lower()}_statement", None)
            try:
                translate(statement) if translate else self._refuse(statement)
            except TypeError as error:
                self._refuse(statement, f" ({error})")

    def _refuse(self, node: ast.AST, reason: str = "") -> NoReturn:
        function = self.frame.function
        line = function.__code__.co_firstlineno + getattr(node, "lineno", 1) - 1
        raise SyntaxError(f"{function.__module__}, line {line}: no translation for {ast.unparse(node)!r}{reason}")

    def _go(self, block: Any) -> None:
        """Go on in another block, unless this one has ended already."""
        if not self.builder.block.is_terminated:
            self.builder.branch(block)

    def _expr_statement(self, node: ast.Expr) -> None:
        if not isinstance(node.value, ast.Constant):  # a docstring
            self._value(node.value)

    def _assign_statement(self, node: ast.Assign) -> None:
        value = self._value(node.value)
        for target in node.targets:
            self._assign(target, value)

    def _augassign_statement(self, node: ast.AugAssign) -> None:
        self._assign(node.target, self._arithmetic(node, self._value(node.target), self._value(node.value)))

    def _assign(self, target: ast.AST, value: Any) -> None:
        if isinstance(target, ast.Name):
            self._assign_name(target.id, value)
        elif isinstance(target, ast.Tuple):
            for part, one in zip(target.elts, value, strict=True):
                self._assign(part, one)
        elif isinstance(target, ast.Subscript):
            array = self._value(target.value)
            place = self.place(array, self._indices(target.slice))
            self.builder.store(self.converted(place.type.pointee, value), place)
        else:
            self._refuse(target)

    def _assign_name(self, name: str, value: Any) -> None:
        if name not in self.frame.slots:
            self.frame.slots[name] = self._new_slots(value)
        self._store(self.frame.slots[name], value)

    def _new_slots(self, value: Any) -> Any:
        """Return places for a value of this type, and all its parts."""
        with self.builder.goto_entry_block():
            return each(lambda part: self.builder.alloca(self.typed(part).type), value)

    def _store(self, slots: Any, value: Any) -> None:
        each(lambda slot, part: self.builder.store(self.converted(slot.type.pointee, part), slot), slots, value)

    def _return_statement(self, node: ast.Return) -> None:
        if node.value is not None:
            value = self._value(node.value)
            self.frame.result[:] = self.frame.result or [self._new_slots(value)]
            self._store(self.frame.result[0], value)
        self._leave(self.frame.end)

    def _break_statement(self, node: ast.Break) -> None:
        self._leave(self.loops[-1])

    def _leave(self, block: Any) -> None:
        """Go on in another block; what follows here is never reached."""
        self._go(block)
        self.builder.position_at_end(self.builder.append_basic_block())

    def _if_statement(self, node: ast.If) -> None:
        test = self.truth(self._value(node.test))
        body, other, after = (self.builder.append_basic_block() for _ in range(3))
        self.builder.cbranch(test, body, other)
        for block, statements in ((body, node.body), (other, node.orelse)):
            self.builder.position_at_end(block)
            self._statements(statements)
            self._go(after)
        self.builder.position_at_end(after)

    def _while_statement(self, node: ast.While) -> None:
        head, body, after = (self.builder.append_basic_block() for _ in range(3))
        self.builder.branch(head)
        self.builder.position_at_end(head)
        self.builder.cbranch(self.truth(self._value(node.test)), body, after)
        self.builder.position_at_end(body)
        self._in_loop(node.body, after)
        self._go(head)
        self.builder.position_at_end(after)

    def _for_statement(self, node: ast.For) -> None:
        if isinstance(node.iter, ast.Tuple):
            for value in node.iter.elts:
                self._assign(node.target, self._value(value))
                self._statements(node.body)
            return
        if not (isinstance(node.iter, ast.Call) and ast.unparse(node.iter.func) == "range"):
            self._refuse(node.iter)
        bounds = self._values(node.iter.args)
        first, last, step = (0, *bounds, 1) if len(bounds) == 1 else (*bounds, 1)[:3]
        with self.write.loop(self.integer(first), self.integer(last), step) as (k, after):
            self._assign(node.target, k)
            self._in_loop(node.body, after)

    def _in_loop(self, statements: list[ast.stmt], after: Any) -> None:
        self.loops.append(after)
        self._statements(statements)
        self.loops.pop()

    # ----------------------------------------------------------------------------------------- expressions

    def _value(self, node: ast.AST) -> Any:
        """Translate an expression: numbers known by now remain Python's."""
        translate = getattr(self, f"_{type(node).__name__.lower()}", None)
        return translate(node) if translate else self._refuse(node)

    def _values(self, nodes: list[ast.expr]) -> tuple[Any, ...]:
        values: list[Any] = []
        for node in nodes:
            values += self._value(node.value) if isinstance(node, ast.Starred) else [self._value(node)]
        return tuple(values)

    def _constant(self, node: ast.Constant) -> Any:
        return node.value

    def _tuple(self, node: ast.Tuple) -> tuple[Any, ...]:
        return self._values(node.elts)

    def _name(self, node: ast.Name) -> Any:
        if node.id in self.frame.slots:
            return each(self.builder.load, self.frame.slots[node.id])
        known = self.frame.function.__globals__
        return known[node.id] if node.id in known else getattr(builtins, node.id)

    def _attribute(self, node: ast.Attribute) -> Any:
        value = self._value(node.value)
        if isinstance(value, ModuleType) or node.attr == "shape":
            return getattr(value, node.attr)
        self._refuse(node)

    def _unaryop(self, node: ast.UnaryOp) -> Any:
        value = self._value(node.operand)
        if isinstance(node.op, ast.Not):
            return self.builder.not_(self.truth(value))
        if not isinstance(node.op, ast.USub):
            self._refuse(node)
        if isinstance(value, int | float):
            return -value
        return self.builder.neg(value) if self.is_whole(value) else self.write.operators["negate"](value)

    def _binop(self, node: ast.BinOp) -> Any:
        return self._arithmetic(node, self._value(node.left), self._value(node.right))

    def _arithmetic(self, node: ast.BinOp | ast.AugAssign, x: Any, y: Any) -> Any:
        return self.arithmetic(type(node.op), x, y) if type(node.op) in ARITHMETIC else self._refuse(node)

    def _compare(self, node: ast.Compare) -> Any:
        values = self._values([node.left, *node.comparators])
        if not {type(compare) for compare in node.ops} <= COMPARISONS.keys():
            self._refuse(node)
        pairs = zip(node.ops, values[:-1], values[1:], strict=True)
        conditions = [self.compared(type(compare), x, y) for compare, x, y in pairs]
        return conditions[0] if len(conditions) == 1 else reduce(self.builder.and_, map(self.typed, conditions))

    def _boolop(self, node: ast.BoolOp) -> Any:
        """Translate `and` and `or`: what need not be known is not evaluated."""
        known = self.truth(self._value(node.values[0]))

        def rest() -> Any:
            others = node.values[1:]
            return self.truth(self._value(others[0] if len(others) == 1 else ast.BoolOp(node.op, others)))

        return self._chosen(known, *((lambda: True, rest) if isinstance(node.op, ast.Or) else (rest, lambda: False)))

    def _ifexp(self, node: ast.IfExp) -> Any:
        test = self.truth(self._value(node.test))
        return self._chosen(test, lambda: self._value(node.body), lambda: self._value(node.orelse))

    def _chosen(self, test: Any, *sides: Callable[[], Any]) -> Any:
        """Return the one value or the other, as the test says, without evaluating both."""
        starts, after = [self.builder.append_basic_block() for _ in sides], self.builder.append_basic_block()
        self.builder.cbranch(test, *starts)
        values, ends = [], []
        for start, side in zip(starts, sides, strict=True):
            self.builder.position_at_end(start)
            values.append(side())
            ends.append(self.builder.block)
        kinds = each(self.common, *values)
        for k, end in enumerate(ends):
            self.builder.position_at_end(end)
            values[k] = each(lambda kind, part: self.converted(kind, part), kinds, values[k])
            self.builder.branch(after)
        self.builder.position_at_end(after)
        return each(lambda *parts: self._joined(parts, ends), *values)

    def _joined(self, parts: tuple[Any, ...], ends: list[Any]) -> Any:
        """Return the one of these values whose block was left last."""
        phi = self.builder.phi(parts[0].type)
        for part, end in zip(parts, ends, strict=True):
            phi.add_incoming(part, end)
        return phi

    # ------------------------------------------------------------------------------------------- elements

    def _subscript(self, node: ast.Subscript) -> Any:
        value, indices = self._value(node.value), self._indices(node.slice)
        if not isinstance(value, Array):
            return value[indices[0]]
        if len(indices) < len(value.shape) or isinstance(indices[-1], slice):
            return self.part(value, indices)
        return self.builder.load(self.place(value, indices))

    def _indices(self, node: ast.AST) -> tuple[Any, ...]:
        nodes = node.elts if isinstance(node, ast.Tuple) else [node]
        return tuple(
            slice(*(bound and self._value(bound) for bound in (one.lower, one.upper)))
            if isinstance(one, ast.Slice)
            else self._value(one)
            for one in nodes
        )

    # ---------------------------------------------------------------------------------------------- calls

    def _call(self, node: ast.Call) -> Any:
        function, arguments = self._value(node.func), self._values(node.args)
        if function is call:
            return write_call(self.builder, *each(self.typed, arguments))
        if hasattr(function, "emit"):
            return function.emit(self.builder, *each(self.typed, arguments))
        if isinstance(function, FunctionType):
            return self.of_call(function, arguments)
        if function in (builtins.min, builtins.max):
            return reduce(partial(self.extreme, ast.Lt if function is builtins.min else ast.Gt), arguments)
        (value,) = arguments
        if function is builtins.len:
            return value.shape[0]
        if function is builtins.abs:
            return self.write.operators["abs"](value)
        if function is builtins.float:
            return float(value) if isinstance(value, int | float) else self.converted(self.write.double, value)
        if function is builtins.int and value.type == self.write.double:
            return self.builder.fptosi(value, self.write.integer)
        self._refuse(node)
