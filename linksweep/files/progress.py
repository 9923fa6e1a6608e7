"""Progress bars of work that ends in a file: on a terminal and in a notebook, after the first second."""

from __future__ import annotations

import sys
import warnings
from typing import Any

SHOWN_AFTER = 1.0
"""Seconds of work after which a progress bar appears."""


def progress_bar(total: int, unit: str) -> Any:
    """Return tqdm's bar for so many steps, a context with `update`; without a terminal or a notebook it is silent."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "IProgress not found")  # a notebook without widgets has a bar of characters
        from tqdm.auto import tqdm  # here: only long work needs it
    disable = not (sys.stderr is not None and (sys.stderr.isatty() or _in_notebook()))
    words = {"unit": f" {unit}", "unit_scale": True, "delay": SHOWN_AFTER, "file": sys.stderr}
    return tqdm(total=total, disable=disable, **words)


def _in_notebook() -> bool:
    """Return whether a notebook shows what is printed: its streams are those of Jupyter's kernel."""
    return type(sys.stderr).__module__.startswith("ipykernel.")
