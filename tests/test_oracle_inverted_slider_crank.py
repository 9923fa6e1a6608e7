"""The judge of the inverted slider-crank is judged: by finite differences, energy, and the machine as a whole."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from oracle import BRANCHES, largest_force, load_force, mp
from oracle_inverted_slider_crank import (
    DRIVES,
    KINDS,
    links,
    longest,
    motion,
    motion_and_slide,
    point,
    random_data,
    random_theta2,
    solve,
)


@pytest.mark.parametrize("case", [*product(KINDS, BRANCHES, DRIVES)], ids="-".join)
def test_laws_of_mechanics(case):
    """Rates are derivatives of places; the drive's power is that of energy, weights and loads; all forces add up."""
    kind, branch, drive = case
    rng = np.random.default_rng(3)
    data = random_data(rng, kind=kind, branch=branch, drive=drive, loads=2)
    theta2 = random_theta2(rng, data)
    result = solve(data, theta2)
    w, a = mp.mpf(data.omega2), mp.mpf(data.alpha2)

    def at(t):
        return motion_and_slide(replace(data, omega2=w + a * t), theta2 + mp.degrees(w * t + a * t**2 / 2))

    def close(value, expected, scale):
        return abs(value - expected) < mp.mpf("1e-25") * scale

    move = motion(data, theta2)
    L = longest(data)
    for name, n, scale in (("slide_velocity", 1, L * abs(w)), ("slide_acceleration", 2, L * w**2)):
        assert close(result[name], mp.diff(lambda t: at(t)[1]["slide"], 0, n), 1e3 * scale)
    turned = [mp.diff(lambda t: mp.arg(at(t)[0].line["rocker"] / move.line["rocker"]), 0, n) for n in (1, 2)]
    assert close(result["omega4"], turned[0], 1e3 * abs(w)) and close(result["alpha4"], turned[1], 1e3 * w**2)

    def energy(t):
        now = at(t)[0]
        return sum(
            mp.mpf(link.mass) * abs(now.vG[name]) ** 2 / 2 + mp.mpf(link.inertia) * now.omega[name] ** 2 / 2
            for name, link in links(data).items()
        )

    terms = [mp.diff(energy, 0), -result["power"]]
    force = sum(mp.mpc(result[f"{F}x"], result[f"{F}y"]) for F in ("F12", "F14"))
    for name, link in links(data).items():
        weight = mp.mpf(link.mass) * mp.mpc(*data.gravity)
        terms.append(-(weight.conjugate() * mp.diff(lambda t, name=name: at(t)[0].G[name], 0)).real)
        force += weight - mp.mpf(link.mass) * move.aG[name]
    for load in data.loads:
        v = mp.diff(lambda t, load=load: point(at(t)[0], load), 0)
        terms.append(-(load_force(move, load).conjugate() * v).real - load.torque * move.omega[load.link])
        force += load_force(move, load)
    assert close(sum(terms), 0, max(map(abs, terms)))
    assert close(force, 0, largest_force(result))
    r = move.line["rocker"]
    along = mp.mpc(result["F43x"], result["F43y"]) / r
    assert close(along.real, result.get("cylinder_force", 0), largest_force(result))
    assert (result["slide"] > 0) == (data.branch == "open")
