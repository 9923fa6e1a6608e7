"""Scenes of PMKS+ documents."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from urllib.parse import unquote

from linksweep.base.validate import quote, refuse
from linksweep.files.pmks.drawing import Drawing, Force, Joint
from linksweep.files.pmks.linkage import linkage_of, words_of
from linksweep.files.pmks.machines import Machine, machines
from linksweep.files.pmks.reading import read_drawing
from linksweep.files.pmks.words import Words
from linksweep.results.sweep import sweep
from linksweep.scene.file.text_file import text_of
from linksweep.scene.loads.load import Load
from linksweep.scene.scene import Scene


class NotCarriedOverWarning(UserWarning):
    """A drawing has parts that the scene made of it lacks.

    The message of `linksweep.from_pmks` lists them: further machines and inputs, loads on links that stand still, and
    the like. What it does not list is in the scene.
    """


def from_pmks(source: str | os.PathLike[str], *, machine: int = 1) -> Scene:
    """Make a scene of a document of PMKS+, the Planar Mechanism Kinematic Simulator.

    Links, sliders, slots and cylinders become a `Linkage`, assembled as it is drawn, with masses, forces, gravity and
    the speed of the input, all in SI units.

    Parameters
    ----------
    source : str or PathLike
        A link to the drawing, such as ``https://app.pmksplus.com/?2v.Ay,…`` (nothing is fetched: the link holds the
        whole document); a file that PMKS+ has saved, "press.pmks"; or the text itself.
    machine : int, default 1
        Machine to take from a drawing of several, in the document's order, those with an input first.

    Returns
    -------
    Scene
        The machine. Links have the names of the drawing in small letters ("Connecting rod" becomes `connecting_rod`,
        AB `ab`), pins its letters in capitals. The link at the input is the crank.

    Raises
    ------
    ValueError
        Where the document is damaged or of another kind, where the machine has what a `Linkage` has not, and where its
        links do not close dyad by dyad: one line for each.

    Warns
    -----
    NotCarriedOverWarning
        Where the document has more than the scene: further machines and inputs, loads on links that stand still, the
        mass of a cylinder, an input that turns one moving link against another. The message lists all.

    Notes
    -----
    A link on two ground pins is part of the ground. A joint that slides and lets its link turn becomes a block,
    `block_C C on guide_C`; a link that slides without turning becomes a slider, whose guide goes through its pin. A
    cylinder that is the input is the `drive`. Where the input is no link on the ground, the crank is the first link
    from which the others can be placed, and `omega2` is the speed at which the input has its own in the position drawn.

    Source: the documents' format as PMKS-Web/PMKSWeb on GitHub has it; see `linksweep.files.pmks`.

    Examples
    --------
    >>> import linksweep as ls
    >>> press = ls.from_pmks(
    ...     "2v.Ay,1E8.A,0.1011.6A,A,0,0,0.0B,B,0,Im,0.5C,C,0,0r8,OZ,,,,,1Tm..YRAB,Crank,VG,o,0,9O,c5cae9,A,B,,."
    ...     "YRBC,Connecting rod,ku,6G,0,0HC,303e9f,B,C,,..2F1,BC,F1,0,0r8,0,0bW,1Xg0..N_p*3gSQPQ"
    ... )
    >>> press.mechanism.links, press.mechanism.crank.mass
    ('crank A-B, connecting_rod B-C, block_C C on guide_C', 0.002)
    """
    drawing = read_drawing(_document(source))
    drawn = machines(drawing)
    if machine not in range(1, len(drawn) + 1):
        raise ValueError(f"machine = {quote(machine)}: must be a number from 1 to {len(drawn)}, as many as are drawn")
    chosen = drawn[machine - 1]
    words = words_of(chosen)
    scene = _scene(drawing, words)
    if lines := [*drawing.left_out, *_other_machines(drawn, chosen), *_left_out(drawing, words)]:
        warnings.warn("not carried over:\n" + "\n".join(lines), NotCarriedOverWarning, stacklevel=2)
    return scene


def _document(source: str | os.PathLike[str]) -> str:
    """Return the text of a document, which a link or a file holds."""
    known = "must be the link that PMKS+ shares, or the name of a file"
    refuse([] if isinstance(source, str | os.PathLike) else [f"source is a {type(source).__name__}: {known}"])
    text = str(os.fspath(source))
    if "?" in text:
        text = text.partition("?")[2].partition("#")[0]
    elif isinstance(source, os.PathLike) or text.endswith(".pmks"):
        text = text_of(Path(text), text, ".pmks").strip()
    if text.startswith("data="):
        raise ValueError("a link with data=… is of another program of the same makers: open it there and draw it anew")
    return unquote(text)


def _scene(drawing: Drawing, words: Words) -> Scene:
    loads = [_load(force, words) for force in drawing.forces if force.body in words.axes]
    drive = words.roles[words.cylinder[0]] if words.cylinder else ""
    scene = Scene(linkage_of(words), omega2=1.0, gravity=(0.0, -drawing.gravity), loads=loads, drive=drive)
    return replace(scene, omega2=_speed(scene, words))


def _load(force: Force, words: Words) -> Load:
    axes, frame = words.axes[force.body], "link" if force.follows else "ground"
    components = axes.components(force.force) if force.follows else force.force
    return Load(words.roles[force.body], force=components, at=axes.polar(force.at), frame=frame)


def _speed(scene: Scene, words: Words) -> float:
    """Return the speed of the crank at which the input has its own in the position drawn [rad/s].

    Where the input stands still there, the crank has the document's speed.
    """
    pivot = words.machine.joints[next(iter(words.ground))]
    if not _other_input(words):
        return pivot.speed
    rate = _rate(words, words.machine.inputs[0])
    ratio = float(sweep(scene, theta2=[words.axes[words.crank].angle], of=[rate])[rate].item())
    return words.machine.inputs[0].speed / ratio if abs(ratio) > 0.0 else pivot.speed


def _rate(words: Words, joint: Joint) -> str:
    """Return the quantity that is the speed of an input."""
    if joint is words.piston:
        return f"rate_{words.roles[words.cylinder[0]]}"
    if joint.slides:
        bodies = [words.roles[name] for name, by in words.sliders.items() if by is joint]
        return f"v_{(*bodies, f'block_{joint.name}')[0]}"
    return f"omega_{joint.name}"


def _other_input(words: Words) -> bool:
    """Return whether the first input is another than that of the crank against the ground."""
    return any(joint.name not in words.ground for joint in words.machine.inputs[:1])


def _other_machines(drawn: list[Machine], chosen: Machine) -> Iterator[str]:
    for number, other in enumerate(drawn, 1):
        if other is not chosen:
            yield f"machine {number}, of the links {', '.join(other.bodies)}: machine={number} takes it"


def _left_out(drawing: Drawing, words: Words) -> Iterator[str]:
    """Yield what the scene lacks of the machine."""
    machine, crank = words.machine, words.roles[words.crank]
    yield from (
        f"the input at {joint.name}: {crank} turns by that at {machine.inputs[0].name}" for joint in machine.inputs[1:]
    )
    if not machine.inputs:
        yield f"no joint has an input: {crank} turns"
    elif _other_input(words):
        drive = "" if words.cylinder else " and is the drive"
        yield f"the steady speed of the input at {machine.inputs[0].name}: {crank} turns steadily instead{drive}"
    for name in words.cylinder:
        if mass := machine.bodies[name].mass:
            yield f"the mass of {name}, {mass:g} kg: a cylinder has none"
    for name, slide in words.sliders.items():
        used = {slide.name, words.pin_of(name)}
        if points := [pin for pin in machine.bodies[name].joints if pin not in used]:
            yield f"{', '.join(points)} on {words.roles[name]}: a slider has no further points"
    for joint in (*words.yokes.values(), *words.sliders.values()):
        if joint.mass:
            yield f"the mass of the block at {joint.name}, {joint.mass:g} kg"
    for force in drawing.forces:
        if force.body not in words.axes:
            yield f"force {force.name} on {force.body}"
