"""Kernel source to machine code: every numba setting of the package, and where compiled kernels are kept.

A generated module holds all the code that enters its kernel, so its text, hashed, names its file in the user's
cache folder, and numba's own disk cache beside it can never be stale: numba keys on bytecode alone, which here
is everything. Without a folder to write to, kernels are compiled afresh in each process.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

SETTINGS = 'error_model="numpy", nogil=True'
"""IEEE division, threads allowed, and no fast-math at all: a contracted or reordered sum would give other bits."""

SIGNATURE = (
    "void(i8, i8, i8, i8[::1], f8[::1], i8[::1], f8[:, ::1], i8[::1], "
    "f8[:, ::1], i8[::1], f8[::1], i8[::1], f8[:, ::1], f8[::1], f8, f8[::1])"
)

HEADER = "import math\nfrom math import atan2, sqrt\n\nimport numba\n\n\n"


@cache
def compiled(kernel_source: str, reductions_source: str) -> Callable:
    """The kernel of this source as machine code: from this process, from the user's cache, or compiled now."""
    folder = cache_folder()
    if folder is not None:
        path = _stored(folder, _module(kernel_source, reductions_source, cached=True))
        if path is not None:
            return _imported(path).kernel
    namespace: dict = {}
    exec(_module(kernel_source, reductions_source, cached=False), namespace)
    return namespace["kernel"]


def _module(kernel_source: str, reductions_source: str, cached: bool) -> str:
    helper = f"@numba.njit({SETTINGS})\ndef "
    reductions = reductions_source.replace("import math\n", "").replace("\ndef ", "\n" + helper)
    option = ", cache=True" if cached else ""
    return f'{HEADER}{reductions}\n\n@numba.njit("{SIGNATURE}", {SETTINGS}{option})\n{kernel_source}'


def cache_folder() -> Path | None:
    """Where compiled kernels are kept: LINKSWEEP_CACHE_DIR, or the user's cache folder; None if it can't be made."""
    import platformdirs

    folder = Path(os.environ.get("LINKSWEEP_CACHE_DIR") or platformdirs.user_cache_path("linksweep"))
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def _stored(folder: Path, text: str) -> Path | None:
    """The module's file, written whole unless it is there as it should be; None if it can't be."""
    import numba

    digest = hashlib.sha256(f"{numba.__version__} {sys.version} {text}".encode()).hexdigest()
    path = folder / f"kernel_{digest[:24]}.py"
    try:
        if not path.exists() or path.read_text() != text:
            handle, temporary = tempfile.mkstemp(dir=folder, suffix=".tmp")
            with os.fdopen(handle, "w") as file:
                file.write(text)
            os.replace(temporary, path)
    except OSError:
        return None
    return path


def _imported(path: Path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path}: not a module")
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module
