"""Forces of a machine made of a crank and dyads, from the last dyad back to the crank.

The forces of a dyad follow from all that acts on its two links, the dyads beyond included: what these exert on their
hosts is applied to them. No system of equations larger than a dyad's is solved. In the names of rows, `push_rod_B` is
the force of the rod on pin B, and `hold_ram` the force of the guide, or of a pin, on the ram.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection
from types import ModuleType

from linksweep.chains import cylinders, gears, lines, slides
from linksweep.chains.between_links import name_between
from linksweep.chains.coupling import JAM, Coupling, Rub
from linksweep.chains.drives import Drive, steps_that_bear
from linksweep.chains.dyads import rrp, rrr
from linksweep.chains.dyads.names import Slide
from linksweep.chains.dyads.rrr import Rows
from linksweep.chains.equations import Contact
from linksweep.chains.motion import Motion
from linksweep.chains.rows.bodies import Source, xy
from linksweep.chains.topology import GROUND, RRP, RRR, Side, Step
from linksweep.engine.quantity import Row, Total
from linksweep.physics.algebra import planar


class Forces:
    """Rows of the forces at all pins and slides of a machine whose motion is known; slides on guides `rubbing` rub.

    Friction that depends on a drive decides it in turn: the `coupling` finds both, and then such a slide's friction is
    given as are loads.
    """

    def __init__(self, motion: Motion, drive: Drive | None = None, rubbing: Collection[str] = ()):
        self.motion, self.topology = motion, motion.topology
        self.rows: Rows = []
        self.statuses: list[tuple[Source, Source]] = []
        self.losses: list[str] = []
        self.directions: dict[str, str] = {}
        self.powers: list[str] = []
        self.contacts: list[Contact] = []
        self.work: list[str] = []
        self.applied: dict[str, list[tuple[str, str]]] = defaultdict(list)
        self.pushes: dict[str, dict[str, str]] = defaultdict(dict)
        self.rubbing, self.bearing = rubbing, frozenset[Step]()
        self.coupling: Coupling | None = None
        if drive and not drive.is_crank:
            self._drive(drive)
            self.bearing = frozenset(steps_that_bear(self.topology, drive.roles))
            self.coupling = Coupling(drive) if self._is_coupled() else None
        for step in reversed(self.topology.steps):
            getattr(self, f"_force_{type(step).__name__}")(step)
        self._crank()
        for pin, members in self.topology.members.items():
            self._pin(pin, *members)
        self.statuses.reverse()

    def row(self, function: Callable, outputs: tuple[str, ...], *inputs: Source) -> None:
        self.rows.append(Row(function, outputs, inputs))

    _force_RPP = slides.force_RPP
    _force_PRP = slides.force_PRP
    _force_RPR = lines.force_RPR
    _force_Gear = gears.force_Gear

    # ------------------------------------------------------------------------------------------------ dyads

    def _force_RRR(self, step: RRR) -> None:
        coupler, rocker = self.motion.sides[step.name]
        self.act_about(coupler)
        self.act_about(rocker)
        self.solve(step.name, rrr.forces())
        self.meet(coupler.role, rocker.role, step.pin)
        for side in (coupler, rocker):
            if side.role in self.topology.struts:
                cylinders.force_strut(self, side, step.pin, f"push_{side.role}_{step.pin}")
        self.push(coupler)
        self.release(rocker)

    def _force_RRP(self, step: RRP) -> None:
        self.act_about(step.link)
        self.act(step.slider)
        self.contact(step, rrp, (step.guide, rrp.CONTACT, "ratio_slider"))
        self.meet(step.link.role, step.slider, step.pin)
        if step.link.role in self.topology.struts:
            cylinders.force_strut(self, step.link, step.pin, f"push_{step.link.role}_{step.pin}")
        self.push(step.link)
        self.slide(step.slider, step.guide, f"hold_{step.slider}", step.name, rrp.CONTACT)

    def _crank(self) -> None:
        role = self.topology.crank
        self.act(role)
        pivot = self.topology.ground[0]
        for axis in "xy":
            self.row(planar.identity, (f"push_{role}_{pivot}{axis}",), f"acting2{axis}")
        self.push(Side(role, pivot))

    def _drive(self, drive: Drive) -> None:
        """Apply the torque or force of the drive to its links."""
        if drive.name in self.topology.cylinders:
            cylinders.drive_by_cylinder(self, drive.name)
        else:
            self.applied[drive.name].append(("", drive.unknown.name))

    # ------------------------------------------------------------------------------------------------ actions

    def solve(self, name: str, rows: Rows, status: str = "closure") -> None:
        """Add the rows of a dyad's forces, and its status."""
        names = self.motion.names[name]
        self.rows += names.placed(rows)
        self.statuses.append((str(names["closure"]), str(names[status])))

    def contact(self, step: Step, dyad: ModuleType, *slides: tuple[str, Slide, str]) -> None:
        """Add the rows of a dyad with slides, each by its guide and the name of its velocity per rate of the crank."""
        if self.coupled(step):
            self.solve(step.name, dyad.forces_from_friction())
        else:
            self.solve(step.name, dyad.forces(), "jam_status")
        for guide, slide, ratio in slides:
            self._rub(step, guide, slide, ratio)

    def _is_coupled(self) -> bool:
        """Return whether the drive loads a slide that rubs, or a cylinder of given length."""
        rubs = any(guide in self.rubbing for step in self.bearing for guide in step.slides)
        return rubs or any(role in self.topology.struts for step in self.bearing for role in step.roles)

    def coupled(self, step: Step) -> bool:
        """Return whether the friction of a dyad's slides is found together with the drive."""
        return self.coupling is not None and step in self.bearing

    def _rub(self, step: Step, guide: str, slide: Slide, ratio: str) -> None:
        """Add the work of a slide's friction, and the power that it loses."""
        names = self.motion.names[step.name]
        normal, friction, direction = (str(names[own]) for own in (slide.normal, slide.friction, slide.acts[0]))
        self.directions[guide] = direction
        self.losses.append(str(names[slide.power]))
        if step not in self.bearing:
            self.row(planar.product, (f"work_of_{friction}",), names[ratio], friction)
            self.work.append(f"work_of_{friction}")
        elif self.coupling is not None and guide in self.rubbing:
            self.coupling.rubs.append(Rub(normal, friction, direction, f"{guide}_friction", names[ratio]))
            self.statuses[-1] = (self.statuses[-1][0], JAM)
        elif self.coupling is not None:
            self.row(planar.identity, (friction,), 0.0)

    def act(self, role: str) -> None:
        """Add up all that acts on a link: force acting3, and moment L3 about its first pin; nothing acts on a strut."""
        if role in self.topology.struts:
            return
        k = self.motion.number(role)
        for axis in "xy":
            terms = (f"{force}{axis}" for force, _ in self.applied[role] if force)
            self.rows.append(Total(f"acting{k}{axis}", (f"Q{k}{axis}", *terms)))
        self.rows.append(Total(f"L{k}", (f"N{k}", *(moment for _, moment in self.applied[role]))))

    def act_about(self, side: Side) -> None:
        """Add up all that acts on a link, also its moment about a known pin."""
        self.act(side.role)
        if side.role in self.topology.struts:
            return
        k, arm = self.motion.number(side.role), self.motion.arm(side.role, side.pin)
        self.row(planar.moment_about, (f"L{k}_{side.pin}",), f"L{k}", *arm, *xy(f"acting{k}"))

    def push(self, side: Side) -> None:
        """Apply the force of a link on a pin, push_rod_B, to the link that supports the pin."""
        push, host = f"push_{side.role}_{side.pin}", self.topology.support[side.pin]
        self.pushes[side.pin][side.role] = push
        self.apply(host, push, self.motion.arm(host, side.pin) if host != GROUND else (0.0, 0.0))

    def release(self, side: Side) -> None:
        """Reverse the force of a pin on a link, and apply it to the link that supports the pin."""
        self.opposite(f"push_{side.role}_{side.pin}", f"hold_{side.role}")
        self.push(side)

    def opposite(self, stem: str, of: str) -> None:
        for axis in "xy":
            self.row(planar.opposite, (f"{stem}{axis}",), f"{of}{axis}")

    def apply(self, host: str, force: str, arm: tuple[Source, Source], *moments: str) -> None:
        """Apply a force to a link, at an arm from its first pin, and further moments."""
        if host == GROUND:
            return
        self.row(planar.cross, (f"moment_{force}",), *arm, *xy(force))
        self.rows.append(Total(f"moments_{force}", (f"moment_{force}", *moments)))
        self.applied[host].append((force, f"moments_{force}"))

    def meet(self, one: str, other: str, pin: str) -> None:
        """State the force between two links at a dyad's pin as a push of either: push_rod_C, push_rocker_C."""
        if self.topology.support[pin] == other:
            self.opposite(f"push_{one}_{pin}", f"push_{other}_{pin}")
            self.pushes[pin][one] = f"push_{one}_{pin}"
        else:
            self.pushes[pin][other] = f"push_{other}_{pin}"

    def slide(
        self, slider: str, guide: str, hold: str, name: str, slide: Slide, arm: tuple[str, str] = ("OCx", "OCy")
    ) -> None:
        """Apply a slider's force to its guide, at an arm from the guide's origin, with the moment about its pin."""
        host, names, react = self.topology.hosts[guide], self.motion.names[name], f"push_{slider}_{guide}"
        if host != GROUND:
            self.opposite(react, hold)
            self.row(planar.opposite, (f"react_{slider}",), names[slide.moment])
            self.apply(host, react, (names[arm[0]], names[arm[1]]), f"react_{slider}")
        self.between(host, slider, hold, name, slide)

    # ------------------------------------------------------------------------------------------------ joints

    def _pin(self, pin: str, carrier: str, *others: str) -> None:
        """Add rows of the forces between the first link that shares a pin, which carries it, and each other."""
        support, pushes = self.topology.support[pin], self.pushes[pin]
        for role in others:
            name = name_between("F", *self.topology.pair(carrier, role))
            for axis in "xy":
                if role == support:
                    terms = tuple(f"{push}{axis}" for push in pushes.values())
                    self.rows.append(Total(f"borne_{name}{axis}", terms))
                    self.row(planar.opposite, (f"{name}{axis}",), f"borne_{name}{axis}")
                else:
                    turn = planar.opposite if carrier == GROUND else planar.identity
                    self.row(turn, (f"{name}{axis}",), f"{pushes[role]}{axis}")

    def between(self, one: str, other: str, force: str, name: str, slide: Slide) -> None:
        """Add rows of the force of one link on another in a slide: of the ground, or else of the later link."""
        i, j = self.topology.pair(one, other)
        same = planar.identity if i == self.motion.number(one) else planar.opposite
        names, stem = self.motion.names[name], name_between("F", i, j)
        inner = (f"{force}x", f"{force}y", *(str(names[part]) for part in slide[:3] if part))
        outer = (f"{stem}x", f"{stem}y", f"{stem}n", f"{stem}t", name_between("T", i, j))
        for out, into in zip(outer, inner, strict=False):
            if out != into:
                self.row(same, (out,), into)
        self.contacts.append(Contact((i, j), *(names[own] for own in (slide.normal, *slide.acts))))
