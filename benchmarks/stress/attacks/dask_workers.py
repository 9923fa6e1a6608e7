"""Kill workers of a cluster while they compute a study: it ends as an equal file, with nothing left behind."""

from __future__ import annotations

import contextlib
import logging
import os
import signal
import tempfile
import threading
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import linksweep as ls
from benchmarks.stress.attacks import Outcome

TITLE = "workers of a cluster killed during a study: byte-equal in the end, nothing left behind"
ROUNDS, SMALL = 60, 0

CHUNK, DESIGNS = 4, 40
KILLS = 2
"""Most kills in one study: the scheduler gives up a chunk on which three workers died."""
PAUSE = 0.02
"""Seconds added to each chunk, so that workers are killed while computing."""


def attack(random: np.random.Generator, rounds: int) -> Outcome:
    import dask
    from distributed import Client, LocalCluster

    failures, kills, workers = [], 0, min(2, rounds)
    quiet = {"dashboard_address": ":0", "silence_logs": logging.CRITICAL}
    with (
        tempfile.TemporaryDirectory() as folder,
        dask.config.set({"distributed.comm.timeouts.connect": "60s"}),
        LocalCluster(n_workers=workers, threads_per_worker=1, **quiet) as cluster,
        Client(cluster) as client,
    ):
        _study(Path(folder, "whole.nc"), None)
        reference = Path(folder, "whole.nc").read_bytes()
        while kills < rounds:
            client.wait_for_workers(workers, timeout=120)
            path = Path(folder, f"study{kills}.nc")
            times = random.uniform(0.0, 1.0, min(KILLS, rounds - kills))
            killer = threading.Thread(target=_kill, args=(cluster, times, random.integers(workers, size=len(times))))
            killer.start()
            _study(path, client)
            killer.join()
            failures += ["a study ends as another file"] * (path.read_bytes() != reference)
            failures += [f"{path.name}.partial is left behind"] * Path(f"{path}.partial").exists()
            kills += len(times)
    return Outcome(kills, failures)


def _kill(cluster: Any, pauses: np.ndarray, places: np.ndarray) -> None:
    """Kill a worker after each pause, of those that the scheduler knows; its nanny starts another."""
    for pause, place in zip(pauses, places, strict=True):
        time.sleep(float(pause))
        running = [worker.pid for worker in [*cluster.scheduler.workers.values()] if worker.pid]
        if running:
            with contextlib.suppress(ProcessLookupError):
                os.kill(running[place % len(running)], signal.SIGKILL)


def _study(path: Path, client: Any) -> None:
    speed = xr.DataArray(np.linspace(10.0, 40.0, DESIGNS), dims="speed")
    scene = replace(ls.example("press"), omega2=speed, loads=[ls.Load("rocker", torque=_slow_torque)])
    ls.study(scene, path, of=["T12"], chunk=CHUNK, theta2=36, client=client).close()


def _slow_torque(theta2: np.ndarray) -> np.ndarray:
    time.sleep(PAUSE)
    return 3.0 * np.cos(np.radians(theta2))
