"""Run the command line as ``python -m linksweep``."""

from linksweep.cli.program import start

start()
