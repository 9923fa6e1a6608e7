"""Rooms above the mechanisms ask a machine for its capabilities and name no machine.

Names are searched in the syntax tree, so that docstrings may use machines in examples.
"""

import ast
from pathlib import Path

import pytest

import linksweep as ls
from linksweep.mechanisms import MECHANISMS
from linksweep.mechanisms.capabilities import CAPABILITIES, lack, offers

PACKAGE = Path(ls.__file__).parent


@pytest.mark.parametrize(
    "room", ["scene", "files", "results", "analysis", "studies", "tables", "plot", "reports", "cli"]
)
def test_no_machine_is_named(room):
    reader = PACKAGE / "files" / "pmks"  # of documents that are linkages, whatever is in them
    for path in sorted({*(PACKAGE / room).rglob("*.py")} - {*reader.glob("*.py")}):
        nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
        names = {node.id for node in nodes if isinstance(node, ast.Name)}
        names |= {alias.name for node in nodes if isinstance(node, ast.ImportFrom) for alias in node.names}
        texts = {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
        assert not names & MECHANISMS.keys(), path
        assert not texts & MECHANISMS.keys(), path


OFFERED = {
    "FourBar": {"bodies", "pins", "drives", "position_equation", "drawing", "stroke_findings", "balancing_moments"},
    "SliderCrank": {"bodies", "pins", "drives", "engine_cylinder", "drawing", "stroke_findings", "balancing_moments"},
    "InvertedSliderCrank": {"bodies", "pins", "drives", "drawing", "stroke_findings", "balancing_moments"},
    "LoopTrack": {"track"},
}


@pytest.mark.parametrize("kind", OFFERED)
def test_each_machine_offers_its_capabilities(kind):
    assert {name for name in CAPABILITIES if offers(MECHANISMS[kind], name)} == OFFERED[kind]


def test_lack_names_machine_capability_and_alternatives():
    loop, press = (ls.example(name).mechanism for name in ("loop", "press"))
    others = "FourBar, InvertedSliderCrank, Linkage, SliderCrank"
    assert lack(loop, "pins") == f"a LoopTrack, which has no pins: give another machine ({others})"
    assert lack(press, "pins") == ""
