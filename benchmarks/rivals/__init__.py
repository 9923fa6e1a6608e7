"""Other programs that do the job, or part of it; each module needs one package, and is a missing row without it.

Every module has `bind(q, theta2)`: a design and crank angles [degree] to a `Bound`, whose `call` is timed and whose
`read` makes rows of what the call gave.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from benchmarks.rivals.peers import Array


class Bound(NamedTuple):
    """A call, ready to be timed, and how its answer is read: rows (quantities, angles)."""

    call: Callable[[], Any]
    read: Callable[[Any], Array] = np.asarray
