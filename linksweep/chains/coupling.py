"""Drives that decide the friction of slides, or the force of cylinders of given length, and are decided by it in turn.

The rows of the dyads' forces, from a known drive and known friction to the normal forces, are linear: evaluated on
affine numbers they give the coefficients by which `linksweep.physics.coupled_contacts` finds drive and friction.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

from linksweep.chains.drives import Drive
from linksweep.chains.dyads.rrr import Rows
from linksweep.chains.rows.bodies import Source
from linksweep.engine.quantity import Limit, Row, Total
from linksweep.physics import coulomb, coupled_contacts
from linksweep.physics.algebra import planar
from linksweep.physics.algebra.affine import Affine, affine
from linksweep.physics.algebra.arithmetic import Number

JAM = "drive_jam"
"""Name of the status of friction that depends on the drive."""
NOISE = ("noise_of_balancing", "noise_of_slowness")
"""Names of the noise of work over rate of the drive, and of one over that rate."""


class Rub(NamedTuple):
    """A slide that rubs: names of its normal force, friction, μ·sign(v) and μ, and of its velocity per rate of the
    crank."""

    normal: str
    friction: str
    direction: str
    coefficient: str
    ratio: Source


class Coupling:
    """A drive, with the slides that rub and the cylinders of given length (struts) that depend on it and decide it."""

    def __init__(self, drive: Drive) -> None:
        self.drive = drive
        self.rubs: list[Rub] = []
        self.struts: list[str] = []

    def rows(self, of_forces: Rows, fixed_work: Sequence[str]) -> Rows:
        """Return the rows of drive and friction, from those of the forces where both are known, and from all work that
        does not depend on them."""
        effects = [*(rub.normal for rub in self.rubs), *(f"force_{role}" for role in self.struts)]
        of_friction = [f"work_of_{rub.friction}" for rub in self.rubs]
        return [
            Total("fixed_work", tuple(fixed_work)),
            response(of_forces, self._causes, effects),
            *(self._rates_with_struts() if self.struts else []),
            Row(coupled_contacts.noise_of_drive, NOISE, (*self._balanced, self.drive.size, *fixed_work)),
            *(row for rub in self.rubs for row in self._rows_of_slide(rub)),
            *self._solving(),
            Total("work", ("fixed_work", *of_friction, *(f"work_of_{role}" for role in self.struts))),
            Total("balance", (self._work, *(f"balance_of_{rub.friction}" for rub in self.rubs))),
            *self._driven.rows("balance"),
        ]

    def limits(self) -> tuple[Limit, ...]:
        """Return the limits at which the drive stands still, and at which friction wedges the slides."""
        wedged = Limit(self.drive.name, self._grips, ("drive_grip_noise",) * len(self._grips), "wedge")
        return (*self._driven.limits(), *([wedged] if self.rubs else []))

    def contacts(self) -> tuple[Limit, ...]:
        """Return the limit at which one of several slides bears nothing, beyond which they may jam."""
        noise = tuple(name for name in self._edge_noise for _ in range(2 ** len(self.rubs) // 2))
        unloaded = Limit(self.drive.name, self._edges, noise, "contact")
        return (unloaded,) if len(self.rubs) > 1 else ()

    # ---- names

    @property
    def _causes(self) -> tuple[str, ...]:
        """The drive, and the friction of all slides."""
        return (self.drive.unknown.name, *(rub.friction for rub in self.rubs))

    @property
    def _work(self) -> str:
        return "work_with_struts" if self.struts else "fixed_work"

    @property
    def _balanced(self) -> tuple[str, Source]:
        """The work that the drive balances, and the rate of the drive."""
        return self._work, self._driven.ratio

    @property
    def _driven(self) -> Drive:
        """The drive with its rate, per rate of the crank, while cylinders of given length keep their length."""
        return self.drive._replace(ratio="rate_of_drive") if self.struts else self.drive

    @property
    def _ratios(self) -> list[Source]:
        """Likewise the rates of all slides."""
        return [f"rate_of_{rub.friction}" if self.struts else rub.ratio for rub in self.rubs]

    @property
    def _grips(self) -> tuple[str, ...]:
        return tuple(f"drive_grip_{k}" for k in range(2 ** len(self.rubs)))

    @property
    def _edges(self) -> tuple[str, ...]:
        return tuple(f"drive_edge_{k}" for k in range(len(self.rubs) * 2 ** len(self.rubs) // 2))

    @property
    def _edge_noise(self) -> tuple[str, ...]:
        return tuple(f"drive_edge_noise_{k}" for k in range(len(self.rubs)))

    # ---- rows

    def _rates_with_struts(self) -> Rows:
        """Return the row that eliminates the forces of cylinders of given length from the work."""
        of_struts = [(f"{role}_length_slope", *coefficients(f"force_{role}", self._causes)) for role in self.struts]
        inputs = ("fixed_work", self.drive.ratio, *(rub.ratio for rub in self.rubs), *_joined(of_struts))
        outputs = (self._work, "rate_of_drive", *map(str, self._ratios))

        def work_with_struts(*numbers: Number) -> tuple[Number, ...]:
            (work, *rates), of_struts = numbers[: len(outputs)], numbers[len(outputs) :]
            return coupled_contacts.work_with_cylinders(work, rates, _parts(of_struts, len(self.struts)))

        return [Row(work_with_struts, outputs, inputs)]

    def _rows_of_slide(self, rub: Rub) -> Rows:
        """Return the rows of a slide's friction in the work, and of its normal force without the drive."""
        free, per_drive, *slopes = coefficients(rub.normal, self._causes)
        pairs = _joined(zip(self._ratios, slopes, strict=True))
        own = dict(zip((rub.friction for rub in self.rubs), self._ratios, strict=True))

        def without_drive(free: Number, per_drive: Number, work: Number, rate: Number, *numbers: Number):
            of_slides = _parts(numbers[2:], len(self.rubs))
            return coupled_contacts.without_drive(free, per_drive, work, rate, numbers[:2], of_slides)

        return [
            Row(planar.product, (f"work_of_{rub.friction}",), (rub.ratio, rub.friction)),
            Row(planar.product, (f"balance_of_{rub.friction}",), (own[rub.friction], rub.friction)),
            Row(without_drive, self._without_drive(rub), (free, per_drive, *self._balanced, *NOISE, *pairs)),
        ]

    def _without_drive(self, rub: Rub) -> tuple[str, ...]:
        """Return the names of a normal force without drive and friction, and of its change per friction of each."""
        return tuple(f"{name}_driven" for name in coefficients(rub.normal, self._causes[1:]))

    def _solving(self) -> Rows:
        """Return the rows of the friction of all slides, and of its status; then those of the signals of wedging."""
        s = len(self.rubs)
        if not s:
            return []
        known = _joined(map(self._without_drive, self.rubs))
        frictions, directions = self._causes[1:], [rub.direction for rub in self.rubs]

        def coupled_contacts_of(*numbers: Number) -> tuple[Number, ...]:
            of_slides = _parts(numbers[:-s], s)
            alone, slopes = [part[0] for part in of_slides], [part[1:] for part in of_slides]
            return coupled_contacts.coupled_contacts(alone, slopes, numbers[-s:])

        def statics(rate: Number, *numbers: Number) -> coupled_contacts.Statics:
            of_slides = _parts(numbers[2 * s :], s)
            per_drive, slopes = [part[0] for part in of_slides], [part[1:] for part in of_slides]
            return coupled_contacts.Statics(rate, numbers[:s], per_drive, slopes, numbers[s : 2 * s])

        def wedging_signals(*numbers: Number) -> tuple[Number, ...]:
            return coupled_contacts.wedging_signals(statics(*numbers))

        def unloaded_signals(work: Number, *numbers: Number) -> tuple[Number, ...]:
            return coupled_contacts.unloaded_signals(statics(*numbers[s:]), [-work, *numbers[:s]])

        of_normals = [coefficients(rub.normal, self._causes) for rub in self.rubs]
        free, per_cause = [names[0] for names in of_normals], [names[1:] for names in of_normals]
        of_signals = (self._driven.ratio, *self._ratios, *(rub.coefficient for rub in self.rubs), *_joined(per_cause))
        return [
            Row(coupled_contacts_of, (*frictions, "drive_solutions"), (*known, *directions)),
            Row(coulomb.solutions_status, (JAM,), (0.0, "drive_solutions")),
            Row(wedging_signals, (*self._grips, "drive_grip_noise"), of_signals),
            Row(unloaded_signals, (*self._edges, *self._edge_noise), (self._work, *free, *of_signals)),
        ]


def response(rows: Rows, causes: Collection[str], effects: Collection[str]) -> Row:
    """Return the row of the coefficients of effects that depend linearly on causes.

    The rows that lead from causes to effects stand in their order; all else that they need is an input.
    """
    caused, consequences = set(causes), []
    for row in rows:
        if not caused.isdisjoint(row.wiring):
            consequences.append(row)
            caused |= {*row.outputs}
    needed, on_the_way = set(effects), []
    for row in reversed(consequences):
        if not needed.isdisjoint(row.outputs):
            on_the_way.append(row)
            needed |= {source for source in row.wiring if isinstance(source, str)}
    others = sorted(needed - caused)

    def linear_response(*numbers: Number) -> tuple[Number, ...]:
        known = {name: affine(number) for name, number in zip(others, numbers, strict=True)}
        known |= {cause: Affine.unknown(cause) for cause in causes}
        for row in reversed(on_the_way):
            made = row.function(*(known[x] if isinstance(x, str) else affine(x) for x in row.wiring))
            known.update(zip(row.outputs, made if isinstance(made, tuple) else (made,), strict=True))
        return tuple(_joined(known[effect].coefficients(*causes) for effect in effects))

    return Row(linear_response, tuple(_joined(coefficients(effect, causes) for effect in effects)), tuple(others))


def coefficients(effect: str, causes: Collection[str]) -> list[str]:
    """Return the names of an effect's coefficients: without the causes, then per cause."""
    return [f"{effect}_free", *(f"{effect}_per_{cause}" for cause in causes)]


def _joined(parts) -> list:
    return [x for part in parts for x in part]


def _parts(numbers: Sequence[Number], count: int) -> list[Sequence[Number]]:
    """Return numbers as so many parts of one length."""
    each = len(numbers) // count
    return [numbers[k * each : (k + 1) * each] for k in range(count)]
