"""Evaluate the signals of a plan for several designs side by side, one in each lane.

    prepare(front, designs, sizes, parameters, parameter_at, constants)
                                                            numbers of designs `front` … from their parameters
    share(constants, x)                                     numbers that all designs have in common at these samples
    sample(constants, x, rows)                              all signals at all samples of the turn
    evaluate(constants, table, x, value, far, signal, first, last)
                                                            one signal at one place in each lane `first` … `last`
    enter(front, piece, sizes, parameters, parameter_at, constants)
                                                            numbers of a piece of each design, beside those it has

`evaluate` takes the numbers of rows of a table: of the place, the value, the half turn and the signal's number; −1 if
the first lanes are for the first signal, the next ones for the second and so on: each is then evaluated alone.

Arrays have a row of lanes for each number, one after the other. `constants` begins with the widths of the near-toggles;
`x` of `sample` has the tangents of samples of each half turn, with one more on either side. Those before the middle
mirror those after it, and share all operations whose results are the same there, or opposite. Samples may also lie
anywhere: `x` then has their tangents, and after these their half turns.

Where no design dim enters the motion, as of many masses on one geometry, all designs have the same samples. `share`
then computes once, whenever samples were placed, all that depends on nothing else: numbers behind the places in `x`,
from which `sample` goes on.
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cached_property, partial
from itertools import product
from typing import Any, NamedTuple

from linksweep.engine.kernel.instructions import REGISTER as LANES
from linksweep.engine.kernel.instructions import Instructions
from linksweep.engine.kernel.machine_code import INTEGER, INTEGERS, ROW, TABLE, MachineCode, is_kept, machine_code
from linksweep.engine.patience import Patience
from linksweep.engine.peaks import roles
from linksweep.engine.peaks.interpreted import Interpreted
from linksweep.engine.peaks.lanewise import Values
from linksweep.engine.peaks.roles import PIECE, Roles
from linksweep.engine.peaks.samples import HALF, PLACED
from linksweep.engine.trace.graph import Node
from linksweep.engine.trace.operators import interpret
from linksweep.engine.trace.parity import parities

SOURCE = inspect.getsource(sys.modules[__name__]) + inspect.getsource(roles) + inspect.getsource(parities)
"""All that enters the machine code besides nodes and instructions."""
SOON = 2 * LANES
"""Designs from the first lane's to one whose parameters are fetched into the caches: that of the lanes after the next.
"""

Writing = tuple[Callable[..., Any], tuple[str, ...], str]
"""The writing of a function of machine code: what emits its body, the kinds of its arguments, and a text that differs
wherever the body does."""
Pairs = Iterator[tuple[Any, Any, Values, Values]]
"""Half turn and number of a sample from its middle on, and the values there and at its mirror."""


class Functions(NamedTuple):
    """The functions, the number of their lanes, that of the constants of a design, and that of what all share."""

    lanes: int
    constants: int
    shared: int
    prepare: Callable[..., Any]
    share: Callable[..., Any]
    sample: Callable[..., Any]
    evaluate: Callable[..., Any]
    enter: Callable[..., Any] | None = None
    """None where designs are not divided into pieces."""

    @property
    def passed(self) -> list[Any]:
        """The functions as a search takes them, on pieces with `enter` in place of `share`: compiled ones by their
        addresses."""
        functions = self.prepare, self.enter or self.share, self.sample, self.evaluate
        return [each.address if isinstance(each, MachineCode) else each for each in functions]


class Evaluators(Roles, Patience):
    """The evaluators of some of a plan's outputs, its signals."""

    @cached_property
    def interpreted(self) -> Functions:
        """The functions by the interpreter, for one lane: its constants are the widths, and the parameters as such."""
        one = Interpreted(self)
        functions = one.prepare, one.share, one.sample, one.evaluate
        return Functions(1, 2 + len(self.inputs), 0, *functions, one.enter if PIECE in self.dims else None)

    @cached_property
    def compiled(self) -> Functions:
        """The functions as machine code, for `LANES` lanes."""
        functions = {name: machine_code(*writing) for name, writing in self._writings.items()}
        return Functions(LANES, len(self.constants), 4 * (HALF + 1) * len(self.shared), **functions)

    @cached_property
    def are_kept(self) -> bool:
        """True where the machine code of all functions is kept on disk."""
        return all(is_kept(*writing) for writing in self._writings.values())

    @property
    def _writings(self) -> dict[str, Writing]:
        """The writing of each function."""
        text, of_designs = self._text(), (INTEGER, INTEGER, INTEGERS, ROW, INTEGERS, ROW)
        functions: dict[str, Writing] = {
            "prepare": (self._emit_prepare, of_designs, text),
            "share": (self._emit_share, (ROW, ROW), text if self.shared else ""),
            "sample": (self._emit_sample, (ROW, ROW, ROW), text),
            "evaluate": (self._emit_evaluate, (ROW, TABLE, *[INTEGER] * 6), text),
        }
        return functions | ({"enter": (self._emit_enter, of_designs, text)} if PIECE in self.dims else {})

    def _emit_prepare(self, builder: Any, front: Any, designs: Any, sizes: Any, *arrays: Any) -> None:
        """Emit the constants of designs side by side; lanes beyond the last design repeat it."""
        vectors, digit = Instructions(builder), dict[str, Any]()
        design = self._side_by_side(vectors, front, designs)
        for k, dim in reversed([*enumerate(self.dims)]):  # the outermost takes what the others leave
            size = vectors.wide(_number(builder, sizes, vectors.integer(k)))
            digit[dim] = builder.urem(design, size) if k else design
            design = builder.udiv(design, size) if k else design
        self._emit_constants(vectors, digit, frozenset(), sizes, *arrays)

    def _emit_enter(self, builder: Any, front: Any, piece: Any, sizes: Any, *arrays: Any) -> None:
        """Emit the constants of a piece of each design, from those that all its pieces have."""
        vectors, (piece_dim, *others) = Instructions(builder), self.dims
        digit = {piece_dim: vectors.wide(piece)}
        for dim in others:
            digit[dim] = self._side_by_side(vectors, front, _number(builder, sizes, vectors.integer(1)))
        self._emit_constants(vectors, digit, frozenset([piece_dim]), sizes, *arrays)

    def _side_by_side(self, vectors: Instructions, front: Any, designs: Any) -> Any:
        """Emit the numbers of designs side by side; beyond the last design, its own."""
        builder = vectors.builder
        lanes = vectors.ir.VectorType(vectors.integer, LANES)([*range(LANES)])
        design, latest = builder.add(vectors.wide(front), lanes), vectors.wide(builder.sub(designs, vectors.integer(1)))
        return vectors.smaller(design, latest)

    def _emit_constants(self, vectors: Instructions, digit: dict, alike: frozenset[str], *arrays: Any) -> None:
        """Emit the constants that depend on all of some dims, in which lanes are `alike`, from those that do not."""
        builder, integer, (sizes, parameters, parameter_at, constants) = vectors.builder, vectors.integer, arrays
        size = {dim: vectors.wide(_number(builder, sizes, integer(k))) for k, dim in enumerate(self.dims)}
        known = {node: k for k, node in enumerate(self.constants) if not alike <= node.dims}
        values = {node: vectors.load(constants.data, integer(k * LANES)) for node, k in known.items()}
        for k, node in enumerate(self.inputs):
            if not alike <= node.dims:
                continue
            place = vectors.wide(integer(0))
            for dim in (dim for dim in self.plan.loops if dim in node.dims):
                place = builder.add(builder.mul(place, size[dim]), digit[dim])
            start = builder.gep(parameters.data, [_number(builder, parameter_at, integer(k))])
            first = builder.extract_element(place, integer(0))
            if node.dims <= alike:
                values[node] = vectors.wide(builder.load(builder.gep(start, [first])))
                continue
            values[node] = vectors.gather(start, place)
            vectors.prefetch(start, builder.add(first, integer(SOON)))
        work = [node for node in self.of_designs if alike <= node.dims]
        interpret([*self.plan.constants, *work], values, vectors.operators)
        for k, node in enumerate(self.constants):
            if node not in known:
                vectors.store(values[node], constants.data, integer(k * LANES))

    def _emit_share(self, builder: Any, constants: Any, x: Any) -> None:
        """Emit the numbers that all designs share at each sample and at its mirror, behind the places in `x`."""
        if self.shared:
            vectors = Instructions(builder)
            with self._pairs(vectors, constants, x) as (turn, k, *pair):
                places = self._of_pair(vectors, x, turn, k)
                for values, node in product(pair, self.shared):
                    value = vectors.wide(vectors.as_number(values[node]))
                    builder.store(builder.extract_element(value, vectors.integer(0)), next(places))

    def _emit_sample(self, builder: Any, constants: Any, x: Any, rows: Any) -> None:
        vectors = Instructions(builder)
        integer, of = vectors.integer, builder.mul
        size = integer(len(self.signals) * LANES)

        def store(values: Values, sample: Any) -> None:
            for s, signal in enumerate(self.signals):
                vectors.store(values[signal], rows.data, builder.add(of(sample, size), integer(s * LANES)))

        if self.anywhere:
            with self._places_anywhere(vectors, constants, x) as (k, here):
                store(interpret(self.left, here, vectors.operators), k)
            return
        pairs = self._pairs_from_shared if self.shared else self._pairs
        with pairs(vectors, constants, x) as (turn, k, here, there):
            half = self._half(vectors, x)
            middle = builder.add(of(turn, of(integer(2), half)), half)
            store(there, builder.sub(middle, k))
            store(here, builder.add(middle, k))

    def _places_anywhere(self, vectors: Instructions, constants: Any, x: Any) -> Any:
        """Emit a loop over samples that lie anywhere."""
        builder, integer = vectors.builder, vectors.integer
        count = builder.udiv(x.shape[0], integer(2 * LANES))

        def place(k: Any) -> Values:
            at = builder.mul(k, integer(LANES)), builder.mul(builder.add(k, count), integer(LANES))
            return {node: vectors.load(x.data, k) for node, k in zip((self.tangent, self.far), at, strict=True)}

        return self._each(vectors, constants, integer(0), count, 1, place)

    @contextmanager
    def _pairs(self, vectors: Instructions, constants: Any, x: Any) -> Pairs:
        """Emit a loop over both half turns, and in it one over the samples from the middle on; yield their numbers, and
        the values at each and at its mirror."""
        builder, integer = vectors.builder, vectors.integer
        beyond = builder.add(self._half(vectors, x), integer(1))
        with vectors.loop(integer(0), integer(2)) as (turn, _):

            def place(k: Any) -> Values:
                at = builder.add(builder.mul(turn, builder.mul(integer(2), beyond)), builder.add(beyond, k))
                tangent = vectors.load(x.data, builder.mul(at, integer(LANES)))
                return {self.tangent: tangent, self.far: builder.uitofp(turn, vectors.double)}

            with self._each(vectors, constants, integer(0), beyond, 1, place) as (k, here):
                yield turn, k, here, self._mirrored(vectors, [*self.kept, *self.left], here, {})

    def _half(self, vectors: Instructions, x: Any) -> Any:
        """Emit the number of samples on either side of the middle of a half turn: on pieces that for which places have
        room."""
        if not self.even:
            return vectors.integer(HALF)
        placed = vectors.builder.udiv(x.shape[0], vectors.integer(2 * LANES))
        return vectors.builder.sub(vectors.builder.udiv(placed, vectors.integer(2)), vectors.integer(1))

    @contextmanager
    def _pairs_from_shared(self, vectors: Instructions, constants: Any, x: Any) -> Pairs:
        """Do the same from what all designs share."""
        builder, integer = vectors.builder, vectors.integer
        with vectors.loop(integer(0), integer(2)) as (turn, _), vectors.loop(integer(0), integer(HALF + 1)) as (k, _):
            places = self._of_pair(vectors, x, turn, k)
            here, there = ({node: vectors.wide(builder.load(next(places))) for node in self.shared} for _ in range(2))
            here |= self._constants(vectors, constants)
            yield turn, k, here, self._mirrored(vectors, self.own, here, there)

    def _of_pair(self, vectors: Instructions, x: Any, turn: Any, k: Any) -> Iterator[Any]:
        """Yield the places of the numbers that all designs share at a sample, then of those at its mirror."""
        builder, integer = vectors.builder, vectors.integer
        pair = builder.add(builder.mul(turn, integer(HALF + 1)), k)
        first = builder.add(integer(2 * PLACED * LANES), builder.mul(pair, integer(2 * len(self.shared))))
        return (builder.gep(x.data, [builder.add(first, integer(n))]) for n in range(2 * len(self.shared)))

    def _mirrored(self, vectors: Instructions, nodes: list[Node], here: Values, there: Values) -> Values:
        """Emit operations that are left to do at a place and at the opposite tangent, and return the values there, some
        of which are known; only operations that are neither even nor odd are repeated."""
        there = here | there
        for node in nodes:
            parity = self.parity[node]
            interpret([node] if node not in here else [], here, vectors.operators)
            if parity == 0:
                interpret([node], there, vectors.operators)
            else:
                there[node] = here[node] if parity > 0 else vectors.operators["negate"](here[node])
        return there

    def _emit_evaluate(
        self, builder: Any, constants: Any, table: Any, x: Any, value: Any, far: Any, signal: Any, first: Any, last: Any
    ) -> None:
        vectors = Instructions(builder)
        length = table.shape[1]

        def at(row: Any, lane: Any) -> Any:
            return builder.add(builder.mul(length, row), lane)

        def place(lane: Any) -> Values:
            return {node: vectors.load(table.data, at(row, lane)) for node, row in ((self.tangent, x), (self.far, far))}

        count = 0 if self.even or self.anywhere else len(self.signals)  # on pieces, none is evaluated alone
        lanes = [vectors.integer(k * LANES) for k in range(count)]
        with builder.if_else(builder.icmp_signed("<", signal, vectors.integer(0))) as (alone, mixed):
            with alone:
                each = vectors.each_ahead(lanes, partial(self._start, vectors, constants, place))
                for (lane, kept), node in zip(each, self.signals, strict=False):
                    left = [x for x in self.needed([node]) if x in self.left]
                    here = interpret(left, self._here(vectors, constants, kept), vectors.operators)
                    vectors.store(here[node], table.data, at(value, lane))
            with mixed, self._each(vectors, constants, first, last, LANES, place) as (lane, here):
                interpret(self.left, here, vectors.operators)
                number, chosen = vectors.load(table.data, at(signal, lane)), here[self.signals[0]]
                for k, node in enumerate(self.signals[1:], 1):
                    chosen = vectors.operators["where"](vectors.operators["=="](number, k), here[node], chosen)
                vectors.store(chosen, table.data, at(value, lane))

    @contextmanager
    def _each(
        self, vectors: Instructions, constants: Any, first: Any, last: Any, step: int, place: Callable[[Any], Values]
    ) -> Iterator[tuple[Any, Values]]:
        """Emit a loop over places, which yields its counter and the values that are `kept` there."""
        start = partial(self._start, vectors, constants, place)
        with vectors.loop_ahead(first, last, step, start) as (k, kept):
            yield k, self._here(vectors, constants, kept)

    def _start(self, vectors: Instructions, constants: Any, place: Callable[[Any], Values], k: Any) -> list[Any]:
        """Emit the operations `ahead` at a place, and return the values that are `kept`."""
        values = interpret(self.ahead, self._constants(vectors, constants) | place(k), vectors.operators)
        return [values[node] for node in self.kept]

    def _here(self, vectors: Instructions, constants: Any, kept: list[Any]) -> Values:
        """Return values that are `kept`, and constants, loaded where they are used: they would fill the registers."""
        return dict(zip(self.kept, kept, strict=True)) | self._constants(vectors, constants)

    def _constants(self, vectors: Instructions, constants: Any) -> Values:
        """Return the constants of designs, which an array holds one after the other, and those of the plan."""
        places = enumerate(self.constants)
        loaded = {node: vectors.load(constants.data, vectors.integer(k * LANES)) for k, node in places}
        return interpret(self.plan.constants, loaded, vectors.operators)

    def _text(self) -> str:
        """Return a text that differs wherever the functions do."""
        nodes = {node: k for k, node in enumerate(self.plan.nodes)}
        lines = [(node.operator, node.value, [nodes[x] for x in node.operands]) for node in nodes]
        by_role = [[nodes[node] for node in role] for role in (self.inputs, self.constants, self.signals, self.shared)]
        dims = [[dim in node.dims for dim in self.plan.loops] for node in self.inputs]
        counted = [self.dims.index(dim) for dim in self.plan.loops]
        return f"{SOURCE} {HALF} {lines} {by_role} {dims} {counted} {PIECE in self.dims}"


def _number(builder: Any, array: Any, k: Any) -> Any:
    """Emit a number of an array."""
    return builder.load(builder.gep(array.data, [k]))
