"""The command `completion`: a script with which a shell completes commands, options and names of files.

shtab (an optional dependency) writes it from the parser, so that nothing is started while one types.
"""

from __future__ import annotations

import argparse

from linksweep.cli.options import Commands

SHELLS = ("bash", "zsh", "fish")
FILES = ("scene", "output", "plot", "table")
"""Arguments and options that are names of files."""
MISSING = 'completion needs shtab, which is not installed: pip install "linksweep[completion]"'


def add_completion(commands: Commands) -> None:
    """Add the command to those of the command line."""
    text = "a script that completes words of this program in your shell"
    parser = commands.add("completion", _completion, text, task="Shell", scene=False)
    parser.add_argument("shell", choices=SHELLS, help="as in: source <(linksweep completion bash)")


def _completion(options: argparse.Namespace) -> None:
    try:
        import shtab
    except ImportError:
        raise ImportError(MISSING) from None
    from linksweep.cli.parser import Program  # which adds this command

    program = Program()
    for parser in program.commands.by_name.values():
        for action in parser._actions:
            if action.dest in FILES and not action.choices:
                action.complete = shtab.FILE  # type: ignore[attr-defined]  # the sign that shtab looks for
    print(shtab.complete(program, options.shell))
