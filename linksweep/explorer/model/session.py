"""One person at one page: the scene, what it was before, and the design that it is compared with."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from linksweep.base.validate import refuse
from linksweep.explorer.model import answers
from linksweep.explorer.model.controls import controls, read, values, with_branch
from linksweep.explorer.model.dragging import dragged, handles
from linksweep.explorer.model.exports import EXPORTS
from linksweep.scene.designs.choose import design_labels
from linksweep.scene.parameters import free, replaced
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import shown_units

Reply = dict[str, Any]


class Session:
    """Replies to the questions of a page; a bad number leaves the scene as it is.

    A question is a mapping: ``ask`` names it, ``gesture`` counts movements of the mouse. All changes of one gesture are
    undone at once. A reply has what changed; where nothing could, it has a ``refusal`` in a sentence.
    """

    def __init__(self, scene: Scene, title: str) -> None:
        several = ", ".join(f"{dim} ({len(labels)})" for dim, labels in design_labels(scene).items())
        refuse([f"scene: has several designs, over {several}: choose one, ls.scene_at(scene, ...)"] if several else [])
        self.scene, self.title, self.system = scene, title, shown_units(scene.units)
        self.pinned: Scene | None = None
        self._past: list[Scene] = []
        self._future: list[Scene] = []
        self._gesture: Any = None

    def reply(self, question: Mapping[str, Any]) -> Reply:
        """Return the reply to a question, with what was asked."""
        try:
            return {"ask": question["ask"], **self._answer(**question)}
        except ValueError as error:
            return {"ask": question["ask"], "refusal": str(error)}

    def _answer(self, ask: str, **details: Any) -> Reply:
        match ask:
            case "start":
                return self._start()
            case "set":
                return self._set(**details)
            case "assemble":
                return self._changed(with_branch(self.scene, **details))
            case "drag":
                return self._drag(**details)
            case "exact":
                return answers.exact(self.scene, self.system)
            case "undo":
                return self._step(self._past, self._future)
            case "redo":
                return self._step(self._future, self._past)
            case "pin":
                return self._pin()
            case "unpin":
                return self._unpin()
            case "restore":
                return self._changed(self.pinned or self.scene)
            case "export":
                return EXPORTS[details["form"]](self.scene, self.title)._asdict()
        raise ValueError(f"ask = {ask!r}: is no question of the page")

    def _start(self) -> Reply:
        view = [control._asdict() for control in controls(self.scene, self.system)]
        return {
            "title": self.title,
            "picture": answers.picture(self.scene, self.system),
            "handles": handles(self.scene),
            "controls": view,
            "pinned": self.pinned and self._compared(self.pinned),
            **self._state(),
        }

    def _state(self) -> Reply:
        """Return the cycle and the numbers of the present scene."""
        return {**self._view(self.scene), "undo": bool(self._past), "redo": bool(self._future)}

    def _set(self, numbers: Mapping[str, Any], gesture: Any = None) -> Reply:
        known = free(self.scene)
        new = {path: read(number, known[path][1], self.system) for path, number in numbers.items()}
        return self._changed(replaced(self.scene, new), gesture)

    def _drag(self, pin: str, place: tuple[float, float], angle: float, gesture: Any = None) -> Reply:
        metre = self.system.size("m")
        move = dragged(self.scene, pin, (place[0] * metre, place[1] * metre), angle)
        return self._changed(replaced(self.scene, move.numbers), gesture) | {"angle": move.angle}

    def _changed(self, scene: Scene, gesture: Any = None) -> Reply:
        """Take another scene, and begin a new step unless it belongs to the last gesture."""
        view = self._view(scene)  # first: where it fails, the old scene stays
        if gesture is None or gesture != self._gesture:
            self._past.append(self.scene)
        self._gesture, self._future, self.scene = gesture, [], scene
        return {**view, "undo": True, "redo": False}

    def _step(self, here: list[Scene], there: list[Scene]) -> Reply:
        if here:
            there.append(self.scene)
            self.scene, self._gesture = here.pop(), None
        return self._state()

    def _pin(self) -> Reply:
        self.pinned = self.scene
        return {"pinned": self._compared(self.scene)}

    def _unpin(self) -> Reply:
        self.pinned = None
        return {"pinned": None}

    def _view(self, scene: Scene) -> Reply:
        numbers = values(scene, self.system)
        return {"cycle": answers.cycle(scene, self.system), "values": numbers, "branches": scene.mechanism.branches}

    def _compared(self, scene: Scene) -> Reply:
        return {**self._view(scene), **answers.exact(scene, self.system)}
