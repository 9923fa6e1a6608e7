"""Tables: a row for each design and angle, units in the header, every digit; files written whole or not at all."""

import csv
import math
import sys

import numpy as np
import openpyxl
import pandas as pd
import pytest
import xarray as xr

import linksweep as ls

PRESS = ls.example("press")


def study(n=8) -> xr.Dataset:
    made = ls.sample(PRESS, {"ground": (0.1, 0.3), "omega2": [20.0, 30.0]}, n=n)
    return ls.peaks(made, of=["F32", "T12"], theta2=36)


def test_designs_left_out_by_a_condition_are_rows_of_empty_cells(tmp_path):
    designs = study()
    some = designs.where(designs.omega2 < 25.0)
    left_out = ~(designs.omega2 < 25.0).values
    words = some.linksweep.to_pandas()["status"].to_numpy()
    assert 0 < left_out.sum() < 8 and (words[left_out] == "").all()
    np.testing.assert_array_equal(words[~left_out], designs.linksweep.to_pandas()["status"].to_numpy()[~left_out])
    ls.save(some, tmp_path / "some.csv")
    table = pd.read_csv(tmp_path / "some.csv")
    assert (table["status"].isna() == left_out).all() and (table["F32_peak [N]"].isna() >= left_out).all()


def test_a_row_for_each_design():
    designs = study()
    table = designs.linksweep.to_pandas()
    assert list(table.columns[:4]) == ["design", "ground [m]", "omega2 [rad/s]", "F32_peak [N]"]
    assert table["design"].tolist() == list(range(8))
    for name, header in (("ground", "ground [m]"), ("F32_peak", "F32_peak [N]"), ("T12_max_at", "T12_max_at [degree]")):
        np.testing.assert_array_equal(table[header].to_numpy(), designs[name].values)
    words = designs.status.attrs["flag_meanings"].split()
    assert table["status"].tolist() == [words[k] for k in designs.status.values]
    assert set(table["status"]) >= {"ok", "partial_revolution"}


def test_a_row_for_each_design_and_angle_angles_innermost():
    cycle = ls.sweep(ls.sample(PRESS, {"omega2": (20, 30)}, n=3), theta2=4, of=["theta4", "T12"])
    table = cycle.linksweep.to_pandas()
    assert list(table.columns) == [
        "design",
        "theta2 [degree]",
        "omega2 [rad/s]",
        "theta4 [degree]",
        "T12 [N m]",
        "status",
    ]
    assert table["design"].tolist() == [0] * 4 + [1] * 4 + [2] * 4
    assert table["theta2 [degree]"].tolist() == [0.0, 90.0, 180.0, 270.0] * 3
    for _, row in table.iterrows():  # theta4 is the same for all designs
        at = cycle.sel(design=row["design"], theta2=row["theta2 [degree]"])
        assert (row["theta4 [degree]"], row["T12 [N m]"]) == (float(at.theta4), float(at.T12))
        assert row["omega2 [rad/s]"] == float(at.omega2)


def test_several_dims_with_and_without_labels():
    torque = xr.DataArray([1.0, 2.0], dims="case")
    mechanism = ls.FourBar(PRESS.mechanism.crank, PRESS.mechanism.coupler, PRESS.mechanism.rocker, 0.2, branch="both")
    peaks = ls.peaks(ls.Scene(mechanism, 30.0, loads=[ls.Load("rocker", torque=torque)]), of=["F32"], theta2=8)
    table = peaks.linksweep.to_pandas()
    assert set(zip(table["branch"], table["case"], strict=True)) == {
        (b, c) for b in ("open", "crossed") for c in (0, 1)
    }
    for _, row in table.iterrows():
        assert row["F32_peak [N]"] == float(peaks.F32_peak.sel(branch=row["branch"]).isel(case=row["case"]))
        assert row["loads[1].torque [N m]"] == row["case"] + 1.0


def test_one_design_is_one_row():
    table = ls.peaks(PRESS, of=["F32"], theta2=36).linksweep.to_pandas()
    assert len(table) == 1 and list(table.columns) == ["F32_peak [N]", "F32_peak_at [degree]", "status"]
    check = ls.check(PRESS).linksweep.to_pandas()
    assert set(check["grashof"]) == {"crank_rocker"}


def test_the_file_reads_back_to_the_bit(tmp_path):
    designs = study()
    designs["F32_peak"][2] = math.inf
    designs.linksweep.to_csv(tmp_path / "study.csv")
    with open(tmp_path / "study.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    table = designs.linksweep.to_pandas()
    assert list(rows[0]) == list(table.columns) and len(rows) == 8
    for header in table.columns.drop("status"):
        read = [float(row[header] or "nan") for row in rows]
        np.testing.assert_array_equal(read, table[header].to_numpy())
    assert [row["status"] for row in rows] == table["status"].tolist()
    impossible = [row["T12_peak [N m]"] == "" for row in rows]
    assert impossible == np.isnan(designs.T12_peak.values).tolist() and rows[2]["F32_peak [N]"] == "inf"


def test_a_file_is_written_whole_or_not_at_all(tmp_path, monkeypatch):
    path = tmp_path / "study.csv"
    path.write_text("old")

    def breaks(self, file, **options):
        file.write_text("half")
        raise OSError("disk full")

    monkeypatch.setattr(pd.DataFrame, "to_csv", breaks)
    with pytest.raises(OSError, match="disk full"):
        study(n=4).linksweep.to_csv(path)
    assert path.read_text() == "old"
    assert [file.name for file in tmp_path.iterdir()] == ["study.csv"]


def test_a_missing_folder_of_a_table_is_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match="there is no folder"):
        study(n=4).linksweep.to_csv(tmp_path / "nowhere" / "study.csv")


# ------------------------------------------------------------------------------------------- Excel, units


def sheets(path) -> dict[str, list[tuple]]:
    """Return the cells of each sheet of an Excel file, formulas as formulas."""
    book = openpyxl.load_workbook(path)
    return {sheet.title: [tuple(cell.value for cell in row) for row in sheet.rows] for sheet in book}


def test_an_excel_file_has_the_table_its_meanings_and_the_scene(tmp_path):
    designs = study()
    designs["F32_peak"][2] = math.inf
    ls.save(designs, tmp_path / "study.xlsx")
    book, table = sheets(tmp_path / "study.xlsx"), designs.linksweep.to_pandas()
    header, *rows = book["results"]
    assert list(header) == list(table.columns) and len(rows) == 8
    for k, name in enumerate(header):
        for cell, value in zip((row[k] for row in rows), table[name], strict=True):
            if isinstance(value, str) or math.isinf(value):
                assert cell == str(value)
            else:
                assert cell is None if math.isnan(value) else cell == pytest.approx(value, rel=1e-15)
    meanings = {row[0]: row[1:] for row in book["columns"]}
    assert meanings["F32_peak [N]"] == ("N", designs.F32_peak.long_name)
    assert "\n".join(row[0] or "" for row in book["scene"]) == designs.scene.rstrip("\n")


def test_no_label_of_an_excel_file_is_a_formula(tmp_path):
    cases = xr.DataArray([1.0, 2.0], {"case": ["=1+1", "@x"]}, "case")
    peaks = ls.peaks(ls.Scene(PRESS.mechanism, 30.0, loads=[ls.Load("rocker", torque=cases)]), of=["F32"], theta2=8)
    peaks.linksweep.to_excel(tmp_path / "cases.xlsx")
    cells = openpyxl.load_workbook(tmp_path / "cases.xlsx")["results"]
    assert [(cell.value, cell.data_type) for cell in cells["A"][1:]] == [("=1+1", "s"), ("@x", "s")]


def test_more_rows_than_a_sheet_has_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("linksweep.files.spreadsheet.MOST_ROWS", 7)
    with pytest.raises(ValueError, match="ds has 8 rows: an Excel sheet holds 7; write"):
        study().linksweep.to_excel(tmp_path / "study.xlsx")
    assert list(tmp_path.iterdir()) == []


def test_without_openpyxl_excel_files_say_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(ImportError, match=r'need openpyxl: pip install "linksweep\[excel\]"'):
        study(n=2).linksweep.to_excel(tmp_path / "study.xlsx")


def test_tables_have_the_units_of_the_session_and_netcdf_those_of_si(tmp_path):
    peaks = ls.peaks(PRESS, of=["F32"], theta2=36)
    with ls.units("US"):
        for name in ("peaks.csv", "peaks.xlsx", "peaks.nc"):
            ls.save(peaks, tmp_path / name)
    pounds = float(peaks.F32_peak) / 4.4482216152605
    (row,) = csv.DictReader((tmp_path / "peaks.csv").read_text().splitlines())
    assert float(row["F32_peak [lbf]"]) == pytest.approx(pounds, rel=1e-15)
    header, cells = sheets(tmp_path / "peaks.xlsx")["results"]
    assert dict(zip(header, cells, strict=True))["F32_peak [lbf]"] == pytest.approx(pounds, rel=1e-15)
    with xr.open_dataset(tmp_path / "peaks.nc") as ds:
        xr.testing.assert_identical(ds.load(), peaks)
