"""Results side by side: the numbers of the files, and a difference is real where it is larger than both errors."""

from __future__ import annotations

import json
import os

import numpy as np
import pytest
import xarray as xr

from base import InputError
from base.results import EXACT
from flankfilm.app.checking import Place
from flankfilm.app.kept import kept_results
from flankfilm.app.side_by_side import compared

FACE = 0.04
POSITION = np.linspace(0.0, 1.0, 5)


def results(root, name, stiffness, error, model_error=0.1, choice="fem", cycle="dry", ratio=1.7):
    """Results as a run writes them, of a stiffness [N/m]."""
    folder = root / name
    (folder / "csv").mkdir(parents=True)
    share = np.array([[0.5, 0.5], [1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.5, 0.5]])
    curve = {"units": "m", "display_units": "um", "long_name": "transmission error", "error": error}
    about = {"units": "N/m", "long_name": "mean mesh stiffness (tangent)"}
    data = xr.Dataset(
        {
            "pair_face_width": ((), FACE, {"units": "m", "display_units": "mm", "error_note": EXACT}),
            "pair_contact_ratio": (
                (),
                ratio,
                {"units": "1", "long_name": "contact ratio", "error_note": EXACT},
            ),
            f"{cycle}_transmission_error": (f"{cycle}_position", 1e3 / stiffness * (1 + POSITION), curve),
            f"{cycle}_load_share": (
                (f"{cycle}_position", f"{cycle}_pair"),
                share,
                {"units": "1", "long_name": "load share", "error_note": "not estimated"},
            ),
            f"{cycle}_mean_tangent_stiffness": (
                (),
                stiffness,
                {**about, "error": error, "model_error": model_error},
            ),
        },
        {f"{cycle}_position": POSITION},
        {"title": name, "decisions_json": json.dumps([{"subject": "stiffness", "choice": choice}])},
    )
    data.to_netcdf(folder / "results.nc", engine="h5netcdf")
    return folder


def rows(root, *names):
    return {row.name: row for row in compared(Place(root, root), names).rows}


def test_a_difference_is_real_where_it_is_larger_than_both_numerical_errors_of_the_same_models(tmp_path):
    results(tmp_path, "a", 8.0e8, 0.005)
    results(tmp_path, "b", 8.07e8, 0.005)  # 0.175 apart, and 0.1 + 0.1009 off
    results(tmp_path, "c", 8.1e8, 0.005)  # 0.25 apart, and 0.1 + 0.10125 off
    row = rows(tmp_path, "a", "b", "c")["dry_mean_tangent_stiffness"]
    assert row.unit == "N/(mm um)"
    assert row.values == ("20.00 ± 0.10", "20.18 ± 0.10", "20.25 ± 0.10")
    assert row.differences == ("", "+0.175", "+0.25")
    assert row.real == (False, False, True)


def test_errors_of_models_count_where_the_models_differ(tmp_path):
    results(tmp_path, "a", 8.0e8, 0.005)
    results(tmp_path, "b", 9.0e8, 0.005, choice="weber-banaschek")
    found = compared(Place(tmp_path, tmp_path), ["a", "b"])
    (row,) = (row for row in found.rows if row.name == "dry_mean_tangent_stiffness")
    assert row.real == (False, False)  # 2.5 apart, and 2.1 + 2.3625 off
    assert row.values[0] == "20.0 ± 2.1"
    assert "different models" in found.about


def test_what_is_exact_is_told_apart_at_any_difference_and_equal_figures_are_counted(tmp_path):
    results(tmp_path, "a", 8.0e8, 0.005)
    results(tmp_path, "b", 8.0e8, 0.005, ratio=1.7 + 1e-6)
    found = compared(Place(tmp_path, tmp_path), ["a", "b"])
    (row,) = found.rows
    assert (row.name, row.values, row.real) == ("pair_contact_ratio", ("1.7", "1.700001"), (False, True))
    assert found.equal == 2  # the face width, and the stiffness


def test_curves_are_those_of_the_files_in_units_that_people_read(tmp_path):
    results(tmp_path, "a", 8.0e8, 0.005)
    results(tmp_path, "b", 4.0e8, 0.005, cycle="lubricated")
    curves = {curve.name: curve for curve in compared(Place(tmp_path, tmp_path), ["a", "b"]).curves}
    assert curves.keys() == {"transmission_error", "load_share"}
    first, second = curves["transmission_error"].runs
    assert curves["transmission_error"].unit == "µm"
    assert first["position"] == POSITION.tolist()
    assert first["lines"][0] == pytest.approx((1.25 * (1 + POSITION)).tolist(), rel=1e-12)
    assert second["lines"][0] == pytest.approx((2.5 * (1 + POSITION)).tolist(), rel=1e-12)
    assert (first["error"], curves["load_share"].runs[0]["error"]) == ("± 0.5 %", "error unknown")
    assert curves["load_share"].runs[0]["lines"][1] == [0.5, None, None, None, 0.5]


def test_results_are_listed_newest_first_without_links_and_hidden_folders(tmp_path):
    for at, name in enumerate(("old-results", "sub/new-results", ".hidden")):
        folder = results(tmp_path, name, 8.0e8, 0.005)
        os.utime(folder / "results.nc", (1e9 + at, 1e9 + at))
    (tmp_path / "link").symlink_to(tmp_path / "old-results")
    head = "variable,figure,value,unit,numerical_error"
    row = "dry_mean_tangent_stiffness,mean mesh stiffness (tangent),8e8,N/m,0.005"
    (tmp_path / "old-results" / "csv" / "uncertainties.csv").write_text(f"{head}\n{row}\n", encoding="utf-8")
    (tmp_path / "sub/new-results" / "csv" / "uncertainties.csv").write_text("nonsense", encoding="utf-8")
    new, old = kept_results(tmp_path)
    assert (new.name, new.scene, new.figures) == ("sub/new-results", "new", ())
    assert old.figures == ("mean mesh stiffness (tangent) 800 N/um ± 0.5 %",)


@pytest.mark.parametrize(("names", "fault"), [
    (["a"], "must be 2 to 6"), (["a", "a"], "must be 2 to 6"), (["a", "../out"], "must be below"),
    (["a", "none"], "does not exist"), (["a", "damaged"], "cannot be read"),
])  # fmt: skip
def test_what_cannot_be_compared_is_refused(tmp_path, names, fault):
    root = tmp_path / "root"
    results(root, "a", 8.0e8, 0.005)
    results(tmp_path, "out", 8.0e8, 0.005)
    (root / "damaged").mkdir()
    (root / "damaged" / "results.nc").write_bytes(b"no data")
    with pytest.raises(InputError, match=fault):
        compared(Place(root, root), names)
