"""Compile kernel source to machine code: every numba setting of the package, and the cache of compiled kernels.

A generated module holds all the code that enters its kernel. A hash of its text names the module, and the file of each
of its compiled functions in the user's cache folder (`base.cache`), so none can be stale. numba's own disk cache is not
used: it trusts whatever file it reads, so a damaged one would end every run. If a cached kernel cannot be used for any
reason, it is compiled afresh.
"""

from __future__ import annotations

import contextlib
import hashlib
import pickle
import sys
from collections.abc import Callable, Mapping
from functools import cache, partial
from types import FunctionType, ModuleType
from typing import Any

from linksweep.base.cache import forget, keep, recall
from linksweep.engine.kernel import vectors

SETTINGS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "_nrt": False, "no_cfunc_wrapper": True}
"""IEEE division, no GIL, and no fast-math at all: contracted or reordered sums would change bits. Kernels allocate no
arrays, so numba's reference counting (`_nrt`) is off."""

SIGNATURE = (
    "void(i8, i8, i8, i8[::1], f8[::1], i8[::1], f8[:, ::1], i8[::1], "
    "f8[:, ::1], i8[::1], f8[::1], i8[::1], f8[:, ::1], f8[::1], f8[::1], f8[::1])"
)


@cache
def compiled(kernel_source: str, helpers_source: str = "", signature: str = SIGNATURE, streamed: str = "") -> Callable:
    """Return the kernel of this source as machine code: of this process, from the user's cache, or compiled now.

    It writes the array that is `streamed` past the caches.
    """
    context = f"{signature} {helpers_source} {vectors.SOURCE} {vectors.width()} {streamed}"
    vectorised = {"vectorised": partial(vectors.intrinsic, streamed=streamed)}
    kernel = _jitted(kernel_source, {**vectorised, **compiled_functions(helpers_source)}, context)["kernel"]
    kernel.compile(signature)
    kernel.disable_compile()
    return kernel


@cache
def compiled_functions(source: str, emitted: str = "") -> Mapping[str, Any]:
    """Return the functions of a module of plain functions by name, each compiled on its first call.

    `emitted` is the source of what the package itself teaches numba to compile in them.
    """
    return _jitted(source, {}, emitted) if source else {}


def _jitted(text: str, helpers: Mapping[str, Callable], context: str = "") -> dict[str, Any]:
    """Run a module's text with its helpers, and hand its functions to numba; its name covers all that enters their
    machine code."""
    import numba

    name = f"kernel_{_digest(f'{numba.__version__} {sys.version} {SETTINGS} {context} {text}')}"
    module = sys.modules[name] = ModuleType(name)  # where a cached kernel looks for it
    vars(module).update(helpers)
    exec(compile(text, name, "exec"), vars(module))
    functions = {key: value for key, value in vars(module).items() if _is_function_of(module, value)}
    jitted = {key: _dispatcher(function) for key, function in functions.items()}
    for key, function in jitted.items():
        function._cache = KernelCache(f"{name}.{key}")
    vars(module).update(jitted)  # so that they call each other compiled
    return jitted


def _dispatcher(function: FunctionType) -> Any:
    """Return a function as numba compiles it: with NUMBA_DISABLE_JIT=1 set, too, for its code is no Python to debug."""
    import numba

    config: Any = numba.config
    disabled, config.DISABLE_JIT = config.DISABLE_JIT, 0
    try:
        return numba.njit(**SETTINGS)(function)
    finally:
        config.DISABLE_JIT = disabled


def _is_function_of(module: ModuleType, value: object) -> bool:
    return isinstance(value, FunctionType) and value.__globals__ is vars(module)


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
