"""Safeties of a rating by our own load factors, beside the standard's: method A of ISO 6336-1."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import gears.rating
from base import part, quantity, record
from gears.closed_form.face_load import iso6336_face_load

if TYPE_CHECKING:
    from flankfilm.coupling.rating.loaded_factors import LoadedFactors
    from flankfilm.coupling.rating.motion_factor import MotionFactor
    from flankfilm.coupling.rating.own_contact import OwnContact
    from gears.rating import Rating

STRENGTH = "not known: strengths and nominal stresses are the standard's"
"""Why a safety has no model error."""


@record
class OwnRating:
    """Safeties whose load factors are computed where the run has them, and the standard's where it does not."""

    headline = ("S_H", "S_F")
    no_error = "the standard's: nothing in this run gives it"

    K_v: float = quantity("1", "dynamic factor: of the motion, or the standard's", error="K_v_error")
    K_H: float = quantity(
        "1", "face-load and transverse load factor of the contact stress together", error="K_H_error"
    )
    K_F: float = quantity(
        "1", "face-load and transverse load factor of the root stress together", error="K_H_error"
    )
    K_v_error: float | None = quantity("1", "estimated relative error of the dynamic factor")
    K_H_error: float | None = quantity("1", "estimated relative error of the other load factors")
    S_H: tuple[float, float] = quantity("1", "safety against pitting", "gear", error="S_H_error")
    S_F: tuple[float, float] | None = quantity(
        "1", "safety against breakage; None where ISO 6336-3 has no answer", "gear", error="S_F_error"
    )
    S_H_error: float = quantity("1", "estimated relative error of the safety against pitting")
    S_F_error: float = quantity("1", "estimated relative error of the safety against breakage")
    motion: MotionFactor | None = part("dynamic factor of the motion; None without a wanted motion")
    loaded: LoadedFactors | None = part("load factors of the loaded contact; None without a mesh cycle")
    root_ratio: tuple[float, float] | None = quantity(
        "1",
        "maximum tension of the fillets by finite elements over the nominal root stress; None without root stress",
        "gear",
        error="root_error",
    )
    root_error: float | None = quantity("1", "estimated relative error of the fillets' stress")
    flanks: OwnContact | None = part("flanks by our own films; None without a wanted film", default=None)

    @property
    def error(self) -> float:
        """Relative error of the safeties, the larger one."""
        return max(self.S_H_error, self.S_F_error)


def own_rating(
    rating: Rating,
    pair: gears.GearPair,
    *,
    motion: MotionFactor | None = None,
    loaded: LoadedFactors | None = None,
    tensions: tuple[float, float] | None = None,
    tension_error: float | None = None,
    flanks: OwnContact | None = None,
) -> OwnRating:
    """Put our own load factors into a rating in place of the standard's.

    Application factor, nominal stresses and strengths stay. S_H goes with the root of the factors, S_F with the
    factors themselves; K_F is K_H^N_F with the standard's exponent. Errors of factors add up.

    Parameters
    ----------
    rating : Rating
    pair : GearPair
    motion : MotionFactor, optional
    loaded : LoadedFactors, optional
    tensions : (float, float), optional
        Maximum tension of the fillets of both gears at the nominal load [Pa]: compared, and in no safety, since the
        strengths belong to the standard's stresses.
    tension_error : float, optional
    flanks : OwnContact, optional
        Compared as well, and in no safety.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from gears.rating import RatedSteel, RatingData, rate
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
    >>> data = RatingData(6, (RatedSteel("Eh", 1500e6, 430e6),) * 2, 3.6e7, 220e-6, 4.8e-6, (20e-6, 20e-6))
    >>> rating = rate(pair, 300.0, 209.44, data)
    >>> own_rating(rating, pair).S_H == rating.S_H
    True
    """
    factors, replaced = rating.factors, motion is not None or loaded is not None
    K_v, K_v_error = (factors.K_v, None) if motion is None else (motion.K_v, motion.error)
    K_H, K_F = factors.K_Hbeta * factors.K_Halpha, factors.K_Fbeta * factors.K_Falpha
    K_H_error = None
    if loaded is not None and loaded.K_H is not None:
        N_F = iso6336_face_load(pair, abs(rating.torque), 0.0).N_F
        K_H, K_F, K_H_error = _together(rating, loaded, N_F)
    contact, bending = factors.K_A * K_v * K_H, factors.K_A * K_v * K_F
    off = (K_v_error or 0.0) + (K_H_error or 0.0)
    S_H = rating.S_H if not replaced else _scaled(rating.S_H, math.sqrt(factors.contact / contact))
    S_F = rating.S_F
    if replaced and S_F is not None:
        S_F = _scaled(S_F, factors.bending / bending)
    root_ratio = None
    if tensions is not None and rating.bending is not None:
        first, second = (t / s for t, s in zip(tensions, rating.bending.nominal.stresses, strict=True))
        root_ratio = first, second
    return OwnRating(
        K_v,
        K_H,
        K_F,
        K_v_error,
        K_H_error,
        S_H,
        S_F,
        0.5 * off,
        off,
        motion,
        loaded,
        root_ratio,
        None if root_ratio is None else tension_error,
        flanks,
    )


def _together(rating: Rating, loaded: LoadedFactors, N_F: float) -> tuple[float, float, float | None]:
    """K_H and K_F with what is computed, the standard's for what is not, and the error of both."""
    factors = rating.factors
    if loaded.helical:
        assert loaded.K_H is not None
        return loaded.K_H, loaded.K_H**N_F, loaded.error
    beta = factors.K_Hbeta if loaded.K_Hbeta is None else loaded.K_Hbeta
    alpha = factors.K_Halpha if loaded.K_Halpha is None else loaded.K_Halpha
    return beta * alpha, beta**N_F * alpha, loaded.error


def _scaled(safeties: tuple[float, float], factor: float) -> tuple[float, float]:
    return safeties[0] * factor, safeties[1] * factor
