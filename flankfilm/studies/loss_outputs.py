"""What a study can ask of a row's friction, losses and temperatures."""

from __future__ import annotations

from operator import attrgetter

import numpy as np

from base import Figure
from base.results import figures
from flankfilm.coupling.losses_along_path import LossesAlongPath
from flankfilm.coupling.losses_record import MeshLosses
from flankfilm.stages.losses import LOSSES
from flankfilm.studies.output import Named, Take, in_result, output_of, outputs_from

_losses = outputs_from(lambda engine: engine[LOSSES], MeshLosses, "losses")
_path = outputs_from(lambda engine: engine[LOSSES].path, LossesAlongPath, "losses")


def _at_end(figure: str, end: int) -> Take:
    """Mean at the lower or the upper end of the band of Eyring's stress."""
    return lambda found: getattr(found.band, figure)[end]


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
            "path.surface_temperature_rise",
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
    return lambda found: np.max(attrgetter(figure)(found)[gear])


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
    _path("oil_temperature_rise", np.max, said="{} along the path"),
    _losses("greatest_contact_temperature", name="flank_temperature"),
    _path("flash_temperature", np.max, said="maximum flash temperature after Blok along the path, a rise"),
    *_gears(),
    _path("least_film", name="least_film_with_heat", said="{} along the path, with heat and shear thinning"),
    _path("film_ratio", np.min, "film_ratio_with_heat", "minimum {} along the path with heat; nan if smooth"),
    _path("greatest_pressure_times_sliding", name="pressure_times_sliding"),
    _error("losses_error", "estimated relative error of mean friction and losses", attrgetter("error")),
    _error("efficiency_error", "estimated relative error of the mesh's efficiency", attrgetter("loss_error")),
    _error(
        "temperature_rise_error",
        "largest estimated relative error of the oil's and the flanks' rises along the path",
        lambda found: np.max(found.path.temperature_error),
    ),
    _error(
        "film_with_heat_error",
        "largest estimated relative error of the films with heat",
        lambda found: np.max(found.path.film_error),
    ),
)
"""Outputs by name."""
