"""linksweep: how hard are my pins loaded, and where is the worst of it?"""

from linksweep.mechanisms import FourBar, InvertedSliderCrank, LoopTrack, SliderCrank
from linksweep.mechanisms.links import Bar, Disk, Link
from linksweep.results.check import check
from linksweep.results.peaks import peaks
from linksweep.results.sweep import sweep
from linksweep.results.system import system
from linksweep.scene.air_cycle import DieselCycle, OttoCycle
from linksweep.scene.examples import example
from linksweep.scene.gas_pressure import GasPressure
from linksweep.scene.loads import Load
from linksweep.scene.scene import Scene
from linksweep.scene.springs import Damper, Spring, TorsionDamper, TorsionSpring
from linksweep.surface import accessor as _accessor  # noqa: F401  (registers Dataset.linksweep)
from linksweep.surface import plot
from linksweep.surface.storage import load_scene, save

__all__ = [
    "Bar",
    "Damper",
    "DieselCycle",
    "Disk",
    "FourBar",
    "GasPressure",
    "InvertedSliderCrank",
    "Link",
    "Load",
    "LoopTrack",
    "OttoCycle",
    "Scene",
    "SliderCrank",
    "Spring",
    "TorsionDamper",
    "TorsionSpring",
    "check",
    "example",
    "load_scene",
    "peaks",
    "plot",
    "save",
    "sweep",
    "system",
]
