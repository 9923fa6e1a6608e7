"""Scenes that come with the package."""

from importlib.resources import files

from linksweep.mechanisms.validate import choice_problems, refuse
from linksweep.scene.file import parse_scene
from linksweep.scene.scene import Scene


def example(name: str) -> Scene:
    """A scene that comes with the package.

    Parameters
    ----------
    name : "press", a crank-rocker press of steel bars, 300 rpm, 80 lbf on the coupler

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
    known = sorted(file.name.removesuffix(".toml") for file in files(__name__).iterdir() if file.name.endswith(".toml"))
    refuse(choice_problems("name", name, known))
    file = files(__name__) / f"{name}.toml"
    return parse_scene(file.read_text(encoding="utf-8"), file.name)
