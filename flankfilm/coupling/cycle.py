"""Mesh stiffness over one base pitch, from whichever model, in one form for all that follows."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any, ClassVar, Self

import numpy as np

import fem
from base import Array, Cost, InputError, described, part, quantity, record


@record
class MeshCycle:
    """Stiffness, load share and deflection at the midpoints of equal intervals of one base pitch, by any model.

    ``error`` is the estimated relative numerical error at each position; None where the model's error is unknown.
    """

    headline: ClassVar[tuple[str, ...]] = (
        "label",
        "mean_secant_stiffness",
        "mean_stiffness",
        "transmission_error_range",
    )

    label: str = quantity("", "model of the mesh cycle")
    position: Array = quantity("1", "position, base pitches from A", "position")
    rho1: Array = quantity(
        "m",
        "curvature radius of the pinion's flank at the contact; nan without contact",
        "position pair",
        shown="mm",
    )
    forces: Array = quantity("N", "normal force of each pair", "position pair")
    load_share: Array = quantity("1", "load share: each pair's share of the torque", "position pair")
    secant_stiffness: Array = quantity(
        "N/m", "secant stiffness: force over deflection", "position", error="mean_error"
    )
    stiffness: Array = quantity(
        "N/m", "tangent stiffness: slope of force over deflection", "position", error="mean_error"
    )
    transmission_error: Array = quantity(
        "m",
        "loaded transmission error: deflection along the line of action",
        "position",
        shown="um",
        error="error",
    )
    error: float | None
    cost: Cost
    contact: fem.MeshCycle | None = part(
        "loaded contact by finite elements that it was taken from; None by other models", default=None
    )
    converged: bool = True
    message: str = ""
    reference: str = quantity(
        "",
        'what the deflection is measured against: "bore", "body" or "teeth", as which closed forms count',
        default="teeth",
    )

    def against(self, reference: str, bore_inertia: tuple[float, float] = (0.0, 0.0)) -> Self:
        """Measure the deflection of coupled finite elements against something else; no force changes.

        Parameters
        ----------
        reference : {"bore", "body", "teeth"}
            As of `fem.mesh_cycle`.
        bore_inertia : (float, float)
            What turns with the bores of pinion and wheel beside their own bodies, for "body" [kg m2].

        Raises
        ------
        InputError
            For closed forms and independent pairs, whose pairs have no turn in common; no such reference.
        """
        if self.contact is None:
            allowed = "requires a loaded contact by finite elements of coupled pairs"
            raise InputError.at("reference", f"{reference!r} of {self.label}", allowed, "take them")
        before, after = self.contact, self.contact.against(reference, bore_inertia)
        softer = before.force / before.secant_stiffness - after.force / after.secant_stiffness  # D - D'
        steeper = after.stiffness / before.stiffness
        return replace(
            self,
            contact=after,
            reference=after.reference,
            transmission_error=self.transmission_error - softer,
            secant_stiffness=before.force / (before.force / self.secant_stiffness - softer),
            stiffness=self.stiffness * steeper,
            error=None if self.error is None else self.error * max(1.0, float(np.max(steeper))),
        )

    @described("N/m", error="mean_error")
    def mean_secant_stiffness(self) -> float:
        """Mean mesh stiffness (secant)."""
        return float(self.secant_stiffness.mean())

    @described("N/m", error="mean_error")
    def mean_stiffness(self) -> float:
        """Mean mesh stiffness (tangent)."""
        return float(self.stiffness.mean())

    @described("m", shown="um")
    def transmission_error_range(self) -> float:
        """Transmission error, peak to peak."""
        return float(np.ptp(self.transmission_error))

    @described("1")
    def mean_error(self) -> float | None:
        """Estimated relative numerical error of the mean secant stiffness: of the positions and of their number."""
        return None if self.error is None else self.error + sampling_error(self.secant_stiffness)

    def curve(self, kind: str) -> Array:
        """Curve of a kind of stiffness, ``"secant"`` or ``"tangent"`` (positions,) [N/m]."""
        return {"secant": self.secant_stiffness, "tangent": self.stiffness}[kind]

    def harmonic(self, order: int) -> float:
        """Amplitude of a harmonic of the secant stiffness over its mean."""
        return float(harmonics(self.secant_stiffness)[order - 1])

    @classmethod
    def fields_of(cls, found: object) -> dict[str, Any]:
        """Fields of this class that another record has as well, for one made of it."""
        return {one.name: getattr(found, one.name) for one in fields(cls) if hasattr(found, one.name)}


def harmonics(curve: Array) -> Array:
    """Amplitudes of the harmonics 1, 2, ... of evenly sampled values (n,) over their mean, (n // 2,)."""
    spectrum = np.abs(np.fft.rfft(curve))
    return np.asarray(2.0 * spectrum[1:] / spectrum[0])


def sampling_error(stiffness: Array) -> float:
    r"""Estimate the relative error of the mean of `stiffness` over its sampled period.

    A step :math:`\Delta` between two of :math:`n` midpoints lies anywhere between them and moves
    the mean by :math:`\Delta/(n\sqrt{12})` in the root mean square; independent steps add in
    square. On smooth stretches the estimate falls as :math:`n^{-3/2}`, above the true error.

    Parameters
    ----------
    stiffness : ndarray, shape (n,)
        Samples at the midpoints of equal intervals.
    """
    steps = np.diff(stiffness, append=stiffness[:1])
    return float(np.sqrt(np.sum(steps**2) / 12) / (stiffness.size * stiffness.mean()))


def peak_to_peak_error(curve: Array) -> float:
    r"""Bound the relative error of the peak-to-peak value of `curve` from the number of its samples.

    At a cusp, such as the transmission error has where contact passes to the next pair, the extremum is missed by
    up to half the distance h of the samples times the slope. The three sets of every third sample have three times
    the distance; the worst of them misses the highest sample by about h times the slope, wherever the cusp lies
    between samples. Half the largest difference is the bound.

    Parameters
    ----------
    curve : ndarray, shape (n,)
        Samples at the midpoints of equal intervals; n a multiple of three.
    """
    whole = float(np.ptp(curve))
    if whole == 0.0:
        return 0.0
    return max(whole - float(np.ptp(curve[k::3])) for k in range(3)) / (2 * whole)
