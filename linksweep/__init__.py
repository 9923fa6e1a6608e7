"""Sweep planar linkages over whole revolutions: motion, pin forces and torques of many designs, and exact peaks."""

from typing import Any

from linksweep.base.public.on_demand import modules_of_names, public_name, when_imported
from linksweep.base.version import installed_version

_MODULES = modules_of_names(__file__)
__all__ = [*_MODULES]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return installed_version()
    globals()[name] = item = public_name(__name__, name, _MODULES)
    return item


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


@when_imported("xarray")
def _register_accessor(xarray: Any) -> None:
    """Add `Dataset.linksweep`, which is imported when it is first used."""

    @xarray.register_dataset_accessor("linksweep")
    def accessor(ds: Any) -> Any:
        from linksweep.plot.accessor import Cycle

        return Cycle(ds)
