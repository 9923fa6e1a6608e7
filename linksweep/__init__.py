"""linksweep: how hard are my pins loaded, and where is the worst of it?"""

from linksweep.mechanisms import FourBar, InvertedSliderCrank, LoopTrack, SliderCrank
from linksweep.mechanisms.links import Bar, Disk, Link
from linksweep.results.balancing import Counterweight, counterweights, with_counterweights
from linksweep.results.bearings import Bearing, bearings, load_spectrum
from linksweep.results.best_balance import best_counterweights
from linksweep.results.breakdown import breakdown
from linksweep.results.check import check
from linksweep.results.compare import compare
from linksweep.results.cylinders import MultiCylinder
from linksweep.results.duty import duty
from linksweep.results.flywheel import flywheel
from linksweep.results.geometry import coupler_curve, geometry
from linksweep.results.motor import Motor, motor_load
from linksweep.results.objective import objective
from linksweep.results.orders import orders
from linksweep.results.pareto import pareto
from linksweep.results.peaks import peaks
from linksweep.results.pin_friction import pin_friction
from linksweep.results.position_equation import position_equation
from linksweep.results.regressor import regressor
from linksweep.results.shaking import shaking_moment
from linksweep.results.speed_limit import speed_limit, speed_separation
from linksweep.results.sweep import sweep
from linksweep.results.system import system
from linksweep.scene.air_cycle import DieselCycle, OttoCycle
from linksweep.scene.examples import example
from linksweep.scene.gas_pressure import GasPressure
from linksweep.scene.interpolation import OvershootWarning
from linksweep.scene.loads import Load
from linksweep.scene.sample import sample
from linksweep.scene.scene import Scene
from linksweep.scene.spread import Normal, Tolerance
from linksweep.scene.springs import Damper, Spring, TorsionDamper, TorsionSpring
from linksweep.surface import accessor as _accessor  # noqa: F401  (registers Dataset.linksweep)
from linksweep.surface import plot
from linksweep.surface.checked import open_study
from linksweep.surface.page import report
from linksweep.surface.scene_at import scene_at
from linksweep.surface.storage import load_scene, save
from linksweep.surface.study import study

__all__ = [
    "Bar",
    "Bearing",
    "Counterweight",
    "Damper",
    "DieselCycle",
    "Disk",
    "FourBar",
    "GasPressure",
    "InvertedSliderCrank",
    "Link",
    "Load",
    "LoopTrack",
    "Motor",
    "MultiCylinder",
    "Normal",
    "OttoCycle",
    "OvershootWarning",
    "Scene",
    "SliderCrank",
    "Spring",
    "Tolerance",
    "TorsionDamper",
    "TorsionSpring",
    "bearings",
    "best_counterweights",
    "breakdown",
    "check",
    "compare",
    "counterweights",
    "coupler_curve",
    "duty",
    "example",
    "flywheel",
    "geometry",
    "load_scene",
    "load_spectrum",
    "motor_load",
    "objective",
    "open_study",
    "orders",
    "pareto",
    "peaks",
    "pin_friction",
    "plot",
    "position_equation",
    "regressor",
    "report",
    "sample",
    "save",
    "scene_at",
    "shaking_moment",
    "speed_limit",
    "speed_separation",
    "study",
    "sweep",
    "system",
    "with_counterweights",
]
