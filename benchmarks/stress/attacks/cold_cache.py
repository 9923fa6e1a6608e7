"""Start six processes with an empty cache that all compile kernels: equal results, nothing left half written."""

from __future__ import annotations

import os
import subprocess
import sys
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.stress.attacks import Outcome

TITLE = "processes, six at a time, on a cold kernel cache: equal results, no temporary file left"
ROUNDS, SMALL = 60, 2

AT_ONCE = 6
PROGRAM = """
import sys
import numpy as np
from linksweep.engine.kernel.compile import compiled
x = np.array([2.0])
compiled("from math import sqrt\\n\\n\\ndef kernel(x):\\n    x[0] = sqrt(x[0])\\n", kinds=("f8*",))(x)
sys.stdout.buffer.write(x.tobytes())
"""


def attack(random: np.random.Generator, rounds: int) -> Outcome:
    processes = iter(range(rounds))
    failures = []
    while batch := len(list(islice(processes, AT_ONCE))):
        with TemporaryDirectory() as folder:
            failures += _problems(Path(folder), batch)
    return Outcome(rounds, failures)


def _problems(folder: Path, processes: int) -> list[str]:
    environment = os.environ | {"LINKSWEEP_CACHE_DIR": str(folder)}
    command = [sys.executable, "-W", "error", "-c", PROGRAM]
    started = [
        subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        for _ in range(processes)
    ]
    outputs, errors = zip(*(process.communicate(timeout=600) for process in started), strict=True)
    problems = [error.decode()[-200:] for error in errors if error]
    problems += ["processes differ"] * (len(set(outputs)) > 1)
    return problems + [f"{path.name} is left behind" for path in folder.glob("*.tmp")]
