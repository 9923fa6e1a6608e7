"""The kinds of loads: each is a class in a file of this folder, `register`ed there, with a line here.

The line is all that scenes, scene files and `linksweep` itself need to take a new kind.
"""

from linksweep.scene.loads.gas_pressure import GasPressure as GasPressure
from linksweep.scene.loads.load import Load as Load
from linksweep.scene.loads.springs import Damper as Damper
from linksweep.scene.loads.springs import Spring as Spring
from linksweep.scene.loads.torsion import TorsionDamper as TorsionDamper
from linksweep.scene.loads.torsion import TorsionSpring as TorsionSpring
