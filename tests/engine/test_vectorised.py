"""The compiled kernels work on the samples that the processor's registers hold side by side, with the bits of numpy.

A lost vectorisation is silent and costs a factor of eight: nothing but the machine code shows it.
"""

import re
from functools import partial

import numpy as np
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from benchmarks.cases import ALL, GENERAL, NINE, batch, scene
from benchmarks.speed.kernel import kernel_of, way
from linksweep.base import cache
from linksweep.engine import run
from linksweep.engine.kernel import compile, vectors
from linksweep.engine.kernel.machine_code import INTEGER

PINS = ("F12", "F32", "F43", "F14")
general, designs, six_bar = scene(GENERAL), scene(batch(3, *ALL)), ls.example("watt-2")
CALLS = {
    "nine unknowns": (partial(ls.sweep, general, 72, of=NINE), 1),
    "nine unknowns of many designs": (partial(ls.sweep, designs, 72, of=NINE, threads=1), 1),
    "default quantities": (partial(ls.sweep, general, 72), 1 + len(PINS)),
    "default quantities of many designs": (partial(ls.sweep, designs, 72, threads=1), 1 + len(PINS)),
    "six-bar": (partial(ls.sweep, six_bar, 72, of=six_bar.mechanism.unknowns("crank")), 2),
    "T12 alone": (partial(ls.sweep, general, 72, of=("T12",)), 1),
    "magnitudes": (partial(ls.sweep, general, 72, of=PINS), 1 + len(PINS)),
    "peaks": (partial(ls.peaks, designs, theta2=72, threads=1), 1),
    "peaks of designs side by side": (partial(ls.peaks, scene(batch(25, *ALL)), theta2=72, threads=1), 2),
}
"""Calls, and how many registers of square roots their kernels take: that of each closure and those of magnitudes; of
designs side by side two."""


def width() -> str:
    """Registers that the host's square roots must be in; skips where it has none wide enough."""
    binding = pytest.importorskip("llvmlite.binding")
    features = binding.get_host_cpu_features()
    if not features.get("avx2"):
        pytest.skip("neither AVX-512 nor AVX2 on this machine")
    return "zmm" if features.get("avx512f") else "ymm"


@pytest.fixture
def assembly(monkeypatch):
    """Machine code of the one kernel that a call runs, compiled here: a cached one has none to show."""
    monkeypatch.setattr(cache, "cache_folder", lambda: None)

    def of(call) -> str:
        return compile.compiled.__wrapped__(*kernel_of(call).sources).owner._library.get_asm_str()

    return of


@pytest.mark.parametrize("name", long_but(CALLS, "nine unknowns of many designs"))
def test_square_roots_are_packed(name, assembly):
    registers = width()
    call, roots = CALLS[name]
    packed = re.findall(rf"\bvsqrtpd\s.*%{registers}", assembly(call))
    assert len(packed) == roots


REQUESTS = {
    "two toggles": partial(ls.sweep, six_bar),
    "guides with friction": partial(ls.sweep, ls.example("engine")),
    "designs": partial(ls.sweep, designs, of=(*NINE, "transmission_angle")),
    "largest samples": partial(ls.peaks, designs),
    "largest samples, masses side by side": partial(ls.peaks, scene(batch(25, "m3", "m4")), of=NINE),
}


@pytest.mark.parametrize("width", [4, 8, 16])
@pytest.mark.parametrize("request_name", long_but(REQUESTS, "two toggles", "largest samples, masses side by side"))
def test_any_width_has_the_bits_of_numpy(request_name, width, monkeypatch):
    """Rows are shorter than a vector, whole vectors, or neither."""
    monkeypatch.setattr(vectors, "width", lambda: width)
    compile.compiled.cache_clear()
    for samples in (1, 3, 16, 37):
        ways = {}
        for name in ("compiled", "interpreted"):
            with way(name):
                ways[name] = REQUESTS[request_name](theta2=samples, threads=1)
        xr.testing.assert_identical(ways["compiled"], ways["interpreted"])
    compile.compiled.cache_clear()


def test_the_search_for_the_largest_is_packed(assembly):
    """A block of 64 running maxima fills eight registers of AVX-512; a search sample by sample leaves five or fewer."""
    registers = width()
    if pytest.importorskip("llvmlite.binding").llvm_version_info < (20,):
        pytest.skip("LLVM 15, of numba 0.61, takes the maxima one by one: the same numbers, more slowly")
    call, *_ = CALLS["peaks"]
    assert len(re.findall(rf"\bvmaxpd\s.*%{registers}", assembly(call))) >= 8


def test_lines_are_written_past_the_caches_at_once(monkeypatch, assembly):
    """Halves of a line with stores to others between them go to memory one by one: results took three times as long."""
    width()
    monkeypatch.setattr(vectors, "width", lambda: 8)
    monkeypatch.setattr(run, "STREAMED_FROM", 0)
    run.runner.cache_clear()
    stores = re.findall(r"\bvmovntp[sd]\s+%([yz])mm\d+, (\d*)\((.*)\)", assembly(partial(ls.sweep, general, 72)))
    run.runner.cache_clear()
    halves = [(base, int(offset or 0)) for register, offset, base in stores if register == "y"]
    assert len(stores) - len(halves) // 2 == len(ls.sweep(general, 72).data_vars) - 1  # all but status
    for (base, offset), (next_base, next_offset) in zip(halves[::2], halves[1::2], strict=True):
        assert base == next_base
        assert {offset % 64, next_offset % 64} == {0, 32}


CONDITIONS = """
@vectorised
def rows(samples, x, y, values, flags, result):
    values[2] = values[0] < values[1]
    for j in in_vectors(0, samples, samples):
        flags[j] = x[j] < y[j]
    above = values[2]
    for j in in_vectors(0, samples, samples):
        smaller = where(flags[j], x[j], y[j])
        result[j] = where(above, smaller, -1.0)


def kernel(samples, x, y, values, flags, result):
    rows(samples, x, y, values, flags, result)
"""


@pytest.mark.parametrize("values", [(1.0, 2.0), (2.0, 1.0)])
def test_conditions_are_stored_as_one_and_zero(values):
    x, y = np.random.default_rng(3).standard_normal((2, 37))
    compiled, (flags, result) = np.array([*values, np.nan]), np.empty((2, 37))
    kernel = compile.compiled.__wrapped__(CONDITIONS, kinds=(INTEGER, *[compile.FLOATS] * 5))
    kernel(37, x, y, compiled, flags, result)
    above = values[0] < values[1]
    assert compiled[2] == above
    np.testing.assert_array_equal(flags, x < y)
    np.testing.assert_array_equal(result, np.minimum(x, y) if above else -np.ones(37))
