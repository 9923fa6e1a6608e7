"""Public names, and the modules that define them: `linksweep/__init__.py` imports each when it is first used."""

from linksweep import plot
from linksweep.analysis.balance.best_counterweights import best_counterweights
from linksweep.analysis.balance.compare import compare
from linksweep.analysis.balance.counterweights import Counterweight, counterweights, with_counterweights
from linksweep.analysis.balance.orders import orders
from linksweep.analysis.balance.regressor import regressor
from linksweep.analysis.balance.shaking import shaking_moment
from linksweep.analysis.design.geometry import coupler_curve, geometry
from linksweep.analysis.design.objective import objective
from linksweep.analysis.design.pareto import pareto
from linksweep.analysis.design.sensitivities import sensitivities
from linksweep.analysis.design.tolerance import tolerance
from linksweep.analysis.drive.duty import duty
from linksweep.analysis.drive.flywheel import flywheel
from linksweep.analysis.drive.in_time.run_down import run_down
from linksweep.analysis.drive.in_time.run_up import run_up
from linksweep.analysis.drive.motor_load import motor_load
from linksweep.analysis.drive.motors.curve import Motor
from linksweep.analysis.drive.motors.direct_current import DCMotor
from linksweep.analysis.drive.motors.governed import GovernedMotor
from linksweep.analysis.drive.motors.induction import InductionMotor
from linksweep.analysis.drive.steady_cycle import steady_cycle
from linksweep.analysis.pins.bearing import Bearing
from linksweep.analysis.pins.bearings import bearings, load_spectrum
from linksweep.analysis.pins.breakdown import breakdown
from linksweep.analysis.pins.choose_bearings import choose_bearings
from linksweep.analysis.pins.contact_loss import contact_loss
from linksweep.analysis.pins.pin_friction import pin_friction
from linksweep.analysis.pins.speed_limit import speed_limit, speed_separation
from linksweep.analysis.strength.links import size_links
from linksweep.analysis.strength.material import Material, material
from linksweep.analysis.strength.pins import size_pins
from linksweep.analysis.strength.strength import strength
from linksweep.explorer.explore import explore
from linksweep.files.netcdf import load_scene, save
from linksweep.files.pmks.from_pmks import NotCarriedOverWarning, from_pmks
from linksweep.mechanisms import FourBar, InvertedSliderCrank, Linkage, LoopTrack, SliderCrank
from linksweep.mechanisms.beams.sections import IBeam, Section, Tube
from linksweep.mechanisms.links import Bar, Cylinder, Disk, Gears, Guide, Link, Slider
from linksweep.plot.sheets.save_drawing import save_drawing
from linksweep.reports.page import report
from linksweep.results.check import check
from linksweep.results.cylinders.multi_cylinder import MultiCylinder
from linksweep.results.peaks import peaks
from linksweep.results.position_equation import position_equation
from linksweep.results.quantities import QuantityTable, quantities
from linksweep.results.sweep import sweep
from linksweep.results.system import system
from linksweep.scene.curves.interpolation import OvershootWarning
from linksweep.scene.designs.combinations import grid
from linksweep.scene.designs.distributions import Normal, Tolerance
from linksweep.scene.designs.drawing import draw
from linksweep.scene.designs.sampling import sample
from linksweep.scene.examples import example
from linksweep.scene.loads.air_cycle import DieselCycle, OttoCycle
from linksweep.scene.loads.kinds import Damper, GasPressure, Load, Spring, TorsionDamper, TorsionSpring
from linksweep.scene.scene import Scene
from linksweep.scene.shown_units import units
from linksweep.studies.checked import open_study
from linksweep.studies.scene_at import scene_at
from linksweep.studies.screen import screen
from linksweep.studies.study import study

__version__: str

__all__ = [
    "Bar",
    "Bearing",
    "Counterweight",
    "Cylinder",
    "DCMotor",
    "Damper",
    "DieselCycle",
    "Disk",
    "FourBar",
    "GasPressure",
    "Gears",
    "GovernedMotor",
    "Guide",
    "IBeam",
    "InductionMotor",
    "InvertedSliderCrank",
    "Link",
    "Linkage",
    "Load",
    "LoopTrack",
    "Material",
    "Motor",
    "MultiCylinder",
    "Normal",
    "NotCarriedOverWarning",
    "OttoCycle",
    "OvershootWarning",
    "QuantityTable",
    "Scene",
    "Section",
    "Slider",
    "SliderCrank",
    "Spring",
    "Tolerance",
    "TorsionDamper",
    "TorsionSpring",
    "Tube",
    "bearings",
    "best_counterweights",
    "breakdown",
    "check",
    "choose_bearings",
    "compare",
    "contact_loss",
    "counterweights",
    "coupler_curve",
    "draw",
    "duty",
    "example",
    "explore",
    "flywheel",
    "from_pmks",
    "geometry",
    "grid",
    "load_scene",
    "load_spectrum",
    "material",
    "motor_load",
    "objective",
    "open_study",
    "orders",
    "pareto",
    "peaks",
    "pin_friction",
    "plot",
    "position_equation",
    "quantities",
    "regressor",
    "report",
    "run_down",
    "run_up",
    "sample",
    "save",
    "save_drawing",
    "scene_at",
    "screen",
    "sensitivities",
    "shaking_moment",
    "size_links",
    "size_pins",
    "speed_limit",
    "speed_separation",
    "steady_cycle",
    "strength",
    "study",
    "sweep",
    "system",
    "tolerance",
    "units",
    "with_counterweights",
]
