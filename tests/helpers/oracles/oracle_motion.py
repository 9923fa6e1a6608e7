"""Machines that run by themselves, integrated over the crank angle: the independent reference of motions on a motor.

Nothing here knows the product. Loops close by angles and are differentiated by hand; w = ω²/2 has dw/dθ = α, by
Lagrange for the four-bar, with the reduced inertia J = Σ (m |v_G|² + I k²)/ω²,

    J α + J' w = M + Σ F·u,        u = dr/dθ of the point on which a force acts

and by the equations of Newton and Euler of three bodies for the slider-crank with friction, whose unknowns are the
forces in three pins, the normal force of the guide and α. scipy's DOP853 integrates them. Vectors are complex numbers.
"""

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.integrate import solve_ivp

DEGREE = np.pi / 180.0


def cross(a, b):
    return (np.conj(a) * b).imag


def dot(a, b):
    return (np.conj(a) * b).real


@dataclass(frozen=True)
class Body:
    """A link: length, mass, moment of inertia, centre of gravity by distance and angle [degree] in its axes."""

    length: float
    mass: float
    inertia: float
    distance: float = 0.0
    angle: float = 0.0

    @property
    def centre(self):
        return self.distance * np.exp(1j * self.angle * DEGREE)


@dataclass(frozen=True)
class FourBar:
    """A four-bar, open branch, with torques and torsional dampers of the ground on crank and rocker, and gravity."""

    crank: Body
    coupler: Body
    rocker: Body
    ground: float
    gravity: complex = 0.0
    torque_on_rocker: float = 0.0
    damping_of_crank: float = 0.0
    damping_of_rocker: float = 0.0

    def links(self, theta):
        """Yield of each link its body, first and second derivatives of its angle, and those of its centre."""
        a, b, c, d = self.crank.length, self.coupler.length, self.rocker.length, self.ground
        B, dB = a * np.exp(1j * theta), 1j * a * np.exp(1j * theta)
        to_D = d - B
        f = abs(to_D)
        angle3 = np.angle(to_D) + np.arccos((b * b + f * f - c * c) / (2.0 * b * f))
        u, v = b * np.exp(1j * angle3), B + b * np.exp(1j * angle3) - d
        # dB + j k3 u = j k4 v, and its derivative ddB + j h3 u − k3² u = j h4 v − k4² v
        k3, k4 = -dot(dB, v) / dot(1j * u, v), dot(dB, u) / dot(1j * v, u)
        right = B + k3 * k3 * u - k4 * k4 * v  # −ddB + …
        h3, h4 = dot(right, v) / dot(1j * u, v), -dot(right, u) / dot(1j * v, u)
        for body, k, h, start, second, line in (
            (self.crank, 1.0, 0.0, 0.0, 0.0, B),
            (self.coupler, k3, h3, dB, -B, u),
            (self.rocker, k4, h4, 0.0, 0.0, v),
        ):
            r = body.centre * line / abs(line)
            yield body, k, h, start + 1j * k * r, second + 1j * h * r - k * k * r

    def rise(self, theta, w, motor_torque):
        """Return inertia and torque whose quotient is dw/dθ, by Lagrange."""
        J = slope = load = 0.0
        for body, k, h, velocity, acceleration in self.links(theta):
            J += body.mass * abs(velocity) ** 2 + body.inertia * k * k
            slope += 2.0 * (body.mass * dot(velocity, acceleration) + body.inertia * k * h)
            load += body.mass * dot(self.gravity, velocity)
        omega = np.sqrt(2.0 * w)
        load += self.torque_on_rocker * k - self.damping_of_rocker * k * k * omega - self.damping_of_crank * omega
        return J, motor_torque + load - slope * w


@dataclass(frozen=True)
class SliderCrank:
    """A slider-crank along x with friction, a force and a damper on its slider."""

    crank: Body
    rod: Body
    slider_mass: float
    offset: float = 0.0
    friction: float = 0.0
    force: float = 0.0
    damping: float = 0.0
    gravity: complex = 0.0

    def rise(self, theta, w, motor_torque):
        """Return inertia and torque whose quotient is dw/dθ, from the equations of Newton and Euler."""
        a, b = self.crank.length, self.rod.length
        B, omega = a * np.exp(1j * theta), np.sqrt(2.0 * w)
        sine = (self.offset - B.imag) / b
        angle3 = np.arcsin(sine)
        u = b * np.exp(1j * angle3)
        k3 = -B.real / u.real
        h3 = (B.imag + k3 * k3 * u.imag) / u.real
        dC, ddC = (1j * B + 1j * k3 * u).real, (-B + 1j * h3 * u - k3 * k3 * u).real
        r2, r3 = self.crank.centre * B / a, self.rod.centre * u / b
        bodies = (
            (self.crank, 1.0, 0.0, 1j * r2, -r2),
            (self.rod, k3, h3, 1j * B + 1j * k3 * r3, -B + 1j * h3 * r3 - k3 * k3 * r3),
        )
        # unknowns: F12x F12y F32x F32y F43x F43y N alpha
        arms = (((0, -r2, 1.0), (2, B - r2, 1.0)), ((2, -r3, -1.0), (4, u - r3, 1.0)))
        matrix, right = np.zeros((8, 8)), np.zeros(8)
        for number, ((body, k, h, first, second), joints) in enumerate(zip(bodies, arms, strict=True)):
            row = 3 * number
            for column, arm, sign in joints:
                matrix[row, column] = matrix[row + 1, column + 1] = sign
                matrix[row + 2, column : column + 2] = -sign * arm.imag, sign * arm.real
            matrix[row : row + 3, 7] = -body.mass * first.real, -body.mass * first.imag, -body.inertia * k
            push = body.mass * (second * omega**2 - self.gravity)
            right[row : row + 3] = push.real, push.imag, body.inertia * h * omega**2
        right[2] -= motor_torque
        m = self.slider_mass
        matrix[6, 4], matrix[6, 7], matrix[7, 5], matrix[7, 6] = -1.0, -m * dC, -1.0, 1.0
        right[6] = m * ddC * omega**2 - m * np.real(self.gravity) - self.force + self.damping * dC * omega
        right[7] = -m * np.imag(self.gravity)
        for sign in (1.0, -1.0):  # of the normal force: friction −μ·|N|·sign(v) = −μ·sign·sign(v)·N
            matrix[6, 6] = -self.friction * sign * np.sign(dC)
            solution = np.linalg.solve(matrix, right)
            if solution[6] * sign >= 0.0:
                break
        return 1.0, solution[7]


@dataclass(frozen=True)
class OnMotor:
    """A machine behind a gear on a motor, of which `torque` returns the torque at its speed.

    `rotor` is the inertia of the rotor at the crank's shaft; what the gear passes on arrives with its `efficiency`.
    """

    machine: FourBar | SliderCrank
    torque: object = field(repr=False)
    ratio: float = 1.0
    shaft_inertia: float = 0.0
    rotor: float = 0.0
    efficiency: float = 1.0

    def slope(self, theta, w):
        """Return dw/dθ; inertia on the shaft of a slider-crank belongs into its crank's own."""
        torque = self.ratio * self.torque(self.ratio * np.sqrt(2.0 * w))
        for part in (self.efficiency, 1.0 / self.efficiency):  # to the machine, or from it
            inertia, left = self.machine.rise(theta, w, part * torque)
            alpha = left / (inertia + self.shaft_inertia + part * self.rotor)
            if (torque > self.rotor * alpha) == (part < 1.0):
                break
        return alpha

    def slowest(self, omega, cycles):
        """Return the least ω of the last of some cycles; 0 where the machine comes to rest before."""

        def rest(theta, w):
            return w[0] - 1e-3

        rest.terminal = True
        w = 0.5 * omega**2
        for _ in range(cycles):
            run = solve_ivp(
                lambda theta, w: [self.slope(theta, max(w[0], 1e-9))], (0.0, 2.0 * np.pi), [w],
                method="DOP853", rtol=1e-9, atol=1e-9, events=rest, max_step=0.02,
            )  # fmt: skip
            if run.status == 1:
                return 0.0
            w = run.y[0, -1]
        return np.sqrt(2.0 * run.y[0].min())

    def steady(self, omega, angles, cycles=6, kinks=()):
        """Return ω at the angles [degree] of the last of some cycles, each from the end of the one before.

        Integration starts anew at the `kinks` [degree], where the torque has corners.
        """
        edges = np.unique([0.0, *(np.asarray(kinks) % 360.0), 360.0]) * DEGREE
        w, values = 0.5 * omega**2, np.empty(len(angles))
        at = np.asarray(angles) * DEGREE
        for _ in range(cycles):
            for first, last in pairwise(edges):
                run = solve_ivp(
                    lambda theta, w: [self.slope(theta, w[0])],
                    (first, last), [w], method="DOP853", rtol=2e-13, atol=1e-13, dense_output=True,
                )  # fmt: skip
                assert run.success
                own = (at >= first) & (at < last)
                values[own] = run.sol(at[own])[0]
                w = run.y[0, -1]
        return np.sqrt(2.0 * values)
