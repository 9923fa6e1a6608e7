"""Other programs that do the job, or part of it; each module needs one package, without which its row is missing.

Every module has `bind(q, theta2)`, which returns for a design and crank angles [degree] a `Bound`: its `call` is timed,
and its `read` makes rows of the call's result.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from benchmarks.rivals.peers import Array


class Bound(NamedTuple):
    """A call, ready to be timed, and a function that reads its result as rows (quantities, angles)."""

    call: Callable[[], Any]
    read: Callable[[Any], Array] = np.asarray
