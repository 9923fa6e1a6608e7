"""Run the command line as ``python -m linksweep``."""

import sys

from linksweep.cli.program import run

sys.exit(run())
