"""Variables of heat: friction, losses and temperatures along the path, and the film of the hottest contact."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from base.results import EXACT
from ehl.discrete.collocation import lobatto
from flankfilm.output.variables import figure_of, of_quantities, of_record

if TYPE_CHECKING:
    import xarray as xr

    import ehl
    from base import Array
    from flankfilm.coupling import MeshLosses

THROUGH = ("x", "pressure", "thickness", "temperature", "shear_stress", "oil_temperature_rise")
"""Figures of the film of the hottest contact."""


def losses(mesh_losses: MeshLosses) -> Iterator[xr.Dataset]:
    """Means over the base pitch, their band by Eyring's stress, and what stands at each contact."""
    yield of_record("losses", mesh_losses)
    yield of_record("losses_band", mesh_losses.band)
    yield of_record("losses_path", mesh_losses.path)
    if mesh_losses.over_face is not None:
        yield of_record("losses_face", mesh_losses.over_face)
    if mesh_losses.over_lines is not None:
        yield of_record("losses_lines", mesh_losses.over_lines)


def hot_contact(film: ehl.ThermalFilm, bulk: Array) -> Iterator[xr.Dataset]:
    """Film of the hottest contact, with the temperatures of the flanks [K] that its temperatures are above."""
    assert film.temperature is not None
    yield of_record("hot_contact", film, THROUGH)
    yield of_record("hot_contact", film.contact, ("half_width",))
    place = "place across the film over its thickness, -1/2 at the pinion"
    bulk_of = "bulk temperature of the flank"
    yield of_quantities(
        "hot_contact",
        (
            figure_of("place", "1", place, "across", lobatto(film.temperature.shape[1]).zeta, no_error=EXACT),
            figure_of("bulk_temperature", "K", bulk_of, "gear", list(bulk), no_error="of the losses"),
        ),
    )
