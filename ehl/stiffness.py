"""All definitions of a film's stiffness side by side, and what each costs the mesh."""

from __future__ import annotations

import math
from dataclasses import dataclass

from base import Faults, Limit
from ehl.film import DEFINITIONS, Film

__all__ = ["StiffnessRow", "stiffness_table"]

_FACE_WIDTH = Limit(0.0, 1e3, "m", "give b in m", low_open=True)
_BODIES = Limit(0.0, 1e18, "N/m", "give it at the whole face", low_open=True)
_KINDS = {
    "approach": "tangent, -1/(d separation/dw): the film's yielding beyond the dry contact",
    "tangent": "tangent, -dw/dh_cen",
    "nodal-sum": "secant, int p/h dx",
    "dowson-central": "tangent of a formula, 10 w/h_c",
    "dowson-minimum": "tangent of a formula, w/(0.13 h_m)",
}


@dataclass(frozen=True)
class StiffnessRow:
    """One definition."""

    definition: str
    meaning: str
    stiffness: float  # at the whole face [N/m]; NaN where the definition does not hold
    error: float  # estimated relative error; NaN where it is unknown
    loss: float  # 1 - k/k_bodies of the series with the bodies, NaN if none were given


def stiffness_table(
    film: Film, face_width: float = 1.0, bodies: float | None = None
) -> tuple[StiffnessRow, ...]:
    """Return every definition of the film's stiffness, in the order of ``ehl.DEFINITIONS``.

    Parameters
    ----------
    film : Film
        A solved film.
    face_width : float
        b [m]; with 1 the stiffnesses are per length of face.
    bodies : float, optional
        Tangent stiffness of the bodies that the film is in series with, the dry contact included [N/m at the
        whole face]. The loss is then k_b/(k_b + k_film): how much the film lowers the stiffness of the pair.

    Returns
    -------
    tuple of StiffnessRow
        Dowson's formulas are of flooded contacts and NaN for starved ones.

    Raises
    ------
    InputError
        For a face width or a stiffness that is no positive number.
    """
    found = Faults()
    found.number("face_width", face_width, _FACE_WIDTH)
    if bodies is not None:
        found.number("bodies", bodies, _BODIES)
    found.raise_if_any()
    errors = {"approach": film.errors.approach_stiffness, "tangent": film.errors.tangent_stiffness}
    rows = []
    for definition in DEFINITIONS:
        stiffness = face_width * film.stiffness(definition)
        loss = math.nan if bodies is None else bodies / (bodies + stiffness)
        error = errors.get(definition, film.error if definition == "nodal-sum" else math.nan)
        rows.append(StiffnessRow(definition, _KINDS[definition], stiffness, error, loss))
    return tuple(rows)
