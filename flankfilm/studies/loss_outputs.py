"""What a study can ask of a row's friction, losses and temperatures."""

from __future__ import annotations

from collections.abc import Iterator
from operator import attrgetter

import numpy as np

from base import Figure
from base.results import figures
from ehl.discrete.regimes import NUMBERS, regime_number
from flankfilm.coupling.losses.losses_along_path import LossesAlongPath
from flankfilm.coupling.losses.losses_record import MeshLosses
from flankfilm.stages.losses import LOSSES
from flankfilm.studies.output import Named, Take, in_result, model_error_of, output_of, outputs_from

_losses = outputs_from(lambda engine: engine[LOSSES], MeshLosses, "losses")
_path = outputs_from(lambda engine: engine[LOSSES].path, LossesAlongPath, "losses")


def _at_end(figure: str, end: int) -> Take:
    """Mean at the lower or the upper end of the band of Eyring's stress."""
    return lambda losses: getattr(losses.band, figure)[end]


def _band(figure: str) -> list[Named]:
    about = figures(MeshLosses)[figure]
    return [
        output_of(f"{figure}_by_{stress}_MPa", about, "losses", in_result(LOSSES, _at_end(figure, end)), said)
        for end, (stress, said) in enumerate(
            (("5", "{} with an Eyring stress of 5 MPa"), ("10", "{} with an Eyring stress of 10 MPa"))
        )
    ]


def _gears() -> list[Named]:
    """Temperatures of each gear."""
    meant = (
        ("bulk_temperature", "bulk temperature of the {}'s flanks", "bulk_temperatures"),
        (
            "flank_temperature_rise",
            "maximum rise of the {}'s flank above its bulk",
            "path.greatest_flank_rise",
        ),
    )
    return [
        output_of(
            f"{name}_{gear}", Figure("K", meaning.format(gear)), "losses", in_result(LOSSES, _of_gear(at, k))
        )
        for k, gear in enumerate(("pinion", "wheel"))
        for name, meaning, at in meant
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

    about = figures(MeshLosses)["mesh_loss"]
    for end, which in enumerate(("least", "most")):
        said = f"{{}} within the band of the boundary friction, {which}; nan if smooth"
        yield output_of(
            f"mesh_loss_by_boundary_{which}", about, "losses", in_result(LOSSES, of(at(end))), said
        )
    part = Figure("1", "part of the losses that the asperities' friction makes; nan if smooth", shown="%")
    yield output_of("boundary_friction_part", part, "losses", in_result(LOSSES, of(attrgetter("loss_part"))))

    def regime_of(losses: MeshLosses) -> float | None:
        ratio = losses.path.least_film_ratio
        return None if ratio is None else regime_number(ratio)

    about = Figure("1", f"regime at the minimum film ratio with heat: {NUMBERS}; nan if smooth")
    yield output_of("regime_with_heat", about, "losses", in_result(LOSSES, regime_of))


def _error(name: str, meaning: str, value: Take) -> Named:
    return output_of(name, Figure("1", meaning), "losses", in_result(LOSSES, value))


LOSS_OUTPUTS: tuple[Named, ...] = (
    _losses("mean_friction"),
    _losses("mesh_loss"),
    *_band("mesh_loss"),
    _losses("sliding_loss"),
    _losses("rolling_loss"),
    _losses("efficiency", name="mesh_efficiency"),
    _losses("loss_factor"),
    _path("greatest_oil_rise", name="oil_temperature_rise"),
    _losses("greatest_contact_temperature", name="flank_temperature"),
    _path("flash_temperature", np.max, said="maximum flash temperature after Blok along the path, a rise"),
    *_gears(),
    _path("least_film", name="least_film_with_heat", said="{} along the path, with heat and shear thinning"),
    _path("least_film_ratio", name="film_ratio_with_heat", said="{} with heat; nan if smooth"),
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
    _path("greatest_pressure_times_sliding", name="pressure_times_sliding"),
    _error("losses_error", "estimated relative error of mean friction and losses", attrgetter("error")),
    *(
        _error(
            f"losses_error_by_{stress}_MPa",
            f"the same with an Eyring stress of {stress} MPa",
            _at_end("end_error", end),
        )
        for end, stress in enumerate((5, 10))
    ),
    _error("efficiency_error", "estimated relative error of the mesh's efficiency", attrgetter("loss_error")),
    _error(
        "temperature_rise_error",
        "larger estimated relative error of the maximum rises of oil and flanks",
        lambda losses: max(losses.path.greatest_oil_rise_error, losses.path.greatest_flank_rise_error.max()),
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
"""Outputs by name."""
