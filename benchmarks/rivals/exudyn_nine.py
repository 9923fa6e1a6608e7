"""exudyn: the four-bar as a multibody system, stepped in time through a turn at constant speed.

Its forces need an eighth of a turn to settle, which is stepped too.
"""

from __future__ import annotations

import numpy as np

from benchmarks.rivals import Bound, peers
from benchmarks.rivals.peers import Array, Design

SETTLING = 8
"""Steps of a turn per step before it, for settling."""


def bind(q: Design, theta2: Array) -> Bound:
    n = len(theta2)
    before = n // SETTLING

    def call() -> tuple:
        container, sensors = _system(q, 2 * np.pi * (theta2[0] / 360.0 - before / n))
        mbs = container.GetSystem(0)
        mbs.SolveDynamic(_settings(q, n + before, n))
        return tuple(mbs.GetSensorStoredData(sensor) for sensor in sensors)

    return Bound(call, lambda data: _nine(data, before))


def _nine(data: tuple, before: int) -> Array:
    """Return the nine unknowns; exudyn's rows are time and values, the start first."""
    A, B, C, D, drive = (rows[before:-1, 1:3].T for rows in data)
    return np.concatenate([-A, B, C, -D, -drive[:1]])


def _settings(q: Design, steps: int, steps_a_turn: int):
    import exudyn

    settings = exudyn.SimulationSettings()
    duration = steps / steps_a_turn * 2 * np.pi / q.omega2
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = duration / steps
    return settings


def _system(q: Design, t2: float):
    """Return the machine at theta2 [rad], assembled and moving, and the sensors of its pin forces and its drive."""
    import exudyn
    from exudyn import itemInterface as item

    container = exudyn.SystemContainer()
    mbs = container.AddSystem()
    ground = mbs.AddObject(item.ObjectGround())
    A1, D1 = (mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=ground, localPosition=[x, 0, 0])) for x in (0.0, q.d))
    (crank, A2, B2), (_, B3, C3), (_, D4, C4) = (body(mbs, item, q, *link) for link in links(q, t2))
    pins = [
        mbs.AddObject(item.ObjectJointRevolute2D(markerNumbers=list(pair)))
        for pair in ((A1, A2), (B2, B3), (C3, C4), (D1, D4))
    ]
    still = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(item.NodePointGround()), coordinate=0))
    angle = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=crank, coordinate=2))
    drive = item.ObjectConnectorCoordinate(markerNumbers=[still, angle], velocityLevel=True, offset=q.omega2)
    force = exudyn.OutputVariableType.Force
    sensors = [
        mbs.AddSensor(item.SensorObject(objectNumber=joint, storeInternal=True, outputVariableType=force))
        for joint in (*pins, mbs.AddObject(drive))
    ]
    mbs.Assemble()
    return container, sensors


def links(q: Design, t2: float):
    """Yield for crank, coupler and rocker: first pin and its velocity, angle and rate, mass and inertia, centre of
    gravity in the link, length; vectors as complex numbers."""
    t3, t4 = peers.position(q, t2)
    w3, w4 = peers.rates(q, t2, t3, t4)
    B = q.a * np.exp(1j * t2)
    yield 0j, 0j, t2, q.omega2, q.m2, q.I2, q.s * np.exp(1j * np.radians(q.delta2)), q.a
    yield B, 1j * q.omega2 * B, t3, w3, q.m3, q.I3, q.p * np.exp(1j * np.radians(q.delta3)), q.b
    yield q.d + 0j, 0j, t4, w4, q.m4, q.I4, q.u * np.exp(1j * np.radians(q.delta4)), q.c


def body(mbs, item, q: Design, pin, pin_velocity, angle, rate, mass, inertia, cg, length):
    """Add a rigid body; return its node, and the markers of its two pins."""
    arm = cg * np.exp(1j * angle)
    G, v = pin + arm, pin_velocity + 1j * rate * arm
    start = {"initialCoordinates": [G.real, G.imag, angle], "initialVelocities": [v.real, v.imag, rate]}
    node = mbs.AddNode(item.NodeRigidBody2D(**start))
    body = mbs.AddObject(item.ObjectRigidBody2D(nodeNumber=node, mass=mass, inertia=inertia))
    first, second = (
        mbs.AddMarker(item.MarkerBodyPosition(bodyNumber=body, localPosition=[(x - cg).real, -cg.imag, 0]))
        for x in (0.0, length)
    )
    weight = mbs.AddMarker(item.MarkerBodyMass(bodyNumber=body))
    mbs.AddLoad(item.LoadMassProportional(markerNumber=weight, loadVector=[q.gx, q.gy, 0]))
    return node, first, second
