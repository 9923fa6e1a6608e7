"""The command line: parse what was typed, run its command, and state what was at fault in words of the shell."""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import sys
import warnings
from collections.abc import Collection, Sequence

import linksweep as ls
from linksweep.cli.parser import Program
from linksweep.cli.shell_words import in_shell_words

CLOSED_PIPE = 141
"""Exit status, as a shell tells it, of a program that ended because nobody reads its output."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; 0 when all went well, 2 with a message when the input or a file was at fault."""
    _print_anything()
    try:
        program = Program()
        code = _run(program.parse_args(arguments), program.commands.by_name)
        if sys.stdout:  # None where it was closed before the start
            sys.stdout.flush()
    except BrokenPipeError:  # who reads the output has had enough of it
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return CLOSED_PIPE
    return code


def _run(options: argparse.Namespace, commands: Collection[str]) -> int:
    def say(message: object) -> None:
        print(f"linksweep: {in_shell_words(str(message), options.parser, commands)}", file=sys.stderr)

    try:
        units = getattr(options, "units", None)
        with warnings.catch_warnings(), ls.units(units) if units else contextlib.nullcontext():
            warnings.showwarning = lambda message, *where: say(f"warning: {message}")
            _require_targets(options)
            options.run(options)
    except BrokenPipeError:
        raise
    except (ValueError, OSError, ImportError) as error:
        say(error)
        return 2
    except MemoryError:
        say("the memory is full: ask for fewer angles, designs or quantities")
        return 2
    except KeyboardInterrupt as stopped:
        say(str(stopped) or "stopped")
        return 130
    return 0


def _require_targets(options: argparse.Namespace) -> None:
    """Raise OSError where a file cannot be written, before anything is computed."""
    paths = [path for name in ("output", "plot") if (path := getattr(options, name, None))]
    if paths:
        from linksweep.files.atomic import target_of

        for path in paths:
            target_of(path)


def _print_anything() -> None:
    """Print a question mark for characters that the terminal's encoding lacks, such as ° in ASCII."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
