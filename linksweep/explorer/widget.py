"""The component of Panel that shows the page and passes its questions to the model."""

from __future__ import annotations

from importlib.resources import files
from typing import Any

import param
from panel.custom import JSComponent

from linksweep.explorer.model.session import Session
from linksweep.scene.scene import Scene

SCRIPTS = ("drawing.js", "loads.js", "machine.js", "charts.js", "controls.js", "page.js")
"""Files of the page's one module, in order."""


def _text(*names: str) -> str:
    return "\n".join((files(__package__) / "page" / name).read_text("utf-8") for name in names)


class Explorer(JSComponent):
    """A machine under the mouse, which a notebook shows as the last expression of a cell; `scene` is its present
    design."""

    fills = param.Boolean(False, doc="True where the component is the whole page.")

    _esm = _text(*SCRIPTS)
    _stylesheets = [_text("page.css")]  # noqa: RUF012 - Panel's way

    def __init__(self, scene: Scene, title: str, **options: Any) -> None:
        super().__init__(**{"sizing_mode": "stretch_width"} | options)
        self._session = Session(scene, title)

    @property
    def scene(self) -> Scene:
        """The design as the page shows it."""
        return self._session.scene

    def _handle_msg(self, question: Any) -> None:
        self._send_msg(self._session.reply(question))
