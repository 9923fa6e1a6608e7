"""The parser of the command line, whose help lists the commands by task."""

from __future__ import annotations

import argparse
import difflib
import re
from typing import NoReturn

from linksweep.base.version import installed_version
from linksweep.cli.commands import add_commands
from linksweep.cli.completion import add_completion
from linksweep.cli.designs import add_design_commands
from linksweep.cli.motors import add_motor_commands
from linksweep.cli.options import Commands
from linksweep.cli.pages import add_page_commands
from linksweep.cli.results import add_result_commands

BEGIN = """\
Begin with:   linksweep demo
Your machine: linksweep peaks scene.toml
"""
END = (
    "SCENE is a scene file (.toml), a result (.nc) that holds its scene, or the name of an example. "
    "linksweep COMMAND -h lists the options of a command."
)


class Program(argparse.ArgumentParser):
    """The parser of the whole command line."""

    def __init__(self) -> None:
        super().__init__(prog="linksweep", description="How hard are my pins loaded, and where is the worst of it?")
        self.add_argument("--version", action="version", version=f"linksweep {installed_version()}")
        self.set_defaults(run=lambda options: self.print_help(), parser=self)
        self.commands = Commands(self)
        tasks = add_result_commands, add_commands, add_motor_commands, add_design_commands, add_page_commands
        for add in (*tasks, add_completion):
            add(self.commands)

    def format_help(self) -> str:
        """Return the help: how to begin, and the commands by task, each in a line."""
        formatter = self.formatter_class(prog=self.prog)
        formatter.add_usage("linksweep COMMAND SCENE [options]", [], [])
        formatter.add_text(self.description)
        for task, commands in self.commands.by_task.items():
            formatter.start_section(task)
            formatter.add_arguments([argparse.Action([], name, help=text) for name, text in commands.items()])
            formatter.end_section()
        formatter.add_text(END)
        head, blank, rest = formatter.format_help().partition(f"{self.description}\n")
        return f"{head}{blank}\n{BEGIN}{rest}"

    def error(self, message: str) -> NoReturn:
        """Exit with a message; of a misspelt command with the one that was probably meant."""
        slip = re.search(r"invalid choice: '(.*?)'", message)
        near = difflib.get_close_matches(slip[1], self.commands.by_name, n=1) if slip else []
        super().error(message + "".join(f'; did you mean "{name}"?' for name in near))
