"""Assemble the textbook's square system, labelled as on the page, and solve it as a reference for the fast path."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from linksweep.base.conversion import to_float64
from linksweep.base.validate import choice_problems, refuse
from linksweep.chains.rows.bodies import Equation
from linksweep.engine.linear import solve as linear
from linksweep.engine.linear.solve import Structure
from linksweep.engine.run import Field, Grid
from linksweep.engine.threads import limits_threads
from linksweep.results.compute import angles_of, blank, compute, require_scene, sample_status
from linksweep.results.dataset import index_coordinate, provenance, status_attributes
from linksweep.scene.designs.lazy import in_memory
from linksweep.scene.dimensions import aligned
from linksweep.scene.scene import Scene

FORMS = ("reduced", "document")
System = tuple[tuple[str, ...], tuple[Equation, ...]]
"""Unknowns and equations."""


@limits_threads
def system(
    scene: Scene,
    angles: ArrayLike | None = None,
    *,
    theta2: ArrayLike | None = None,
    theta: ArrayLike | None = None,
    form: str = "reduced",
    threads: int | None = None,
) -> xr.Dataset:
    """Return the square Newton–Euler system of a scene, as the textbook prints it.

    Parameters
    ----------
    scene : Scene
        Scene of any number of designs.
    angles : float or array_like, default None
        Angle or angles [degree]; a single number is an angle here, not a count. ``system(scene, 45.0)``, or by the name
        of the machine's index, as follows.
    theta2 : float or array_like, default None
        Angle or angles of the crank [degree].
    theta : float or array_like, default None
        Position or positions of a car in a loop [degree].
    form : {"reduced", "document"}, default "reduced"
        "reduced": three equations of each moving link. "document": a slider-crank's with T14 and its row, as document 3
        prints them: nine without friction, F14x left out; ten with it, or with a slide_angle. Other machines have one
        form.
    threads : int, default None
        Largest number of threads; None for all cores.

    Returns
    -------
    Dataset
        With `matrix` (…, theta2, equation, unknown), `rhs` (…, theta2, equation) and `status`. Rows ΣFx and ΣFy are in
        N, rows ΣM (about the link's centre of gravity) in N m; columns of forces in N, of the torque in N m.

    Raises
    ------
    ValueError
        If the scene is no Scene, an angle is no finite number, angles end at π, 2π or 4π (radians), or the form is
        unknown.

    Notes
    -----
    Sources, with their misprints mended:

    - Four-bar: document 2 (ME 470), the matrix of R vectors, R_23 read as R_23x, with weights and loads on every link;
      document 1's matrix is the same with F23, F34 for F32, F43, once the signs of row 3 are turned. With
      drive="coupler" or "rocker" the torque's column moves to that link's moment row (document 3, lecture 17, where
      the four-bar's ΣT on link 2 lacks T12 and has a wrong third term).
    - Slider-crank: document 1's rows, nine columns instead of the ten printed, row 6 with F34 = −F43, the friction row
      with the sign that its abs() stands for, moments of the crank about its centre of gravity. With drive="coupler"
      T13 stands on the rod, T12 is known (document 3). form="document" has the slider's moment row, of which document
      3 says that it can be removed, T14 = I4·α4 = 0; with a load's moment, or the slider's centre of gravity off C, it
      is not zero. With friction that makes the ten columns of document 1 and, with F14x, the ten unknowns of document
      3; document 3's b_y is positive for a rod that slopes down, its T12 a load on the crank.
    - Inverted slider-crank: the same equations with the slide's normal force F43n and moment T43; with
      drive="cylinder" cylinder_force stands on block and rocker in place of a torque. The loop: document 3's 2×2,
      example 17-4.
    - Linkage: three equations of each link, in the order of its text; the unknowns are the forces at its pins, normal
      force and moment of each slide (no moment of a block without mass), and those of the drive.

    Examples
    --------
    >>> import linksweep as ls
    >>> scene = ls.example("press")
    >>> page = ls.system(scene, theta2=45.0)
    >>> page.matrix.isel(theta2=0).shape
    (9, 9)
    >>> ls.system(ls.example("engine"), theta2=45.0, form="document").unknown.values[-2:].tolist()
    ['T12', 'T14']
    """
    require_scene(scene)
    refuse(choice_problems("form", form, FORMS))
    index = scene.mechanism.index
    angles = angles_of(scene, angles=angles, theta2=theta2, theta=theta)
    refuse([f"{index} is missing: give an angle or angles, in degrees"] if angles is None else [])
    scene = in_memory(scene)
    grid = scene.grid(as_angles(angles))
    sampled = scene.at(grid)
    status = sample_status(sampled, grid)
    unknowns, equations = of_form(scene, form)
    dims, matrix, rhs = assembled(sampled, grid, form)
    both = {"matrix": Field((*dims, "equation", "unknown"), matrix), "rhs": Field((*dims, "equation"), rhs)}
    blank(both, status)
    variables = {
        "matrix": xr.Variable(*both["matrix"], {"long_name": "coefficients; in rows of moments, arms in m"}),
        "rhs": xr.Variable(*both["rhs"], {"long_name": "right side; forces in N, moments in N m"}),
        "status": xr.Variable(status.dims, status.values, status_attributes(scene.mechanism.status_meanings)),
    }
    coordinates = sampled.labels | sampled.parameters | index_coordinate(scene, grid)
    coordinates |= {
        "equation": xr.Variable("equation", [equation.label for equation in equations]),
        "unknown": xr.Variable("unknown", list(unknowns)),
    }
    command = f"linksweep.system(scene, {index}={angles}, form={form!r})"
    return xr.Dataset(variables, coordinates, provenance(scene, command, coordinates))


def as_angles(theta2: Any) -> Any:
    """Return angles, a single number as a list of one angle, where other functions take it for a count."""
    angle = to_float64(theta2, "angle")
    return [angle] if isinstance(angle, float) else theta2


def of_form(scene: Scene, form: str) -> System:
    """Return the unknowns and the equations of a scene's square system."""
    mechanism, drive = scene.mechanism, scene.drive
    if form == "document":
        return mechanism.document_form(drive)
    return mechanism.unknowns(drive), mechanism.equations(drive)


def names_in(equations: tuple[Equation, ...]) -> tuple[str, ...]:
    """Return the names of the quantities that equations are made of, on both of their sides."""
    names = {entry[1] for row in equations for entry in row.coefficients.values() if isinstance(entry, tuple)}
    return tuple(sorted(names | {row.right_side for row in equations}))


def assembled(scene: Scene, grid: Grid, form: str) -> tuple[tuple[str, ...], np.ndarray, np.ndarray]:
    """Return dims, matrix and right side of a square system, for every design and angle."""
    unknowns, equations = of_form(scene, form)
    fields = compute(scene, grid, names_in(equations))
    sizes = _sizes(scene, grid, fields)
    dims, shape = tuple(sizes), tuple(sizes.values())
    matrix, rhs = np.zeros((*shape, len(equations), len(unknowns))), np.zeros((*shape, len(equations)))
    for i, row in enumerate(equations):
        rhs[..., i] = aligned(fields[row.right_side], dims)
        for unknown, entry in row.coefficients.items():
            j = unknowns.index(unknown)
            matrix[..., i, j] = entry[0] * aligned(fields[entry[1]], dims) if isinstance(entry, tuple) else entry
    return dims, matrix, rhs


def _sizes(scene: Scene, grid: Grid, fields: dict[str, Field]) -> dict[str, int]:
    """Return the sizes of the dims that any of the fields has, and of the grid."""
    sizes = {dim: n for dim, n in scene.inputs.sizes.items() if any(dim in field.dims for field in fields.values())}
    return sizes | {grid.dim: len(grid.angles)}


def structure_of(scene: Scene) -> tuple[Structure, tuple[str, ...]]:
    """Return the structure of a scene's square system, and the names of the quantities that its terms take.

    Terms follow each other along diagonals, so that none waits for the one before, in the same row or column.
    """
    unknowns, equations = of_form(scene, "reduced")
    names, terms = names_in(equations), []
    for i, row in enumerate(equations):
        with_torque = any(_is_torque(unknown) for unknown in row.coefficients)
        for unknown, entry in row.coefficients.items():
            coefficient, name = entry if isinstance(entry, tuple) else (entry, None)
            beside = with_torque and not _is_torque(unknown)
            source = -1 if name is None else names.index(name)
            terms.append((coefficient, (i, unknowns.index(unknown), source, beside)))
        terms.append((1.0, (i, len(unknowns), names.index(row.right_side), False)))
    terms.sort(key=lambda term: (term[1][1] - term[1][0]) % (len(unknowns) + 1))
    coefficients, places = zip(*terms, strict=True)
    torques = np.array([_is_torque(name) for name in unknowns], dtype=np.int64)
    return Structure(np.array(places, dtype=np.int64), np.array(coefficients, dtype=np.float64), torques), names


def _is_torque(unknown: str) -> bool:
    return unknown.startswith("T")


class Sampled(NamedTuple):
    """The square systems of a scene at all samples: their structure, the numbers of their terms, and the samples' dims
    and shape."""

    structure: Structure
    values: list[np.ndarray]
    dims: tuple[str, ...]
    shape: tuple[int, ...]

    def field(self, row: np.ndarray) -> Field:
        """Return one number of each sample as a field."""
        return Field(self.dims, row.reshape(self.shape))


def dense_unknowns(scene: Scene, grid: Grid, refined: bool = False) -> dict[str, Field]:
    """Return the unknowns of the square system by elimination with partial pivoting.

    Rows and columns of the matrix are first scaled to one size, so that units and scales do not decide the pivots.
    `refined` adds one step of iterative refinement.
    """
    systems, names = sampled_systems(scene, grid), of_form(scene, "reduced")[0]
    rows = linear.unknowns(systems.structure, systems.values, refined)
    return {name: systems.field(row) for name, row in zip(names, rows, strict=True)}


def condition_number(scene: Scene, grid: Grid) -> Field:
    """Return the 1-norm condition number of the square system, its rows and columns scaled to one size."""
    systems = sampled_systems(scene, grid)
    return systems.field(linear.condition(systems.structure, systems.values))


def sampled_systems(scene: Scene, grid: Grid) -> Sampled:
    """Return the square systems of a scene at all samples."""
    structure, names = structure_of(scene)
    fields = compute(scene, grid, names)
    sizes = _sizes(scene, grid, fields)
    dims, shape = tuple(sizes), tuple(sizes.values())
    values = [np.broadcast_to(aligned(fields[name], dims), shape).reshape(-1) for name in names]
    return Sampled(structure, values, dims, shape)
