"""Advice in words of the shell: messages of the library name Python's calls, the command line's commands and options.

Messages are written once, in the library, for Python. Here phrases that a shell has no use for are replaced, then calls
become commands (``ls.check(scene)``: ``linksweep check``), and parameters become options (``theta2=360``: ``--theta2
360``) or, as no option, keys of a scene file (``branch="both"``: ``branch = "both"``).
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Collection

PHRASES = {
    'ls.open_study("study.nc").linksweep.to_csv("study.csv") writes a finished one as a table': (
        "--table study.csv writes it as a table too"
    ),
    "; of the example write ls.example(": "; there is an example (",
    "; take ls.peaks of its position, or": ";",
    "; or sweep at more angles": "",
    "; take ls.best_counterweights, or": ";",
    " (plot.loop draws a track)": "",
    'ls.Tolerance(lower, upper), ls.Normal(deviation=...) or a class of ISO 286, as "h9"': (
        "two limits, or a class of ISO 286, as h9"
    ),
    'give pins={"{}": ls.Bearing(capacity=...)}': "give --capacity",
    "give it ls.Tolerance(lower, upper)": "give it two limits",
    "ls.Bar(...), or as ls.Link(..., section=ls.Section(...))": 'type = "Bar", or with section = {...}',
    "declare it in guides, by an ls.Guide": "declare it in guides, as guides.slide = { through = [x, y] }",
    "use sample or a DataArray": "write values = [...] of several parameters",
    "a DataArray, with interpolation": "a CSV table, with interpolation",
    ", or an xarray.DataArray of them": ", or { dim = ..., values = [...] }",
    "each a number, a DataArray or a function of theta2": "each a number, or { dim = ..., values = [...] }",
    'name its dimensions, as in xarray.DataArray(values, dims="design")': (
        'name its dimension, as in { dim = "design", values = [...] }'
    ),
    'name its dimension: over the crank angle xarray.DataArray(values, {"theta2": degrees}, "theta2")': (
        "over the crank angle give it a CSV table"
    ),
    'give it one of another name, as in xarray.DataArray([...], dims="k")': 'give it one of another name, as dim = "k"',
    'one value for each design xarray.DataArray(values, dims="design")': (
        'for several designs write { dim = "design", values = [...] }'
    ),
    "force=(Fx, Fy), torque=..., or both": "force = [Fx, Fy], torque = ..., or both",
    'give it its angles with coords={"theta2": degrees}': "give it its angles in a CSV table",
    "only Datasets made by linksweep": "only results made by linksweep",
    " of the Dataset: see its status": ": see its status",
    "ds has no finite {} with a derivative: its {} says why": "nothing to draw: the result has no derivatives",
    "ds has no speed: ": "nothing to draw: ",
    "ls.peaks of several designs": "linksweep peaks of several designs",
}
"""Phrases of messages that a command can meet, {} for any text in them, and what to say in a shell."""

CALL = re.compile(r"\b(?:ls|linksweep)\.([a-z]\w*)(?:\([^()]*\))?")
VALUE = re.compile(r"""\b([a-z]\w*)=("[^"]*"|'[^']*'|\{[^}]*\}|[\w.+-]*\w)""")
KEY = re.compile(r"""["'](\w+)["']: """)
HEAD = re.compile(r"^([A-Za-z_]\w*)( = |(?=: |\[))", re.MULTILINE)


def in_shell_words(message: str, command: argparse.ArgumentParser, commands: Collection[str]) -> str:
    """Return a message of the library in the words of one command, among the program's commands."""
    options = _options(command)

    def called(call: re.Match[str]) -> str:
        name = call[1].replace("_", "-")
        return f"linksweep {name}" if name in commands else call[0]

    def paired(pair: re.Match[str]) -> str:
        name, value = pair.groups()
        if name in options:
            return f"{options[name]} {value}"
        return name + " = " + KEY.sub(r"\1 = ", value) if value[0] in "\"'{" else pair[0]

    def named(head: re.Match[str]) -> str:
        name, equals = head.groups()
        return head[0] if name not in options else options[name] + (" " if equals else "")

    for phrase, instead in PHRASES.items():
        message = re.sub(re.escape(phrase).replace(r"\{\}", ".*?"), instead, message)
    return HEAD.sub(named, VALUE.sub(paired, CALL.sub(called, message)))


def _options(command: argparse.ArgumentParser) -> dict[str, str]:
    """Return the options of a command by the names that the library has for them; an argument's is the usage's word."""
    words: dict[str, str] = {}
    for action in command._actions:
        words[action.dest] = action.option_strings[-1] if action.option_strings else str(action.metavar or action.dest)
        words |= {each.lstrip("-").replace("-", "_"): each for each in action.option_strings}
    return words
