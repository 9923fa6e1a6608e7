"""A request is charged for what it needs: the functions and operations that its plan holds, counted."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import linksweep as ls
from linksweep.engine.quantity import Row, Table
from linksweep.engine.trace.derivatives import derivative_of
from linksweep.engine.trace.plan import Plan, plan
from linksweep.physics.algebra import planar
from linksweep.scene.derivatives.differentiated import differentiated
from linksweep.scene.inputs import engine_inputs
from linksweep.scene.parameters import free

KINEMATICS = ("theta3", "theta4", "omega3", "omega4", "alpha3", "alpha4")
UNKNOWNS = ("F12x", "F12y", "F32x", "F32y", "F43x", "F43y", "F14x", "F14y", "T12")
PIN_FORCES = {name for name in UNKNOWNS if name.startswith("F")}


def links(**changes) -> dict[str, ls.Link]:
    """Links with nothing that is zero or one, unless changed."""
    return {
        "crank": ls.Link(0.04, 0.25, 1.3e-4, cg_distance=0.013, cg_angle=70.0),
        "coupler": ls.Link(0.12, 0.40, 5.0e-4, cg_distance=0.05, cg_angle=12.0),
        "rocker": ls.Link(0.09, 0.33, 4.0e-4, cg_distance=0.06, cg_angle=-33.0),
    } | changes


def scene(loads=(), gravity=(0.3, -9.81), alpha2=7.0, omega2=-31.0, ground_angle=25.0, **changed_links) -> ls.Scene:
    bars = ls.FourBar(**links(**changed_links), ground=0.13, ground_angle=ground_angle)
    return ls.Scene(bars, omega2=omega2, alpha2=alpha2, gravity=gravity, loads=loads)


def planned(scene: ls.Scene, *names: str) -> Plan:
    return plan(scene.table, names, scene.inputs.forms)


def makes(result: Plan) -> set[str]:
    """Names of all that the plan's functions make."""
    return {name for function in result.functions for name in function.split(" → ")[1].split(", ")}


def cost(scene: ls.Scene, *names: str) -> int:
    """Operations at every crank angle."""
    return planned(scene, *names).operations("theta2").total()


def test_velocities_need_no_inertia_and_no_force():
    result = planned(scene(loads=[ls.Load("rocker", force=(1.0, 2.0), at=(0.05, 10.0))]), "omega3")
    assert {"r3x", "ratio3", "omega3"} <= makes(result)
    assert not {name for name in makes(result) if name[0] in "FQNPMTJ" or name.startswith(("alpha", "aB", "load"))}
    assert set(result.inputs) <= {
        *("cos2", "sin2", "cos2_lo", "sin2_lo", "omega2", "branch_sign"),
        *(f"{link}_length" for link in ("crank", "coupler", "rocker", "ground")),
        *("ground_cos", "ground_sin", "ground_cos_lo", "ground_sin_lo"),
    }


def test_torque_needs_no_pin_force():
    """Virtual work gives it without."""
    result = planned(scene(), "T12")
    assert makes(result).isdisjoint(PIN_FORCES)
    assert "work" in makes(result)
    assert cost(scene(), "T12") < 0.9 * cost(scene(), *UNKNOWNS)


def test_forces_need_no_torque_and_no_power():
    assert makes(planned(scene(), *sorted(PIN_FORCES))).isdisjoint({"T12", "work", "power"})


def test_one_pin_force_needs_only_what_leads_to_it():
    """The force at C is solved first; the others follow by addition, each by its own."""
    at_C, at_B, at_D = ({f"{stem}x", f"{stem}y"} for stem in ("push_rocker_C", "push_coupler_B", "hold_rocker"))
    forces = at_C | at_B | at_D
    assert makes(planned(scene(), "F43x")) & forces == at_C
    assert makes(planned(scene(), "F32x")) & forces == at_C | at_B
    assert makes(planned(scene(), "F14y")) & forces == at_C | at_D


def test_costs_rise_with_the_request():
    requests = [("omega3",), ("omega3", "omega4"), ("alpha3", "alpha4"), ("T12",), UNKNOWNS]
    costs = [cost(scene(), *names) for names in requests]
    assert costs == sorted(set(costs))


def test_all_of_the_kinematics_is_shared_by_the_forces():
    together = cost(scene(), *KINEMATICS, *UNKNOWNS)
    angles, signs = 4, 2  # theta3 and theta4: atan2, and degrees; omega3 and omega4, which forces take with a minus
    assert together - cost(scene(), *UNKNOWNS) == angles + signs


def test_one_root_and_one_division_an_angle():
    """Divisors belong to the design, or are shared: that makes the kernel fast."""
    result = planned(scene(), *UNKNOWNS).operations("theta2")
    assert (result["sqrt"], result["/"]) == (1, 1)


# ---- what is zero costs nothing -----

FORCE = ls.Load("coupler", force=(3.0, -80.0), at=(0.10, 15.0))


def test_no_loads_no_load_functions():
    assert not {name for name in makes(planned(scene(), *UNKNOWNS, "power_residual")) if "load" in name}
    assert {"load1_rx", "load1_moment"} <= makes(planned(scene(loads=[FORCE]), *UNKNOWNS))


def test_each_load_costs_what_it_brings():
    none, torque, force, in_link_axes, two = (
        cost(scene(loads=loads), *UNKNOWNS)
        for loads in (
            [],
            [ls.Load("coupler", torque=2.0)],
            [FORCE],
            [replace(FORCE, frame="link")],
            [FORCE, replace(FORCE, link="rocker")],
        )
    )
    assert none < torque < force < in_link_axes
    assert two > force
    at_the_pin = cost(scene(loads=[replace(FORCE, at=(0.0, 0.0))]), *UNKNOWNS)
    assert none < at_the_pin < force


WITHOUT = {
    "gravity": {"gravity": (0.0, 0.0)},
    "gravity_x": {"gravity": (0.0, -9.81)},
    "alpha2": {"alpha2": 0.0},
    "omega2": {"omega2": 0.0},
    "ground_angle": {"ground_angle": 0.0},
    "crank_cg": {"crank": ls.Link(0.04, 0.25, 1.3e-4)},
    "coupler_cg": {"coupler": ls.Link(0.12, 0.40, 5.0e-4)},
    "rocker_cg": {"rocker": ls.Link(0.09, 0.33, 4.0e-4)},
    "coupler_cg_angle": {"coupler": ls.Link(0.12, 0.40, 5.0e-4, cg_distance=0.05)},
    "crank_mass": {"crank": ls.Link(0.04, 0.0, 0.0)},
    "coupler_mass": {"coupler": ls.Link(0.12, 0.0, 0.0)},
    "rocker_mass": {"rocker": ls.Link(0.09, 0.0, 0.0)},
}


@pytest.mark.parametrize("nothing", WITHOUT)
def test_nothing_costs_nothing(nothing):
    assert cost(scene(**WITHOUT[nothing]), *UNKNOWNS) < cost(scene(), *UNKNOWNS)


@pytest.mark.parametrize("nothing", WITHOUT)
def test_leaving_nothing_out_changes_no_number(nothing):
    """The cheaper plan against the full one, which has the same zeros as arrays of one design."""

    def as_array(value):
        return xr.DataArray([float(value)], dims="design")

    cheap = scene(**WITHOUT[nothing])
    bars = cheap.mechanism
    numbers = ("length", "mass", "inertia", "cg_distance", "cg_angle")
    full_links = (
        ls.Link(*(as_array(getattr(link, x)) for x in numbers)) for link in (bars.crank, bars.coupler, bars.rocker)
    )
    full = ls.Scene(
        ls.FourBar(*full_links, ground=bars.ground, ground_angle=as_array(bars.ground_angle)),
        omega2=as_array(cheap.omega2),
        alpha2=as_array(cheap.alpha2),
        gravity=tuple(map(as_array, cheap.gravity)),
    )
    expected, result = ls.sweep(full, 36), ls.sweep(cheap, 36)
    for name in expected.data_vars:
        np.testing.assert_array_equal(*np.broadcast_arrays(result[name], expected[name].isel(design=0)), err_msg=name)


def test_massless_machine_at_rest_has_nothing_to_do():
    still = scene(crank=ls.Link(0.04, 0, 0), coupler=ls.Link(0.12, 0, 0), rocker=ls.Link(0.09, 0, 0), alpha2=0.0)
    assert cost(still, *UNKNOWNS) == 0
    assert not any(ls.sweep(still, 8, of=UNKNOWNS)[name].any() for name in UNKNOWNS)


def test_operations_of_a_design_are_done_once():
    """Moments of inertia and the like are no work at the angles."""
    result = planned(scene(), *UNKNOWNS)
    assert result.operations().total() > 20
    once = {"J2", "J3", "J4"} & makes(result)
    assert once == {"J2", "J3", "J4"}
    heavy = planned(scene(coupler=links()["coupler"]), "J3")
    assert heavy.operations("theta2").total() == 0


@pytest.mark.parametrize("name", ["press", "watt-2"])
def test_ten_derivatives_take_at_most_four_and_a_half_times_the_operations_and_few_divisions(name):
    """Adjoints divide only by what changes with the angle: by each square root once, and by what a quotient is over."""
    machine, force = ls.example(name), "F32_squared"
    paths = tuple(path for path in free(machine) if path.partition(".")[0] in machine.mechanism.roles)[:10]
    own = differentiated(machine, (force,), paths)
    alone = planned(machine, force).operations("theta2")
    both = planned(own, force, *(derivative_of(force, path) for path in paths)).operations("theta2")
    assert both.total() <= 4.5 * alone.total()
    assert both["/"] <= 2 * alone["/"] + alone["sqrt"]


# ---- names -----


@pytest.mark.parametrize(
    ("name", "meant"), [("omega_3", "omega3"), ("F23X", "F23x"), ("t12", "T12"), ("pwoer", "power")]
)
def test_unknown_output_is_refused_with_what_was_meant(name, meant):
    with pytest.raises(ValueError, match=rf'{name}.*did you mean "{meant}"'):
        ls.sweep(scene(), of=["theta3", name])


def test_all_unknown_names_are_named_at_once():
    with pytest.raises(ValueError, match="of") as caught:
        ls.sweep(scene(), of=["omega_3", "theta3", "zzz"])
    first, second = str(caught.value).splitlines()
    assert "omega_3" in first
    assert "zzz" in second
    assert "transmission_angle" in second


def test_torque_of_another_drive_is_no_output():
    with pytest.raises(ValueError, match="T13"):
        ls.sweep(scene(), of="T13")


def test_a_table_that_makes_a_name_of_itself_is_refused():
    circle = (Row(planar.opposite, ("a",), ("b",)), Row(planar.opposite, ("b",), ("a",)))
    with pytest.raises(ValueError, match="makes a of itself"):
        plan(Table("theta2", circle), ("a",), ())


def test_a_table_with_two_rows_that_make_one_name_is_refused():
    """Rows that take the place of others do so by name; of those whose name they make nothing is left."""
    rows = (Row(planar.opposite, ("a",), ("b",)), Row(planar.identity, ("c",), ("a",)))
    again = Row(planar.identity, ("a", "d"), ("b",))
    with pytest.raises(ValueError, match=r"two rows of the table make a$"):
        Table("theta2", (*rows, again))
    assert Table("theta2", rows).replacing(again).rows == (rows[1], again)


def test_an_input_that_a_row_makes_is_refused():
    press = scene()
    made = replace(press.table, rows=(*press.table.rows, Row(planar.opposite, ("crank_mass",), ("coupler_mass",))))
    vars(press)["table"] = made
    with pytest.raises(ValueError, match="two numbers would be called crank_mass"):
        engine_inputs(press)
