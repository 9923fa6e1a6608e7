"""Write the report of an engine of several cylinders: how they stand, peaks, drive, mains, figures."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import xarray as xr

from linksweep.analysis.drive.duty import cycle_problems, duty
from linksweep.analysis.drive.flywheel import flywheel
from linksweep.analysis.pins.bearings import bearings
from linksweep.base.validate import refuse
from linksweep.plot.curves import STYLES
from linksweep.reports import scene_tables
from linksweep.reports import tables as page_tables
from linksweep.reports.figures import SIZE, Picture, legend_below, of_shaking, pictures
from linksweep.reports.markup import NONE, Markup, angle, joined, section, symbol, table, tag, tiny
from linksweep.reports.results_of_page import fluctuations
from linksweep.reports.units_of_page import distance, measure
from linksweep.results.cylinders.multi_cylinder import SHAKING, MultiCylinder
from linksweep.results.origin.in_shown_units import in_shown_units
from linksweep.results.peaks import peaks
from linksweep.scene.designs.choose import design_labels
from linksweep.scene.shown_units import UnitSystem, shown_units

SIGNS = "Angles and torques count counter-clockwise, from x; z points towards the viewer."
HINGED = "The crankshaft is taken as hinged at every main bearing (lever rule)."
CANCELLED = 10.0
"""Of its bound: a peak below is the rounding of what cancels."""
PINS = ("F12", "F32", "F43")
MAIN = ("main_position", "F_peak", "F_peak_at", "equivalent_load")
SIGNALS = [name for name in SHAKING if name not in ("Fsx", "Fsy")]


def parts_of(machine: MultiCylinder) -> dict[str, Any]:
    """Return the parts of the page of an engine of one design."""
    engine = machine.engine
    if design_labels(engine):
        refuse(["engine: has several designs, and a report shows one; give one"])
    refuse(cycle_problems(engine))
    worst = peaks(machine, of=[*SIGNALS, *(f"{name}_bound" for name in SIGNALS), *PINS])
    refuse([] if int(worst["status"]) == 0 else ["engine: must run all the way round; ls.check tells where it ends"])
    mains = bearings(machine) if machine.mains else None
    cylinders = section("Cylinders", _cylinders(machine, worst))
    return {
        "kind": f"{len(machine.crank_angles)} cylinders",
        "warnings": "",
        "machine": section("One cylinder", scene_tables.links(engine), scene_tables.loads(engine)),
        "left": joined(cylinders, section("Peaks of all together", _peaks(machine, worst))),
        "right": joined(
            section("Motion", scene_tables.settings(engine)),
            section("Drive", _drive(machine)),
            section("Main bearings", _mains(mains, _system(machine)), tag("p", HINGED, class_="note"))
            if mains is not None
            else Markup(),
        ),
        "figures": pictures(_figures(machine, mains)),
        "more": "",
        "signs": SIGNS,
        "explore": "",
        "scene": engine.to_toml(),
    }


def _cylinders(machine: MultiCylinder, worst: xr.Dataset) -> Markup:
    header = ("", "crank ahead", "bank", "place", *(symbol(name) for name in PINS))
    standing = zip(machine.crank_angles, machine.bank_angles, machine.positions, strict=True)
    rows = []
    for k, (ahead, bank, z) in enumerate(standing):
        forces = (measure(float(worst[f"{name}_peak"][k]), "N", _system(machine)) for name in PINS)
        rows.append((str(k + 1), angle(ahead), angle(bank), distance(z, _system(machine)), *forces))
    return table(header, rows, class_="numbers")


def _peaks(machine: MultiCylinder, worst: xr.Dataset) -> Markup:
    rows: list[tuple[Any, ...]] = []
    for name in SIGNALS:
        quantity, bound = machine.quantity[name], float(worst[f"{name}_bound"])
        in_unit = partial(measure, unit=quantity.units, system=_system(machine))
        ends = {"_max": ", largest", "_min": ", least"} if f"{name}_max" in worst else {"_peak": ""}
        what = quantity.long_name.split(",")[0].split(" of all")[0].split(" of the drive")[0]
        for end, words in ends.items():
            value, at = float(worst[name + end]), float(worst[f"{name}{end}_at"])
            known = abs(value) > CANCELLED * bound
            rounding = tiny(float(_system(machine).value(bound, quantity.units)))
            cells = (in_unit(value if known else 0.0), angle(at) if known else NONE, rounding)
            rows.append((symbol(name), tag("span", what + words, title=quantity.long_name), *cells))
    return table(("", "", "peak", "at θ₂", "bound"), rows, class_="peaks")


def _drive(machine: MultiCylinder) -> Markup:
    work = duty(machine)
    wheels = flywheel(machine, fluctuation=fluctuations())
    system = _system(machine)
    torque = "mean torque", measure(float(work["effort_mean"]), "N m", system)
    rows = [torque, *page_tables.works(work, system), *page_tables.flywheels(wheels, system)]
    return table((), rows, class_="numbers")


def _system(machine: MultiCylinder) -> UnitSystem:
    return shown_units(machine.engine.units)


def _mains(loads: xr.Dataset, system: UnitSystem) -> Markup:
    header = ("", "place", "largest load", "at θ₂", "equivalent load")
    rows = []
    for name in loads["main"].values:
        place, most, at, mean = (float(loads[key].sel(main=name)) for key in MAIN)
        forces = measure(most, "N", system), angle(at), measure(mean, "N", system)
        rows.append((str(name), distance(place, system), *forces))
    return table(header, rows, class_="numbers")


def _figures(machine: MultiCylinder, mains: xr.Dataset | None) -> Iterator[Picture]:
    cycle, system = machine.sweep(), _system(machine)
    torque = in_shown_units(cycle[["T12"]], system)["T12"]
    yield Picture("Torque of all cylinders", SIZE, partial(_over_angle, [torque], f"torque [{system.unit('N m')}]"))
    if mains is not None:
        forces = in_shown_units(mains, system)["F"]
        loads = [forces.sel(main=name) for name in mains["main"].values]
        yield Picture("Loads of the main bearings", SIZE, partial(_over_angle, loads, f"force [{system.unit('N')}]"))
    yield from of_shaking(cycle)


def _over_angle(signals: list[xr.DataArray], label: str, ax: Any) -> None:
    for k, signal in enumerate(signals):
        color, dashes = STYLES[k % len(STYLES)]
        main = str(signal.coords["main"].item()) if "main" in signal.coords else None
        ax.plot(signal["theta2"], signal, color=color, linestyle=dashes, label=main)
    ax.set(xlabel="crank angle θ₂ [°]", ylabel=label)
    ax.margins(x=0.0)
    if len(signals) > 1:
        legend_below(ax)
