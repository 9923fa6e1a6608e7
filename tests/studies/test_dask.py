"""Scenes of dask arrays give lazy results, and a cluster computes studies, equal to the bit."""

import logging
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace

import dask
import dask.array
import numpy as np
import pytest
import xarray as xr
from studies import ENGINE, PRESS, SCENES, gas, grid, many, refused, sliding, stopped_study

import linksweep as ls
from linksweep.results import dask_blocks
from linksweep.scene.parameters import replaced
from linksweep.studies import cluster as cluster_module
from linksweep.studies.job import Job
from linksweep.studies.partial import Partial
from linksweep.studies.screening import Screening


def lazy(scene: ls.Scene, chunk: int = 2) -> ls.Scene:
    return replaced(scene, {path: array.chunk(chunk) for path, array in scene.arrays.items()})


def never(*shape: int) -> dask.array.Array:
    """Return numbers that must not be computed."""

    def compute_none():
        raise RuntimeError("computed")

    return dask.array.from_delayed(dask.delayed(compute_none)(), shape, float)


def computed(ds: xr.Dataset) -> xr.Dataset:
    return ds.compute(scheduler="threads")


def assert_equal(lazy: xr.Dataset, expected: xr.Dataset) -> None:
    """Check that a lazy result and its attributes equal the expected ones to the bit."""
    eager = computed(lazy)
    assert list(eager.variables) == list(expected.variables)
    xr.testing.assert_identical(eager.drop_attrs(deep=False), expected.drop_attrs(deep=False))
    for name, values in expected.variables.items():
        assert eager[name].dims == values.dims
        assert values.dtype.kind in "OUT" or eager[name].values.tobytes() == values.values.tobytes()


def with_status_over_all(peaks: xr.Dataset, like: xr.Dataset) -> xr.Dataset:
    """Return peaks with the status broadcast to all dims of the designs."""
    dims = like.status.dims
    status = peaks.status.variable.set_dims({dim: like.sizes[dim] for dim in dims})
    return peaks.assign(status=status)


# -------------------------------------------------------------------------------------------------- lazy results


@pytest.mark.parametrize("scene", [name for name in SCENES if name != "one"])
def test_a_lazy_sweep_equals_the_eager_one(scene):
    scene = SCENES[scene]()
    outcome, expected = ls.sweep(lazy(scene), 48), ls.sweep(scene, 48)
    assert all(values.chunks is not None for values in outcome.data_vars.values())
    assert_equal(outcome, expected)


@pytest.mark.parametrize(("limit", "of_each"), [({}, 1), ({"threads": 2}, 2)])
@pytest.mark.parametrize("function", [ls.sweep, ls.breakdown])
def test_a_limit_of_threads_holds_for_each_block(function, limit, of_each, monkeypatch):
    """Blocks are computed beside each other, when the function that asked for them has ended."""
    seen, compute = set(), dask_blocks.Task.__call__
    monkeypatch.setattr(
        dask_blocks.Task, "__call__", lambda task, x: seen.add(task.options["threads"]) or compute(task, x)
    )
    computed(function(lazy(many(), 20), theta2=8, of=["F32"], **limit))
    assert seen == {of_each}


@pytest.mark.parametrize("scene", [name for name in SCENES if name != "one"])
def test_lazy_peaks_equal_the_eager_ones(scene):
    scene = SCENES[scene]()
    outcome, expected = (
        ls.peaks(lazy(scene), **{scene.mechanism.index: 48}),
        ls.peaks(scene, **{scene.mechanism.index: 48}),
    )
    assert_equal(outcome, with_status_over_all(expected, outcome))


def test_lazy_exact_peaks_equal_the_eager_ones():
    peaks, expected = ls.peaks(lazy(many(), 25), ["F32"]), ls.peaks(many(), ["F32"])
    assert peaks.F32_peak.chunks == ((25, 25, 10),)
    assert_equal(peaks, with_status_over_all(expected, peaks))
    assert peaks.attrs == expected.attrs


def test_attributes_equal_those_of_the_eager_result():
    for scene in (grid(), sliding(), gas()):
        assert ls.sweep(lazy(scene), theta2=8).attrs == ls.sweep(scene, theta2=8).attrs
        assert ls.peaks(lazy(scene), theta2=8).attrs == ls.peaks(scene, theta2=8).attrs


AWAKE = """
import sys
import linksweep as ls
bars = [ls.Bar(length=length, width=0.02, thickness=0.02, density=7750) for length in (0.08, 0.22, 0.18)]
scene = ls.Scene(ls.FourBar(*bars, ground=0.20), omega2=30.0)
ls.sweep(scene)
ls.peaks(scene)
print(*{"dask.array", "distributed", "pint"}.intersection(sys.modules))
"""


def test_a_scene_of_plain_numbers_imports_neither_dask_nor_pint():
    """Importing them takes longer than a sweep; xarray would do so to recognize their arrays."""
    assert subprocess.run([sys.executable, "-c", AWAKE], capture_output=True, text=True, check=True).stdout == "\n"


def test_nothing_is_computed_before_compute():
    length = xr.DataArray(never(4), dims="a")
    torque = xr.DataArray(never(4, 6), {"theta2": np.arange(6) * 60.0}, ("a", "theta2"))
    mechanism = replace(PRESS.mechanism, coupler=replace(PRESS.mechanism.coupler, length=length))
    scene = replace(PRESS, mechanism=mechanism, loads=[ls.Load("rocker", torque=torque)])
    for outcome in (ls.peaks(scene, ["F32"]), ls.sweep(scene), ls.sweep(scene, solver="dense")):
        assert outcome.sizes["a"] == 4
        with pytest.raises(RuntimeError, match="computed"):
            computed(outcome)


def test_no_constructor_computes_lazy_numbers():
    numbers = [xr.DataArray(never(3), dims="a") for _ in range(8)]
    cycles = [
        ls.OttoCycle(*numbers[:2], intake_pressure=numbers[2], gamma=numbers[3]),
        ls.DieselCycle(numbers[0], cutoff_ratio=numbers[1], peak_pressure=numbers[2]),
    ]
    for cycle in cycles:
        mechanism = replace(ENGINE, offset=numbers[4], friction=numbers[5])
        scene = ls.Scene(mechanism, omega2=numbers[6], loads=[ls.GasPressure(bore=numbers[7], pressure=cycle)])
        assert ls.sweep(scene, of=["T12"]).T12.dims == ("a", "theta2")
    car = ls.Scene(ls.LoopTrack(radius=numbers[0], mass=numbers[1]), speed=numbers[2], profile="energy")
    assert ls.peaks(car).sizes == {"a": 3}


def test_shared_values_come_from_any_design_that_has_them():
    """The rod's angle is independent of friction: where friction jams in one block, another block has the value."""
    whole = ls.sweep(sliding(), theta2=24, of=["theta3", "T12"])
    jammed = whole.status == 4
    assert whole.theta3.dims == ("aside", "theta2")
    assert (jammed.any("mu") & ~jammed.all("mu")).any()
    assert_equal(ls.sweep(lazy(sliding(), 1), theta2=24, of=["theta3", "T12"]), whole)


def test_the_direction_of_a_lazy_crank_is_known_block_by_block():
    """Without masses only the sign of the speed matters, by the strokes of the cycle; it is constant in each block."""
    massless = ls.SliderCrank(ls.Link(0.04, 0.0, 0.0), ls.Link(0.14, 0.0, 0.0), slider_mass=0.0)
    scene = replace(gas(), mechanism=massless)
    expected = ls.sweep(scene, theta2=24, of=["F14y"])
    assert expected.F14y.dims == ("speed", "bore", "theta2")
    assert_equal(ls.sweep(lazy(scene), theta2=24, of=["F14y"]), expected)


def test_peaks_are_not_chunked_along_shared_dims():
    outcome, whole = (ls.peaks(scene, ["theta3", "F32"], theta2=24) for scene in (lazy(sliding(), 1), sliding()))
    assert outcome.F32_peak.chunks == ((1, 1, 1), (4,))
    assert_equal(outcome, with_status_over_all(whole, outcome))


def test_requests_of_one_scene_do_not_mix():
    scene = lazy(grid())
    fast, dense = (ls.sweep(scene, theta2=8, of=["T12"], solver=solver) for solver in ("fast", "dense"))
    both = dask.compute(fast, dense, scheduler="threads")
    for outcome, solver in zip(both, ("fast", "dense"), strict=True):
        assert_equal(outcome, ls.sweep(grid(), theta2=8, of=["T12"], solver=solver))
    assert not both[0].T12.equals(both[1].T12)


def test_a_lazy_number_without_dims_is_a_number():
    mass = xr.DataArray(dask.array.ones(()), attrs={"units": "kg"})
    coupler = ls.Link(PRESS.mechanism.coupler.length, mass, 2e-3, cg_distance=0.1)
    scene = replace(many(), mechanism=replace(PRESS.mechanism, coupler=coupler))
    eager = replaced(scene, {"coupler.mass": mass.compute()})
    assert_equal(ls.sweep(scene, theta2=6), ls.sweep(eager, theta2=6))
    assert_equal(ls.sweep(lazy(scene, 20), theta2=6), ls.sweep(eager, theta2=6))


def test_a_lazy_load_over_the_angle_is_chunked_along_the_designs_only():
    scene = SCENES["moving"]()
    path = "loads[1].torque"
    peaks = ls.peaks(replaced(scene, {path: scene.arrays[path].chunk({"n": 2, "theta2": 5})}), ["T12"], theta2=30)
    expected = ls.peaks(scene, ["T12"], theta2=30)
    assert peaks.T12_peak.chunks == ((2, 2, 1), (2,))
    assert np.array_equal(computed(peaks).T12_peak, expected.T12_peak)
    assert "scene" not in peaks.attrs  # lazy numbers are not stored in the Dataset


def test_a_lazy_load_of_one_design_is_computed_at_once():
    torque = xr.DataArray([1.0, 9.0, -4.0, 2.0], {"theta2": [0, 90, 180, 270]}, "theta2")
    loads = (ls.Load("rocker", torque=each, interpolation="linear") for each in (torque.chunk(), torque))
    made, expected = (replace(PRESS, loads=[load]) for load in loads)
    assert ls.peaks(made, of=["T12"]).identical(ls.peaks(expected, of=["T12"]))


# -------------------------------------------------------------------------------------------------------- errors


def spoiled(value: float) -> ls.Scene:
    """Return a lazy scene of six unlabelled designs, of which the fifth is refused."""
    length = np.full(6, 0.2)
    length[4] = value
    link = replace(PRESS.mechanism.coupler, length=xr.DataArray(length, dims="design").chunk(2))
    return replace(PRESS, mechanism=replace(PRESS.mechanism, coupler=link))


@pytest.mark.parametrize("value", [-0.1, 0.0, np.nan])
def test_a_refused_design_raises_when_computed(value):
    expected = f"coupler.length = {value:g} m at design = 4: must be "
    for outcome in (ls.sweep(spoiled(value), theta2=6), ls.peaks(spoiled(value), ["T12"], theta2=6)):
        assert refused(computed, outcome).startswith(expected)
        assert computed(outcome.isel(design=slice(0, 4))).status.values.max() == 0  # other designs are computed


@pytest.mark.parametrize(
    "call", [ls.check, lambda scene: ls.system(scene, 10.0), lambda scene: ls.study(scene, "a.nc")]
)
def test_eager_functions_refuse_a_bad_lazy_design_at_once(call, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert refused(call, spoiled(-0.1)).startswith("coupler.length = -0.1 m at design[4]: must be greater than 0")
    assert not os.listdir()


def test_requests_and_shapes_are_refused_at_once():
    assert refused(ls.peaks, lazy(many()), ["F33"]).startswith("of: nothing is named 'F33'")
    assert refused(ls.sweep, lazy(many()), theta2=0).startswith("theta2 = 0: ")
    integers = xr.DataArray(dask.array.ones(3, dtype=bool), dims="speed")
    assert refused(replace, PRESS, omega2=integers).startswith("omega2 holds bool values: ")


def test_dask_is_not_needed():
    code = "import sys; sys.modules['dask'] = None; import linksweep as ls; ls.peaks(ls.example('press'), theta2=5)"
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True)


# ------------------------------------------------------------------------------------------------------- studies


def test_a_study_of_a_lazy_scene_equals_the_eager_one(tmp_path):
    ls.study(grid(), tmp_path / "eager.nc", of=["F32"], chunk=9, theta2=24)
    ls.study(lazy(grid()), tmp_path / "lazy.nc", of=["F32"], chunk=9, theta2=24)
    assert (tmp_path / "lazy.nc").read_bytes() == (tmp_path / "eager.nc").read_bytes()


def test_a_lazy_result_is_saved_block_by_block(tmp_path):
    ls.save(ls.sweep(lazy(grid()), theta2=12), tmp_path / "lazy.nc")
    with xr.open_dataset(tmp_path / "lazy.nc") as ds:
        assert_equal(ds.drop_encoding(), ls.sweep(grid(), theta2=12))
    assert ls.load_scene(tmp_path / "lazy.nc") == grid()


@pytest.fixture(scope="module")
def cluster():
    from distributed import Client, LocalCluster

    with (
        dask.config.set({"distributed.comm.timeouts.connect": "60s"}),
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=logging.CRITICAL) as both,
        Client(both) as client,
    ):
        yield client


@pytest.fixture
def client(cluster):
    """Return a client of a cluster of two processes, waiting until both run."""
    cluster.wait_for_workers(2, timeout=60)
    return cluster


def slowly() -> ls.Scene:
    """Return sixty designs with a slow load."""

    def torque(theta2):
        time.sleep(0.02)
        return 3.0 * np.cos(np.radians(theta2))

    return replace(many(), loads=[ls.Load("rocker", torque=torque)])


def without_a_cluster(patch) -> None:
    def none():
        raise ValueError("no clients found")

    patch.setattr("distributed.default_client", none)


def only_on_the_cluster(patch) -> None:
    """Forbid chunks in this process, except the one design that is tried first."""
    compute = Job.compute

    def tried(job, block):
        assert block == {dim: slice(0, 1) for dim in job.sizes}
        return compute(job, block)

    patch.setattr(Job, "compute", tried)


def after_each_chunk(patch, happens) -> None:
    keep = Partial.keep

    def keep_and(kept, number, ds):
        keep(kept, number, ds)
        happens(kept)

    patch.setattr(Partial, "keep", keep_and)


WORDS = {"of": ["F32", "T12"], "chunk": 6, "theta2": 48}


@pytest.mark.long
def test_a_study_survives_the_loss_of_a_worker(client, tmp_path, monkeypatch):
    with monkeypatch.context() as patch:
        without_a_cluster(patch)
        ls.study(slowly(), tmp_path / "whole.nc", **WORDS)
    pids, killed = client.run(os.getpid), []

    def kill(kept):
        busy = [worker for worker, chunks in client.processing().items() if chunks]
        if len(kept.kept) >= 2 and busy and not killed:
            killed.append(pids[busy[0]])
            os.kill(pids[busy[0]], signal.SIGKILL)

    only_on_the_cluster(monkeypatch)
    after_each_chunk(monkeypatch, kill)
    ls.study(slowly(), tmp_path / "study.nc", **WORDS)
    assert len(killed) == 1
    assert killed[0] not in client.run(os.getpid).values()
    assert (tmp_path / "study.nc").read_bytes() == (tmp_path / "whole.nc").read_bytes()


def test_a_study_begun_locally_continues_on_the_cluster(client, tmp_path, monkeypatch):
    with monkeypatch.context() as patch:
        without_a_cluster(patch)
        path, whole = stopped_study(tmp_path, patch)
    sent, ahead, submit = [], [], client.submit
    monkeypatch.setattr(client, "submit", lambda *a, **k: sent.append(a) or submit(*a, **k))
    only_on_the_cluster(monkeypatch)
    after_each_chunk(monkeypatch, lambda kept: ahead.append(len(sent) - len(kept.kept) + 3))
    ls.study(many(), path, of=["F32"], chunk=6, client=client)
    assert path.read_bytes() == whole
    assert len(sent) == 7  # three of ten chunks existed
    assert ahead[0] == 4  # two for each of two workers
    assert all(len(part.omega2) == 6 for _, part, *_ in sent)  # each with its own designs only


def test_a_stopped_study_cancels_its_chunks(client, tmp_path, monkeypatch):
    def stop(kept):
        if len(kept.kept) == 2:
            raise KeyboardInterrupt

    sent, submit = [], client.submit
    monkeypatch.setattr(client, "submit", lambda *a, **k: sent.append(submit(*a, **k)) or sent[-1])
    after_each_chunk(monkeypatch, stop)
    with pytest.raises(KeyboardInterrupt, match=r"^stopped; 2 of 10 chunks are done"):
        ls.study(slowly(), tmp_path / "study.nc", **WORDS)
    assert [future.status for future in sent].count("cancelled") == 4


def test_workers_of_another_version_are_refused(client, tmp_path, monkeypatch):
    monkeypatch.setattr(cluster_module, "version", lambda name: "9.9")
    message = refused(ls.study, many(), tmp_path / "study.nc", of=["F32"], chunk=30, theta2=6)
    assert (
        message
        == f"a worker has linksweep {ls.peaks(PRESS).linksweep_version}, and this is 9.9: install the same on all"
    )


def test_a_screening_on_the_cluster_equals_that_of_one_process(client, monkeypatch):
    request = {"n": 500, "minimize": ["F32_peak", "T12_peak"], "keep": 3, "chunk": 64, "theta2": 12}
    lengths = {"coupler.length": (0.2, 0.24), "rocker.length": ls.Normal(0.18, 1e-3)}
    with monkeypatch.context() as patch:
        without_a_cluster(patch)
        alone = ls.screen(PRESS, lengths, **request)
    monkeypatch.setattr(Screening, "tally", None)  # in this process
    assert ls.screen(PRESS, lengths, client=client, **request).identical(alone)


def test_lazy_results_are_computed_on_the_cluster(client):
    outcome = client.compute(ls.sweep(lazy(many(), 30), theta2=12, of=["T12"])).result()
    assert_equal(outcome, ls.sweep(many(), theta2=12, of=["T12"]))


@pytest.mark.parametrize("client", [5, "tcp://127.0.0.1:8786"])
def test_an_object_that_is_not_a_client_is_refused(client, tmp_path):
    message = refused(ls.study, many(), tmp_path / "study.nc", client=client)
    assert message.startswith(f"client = {client!r}: must be a client of dask.distributed; ")
