"""Shared by all tests: figures are drawn without a window, and a run says where it left out long tests."""

import os
import sys

os.environ["MPLBACKEND"] = "Agg"


class CloseFigures:
    """Close the figures that a file of tests, or an example of a docstring, leaves open."""

    @staticmethod
    def pytest_runtest_teardown(item, nextitem):
        last = hasattr(item, "dtest") or nextitem is None or nextitem.path != item.path
        if last and "matplotlib.pyplot" in sys.modules:
            sys.modules["matplotlib.pyplot"].close("all")


def pytest_configure(config):
    config.pluginmanager.register(CloseFigures())  # hooks of this file alone would see no docstrings


def pytest_terminal_summary(terminalreporter, config):
    if config.option.markexpr == "not long and not nightly":
        terminalreporter.write_line("Tests marked long or nightly were left out; -m '' runs all.")
