"""Commands for pages and pictures: report, animate, explore."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

import linksweep as ls
from linksweep.cli.options import FILMS, STRENGTHS, Commands, a_file, add_part
from linksweep.cli.running import one_design, without_a_screen


def add_page_commands(commands: Commands) -> None:
    """Add these commands to those of the command line."""
    add = partial(commands.add, task="Pages and pictures")
    page = add("report", _report, "a page to print: inputs, checks, peaks, drive, figures")
    page.add_argument("-o", "--output", type=Path, required=True, help="page to write: .html")
    page.add_argument("--title", help="heading of the page (name of the scene file)")
    add_part(page, "crank angles [degree] of a machine that moves over part of a turn")
    strong = "of the links, for a table of their strength: %(choices)s"
    page.add_argument("--material", choices=STRENGTHS, metavar="NAME", help=strong)

    film = add("animate", _animate, "a film of the mechanism with its forces: .gif or .html")
    film.add_argument("-o", "--output", type=a_file(FILMS), required=True, help="film to write: .gif or .html")
    film.add_argument("--frames", type=int, default=72, metavar="N", help="frames in a cycle, 25 a second (72)")

    mouse = add("explore", _explore, "a page on this machine: numbers as sliders, pins to drag, until Ctrl-C")
    mouse.add_argument("--port", type=int, default=0, help="port on 127.0.0.1 (any that is free)")
    mouse.add_argument("--no-browser", action="store_true", help="print the address, and open no browser")


def _report(options: argparse.Namespace) -> None:
    part = tuple(options.theta2) if options.theta2 else None
    steel = ls.material(options.material) if options.material else None
    heading = options.title or options.scene.stem
    ls.report(one_design(options.scene), options.output, title=heading, theta2=part, material=steel)
    print(f"written: {options.output}")


def _animate(options: argparse.Namespace) -> None:
    without_a_screen()
    ls.plot.animate(one_design(options.scene), frames=options.frames, title=options.scene.stem).save(options.output)
    print(f"written: {options.output}")


def _explore(options: argparse.Namespace) -> None:
    from linksweep.explorer.explore import serve

    scene = one_design(options.scene)
    serve(scene, title=options.scene.stem, port=options.port, show=not options.no_browser)
