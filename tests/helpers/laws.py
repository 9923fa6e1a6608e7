"""Check the reference solutions against the laws of mechanics, in 60 digits: agreement, derivatives, energy."""

from dataclasses import replace

from references import mp

# identities of 60-digit numbers, less the digits that a toggle margin of 0.1 may cost
TIGHT = mp.mpf("1e-40")


def close(value, expected, scale):
    return abs(value - expected) <= TIGHT * scale


def all_close(result, expected, scale=1):
    assert {name: result[name] for name in expected if not close(result[name], expected[name], scale)} == {}


def dot(F, v):
    return (F.conjugate() * v).real


def history(motion, data, theta2):
    """Return the motion as a function of time, with alpha2 constant."""
    w, a = mp.mpf(data.omega2), mp.mpf(data.alpha2)

    def at(t):
        return motion(replace(data, omega2=w + a * t), theta2 + mp.degrees(w * t + a * t**2 / 2))

    return at


def derivative(at, of, n=1):
    """Return the n-th time derivative, by finite differences, of a quantity of the motion."""
    return mp.diff(lambda t: of(at(t)), 0, n)


def kinetic_energy(links, move):
    return sum(
        mp.mpf(link.mass) * abs(move.vG[name]) ** 2 / 2 + mp.mpf(link.inertia) * move.omega[name] ** 2 / 2
        for name, link in links.items()
    )
