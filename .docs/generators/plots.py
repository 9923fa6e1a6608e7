"""Pictures of the plots: the page of each shows the figure that its own example draws."""

import doctest
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import matplotlib.pyplot as plt

import linksweep as ls
from linksweep.plot.kit.film import Film

PICTURES = Path("plots")
ACCESSOR = "linksweep.plot.accessor.Cycle"


def write(folder: Path) -> None:
    """Draw the pictures that are not there yet."""
    (folder / PICTURES).mkdir(parents=True, exist_ok=True)
    for name in ls.plot.__all__:
        picture = folder / PICTURES / f"{name}.png"
        if not picture.exists():
            _draw(getattr(ls.plot, name).__doc__, picture)


def complete(app, what: str, name: str, thing: object, options: object, lines: list[str]) -> None:
    """Append the picture to the docstring of a plot; a method that draws it refers to the plot's own page."""
    home, _, plot = name.rpartition(".")
    if plot not in ls.plot.__all__:
        return
    if home == ACCESSOR:
        lines[1:] = ["", f"Parameters, errors and a picture: `linksweep.plot.{plot}`."]
    elif home == "linksweep.plot":
        lines += ["", f".. image:: /generated/{PICTURES}/{plot}.png", f"   :alt: {lines[0]}"]


def _draw(docstring: str, picture: Path) -> None:
    """Run the example of a plot, and write the figure, or the middle of the film, that it makes."""
    names: dict[str, object] = {}
    with redirect_stdout(StringIO()):
        for example in doctest.DocTestParser().get_examples(docstring):
            exec(compile(example.source, picture.stem, "single"), names)
    films = [thing for thing in names.values() if isinstance(thing, Film)]
    if films:
        films[0].image(len(films[0]) // 3).save(picture)
    else:
        plt.gcf().savefig(picture, dpi=110)
    plt.close("all")
