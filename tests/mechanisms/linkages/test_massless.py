"""Linkages without masses: loads alone make their forces, and the drive's power is what the loads take.

Velocities of the points where loads act are central differences of positions, which no force has anything to do with.
"""

from dataclasses import replace

import numpy as np
import pytest
from random_linkages import swept

import linksweep as ls
from linksweep.mechanisms.balance import MassDistribution
from linksweep.scene.parameters import replaced

NAMES = ("watt-2", "knuckle-press", "excavator", "whitworth", "geared-five-bar", "scotch-yoke")
NOTHING = MassDistribution(0.0, 0.0, 0.0, 0.0)
THETA2 = np.array([7.0, 12.0, 23.0, 31.0, 38.0])  # in degrees: on the arc of the excavator
STEP = 1e-4  # degree


def massless(name: str, **changes) -> ls.Scene:
    """Return an example without masses, gravity or friction, a constant force and torque on each link."""
    scene = ls.example(name)
    slides = {path: 0.0 for path in scene.numbers if path.endswith("friction")}
    rng, roles = np.random.default_rng(len(name)), scene.mechanism.roles
    points = {role: (0.1, 25.0) if role in scene.mechanism.topology.links else (0.0, 0.0) for role in roles}
    loads = [ls.Load(role, tuple(rng.uniform(-90.0, 90.0, 2)), at=at) for role, at in points.items()]
    loads += [ls.Load(role, torque=rng.uniform(-9.0, 9.0)) for role in scene.mechanism.topology.links]
    machine = scene.mechanism.with_masses(dict.fromkeys(roles, NOTHING))
    return replaced(replace(scene, mechanism=machine, alpha2=None, loads=loads, **changes), slides)


@pytest.mark.parametrize("name", NAMES)
def test_forces_come_from_loads_alone(name):
    """Neither speed, acceleration nor gravity has an effect, and twice the loads make twice the forces."""
    scene = massless(name)
    forces = list(scene.mechanism.unknowns(scene.drive))
    quick = replace(scene, omega2=7.0 * scene.omega2, alpha2=-31.0, gravity=(2.0, -3.0))
    doubled = [replace(load, **{word: twice(load, word) for word in ("force", "torque")}) for load in scene.loads]
    once, same, twofold = (swept(one, THETA2, forces) for one in (scene, quick, replace(scene, loads=doubled)))
    assert not once.status.any()
    for force in forces:
        size = float(abs(once[force]).max())
        np.testing.assert_allclose(same[force], once[force], rtol=1e-12, atol=1e-12 * size, err_msg=force)
        np.testing.assert_allclose(twofold[force], 2.0 * once[force], rtol=1e-12, atol=1e-12 * size, err_msg=force)


def twice(load: ls.Load, word: str):
    value = getattr(load, word)
    return None if value is None else tuple(2.0 * part for part in value) if word == "force" else 2.0 * value


@pytest.mark.parametrize("name", NAMES)
def test_the_drive_does_the_work_of_the_loads(name):
    scene = massless(name)
    machine, rate = scene.mechanism, float(scene.omega2)
    power = np.zeros(len(THETA2))
    for load in scene.loads:
        number = machine.topology.number(load.link)
        if load.force is not None:
            ends = [ls.coupler_curve(scene, load.at, theta2=THETA2 + way * STEP, link=load.link) for way in (1.0, -1.0)]
            power += sum(
                load.force[k] * slope(ends[0][axis].values, ends[1][axis].values) for k, axis in enumerate(("Px", "Py"))
            )
        elif number == 2:
            power += load.torque
        else:
            power += load.torque * np.radians(turn(scene, f"theta{number}"))
    for cylinder in machine.topology.struts:  # their lengths change with theta2
        power += swept(scene, THETA2, [f"force_{cylinder}"])[f"force_{cylinder}"] * turn(scene, f"length_{cylinder}")
    unknown = machine.drives[scene.drive]
    drive = swept(scene, THETA2, [unknown])[unknown].values
    work = drive * (1.0 if scene.drive == machine.roles[0] else turn(scene, f"length_{scene.drive}"))
    assert rate and float(abs(work).max()) > 0.1
    np.testing.assert_allclose(work + power, 0.0, atol=1e-7 * float(abs(work).max()))


def turn(scene: ls.Scene, name: str) -> np.ndarray:
    """Return the change of an angle [degree] or a length with the crank's angle [rad]."""
    ahead, behind = (swept(scene, THETA2 + way * STEP, [name])[name].values for way in (1.0, -1.0))
    around = (ahead - behind + 180.0) % 360.0 - 180.0 if name.startswith("theta") else ahead - behind
    return slope(around, 0.0)


def slope(ahead, behind):
    """Return a central difference to the crank's angle in radians."""
    return (ahead - behind) / np.radians(2.0 * STEP)
