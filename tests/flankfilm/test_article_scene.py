"""The README's scene from TOML to report, against the numbers that are known for its pair."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
import xarray as xr

from tests.flankfilm.explained import unexplained
from tests.flankfilm.program import EXAMPLES, flankfilm

pytestmark = pytest.mark.xdist_group("article")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    out = tmp_path_factory.mktemp("article")
    cache = str(out / "cache")
    done = flankfilm("run", EXAMPLES / "article.toml", "--out", out / "first", FLANKFILM_CACHE=cache)
    (out / "said.txt").write_text(done.stdout + done.stderr, encoding="utf-8")
    return out


@pytest.fixture(scope="module")
def results(folder):
    with xr.open_dataset(folder / "first" / "results.nc", engine="h5netcdf") as dataset:
        yield dataset.load()


def test_the_first_page_shows_what_the_program_says(folder):
    """Texts to the letter, numbers to a tenth: errors hang on the machine's last digits."""
    page = (EXAMPLES.parent / "docs" / "getting_started.md").read_text(encoding="utf-8")
    number = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")
    said = {
        number.sub("#", line): line for line in (folder / "said.txt").read_text(encoding="utf-8").splitlines()
    }
    shown = re.search(r"```text\n(mean mesh stiffness.*?)```", page, re.DOTALL)
    assert shown is not None
    for line in shown[1].splitlines():
        own = said[number.sub("#", line)]
        for one, other in zip(number.findall(line), number.findall(own), strict=True):
            assert float(one) == pytest.approx(float(other), rel=0.1), (line, own)


def test_every_figure_has_an_error_or_says_why_not(results):
    assert not unexplained(results)


def test_a_figure_has_its_own_error_and_not_another_ones(results):
    mean = results.fourier_mean.attrs["error"]
    # of the same meshes and films, but against the bodies instead of the bores
    assert mean == pytest.approx(results.lubricated_mean_secant_stiffness.attrs["error"], rel=0.3)
    assert mean < 0.5 * results.fourier_remainder  # which is what the series leaves out of the curve
    assert results.fourier_amplitude.attrs["error_variable"] == "fourier_harmonic_error"
    assert results.reference_iso_mesh_stiffness.attrs["error_note"].startswith("unknown")
    assert results.dry_mean_stiffness.attrs["converged"] == 1


def test_films_are_in_series_with_the_teeth_before_load_sharing(results):
    share = results.lubricated_load_share.values
    assert np.allclose(share.sum(axis=1), 1.0, atol=1e-9)
    # the film at its own load: films are solved at every ninth position of the cycle, with the forces there
    rho1, force = results.lubricated_rho1.values.ravel(), results.lubricated_forces.values.ravel()
    same = np.nanargmin(np.abs(rho1 - results.film_rho1.values[:, None]), axis=1)
    assert np.allclose(rho1[same], results.film_rho1.values, rtol=1e-9)
    assert np.allclose(force[same], results.film_load.values * 0.040, rtol=2e-4)


def test_the_film_softens_the_mesh_by_less_than_the_tolerance(results):
    for kind in ("secant_stiffness", "stiffness"):
        change = float(results[f"lubricated_{kind}"].mean() / results[f"dry_{kind}"].mean() - 1)
        assert -0.006 < change < -0.002


def test_the_tangent_is_the_series_of_teeth_and_films(results):
    """Films in series with each pair: by virtual work d(1/k) = sum of share_i^2/k_film,i, to the first order in them.

    The median, since a film that lets a tip edge go, or come, changes the tangent by more where that happens.
    """
    share, places = results.lubricated_load_share.values, results.lubricated_rho1.values
    film = np.interp(places, results.film_rho1.values, results.film_stiffness_approach.values)
    softer = np.nansum(share**2 / film, axis=1)  # tip edges touch dry
    dry, wet = (results[f"{name}_stiffness"].values for name in ("dry", "lubricated"))
    assert np.median((1 / wet - 1 / dry) / softer) == pytest.approx(1.0, rel=0.02)


def test_the_film_at_the_pitch_point_is_the_known_one(results):
    """Independent reference at one pair carrying all: h_c 5.888, h_min 5.274 in Moes units; M^-1/8 takes the load."""
    at = int(np.argmax(results.film_load.values))
    u2 = 2 * 0.075 * 2.579 / (2.2e11 * 6.48e-3)
    central = float(results.film_central_thickness[at]) / (6.48e-3 * np.sqrt(u2))
    scaled = central * (float(results.film_load[at]) / 4.434e5) ** 0.13
    assert scaled == pytest.approx(5.888, rel=0.01)


def test_time_series_names_files_that_exist(folder):
    index = folder / "first" / "mesh_cycle.pvd"
    entries = ElementTree.parse(index).getroot().findall(".//DataSet")
    times = np.unique([float(str(entry.get("timestep"))) for entry in entries])
    assert len(times) == 20
    gaps = np.diff([*times, times[0] + 1.0])  # the next base pitch follows as evenly
    np.testing.assert_allclose(gaps, 0.05, atol=1e-8)
    assert [entry.get("name") for entry in entries[:3]] == ["pinion", "wheel", "contacts"]
    assert all((index.parent / str(entry.get("file"))).is_file() for entry in entries)


def test_fields_open_in_vtk_with_sensible_names(folder):
    import pyvista

    grid = pyvista.read(sorted((folder / "first" / "vtk").glob("pinion*.vtu"))[0])
    assert {"von_mises_Pa", "displacement_m"} <= {*grid.point_data}
    assert grid.celltypes[0] == 22  # VTK's quadratic triangle
    assert 2e8 < float(grid["von_mises_Pa"].max()) < 2e9


@pytest.mark.slow
def test_a_second_run_takes_the_stages_from_the_cache_and_gives_the_same_numbers(folder, results):
    cache = str(folder / "cache")
    done = flankfilm("run", EXAMPLES / "article.toml", "--out", folder / "second", FLANKFILM_CACHE=cache)
    announced = [line.split("s  ", 1)[1] for line in done.stderr.splitlines()]
    assert "oil film in series with the teeth" not in announced
    assert announced[-3:] == ["writing the report", "netCDF and CSV files", "fields for ParaView"]
    assert "kept from an earlier run" in (folder / "second" / "report.html").read_text(encoding="utf-8")
    with xr.open_dataset(folder / "second" / "results.nc", engine="h5netcdf") as again:
        xr.testing.assert_identical(again.load(), results)


def test_the_report_shows_every_section(folder):
    page = (folder / "first" / "report.html").read_text(encoding="utf-8")
    for title in (
        "Geometry", "Mesh stiffness", "Oil film", "Loaded teeth", "Fourier stiffness",
        "Physical and dimensionless", "Motion", "Error and cost", "Inputs",
    ):  # fmt: skip
        assert f"<h2>{title}</h2>" in page
    assert page.count("<svg") >= 10
    assert len(page) < 5e6


TABLES = {
    "path_of_contact": "rho1_mm rho2_mm radius_mm entrainment_m_per_s sliding_m_per_s",
    "mesh_cycle_dry": "position secant_stiffness_N_per_m tangent_stiffness_N_per_m stiffness_N_per_m load_share",
    "contacts_dry": "position forces_N hertz_pressure_MPa half_width_um sliding_m_per_s",
    "mesh_cycle_lubricated": "position secant_stiffness_N_per_m tangent_stiffness_N_per_m transmission_error_um",
    "film_along_path": "rho1_mm load_N_per_mm central_thickness_um minimum_thickness_um hertz_pressure_GPa",
    "sweep_up": "speed_rpm frequency",
}
"""Columns that a reader of the tables relies on; those of several entries have their numbers at the end."""


@pytest.mark.parametrize("name", TABLES)
def test_tables_hold_the_figures_that_the_pages_name(folder, name):
    head, *rows = (folder / "first" / "csv" / f"{name}.csv").read_text(encoding="utf-8").splitlines()
    columns = head.split(",")
    for wanted in TABLES[name].split():
        assert any(column.startswith(wanted) for column in columns), (wanted, columns)
    assert rows
    assert {len(row.split(",")) for row in rows} == {len(columns)}
