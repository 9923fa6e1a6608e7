"""Scenes that come with the package. The comment that a file begins with is its title."""

from importlib.resources import files
from itertools import takewhile

from linksweep.base.validate import choice_problems, refuse
from linksweep.scene.file.reading import parse_scene
from linksweep.scene.scene import Scene


def example(name: str) -> Scene:
    """A scene that comes with the package.

    Parameters
    ----------
    name : "press", a crank-rocker press of steel bars, 300 rpm, 80 lbf on the coupler; "engine", a
        four-stroke engine with one cylinder of 0.5 litre, 3000 rpm; "quick-return", a shaper's inverted
        slider-crank; "loop", the rocket car of document 3's example 17-4

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
    """Names of the scenes that come with the package."""
    return sorted(file.name.removesuffix(".toml") for file in files(__name__).iterdir() if file.name.endswith(".toml"))


def title(name: str) -> str:
    """What a scene is, in a sentence or two: the comment that its file begins with."""
    lines = takewhile(lambda line: line.startswith("#"), _text(name).splitlines())
    return "\n".join(line.removeprefix("# ") for line in lines)


def _text(name: str) -> str:
    refuse(choice_problems("name", name, names()))
    return (files(__name__) / f"{name}.toml").read_text(encoding="utf-8")
