"""Records become variables and columns that describe themselves."""

from __future__ import annotations

import csv

import numpy as np
import pytest
import xarray as xr

from base import quantity, record
from flankfilm.output.files import LateWriter, write_csv, write_netcdf
from flankfilm.output.tables import columns
from flankfilm.output.variables import merged, of_list, of_models, of_record


@record
class Made:
    """A result with everything that one can have."""

    headline = ("stiffness",)

    position: np.ndarray = quantity("1", "position", "position")
    stiffness: np.ndarray = quantity("N/m", "Mean stiffness", "position")
    share: np.ndarray = quantity("1", "load share", "position pair")
    film: dict[str, np.ndarray] = quantity("m", "film", "position", shown="um")
    stable: np.ndarray = quantity("1", "whether it is stable", "position")
    name: str = quantity("", "name")
    left_out: float | None = quantity("1", "what is not there", default=None)
    error: float = 0.01


@pytest.fixture
def made() -> Made:
    third = 1.0 / 3.0
    return Made(
        position=np.array([third, 2 * third]),
        stiffness=np.array([1e9 / 7, 2e9]),
        share=np.array([[1.0, 0.0], [third, 1 - third]]),
        film={"at C, central": np.array([1e-6, third * 1e-6])},
        stable=np.array([True, False]),
        name="finite elements",
    )


def test_variables_have_names_axes_units_and_errors(made, tmp_path):
    data = merged([of_record("dry", made)], {"title": "a test"})
    write_netcdf(tmp_path / "results.nc", data)
    with xr.open_dataset(tmp_path / "results.nc", engine="h5netcdf") as found:
        assert found.dry_share.dims == ("dry_position", "dry_pair")
        assert "dry_position" in found.indexes
        assert found.dry_stiffness.attrs == {"units": "N/m", "long_name": "mean stiffness", "error": 0.01}
        assert found.dry_film_at_c_central.attrs["long_name"] == "film: at C, central"
        assert found.dry_film_at_c_central.attrs["display_units"] == "um"
        assert found.dry_name.item() == "finite elements"
        assert found.dry_stable.values.tolist() == [1, 0]
        assert "dry_left_out" not in found
        assert np.array_equal(found.dry_stiffness.values, made.stiffness)


def test_variables_keep_their_order(tmp_path):
    data = xr.Dataset({name: ("row", [1.0]) for name in ("torque", "load", "stiffness")})
    write_netcdf(tmp_path / "results.nc", data)
    for engine in ("h5netcdf", "netcdf4"):  # a figure's curves and a study's columns follow it
        with xr.open_dataset(tmp_path / "results.nc", engine=engine) as found:
            assert list(found.data_vars) == ["torque", "load", "stiffness"]


def test_columns_carry_units_and_read_back_exactly(made, tmp_path):
    table = columns(of_record("dry", made), "dry", axis="position")
    write_csv(tmp_path / "dry.csv", table)
    with (tmp_path / "dry.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {"stiffness_N_per_m", "share_pair_1", "share_pair_2", "film_at_c_central_um"} <= set(rows[0])
    for name, values in table.items():
        assert [float(row[name]) for row in rows] == values.tolist(), name


def test_models_stand_beside_each_other_at_the_same_places(made):
    found = of_models("other", {"first": made, "second": made}, "model")
    assert found.other_stiffness.dims == ("other_model", "other_position")
    assert found.other_position.dims == ("other_position",)
    assert found.other_model.values.tolist() == ["first", "second"]


def test_single_numbers_of_records_become_an_axis():
    @record
    class Section:
        """One number."""

        Y_F: float = quantity("1", "form factor")

    found = merged([of_list("iso6336_3", "gear", (Section(1.9), Section(2.1)))], {})
    assert float(found.iso6336_3_Y_F.sel(gear="wheel")) == 2.1


def test_a_tangent_says_so_in_files_and_keeps_its_older_name_for_one_version():
    @record
    class Cycle:
        position: object = quantity("1", "base pitches from A", "position")
        stiffness: object = quantity(
            "N/m", "tangent stiffness", "position", error="error", called="tangent_stiffness"
        )
        error: float = 0.01

    data = of_record("dry", Cycle(np.array([0.25, 0.75]), np.array([1e9, 2e9])))
    assert data.dry_tangent_stiffness.attrs["error"] == 0.01
    assert data.dry_stiffness.attrs == {
        **data.dry_tangent_stiffness.attrs,
        "alias_of": "dry_tangent_stiffness",
    }
    np.testing.assert_array_equal(data.dry_stiffness, data.dry_tangent_stiffness)
    for given in ({"names": ("position", "tangent_stiffness")}, {"axis": "position"}):
        found = columns(data, "dry", **given)
        assert list(found) == ["position", "tangent_stiffness_N_per_m", "stiffness_N_per_m"]


def test_values_follow_after_all_variables_of_a_file_are_defined(tmp_path, monkeypatch):
    """netCDF's library looks through the whole file for each definition that follows values."""
    from xarray.backends import NetCDF4DataStore

    done: list[str | int] = []
    define, write = NetCDF4DataStore.prepare_variable, LateWriter.write
    monkeypatch.setattr(
        NetCDF4DataStore,
        "prepare_variable",
        lambda store, name, *given, **options: done.append(name) or define(store, name, *given, **options),
    )
    monkeypatch.setattr(LateWriter, "write", lambda writer: done.append(len(writer.kept)) or write(writer))
    given = xr.Dataset({"a": ("x", [1.0, 2.0]), "b": ("x", ["one", "two"]), "c": 3})
    write_netcdf(tmp_path / "given.nc", given)
    assert done == ["a", "b", "c", 3]
    for engine in ("netcdf4", "h5netcdf"):
        with xr.open_dataset(tmp_path / "given.nc", engine=engine) as read:
            xr.testing.assert_identical(read.load(), given)
