"""A car of mass m on the inside of a vertical loop of radius R, at the position θ from the bottom, counter-clockwise.

Tangent t = (cos θ, sin θ), inward normal n = (−sin θ, cos θ), gravity g, thrust F along t, speed v:

    F_N = m(v²/R − g·n)        a_T = F/m + g·t        a_R = v²/R along n

With the energy profile v² = v0² + 2(F R θ/m + g·r), with r = R(sin θ, 1 − cos θ) the displacement from the bottom,
where the speed is v0. Source: document 3, lecture 17, example 17-4, which calls +v²/R a component along the outward
normal: the value is right, but it points inwards.
"""

import math

from linksweep.physics.algebra.arithmetic import Number, sqrt, where
from linksweep.physics.algebra.double_double import difference
from linksweep.physics.algebra.planar import cross, dot, square


def gravity_on_track(cos2: Number, sin2: Number, gravity_x: Number, gravity_y: Number) -> tuple[Number, Number]:
    """Return g·t and g·n."""
    return dot(cos2, sin2, gravity_x, gravity_y), cross(cos2, sin2, gravity_x, gravity_y)


def squared_speed(
    entry_speed: Number,
    thrust: Number,
    mass: Number,
    radius: Number,
    gravity_x: Number,
    gravity_y: Number,
    sin2: Number,
    psi_cos: Number,
    psi_cos_lo: Number,
    radians2: Number,
    work_counts: Number,
) -> Number:
    """Return v²; `work_counts` is 1 with the energy profile and 0 with constant speed."""
    rise = difference((1.0, 0.0), (psi_cos, psi_cos_lo))
    work = thrust / mass * radians2 + (gravity_x * sin2 + gravity_y * rise)
    return entry_speed * entry_speed + work_counts * (2.0 * radius * work)


def force_of_track(mass: Number, radius: Number, squared_speed: Number, gravity_inward: Number) -> Number:
    """Return F_N, positive inwards; a track can only push."""
    return mass * (squared_speed / radius - gravity_inward)


def tangential_acceleration(thrust: Number, mass: Number, gravity_forward: Number) -> Number:
    """Return a_T."""
    return thrust / mass + gravity_forward


def status_on_track(
    radians2: Number, leaves_at: Number, stalls_at: Number, force_of_track: Number, work_counts: Number
) -> Number:
    """Return 0 ok, 1 left_track from where the car leaves (at constant speed: where F_N is negative), or 2 stalled."""
    leaves = where(radians2 < leaves_at, 0.0, 1.0)
    stalls = where(radians2 < stalls_at, 0.0, 2.0)
    by_energy = where(leaves_at < stalls_at, leaves, stalls)
    return where(work_counts > 0.0, by_energy, where(force_of_track < 0.0, 1.0, 0.0))


def mask_off_track(status: Number, squared_speed: Number, force: Number, a_tangential: Number) -> tuple[Number, ...]:
    """Return v², F_N and a_T, or NaN where the car is off the track."""
    off = status > 0.0
    return where(off, math.nan, squared_speed), where(off, math.nan, force), where(off, math.nan, a_tangential)


def centripetal(squared_speed: Number, radius: Number) -> Number:
    """Return a_R."""
    return squared_speed / radius


def ground_axes(a_radial: Number, a_tangential: Number, cos2: Number, sin2: Number) -> tuple[Number, Number]:
    """Return a_R n + a_T t."""
    return a_tangential * cos2 - a_radial * sin2, a_tangential * sin2 + a_radial * cos2


def round_trip(
    leaves_at: Number,
    stalls_at: Number,
    entry_speed: Number,
    radius: Number,
    gravity_x: Number,
    gravity_y: Number,
    work_counts: Number,
) -> Number:
    """Return 0 where the car stays on the track all the way round, 1 where it leaves or stalls, 2 where it is never on
    it."""
    first = where(leaves_at < stalls_at, leaves_at, stalls_at)
    by_energy = where(first > 0.0, where(first < math.tau, 1.0, 0.0), 2.0)
    pull = sqrt(square(gravity_x, gravity_y))
    return where(work_counts > 0.0, by_energy, where(entry_speed * entry_speed < radius * pull, 1.0, 0.0))
