"""Every figure of results.nc has an error, or says why it has none, and whether its solver converged."""

from __future__ import annotations

import re

import pytest

from base import Cost
from flankfilm.files.cache import Cache, results_cache
from flankfilm.products.catalogue import goals
from flankfilm.runs.dataset import results_dataset
from flankfilm.scene import parse_scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine
from tests.flankfilm.explained import unexplained
from tests.flankfilm.program import EXAMPLES
from tests.flankfilm.scenes import CLOSED_FORMS_WITH_FILM


def computed(scene, cache):
    engine = Engine(scene, cache)
    for stage in goals(scene):
        engine[stage]
    return engine.results(), results_dataset(Computed(scene, engine.results()))


def test_closed_forms_say_that_their_error_is_unknown():
    _, data = computed(parse_scene(CLOSED_FORMS_WITH_FILM), Cache(None))
    assert not unexplained(data)
    for name in (
        "dry_mean_secant_stiffness",
        "lubricated_mean_stiffness",
        "fourier_amplitude",
    ):
        assert data[name].attrs["error_note"].startswith("unknown"), name
    assert "Dowson" in data.film_central_thickness.attrs["error_note"]
    assert data.dry_mean_stiffness.attrs["converged"] == 1


def test_a_result_that_did_not_converge_says_so_beside_its_figures():
    from dataclasses import replace

    scene = parse_scene(
        CLOSED_FORMS_WITH_FILM.replace('"film", "fourier"', '"fourier"').replace(
            'model = "dowson"', 'model = "none"'
        )
    )
    values, _ = computed(scene, Cache(None))
    stray = replace(values["fourier"], converged=False, message="left out", cost=Cost(0.0))
    data = results_dataset(Computed(scene, {**values, "fourier": stray}))
    assert data.fourier_amplitude.attrs["converged"] == 0
    assert data.fourier_amplitude.attrs["message"] == "left out"
    assert data.dry_mean_stiffness.attrs["converged"] == 1


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_every_figure_of_every_example_is_explained(path):
    """With 20 speeds: figures say as much of their errors as with 400."""
    text = re.sub(r"\bpoints = \d+", "points = 20", path.read_text(encoding="utf-8"))
    scene = parse_scene(text, folder=path.parent)
    _, data = computed(scene, results_cache(True))
    assert not unexplained(data)
