"""Rows of a pin between two links: its place on each link, its rotation in the bearing, its force in link axes.

Fij is the force of link i on link j. The mechanism's `journals` name the link that carries the journal (the pin that
turns) of each pin; the other link has the bearing (the bush, the big end).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from linksweep.chains.between_links import force_name, is_pin, name_between
from linksweep.chains.rows.bodies import Body, xy
from linksweep.engine.quantity import Quantity, Row
from linksweep.physics import bearing

Pins = Mapping[str, tuple[int, int]]
Journals = Mapping[str, int]


def rotating(pins: Pins) -> dict[str, tuple[int, int]]:
    """Return the joints that turn: pins, named by a letter."""
    return {pin: links for pin, links in pins.items() if is_pin(pin)}


def pin_rows(pins: Pins, bodies: Iterable[Body]) -> list[Row]:
    """Return rows of the rotation in each pin, and of its force in the axes of both links."""
    by_number = {body.number: body for body in bodies}
    rates: dict[int, str | float] = {1: 0.0} | {k: f"omega{k}" for k in by_number}
    rows = []
    for pin, (i, j) in rotating(pins).items():
        rows.append(Row(bearing.relative_rotation, (f"omega_{pin}",), (rates[j], rates[i])))
        for k in {i, j} - {1}:
            force = xy(force_name(i, j))
            turned = tuple(f"{part}_link{k}" for part in force)
            rows.append(Row(bearing.in_link_axes, turned, (*force, *by_number[k].axes)))
    return rows


def pin_quantities(pins: Pins, links: Mapping[int, str]) -> list[Quantity]:
    """Return the rotation in each pin, its force in link axes, and its arms as quantities."""
    quantities = []
    for pin, (i, j) in rotating(pins).items():
        relative = f"of link {j} ({links[j]}) relative to link {i} ({links[i]}) at pin {pin}"
        rotation = f"angular velocity {relative}, positive counter-clockwise"
        quantities.append(Quantity(f"omega_{pin}", "rad/s", rotation))
        name, force = force_name(i, j), f"force of link {i} ({links[i]}) on link {j} ({links[j]}) at pin {pin}"
        for k in sorted({i, j} - {1}):
            axes = f"of link {k} ({links[k]})"
            quantities += [
                Quantity(f"{name}x_link{k}", "N", f"{force}, component along the x axis {axes}"),
                Quantity(f"{name}y_link{k}", "N", f"{force}, component along the y axis {axes}"),
            ]
            quantities += _arm_quantities(pin, k, ({i, j} - {k}).pop(), links)
    return quantities


def _arm_quantities(pin: str, link: int, other: int, links: Mapping[int, str]) -> list[Quantity]:
    """Return the vector of document 2 (ME 470) from a link's centre of gravity to a pin, named after both links there.

    Its rows are `linksweep.chains.equations.arm_rows`.
    """
    vector = f"vector from the centre of gravity of link {link} ({links[link]}) to its pin {pin} with link {other}"
    axes = {"x": "along x (positive to the right)", "y": "along y (positive upwards)"}.items()
    name = name_between("R", other, link)
    return [Quantity(f"{name}{axis}", "m", f"{vector} ({links[other]}), component {way}") for axis, way in axes]
