r"""How a tolerance is split among the stages of a computation: for the lowest cost.

A stage that may err by :math:`e` costs :math:`c(e) = s \, (e/e_0)^{-p}` below the error :math:`e_0` of its coarsest
resolution, and :math:`s` above: nothing is cheaper than the coarsest. The split makes :math:`\sum c_i(e_i)` smallest
with :math:`\sum e_i = T`. Lagrange's condition, one slope of the cost for all, gives

.. math:: e_i = \min\left(e_{0i}, \; e_{0i} \left(\frac{s_i \, p_i}{\lambda \, e_{0i}}\right)^{1/(1+p_i)}\right),

no less than the error :math:`f_i` of the finest resolution that there is. The sum falls with :math:`\lambda`, which
follows from it. Where the tolerance exceeds all coarsest errors together, nothing is left to save, and it is handed
out in their proportion. The laws come from convergence studies; that they are rough costs time, never accuracy: each
stage estimates its own error and refines until that is below its share.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class CostLaw:
    """What a stage costs for what error.

    Attributes
    ----------
    name : str
        Of the stage's share.
    coarsest : float
        Relative error on the coarsest resolution, e_0.
    seconds : float
        Cost there, s [s].
    power : float
        p, positive.
    finest : float
        Smallest relative error that the stage can reach, below `coarsest`.
    """

    name: str
    coarsest: float
    seconds: float
    power: float
    finest: float = 0.0

    def cost(self, error: float) -> float:
        """Seconds for an error."""
        return self.seconds * math.pow(max(1.0, self.coarsest / error), self.power)


def split(tolerance: float, laws: Sequence[CostLaw]) -> dict[str, float] | None:
    """Split a tolerance among stages for the lowest cost; None where it lies below all that they can reach.

    Parameters
    ----------
    tolerance : float
        Relative, T.
    laws : sequence of CostLaw
        Of different names.

    Returns
    -------
    dict or None
        Relative errors by the laws' names, summing to `tolerance`; empty where there is no stage.
    """
    if laws and tolerance <= math.fsum(law.finest for law in laws):
        return None
    if tolerance >= (coarsest := math.fsum(law.coarsest for law in laws)):
        return {law.name: law.coarsest * tolerance / coarsest for law in laws}
    # the minimum slope at which every stage would still be at its coarsest, and one at which all are at their finest
    low = min(_slope(law, law.coarsest) for law in laws)
    high = max(_slope(law, max(law.finest, 1e-9 * tolerance)) for law in laws)
    low, high = math.log(low), math.log(high)
    while high - low > 1e-13 * max(abs(low), abs(high), 1.0):
        middle = 0.5 * (low + high)
        if math.fsum(_share(law, middle) for law in laws) > tolerance:
            low = middle
        else:
            high = middle
    errors = {law.name: _share(law, high) for law in laws}
    # what rounding leaves goes to the largest share
    errors[max(errors, key=errors.__getitem__)] += tolerance - math.fsum(errors.values())
    return errors


def _slope(law: CostLaw, error: float) -> float:
    """-dc/de, seconds saved for each unit of error allowed."""
    return law.seconds * law.power / law.coarsest * math.pow(law.coarsest / error, 1.0 + law.power)


def _share(law: CostLaw, log_slope: float) -> float:
    """Error at which a stage's cost has a slope."""
    ratio = math.log(law.seconds * law.power / law.coarsest) - log_slope
    return max(law.finest, law.coarsest * math.exp(min(0.0, ratio / (1.0 + law.power))))


def step_below(share: float) -> float:
    """Round down to 1, 2 or 5 times a power of ten.

    Stages whose result is kept ask for such steps: a share that moves a little, because another part of the scene
    changed, leaves what was computed as good as it was.
    """
    power = 10.0 ** math.floor(math.log10(share) + 1e-12)
    step = max((m for m in (1.0, 2.0, 5.0) if m * power <= share * (1 + 1e-12)), default=1.0)
    return float(f"{step * power:.0e}")
