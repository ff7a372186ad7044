"""What the model of a helical pair's loaded contact leaves open, figure by figure.

Three parts: contacts on flanks (``MeshCycle.flank_error``), all that contact beyond the path changes at most
(``MeshCycle.beyond_path_change``), and what another solver of the same pair found (docs/validation/face_width.md).
"""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["deflection_of_lines", "mean_of_lines", "over_mean_of_lines", "range_of_lines"]

MEAN, SWING = 0.008, 0.05
"""By how much a solver written apart differs in means, and in the peak-to-peak transmission error."""


def mean_of_lines(contact: Any, law: float) -> float:
    """Of a mean stiffness: the secant's for `law` 1, the tangent's for 2, whose flanks count twice."""
    beyond, force, change = contact.beyond_path_change, abs(contact.force), 0.0
    if beyond is not None:
        change = (
            beyond.of_mean_secant(force, contact.secant_stiffness)
            if law == 1.0
            else beyond.of_mean_tangent(contact.stiffness)
        )
    return float(law * contact.flank_error + change + MEAN)


def deflection_of_lines(contact: Any) -> float:
    """Change of the peak-to-peak transmission error by flanks and by contact beyond the path [m]."""
    deflection, beyond = np.abs(contact.transmission_error), contact.beyond_path_change
    by_edges = 0.0 if beyond is None else beyond.of_range(contact.transmission_error)
    return float(np.ptp(contact.loaded.of_flanks * deflection) + by_edges)


def range_of_lines(contact: Any, whole: float) -> float:
    """Of the peak-to-peak transmission error, of which this is the whole [m]."""
    return deflection_of_lines(contact) / whole + SWING


def over_mean_of_lines(contact: Any, law: float) -> float:
    """Of harmonics of a stiffness over its mean: half the range of its relative change over the positions."""
    beyond, change = contact.beyond_path_change, law * contact.loaded.of_flanks
    if beyond is not None and law == 1.0:
        change = change + beyond.deflection * contact.secant_stiffness / abs(contact.force)
    elif beyond is not None:
        change = change + beyond.compliance * contact.stiffness
    return 0.5 * float(np.ptp(change))
