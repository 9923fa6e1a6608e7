"""Compile kernel source to machine code: every numba setting of the package, and the cache of compiled kernels.

A generated module holds all the code that enters its kernel. A hash of its text names the module, and the file of each
of its compiled functions in the user's cache folder (`base.cache`), so none can be stale. numba's own disk cache is not
used: it trusts whatever file it reads, so a damaged one would end every run. If a cached kernel cannot be used for any
reason, it is compiled afresh.
"""

from __future__ import annotations

import contextlib
import hashlib
import inspect
import pickle
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import cache, partial
from types import FunctionType, ModuleType
from typing import Any

from linksweep.base.cache import forget, keep, recall
from linksweep.base.memory import without_collecting
from linksweep.engine.kernel import vectors
from linksweep.engine.kernel.machine_code import INTEGER, MachineCode

SETTINGS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "_nrt": False}
"""IEEE division, no GIL, and no fast-math at all: sums that LLVM contracts or reorders would change bits. Kernels
allocate no arrays, so numba's reference counting (`_nrt`) is off."""

PLACES, FLOATS = "i8*", "f8*"
KINDS = (*[INTEGER] * 5, PLACES, FLOATS, PLACES, FLOATS, PLACES, FLOATS, PLACES, FLOATS, PLACES, *[FLOATS] * 4)
"""Arguments of kernels (`engine.kernel.writer`)."""
TYPES = {INTEGER: "i8", PLACES: "CPointer(i8)", FLOATS: "CPointer(f8)"}
"""Their types. numba takes four times as long to compile a function that is called with Python's arrays."""


@cache
@without_collecting()
def compiled(kernel_source: str, streamed: str = "", kinds: tuple[str, ...] = KINDS) -> MachineCode:
    """Return the kernel of this source as machine code: of this process, from the user's cache, or compiled now.

    It writes the array that is `streamed` past the caches.
    """
    from numba.core.ccallback import CFunc
    from numba.core.sigutils import normalize_signature

    from linksweep.engine.kernel import numba_code

    context = f"{kinds} {vectors.SOURCE} {vectors.width()} {streamed} {numba_code.SOURCE}"
    module = _module(kernel_source, {"vectorised": partial(_intrinsic, streamed=streamed)}, context)
    signature = normalize_signature(f"void({', '.join(TYPES[kind] for kind in kinds)})")
    callback: Any = CFunc(module.kernel, signature, {}, SETTINGS, numba_code.KernelCompiler)
    callback._cache = KernelCache(f"{module.__name__}.kernel")
    with _in_written_order() if "in_stages(" in kernel_source else contextlib.nullcontext():
        callback.compile()
    return MachineCode(callback, callback.address, kinds)


def _intrinsic(function: FunctionType, streamed: str) -> Callable:
    """Return a function as instructions that numba puts in place of its calls."""
    import numba.extending
    from numba.core import types

    parameters = inspect.signature(function).parameters

    def typed(_typing_context: Any, *kinds: Any) -> tuple[Any, Callable]:
        def write(context: Any, builder: Any, _signature: Any, values: Any) -> Any:
            vectors.write_function(builder, function, dict(zip(parameters, values, strict=True)), streamed)
            return context.get_dummy_value()

        return types.void(*kinds), write

    first = inspect.Parameter("typing_context", inspect.Parameter.POSITIONAL_OR_KEYWORD)
    typed.__signature__ = inspect.Signature([first, *parameters.values()])  # type: ignore[attr-defined]
    return numba.extending.intrinsic(typed)


@contextlib.contextmanager
def _in_written_order() -> Iterator[None]:
    """Let LLVM leave instructions in the order in which they are written: this setting holds for the whole process,
    so no other thread may compile meanwhile."""
    from llvmlite import binding
    from numba.core.compiler_lock import global_compiler_lock

    with global_compiler_lock:
        binding.set_option("", "-enable-misched=false")
        try:
            yield
        finally:
            binding.set_option("", "-enable-misched=true")


def _module(text: str, helpers: Mapping[str, Callable], context: str) -> Any:
    """Run a module's text with its helpers; its name covers all that enters the machine code of its functions."""
    import numba

    name = f"kernel_{_digest(f'{numba.__version__} {sys.version} {SETTINGS} {context} {text}')}"
    module = sys.modules[name] = ModuleType(name)  # where a cached kernel looks for it
    vars(module).update(helpers)
    exec(compile(text, name, "exec"), vars(module))
    return module


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:24]


class KernelCache:
    """Cache of a numba dispatcher: machine code of one function, by signature and processor type."""

    cache_path = None

    def __init__(self, name: str) -> None:
        self.name = name

    def load_overload(self, signature: object, target: Any) -> Any:
        """Return the cached machine code, ready to run; None where there is none, or it cannot be used."""
        from numba.core.compiler import CompileResult

        target.refresh()
        name = self._file(signature, target.codegen())
        try:
            content = recall(name)
            return content and CompileResult._rebuild(target, *pickle.loads(content))
        except Exception:
            forget(name)
            return None

    def save_overload(self, signature: object, result: Any) -> None:
        """Store machine code; where that fails, the next process compiles again."""
        from numba.core.serialize import dumps

        with contextlib.suppress(Exception):
            keep(self._file(signature, result.codegen), dumps(result._reduce()))

    def _file(self, signature: object, codegen: Any) -> str:
        return f"{self.name}.{_digest(f'{signature} {codegen.magic_tuple()}')}"
