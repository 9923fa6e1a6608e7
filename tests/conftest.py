"""Shared by all tests: figures are drawn without a window, and a run says where it left out long tests."""

import os
import sys

os.environ["MPLBACKEND"] = "Agg"


class ExamplesClose:
    """Close the figures that an example of a docstring draws: it is there to be read, and closes none."""

    @staticmethod
    def pytest_runtest_teardown(item):
        if hasattr(item, "dtest") and "matplotlib.pyplot" in sys.modules:
            sys.modules["matplotlib.pyplot"].close("all")


def pytest_configure(config):
    config.pluginmanager.register(ExamplesClose())  # of this file alone, it would see the tests alone


def pytest_terminal_summary(terminalreporter, config):
    if config.option.markexpr == "not long":
        terminalreporter.write_line("Tests marked long were left out; -m '' runs all.")
