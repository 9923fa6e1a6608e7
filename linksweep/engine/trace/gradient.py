"""Differentiate a traced value to its inputs, in reverse: one pass gives the derivatives to all of them.

From the value back to the inputs, each operation z = f(x, y) passes its adjoint w = ∂value/∂z on to its operands:

    z = x ± y    w, ±w               z = x·y    w·y, w·x              z = √x     w/(2z)
    z = x/y      w/y, −z·w/y         z = |x|    w or −w               z = atan2(y, x)    w·x/(x² + y²), −w·y/(x² + y²)

and an operand's adjoint is the sum of what it receives. The derivatives are operations of the same graph, so that they
share all that the value has computed. (A. Griewank and A. Walther, Evaluating Derivatives, 2nd ed., chapter 3.)

A selection passes its adjoint to both operands, each with the condition under which it counts. Between operations of
one condition nothing is masked, so that what is not selected may be infinite or NaN; where adjoints of several
conditions meet, each becomes 0 where its own does not hold. At the border itself the derivative is one-sided.

Low words of double-doubles are what rounding left: they have no derivative, and a product with one has none either.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable

from linksweep.engine.trace.graph import LOW_WORDS, Node, depth_first

Conditions = frozenset[tuple[Node, bool]]
"""Conditions that hold together, each with the outcome that it must have."""
Mask = frozenset[Conditions]
"""Alternatives: a value counts where the conditions of one of them hold."""
ALWAYS: Mask = frozenset({frozenset()})
MOST_ALTERNATIVES = 8
"""Alternatives of a mask kept; of more only the conditions common to all of them."""

PASSED_ON: dict[str, Callable[..., tuple[Node, ...]]] = {
    "+": lambda z, w, x, y: (w, w),
    "-": lambda z, w, x, y: (w, -w),
    "*": lambda z, w, x, y: (w * y, w * x),
    "/": lambda z, w, x, y: _opposed(_divided(w, z, x, y), 1.0, z),
    "sqrt": lambda z, w, x: (0.5 * w / z,),
    "negate": lambda z, w, x: (-w,),
    "rounded": lambda z, w, x: (w,),
    "abs": lambda z, w, x: ((x < 0.0).where(-w, w),),
    "atan2": lambda z, w, y, x: _opposed(w / (x * x + y * y), x, y),
}
"""Adjoints that an operation passes on to its operands, from its result z, the adjoint w of that, and the operands."""


def gradient(value: Node, to: Collection[Node]) -> dict[Node, Node]:
    """Return the derivatives of a value to those of these inputs on which it depends."""
    operations = depth_first([value])  # adjoints are summed in this order
    active = _active(operations, frozenset(to))
    received: dict[Node, list[tuple[Mask, Node]]] = defaultdict(list)
    received[value].append((ALWAYS, value.graph.constant(1.0)))
    for z in reversed(operations):
        if z not in active or z in to or z not in received:
            continue
        mask, w = _joined(received.pop(z))
        for x, own, passed in _passed_on(z, mask, w):
            if x in active:
                received[x].append((own, passed))
    return {x: _selected(*_joined(received[x])) for x in to if x in received}


def _active(operations: Iterable[Node], to: frozenset[Node]) -> set[Node]:
    """Return the nodes through which a derivative to some of the inputs passes."""
    active, low = set(to), set[Node]()
    for z in operations:
        if z in to:
            continue
        if _is_low(z, low):
            low.add(z)
        elif z.operator != "<" and not active.isdisjoint(z.operands[1:] if z.operator == "where" else z.operands):
            active.add(z)
    return active


def _is_low(z: Node, low: Collection[Node]) -> bool:
    """Return whether a value is the low word of a double-double, or computed from such alone."""
    if z.operator in LOW_WORDS or z in z.graph.low_words:
        return True
    if z.operator == "*":
        return z.operands[0] in low or z.operands[1] in low
    if z.operator == "/":
        return z.operands[0] in low
    return z.operator in ("+", "-", "negate", "rounded") and all(x in low for x in z.operands)


def _passed_on(z: Node, mask: Mask, w: Node) -> list[tuple[Node, Mask, Node]]:
    """Return each operand of a node with what it receives, and where that counts."""
    if z.operator != "where":
        parts = PASSED_ON[z.operator](z, w, *z.operands)
        return [(x, mask, part) for x, part in zip(z.operands, parts, strict=True)]
    condition, *chosen = z.operands
    sides = [(x, _under(mask, condition, side), w) for x, side in zip(chosen, (True, False), strict=True)]
    return [side for side in sides if side[1]]


def _divided(w: Node, z: Node, x: Node, y: Node) -> Node:
    """Return w/y, of an adjoint w and a quotient z = x/y: by z/x where x is a constant but 0, else by 1/y, which is
    computed once for all adjoints, and once per design where y depends on the design alone."""
    inverse = z * (1.0 / x.value) if x.operator == "constant" and x.value else 1.0 / y
    return w * inverse


def _opposed(part: Node, x: Node | float, y: Node) -> tuple[Node, Node]:
    return part * x, -(part * y)


# --------------------------------------------------------------------------------------------------- conditions


def _joined(received: list[tuple[Mask, Node]]) -> tuple[Mask, Node]:
    """Return the sum of all that a node receives, and where it counts."""
    sums: dict[Mask, Node] = {}
    for mask, part in received:
        sums[mask] = sums[mask] + part if mask in sums else part
    if len(sums) == 1:
        return next(iter(sums.items()))
    first, *others = (_selected(mask, part) for mask, part in sums.items())
    return _either(sums), sum(others, first)


def _selected(mask: Mask, value: Node) -> Node:
    """Return a value, 0 where it does not count."""
    result = value.graph.constant(0.0)
    for conditions in sorted(mask, key=_order):
        chosen = value
        for condition, outcome in sorted(conditions, key=lambda one: -one[0].position):
            chosen = condition.where(chosen, result) if outcome else condition.where(result, chosen)
        result = chosen
    return result


def _order(conditions: Conditions) -> list[tuple[int, bool]]:
    return sorted((condition.position, outcome) for condition, outcome in conditions)


def _under(mask: Mask, condition: Node, outcome: bool) -> Mask:
    """Return the mask of what also takes an outcome of a condition; no alternatives where it never counts."""
    return frozenset(own | {(condition, outcome)} for own in mask if (condition, not outcome) not in own)


def _either(masks: Iterable[Mask]) -> Mask:
    """Return the mask of what counts where one of several does: x and y, or x and not y, is x."""
    some = set().union(*masks)
    while pair := next(((a, b) for a in some for b in some if a < b or _complementary(a, b)), None):
        a, b = pair
        some -= {b} if a < b else {a, b}
        some |= set() if a < b else {a & b}
    return frozenset(some) if len(some) <= MOST_ALTERNATIVES else frozenset({frozenset.intersection(*some)})


def _complementary(a: Conditions, b: Conditions) -> bool:
    """Return whether two sets of conditions differ in the outcome of one condition alone."""
    apart = a ^ b
    return len(apart) == 2 and len({condition for condition, _ in apart}) == 1
