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
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

SETTINGS = 'error_model="numpy", nogil=True, _nrt=False'
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

IMPORTS = "import math\nfrom math import atan2, sqrt\n\nimport numba\n\n\n"


@cache
def compiled(kernel_source: str, helpers_source: str = "", signature: str = SIGNATURE) -> Callable:
    """The kernel of this source as machine code: from this process, from the user's cache, or compiled now.

    The helpers' digest in its text makes it another module when they change.
    """
    given = compiled_functions(helpers_source)
    decorator = f'@numba.njit("{signature}", {SETTINGS}, cache=__spec__ is not None)'
    text = f"# helpers {_digest(_helpers(helpers_source))}\n{IMPORTS}{decorator}\n{kernel_source}"
    return _namespace(text, given)["kernel"]


def compiled_functions(source: str) -> Mapping[str, Callable]:
    """A module of plain functions as functions that numba compiles when they are first called, by name."""
    return _compiled_functions(source, cache_folder())


@cache
def _compiled_functions(source: str, folder: Path | None) -> Mapping[str, Callable]:
    """The same, once for each folder: a kernel from a folder looks for its helpers under their name there."""
    made = _namespace(_helpers(source), {}) if source else {}
    return {name: value for name, value in made.items() if hasattr(value, "py_func")}


def _helpers(source: str) -> str:
    """The module that a module of plain functions becomes."""
    decorator = f"@numba.njit({SETTINGS}, cache=__spec__ is not None)\ndef "
    return IMPORTS + source.replace("import math\n", "").replace("\ndef ", "\n" + decorator)


def _namespace(text: str, given: Mapping[str, Callable]) -> Mapping[str, Any]:
    """What a module of this text defines: kept in the user's cache folder if that can be, else made afresh."""
    folder = cache_folder()
    path = folder and folder / f"kernel_{_digest(text)}.py"
    if path and stored(path, text):
        return vars(_imported(path, given))
    namespace = {"__spec__": None, **given}
    exec(text, namespace)
    return namespace


def _digest(text: str) -> str:
    import numba

    return hashlib.sha256(f"{numba.__version__} {sys.version} {text}".encode()).hexdigest()[:24]


def cache_folder() -> Path | None:
    """Where what took long is kept: LINKSWEEP_CACHE_DIR, or the user's cache folder; None if it can't be made."""
    import platformdirs

    folder = Path(os.environ.get("LINKSWEEP_CACHE_DIR") or platformdirs.user_cache_path("linksweep"))
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK) else None


def stored(path: Path, text: str) -> bool:
    """Whether a file of the cache holds this text: it is written, whole, unless it is there as it should be."""
    content = text.encode()
    try:
        if not path.exists() or path.read_bytes() != content:
            handle, temporary = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
            with os.fdopen(handle, "wb") as file:
                file.write(content)
            os.replace(temporary, path)
    except OSError:
        return False
    return True


def _imported(path: Path, given: Mapping[str, Callable]):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path}: not a module")
    module = importlib.util.module_from_spec(spec)
    vars(module).update(given)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module
