"""The command line speaks its users' language: help by task, lists of names, completion, and advice for a shell."""

import argparse
import ast
import re
import subprocess
import sys
import warnings
from functools import cache
from pathlib import Path

import pytest
from refusals import python_words

import linksweep as ls
from linksweep.cli.main import main
from linksweep.cli.parser import Program
from linksweep.cli.shell_words import PHRASES, in_shell_words

PACKAGE = Path(ls.__file__).parent
PROGRAM = Program()
COMMANDS = PROGRAM.commands.by_name
ARGUMENTS = {
    "study": ["-o", "s.nc"],
    "sweep": ["-o", "c.nc", "--plot", "c.png"],
    "report": ["-o", "page.html"],
    "animate": ["-o", "film.gif"],
    "choose-bearings": ["--life", "10000 h"],
    "strength": ["--material", "S355"],
    "breakdown": ["F32"],
    "balance": ["--radius", "6 cm"],
    "steady": ["--motor", "dc", "stall_torque=6", "no_load_speed=160"],
    "run-up": ["--motor", "dc", "stall_torque=6", "no_load_speed=160"],
    "draw": ["-o", "press.svg"],
    "tolerance": ["--of", "F32_peak", "--tol", "ground", "js9"],
}
"""Arguments that commands need after the scene."""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """Enter a working folder with a scene of several designs."""
    monkeypatch.chdir(tmp_path)
    text = PACKAGE.joinpath("scene", "examples", "press.toml").read_text("utf-8")
    several = 'omega2 = {dim = "speed", values = [10, 20]}'
    Path("batch.toml").write_text(re.sub(r"^omega2 = .*$", several, text, flags=re.MULTILINE), "utf-8")
    return tmp_path


# ------------------------------------------------------------------------------------------------ help


def test_the_help_lists_each_command_once_under_its_task_and_an_example_to_begin_with(capsys):
    assert main([]) == 0
    text = capsys.readouterr().out
    tasks = re.findall(r"^(\w[\w ,]+):\n((?:  .*\n)+)", text, re.MULTILINE)
    assert [task for task, _ in tasks] == [*PROGRAM.commands.by_task]
    listed = [name for _, lines in tasks for name in re.findall(r"^  ([a-z-]+)(?:  |$)", lines, re.MULTILINE)]
    assert sorted(listed) == sorted(COMMANDS)
    (example,) = re.findall(r"Begin with: +linksweep (.*)\n", text)
    assert PROGRAM.parse_args(example.split()).scene == "press"


@pytest.mark.parametrize("arguments", [[], ["--help"], ["--version"], ["peaks", "-h"], ["study", "--help"]])
def test_help_imports_nothing_slow(arguments):
    code = (
        "import sys; from linksweep.cli.program import run\ntry: run()\nfinally: print(*sys.modules, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True)
    assert done.stdout
    assert {"numpy", "xarray", "scipy", "matplotlib", "numba", "llvmlite", "pint"}.isdisjoint(done.stderr.split())


@pytest.mark.parametrize("name", COMMANDS)
def test_each_command_has_a_help_of_its_own(name, capsys):
    with pytest.raises(SystemExit) as stopped:
        main([name, "--help"])
    text = " ".join(capsys.readouterr().out.split())
    (line,) = [lines[name] for lines in PROGRAM.commands.by_task.values() if name in lines]
    assert stopped.value.code == 0 and text.startswith(f"usage: linksweep {name}") and line in text


def test_slips_in_what_was_typed_are_answered(capsys):
    for arguments, advice in {
        ("chek", "press"): 'did you mean "check"?',
        ("peaks", "--of", "F32", "press"): "required: scene; it stands before options that take several names",
    }.items():
        with pytest.raises(SystemExit):
            main([*arguments])
        assert advice in capsys.readouterr().err


# ------------------------------------------------------------------------------------------------ lists of names

LISTS = [
    (name, option)
    for name, parser in COMMANDS.items()
    for option in ("--of", "--to")
    if option in parser._option_string_actions
]


@pytest.mark.parametrize(("name", "option"), LISTS)
def test_names_are_listed_with_spaces_or_commas(name, option):
    forms = (["F32", "T12"], ["F32,T12"], ["F32,", "T12"], ["F32, T12"])
    read = [vars(PROGRAM.parse_args([name, "press", *ARGUMENTS.get(name, []), option, *form])) for form in forms]
    assert [each[option[2:]] for each in read] == [["F32", "T12"]] * len(forms)


def test_arguments_are_listed_likewise():
    read = [PROGRAM.parse_args(["orders", "press", *form]).of for form in ([], ["Fsx,T12"], ["Fsx", "T12"])]
    assert read == [["Fsx", "Fsy"], ["Fsx", "T12"], ["Fsx", "T12"]]


def test_lists_are_found():
    assert {name for name, _ in LISTS} >= {"peaks", "sweep", "study", "sensitivities", "tolerance"}


# ------------------------------------------------------------------------------------------------ completion


def test_bash_completes_commands_options_words_and_files(capsys):
    pytest.importorskip("shtab")
    assert main(["completion", "bash"]) == 0
    Path("script").write_text(capsys.readouterr().out, "utf-8")
    for typed, expected in {
        "linksweep sen": {"sensitivities"},
        "linksweep peaks --o": {"--of", "--output"},
        "linksweep strength batch.toml --material S3": {"S355"},
        "linksweep demo engi": {"engine"},
        "linksweep check ba": {"batch.toml"},
    }.items():
        words = typed.split()
        ask = f"COMP_WORDS=({typed}); COMP_CWORD={len(words) - 1}; _shtab_linksweep linksweep {words[-1]} {words[-2]}"
        shell = f'source ./script; {ask}; echo "${{COMPREPLY[@]}}"'
        done = subprocess.run(["bash", "-c", shell], capture_output=True, text=True)
        assert {*done.stdout.split()} >= expected, done.stderr


@pytest.mark.parametrize(("shell", "begins"), [("zsh", "#compdef linksweep"), ("fish", "# AUTOMATICALLY")])
def test_other_shells_have_scripts_with_every_command(shell, begins, capsys):
    pytest.importorskip("shtab")
    assert main(["completion", shell]) == 0
    text = capsys.readouterr().out
    assert text.startswith(begins) and all(re.search(rf"\b{name}\b", text) for name in COMMANDS)


def test_without_shtab_the_message_states_how_to_install_it(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert main(["completion", "bash"]) == 2
    assert 'pip install "linksweep[completion]"' in capsys.readouterr().err


# ------------------------------------------------------------------------------------------------ advice

NO_COMMAND = """
    analysis/balance/best_counterweights.py analysis/balance/shaking.py analysis/design/objective.py
    analysis/design/searches.py analysis/drive/flywheel.py analysis/pins/bearing.py results/cylinders/multi_cylinder.py
    analysis/pins/pin_friction.py analysis/strength/strength.py files/pmks/from_pmks.py mechanisms/mechanism.py
    physics/closures/freudenstein.py results/compute.py scene/curves/over_angle.py scene/curves/over_position.py
    scene/derivatives/sloped.py scene/designs/combinations.py
    scene/designs/distributions.py scene/designs/drawing.py scene/designs/sampling.py
    studies/cluster.py studies/scene_at.py studies/screen_request.py tables/of_any.py reports/page.py
    reports/notebook.py results/check.py files/netcdf.py base/frozen.py
"""
"""Files with messages that no command can meet: of functions of theta2, of several cylinders, of Datasets, of calls
that have no command, and texts that are no messages."""
NEVER = ("cli", "engine", "explorer", "plot")
"""Rooms whose messages are about Datasets and pages, or are of the command line itself."""


@cache
def texts(path: Path) -> list[str]:
    """Return the texts in a file, but for docstrings, and with {} for what they are formatted with."""
    tree = ast.parse(path.read_text("utf-8"))
    nodes = [*ast.walk(tree)]
    parts = {
        id(part) for node in nodes if isinstance(node, ast.JoinedStr) for part in ast.walk(node) if part is not node
    }
    parts |= {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    pieces = {id(node): node.values for node in nodes if isinstance(node, ast.JoinedStr) and id(node) not in parts}
    pieces |= {id(node): [node] for node in nodes if isinstance(node, ast.Constant) and id(node) not in parts}
    return [
        "".join(str(getattr(piece, "value", "")) if isinstance(piece, ast.Constant) else "{}" for piece in each)
        for each in pieces.values()
    ]


def is_message(text: str) -> bool:
    return " " in text and not re.match(r"linksweep\.\w+\(", text)


def test_no_message_that_a_command_can_meet_speaks_python():
    parser, left = argparse.ArgumentParser(), {}
    for path in sorted(PACKAGE.rglob("*.py")):
        name = path.relative_to(PACKAGE)
        if name.parts[0] not in NEVER:
            advice = [in_shell_words(text, parser, COMMANDS) for text in texts(path) if is_message(text)]
            left[name.as_posix()] = [text for text in advice if python_words(text)]
    assert {name: wrong for name, wrong in left.items() if wrong and name not in NO_COMMAND.split()} == {}
    assert {name for name in NO_COMMAND.split() if not left.get(name)} == set()


def test_every_phrase_stands_in_a_message():
    known = "\n".join(text for path in PACKAGE.rglob("*.py") if "cli" not in path.parts for text in texts(path))
    assert [phrase for phrase in PHRASES if phrase.partition("{")[0].rstrip('"') not in known] == []
    assert [text for text in PHRASES.values() if python_words(text)] == []


@pytest.mark.parametrize(
    ("command", "message", "advice"),
    [
        ("peaks", "of: see ls.quantities(scene)", "--of: see linksweep quantities"),
        ("peaks", "theta2 = 0: must be 1 or more", "--theta2 0: must be 1 or more"),
        ("peaks", "ask for samples with theta2=360", "ask for samples with --theta2 360"),
        ("study", "chunk = 0: must be 1\nn = 2: small", "--chunk 0: must be 1\nn = 2: small"),
        ("check", 'links: of="slide", or branch={"C": "open"}', 'links: of = "slide", or branch = {C = "open"}'),
        ("breakdown", "of: nothing is named 'X'", "FORCE: nothing is named 'X'"),
        ("strength", "stress_concentration = 0.5: must be 1", "--concentration 0.5: must be 1"),
        ("check", "a.toml:3: drive = 'x'; see ls.check", "a.toml:3: drive = 'x'; see linksweep check"),
    ],
)
def test_messages_are_in_words_of_the_command(command, message, advice):
    assert in_shell_words(message, COMMANDS[command], COMMANDS) == advice


MANY = {"peaks", "study", "check", "quantities"}
"""Commands that take several designs."""


@pytest.mark.parametrize("name", [name for name in COMMANDS if name not in {"demo", "completion", *MANY}])
def test_every_command_of_one_design_advises_in_shell_words(name, capsys):
    for scene in ("batch.toml", "no.toml", "engin.nc"):
        assert main([name, scene, *ARGUMENTS.get(name, [])]) == 2
        out, err = capsys.readouterr()
        assert out == "" and python_words(err) == []
    assert main([name, "batch.toml", *ARGUMENTS.get(name, [])]) == 2
    assert "linksweep peaks and linksweep study take many" in capsys.readouterr().err


def test_a_warning_is_a_line_of_the_program(monkeypatch, capsys):
    def check(scene):
        warnings.warn("the spline overshoots: see ls.check(scene)", UserWarning, stacklevel=1)
        raise ValueError("stop")

    monkeypatch.setattr(ls, "check", check)
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        assert main(["check", "batch.toml"]) == 2
    first, second = capsys.readouterr().err.splitlines()
    assert first == "linksweep: warning: the spline overshoots: see linksweep check" and second == "linksweep: stop"
