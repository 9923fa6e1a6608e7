"""What may act on a mechanism: the classes that a scene takes as loads, and that its file can name.

Each is an `Action`: a new kind of load is one more of them, one more here, and its form in `mechanisms`.
"""

from linksweep.scene.loads.action import Action
from linksweep.scene.loads.gas_pressure import GasPressure
from linksweep.scene.loads.load import Load
from linksweep.scene.loads.springs import Damper, Spring, TorsionDamper, TorsionSpring

ACTIONS: tuple[type[Action], ...] = (Load, GasPressure, Spring, Damper, TorsionSpring, TorsionDamper)
