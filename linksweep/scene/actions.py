"""What may act on a mechanism: the classes that a scene takes as loads.

Each has `problems(path, links)`, a `form` (which rows it brings), `sampled(path, sample)` (itself over a sweep's
angles) and `parameters(name, machine)` (its numbers, given the machine's). A new kind of load is one more here.
"""

from linksweep.scene.gas_pressure import GasPressure
from linksweep.scene.loads import Load
from linksweep.scene.springs import Damper, Spring, TorsionDamper, TorsionSpring

Action = Load | GasPressure | Spring | Damper | TorsionSpring | TorsionDamper
ACTIONS = (Load, GasPressure, Spring, Damper, TorsionSpring, TorsionDamper)
