"""Our own films beside the scuffing method: its contact temperature with our shares, film over Ra, what is missing."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from flankfilm.coupling import mesh_cycle, own_contact, own_rating
from flankfilm.coupling.rating.own_contact import standard_temperature
from flankfilm.report.rating_tables import flanks
from gears.rating import flash_temperature
from tests.flankfilm.pictured import PAIR, losses, rating


@pytest.fixture(scope="module")
def rated() -> Any:
    return rating()


@pytest.fixture(scope="module")
def with_shares() -> Any:
    return SimpleNamespace(cycle=mesh_cycle(PAIR, 300.0, model="fem", tolerance=0.1, positions=60))


def test_the_standard_has_the_share_of_each_pair(rated, with_shares):
    """Between a single pair that carries all along the path, and one that does from B to D."""
    scuffing, points = rated.scuffing, PAIR.points
    given = {"friction": scuffing.mu, "temperature": scuffing.theta_M, "share": np.ones(61)}
    load = scuffing.w_Bt * scuffing.K_Bgamma
    middle, whole = (
        flash_temperature(PAIR, load, rated.speed, rho1=np.linspace(*ends, 61), **given).theta_Bmax
        for ends in ((points.B, points.D), (points.A, points.E))
    )
    assert (
        middle - 1.0 < standard_temperature(rated, with_shares) < whole
    )  # 1 K by the steps between positions


def test_without_friction_it_is_the_bulk(rated, with_shares):
    smooth = replace(rated, scuffing=replace(rated.scuffing, mu=0.0))
    assert standard_temperature(smooth, with_shares) == pytest.approx(rated.scuffing.theta_M, abs=1e-9)
    twice = replace(rated, scuffing=replace(rated.scuffing, mu=2.0 * rated.scuffing.mu))
    rise, doubled = (
        standard_temperature(which, with_shares) - rated.scuffing.theta_M for which in (rated, twice)
    )
    assert doubled == pytest.approx(2.0 * rise)


def test_a_film_alone_has_a_ratio_and_no_temperature(rated):
    film = SimpleNamespace(film=SimpleNamespace(least_film=0.3e-6, least_film_error=0.01))
    found = own_contact(rated, 0.6e-6, film=film)
    assert found.film_ratio == pytest.approx(0.5)
    assert (found.film_error, found.contact_temperature, found.theta_B) == (0.01, None, None)
    rows = {row[0]: row[1:] for row in flanks(rated, found).rows}
    assert rows["minimum film over Ra = 0.6 µm"] == ("left out", "0.500", "± 1 %")
    assert rows["mean coefficient of friction"] == (f"{rated.scuffing.mu:.4f}", "", "")


def test_films_are_in_no_safety(rated):
    film = SimpleNamespace(film=SimpleNamespace(least_film=0.3e-6, least_film_error=0.01))
    own = own_rating(rated, PAIR, flanks=own_contact(rated, 0.6e-6, film=film))
    assert own.S_H == rated.S_H
    assert own.S_F == rated.S_F


def test_scuffing_that_is_not_rated_leaves_the_standard_out(rated, with_shares):
    assert standard_temperature(replace(rated, scuffing=None), with_shares) is None


@pytest.mark.slow
@pytest.mark.long
def test_losses_give_temperature_friction_and_film(rated):
    lost = losses().values["losses"]
    found = own_contact(rated, 0.6e-6, losses=lost)
    assert found.contact_temperature == lost.path.greatest_contact_temperature
    assert found.contact_temperature >= max(found.bulk_temperatures)
    assert found.friction == lost.mean_friction
    assert found.least_film == lost.path.least_film
    assert found.flash == lost.path.greatest_flank_rise.max()
