"""linksweep: how hard are my pins loaded, and where is the worst of it?"""

from linksweep.mechanisms.four_bar import FourBar
from linksweep.mechanisms.links import Bar, Disk, Link
from linksweep.results.peaks import peaks
from linksweep.results.sweep import sweep
from linksweep.results.system import system
from linksweep.scene.loads import Load
from linksweep.scene.scene import Scene

__all__ = ["Bar", "Disk", "FourBar", "Link", "Load", "Scene", "peaks", "sweep", "system"]
