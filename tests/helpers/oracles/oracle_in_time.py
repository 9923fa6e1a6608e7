"""Independent motion in time of a four-bar and a slider-crank: Lagrange's equations with multipliers, by scipy.

Each moving body has three coordinates, those of its centre of gravity and its angle; pins and guides are constraints C
= 0 between them. At every instant

    | M  Cqᵀ | | q̈ |   | Q  |
    | Cq  0  | | λ | = | γ  |         γ = −(Cq q̇)_q q̇

is solved as a whole: masses, forces and constraints are stated once, and no formula of a dyad, no reduced inertia and
no reaction is written down. Positions come from intersecting circles. The state in time is the crank's angle and speed,
which `solve_ivp` integrates by DOP853. Vectors are arrays (x, y) from pin A; all is in SI and radians.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_ivp


@dataclass
class Body:
    """A body: its first pin is the origin of its own axes, which lie along its line of pins."""

    length: float
    mass: float
    inertia: float
    cg_distance: float = 0.0
    cg_angle: float = 0.0  # degrees

    def arm(self, distance: float, angle: float = 0.0) -> np.ndarray:
        """Return a polar point of the body from its centre of gravity, in its own axes."""
        return polar(distance, angle) - polar(self.cg_distance, self.cg_angle)


@dataclass
class Line:
    """A spring and a damper between two points, each (body, distance, degrees), or ("ground", x, y)."""

    ends: tuple
    rate: float = 0.0
    free_length: float = 0.0
    damping: float = 0.0


@dataclass
class Machine:
    """A four-bar with bodies crank, coupler, rocker, or a slider-crank with crank and rod and a slider of this mass."""

    bodies: Sequence[Body]
    ground: float | None = None
    slider_mass: float | None = None
    offset: float = 0.0
    gravity: tuple[float, float] = (0.0, 0.0)
    lines: Sequence[Line] = ()
    torques: dict[int, float] = field(default_factory=dict)  # constant, on a body
    turning_dampers: dict[int, float] = field(default_factory=dict)  # between the ground and a body [N m s/rad]
    shaft_inertia: float = 0.0  # of flywheel and rotor, on the crank
    friction: float = 0.0  # of the slider on its guide

    @property
    def masses(self) -> np.ndarray:
        rows = [(body.mass, body.mass, body.inertia) for body in self.bodies]
        rows[0] = (rows[0][0], rows[0][1], rows[0][2] + self.shaft_inertia)
        return np.array([*rows, (self.slider_mass, self.slider_mass, 1.0)] if self.slider_mass is not None else rows)

    def positions(self, theta: float) -> np.ndarray:
        """Return centre of gravity and angle of each body, open branch."""
        B = self.bodies[0].length * unit(theta)
        if self.ground is None:
            b = self.bodies[1].length
            C = np.array([B[0] + np.sqrt(b**2 - (self.offset - B[1]) ** 2), self.offset])
            starts, angles = [np.zeros(2), B, C], [theta, angle_of(C - B), 0.0]
        else:
            D, b, c = np.array([self.ground, 0.0]), self.bodies[1].length, self.bodies[2].length
            way = D - B
            f = np.hypot(*way)
            along = (b**2 - c**2 + f**2) / (2.0 * f)
            C = B + (along * way + np.sqrt(b**2 - along**2) * np.array([-way[1], way[0]])) / f
            starts, angles = [np.zeros(2), B, D], [theta, angle_of(C - B), angle_of(C - D)]
        bodies = [*self.bodies, Body(0.0, 0.0, 0.0)][:3]
        centres = [s - turned(a, body.arm(0.0)) for s, a, body in zip(starts, angles, bodies, strict=True)]
        return np.array([[*centre, angle] for centre, angle in zip(centres, angles, strict=True)])

    def joints(self) -> list[tuple]:
        """Return the pins in order: two bodies (None for the ground), and the arm of the pin in each."""
        crank, coupler, *_ = self.bodies
        first = [(0, None, crank.arm(0.0), None), (0, 1, crank.arm(crank.length), coupler.arm(0.0))]
        if self.ground is None:
            return [*first, (1, 2, coupler.arm(coupler.length), np.zeros(2))]
        rocker = self.bodies[2]
        last = (1, 2, coupler.arm(coupler.length), rocker.arm(rocker.length)), (2, None, rocker.arm(0.0), None)
        return [*first, *last]

    def constraints(self, q: np.ndarray, rates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return Cq and γ."""
        rows, right = [], []
        for i, j, arm_i, arm_j in self.joints():
            row, gamma = np.zeros((2, 9)), np.zeros(2)
            for body, arm, sign in ((i, arm_i, 1.0), (j, arm_j, -1.0)):
                if body is not None:
                    r = turned(q[body, 2], arm)
                    row[:, 3 * body : 3 * body + 2] = sign * np.eye(2)
                    row[:, 3 * body + 2] = sign * np.array([-r[1], r[0]])
                    gamma += sign * r * rates[body, 2] ** 2
            rows.append(row)
            right.append(gamma)
        if self.ground is None:  # the slider keeps its height and does not turn
            rows.append(np.eye(9)[[7, 8]])
            right.append(np.zeros(2))
        return np.concatenate(rows), np.concatenate(right)

    def forces(self, q: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Return the applied forces and torques on all bodies, but for the drive."""
        Q = np.zeros((3, 3))
        Q[:, :2] = self.masses[:, :1] * np.array(self.gravity)
        for body, torque in self.torques.items():
            Q[body, 2] += torque
        for body, damping in self.turning_dampers.items():
            Q[body, 2] -= damping * rates[body, 2]
        for line in self.lines:
            (p, u, first), (r, v, second) = (self._end(end, q, rates) for end in line.ends)
            length = np.hypot(*(r - p))
            e = (r - p) / length
            pull = line.rate * (length - line.free_length) + line.damping * np.dot(v - u, e)
            for place, end, force in ((p, first, pull * e), (r, second, -pull * e)):
                if end is not None:
                    Q[end, :2] += force
                    Q[end, 2] += cross(place - q[end, :2], force)
        return Q.ravel()

    def _end(self, end: tuple, q: np.ndarray, rates: np.ndarray):
        """Return place and velocity of the end of a line, and its body."""
        body, *numbers = end
        if body == "ground":
            return np.array(numbers), np.zeros(2), None
        r = turned(q[body, 2], self.bodies[body].arm(*numbers))
        return q[body, :2] + r, rates[body, :2] + rates[body, 2] * np.array([-r[1], r[0]]), body

    def moving(self, theta: float, omega: float, torque: float) -> tuple[float, np.ndarray]:
        """Return the crank's acceleration under a torque of its drive, and the multipliers, two of each pin."""
        q = self.positions(theta)
        Cq, _ = self.constraints(q, np.zeros((3, 3)))
        crank = np.eye(9)[2:3]
        rates = np.linalg.solve(np.concatenate([Cq, crank]), [*np.zeros(8), omega]).reshape(3, 3)
        _, gamma = self.constraints(q, rates)
        Q = self.forces(q, rates)
        Q[2] += torque
        whole = np.block([[np.diag(self.masses.ravel()), Cq.T], [Cq, np.zeros((8, 8))]])
        known = np.concatenate([Q, gamma])
        solution = np.linalg.solve(whole, known)
        for _ in range(100 if self.friction else 0):  # the friction follows from the normal force that it changes
            known[6] = Q[6] - self.friction * abs(solution[15]) * np.sign(rates[2, 0])
            last, solution = solution, np.linalg.solve(whole, known)
            if abs(solution - last).max() <= 1e-14 * abs(solution).max():
                break
        return solution[2], solution[9:]

    def height_energy(self, theta: float) -> float:
        """Return the potential energy of the weights."""
        return -float(np.sum(self.masses[:, 0] * (self.positions(theta)[:, :2] @ np.array(self.gravity))))

    def pin_forces(self, theta: float, omega: float, torque: float) -> np.ndarray:
        """Return the size of the force in each pin."""
        _, multipliers = self.moving(theta, omega, torque)
        count = len(self.joints())
        return np.hypot(*multipliers[: 2 * count].reshape(count, 2).T)

    def run(self, drive: Callable[[float], float], times: Sequence[float], theta: float = 0.0, omega: float = 0.0):
        """Return the crank's angle turned and speed (2, times) from its start, the drive's torque a function of its
        speed."""

        def rates(_, y):
            return y[1], self.moving(y[0], y[1], drive(y[1]))[0]

        times = np.asarray(times, dtype=float)
        span = 0.0, times[-1]
        solution = solve_ivp(rates, span, (theta, omega), "DOP853", t_eval=times, rtol=1e-11, atol=1e-12)
        assert solution.success, solution.message
        return solution.y


def unit(angle: float) -> np.ndarray:
    return np.array([np.cos(angle), np.sin(angle)])


def polar(distance: float, degrees: float) -> np.ndarray:
    return distance * unit(np.radians(degrees))


def angle_of(vector: np.ndarray) -> float:
    return float(np.arctan2(vector[1], vector[0]))


def turned(angle: float, vector: np.ndarray) -> np.ndarray:
    c, s = unit(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])


def cross(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])
