"""Loads as they are drawn: forces and torques at their points, gas on its piston, springs and dampers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from linksweep.mechanisms.drawing import Drawing
from linksweep.plot.kit import signals
from linksweep.plot.kit.shape import axes_of, places_of, point_of
from linksweep.scene.loads.ends import GROUND
from linksweep.scene.loads.gas_pressure import GasPressure
from linksweep.scene.loads.load import LoadForm
from linksweep.scene.loads.springs import LineForm
from linksweep.scene.loads.torsion import TurningForm
from linksweep.scene.scene import Scene

if TYPE_CHECKING:
    from linksweep.engine.run import Field


class LoadSymbol(NamedTuple):
    """The sign of a load on a drawing; arrays are over crank angles, (2, angles) for x and y, (2, 1) where it stands.

    A "force" and "gas" have a force [N] at their place [m], a "torque" has one [N m] about its place, a "spring" and a
    "damper" have an end, a "torsion spring" and a "torsion damper" a place alone. `links` are the numbers of the links
    at the place and at the end.
    """

    name: str
    kind: str
    links: tuple[int, ...]
    place: np.ndarray
    force: np.ndarray | None = None
    torque: np.ndarray | None = None
    end: np.ndarray | None = None

    @property
    def acts(self) -> bool:
        """True of one angle's symbol that has an arrow."""
        return self.force is not None and bool(np.any(self.force != 0.0))

    def at(self, k: int) -> LoadSymbol:
        """Return the symbol at one of the angles, with x and y of its place, force and end."""
        rows = (None if row is None else row[..., k % row.shape[-1]] for row in self[3:])
        return LoadSymbol(self.name, self.kind, self.links, *rows)  # type: ignore[arg-type]

    def turned(self, turn: np.ndarray) -> LoadSymbol:
        """Return the symbol turned about the origin by a rotation matrix."""
        force, end = (None if vector is None else turn @ vector for vector in (self.force, self.end))
        return self._replace(place=turn @ self.place, force=force, end=end)


def load_symbols(
    scene: Scene, drawing: Drawing, motion: xr.Dataset, places: Mapping[str, np.ndarray], angles: Any
) -> list[LoadSymbol]:
    """Return the symbols of a scene's loads.

    Parameters
    ----------
    scene : Scene
        Scene of one design.
    drawing : Drawing
        Drawing of its machine.
    motion : Dataset
        Positions, as `shape.positions` returns them.
    places : mapping of str to array
        Place of each pin in the motion, as `shape.places_of` returns them.
    angles : int or array
        Crank angles of forces and torques, as `Scene.grid` takes them: those of the motion, or whole cycles of it.

    Returns
    -------
    list of LoadSymbol
        One for each force, torque, spring or damper, in the order of the loads.
    """
    grid = scene.grid(angles)
    return [*_Loads(scene, drawing, motion, places, scene.at(grid).inputs.fields, len(grid.angles)).symbols()]


def loads_at(scene: Scene, drawing: Drawing, cycle: xr.Dataset, angles: Sequence[float]) -> list[list[LoadSymbol]]:
    """Return the symbols of a scene's loads at each of the angles at which a cycle of `shape.positions` ends."""
    motion = cycle.isel({signals.INDEX: slice(cycle.sizes[signals.INDEX] - len(angles), None)})
    symbols = load_symbols(scene, drawing, motion, places_of(scene, drawing, motion), np.asarray(angles))
    return [[symbol.at(k) for symbol in symbols] for k in range(len(angles))]


class _Loads(NamedTuple):
    """The loads of a scene, the positions of its links, and the numbers of the loads at each angle."""

    scene: Scene
    drawing: Drawing
    motion: xr.Dataset
    places: Mapping[str, np.ndarray]
    fields: Mapping[str, Field]
    samples: int

    def symbols(self) -> Iterator[LoadSymbol]:
        for k, load in enumerate(self.scene.loads, 1):
            name, form = f"load{k}", load.form
            if isinstance(form, LoadForm):
                kind = "gas" if isinstance(load, GasPressure) else "force"
                yield from self._on_link(name, kind, form)
            elif isinstance(form, LineForm):
                kind, links = "damper" if form.damps else "spring", (form.from_, form.to)
                start, end = (self._end(f"{name}_{end}", link) for end, link in zip(("from", "to"), links, strict=True))
                yield LoadSymbol(_words(name), kind, tuple(map(self._number, links)), start, end=end)
            elif isinstance(form, TurningForm):
                kind = "torsion damper" if form.damps else "torsion spring"
                yield LoadSymbol(_words(name), kind, (), self._joint(form.from_, form.to))

    def _on_link(self, name: str, kind: str, form: LoadForm) -> Iterator[LoadSymbol]:
        number = self._number(form.link)
        place = self._point(number, self._value(f"{name}_at_x"), self._value(f"{name}_at_y"))
        if form.force:
            yield LoadSymbol(_words(name), kind, (number,), place, force=self._force(name, number, form.link_axes))
        if form.torque:
            yield LoadSymbol(_words(name), "torque", (number,), place, torque=self._value(f"{name}_torque"))

    def _force(self, name: str, number: int, link_axes: bool) -> np.ndarray:
        if not link_axes:
            return np.array([self._value(f"{name}_F{axis}") for axis in "xy"])
        along, across = (self._value(f"{name}_force_{axis}") for axis in "xy")
        x, y = axes_of(self.scene, self.motion, self.drawing.frames[number])
        x, y = (np.tile(part, max(1, self.samples // len(part))) for part in (x, y))
        return np.array([along * x - across * y, along * y + across * x])

    def _end(self, name: str, link: str) -> np.ndarray:
        if link == GROUND:
            return np.array([self._value(f"{name}_{axis}")[:1] for axis in "xy"])
        at = (self._value(f"{name}_at_{axis}")[:1] for axis in "xy")
        return self._point(self._number(link), *at)

    def _point(self, number: int, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return point_of(self.scene, self.drawing, self.motion, self.places, number, x[:1], y[:1])

    def _joint(self, first: str, second: str) -> np.ndarray:
        """Return the place of the pin that joins two links, or else of the first pin of one that moves."""
        still = (*self.drawing.fixed(self.scene.mechanism),)
        pins = [still if link == GROUND else self.drawing.pins_of(self._number(link)) for link in (first, second)]
        moving = pins[first == GROUND]
        return self.places[next((pin for pin in moving if all(pin in each for each in pins)), moving[0])]

    def _number(self, role: str) -> int:
        """Return the number of a link, 1 of the ground."""
        return next((body.number for body in self.scene.mechanism.bodies if body.role == role), 1)

    def _value(self, name: str) -> np.ndarray:
        """Return a number of a load at every angle."""
        return np.broadcast_to(self.fields[name].values, (self.samples,))


def _words(name: str) -> str:
    return name.replace("load", "load ")
