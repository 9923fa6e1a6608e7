"""The accessor `.linksweep` of Datasets: plots, tables, and the scene of their results.

`linksweep/__init__.py` registers it.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from functools import wraps
from inspect import Parameter, cleandoc, signature
from typing import TYPE_CHECKING, Any

from linksweep import plot
from linksweep.base.public.clear_calls import clear_method
from linksweep.files import spreadsheet, table
from linksweep.files.netcdf import scene_of
from linksweep.scene.scene import Scene
from linksweep.tables.answers import answer_of

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

FIRST_PARAMETER = re.compile(r"(?<=Parameters\n----------\n)\S.*\n(?: {4}.*\n)*")
NO_PARAMETERS = re.compile(r"Parameters\n----------\n\n")


class Cycle:
    """A Dataset of linksweep with its plots and tables, as ``ds.linksweep``.

    It prints, and shows in a notebook, as the table that the command line prints: names, values, units and angles.
    Every function of `linksweep.plot` that takes a Dataset is a method, with the Dataset as its first argument.

    Parameters
    ----------
    ds : Dataset
        Results of linksweep.

    Examples
    --------
    >>> import linksweep as ls
    >>> cycle = ls.sweep(ls.example("press"))
    >>> cycle.linksweep.scene == ls.example("press")
    True
    >>> print(ls.peaks(ls.example("press"), of=["F32", "T12"]).linksweep)
    quantity     value  unit  at theta2
    F32_peak   354.538  N       300.27°
    T12_max    20.5233  N m     324.69°
    T12_min   -21.2235  N m     183.20°
    """

    def __init__(self, ds: xr.Dataset) -> None:
        self._ds = ds

    def __repr__(self) -> str:
        return repr(answer_of(self._ds))

    def _repr_html_(self) -> str:
        return answer_of(self._ds)._repr_html_()

    @property
    def scene(self) -> Scene:
        """Scene that the Dataset was computed from.

        Raises
        ------
        ValueError
            If the Dataset has lost it.

        Examples
        --------
        >>> import linksweep as ls
        >>> round(ls.peaks(ls.example("press")).linksweep.scene.omega2, 3)  # rad/s
        31.416
        """
        return scene_of(self._ds)

    @clear_method
    def to_pandas(self) -> pd.DataFrame:
        """Return the Dataset as a table whose columns have their units in their names, always of SI.

        Returns
        -------
        pandas DataFrame
            A row for each design, and for each angle of a cycle; status is in words.
        """
        return table.to_pandas(self._ds)

    @clear_method
    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Write the table as a CSV file, whole or not at all, in the units in which results are shown.

        Parameters
        ----------
        path : str or PathLike
            File to write.
        """
        table.to_csv(self._ds, path)

    @clear_method
    def to_excel(self, path: str | os.PathLike[str]) -> None:
        """Write the table as an Excel file, in the units in which results are shown, with the meaning of each column.

        Parameters
        ----------
        path : str or PathLike
            File to write, "study.xlsx".
        """
        spreadsheet.to_excel(self._ds, path)


def _method(draw: Callable[..., Any]) -> Callable[..., Any]:
    """Return a plot as a method that passes the Dataset."""

    @wraps(draw)
    def method(self: Cycle, *args: Any, **kwargs: Any) -> Any:
        return draw(self._ds, *args, **kwargs)

    plain = signature(draw)
    itself = Parameter("self", Parameter.POSITIONAL_OR_KEYWORD)
    text = cleandoc(draw.__doc__ or "").partition("\n\nExamples\n")[0] + "\n"
    method.__signature__ = plain.replace(parameters=[itself, *[*plain.parameters.values()][1:]])  # type: ignore[attr-defined]
    method.__doc__ = NO_PARAMETERS.sub("", FIRST_PARAMETER.sub("", text))
    return clear_method(method)


for _draw in (getattr(plot, name) for name in plot.__all__):
    if "Dataset" in str(next(iter(signature(_draw).parameters.values())).annotation):
        setattr(Cycle, _draw.__name__, _method(_draw))
