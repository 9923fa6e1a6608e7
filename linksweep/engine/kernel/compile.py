"""Kernel source to machine code: every numba setting of the package, and how compiled kernels are kept.

A generated module holds all the code that enters its kernel. Its text, hashed, names it, and the file of each of its
compiled functions in the user's cache folder (`engine.cache`): none can be stale. numba's own disk cache is not used:
it runs what it finds, and a damaged file ends every run. Whatever goes wrong with a kept kernel, it is compiled afresh.
"""

from __future__ import annotations

import contextlib
import hashlib
import pickle
import sys
from collections.abc import Callable, Mapping
from functools import cache
from types import FunctionType, ModuleType
from typing import Any

from linksweep.base.cache import forget, keep, recall

SETTINGS: dict[str, Any] = {"error_model": "numpy", "nogil": True, "_nrt": False}
"""IEEE division, threads allowed, and no fast-math at all: a contracted or reordered sum would give other bits.
Kernels make no arrays: numba need not count who refers to the rows they look at, which is felt in a search."""

SIGNATURE = (
    "void(i8, i8, i8, i8[::1], f8[::1], i8[::1], f8[:, ::1], i8[::1], "
    "f8[:, ::1], i8[::1], f8[::1], i8[::1], f8[::1], f8[::1], f8[::1])"
)

SEARCH_SIGNATURE = (
    "void(i8, i8, i8[::1], f8[::1], i8[::1], f8[::1], i8[::1], "
    "f8[::1], f8[:, ::1], f8[:, ::1], f8[:, ::1], f8[:, ::1], i8[::1])"
)

IMPORTS = "import math\nfrom math import atan2, sqrt\n\n\n"


@cache
def compiled(kernel_source: str, helpers_source: str = "", signature: str = SIGNATURE) -> Callable:
    """Return the kernel of this source as machine code: from this process, from the user's cache, or compiled now."""
    helpers = compiled_functions(helpers_source)
    kernel = _jitted(IMPORTS + kernel_source, helpers, f"{signature} {helpers_source}")["kernel"]
    kernel.compile(signature)
    kernel.disable_compile()
    return kernel


@cache
def compiled_functions(source: str) -> Mapping[str, Any]:
    """Return the functions of a module of plain functions by name, compiled when they are first called."""
    return _jitted(source, {}) if source else {}


def _jitted(text: str, helpers: Mapping[str, Callable], context: str = "") -> dict[str, Any]:
    """Run a module's text and hand its functions to numba; its name covers all that enters their machine code."""
    import numba

    name = f"kernel_{_digest(f'{numba.__version__} {sys.version} {SETTINGS} {context} {text}')}"
    module = sys.modules[name] = ModuleType(name)  # where a kept kernel looks for it
    vars(module).update(helpers)
    exec(compile(text, name, "exec"), vars(module))
    functions = {key: value for key, value in vars(module).items() if isinstance(value, FunctionType)}
    jitted = {key: numba.njit(**SETTINGS)(function) for key, function in functions.items()}
    for key, function in jitted.items():
        function._cache = KernelCache(f"{name}.{key}")
    vars(module).update(jitted)  # so that they call each other compiled
    return jitted


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:24]


class KernelCache:
    """Machine code of one function, kept for each signature and kind of processor: the cache of a numba dispatcher."""

    cache_path = None

    def __init__(self, name: str) -> None:
        self.name = name

    def load_overload(self, signature: object, target: Any) -> Any:
        """Return the kept machine code, ready to run; None where there is none, or anything is wrong with it."""
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
        """Keep machine code; what can't be kept is compiled again by the next process."""
        from numba.core.serialize import dumps

        with contextlib.suppress(Exception):
            keep(self._file(signature, result.codegen), dumps(result._reduce()))

    def _file(self, signature: object, codegen: Any) -> str:
        return f"{self.name}.{_digest(f'{signature} {codegen.magic_tuple()}')}"
