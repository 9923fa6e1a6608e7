"""The reference of the inverted slider-crank is checked: by finite differences, energy, and the machine as a whole."""

from itertools import product

import numpy as np
import pytest
from laws import dot, history, kinetic_energy
from oracle_inverted_slider_crank import (
    DRIVES,
    KINDS,
    links,
    longest,
    motion,
    motion_and_slide,
    random_data,
    random_rubbing_theta2,
    solve,
)
from references import BRANCHES, largest_force, load_force, load_point, mp


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("case", [*product(KINDS, BRANCHES, DRIVES)], ids="-".join)
def test_laws_of_mechanics(case, friction):
    """Rates are derivatives of places; the drive's power is that of energy, weights and loads; all forces add up."""
    kind, branch, drive = case
    rng = np.random.default_rng(3)
    data = random_data(rng, kind=kind, branch=branch, drive=drive, loads=2, friction=friction)
    theta2 = random_rubbing_theta2(rng, data)
    result = solve(data, theta2)
    at, w = history(motion_and_slide, data, theta2), mp.mpf(data.omega2)

    def close(value, expected, scale):
        return abs(value - expected) < mp.mpf("1e-25") * scale

    move = motion(data, theta2)
    L = longest(data)
    for name, n, scale in (("slide_velocity", 1, L * abs(w)), ("slide_acceleration", 2, L * w**2)):
        assert close(result[name], mp.diff(lambda t: at(t)[1]["slide"], 0, n), 1e3 * scale)
    turned = [mp.diff(lambda t: mp.arg(at(t)[0].line["rocker"] / move.line["rocker"]), 0, n) for n in (1, 2)]
    assert close(result["omega4"], turned[0], 1e3 * abs(w)) and close(result["alpha4"], turned[1], 1e3 * w**2)

    terms = [mp.diff(lambda t: kinetic_energy(links(data), at(t)[0]), 0), -result["power"], -result["friction_power"]]
    force = sum(mp.mpc(result[f"{F}x"], result[f"{F}y"]) for F in ("F12", "F14"))
    for name, link in links(data).items():
        weight = mp.mpf(link.mass) * mp.mpc(*data.gravity)
        terms.append(-dot(weight, mp.diff(lambda t, name=name: at(t)[0].G[name], 0)))
        force += weight - mp.mpf(link.mass) * move.aG[name]
    for load in data.loads:
        v = mp.diff(lambda t, load=load: load_point(at(t)[0], load), 0)
        terms.append(-dot(load_force(move, load), v) - load.torque * move.omega[load.link])
        force += load_force(move, load)
    assert close(sum(terms), 0, max(map(abs, terms)))
    assert close(force, 0, largest_force(result))
    r = move.line["rocker"]
    along = mp.mpc(result["F43x"], result["F43y"]) / r
    assert close(along.real, result.get("cylinder_force", 0) + result["friction_force"], largest_force(result))
    assert (result["slide"] > 0) == (data.branch == "open")
