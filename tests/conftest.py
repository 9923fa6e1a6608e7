"""Shared by all tests: figures are drawn without a window, and a run says where it left out long tests."""

import os

os.environ["MPLBACKEND"] = "Agg"


def pytest_terminal_summary(terminalreporter, config):
    if config.option.markexpr == "not long":
        terminalreporter.write_line("Tests marked long were left out; -m '' runs all.")
