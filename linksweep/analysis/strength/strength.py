"""strength(scene): the worst stress of each link over the exact cycle, and its safety against yield, fatigue, buckling.

Peaks over the cycle are exact at each section. The worst section is sought among 41 and those on either side of third
pins and loads, then among 3 × 15 more, between the neighbours of the sections worst by stress, Goodman and Soderberg.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from linksweep.analysis.strength.criteria import buckling_load, fatigue_safety, mean_and_amplitude
from linksweep.analysis.strength.fatigue import life
from linksweep.analysis.strength.material import Material
from linksweep.base.checked_number import checked_number
from linksweep.base.validate import Number, Rule, choice_problems, name_problems, quote, refuse
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import requested, require, require_one_branch, require_scene
from linksweep.results.dataset import design_coordinates, flags, joined, provenance, with_units
from linksweep.results.peaks import peaks
from linksweep.scene.at_sections import COUNT, marks
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.dimensions import argument_problems
from linksweep.scene.scene import Scene

FIBRES, ENDS = ("left", "right"), ("max", "min")
PLANES = ("motion", "across")
PLACE, FIBRE, END = "_place", "_fibre", "_end"
"""Dims of the sections at which peaks are computed, and of the fibres and the extremes of their stress."""
FINE, WITHIN = 15, 1e-9
"""Sections between the neighbours of the worst of the others, and their least share from the pins at the ends."""
FACTOR = Rule("dimensionless", above=0.0)
CONCENTRATION = Rule("dimensionless", at_least=1.0)
TEXTS = {
    "stress": ("Pa", "largest size of the normal stress in the link"),
    "stress_section": ("1", "place of the largest stress, as a share of the way between the link's ends"),
    "stress_at": ("degree", "crank angle of the largest stress"),
    "yield_safety": ("1", "yield strength over the largest stress"),
    "fatigue_section": ("1", "place of the least safety against fatigue by Goodman"),
    "stress_mean": ("Pa", "mean of the cycle of stress at that place, positive in tension"),
    "stress_amplitude": ("Pa", "amplitude of the cycle of stress at that place"),
    "goodman_safety": ("1", "least safety against fatigue by Goodman"),
    "soderberg_safety": ("1", "least safety against fatigue by Soderberg"),
    "compression": ("N", "largest axial compression of the link, 0 where it is never pressed"),
    "compression_at": ("degree", "crank angle of the largest compression"),
    "buckling_load": ("N", "load at which the link buckles, by Euler and Johnson"),
    "buckling_safety": ("1", "buckling load over the largest compression"),
}
TEXTS_OF_LIFE = {
    "stress_cycles": ("1", "closed cycles of stress in a cycle of motion, where fatigue is worst"),
    "damage": ("1", "damage of a cycle of motion by Miner's rule, where fatigue is worst"),
    "life": ("1", "number of cycles of motion until the damage is 1, inf where none damages"),
}
"""Results where some material has a slope."""


@limits_threads
def strength(
    scene: Scene,
    material: Material | Mapping[str, Material],
    *,
    links: str | Iterable[str] | None = None,
    stress_concentration: Number = 1.0,
    effective_length: tuple[Number, Number] = (1.0, 1.0),
    threads: int | None = None,
) -> xr.Dataset:
    """Compute the worst stress of each link over the cycle, and its safety against yield, fatigue and buckling.

    Parameters
    ----------
    scene : Scene
        Scene of a machine with links that are beams: a Bar, or a Link with a section, whose pins lie in one line.
    material : Material or mapping of str to Material
        Material of all links, or of each by role.
    links : str or iterable of str, default None
        Roles of links; None for all that are beams.
    stress_concentration : float or DataArray, default 1.0
        Factor on the nominal stress in sections through pins, for their eyes [1].
    effective_length : pair of float or DataArray, default (1.0, 1.0)
        Effective lengths for buckling in and across the plane of motion, per length between the outer pins [1]. Pins
        are hinges in the plane; across it, stiff forks may hold the ends, down to 0.5.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        Results over `link` and the design dims:

        - `stress` [Pa], `stress_section` [1] and `stress_at` [degree]: the largest, its place and its crank angle;
          `yield_safety` [1]
        - `goodman_safety` and `soderberg_safety` [1], each the least of all sections and of both fibres; `stress_mean`
          and `stress_amplitude` [Pa] at the place of the former, `fatigue_section` [1]
        - `compression` [N], `compression_at` [degree], and over `plane` ("motion", "across") `buckling_load` [N] and
          `buckling_safety` [1], inf for a link that is never pressed; NaN for a Section without second moments
        - where a material has a slope: `stress_cycles` [1], the closed cycles of stress in a cycle of motion at the
          place of `goodman_safety`, their `damage` [1] by Miner's rule, and the `life` [1] in cycles of motion, inf
          where that safety is at least 1; NaN of a link that does not move at all crank angles
        - `status` as in `linksweep.peaks`.

    Raises
    ------
    ValueError
        If a link is no beam, none is, a number is out of bounds, arrays over one dim differ in length or labels, or
        branch="both".
    ImportError
        If a material has a slope and rainflow, which counts cycles, is not installed.

    Notes
    -----
    Stress is that of extreme fibres, N/A ± M/W; shear, which is 0 there, is left out. A cycle of stress has its exact
    extremes as ends. Criteria and sources: `linksweep.analysis.strength.criteria`, and `fatigue` beside it.

    Examples
    --------
    >>> import linksweep as ls
    >>> print(ls.strength(ls.example("press"), ls.material("S235"), stress_concentration=2.5).linksweep)
    link     stress [MPa]  at [%]  at [°]  yield  Goodman  Soderberg  buckling
    crank           40.31     0.0   185.4  5.830    4.538      4.506     507.6
    coupler         14.84    43.9    32.9  15.84    18.40      14.43     263.2
    rocker          24.83     0.0    19.0  9.463    15.26      10.31     244.8
    """
    require_scene(scene)
    roles = beams_of(scene, links)
    require_one_branch(scene)
    materials = materials_of(roles, material)
    factor = checked_number("stress_concentration", stress_concentration, CONCENTRATION)
    pair = isinstance(effective_length, tuple | list) and len(effective_length) == len(PLANES)
    refuse([] if pair else [f"effective_length = {quote(effective_length)}: must be two, in and across the plane"])
    lengths = [checked_number(f"effective_length[{k}]", one, FACTOR) for k, one in enumerate(effective_length, 1)]
    own = {"material": material, "stress_concentration": factor, "effective_length": lengths}
    refuse(argument_problems(scene.arrays, **own))
    scene = in_memory(scene)
    parts = [_Link(scene, role, materials[role], factor).results(lengths) for role in roles]
    statuses = [part.pop("status") for part in parts]
    texts = TEXTS | (TEXTS_OF_LIFE if any("life" in part for part in parts) else {})
    described = with_units(
        {name: (joined([part.get(name, np.nan) for part in parts], "link", roles), *texts[name]) for name in texts}
    )
    status = joined(statuses, "link", roles).max("link").astype(np.int8)
    words = flags(scene.mechanism.round_trip, scene.mechanism.round_meanings)
    bare = replace(scene, section=None)
    coordinates = design_coordinates(bare)
    attributes = provenance(bare, "linksweep.strength(scene, ...)", coordinates)
    return xr.Dataset({**described, "status": status.assign_attrs(words)}, coordinates, attributes)


class _Link:
    """A link that is a beam, with its material: its peaks along its sections, and what they mean."""

    def __init__(self, scene: Scene, role: str, material: Material, factor: Number) -> None:
        self.scene, self.role, self.material, self.factor = scene, role, material, factor
        self.k, self.part = 2 + scene.mechanism.roles.index(role), scene.mechanism.parts[role]
        self.names = [f"stress{self.k}_{fibre}" for fibre in FIBRES]

    def results(self, factors: list[Number]) -> dict[str, Any]:
        """Return the results of the link by name, and its status."""
        coarse = self._peaks(*self._sections())
        fatigue = (-safety.min(FIBRE) for safety in self._safeties(coarse))
        fine = [self._about(rank) for rank in (self._size(coarse).max((FIBRE, END)), *fatigue)]
        close = self._peaks(_in_a_row(fine), xr.DataArray(1.0))
        ds = xr.Dataset({name: _in_a_row([coarse[name], close[name]]) for name in coarse if name != "status"})
        status = coarse["status"]
        worst = status.max([dim for dim in status.dims if dim == PLACE])  # a stress may be unbounded at some sections
        return {**self._stress(ds), **self._fatigue(ds), **self._buckling(ds, factors), "status": worst}

    def _sections(self) -> tuple[xr.DataArray, xr.DataArray]:
        """Return sections from end to end and through all pins, and the factors on their stresses."""
        at_forces = [xr.DataArray(share).expand_dims(PLACE) for share in marks(self.scene, self.role)]
        row = _in_a_row([xr.DataArray(np.linspace(0.0, 1.0, COUNT), dims=PLACE), *at_forces])
        third = self.scene.mechanism.third_pins_along(self.role)
        at_pins = [0, COUNT - 1, *(range(COUNT, COUNT + 2 * (2 + len(third))) if third else ())]
        through_pin = xr.DataArray(np.isin(np.arange(row.sizes[PLACE]), at_pins), dims=PLACE)
        return row, xr.where(through_pin, self.factor, 1.0)

    def _about(self, rank: xr.DataArray) -> Any:
        """Return sections between the neighbours of the one that ranks first, of each design; none through end pins."""
        first = rank.isel({PLACE: slice(COUNT)}).fillna(-np.inf).argmax(PLACE) / (COUNT - 1.0)
        steps = xr.DataArray(np.linspace(-1.0, 1.0, FINE), dims=PLACE) / (COUNT - 1.0)
        return np.clip(first + steps, WITHIN, 1.0 - WITHIN)

    def _peaks(self, share: xr.DataArray, factor: xr.DataArray) -> xr.Dataset:
        """Return the extremes of both fibres' stress, and the largest compression, at some sections."""
        section = share.transpose(..., PLACE)
        force = f"axial_force{self.k}"
        ds = peaks(replace(self.scene, section=section), of=[*self.names, force])
        ds = ds.drop_vars(ds.coords)
        stress, angle = (self._of_fibres(ds, ends) for ends in (ENDS, tuple(f"{end}_at" for end in ENDS)))
        results = {"stress": stress * factor, "angle": angle, "axial": ds[f"{force}_min"], "at": ds[f"{force}_min_at"]}
        whole = {
            name: values.broadcast_like(section)
            for name, values in {**results, "share": section, "factor": factor}.items()
        }
        return xr.Dataset(whole).assign(status=ds["status"])

    def _of_fibres(self, ds: xr.Dataset, ends: tuple[str, ...]) -> xr.DataArray:
        """Return extremes of both fibres' stress, or their angles, over the dims of fibres and extremes."""
        rows = (joined([ds[f"{name}_{end}"] for name in self.names], FIBRE, FIBRES) for end in ends)
        return joined(rows, END, ENDS)

    def _size(self, ds: xr.Dataset) -> xr.DataArray:
        return abs(ds["stress"])

    def _cycle(self, ds: xr.Dataset) -> tuple[xr.DataArray, xr.DataArray]:
        """Return mean and amplitude of both fibres' stress."""
        largest, least = (ds["stress"].isel({END: k}) for k in range(2))
        return mean_and_amplitude(largest, least)

    def _safeties(self, ds: xr.Dataset) -> tuple[xr.DataArray, xr.DataArray]:
        """Return the safeties of each fibre by Goodman and by Soderberg."""
        (mean, amplitude), steel = self._cycle(ds), self.material
        goodman = fatigue_safety(mean, amplitude, steel.endurance, steel.tensile_strength)
        soderberg = fatigue_safety(mean, amplitude, steel.endurance, steel.yield_strength)
        return goodman, soderberg

    def _stress(self, ds: xr.Dataset) -> dict[str, xr.DataArray]:
        """Return the largest stress, its place and its angle."""
        stress, at, share = _at_largest(self._size(ds), ds["angle"], ds["share"])
        with np.errstate(divide="ignore"):
            safety = self.material.yield_strength / stress
        place = share.where(stress.notnull())
        return {"stress": stress, "stress_at": at, "stress_section": place, "yield_safety": safety}

    def _fatigue(self, ds: xr.Dataset) -> dict[str, xr.DataArray]:
        """Return the least safeties, and the cycle of stress where that by Goodman is least."""
        mean, amplitude = self._cycle(ds)
        goodman, soderberg = self._safeties(ds)
        fibre = xr.DataArray(np.arange(len(FIBRES)), dims=FIBRE)
        places = mean, amplitude, ds["share"], ds["factor"], fibre
        with np.errstate(divide="ignore"):
            danger, mean, amplitude, share, factor, fibre = _at_largest(1.0 / goodman, *places)
            (other,) = _at_largest(1.0 / soderberg)
        results = {"fatigue_section": share.where(danger.notnull()), "stress_mean": mean, "stress_amplitude": amplitude}
        if self.material.slope is not None:
            ends = {"largest": mean + amplitude, "least": mean - amplitude}
            place = xr.Dataset({"share": share, "factor": factor, "fibre": fibre, **ends})
            results |= life(self.scene, (self.names[0], self.names[1]), place, self.material)
        with np.errstate(divide="ignore"):
            return results | {"goodman_safety": 1.0 / danger, "soderberg_safety": 1.0 / other}

    def _buckling(self, ds: xr.Dataset, factors: list[Number]) -> dict[str, Any]:
        """Return the largest compression, and the buckling load in both planes."""
        pressed, at = _at_largest(-ds["axial"], ds["at"])
        compression = np.maximum(pressed, 0.0)
        section, steel, numbers = self.part.section, self.material, self.scene.mechanism.beam_numbers()
        span = numbers[f"{self.role}_beam_end"] - numbers[f"{self.role}_beam_start"]
        loads = []
        for moment, factor in zip((section.second_moment, section.second_moment_across), factors, strict=True):
            known = np.nan if moment is None else moment
            length = factor * span
            loads.append(buckling_load(section.area, xr.DataArray(known), length, steel.E, steel.yield_strength))
        load = joined(loads, "plane", PLANES)
        with np.errstate(divide="ignore"):
            safety = load / compression
        results = {"compression": compression, "compression_at": at.where(compression > 0.0)}
        return results | {"buckling_load": load, "buckling_safety": safety}


def _at_largest(size: xr.DataArray, *others: xr.DataArray) -> tuple[xr.DataArray, ...]:
    """Return the largest over sections, fibres and ends, and the values of other arrays there."""
    over = [dim for dim in (PLACE, FIBRE, END) if dim in size.dims]
    arrays = (array.drop_vars(array.coords) for array in xr.broadcast(size, *others))
    rows = [array.stack(every=over, create_index=False) for array in arrays]
    first = rows[0].fillna(-np.inf).argmax("every")
    return tuple(row.isel(every=first) for row in rows)


def _in_a_row(parts: list[xr.DataArray]) -> xr.DataArray:
    """Return arrays one after the other along the sections, each broadcast over the other dims of all."""
    firsts = [part.isel({PLACE: 0}, drop=True) for part in parts]
    shape = xr.broadcast(*firsts)[0]
    return xr.concat([part.broadcast_like(shape) for part in parts], PLACE, join="override")


def beams_of(scene: Scene, links: Any) -> list[str]:
    """Return the roles of the links asked for; ValueError where one is no beam, or there are none."""
    require(scene, "bodies")
    machine, kind = scene.mechanism, type(scene.mechanism).__name__
    roles = list(machine.beams) if links is None else requested("links", links)
    refuse([] if roles or links is None else [f"links = {quote(links)}: names no link; leave it out for all"])
    refuse([problem for role in roles for problem in name_problems("links", role, machine.roles)])
    reasons = {role: machine.beam_problem(role) for role in (roles or machine.roles)}
    refuse([f"links: {role} of this {kind} is no beam: {reason}" for role, reason in reasons.items() if reason])
    return roles


def materials_of(roles: list[str], material: Any) -> dict[str, Material]:
    """Return the material of each link."""
    by_role = material if isinstance(material, Mapping) else dict.fromkeys(roles, material)
    wrong = {role: item for role, item in by_role.items() if not isinstance(item, Material)}
    example = 'must be a Material, such as ls.material("S355")'
    refuse([f"material = {quote(item)}: {example}" for item in [*wrong.values()][:1]])
    refuse([problem for role in by_role for problem in choice_problems("material", role, roles)])
    missing = [role for role in roles if role not in by_role]
    refuse([f"material: none for {', '.join(missing)}; {example}"] if missing else [])
    return dict(by_role)
