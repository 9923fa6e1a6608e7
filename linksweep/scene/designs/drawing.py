"""draw(scene, {...}, designs=[17]): designs by their numbers, each drawn without the others.

Philox (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", 2011) turns a key and a counter into four words of
64 bits. The key is the seed, the counter that of the design: its words do not depend on which others are drawn.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from linksweep.base.validate import quote, refuse
from linksweep.scene.designs.sampling import dim_problems, parameter_problems, seed_problems, with_designs
from linksweep.scene.scene import Scene

WORDS = 4
"""Words of one step of the counter."""
BITS = 52
"""Bits of a level: with them (k + 1/2)·2⁻⁵² is exact, and neither 0 nor 1, where a normal is infinite."""
SEEDS = 2**128
LABELS = 2**63
"""Numbers of designs are below it, so that they are labels of 64 bits with a sign."""


def draw(
    scene: Scene, parameters: Mapping[str, Any], *, designs: Iterable[int], seed: int = 0, dim: str = "design"
) -> Scene:
    """Draw designs of a scene by their numbers, as `linksweep.screen` draws them.

    Design 17 is the same to the bit whether it is drawn alone or with a million others.

    Parameters
    ----------
    scene : Scene
        Parameters that are not named stay as they are.
    parameters : mapping
        Values that each parameter may take, as in `linksweep.sample`.
    designs : iterable of int
        Numbers of the designs, from 0.
    seed : int, default 0
        Seed of the designs, below 2^128.
    dim : str, default "design"
        Name of the dimension of the designs, which has their numbers as labels.

    Returns
    -------
    Scene
        Its drawn parameters are DataArrays over `dim`, each independent of the others.

    Raises
    ------
    ValueError
        One line for each parameter that is unknown or whose range is invalid; for numbers of designs below 0 or from
        2^63 on; and for values that the scene refuses.

    Examples
    --------
    >>> import linksweep as ls
    >>> lengths = {"coupler.length": ("20 cm", "24 cm"), "rocker.length": ls.Normal(0.18, 1e-4)}
    >>> some = ls.draw(ls.example("press"), lengths, designs=[17, 999_999_999])
    >>> alone = ls.draw(ls.example("press"), lengths, designs=[999_999_999])
    >>> bool((some.mechanism.rocker.length[1] == alone.mechanism.rocker.length[0]).all())
    True
    """
    refuse([*parameter_problems(scene, parameters), *seed_range_problems(seed), *dim_problems(scene, dim)])
    numbers = _numbers(designs)
    return with_designs(scene, parameters, levels(len(parameters), numbers, int(seed)), numbers, dim)


def levels(parameters: int, numbers: np.ndarray, seed: int) -> np.ndarray:
    """Return a level in (0, 1), evenly distributed, of each parameter of each design, (parameter, design)."""
    steps = -(-parameters // WORDS)
    words = np.empty((len(numbers), steps * WORDS), dtype=np.uint64)
    breaks = np.flatnonzero(np.diff(numbers) != 1) + 1
    for first, last in zip([0, *breaks], [*breaks, len(numbers)], strict=True):  # designs in sequence at once
        philox = np.random.Philox(key=seed).advance(int(numbers[first]) * steps)
        words[first:last] = philox.random_raw((last - first) * steps * WORDS).reshape(last - first, -1)
    return ((words[:, :parameters] >> np.uint64(64 - BITS)).astype(float).T + 0.5) * 0.5**BITS


def seed_range_problems(seed: Any) -> list[str]:
    """Return the problem of a seed that is no key of the generator."""
    if seed is None or seed_problems(seed) or seed >= SEEDS:
        return [f"seed = {quote(seed)}: must be a whole number from 0 to 2^128 − 1"]
    return []


def _numbers(designs: Any) -> np.ndarray:
    """Return the numbers of designs as an array."""
    advice = "must be numbers of designs, whole and from 0, such as [17, 20] or range(100)"
    if isinstance(designs, range) and max(map(abs, (designs.start, designs.stop))) < 2**62:
        numbers = np.arange(designs.start, designs.stop, designs.step)
    else:
        numbers = np.asarray(list(designs) if _several(designs) else None)
    sound = numbers.ndim == 1 and numbers.size and numbers.dtype.kind in "iu"
    labels = sound and numbers.min() >= 0 and numbers.max() < LABELS
    refuse([] if labels else [f"designs = {quote(designs)}: {advice}"])
    return numbers.astype(np.int64)


def _several(designs: Any) -> bool:
    return isinstance(designs, Iterable) and not isinstance(designs, str | bytes) and getattr(designs, "ndim", 1) == 1
