"""Commands for pages and pictures: report, animate, draw, explore."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path
from typing import Any

import linksweep as ls
from linksweep.cli.options import FILMS, SHEETS, STRENGTHS, Commands, a_file, a_number, add_part
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

    sheet = add("draw", _draw, "the machine in a position and curves of its points: .svg, .pdf, or .dxf for CAD")
    sheet.add_argument("-o", "--output", type=a_file(SHEETS), required=True, help="file to write: .svg, .pdf or .dxf")
    sheet.add_argument("--theta2", type=a_number("angle"), default=45.0, metavar="ANGLE", help="crank angle (45)")
    sheet.add_argument("--scale", help="paper per length of .svg and .pdf, such as 1:2 (a figure with axes)")
    point = ("LINK", "DISTANCE", "ANGLE")
    curve = 'point of a link whose curve is drawn, such as coupler "10 cm" 15; may be repeated'
    sheet.add_argument("--curve", nargs=3, action="append", dest="curves", metavar=point, help=curve)
    sheet.add_argument("--curves-only", action="store_false", dest="machine", help="the curves without the machine")

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


def _draw(options: argparse.Namespace) -> None:
    without_a_screen()
    curves = options.curves and [(link, *map(_plain, at)) for link, *at in options.curves]
    more = {"curves": curves, "machine": options.machine, "scale": options.scale}
    ls.save_drawing(one_design(options.scene), options.output, theta2=options.theta2, **more)
    print(f"written: {options.output}")


def _plain(text: str) -> Any:
    """Return a text that is a number by itself as that, and one with a unit as it is."""
    try:
        return float(text)
    except ValueError:
        return text


def _explore(options: argparse.Namespace) -> None:
    from linksweep.explorer.explore import serve

    scene = one_design(options.scene)
    serve(scene, title=options.scene.stem, port=options.port, show=not options.no_browser)
