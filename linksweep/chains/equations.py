"""The square system of a machine made of a crank and dyads: ΣFx, ΣFy, ΣM about its centre of gravity of each link.

A slide between links i and j has two unknowns: the normal force of i on j with the friction that it brings, which acts
at the slider's pin, and a moment about that pin.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from linksweep.chains.between_links import force_name, has_moment, name_between
from linksweep.chains.dyads.rrr import Rows
from linksweep.chains.gears import add_gears
from linksweep.chains.motion import Motion
from linksweep.chains.rows.bodies import Equation, Source, newton_euler_equations, xy
from linksweep.chains.topology import Topology
from linksweep.engine.quantity import Row
from linksweep.physics.algebra import planar
from linksweep.physics.closures import inverted_slider_crank


class Contact(NamedTuple):
    """A slide between links i and j: its normal force, μ·sign(v), its line's direction, and the slider's pin."""

    pair: tuple[int, int]
    normal: Source
    direction: Source
    line_x: Source
    line_y: Source
    pin_x: Source
    pin_y: Source


def arm_rows(motion: Motion) -> Rows:
    """Return rows of the vectors from each link's centre of gravity to its pins."""
    topology = motion.topology
    ends = [(pin.partition(":")[0], pair, k) for pin, pair in topology.pins.items() for k in pair if k != 1]
    return [
        Row(planar.difference, xy(arm(pair, k)), (*motion.arm(topology.roles[k - 2], pin), *xy(f"rG{k}")))
        for pin, pair, k in ends
    ]


def contact_rows(contacts: Iterable[Contact]) -> Rows:
    """Return rows of each slide's force per unit of its normal force, and of its moments about centres of gravity."""
    rows: Rows = []
    for pair, *contact, x, y in contacts:
        stem = f"contact_{force_name(*pair)}"
        rows.append(Row(inverted_slider_crank.contact_direction, xy(stem), tuple(contact)))
        for k in {*pair} - {1}:
            lever = f"{stem}_lever{k}"
            rows.append(Row(planar.difference, xy(lever), (x, y, *xy(f"G{k}"))))
            rows.append(Row(planar.cross, (f"{stem}_on{k}",), (*xy(lever), *xy(stem))))
    return rows


def cylinder_rows(topology: Topology) -> Rows:
    """Return rows of the moments of each cylinder's unit force about the centres of gravity of the links it pushes."""
    rows: Rows = []
    for role, pin, k, _ in _pushed(topology, topology.cylinders):
        lever = f"lever_{role}_{pin}"
        rows.append(Row(planar.difference, xy(lever), (*xy(pin), *xy(f"G{k}"))))
        rows.append(Row(planar.cross, (f"axis_{role}_at_{pin}",), (*xy(lever), *xy(f"axis_{role}"))))
    return rows


def _pushed(topology: Topology, cylinders: Iterable[str]) -> Iterator[tuple[str, str, int, float]]:
    """Yield each cylinder with a pin, the number of the moving link that carries it, and the sign of its push there."""
    for role in cylinders:
        for pin, way in zip(topology.cylinders[role], (-1.0, 1.0), strict=True):
            k = topology.number(topology.members[pin][0])
            if k != 1:
                yield role, pin, k, way


def equations(
    topology: Topology, torques: Mapping[str, str], meshed: frozenset[str] = frozenset()
) -> tuple[Equation, ...]:
    """Return the three rows of each moving link; `torques` names the unknown of the driven link, or cylinder."""
    cylinders = [*topology.struts, *(role for role in torques if role in topology.cylinders)]
    rows = []
    for role in topology.roles:
        k = topology.number(role)
        pins = {force_name(*pair): (sign(pair, k), arm(pair, k)) for pair in topology.pins.values() if k in pair}
        of_link = newton_euler_equations(k, pins, torques.get(role))
        for slide, pair in topology.slides.items():
            if k in pair:
                _add_slide(of_link, pair, k, has_moment(slide))
        for name, pin, number, way in _pushed(topology, cylinders):
            if number == k:
                add_force(of_link, f"force_{name}", way, (*xy(f"axis_{name}"), f"axis_{name}_at_{pin}"))
        add_gears(topology, meshed, of_link, k)
        rows += of_link
    return tuple(rows)


def _add_slide(rows: list[Equation], pair: tuple[int, int], k: int, with_moment: bool) -> None:
    """Add the normal force and the moment of a slide to the rows of a link."""
    force = force_name(*pair)
    stem = f"contact_{force}"
    add_force(rows, f"{force}n", sign(pair, k), (*xy(stem), f"{stem}_on{k}"))
    if with_moment:
        rows[2].coefficients[name_between("T", *pair)] = sign(pair, k)


def add_force(rows: Iterable[Equation], force: str, way: float, names: Iterable[str]) -> None:
    """Add a force of unknown size to the rows of a link: names of its components and moment per unit of the force."""
    for row, name in zip(rows, names, strict=True):
        row.coefficients[force] = (way, name)


def arm(pair: tuple[int, int], k: int) -> str:
    """Return the name of the vector from the centre of gravity of link k to its pin with the other of two links."""
    return name_between("R", sum(pair) - k, k)


def sign(pair: tuple[int, int], k: int) -> float:
    """Return 1 for the link on which the force of two links acts, −1 for the other."""
    return 1.0 if pair[1] == k else -1.0
