"""exudyn: a four-bar as a multibody system on a motor of straight curve, with a damper on its crank, stepped in time.

The trapezoidal rule errs by the square of the step: two runs, one of them with half the steps, are extrapolated.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from benchmarks.rivals.exudyn_nine import body as rigid_body
from benchmarks.rivals.exudyn_nine import links
from benchmarks.rivals.peers import Array, Design

TIGHT = 1e-12
"""Error of exudyn's Newton method."""


class OnCrank(NamedTuple):
    """Torque of the motor at rest [N m], its speed without load [rad/s]; coefficient of the damper [N m s/rad]."""

    stall_torque: float
    no_load_speed: float
    damping: float = 0.0


def end_of_run(q: Design, drive: OnCrank, duration: float, steps: int) -> Array:
    """Return angle [rad] and speed [rad/s] of the crank that starts at 0 with omega2, after a time."""
    coarse, fine = (_stepped(q, drive, duration, n)[-1] for n in (steps // 2, steps))
    return (4.0 * fine - coarse) / 3.0


def speeds_of_a_turn(q: Design, drive: OnCrank, duration: float, steps: int, turn: int, angles: Array) -> Array:
    """Return the speed [rad/s] at angles [rad] of a turn, counted from 0; the crank starts at 0 with omega2."""
    from scipy.interpolate import make_interp_spline

    runs = (_stepped(q, drive, duration, n) for n in (steps // 2, steps))
    coarse, fine = (make_interp_spline(*run.T)(2.0 * np.pi * turn + angles) for run in runs)
    return (4.0 * fine - coarse) / 3.0


def _stepped(q: Design, drive: OnCrank, duration: float, steps: int) -> Array:
    """Return angle and speed of the crank after each step: (step, 2)."""
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
    slope = drive.stall_torque / drive.no_load_speed + drive.damping
    mbs.AddObject(item.ObjectConnectorCoordinateSpringDamper(markerNumbers=[still, angle], damping=slope))
    mbs.AddLoad(item.LoadCoordinate(markerNumber=angle, load=drive.stall_torque))
    kinds = exudyn.OutputVariableType.Coordinates, exudyn.OutputVariableType.Coordinates_t
    sensors = [
        mbs.AddSensor(item.SensorNode(nodeNumber=crank, storeInternal=True, outputVariableType=kind)) for kind in kinds
    ]
    mbs.Assemble()
    mbs.SolveDynamic(_settings(duration, steps))
    return np.stack([mbs.GetSensorStoredData(sensor)[:, 3] for sensor in sensors], axis=1)


def _settings(duration: float, steps: int):
    import exudyn

    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.useNewmark = True
    settings.timeIntegration.generalizedAlpha.useIndex2Constraints = True  # else its speeds do not converge
    settings.timeIntegration.newton.relativeTolerance = TIGHT
    settings.timeIntegration.newton.absoluteTolerance = TIGHT
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = duration / steps
    return settings
