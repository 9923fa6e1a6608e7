"""Example scenes of the package; the comment at the head of each file is its title."""

from importlib.resources import files
from itertools import takewhile

from linksweep.base.validate import choice_problems, refuse
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.scene import Scene


def example(name: str) -> Scene:
    """Load an example scene of the package.

    Parameters
    ----------
    name : str
        "press", a crank-rocker press of steel bars, 300 rpm, 80 lbf on the coupler; "engine", a four-stroke engine with
        one cylinder of 0.5 litre, 3000 rpm; "quick-return", a shaper's inverted slider-crank; "loop", the rocket car of
        document 3's example 17-4.

        Linkages: "watt-1", "watt-2", "stephenson-1" and "stephenson-3", six-bars that feed, stir, pull film and dwell;
        the presses "knuckle-press" and "drag-link-press"; "crank-shaper" and "whitworth", quick returns; "scotch-yoke",
        a pump; "pump-jack"; "jansen-leg" and "klann-leg", which walk; "wipers", of a car; "scissor-lift";
        "geared-five-bar", a press without a guide; "excavator", whose arc is from 0 to 40 degrees.

    Returns
    -------
    Scene
        The scene.

    Raises
    ------
    ValueError
        For another name.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.example("press").mechanism.ground
    0.2
    """
    return parse_scene(_text(name), f"{name}.toml")


def names() -> list[str]:
    """Return the names of the example scenes."""
    return sorted(file.name.removesuffix(".toml") for file in files(__name__).iterdir() if file.name.endswith(".toml"))


def title(name: str) -> str:
    """Return the title of an example scene, in a sentence or two: the comment at the head of its file."""
    lines = takewhile(lambda line: line.startswith("#"), _text(name).splitlines())
    return "\n".join(line.removeprefix("# ") for line in lines)


def _text(name: str) -> str:
    """Return the text of an example scene."""
    refuse(choice_problems("name", name, names()))
    return (files(__name__) / f"{name}.toml").read_text(encoding="utf-8")
