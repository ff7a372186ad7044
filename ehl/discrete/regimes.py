"""Regimes of lubrication by the film ratio, and the friction of asperities that rub.

The bounds 1 and 3 of the film ratio are those of textbooks. Measured friction knows no such steps: rough surfaces raise
it between film ratios of 0.5 and 3.5.

References
----------
B. Vengudusamy, C. Enekes and R. Spallek, EHD friction properties of ISO VG 320 gear oils with smooth and rough
surfaces, Friction (2019), doi:10.1007/s40544-019-0267-5: ball on disc, three roughnesses; friction of mineral oil and
polyalphaolefins is raised at film ratios of 0.5 to 3.5, that of polyglycols is not.
"""

from __future__ import annotations

import math

from base import Limit

__all__ = [
    "BOUNDARY",
    "BOUNDARY_FRICTION",
    "CLASS",
    "MEASURED",
    "NUMBERS",
    "REGIMES",
    "regime",
    "regime_number",
]

REGIMES = ("boundary", "mixed", "full film")
"""Below a film ratio of 1, below 3, and from there on."""

BOUNDS = (1.0, 3.0)

NUMBERS = "1 boundary, 2 mixed, 3 full film"
"""What numbers of regimes mean."""

CLASS = "a class, exact but at its bounds: it follows from the film ratio, which has an error"
"""Why the number of a regime has no error."""

MEASURED = (
    "Measurements show no step at 1 or 3: rough surfaces raised the friction of a mineral and of PAO gear oils at film "
    "ratios from 0.5 to 3.5 (Vengudusamy, Enekes and Spallek, 2019)"
)
"""What measurements say of the regimes."""

BOUNDARY_FRICTION = 0.1
"""Of steel asperities with a layer of additives between them: 0.08 to 0.12 is usual."""

BOUNDARY = Limit(0.0, 0.5, remedy="0.08 to 0.12 is usual for steel in oils for gears")
"""What the friction of asperities may be."""


def regime_number(ratio: float) -> float:
    """Regime at a film ratio: 1 boundary, 2 mixed, 3 full film; NaN without a ratio.

    Examples
    --------
    >>> [regime_number(ratio) for ratio in (0.4, 1.0, 3.0, float("nan"))]
    [1.0, 2.0, 3.0, nan]
    """
    return math.nan if math.isnan(ratio) else 1.0 + sum(ratio >= bound for bound in BOUNDS)


def regime(ratio: float) -> str:
    """Name of the regime at a film ratio, minimum film over the standard deviation of both surfaces' heights.

    Examples
    --------
    >>> [regime(ratio) for ratio in (0.4, 1.0, 3.0)]
    ['boundary', 'mixed', 'full film']
    """
    return REGIMES[int(regime_number(ratio)) - 1]
