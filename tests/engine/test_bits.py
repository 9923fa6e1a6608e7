"""Results are equal to the last bit, however they are computed.

By numpy or compiled, by one thread or two, in any order, alone or among others, in one sweep or in chunks.
"""

import os
import subprocess
import sys
from functools import partial

import numpy as np
import pytest
import xarray as xr
from long import long_but

import linksweep as ls
from linksweep.engine import run, threads
from linksweep.engine.trace.plan import plan

KINEMATICS = ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4")
MAGNITUDES = ("F12", "F32", "F43", "F14")
UNKNOWNS = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T12")
PLACES = ("Bx", "By", "Cx", "Cy", "aG2x", "aG2y", "aG3x", "aG3y", "aG4x", "aG4y")
OTHERS = ("F21x", "F34y", "F41", "transmission_angle", "power", "power_residual", "error_bound")
REQUESTS = {
    "unknowns": UNKNOWNS,
    "torque": ("T12",),
    "kinematics": KINEMATICS,
    "magnitudes": MAGNITUDES,
    "others": (*PLACES, *OTHERS),
}


@pytest.fixture
def sweep(monkeypatch):
    """ls.sweep, made to go one way or the other, and watched doing so."""
    kernels = []
    compiled = run.compiled
    monkeypatch.setattr(run, "compiled", lambda *source: kernels.append(source) or compiled(*source))

    def swept(way, scene, theta2, **request):
        monkeypatch.setattr(run, "COMPILE_AFTER", {"compiled": -1, "interpreted": np.inf}[way])
        kernels.clear()
        cycle = ls.sweep(scene, theta2, **request)
        assert bool(kernels) == (way == "compiled")
        return cycle

    return swept


def assert_same_bits(result: xr.Dataset, expected: xr.Dataset) -> None:
    """Equal dims and equal bits; any NaN is as good as another."""
    assert set(result.data_vars) == set(expected.data_vars)
    for name, value in expected.data_vars.items():
        x, y = result[name].values, value.values
        assert result[name].dims == value.dims, name
        assert x.dtype == y.dtype, name
        assert np.all((x.view(f"i{x.itemsize}") == y.view(f"i{y.itemsize}")) | (np.isnan(x) & np.isnan(y))), name


def four_bar(length=0.12, mass=0.4, **changes) -> ls.FourBar:
    """A crank-rocker with its centres of gravity off the lines of pins; `length` and `mass` are the coupler's."""
    crank = ls.Link(0.04, 0.25, 1.3e-4, cg_distance=0.013, cg_angle=70.0)
    coupler = ls.Link(length, mass, 5e-4, cg_distance=0.05, cg_angle=12.0)
    rocker = ls.Link(0.09, 0.33, 4e-4, cg_distance=0.06, cg_angle=-33.0)
    return ls.FourBar(crank, coupler, rocker, ground=0.13, **changes)


def plain(**changes) -> ls.Scene:
    return ls.Scene(four_bar(), omega2=-31.0, alpha2=7.0, gravity=(0.3, -9.81), **changes)


def ripple(theta2):
    return 30.0 + 2.0 * np.cos(np.radians(theta2))


def loaded(**changes) -> ls.Scene:
    """All sorts of loads, and what changes over the revolution in each of the ways to say so."""
    torque = xr.DataArray([1.0, 0.5, -2.0, 0.25], {"theta2": [0.0, 90.0, 180.0, 270.0]}, "theta2")
    loads = [
        ls.Load("coupler", force=(ripple, -80.0), at=(0.1, 15.0), frame="link", origin="cg"),
        ls.Load("rocker", force=(3.0, 5.0), at=(0.09, 0.0), torque=torque, interpolation="pchip"),
        ls.Load("crank", torque=0.7),
    ]
    return ls.Scene(four_bar(), omega2=ripple, alpha2=-12.0, gravity=(0.0, -9.81), loads=loads, **changes)


def designs(count=400, **changes) -> ls.Scene:
    """Random lengths, masses and speeds along "design"; some cannot be assembled, at some angles or at all."""
    rng = np.random.default_rng(3)
    numbers = [xr.DataArray(rng.uniform(0.03, 0.2, count), dims="design") for _ in range(4)]
    links = [ls.Link(x, 5.0 * x, 0.4 * x**3, cg_distance=0.4 * x, cg_angle=20.0) for x in numbers[:3]]
    speed = xr.DataArray(rng.uniform(-50, 50, count), dims="design")
    return ls.Scene(ls.FourBar(*links, ground=numbers[3], branch="both"), omega2=speed, alpha2=3.0, **changes)


SCENES = {"plain": plain, "loaded": loaded, "coupler": partial(loaded, drive="coupler"), "designs": designs}


@pytest.mark.parametrize(
    ("scene", "request_name"),
    [
        ("plain", "unknowns"),
        pytest.param("plain", "torque", marks=pytest.mark.long),
        pytest.param("plain", "kinematics", marks=pytest.mark.long),
        ("plain", "magnitudes"),
        ("loaded", "unknowns"),
        pytest.param("loaded", "torque", marks=pytest.mark.long),
        pytest.param("loaded", "others", marks=pytest.mark.long),
        ("designs", "unknowns"),
        pytest.param("designs", "kinematics", marks=pytest.mark.long),
    ],
)
def test_compiled_and_interpreted_kernels_agree(sweep, scene, request_name):
    names, scene = REQUESTS[request_name], SCENES[scene]()
    assert_same_bits(*(sweep(way, scene, 37, of=names) for way in ("compiled", "interpreted")))


@pytest.mark.parametrize("drive", long_but(["coupler", "rocker"], "rocker"))
def test_compiled_and_interpreted_kernels_agree_for_each_drive(sweep, drive):
    assert_same_bits(*(sweep(way, loaded(drive=drive), 37) for way in ("compiled", "interpreted")))


def test_one_thread_and_two_agree(sweep, monkeypatch):
    """Designs are shared among the threads, or the angles of a single design."""
    monkeypatch.setattr(run, "SAMPLES_PER_THREAD", 100)
    for scene, count in ((designs(), 72), (loaded(), 5000)):
        one, two, three = (sweep("compiled", scene, count, threads=n) for n in (1, 2, 3))
        assert_same_bits(one, two)
        assert_same_bits(one, three)


@pytest.mark.parametrize("count", [5, 37, 720])
def test_results_written_past_the_caches_agree(sweep, monkeypatch, count):
    """Rows are then filled up to whole vectors, and threads share whole vectors."""
    monkeypatch.setattr(run, "SAMPLES_PER_THREAD", 100)
    for scene in (designs(), loaded()):
        through, past = [], []
        for least, results in ((np.inf, through), (0, past)):
            monkeypatch.setattr(run, "STREAMED_FROM", least)
            results += [sweep("compiled", scene, count, threads=n) for n in (1, 2)]
        for result in (through[1], *past):
            assert_same_bits(result, through[0])


def test_threads_share_the_work(sweep, monkeypatch):
    """The test above relies on this."""
    monkeypatch.setattr(run, "SAMPLES_PER_THREAD", 100)
    submitted, pool = [], threads._pool
    monkeypatch.setattr(threads, "_pool", lambda process: submitted.append(process) or pool(process))
    sweep("compiled", designs(), 72, of=KINEMATICS, threads=1)
    assert not submitted
    sweep("compiled", designs(), 72, of=KINEMATICS, threads=2)
    assert submitted


def reversed_designs(scene: ls.Scene) -> ls.Scene:
    """Return the designs in the opposite order."""

    def turned(value):
        return value.isel(design=slice(None, None, -1)) if "design" in getattr(value, "dims", ()) else value

    def link(old):
        return ls.Link(
            *(turned(getattr(old, name)) for name in ("length", "mass", "inertia", "cg_distance", "cg_angle"))
        )

    bars = scene.mechanism
    links = (link(old) for old in (bars.crank, bars.coupler, bars.rocker))
    return ls.Scene(
        ls.FourBar(*links, ground=turned(bars.ground), branch=bars.branch),
        omega2=turned(scene.omega2),
        alpha2=scene.alpha2,
    )


@pytest.mark.parametrize("way", ["compiled", "interpreted"])
def test_order_of_designs_does_not_matter(sweep, way):
    forth, back = sweep(way, designs(), 37), sweep(way, reversed_designs(designs()), 37)
    assert_same_bits(back.isel(design=slice(None, None, -1)), forth)


@pytest.mark.parametrize("name", SCENES)
def test_each_output_alone_is_what_it_is_among_all(sweep, name):
    scene = SCENES[name]()
    torque = {"coupler": "T13"}.get(scene.drive, "T12")
    names = (*KINEMATICS, *MAGNITUDES, *UNKNOWNS[:8], torque, *PLACES, *OTHERS)
    every = sweep("interpreted", scene, 13, of=names)
    for name in names:
        assert_same_bits(sweep("interpreted", scene, 13, of=name), every[[name, "status"]])


def test_compiled_subset_is_what_it_is_among_all(sweep):
    """The kernel of one output is another program than the kernel of all."""
    every = sweep("compiled", loaded(), 37)
    for names in (["T12"], ["F14x", "omega4"]):
        assert_same_bits(sweep("compiled", loaded(), 37, of=names), every[[*names, "status"]])


@pytest.mark.parametrize("way", ["compiled", "interpreted"])
@pytest.mark.parametrize("scene", ["plain", "loaded", "designs"])
def test_chunks_of_a_sweep_are_the_sweep(sweep, way, scene):
    """Nothing depends on the previous angle, nor on how the grid was requested."""
    scene = SCENES[scene]()
    whole = sweep(way, scene, 72)
    for chunk in (slice(0, 72), slice(0, 1), slice(5, 30), slice(None, None, -1)):
        part = whole.isel(theta2=chunk)
        assert_same_bits(sweep(way, scene, part.theta2.values), part)


# ---- grids of designs -----

MASSES = xr.DataArray([0.1, 0.4, 1.7], dims="mass")
LENGTHS = xr.DataArray([0.11, 0.12, 0.13, 0.2], dims="length")


def on_grid(length, mass, speed=12.0) -> ls.Scene:
    loads = [ls.Load("coupler", force=(5.0, -80.0), at=(0.1, 15.0), frame="link")]
    return ls.Scene(four_bar(length, mass), omega2=speed, alpha2=9.0, gravity=(0.0, -9.81), loads=loads)


@pytest.mark.parametrize("way", long_but(["compiled", "interpreted"], "interpreted"))
def test_a_grid_of_designs_is_the_designs_in_a_loop(sweep, way):
    """Also along the last length, which cannot be assembled all round."""
    names = (*KINEMATICS, *MAGNITUDES, *UNKNOWNS, "Cx", "aG3y", "aG4x", *OTHERS)
    grid = sweep(way, on_grid(LENGTHS, MASSES), 24, of=names)
    assert set(grid.status.values.flat) == {0, 1}
    for i, length in enumerate(LENGTHS.values):
        for k, mass in enumerate(MASSES.values):
            single = sweep("interpreted", on_grid(float(length), float(mass)), 24, of=names)
            assert_same_bits(grid.isel(length=i, mass=k, missing_dims="ignore"), single)


def test_a_shared_value_is_nan_only_where_no_design_is_ok(sweep):
    """Pin B does not know the coupler's length; where no length can be assembled, nobody may rely on it."""
    grid = sweep("interpreted", on_grid(LENGTHS[2:], MASSES), 24, of=["Bx", "aG2y"])
    assert (grid.status == 0).any("length").all()
    assert grid.Bx.notnull().all()
    grid = sweep("interpreted", on_grid(LENGTHS[3:], MASSES), 24, of=["Bx", "aG2y"])
    nobody = (grid.status != 0).all("length")
    assert 0 < nobody.sum() < 24
    for name in ("Bx", "aG2y"):
        np.testing.assert_array_equal(grid[name].isnull().values, nobody.values)


@pytest.mark.parametrize("way", ["compiled", "interpreted"])
def test_variables_carry_only_the_dims_they_depend_on(sweep, way):
    speed = xr.DataArray([10.0, 20.0], dims="speed")
    names = ("theta3", "omega3", "F14y", "F43x", "T12", "Bx", "aG2x", "omega2", "transmission_angle")
    grid = sweep(way, on_grid(LENGTHS, MASSES, speed), 24, of=names)
    dims = {name: set(array.dims) for name, array in grid.data_vars.items()}
    assert dims == {
        "theta3": {"length", "theta2"},
        "transmission_angle": {"length", "theta2"},
        "status": {"length", "theta2"},
        "omega3": {"length", "speed", "theta2"},
        "F43x": {"length", "mass", "speed", "theta2"},
        "F14y": {"length", "mass", "speed", "theta2"},
        "T12": {"length", "mass", "speed", "theta2"},
        "Bx": {"theta2"},
        "aG2x": {"speed", "theta2"},
        "omega2": {"speed"},
    }
    assert all(array.dims[-1] == "theta2" for array in grid.data_vars.values() if "theta2" in array.dims)


def test_quantities_without_masses_are_computed_once():
    """In the work, not only in the result: no kinematic operation is in the loop over masses."""
    scene = on_grid(LENGTHS, MASSES)
    kinematics = plan(scene.table, KINEMATICS, scene.inputs.forms)
    assert not any("mass" in node.dims for node in kinematics.nodes)
    forces = plan(scene.table, (*KINEMATICS, *UNKNOWNS), scene.inputs.forms)
    shared = forces.operations("length", "theta2")
    assert shared >= kinematics.operations("length", "theta2")
    assert forces.operations("length", "mass", "theta2").total() < shared.total()
    assert forces.loops.index("length") < forces.loops.index("mass")


OTHER_PROCESSOR = """
import hashlib
import numpy as np
import linksweep as ls

press, engine = ls.example("press"), ls.example("engine")
designs = ls.sample(press, {"coupler.length": (0.2, 0.24)}, n=4000)
for ds in (ls.sweep(press, 20_000), ls.sweep(engine, 7200), ls.peaks(designs), ls.peaks(designs, theta2=360)):
    numbers = (np.ascontiguousarray(each.values).tobytes() for each in ds.data_vars.values())
    print(hashlib.sha256(b"".join(numbers)).hexdigest())
"""


@pytest.mark.long
def test_an_older_processor_with_one_thread_gives_the_same_bits(tmp_path):
    """It has no wide vectors, and the C library's function in place of FMA; samples and exact peaks are compared."""
    older = {"NUMBA_CPU_NAME": "x86-64-v2", "NUMBA_NUM_THREADS": "1", "LINKSWEEP_CACHE_DIR": str(tmp_path)}
    runs = [
        subprocess.run(
            [sys.executable, "-c", OTHER_PROCESSOR], env=os.environ | more, capture_output=True, text=True, check=True
        )
        for more in ({}, older)
    ]
    digests = runs[0].stdout.split()
    assert len(digests) == 4
    assert runs[1].stdout.split() == digests
