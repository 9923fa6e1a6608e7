"""Scenes of many designs, studies stopped half way, and how they are compared and spoiled."""

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.studies.job import Job

PRESS = ls.example("press")
ENGINE = ls.SliderCrank(ls.Link(0.04, 1.0, 1e-3), ls.Link(0.14, 1.0, 3e-3, cg_distance=0.05), slider_mass=0.5)


def over(dim: str, *values: float, **coords) -> xr.DataArray:
    return xr.DataArray(list(values), coords or None, dim)


def grid() -> ls.Scene:
    """Dims of the geometry, of masses and of the speed, with labels and without; some designs cannot be assembled."""
    press = PRESS.mechanism
    crank = replace(press.crank, length=over("size", 0.04, 0.12, 0.3, 0.9))
    named = over("case", 0.3, 0.5, 0.7, case=["light", "as built, 2nd", "heavy"])
    mechanism = replace(press, crank=crank, coupler=ls.Link(0.22, named, 2.8e-3, cg_distance=0.11), branch="both")
    return replace(PRESS, mechanism=mechanism, omega2=over("omega2", -20.0, 30.0, 55.0, omega2=[-20.0, 30.0, 55.0]))


def sliding() -> ls.Scene:
    """Return designs of which friction wedges some, and some do not close."""
    mechanism = replace(ENGINE, friction=over("mu", 0.05, 0.1, 5.0, 9.0), offset=over("aside", 0.0, 0.01, 0.12))
    return ls.Scene(mechanism, omega2=100.0, gravity=(0.0, -9.81))


def gas() -> ls.Scene:
    """Pressure over the cycle by the way that the crank turns, which differs from design to design."""
    gas = ls.GasPressure(bore=over("bore", 0.08, 0.09), pressure=ls.OttoCycle(10.0, 6e6))
    return ls.Scene(ENGINE, omega2=over("speed", -100.0, -50.0, 50.0, 100.0), loads=[gas])


def moving() -> ls.Scene:
    """Loads over theta2, of which one differs from design to design, and a function."""
    rng = np.random.default_rng(1)
    angles = np.arange(12) * 30.0
    each = xr.DataArray(rng.normal(size=(5, 12)), {"theta2": angles, "n": [1, 2, 4, 8, 16]}, ("n", "theta2"))
    loads = [
        ls.Load("rocker", torque=each, interpolation="pchip"),
        ls.Load(
            "coupler", force=(lambda theta2: 30.0 * np.sin(np.radians(theta2)), over("m", 1.0, 2.0)), at=(0.1, 9.0)
        ),
    ]
    return replace(PRESS, loads=loads)


def loop() -> ls.Scene:
    return ls.Scene(
        ls.LoopTrack(30.0, 700.0), speed=over("entry", 5.0, 30.0, 60.0), gravity=(0.0, -9.81), profile="energy"
    )


def one() -> ls.Scene:
    return PRESS


SCENES = {scene.__name__: scene for scene in (grid, sliding, gas, moving, loop, one)}


def many() -> ls.Scene:
    return replace(PRESS, omega2=over("speed", *np.linspace(1.0, 60.0, 60)))


def assert_same(result: xr.Dataset, expected: xr.Dataset) -> None:
    """Everything but the command, and numbers to the bit."""
    result, expected = result.copy(), expected.copy()
    for ds, function in ((result, "study"), (expected, "peaks")):
        command = ds.attrs.pop("command")
        assert command.startswith(f"linksweep.{function}(scene")
        assert ds.attrs.pop("history").endswith(command)
    xr.testing.assert_identical(result, expected)
    assert list(result.variables) == list(expected.variables)
    assert dict(result.sizes) == dict(expected.sizes)
    for name, values in expected.variables.items():
        assert values.dtype.kind in "OUT" or result[name].values.tobytes() == values.values.tobytes()


def flipped(path: Path, byte: int, bit: int = 0) -> None:
    content = bytearray(path.read_bytes())
    content[byte] ^= 1 << bit
    path.write_bytes(content)


def stop_after(count: int, patch) -> list[object]:
    """Chunks computed from now on, of which the one after so many is interrupted."""
    computed: list[object] = []
    compute = Job.compute

    def watched(job, block):
        if block != {"speed": slice(0, 1)}:  # not the one that is tried out
            if len(computed) == count:
                raise KeyboardInterrupt
            computed.append(block)
        return compute(job, block)

    patch.setattr(Job, "compute", watched)
    return computed


def hang_after(count: int) -> None:
    """This process computes so many more chunks, then waits to be stopped: it does not finish by itself."""
    compute, left = Job.compute, [count]

    def hanging(job, block):
        left[0] -= block != {"speed": slice(0, 1)}  # not the one that is tried out
        if left[0] < 0:
            time.sleep(3600)
        return compute(job, block)

    Job.compute = hanging


def refused(call, *arguments, **options) -> str:
    with pytest.raises(ValueError) as error:  # noqa: PT011
        call(*arguments, **options)
    return str(error.value)


def content(folder: Path) -> dict[str, bytes]:
    return {str(path): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def stopped_study(folder: Path, patch) -> tuple[Path, bytes]:
    """A study of `many` that was stopped after three of its ten chunks; and the file that it should become."""
    ls.study(many(), folder / "whole.nc", of=["F32"], chunk=6)
    path = folder / "study.nc"
    with patch.context() as until_then:
        stop_after(3, until_then)
        with pytest.raises(KeyboardInterrupt, match=r"^stopped; 3 of 10 chunks are done: to go on from there, run the"):
            ls.study(many(), path, of=["F32"], chunk=6)
    return path, (folder / "whole.nc").read_bytes()
