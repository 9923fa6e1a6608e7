"""Files keep to the CF conventions that they state; `.ci/nightly` runs a checker of others on them."""

import netCDF4
import pytest
import xarray as xr

import linksweep as ls

JOBS = {
    "sweep": lambda scene: ls.sweep(scene, 24),
    "peaks": lambda scene: ls.peaks(ls.sample(scene, {"ground": (0.19, 0.21)}, n=4), of=["F32"], theta2=24),
    "bearings": lambda scene: ls.bearings(scene, theta2=24),
    "orders": lambda scene: ls.orders(ls.sweep(scene, 24, of=["Fsx"]), ["Fsx"], n=3),
}


@pytest.mark.parametrize("job", [*JOBS, "study"])
def test_files_keep_to_the_conventions_that_they_state(job, tmp_path):
    """CF 1.11, §2.5.1 and §2.6.2: a coordinate has no missing values, and the history is stated."""
    path = tmp_path / "result.nc"
    if job == "study":
        ls.study(ls.sample(ls.example("press"), {"ground": (0.19, 0.21)}, n=4), path, of=["F32"])
    else:
        ls.save(JOBS[job](ls.example("press")), path)
    with xr.open_dataset(path) as ds:
        coordinates = [str(name) for name in ds.coords]
    with netCDF4.Dataset(path) as file:
        assert coordinates
        assert [name for name in coordinates if "_FillValue" in file[name].ncattrs()] == []
        assert file.getncattr("history") == f"linksweep {ls.__version__}: {file.getncattr('command')}"
