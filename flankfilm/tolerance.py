"""How the tolerance of a scene is split among its stages.

The mean stiffness is the figure that every stage after the teeth inherits. Its error is at most
the sum of the shares: mesh and compliance, sampling of the mesh cycle, oil film. The film's own
figures (thicknesses) are wanted to the full tolerance, and their share in the stiffness is the
film's small part of it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ToleranceSplit:
    """Relative tolerances of the stages.

    Attributes
    ----------
    compliance : float
        Of the flank compliance by finite elements.
    sampling : float
        Of the mean over the mesh cycle, from the number of positions.
    film : float
        Of central and minimum film thickness.
    coupling : float
        Of the load share when film and teeth are iterated.
    """

    compliance: float
    sampling: float
    film: float
    coupling: float

    @classmethod
    def of(cls, tolerance: float) -> ToleranceSplit:
        """Split `tolerance`: finite elements 40 %, sampling 40 %, iteration of the load share 2 %.

        Errors are in proportion to cost to the power of -1 or better for sampling and -3/2 for
        the compliance, and both are cheap: equal shares are close to the cheapest. What is left
        covers the film's part.
        """
        return cls(
            compliance=0.4 * tolerance, sampling=0.4 * tolerance, film=tolerance, coupling=0.02 * tolerance
        )
