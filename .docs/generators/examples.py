"""The gallery: every example of the package with its picture, its file, and how to start it."""

from importlib.resources import files
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

import linksweep as ls
from generators.page import Page
from linksweep.scene import examples

MACHINES = Path("machines")
ANGLES = {"excavator": 12.0, "knuckle-press": 300.0, "drag-link-press": 220.0, "geared-five-bar": 200.0}
"""Crank angles [degree] of the pictures; others stand at 60 degrees."""

INTRODUCTION = """\
Scenes that come with the package. `ls.example("press")` is such a scene in Python; `linksweep demo press` shows it, and
every command of `linksweep` takes the name of an example in place of a file. The file of each is below its picture:
copy it, change its numbers, and it is your machine.
"""


def write(folder: Path) -> None:
    """Write gallery.md and its pictures."""
    page = Page()
    page.heading("Gallery of machines", INTRODUCTION, level=1)
    for name in examples.names():
        page.heading(name, examples.title(name))
        picture = _draw(name, folder / MACHINES)
        page.text(f"![{name}: {_links(name)}]({MACHINES / picture})")
        page.text(f"<details>\n<summary>{name}.toml</summary>\n\n```toml\n{_file(name)}\n```\n\n</details>")
    page.write(folder / "gallery.md")


def _draw(name: str, folder: Path) -> str:
    """Draw an example unless its picture is there; return the picture's file name."""
    picture = folder / f"{name}.png"
    if not picture.exists():
        folder.mkdir(parents=True, exist_ok=True)
        fig = _figure(name)
        fig.savefig(picture, dpi=110)
        plt.close(fig)
    return picture.name


def _figure(name: str) -> Figure:
    """Return the figure of an example: its machine with the forces in its pins, or its track."""
    scene = ls.example(name)
    if isinstance(scene.mechanism, ls.LoopTrack):
        return ls.plot.loop(ls.sweep(scene))
    fig, ax = plt.subplots(figsize=(6.0, 4.5), layout="constrained")
    ls.plot.mechanism(scene, ANGLES.get(name, 60.0), ax=ax, forces=True)
    return fig


def _links(name: str) -> str:
    """Return the links of an example in words, for readers who do not see the picture."""
    machine = ls.example(name).mechanism
    return machine.links if isinstance(machine, ls.Linkage) else type(machine).__name__


def _file(name: str) -> str:
    return (files(examples) / f"{name}.toml").read_text(encoding="utf-8").strip()
