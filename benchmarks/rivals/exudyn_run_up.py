"""exudyn: the run-up of a four-bar as a multibody system, on a motor of straight curve, stepped in time.

The trapezoidal rule errs by the square of the step: two runs, one of them with half the steps, are extrapolated.
"""

from __future__ import annotations

import numpy as np

from benchmarks.rivals.exudyn_nine import body as rigid_body
from benchmarks.rivals.exudyn_nine import links
from benchmarks.rivals.peers import Array, Design

TIGHT = 1e-12
"""Error of exudyn's Newton method."""


def end_of_run(q: Design, stall_torque: float, no_load_speed: float, duration: float, steps: int) -> Array:
    """Return angle [rad] and speed [rad/s] of the crank that starts at rest at 0, after a time."""
    coarse, fine = (_stepped(q, stall_torque, no_load_speed, duration, n) for n in (steps // 2, steps))
    return (4.0 * fine - coarse) / 3.0


def _stepped(q: Design, stall_torque: float, no_load_speed: float, duration: float, steps: int) -> Array:
    import exudyn
    from exudyn import itemInterface as item

    container = exudyn.SystemContainer()
    mbs = container.AddSystem()
    ground = mbs.AddObject(item.ObjectGround())
    A1, D1 = (mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=ground, localPosition=[x, 0, 0])) for x in (0.0, q.d))
    (crank, A2, B2), (_, B3, C3), (_, D4, C4) = (rigid_body(mbs, item, q, *link) for link in links(q, 0.0))
    for pair in ((A1, A2), (B2, B3), (C3, C4), (D1, D4)):
        mbs.AddObject(item.ObjectJointRevolute2D(markerNumbers=list(pair)))
    still = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(item.NodePointGround()), coordinate=0))
    angle = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=crank, coordinate=2))
    slope = stall_torque / no_load_speed
    mbs.AddObject(item.ObjectConnectorCoordinateSpringDamper(markerNumbers=[still, angle], damping=slope))
    mbs.AddLoad(item.LoadCoordinate(markerNumber=angle, load=stall_torque))
    mbs.Assemble()
    mbs.SolveDynamic(_settings(duration, steps))
    kinds = exudyn.OutputVariableType.Coordinates, exudyn.OutputVariableType.Coordinates_t
    return np.array([mbs.GetNodeOutput(crank, kind)[2] for kind in kinds])


def _settings(duration: float, steps: int):
    import exudyn

    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    settings.timeIntegration.newton.relativeTolerance = TIGHT
    settings.timeIntegration.newton.absoluteTolerance = TIGHT
    settings.solution.file.write = False
    return settings
