"""The compiled kernels take square roots eight or four at a time, where the machine can.

A lost vectorisation is silent and costs a factor of eight: nothing but the machine code shows it.
"""

import re
from functools import partial

import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from benchmarks.cases import ALL, GENERAL, NINE, batch, scene
from benchmarks.speed.kernel import kernel_of, way
from linksweep.base import cache
from linksweep.engine.kernel import compile

PINS = ("F12", "F32", "F43", "F14")
general, designs, six_bar = scene(GENERAL), scene(batch(3, *ALL)), ls.example("watt-2")
CALLS = {
    "nine unknowns": (partial(ls.sweep, general, 72, of=NINE), 1),
    "nine unknowns of many designs": (partial(ls.sweep, designs, 72, of=NINE, threads=1), 1),
    "more rows than one loop compares": (partial(ls.sweep, general, 72), 2 + len(PINS)),
    "more rows than one loop compares, of many designs": (partial(ls.sweep, designs, 72, threads=1), 2 + len(PINS)),
    "rows that are copied": (partial(ls.sweep, six_bar, 72, of=six_bar.mechanism.unknowns("crank")), 2),
    "T12 alone": (partial(ls.sweep, general, 72, of=("T12",)), 1),
    "magnitudes": (partial(ls.sweep, general, 72, of=PINS), 1 + len(PINS)),
    "peaks": (partial(ls.peaks, designs, theta2=72, threads=1), 1),
}
"""Calls, and how many square roots their kernels take per sample."""


def width() -> str:
    """Registers that the host's square roots must be in; skips where it has none wide enough."""
    binding = pytest.importorskip("llvmlite.binding")
    features = binding.get_host_cpu_features()
    if not features.get("avx2"):
        pytest.skip("neither AVX-512 nor AVX2 on this machine")
    return "[yz]mm" if features.get("avx512f") else "ymm"


@pytest.fixture
def assembly(monkeypatch):
    """Machine code of the one kernel that a call runs, compiled here: a cached one has none to show."""
    monkeypatch.setattr(cache, "cache_folder", lambda: None)

    def of(call) -> str:
        kernel = compile.compiled.__wrapped__(*kernel_of(call).sources)
        return "\n".join(kernel.inspect_asm().values())

    return of


@pytest.mark.parametrize("name", long_but(CALLS, "nine unknowns of many designs"))
def test_square_roots_are_packed(name, assembly):
    registers = width()
    call, roots = CALLS[name]
    packed = re.findall(rf"\bvsqrtpd\s.*%{registers}", assembly(call))
    assert len(packed) >= roots


@pytest.mark.parametrize("threads", [1, 2])
def test_rows_that_are_copied_have_the_bits_of_numpy(threads):
    """More angles than one call of the kernel takes."""
    ways = {}
    for name in ("compiled", "interpreted"):
        with way(name):
            ways[name] = ls.sweep(six_bar, 5001, of=six_bar.mechanism.unknowns("crank"), threads=threads)
    xr.testing.assert_identical(ways["compiled"], ways["interpreted"])


def test_the_search_for_the_largest_is_packed(assembly):
    """A block of 64 running maxima fills eight registers of AVX-512; a search sample by sample leaves five or fewer."""
    registers = width()
    call, _ = CALLS["peaks"]
    assert len(re.findall(rf"\bvmaxpd\s.*%{registers}", assembly(call))) >= 8
