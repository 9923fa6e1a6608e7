"""State the facts that figures depend on: the machine, the versions, and the commit that was run."""

from __future__ import annotations

import os
import platform
import re
import subprocess
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path

from benchmarks.rivals import limit
from linksweep.engine.kernel import vectors

Facts = dict[str, str]
VECTORS = {16: "AVX-512", 8: "AVX2", 4: "of two numbers"}
"""Names of vectors, by the number of samples that linksweep takes side by side."""
WIDEST = VECTORS[max(VECTORS)]
TRADE = re.compile(r"\((R|TM)\)|\b(Processor|CPU|\d+-Core)\b|@[^,]*", re.IGNORECASE)
"""Parts of a processor's name to leave out: trade marks, the words that many share, the clock."""
FACT = re.compile(r"^([^:\n]+?)[ \t]*: (.+)$", re.MULTILINE)
"""A line of /proc/cpuinfo: name and value."""
NUMBERS = {"family": "cpu family", "model": "model"}
"""Numbers that tell processors of one name apart, and the names of their lines."""


def machine() -> Facts:
    """Return the facts of this run; no names of hosts, no paths."""
    return {
        "processor": _processor(),
        "vectors": VECTORS[vectors.width()],
        "cores": str(os.cpu_count()),
        "system": f"{platform.system()} {platform.machine()}",
        "Python": platform.python_version(),
        **{name: version(name) for name in ("linksweep", "numpy", "numba", "xarray")},
        "C compiler": _compiler(),
        "commit": _commit(),
        "date": f"{datetime.now(UTC):%Y-%m-%d}",
    }


def short_name(facts: Facts) -> str:
    """Return the processor's name without trade marks, and its vectors, if they are not the widest: processors of one
    name may differ in these."""
    name = " ".join(TRADE.sub(" ", facts["processor"]).split()).replace(" ,", ",") or "unknown"
    return name if facts.get("vectors", WIDEST) == WIDEST else f"{name}, {facts['vectors']}"


def _processor() -> str:
    """Return the processor's name, with its family and model: virtual machines name several processors alike."""
    try:
        facts = dict(FACT.findall(Path("/proc/cpuinfo").read_text()))
    except OSError:
        facts = {}
    name = facts.get("model name") or platform.processor() or platform.machine()
    return ", ".join([name, *(f"{number} {facts[key]}" for number, key in NUMBERS.items() if key in facts)])


def _compiler() -> str:
    cc = limit.compiler()
    if cc is None:
        return "none"
    return (_output(cc, "--version") or Path(cc).name).splitlines()[0]


def _commit() -> str:
    """Return the commit of this checkout, and whether its code was changed since."""
    commit = _output("git", "rev-parse", "--short", "HEAD")
    changed = commit and _output("git", "status", "--porcelain", "--", "*.py", "*.c")
    return f"{commit}, changed" if changed else commit or "unknown"


def _output(*command: str) -> str:
    """Return what a command prints; nothing where it fails or does not exist."""
    try:
        run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=Path(__file__).parent)
    except OSError:
        return ""
    return run.stdout.strip() if run.returncode == 0 else ""
