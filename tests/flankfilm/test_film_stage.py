"""Starved and mixed films through scenes: what is held decides the stiffness of the mesh."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from flankfilm.coupling import LubricatedCycle
from flankfilm.files.cache import Cache
from flankfilm.report.film_parts import headlines
from flankfilm.scene import parse_scene
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import FILM
from tests.flankfilm.scenes import ARTICLE

SCENE = f"""
wants = ["film"]
tolerance = 0.005
{ARTICLE}
[stiffness]
model = "ishikawa"
[film]
"""
ROUGH = """
[roughness]
density_per_mm2 = 25000
tip_radius_um = 10
law = "greenwood-williamson"
"""


@pytest.fixture(autouse=True)
def _few_films(monkeypatch):
    monkeypatch.setattr("flankfilm.coupling.films.films.FILM_POSITIONS", 8)
    monkeypatch.setattr("flankfilm.coupling.films.film_points.profiles", lambda *given: {})


def stage(film: str = "") -> LubricatedCycle:
    return Engine(parse_scene(SCENE + film), Cache(None))[FILM]


@pytest.fixture(scope="module")
def flooded() -> LubricatedCycle:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flankfilm.coupling.films.films.FILM_POSITIONS", 8)
        patch.setattr("flankfilm.coupling.films.film_points.profiles", lambda *given: {})
        return stage()


@pytest.fixture(scope="module")
def starved() -> LubricatedCycle:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("flankfilm.coupling.films.films.FILM_POSITIONS", 8)
        patch.setattr("flankfilm.coupling.films.film_points.profiles", lambda *given: {})
        return stage('supply = "oil-layer"\noil_layer_um = 0.11\n')


@pytest.mark.parametrize(
    "supply", ['supply = "oil-layer"\noil_layer_um = 50\n', 'supply = "meniscus"\nmeniscus_mm = 20\n']
)
def test_plenty_of_oil_is_the_flooded_film(flooded: LubricatedCycle, supply: str):
    """A meniscus a hundred half-widths away starves by 1e-4; the film's stiffness is known to 6 % each way.

    The film changes the tangent by up to 1 %, so a tenth of that is what two such errors may make.
    """
    plenty = stage(supply)
    assert plenty.film.central_thickness == pytest.approx(flooded.film.central_thickness, rel=2e-3)
    assert plenty.stiffness == pytest.approx(flooded.stiffness, rel=1e-3)
    assert plenty.secant_stiffness_change == pytest.approx(flooded.secant_stiffness_change, rel=0.05)
    assert plenty.film.starvation == pytest.approx(1.0, abs=2e-3)


def test_the_layer_passes_every_contact(starved: LubricatedCycle):
    assert starved.film.oil_layer == pytest.approx(0.11e-6, rel=1e-6)
    density = 1 + 0.6e-9 * starved.film.hertz_pressure / (1 + 1.7e-9 * starved.film.hertz_pressure)
    assert starved.film.central_thickness == pytest.approx(0.11e-6 / density, rel=0.01)
    assert starved.film.minimum_thickness.min() < 0.1e-6


@pytest.mark.slow
def test_with_the_layer_held_the_mesh_tends_to_the_dry_one(
    flooded: LubricatedCycle, starved: LubricatedCycle
):
    """The film cannot thin but by compression: about a thirtieth of what the flooded film changes."""
    assert abs(starved.stiffness_change) < 0.1 * abs(flooded.stiffness_change)
    assert starved.stiffness_change < 0.0
    thinner = stage('supply = "oil-layer"\noil_layer_um = 0.03\n')
    assert abs(thinner.stiffness_change) < abs(starved.stiffness_change)


def test_with_the_meniscus_held_the_same_film_softens_the_mesh(
    flooded: LubricatedCycle, starved: LubricatedCycle
):
    held = starved.otherwise["same film, meniscus held"]
    dry = starved.stiffness.mean() / (1 + starved.stiffness_change)
    change = held.stiffness.mean() / dry - 1
    assert change < 5 * flooded.stiffness_change
    assert starved.otherwise["smooth and flooded"].stiffness == pytest.approx(flooded.stiffness, rel=1e-4)


@pytest.mark.slow
def test_held_in_place_or_in_half_widths_it_is_the_same_where_it_is_the_same(starved: LubricatedCycle):
    """The scene's own meniscus where the layer's was: the film, and the softening of the layer's other case."""
    assert starved.film.inlet is not None
    at = int(np.argmax(starved.film.load))
    placed = stage(f'supply = "meniscus"\nmeniscus_half_widths = {-starved.film.inlet[at]:.6f}\n')
    same = int(np.argmin(np.abs(placed.film.rho1 - starved.film.rho1[at])))
    assert placed.film.central_thickness[same] == pytest.approx(starved.film.central_thickness[at], rel=0.01)
    position = int(np.argmin(np.abs(placed.rho1[:, 0] - starved.film.rho1[at])))
    expected = starved.otherwise["same film, meniscus held"].stiffness[position]
    assert placed.stiffness[position] == pytest.approx(expected, rel=2e-3)
    back = placed.otherwise["same film, oil layer held"].stiffness[position]
    assert back == pytest.approx(starved.stiffness[position], rel=2e-4)


def test_starved_films_and_load_share_agree(starved: LubricatedCycle):
    """Films were solved at every fifteenth position; the forces there are those of the last cycle."""
    rho1, force = starved.rho1.ravel(), starved.forces.ravel()
    nearest = np.nanargmin(np.abs(rho1 - starved.film.rho1[:, None]), axis=1)
    assert np.allclose(rho1[nearest], starved.film.rho1, rtol=1e-9)
    assert force[nearest] == pytest.approx(starved.film.load * 0.040, rel=1e-3)


def test_smooth_flanks_are_the_limit_of_rough_ones(flooded: LubricatedCycle):
    smooth = stage(ROUGH + "sigma_um = 0.01\n")
    assert smooth.film.central_thickness == pytest.approx(flooded.film.central_thickness, rel=1e-9)
    assert smooth.stiffness == pytest.approx(flooded.stiffness, rel=1e-9)
    assert smooth.film.asperity_share is not None
    assert smooth.film.asperity_share.max() == 0.0
    assert smooth.film.film_ratio == pytest.approx(flooded.film.minimum_thickness / 0.01e-6, rel=1e-9)


def test_rough_flanks_share_the_load(flooded: LubricatedCycle):
    rough = stage(ROUGH + "sigma_um = 0.3\n")
    assert rough.film.film_ratio is not None
    assert rough.film.asperity_share is not None
    assert rough.film.film_ratio == pytest.approx(rough.film.minimum_thickness / 0.3e-6, rel=1e-12)
    assert np.all((rough.film.asperity_share > 0.05) & (rough.film.asperity_share < 0.5))
    assert np.all(
        rough.film.central_thickness > flooded.film.central_thickness
    )  # asperities hold the flanks apart
    assert [row.definition for row in rough.film.at_pitch][-1] == "whole"


def test_the_card_of_the_minimum_film_names_its_regime(flooded: LubricatedCycle):
    rough = stage(ROUGH + "sigma_um = 0.25\n")

    def note(cycle: LubricatedCycle) -> str:
        return {one.name: one.note for one in headlines(cycle)}["minimum film on the path"]

    for times, regime in ((0.1, "boundary"), (1.0, "mixed"), (10.0, "full film")):
        ratio = times * rough.film.film_ratio
        film = replace(rough.film, film_ratio=ratio)
        said = note(replace(rough, film=film))
        assert said.startswith(f"{regime} lubrication at Lambda = {ratio.min():.2g} (below 1 boundary")
    assert note(flooded) == ""  # of smooth flanks there is no ratio


def test_the_articles_grid_starves_light_contacts():
    """Its inlet at -4 half-widths: thinner films, most where the load is least."""
    wide, cut = stage(), stage('grid = "article"\n')
    thinned = cut.film.central_thickness / wide.film.central_thickness - 1
    assert np.all(thinned < 0.002)
    lightest = int(np.argmin(wide.film.load))
    assert -0.08 < thinned[lightest] < -0.005
    assert cut.film.inlet == pytest.approx(-4.0, abs=1e-12)


def test_the_stiffness_table_is_of_the_contact_nearest_to_c(flooded: LubricatedCycle):
    rows = {row.definition: row for row in flooded.film.at_pitch}
    assert set(rows) == set(flooded.film.stiffness)
    for name, row in rows.items():
        assert np.any(np.isclose(flooded.film.stiffness[name], row.stiffness, rtol=1e-12))
        assert 0 < row.loss < 0.05
    # one pair by Ishikawa carries all at C: 16.6 N/(mm um) at E = 206 GPa
    film = rows["approach"].stiffness
    assert rows["approach"].loss * film / (1 - rows["approach"].loss) == pytest.approx(16.1 * 40e6, rel=0.02)


@pytest.mark.slow
def test_a_meniscus_at_the_contacts_edge_is_solved(flooded: LubricatedCycle):
    """A thousandth of a half-width ahead: separations fall as the six-hundredth power of the load."""
    tight = stage('supply = "meniscus"\nmeniscus_half_widths = 1.001\n')
    assert tight.mismatch < 1e-4
    assert tight.film.central_thickness.max() < 0.01 * flooded.film.central_thickness.min()
    assert tight.stiffness_change < 8 * flooded.stiffness_change


def test_a_meniscus_in_place_is_refused_inside_a_contact_on_the_path():
    with pytest.raises(InputError, match=r"film\.meniscus_mm"):
        stage('supply = "meniscus"\nmeniscus_mm = 0.1\n')
