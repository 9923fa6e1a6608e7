"""List the quantities that can be requested of a scene, as a table to read and to search."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import astuple, dataclass, fields
from html import escape
from typing import TYPE_CHECKING, overload

from linksweep.base.public.clear_calls import clear_method
from linksweep.base.text_table import aligned
from linksweep.base.validate import name_problems, one_text_problems, refuse
from linksweep.engine.trace.plan import plan
from linksweep.results.compute import counts_without_angles, require_scene
from linksweep.results.dataset import STATUS_AT_LONG_NAME, STATUS_LONG_NAME
from linksweep.results.sweep import default_names
from linksweep.results.system import names_in, of_form
from linksweep.scene.at_sections import with_sections
from linksweep.scene.designs.lazy import lazy_paths, stand_in
from linksweep.scene.scene import Scene

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class AvailableQuantity:
    """A quantity that can be requested of a scene.

    Parameters
    ----------
    name : str
        Its name in a request.
    units : str
        Its unit, in UDUNITS spelling; "1" where it has none.
    dims : tuple of str
        The dims that it depends on: those of designs, and theta2.
    default : bool
        True where `linksweep.sweep` computes it by default.
    long_name : str
        Its meaning, and how its sign counts.
    """

    name: str
    units: str
    dims: tuple[str, ...]
    default: bool
    long_name: str

    def __str__(self) -> str:
        return "  ".join(filter(None, self.cells))

    @property
    def cells(self) -> tuple[str, ...]:
        """Return its entries as text."""
        return self.name, self.units, ", ".join(self.dims), "yes" if self.default else "", self.long_name


HEADER = ("name", "unit", "dims", "default", "meaning")


@dataclass(frozen=True, repr=False)
class QuantityTable(Sequence[AvailableQuantity]):
    """A table of quantities, as `linksweep.quantities` returns it.

    It prints as text, shows as a table in a notebook, and gives its rows by name, by place or one after the other.

    Parameters
    ----------
    rows : tuple of AvailableQuantity
        One for each quantity.

    Examples
    --------
    >>> import linksweep as ls
    >>> table = ls.quantities(ls.example("press"))
    >>> table["F32"].units, "F32" in table, table.names[:3]
    ('N', True, ('theta3', 'theta4', 'transmission_angle'))
    """

    rows: tuple[AvailableQuantity, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Return the names, as `linksweep.sweep` takes them."""
        return tuple(row.name for row in self.rows)

    @overload
    def __getitem__(self, key: str | int) -> AvailableQuantity: ...

    @overload
    def __getitem__(self, key: slice) -> QuantityTable: ...

    def __getitem__(self, key: str | int | slice) -> AvailableQuantity | QuantityTable:
        """Return the row of a name or a place, or the table of a slice; raise ValueError for an unknown name."""
        if isinstance(key, str):
            refuse(name_problems("quantity", key, self.names, "the table's names"))
            key = self.names.index(key)
        return QuantityTable(self.rows[key]) if isinstance(key, slice) else self.rows[key]

    def __len__(self) -> int:
        return len(self.rows)

    def __contains__(self, key: object) -> bool:
        return key in self.names or key in self.rows

    @clear_method
    def search(self, words: str) -> QuantityTable:
        """Return the quantities that have all these words in their name, unit or meaning.

        Parameters
        ----------
        words : str
            Words, in small or capital letters.

        Returns
        -------
        QuantityTable
            Table of these quantities.
        """
        refuse(one_text_problems("search", words, "words, as in one text"))
        parts = words.casefold().split()
        return QuantityTable(tuple(row for row in self.rows if all(part in str(row).casefold() for part in parts)))

    @clear_method
    def to_pandas(self) -> pd.DataFrame:
        """Return the table as a DataFrame.

        Returns
        -------
        DataFrame
            A row for each quantity, its index the names.
        """
        import pandas as pd

        columns = [item.name for item in fields(AvailableQuantity)]
        return pd.DataFrame([astuple(row) for row in self.rows], columns=columns).set_index("name")

    def __repr__(self) -> str:
        return "\n".join(aligned([HEADER, *(row.cells for row in self.rows)], right=()))

    def _repr_html_(self) -> str:
        body = "".join(_html_row(row.cells, "td") for row in self.rows)
        return f"<table><thead>{_html_row(HEADER, 'th')}</thead><tbody>{body}</tbody></table>"


def quantities(scene: Scene, search: str | None = None) -> QuantityTable:
    """List every quantity that can be requested of a scene.

    Parameters
    ----------
    scene : Scene
        Scene of any number of designs.
    search : str, default None
        Words, in small or capital letters, that a quantity must have in its name, unit or meaning; None for all.

    Returns
    -------
    QuantityTable
        A row for each quantity with its name, unit, dims, whether a default sweep has it, and its meaning with the
        sign convention. Nothing is computed. Design dims are in the order of the scene, theta2 (in a loop, theta) is
        the last.

    Raises
    ------
    ValueError
        For anything but a Scene, and for words that are no text.

    Notes
    -----
    `linksweep.sweep` takes all of the names; `linksweep.peaks` takes all but `cond`, `status` and `status_at`, each of
    them also with one of the endings `_mean`, `_rms`, `_bound` and `_samples`.

    Examples
    --------
    >>> import linksweep as ls
    >>> ls.quantities(ls.example("press"), "torque")
    name            unit  dims    default  meaning
    T12             N m   theta2  yes      torque of the drive on link 2 (crank), positive counter-clockwise
    torque_ratio    1     theta2           torque that the rocker gives per torque on the crank, without any losses
    reduced_torque  N m   theta2           drive reduced to the crank: its work per radian of the crank
    """
    require_scene(scene)
    default, dims = {*default_names(scene), "status"}, _dims(scene)
    rows = [
        AvailableQuantity(item.name, item.units, dims[item.name], item.name in default, item.long_name)
        for item in scene.table.quantities
    ]
    rows.append(AvailableQuantity("status", "1", dims["status"], True, STATUS_LONG_NAME))
    if scene.mechanism.places:
        rows.append(AvailableQuantity("status_at", "1", dims["status_at"], False, STATUS_AT_LONG_NAME))
    table = QuantityTable(tuple(rows))
    return table if search is None else table.search(search)


def _dims(scene: Scene) -> dict[str, tuple[str, ...]]:
    """Return the dims of each quantity, read off the plan without computing anything."""
    sampled = _with_samples(with_sections(stand_in(scene) if lazy_paths(scene) else scene, scene.table.quantity))
    of_status = ("status", "status_at") if scene.mechanism.places else ("status",)
    names = [name for name in (*scene.table.quantity, *of_status) if name != "cond"]
    of_matrix = names_in(of_form(scene, "reduced")[1])
    request = plan(scene.table, tuple(dict.fromkeys([*names, *of_matrix])), sampled.inputs.forms)
    order = (*sampled.inputs.sizes, request.index)
    known = {name: {*request.dims(request.outputs[name])} for name in request.outputs}
    known["cond"] = {request.index}.union(*(known[name] for name in of_matrix))
    return {name: tuple(dim for dim in order if dim in dims) for name, dims in known.items()}


def _with_samples(scene: Scene) -> Scene:
    """Return the scene at one angle, or at as many as an array over the index without coordinates has."""
    counts = [*counts_without_angles(scene).values()]
    return scene.at(scene.grid(counts[0])) if counts else scene.at_one_angle


def _html_row(cells: Iterable[str], tag: str) -> str:
    return f"<tr>{''.join(f'<{tag}>{escape(cell)}</{tag}>' for cell in cells)}</tr>"
