"""Mutants (planted errors) of benchmarks/stress apply to the sources, and their runner reports survivors."""

import ast
from pathlib import Path

import pytest

from benchmarks.stress.mutants import ROOT, Copy, Mutant, copied, main, mutants

MUTANTS = mutants()
CAUGHT = Mutant(
    what="a disk is twice as heavy to turn",
    file="mechanisms/links.py",
    old="return 0.5 * self.mass * self.radius * self.radius",
    new="return self.mass * self.radius * self.radius",
    tests=("mechanisms/test_links.py",),
)
HARMLESS = Mutant(
    what="the same in other words",
    file="mechanisms/links.py",
    old="return 0.5 * self.mass * self.radius * self.radius",
    new="return 0.5 * (self.mass * self.radius * self.radius)",
    tests=("mechanisms/test_links.py",),
)


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.what)
def test_every_mutant_still_applies_to_the_sources(mutant):
    sound = (ROOT / "linksweep" / mutant.file).read_text(encoding="utf-8")
    planted = mutant.planted(sound)
    assert ast.dump(ast.parse(planted)) != ast.dump(ast.parse(sound))
    assert mutant.tests and all((Path(__file__).parents[1] / name).is_file() for name in mutant.tests)


def test_the_list_covers_the_documents_and_every_mechanism():
    text = [mutant.what for mutant in MUTANTS]
    assert len(text) == len(set(text)) >= 20
    for start in ("document 1", "document 2", "document 3", "four-bar", "slider-crank", "inverted", "rocket car"):
        assert sum(what.startswith(start) for what in text) >= 2, start


def test_a_mutant_must_match_the_source_exactly_once():
    with pytest.raises(ValueError, match=r'"a disk is .*": what it changes stands 0 times in linksweep/.*, not once'):
        CAUGHT.planted("return 0.5")
    with pytest.raises(ValueError, match="stands 2 times"):
        CAUGHT.planted(CAUGHT.old + "\n" + CAUGHT.old)


@pytest.mark.long
def test_the_runner_reports_which_test_catches_a_mutant():
    with copied() as copy:
        source = copy.folder / "linksweep" / CAUGHT.file
        before = source.read_text(encoding="utf-8")
        assert copy.catcher(CAUGHT) == "tests/mechanisms/test_links.py::test_a_disk_is_what_its_parts_add_up_to"
        assert copy.catcher(HARMLESS) is None
        assert source.read_text(encoding="utf-8") == before
        (copy.folder / "tests" / "mechanisms/test_links.py").write_text("def test_red():\n    assert False\n")
        assert copy.failures(CAUGHT.tests) == ["tests/mechanisms/test_links.py::test_red"]
        assert Copy(copy.folder, ("tests/mechanisms/test_links.py::test_red",)).catcher(CAUGHT) is None


def test_the_exit_code_is_1_where_a_mutant_survives(monkeypatch, capsys):
    monkeypatch.setattr(Copy, "failures", lambda self, tests, *options, **limits: [])
    monkeypatch.setattr(Copy, "catcher", lambda self, mutant: "a test" if mutant is CAUGHT else None)
    for listed, code, text in (([CAUGHT], 0, "caught    a disk is"), ([CAUGHT, HARMLESS], 1, "SURVIVED  the same")):
        monkeypatch.setattr("benchmarks.stress.mutants.mutants", lambda listed=listed: listed)
        assert main([]) == code
        assert text in capsys.readouterr().out


def test_tests_that_fail_without_a_mutant_are_named(monkeypatch, capsys):
    red = "tests/mechanisms/test_links.py::test_red"
    monkeypatch.setattr(Copy, "failures", lambda self, tests, *options, **limits: [red])
    assert main(["--only", "a disk's"]) == 1
    text = capsys.readouterr().out.splitlines()
    assert text[0] == "fails without a mutant: tests/mechanisms/test_links.py::test_red"
    assert text[-1] == "1 of 1 mutants caught"
