"""All definitions of a film's stiffness side by side, and what each costs the mesh."""

from __future__ import annotations

import math

from base import Faults, Limit, quantity, record
from ehl.films.film import DEFINITIONS, MEANINGS, Film

_FACE_WIDTH = Limit.above(0.0, 1e3, "m", "give b in m")
_BODIES = Limit.above(0.0, 1e18, "N/m", "give it at the whole face")


@record
class StiffnessRow:
    """One definition of a film's stiffness."""

    headline = ("definition", "stiffness", "loss")

    definition: str = quantity("", "name of the definition")
    meaning: str = quantity("", "what it is")
    stiffness: float = quantity(
        "N/m", "film stiffness at the whole face, NaN where the definition does not hold"
    )
    error: float = quantity("1", "estimated relative error, NaN where it is unknown")
    loss: float = quantity(
        "1", "1 - k/k_bodies of the series with the bodies, NaN if none were given", shown="%"
    )


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

    Examples
    --------
    >>> from ehl import LineContact, solve
    >>> film = solve(LineContact.from_moes(M=20.0, L=10.0))
    >>> for row in stiffness_table(film, face_width=0.04):
    ...     print(f"{row.definition:15}{row.stiffness:.2e} N/m")
    approach       2.31e+11 N/m
    tangent        2.72e+11 N/m
    nodal-sum      3.95e+10 N/m
    dowson-central 3.45e+11 N/m
    dowson-minimum 3.53e+11 N/m
    """
    with Faults() as faults:
        faults.number("face_width", face_width, _FACE_WIDTH)
        if bodies is not None:
            faults.number("bodies", bodies, _BODIES)
    errors = {"approach": film.errors.approach_stiffness, "tangent": film.errors.tangent_stiffness}
    rows = []
    for definition in DEFINITIONS:
        stiffness = face_width * film.stiffness(definition)
        loss = math.nan if bodies is None else bodies / (bodies + stiffness)
        error = errors.get(definition, film.error if definition == "nodal-sum" else math.nan)
        rows.append(StiffnessRow(definition, MEANINGS[definition], stiffness, error, loss))
    return tuple(rows)
