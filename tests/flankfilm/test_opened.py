"""Files of results opened again: coordinates, units and errors are there; what is damaged or foreign is refused."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import flankfilm as ff
from base import InputError
from flankfilm.studies.files import StudyOutcome
from flankfilm.studies.plan import plan_of
from flankfilm.studies.row import RowResult
from flankfilm.studies.run import StudyResults
from flankfilm.studies.study_file import StudyFile
from tests.flankfilm.scenes import ishikawa


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    where = tmp_path_factory.mktemp("opened")
    ff.run(ff.parse_scene(ishikawa("opened", "geometry", "closed-forms", "stiffness")), where, cache=False)
    return where


def test_a_run_opens_with_coordinates_units_and_errors(folder):
    data = ff.open_results(folder)
    assert data.identical(ff.open_results(str(folder / "results.nc")))
    assert {"dry_position", "single_pair_rho1"} <= set(data.coords)
    assert data.dry_tangent_stiffness.units == data.dry_stiffness.units == "N/m"
    near = data.dry_stiffness.sel(dry_position=0.5, method="nearest")
    assert float(near) > 0
    for name, variable in data.variables.items():
        assert "units" in variable.attrs, name
        assert {"error", "error_variable", "error_note"} & set(variable.attrs), name
    # it is in memory: the file can go
    assert data.chunks == {}
    assert np.isfinite(data.pair_contact_ratio.values)


def test_a_study_opens_too(tmp_path):
    raw = {"scene": ff_scene(tmp_path), "outputs": ["contact_ratio"], "vary": {"pair.module_mm": [1.5, 2.0]}}
    plan = plan_of(StudyFile.model_validate(raw), tmp_path)
    rows = (RowResult(0, (1.6,), 0.1), RowResult(1, (1.7,), 0.1))
    StudyOutcome(StudyResults(plan, rows, 2, 1.0)).written(tmp_path)
    data = ff.open_results(tmp_path)
    assert data["pair.module_mm"].values.tolist() == [1.5, 2.0]
    assert data.contact_ratio.values.tolist() == [1.6, 1.7]


def ff_scene(folder):
    (folder / "scene.toml").write_text(ishikawa("opened", "geometry"), encoding="utf-8")
    return "scene.toml"


def test_what_is_damaged_missing_or_foreign_is_refused(folder, tmp_path):
    whole = (folder / "results.nc").read_bytes()
    for name, content in (
        ("short.nc", whole[: len(whole) // 3]),
        ("empty.nc", b""),
        ("text.nc", b"title = 1"),
        ("flipped.nc", whole[:64] + bytes(255 - byte for byte in whole[64:4096]) + whole[4096:]),
    ):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(InputError, match=r"(?s)cannot be read.*Name a results\.nc"):
            ff.open_results(tmp_path / name)
    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(tmp_path / "foreign.nc", engine="h5netcdf")
    with pytest.raises(InputError, match="no results that flankfilm wrote"):
        ff.open_results(tmp_path / "foreign.nc")
    with pytest.raises(InputError, match="does not exist"):
        ff.open_results(tmp_path / "nowhere.nc")
    with pytest.raises(InputError, match="holds none of"):
        ff.open_results(tmp_path)
