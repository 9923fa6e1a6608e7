"""explore(scene): a machine under the mouse, in a notebook; `serve` shows it as a page."""

from __future__ import annotations

from importlib.util import find_spec
from types import ModuleType
from typing import Any

import xarray as xr

from linksweep.files.netcdf import scene_from
from linksweep.plot.kit.drawings import drawing_of
from linksweep.scene.scene import Scene

ADDRESS = "127.0.0.1"
MISSING = 'explore needs Panel, which is not installed: pip install "linksweep[explorer]"'


def explore(scene: Scene | xr.Dataset, *, title: str | None = None) -> Any:
    """Show a machine under the mouse: sliders for its numbers, pins to drag; motion, forces and exact peaks follow.

    Parameters
    ----------
    scene : Scene or Dataset
        Scene of one design, or a Dataset of linksweep that holds it.
    title : str, default None
        Heading; None for the kind of mechanism.

    Returns
    -------
    Panel component
        Explorer that a notebook shows as the last expression of a cell. Its ``scene`` is the design as it stands, for
        the next cell.

    Raises
    ------
    ImportError
        Where Panel is not installed: ``pip install "linksweep[explorer]"``.
    ValueError
        For several designs, and for a machine that has no drawing.

    Examples
    --------
    >>> import linksweep as ls
    >>> explorer = ls.explore(ls.example("press"))
    >>> explorer.scene.mechanism.coupler.length
    0.22
    """
    one = scene_from(scene)
    drawing_of(one.mechanism)
    panel = _panel()
    panel.extension(inline=True)  # its scripts in the notebook, which then needs no network
    return _explorer(one, title)


def serve(scene: Scene, *, title: str | None = None, port: int = 0, show: bool = True) -> None:
    """Serve the explorer as a page on this machine alone, until Ctrl-C.

    Parameters
    ----------
    scene : Scene
        Scene of one design; each page that is opened starts with it.
    title : str, default None
        Heading; None for the kind of mechanism.
    port : int, default 0
        Port; 0 for any that is free.
    show : bool, default True
        True to open the page in the browser.

    Raises
    ------
    ImportError, ValueError
        As `explore`.
    """
    drawing_of(scene.mechanism)
    panel = _panel()
    name = _title(scene, title)
    _explorer(scene, title)  # whose problems are told before the server starts
    panel.serve(lambda: _explorer(scene, title, fills=True), address=ADDRESS, port=port, show=show, title=name)


def _explorer(scene: Scene, title: str | None, **options: Any) -> Any:
    from linksweep.explorer.widget import Explorer  # here: it imports Panel

    return Explorer(scene, _title(scene, title), **options)


def _title(scene: Scene, title: str | None) -> str:
    return title or scene.mechanism.title or type(scene.mechanism).__name__


def _panel() -> ModuleType:
    """Import Panel, which is slow, and not always there."""
    if find_spec("panel") is None:
        raise ImportError(MISSING)
    import panel

    return panel
