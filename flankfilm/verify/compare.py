"""Figures of each closed form beside those of finite elements, with the numerical error of the latter."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flankfilm.build import pinion_torque
from flankfilm.verify.models import Curves, closed_form_curves, reference_curves, stations

if TYPE_CHECKING:
    from flankfilm.stages.engine import Engine
    from gears import GearPair

Array = NDArray[np.float64]

POSITIONS = 360
"""Positions of a base pitch; every third of them shows the error of their number."""

UNITS: Mapping[str, str] = {
    "one pair, at C": "N/(mm um)",
    "one pair, largest": "N/(mm um)",
    "one pair, mean A to E": "N/(mm um)",
    "mesh, two pairs, mean": "N/(mm um)",
    "mesh, mean": "N/(mm um)",
    "harmonic 1 over mean": "1",
    "harmonic 2 over mean": "1",
    "harmonic 3 over mean": "1",
    "transmission error, peak to peak": "um",
}
"""The figures compared and their units; stiffness is secant, per face width."""


@dataclass(frozen=True)
class Difference:
    """One figure of one closed form against one reference.

    Attributes
    ----------
    figure, unit, reference, model : str
    reference_value : float
        By finite elements, in `unit`.
    reference_error : float
        Its estimated numerical error, relative.
    value : float
        By the closed form.
    """

    figure: str
    unit: str
    reference: str
    model: str
    reference_value: float
    reference_error: float
    value: float

    @property
    def difference(self) -> float:
        """(value - reference)/reference."""
        return self.value / self.reference_value - 1.0


@dataclass(frozen=True, eq=False)
class Verification:
    """Closed forms against finite elements.

    Attributes
    ----------
    pair : gears.GearPair
    torque : float
        Of the pinion [N m].
    rho1 : ndarray, shape (m,)
        Curvature radius of the pinion's flank where one pair was loaded, A to E [m].
    phase : ndarray, shape (n,)
        Travel after a pair is at A, over the base pitch.
    references, models : tuple of Curves
        Finite elements with all and with fewer parts; closed forms.
    differences : tuple of Difference
        Every figure of every model against every reference.
    compliance_seconds : float
        Cost of the finite elements that all references share, when they were computed [s].
    """

    pair: GearPair
    torque: float
    rho1: Array
    phase: Array
    references: tuple[Curves, ...]
    models: tuple[Curves, ...]
    differences: tuple[Difference, ...]
    compliance_seconds: float

    @property
    def like_for_like(self) -> Curves:
        """Finite elements without what closed forms lack."""
        return max(self.references, key=lambda reference: len(reference.left_out))


def verification(engine: Engine) -> Verification:
    """Compare every closed form with finite elements on a scene's pair, torque and tolerance."""
    scene = engine.scene
    pair, bodies = engine["pair"], engine["compliance"]
    torque = pinion_torque(scene)
    beyond = scene.stiffness.contact_beyond_path
    references = tuple(reference_curves(pair, torque, bodies, POSITIONS, beyond))
    models = tuple(closed_form_curves(pair, pair.normal_force(torque), POSITIONS))
    return Verification(
        pair=pair,
        torque=torque,
        rho1=stations(pair),
        phase=(np.arange(POSITIONS) + 0.5) / POSITIONS,
        references=references,
        models=models,
        differences=tuple(_differences(pair, references, models)),
        compliance_seconds=bodies.cost.seconds,
    )


def figures(pair: GearPair, curves: Curves, every: int = 1) -> dict[str, float]:
    """Figures of a model in the units of `UNITS`; NaN where it has none.

    Parameters
    ----------
    every : int
        Takes the middle one of as many neighbouring positions, which are midpoints again; odd.
    """
    scale = 1e-9 / pair.face_width
    found = dict.fromkeys(UNITS, float("nan"))
    found |= {name: scale * value for name, value in curves.means.items()}
    if not curves.single.size:
        return found
    rho1, middle = stations(pair), slice(every // 2, None, every)
    secant, te = curves.secant[middle], curves.transmission_error[middle]
    two = curves.pairs[middle] == 2
    spectrum = 2 * np.abs(np.fft.rfft(secant)) / secant.sum()
    found |= {
        "one pair, at C": scale * float(np.interp(pair.points.C, rho1, curves.single)),
        "one pair, largest": scale * float(curves.single.max()),
        "one pair, mean A to E": scale * float(np.trapezoid(curves.single, rho1) / np.ptp(rho1)),
        "mesh, two pairs, mean": scale * float(secant[two].mean()) if two.any() else float("nan"),
        "mesh, mean": scale * float(secant.mean()),
        "transmission error, peak to peak": 1e6 * float(np.ptp(te)),
    }
    return found | {f"harmonic {j} over mean": float(spectrum[j]) for j in (1, 2, 3)}


def figure_errors(pair: GearPair, curves: Curves) -> dict[str, float]:
    """Estimate the relative numerical error of each figure by finite elements.

    The error e of the compliance holds at each position. If the errors of different positions had opposite
    signs, a harmonic over the mean could be off by 2 e, and the peak-to-peak transmission error by e times
    the sum of the largest and the least deflection; they rarely have. The number of positions adds half the
    change that a third of them would make.
    """
    whole, third = figures(pair, curves), figures(pair, curves, every=3)
    own = curves.error or 0.0
    deflection = 1e6 * float(curves.transmission_error.max() + curves.transmission_error.min())
    errors = {}
    for name, value in whole.items():
        absolute = own * value
        if name.startswith("harmonic"):
            absolute = (2 + value) * own
        elif name.startswith("transmission"):
            absolute = own * deflection
        sampling = 0.0 if name.startswith("one pair") else 0.5 * abs(third[name] - value)
        errors[name] = (absolute + sampling) / abs(value)
    return errors


def _differences(
    pair: GearPair, references: tuple[Curves, ...], models: tuple[Curves, ...]
) -> list[Difference]:
    found = []
    for reference in references:
        values, errors = figures(pair, reference), figure_errors(pair, reference)
        for model in models:
            found += [
                Difference(name, UNITS[name], reference.label, model.label, values[name], errors[name], value)
                for name, value in figures(pair, model).items()
                if np.isfinite(value) and np.isfinite(values[name])
            ]
    return found
