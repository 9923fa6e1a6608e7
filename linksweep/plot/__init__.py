"""All plots: a new one is a file, and a line in __init__.pyi, from which this package and the accessor of Datasets take
it.

Each function draws into `ax` where one is passed, and returns the axes; it neither shows a window nor changes
matplotlib's settings. Marked peaks are exact where the Dataset holds its scene, of several designs those of each; else
they are the largest samples. Colours are Okabe and Ito's, which colour-blind readers tell apart; lines also differ in
dashes, so that a force on top of another is seen, in grey too.
"""

from typing import Any

from linksweep.base.public.on_demand import modules_of_names, public_name

_MODULES = modules_of_names(__file__)
__all__ = [*_MODULES]


def __getattr__(name: str) -> Any:
    globals()[name] = item = public_name(__name__, name, _MODULES)
    return item


def __dir__() -> list[str]:
    return __all__
