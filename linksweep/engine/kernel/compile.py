"""Compile kernels: the source that `writer` writes, of loops over designs and of functions that `vectors` writes."""

from __future__ import annotations

import ast
from collections.abc import Callable
from functools import cache, partial
from typing import Any

from linksweep.engine.kernel import vectors
from linksweep.engine.kernel.machine_code import INTEGER, MachineCode, machine_code
from linksweep.engine.kernel.translate import Translator

PLACES, FLOATS = "i8*", "f8*"
KINDS = (*[INTEGER] * 5, PLACES, FLOATS, PLACES, FLOATS, PLACES, FLOATS, PLACES, FLOATS, PLACES, *[FLOATS] * 4)
"""Arguments of kernels (`engine.kernel.writer`)."""


@cache
def compiled(kernel_source: str, streamed: str = "", kinds: tuple[str, ...] = KINDS) -> MachineCode:
    """Return the kernel of this source as machine code: of this process, from the user's cache, or compiled now.

    It writes the array that is `streamed` past the caches.
    """

    def kernel(builder: Any, *arguments: Any) -> None:
        Translator(builder).of_call(_defined(kernel_source, streamed), arguments)

    context = f"{vectors.SOURCE} {vectors.width()} {streamed}"
    return machine_code(kernel, kinds, f"{context} {kernel_source}", in_order="in_stages(" in kernel_source)


def _defined(kernel_source: str, streamed: str) -> Callable:
    """Run the source, and return its function `kernel`, the last one."""
    tree = ast.parse(kernel_source)
    names: dict[str, Any] = {"vectorised": partial(vectors.vectorised, streamed=streamed)}
    exec(compile(tree, "a kernel", "exec"), names)
    names["kernel"].definition = tree.body[-1]
    return names["kernel"]
