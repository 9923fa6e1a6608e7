"""Ways into the explorer: a notebook's component, the command, and what is said without Panel."""

import importlib
import subprocess
import sys
from importlib.resources import files

import pytest

import linksweep as ls
from linksweep.cli.main import main

explore_module = importlib.import_module("linksweep.explorer.explore")


def test_the_component_has_the_scene_and_replies_with_messages(monkeypatch):
    component = ls.explore(ls.sweep(ls.example("press"), 12), title="Mine")
    sent = []
    monkeypatch.setattr(component, "_send_msg", sent.append)
    component._handle_msg({"ask": "start"})
    component._handle_msg({"ask": "set", "numbers": {"crank.length": 0.09}})
    assert [reply["ask"] for reply in sent] == ["start", "set"] and sent[0]["title"] == "Mine"
    assert component.scene.mechanism.crank.length == 0.09


def test_two_components_do_not_share_their_scene():
    one, other = (ls.explore(ls.example("press")) for _ in range(2))
    one._handle_msg({"ask": "set", "numbers": {"crank.length": 0.09}})
    assert other.scene == ls.example("press")


def test_without_panel_a_sentence_says_what_to_install(monkeypatch, capsys):
    monkeypatch.setattr(explore_module, "find_spec", lambda name: None)
    with pytest.raises(ImportError, match=r'pip install "linksweep\[explorer\]"'):
        ls.explore(ls.example("press"))
    assert main(["explore", "press"]) == 2
    assert 'pip install "linksweep[explorer]"' in capsys.readouterr().err


def test_a_machine_without_a_drawing_is_refused():
    with pytest.raises(ValueError, match="draw"):
        ls.explore(ls.example("loop"))


def test_the_command_serves_on_this_machine_alone(monkeypatch, tmp_path):
    panel = pytest.importorskip("panel")
    calls = []
    monkeypatch.setattr(panel, "serve", lambda page, **options: calls.append((page(), options)))
    ls.save(ls.example("press"), tmp_path / "mine.toml")
    assert main(["explore", str(tmp_path / "mine.toml"), "--no-browser", "--port", "0"]) == 0
    ((page, options),) = calls
    assert options == {"address": "127.0.0.1", "port": 0, "show": False, "title": "mine"}
    assert page.fills and page.scene == ls.example("press")


def test_panel_is_imported_when_it_is_needed_alone():
    code = "import linksweep.cli.main, linksweep.explorer.model.session, sys; print('panel' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_the_page_needs_no_other_place():
    """No address of another host stands in the page's files, so that it works without a network."""
    for file in files("linksweep.explorer").joinpath("page").iterdir():
        assert "://" not in file.read_text("utf-8").replace("http://www.w3.org/2000/svg", ""), file.name
