"""peaks: against dense sweeps and against a reference of a few lines, row by row; names, dims, status, bits."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from long import long_but
from oracle import random_lengths

import linksweep as ls
from linksweep.engine import run
from linksweep.engine.kernel import reduce
from linksweep.results import scene_peaks
from linksweep.scene.parameters import replaced

FORCES = ("F12", "F32", "F43", "F14")
LINKS = ("crank", "coupler", "rocker")
BAR = {"width": 0.02, "thickness": 0.02, "density": 7750.0}


def reduced(function, row, angles) -> tuple[float, float]:
    """A function of engine.kernel.reduce on plain Python numbers, as small requests run it."""
    return function(list(map(float, row)), list(map(float, angles)), np.empty(reduce.WORK))


def grid(n: int) -> np.ndarray:
    return np.arange(n) * (360 / n)


def reference(row: np.ndarray, angles: np.ndarray) -> tuple[float, float]:
    """The first largest sample and its angle."""
    return (math.nan, math.nan) if np.isnan(row).all() else (row[np.nanargmax(row)], angles[np.nanargmax(row)])


# --------------------------------------------------------------------------------------- reductions


def test_random_rows_of_every_length_against_the_reference():
    rng = np.random.default_rng(2)
    for n in [*range(1, 135), 191, 192, 193, 720]:
        for missing in (0.0, 0.3, 0.95, 1.0):
            row = np.where(rng.random(n) < missing, np.nan, rng.normal(size=n))
            np.testing.assert_array_equal(reduced(reduce.largest_sample, row, grid(n)), reference(row, grid(n)))
            least, at = reduced(reduce.least_sample, row, grid(n))
            np.testing.assert_array_equal((-least, at), reference(-row, grid(n)))


def test_every_place_of_a_lone_peak_is_found():
    for n in (64, 100, 129):
        for at in range(n):
            row = np.zeros(n)
            row[at] = 1.0
            assert reduced(reduce.largest_sample, row, grid(n)) == (1.0, grid(n)[at])


def test_of_equal_samples_the_first_is_taken():
    row = np.zeros(300)
    row[[7, 71, 135, 200]] = 2.0  # three of them in one lane
    assert reduced(reduce.largest_sample, row, grid(300)) == (2.0, grid(300)[7])
    row[6] = 2.0
    assert reduced(reduce.largest_sample, row, grid(300)) == (2.0, grid(300)[6])


@pytest.mark.parametrize("level", [3.0, 0.0, -3.0, -1e300])
def test_a_plateau_is_itself(level):
    assert reduced(reduce.largest_sample, np.full(100, level), grid(100)) == (level, 0.0)
    row = np.full(100, level)
    row[40:60] = np.nan
    assert reduced(reduce.largest_sample, row, grid(100)) == (level, 0.0)


@pytest.mark.parametrize("n", [1, 64, 130])
def test_mean_and_mean_square_pass_over_what_is_missing(n):
    rng = np.random.default_rng(n)
    row = rng.normal(size=n)
    row[1::3] = np.nan
    there = row[~np.isnan(row)]
    assert reduced(reduce.mean, row, grid(n)) == (pytest.approx(math.fsum(there) / len(there), rel=1e-13), len(there))
    squares = math.fsum(there**2) / len(there)
    assert reduced(reduce.mean_square, row, grid(n)) == (pytest.approx(squares, rel=1e-13), len(there))
    for function in (reduce.mean, reduce.mean_square):
        value, count = reduced(function, np.full(n, np.nan), grid(n))
        assert math.isnan(value)
        assert count == 0.0


# ------------------------------------------------------------------------------- against dense sweeps


def smooth_designs(seed: int, count: int) -> list[ls.Scene]:
    """Crank-rockers and double cranks that transmit well, with loads."""
    rng = np.random.default_rng(seed)
    result: list[ls.Scene] = []
    while len(result) < count:
        *moving, ground = random_lengths(rng, ("crank_rocker", "double_crank")[len(result) % 2])
        links = [
            ls.Link(x, rng.uniform(0.5, 2.0), 0.1 * x * x, rng.uniform(0.0, x), rng.uniform(-180, 180)) for x in moving
        ]
        load = ls.Load("coupler", force=rng.uniform(-30, 30, 2).tolist(), at=(moving[1], 20.0), frame="link")
        mechanism = ls.FourBar(*links, ground=ground, branch=str(rng.choice(["open", "crossed"])))
        scene = ls.Scene(mechanism, omega2=rng.uniform(3.0, 9.0), gravity=(0.0, -9.81), loads=[load])
        if ls.check(scene).transmission_angle_min > 25.0:
            result.append(scene)
    return result


@pytest.mark.parametrize("scene", [ls.example("press"), *smooth_designs(1, 8)])
def test_peaks_are_those_of_a_dense_sweep(scene):
    dense = ls.sweep(scene, 14_400, of=[*FORCES, "T12"])
    peaks = ls.peaks(scene)
    for name in FORCES:
        row = dense[name].values
        assert float(peaks[f"{name}_peak"]) == pytest.approx(row.max(), rel=1e-6)
        assert abs(dense[name].sel(theta2=peaks[f"{name}_peak_at"], method="nearest") / row.max() - 1) < 1e-5
    torque = dense.T12.values
    scale = np.abs(torque).max()
    assert float(peaks.T12_max) == pytest.approx(torque.max(), abs=1e-6 * scale)
    assert float(peaks.T12_min) == pytest.approx(torque.min(), abs=1e-6 * scale)
    assert float(peaks.T12_peak) == pytest.approx(scale, rel=1e-6)
    assert peaks.T12_peak == max(abs(peaks.T12_max), abs(peaks.T12_min))
    for which in ("max", "min"):
        there = ls.sweep(scene, [float(peaks[f"T12_{which}_at"])], of=["T12"]).T12.item()
        assert there == pytest.approx(float(peaks[f"T12_{which}"]), abs=1e-6 * scale)


def test_of_given_angles_it_is_the_largest_sample():
    scene = ls.example("press")
    for parameters in (97, np.linspace(200.0, 350.0, 301), [330.0, 310.0, 320.0, 310.0]):
        cycle = ls.sweep(scene, parameters, of=["F32", "T12"])
        peaks = ls.peaks(scene, of=["F32", "T12"], theta2=parameters)
        for peak, row in (("F32_peak", cycle.F32), ("T12_max", cycle.T12), ("T12_min", -cycle.T12)):
            value, at = reference(row.values, row.theta2.values)
            assert abs(float(peaks[peak])) == pytest.approx(abs(value), rel=1e-15)
            assert float(peaks[f"{peak}_at"]) == at


def over(dim: str, *values: float) -> xr.DataArray:
    return xr.DataArray([*values], dims=dim)


PARTLY = {
    "a crank longer than the coupler": ("press", {"crank.length": 0.3}, ("Bx", "aG2x", "F32")),
    "a jam in all designs that share": (
        "scissor-lift",
        {"guides.floor.friction": 0.9, "crank.length": 0.51, "rod.width": over("d", 0.06, 0.057)},
        ("Kx", "F15", "T12"),
    ),
}


@pytest.mark.parametrize("machine", PARTLY)
def test_peaks_count_no_angle_at_which_the_sweep_has_no_value(machine):
    """Also of quantities that do not know why: pin B is where it is, whether the coupler reaches it or not."""
    name, numbers, of = PARTLY[machine]
    scene = replaced(replace(ls.example(name), loads=[]), numbers)
    cycle, exact = ls.sweep(scene, 360, of=of), ls.peaks(scene, of=of)
    samples, fine = ls.peaks(scene, of=of, theta2=360), ls.sweep(scene, 36_000, of=of)
    assert (cycle.status != 0).any()
    for name in [name for name in map(str, exact.data_vars) if name.endswith(("_peak", "_max", "_min"))]:
        highest, dense = (_highest(ds, name) for ds in (cycle, fine))
        assert samples[name].dims == exact[name].dims == highest.dims
        np.testing.assert_array_equal(samples[name], -highest if name.endswith("_min") else highest)
        short = dense - (-exact[name] if name.endswith("_min") else exact[name])
        scale = abs(fine[name.rpartition("_")[0]]).max("theta2")
        assert (short <= 1e-12 * scale).all()
        assert ((short >= -0.02 * scale) | np.isinf(short)).all()


@pytest.mark.parametrize(
    ("machine", "numbers", "quantity"),
    [
        ("engine", {"rod.length": 0.055, "friction": 1.5}, "v_slider"),
        ("press", {"crank.length": 0.3, "coupler.length": over("d", 0.22, 0.09)}, "Bx"),
    ],
)
def test_samples_count_where_some_design_that_shares_them_is_ok(machine, numbers, quantity):
    """Friction jams the slider; the press moves over part of a turn, of which each design has its own."""
    scene = replaced(replace(ls.example(machine), loads=[]), numbers)
    cycle, samples = ls.sweep(scene, 360, of=[quantity]), ls.peaks(scene, of=[quantity], theta2=360)
    assert (cycle.status != 0).any()
    for end in ("max", "min"):
        expected = _highest(cycle, f"{quantity}_{end}")
        np.testing.assert_array_equal(samples[f"{quantity}_{end}"], -expected if end == "min" else expected)


def _highest(cycle: xr.Dataset, name: str) -> xr.DataArray:
    """Return the largest of the samples that a peak is of, of their magnitudes or of their opposites."""
    quantity, _, end = name.rpartition("_")
    values = {"peak": abs(cycle[quantity]), "max": cycle[quantity], "min": -cycle[quantity]}[end]
    return values.max("theta2")


def test_means_against_work_and_against_the_sweep():
    scene = ls.example("press")
    peaks = ls.peaks(scene, of=["T12_mean", "T12_rms", "F32_mean", "F32_rms", "theta4_mean"])
    cycle = ls.sweep(scene, 720, of=["T12", "F32", "theta4"])
    for name in ("T12", "F32", "theta4"):
        row = cycle[name].values
        assert float(peaks[f"{name}_mean"]) == pytest.approx(math.fsum(row) / 720, rel=1e-12, abs=1e-12)
        if f"{name}_rms" in peaks:
            assert float(peaks[f"{name}_rms"]) == pytest.approx(math.hypot(*row) / math.sqrt(720), rel=1e-12)
    # weight, constant forces and a constant torque on a link that comes back do no work in a revolution
    assert abs(float(peaks.T12_mean)) < 1e-12 * float(peaks.T12_rms)
    turning = ls.Scene(scene.mechanism, omega2=3.0, loads=[ls.Load("crank", torque=-2.5)])
    assert float(ls.peaks(turning, of="T12_mean").T12_mean) == pytest.approx(2.5, rel=1e-12)


# -------------------------------------------------------------------------------- names, dims, status


def test_the_name_of_a_peak_stands_for_its_quantity():
    press = ls.example("press")
    peaks = ls.peaks(press, of=["F32_peak", "T12_min", "T12", "T12_max"])
    xr.testing.assert_equal(peaks, ls.peaks(press, of=["F32", "T12"]))
    with pytest.raises(ValueError, match="nothing is named 'F32_max'"):  # a magnitude has a peak alone
        ls.peaks(press, of="F32_max")


def test_names_units_and_words():
    peaks = ls.peaks(ls.example("press"))
    pins = [f"{name}_{what}" for name in FORCES for what in ("peak", "peak_at")]
    torque = ["T12_max", "T12_max_at", "T12_min", "T12_min_at", "T12_peak"]
    assert list(peaks.data_vars) == [*pins, *torque, "status"]
    for name in [*pins, *torque]:
        unit = "degree" if name.endswith("_at") else "N m" if name.startswith("T12") else "N"
        assert peaks[name].attrs["units"] == unit
    assert peaks.F32_peak.attrs["long_name"] == (
        "largest magnitude of the force of link 3 (coupler) on link 2 (crank) at pin B"
    )
    assert peaks.T12_min_at.attrs["long_name"].startswith("crank angle of the least torque of the drive on link 2")
    assert peaks.status.dtype == np.int8
    assert peaks.status.attrs["flag_meanings"].split() == ["ok", "partial_revolution", "cannot_assemble", "unbounded"]
    assert peaks.attrs["command"] == "linksweep.peaks(scene)"
    assert ls.peaks(ls.example("press"), theta2=72).attrs["command"] == "linksweep.peaks(scene, theta2=72)"
    assert not peaks.sizes


@pytest.mark.parametrize(("drive", "torque"), [("crank", "T12"), ("coupler", "T13"), ("rocker", "T14")])
def test_the_torque_is_that_of_the_drive(drive, torque):
    mechanism = ls.FourBar(ls.Bar(0.2, **BAR), ls.Bar(0.21, **BAR), ls.Bar(0.22, **BAR), ground=0.08)
    peaks = ls.peaks(ls.Scene(mechanism, omega2=5.0, drive=drive))
    assert f"{torque}_max" in peaks
    assert sum(name.endswith("_max") for name in peaks.data_vars) == 1


def test_only_requested_quantities_are_returned():
    peaks = ls.peaks(ls.example("press"), of=["T12_mean", "F21", "theta4", "F32_rms", "T12_mean"])
    assert list(peaks.data_vars) == [
        "T12_mean",
        "F21_peak",
        "F21_peak_at",
        *(f"theta4_{what}" for what in ("max", "max_at", "min", "min_at", "peak")),
        "F32_rms",
        "status",
    ]
    assert list(ls.peaks(ls.example("press"), of="F32").data_vars) == ["F32_peak", "F32_peak_at", "status"]


def batch() -> ls.Scene:
    """Lengths, masses, speeds and loads on dims of their own."""
    coupler = ls.Link(
        xr.DataArray([0.2, 0.22, 0.24], {"length": [20, 22, 24]}, "length"),
        xr.DataArray([0.5, 0.7], dims="mass"),
        2.8e-3,
        cg_distance=0.1,
    )
    mechanism = ls.FourBar(ls.Bar(0.08, **BAR), coupler, ls.Bar(0.18, **BAR), ground=0.2)
    torque = xr.DataArray([-1.0, 0.0, 4.0, 9.0], {"case": list("abcd")}, "case")
    return ls.Scene(mechanism, xr.DataArray([10.0, 30.0], dims="speed"), loads=[ls.Load("rocker", torque=torque)])


def test_a_peak_has_only_the_dims_that_it_depends_on():
    peaks = ls.peaks(batch(), of=["theta4", "omega4", "aG3x", "F43", "T12", "By"], theta2=60)
    assert peaks.theta4_max.dims == peaks.theta4_max_at.dims == peaks.status.dims == ("length",)
    assert peaks.By_max.dims == ()
    assert set(peaks.omega4_max.dims) == {"length", "speed"}
    assert set(peaks.aG3x_peak.dims) == {"length", "speed"}
    assert set(peaks.F43_peak.dims) == set(peaks.T12_min_at.dims) == {"length", "mass", "speed", "case"}
    assert peaks.length.values.tolist() == [20, 22, 24]
    assert peaks.case.values.tolist() == list("abcd")
    assert peaks["coupler.mass"].values.tolist() == [0.5, 0.7]
    np.testing.assert_allclose(peaks.omega4_max.sel(speed=1), 3 * peaks.omega4_max.sel(speed=0), rtol=1e-12)


def test_a_design_of_a_batch_has_the_peaks_that_it_has_alone():
    peaks = ls.peaks(batch(), theta2=90)
    for length, mass, speed, case in ((0, 0, 0, 0), (1, 1, 1, 3), (2, 0, 1, 2)):
        alone = ls.peaks(design(length, mass, speed, case), theta2=90)
        one = peaks.isel({"length": length, "mass": mass, "speed": speed, "case": case}, missing_dims="ignore")
        for name in alone.data_vars:
            assert one[name].item() == alone[name].item(), name


def design(length: int, mass: int, speed: int, case: int) -> ls.Scene:
    """One design of the batch, in plain numbers."""
    coupler = ls.Link([0.2, 0.22, 0.24][length], [0.5, 0.7][mass], 2.8e-3, cg_distance=0.1)
    mechanism = ls.FourBar(ls.Bar(0.08, **BAR), coupler, ls.Bar(0.18, **BAR), ground=0.2)
    load = ls.Load("rocker", torque=[-1.0, 0.0, 4.0, 9.0][case])
    return ls.Scene(mechanism, omega2=[10.0, 30.0][speed], loads=[load])


def mixed() -> ls.Scene:
    """Designs that close everywhere, in part and nowhere."""
    coupler = xr.DataArray([0.22, 0.10, 0.05, 0.5, 0.21], dims="design")
    links = {"crank": ls.Bar(0.08, **BAR), "rocker": ls.Bar(0.18, **BAR)}
    mechanism = ls.FourBar(**links, coupler=ls.Link(coupler, 0.6, 2e-3), ground=0.2, branch="both")
    return ls.Scene(mechanism, omega2=20.0, gravity=(0.0, -9.81))


def test_status_and_values_of_designs_that_do_not_close():
    peaks = ls.peaks(mixed(), of=["F32", "T12", "T12_mean", "F32_rms"], theta2=360)
    words = [peaks.status.attrs["flag_meanings"].split()[k] for k in peaks.status.values]
    assert words == ["ok", "partial_revolution", "partial_revolution", "cannot_assemble", "ok"]
    cycle = ls.sweep(mixed(), 360, of=["F32", "T12"])
    assert peaks.isel(design=3).drop_vars("status").to_array().isnull().all()
    assert not peaks.isel(design=[0, 1, 2, 4]).to_array().isnull().any()
    for branch in ("open", "crossed"):
        for k in (0, 1, 2, 4):
            one, rows = peaks.sel(branch=branch).isel(design=k), cycle.sel(branch=branch).isel(design=k)
            value, angle = reference(rows.F32.values, grid(360))
            assert float(one.F32_peak) == pytest.approx(value, rel=1e-15)
            assert float(one.F32_peak_at) == pytest.approx(angle, abs=1e-6)
            for sign, name in ((1, "max"), (-1, "min")):
                value, angle = reference(sign * rows.T12.values, grid(360))
                assert float(one[f"T12_{name}"]) == pytest.approx(sign * value, rel=1e-9)
                assert float(one[f"T12_{name}_at"]) == pytest.approx(angle, abs=1e-6)
            assert float(one.T12_mean) == pytest.approx(np.nanmean(rows.T12.values), rel=1e-9, abs=1e-9)
            assert float(one.F32_rms) == pytest.approx(math.sqrt(np.nanmean(rows.F32.values**2)), rel=1e-9)


def change_points(kind: str) -> ls.Scene:
    """Two machines that pass a toggle, at a sample of the status and between two; others a little off it."""
    links = {role: ls.Link(length, 1.0, 0.01) for role, length in zip(LINKS, (1.0, 2.0, 2.0), strict=True)}
    ground, angle = over("design", 3.0, 3.0, 3.0 - 1e-13, 2.9), over("design", 0.0, 0.123, 0.0, 0.0)
    if kind == "FourBar":
        return ls.Scene(ls.FourBar(**links, ground=ground, ground_angle=angle), 1.0)
    pins = {"A": (0.0, 0.0), "D": (ground * np.cos(np.radians(angle)), ground * np.sin(np.radians(angle)))}
    return ls.Scene(ls.Linkage("crank A-B, coupler B-C, rocker D-C", ground=pins, **links), 1.0)


@pytest.mark.parametrize("omega2", [1.0, lambda theta2: 2.0 + np.sin(np.radians(theta2))])
@pytest.mark.parametrize("kind", ["FourBar", "Linkage"])
def test_the_status_of_machines_at_and_near_a_change_point_is_that_of_720_samples(kind, omega2):
    scene = replace(change_points(kind), omega2=omega2)
    status = ls.peaks(scene, of=["omega3"]).status.values
    np.testing.assert_array_equal(status, (ls.sweep(scene, 720, of=["omega3"]).status > 0).any("theta2"))
    assert status.tolist() == [1, 0, 0, 0]


def test_the_status_is_sampled_of_four_bars_that_touch_a_toggle_alone(monkeypatch):
    sampled = []

    def reduce_rows(plan, reductions, inputs, grid, sizes):
        sampled.append([*sizes.values()])
        return run.reduce_rows(plan, reductions, inputs, grid, sizes)

    monkeypatch.setattr(scene_peaks, "reduce_rows", reduce_rows)
    ls.peaks(change_points("FourBar"), of=["omega3"])
    assert sampled == [[2]]


# ------------------------------------------------------------------------------------------------ bits


@pytest.mark.parametrize("scene", long_but([batch, mixed], mixed))
def test_compiled_and_interpreted_peaks_are_equal_to_the_bit(scene, monkeypatch):
    of = ["F32", "F14", "T12", "T12_mean", "F43_rms", "aG3y_rms"]
    result = []
    for compile_after in (np.inf, -1):
        monkeypatch.setattr(run, "COMPILE_AFTER", compile_after)
        result += [ls.peaks(scene(), of=of, theta2=angles) for angles in (150, np.linspace(10.0, 300.0, 77))]
    for interpreted, compiled in zip(result[:2], result[2:], strict=True):
        assert list(interpreted.data_vars) == list(compiled.data_vars)
        for name in interpreted.data_vars:
            assert interpreted[name].dims == compiled[name].dims
            np.testing.assert_array_equal(interpreted[name].values, compiled[name].values, err_msg=str(name))


def test_peaks_do_not_depend_on_the_number_of_threads(monkeypatch):
    monkeypatch.setattr(run, "SAMPLES_PER_THREAD", 100)
    monkeypatch.setattr(run, "COMPILE_AFTER", -1)
    one, two, many = (ls.peaks(batch(), of=["F32", "T12"], theta2=90, threads=n) for n in (1, 2, 7))
    xr.testing.assert_identical(one, two)
    xr.testing.assert_identical(one, many)


def test_a_damper_on_a_machine_whose_cylinders_are_moved_changes_nothing_without_a_coefficient():
    """The angle at which its ends come closest depends on the lengths of the cylinders, which change with theta2."""
    scene = ls.example("excavator")
    idle = ls.Damper(("ground", 1.0, 3.0), ("bucket", 0.3, 10.0), 0.0)
    plain, more = (ls.peaks(s, of=["force_c2"]) for s in (scene, replace(scene, loads=[*scene.loads, idle])))
    np.testing.assert_allclose(more.force_c2_max, plain.force_c2_max, rtol=1e-10)
