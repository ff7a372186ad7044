"""Friction, losses and temperatures of films with heat along the path."""

from __future__ import annotations

from collections.abc import Iterator
from operator import attrgetter
from typing import TYPE_CHECKING

import numpy as np

from base import Figure
from base.results import figures
from ehl.discrete.regimes import CLASS, NUMBERS, regime_number
from flankfilm import coupling
from flankfilm.output import heat
from flankfilm.products.output import Named, Take, in_result, model_error_of, output_of, outputs_from
from flankfilm.products.product import CurveTable, Product, ranked, wanting, when
from flankfilm.report import losses_parts
from flankfilm.report.page import Part
from flankfilm.report.run_parts import Work
from flankfilm.report.text import counted
from flankfilm.stages.computed import Computed
from flankfilm.stages.losses import HOT_CONTACT, LOSSES
from flankfilm.stages.mesh import PAIR

if TYPE_CHECKING:
    import xarray as xr

STRESSES = ("eyring_stress", "mean_friction", "sliding_loss", "rolling_loss", "mesh_loss", "efficiency")
"""Figures of a mesh's losses by Eyring's stress."""


def variables(computed: Computed) -> Iterator[xr.Dataset]:
    """Losses, and the film of the hottest contact."""
    lost, hot = computed.get(LOSSES), computed.get(HOT_CONTACT)
    if lost is not None:
        yield from heat.losses(lost)
        if hot is not None and hot.converged:
            yield from heat.hot_contact(hot, lost.bulk_temperatures)


def sections(computed: Computed, results: xr.Dataset) -> Iterator[Part]:
    """Losses with their band, and temperatures."""
    if (lost := computed.get(LOSSES)) is not None:
        yield losses_parts.losses(lost, results, computed.scene)


def _of_losses(lost: coupling.MeshLosses, computed: Computed) -> Work:
    films, rounds = counted(lost.path.rho1.size, "film"), counted(lost.rounds, "round")
    note = f"{films} of up to {counted(lost.cost.unknowns, 'unknown')}, {rounds}"
    return Work("mean friction", computed.scene.tolerance, lost.error, note)


def _at_end(figure: str, end: int) -> Take:
    """Mean at the lower or the upper end of the band of Eyring's stress."""
    return lambda losses: getattr(losses.band, figure)[end]


def _band(figure: str) -> list[Named]:
    about = figures(coupling.MeshLosses)[figure]
    return [
        output_of(
            f"{figure}_by_{stress}_MPa",
            about,
            "losses",
            in_result(LOSSES, _at_end(figure, end)),
            said,
            error_output=f"losses_error_by_{stress}_MPa",
        )
        for end, (stress, said) in enumerate(
            (("5", "{} with an Eyring stress of 5 MPa"), ("10", "{} with an Eyring stress of 10 MPa"))
        )
    ]


def _gears() -> list[Named]:
    """Temperatures of each gear."""
    meant = (
        ("bulk_temperature", "bulk temperature of the {}'s flanks", "bulk_temperatures", ""),
        (
            "flank_temperature_rise",
            "maximum rise of the {}'s flank above its bulk",
            "path.greatest_flank_rise",
            "temperature_rise_error",
        ),
    )
    return [
        output_of(
            f"{name}_{gear}",
            Figure("K", meaning.format(gear)),
            "losses",
            in_result(LOSSES, _of_gear(at, k)),
            error=None if held else in_result(LOSSES, _of_gear(f"{at}_error", k)),
            error_output=held,
        )
        for k, gear in enumerate(("pinion", "wheel"))
        for name, meaning, at, held in meant
    ]


def _of_gear(figure: str, gear: int) -> Take:
    """Maximum value of one gear."""
    return lambda losses: np.max(attrgetter(figure)(losses)[gear])


def _boundary() -> Iterator[Named]:
    """Regime of the films with heat, and what the asperities' friction makes and leaves open."""

    def of(value: Take) -> Take:
        return lambda losses: None if losses.boundary is None else value(losses.boundary)

    def at(end: int) -> Take:
        return lambda band: np.sort(band.mesh_loss)[end]

    about = figures(coupling.MeshLosses)["mesh_loss"]
    for end, which in enumerate(("least", "most")):
        said = f"{{}} within the band of the boundary friction, {which}; nan if smooth"
        yield output_of(
            f"mesh_loss_by_boundary_{which}",
            about,
            "losses",
            in_result(LOSSES, of(at(end))),
            said,
            error_output="losses_error",
        )
    part = Figure(
        "1",
        "part of the losses that the asperities' friction makes; nan if smooth",
        shown="%",
        no_error="not estimated: it errs as the asperities' share of the load does, which has an error along the path",
    )
    yield output_of("boundary_friction_part", part, "losses", in_result(LOSSES, of(attrgetter("loss_part"))))

    def regime_of(losses: coupling.MeshLosses) -> float | None:
        ratio = losses.path.least_film_ratio
        return None if ratio is None else regime_number(ratio)

    about = Figure(
        "1", f"regime at the minimum film ratio with heat: {NUMBERS}; nan if smooth", no_error=CLASS
    )
    yield output_of("regime_with_heat", about, "losses", in_result(LOSSES, regime_of))


def _error(name: str, meaning: str, value: Take) -> Named:
    return output_of(name, Figure("1", meaning), "losses", in_result(LOSSES, value))


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    of_losses = outputs_from(lambda engine: engine[LOSSES], coupling.MeshLosses, "losses")
    of_path = outputs_from(lambda engine: engine[LOSSES].path, coupling.LossesAlongPath, "losses")
    return (
        of_losses("mean_friction", error_output="losses_error", model_output="mean_friction_model_error"),
        of_losses("mesh_loss", error_output="losses_error", model_output="losses_model_error"),
        *_band("mesh_loss"),
        of_losses("sliding_loss", error_output="losses_error", model_output="sliding_loss_model_error"),
        of_losses("rolling_loss"),
        of_losses(
            "efficiency",
            name="mesh_efficiency",
            error_output="efficiency_error",
            model_output="efficiency_model_error",
        ),
        of_losses("loss_factor"),
        of_path("greatest_oil_rise", name="oil_temperature_rise", error_output="temperature_rise_error"),
        of_losses(
            "greatest_contact_temperature",
            name="flank_temperature",
            error_output="flank_temperature_error",
        ),
        of_path(
            "flash_temperature", np.max, said="maximum flash temperature after Blok along the path, a rise"
        ),
        *_gears(),
        of_path(
            "least_film",
            name="least_film_with_heat",
            said="{} along the path, with heat and shear thinning",
            error_output="film_with_heat_error",
        ),
        of_path(
            "least_film_ratio",
            name="film_ratio_with_heat",
            said="{} with heat; nan if smooth",
            error_output="film_with_heat_error",
        ),
        *(
            model_error_of(f"{name}_model_error", said, "losses", lambda engine: engine[LOSSES], figure)
            for name, said, figure in (
                ("losses", "the power lost in the mesh", "mesh_loss"),
                ("mean_friction", "the mean friction", "mean_friction"),
                ("sliding_loss", "the power lost by sliding", "sliding_loss"),
                ("efficiency", "the mesh's efficiency", "efficiency"),
            )
        ),
        *_boundary(),
        of_path("greatest_pressure_times_sliding", name="pressure_times_sliding"),
        _error("losses_error", "estimated relative error of mean friction and losses", attrgetter("error")),
        *(
            _error(
                f"losses_error_by_{stress}_MPa",
                f"the same with an Eyring stress of {stress} MPa",
                _at_end("end_error", end),
            )
            for end, stress in enumerate((5, 10))
        ),
        _error(
            "efficiency_error", "estimated relative error of the mesh's efficiency", attrgetter("loss_error")
        ),
        _error(
            "temperature_rise_error",
            "larger estimated relative error of the maximum rises of oil and flanks",
            lambda losses: max(
                losses.path.greatest_oil_rise_error, losses.path.greatest_flank_rise_error.max()
            ),
        ),
        _error(
            "flank_temperature_error",
            "estimated relative error of the flanks' maximum temperature, in K",
            attrgetter("greatest_contact_temperature_error"),
        ),
        _error(
            "film_with_heat_error",
            "estimated relative error of the minimum film with heat",
            attrgetter("least_film_error"),
        ),
    )


PRODUCT = Product(
    name="losses",
    goals=wanting("losses", PAIR, LOSSES, HOT_CONTACT),
    variables=variables,
    tables={
        "losses_along_path": CurveTable("losses_path", "rho1", axis="point"),
        "losses_on_lines": CurveTable(
            "losses_lines",
            "sliding_loss",
            ("z", "travel", "line_load", "friction_coefficient", "sliding_loss", "contact_temperature"),
        ),
        "losses_by_eyring_stress": CurveTable("losses_band", "eyring_stress", STRESSES),
    },
    headlines=when(LOSSES, lambda lost: ranked(losses_parts.headlines(lost), 2, 2, 3, 1, 1)),
    pictures=losses_parts.PICTURES,
    sections=sections,
    work={LOSSES.name: _of_losses},
    outputs=outputs,
)
