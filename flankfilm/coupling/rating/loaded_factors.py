"""Face-load and transverse load factors of the loaded contact over a mesh cycle, as method A of ISO 6336-1 has them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Booleans, InputError, part, quantity, record
from base.results import EXACT

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle
    from flankfilm.coupling.rating.unequal_pitches import UnequalPitches
    from gears import GearPair

EVEN = "the load is even along the face: add [alignment]"
TOGETHER = "lines of contact cross the face: K_H is both together"
ALL, HALVES = slice(None), (slice(0, None, 2), slice(1, None, 2))
"""Positions of a cycle, and every second one."""

SHARED = "with a contact ratio of 2 and more the nominal stress is not that of a single pair"


@record
class WorstShare:
    """Where a base pitch deviation adds the most to the share of a pair of teeth, relative to that without."""

    headline = ("ratio",)

    ratio: float = quantity("1", "share with the deviation over that without, maximum from A to E")
    share: float = quantity("1", "share with the deviation there", error="error")
    place: float = quantity(
        "m", "place there after A", shown="mm", no_error="not estimated: of the positions computed"
    )
    early: bool = quantity(
        "1", "whether it is by a base pitch of the pinion that is too short", no_error=EXACT
    )
    error: float = quantity("1", "change of the ratio with half as many positions")


@record
class LoadedFactors:
    """Load factors of a loaded contact; None where it has none."""

    headline = ("K_H",)

    K_Hbeta: float | None = quantity("1", "face-load factor, maximum over the mesh cycle", error="error")
    K_Halpha: float | None = quantity(
        "1",
        "transverse load factor: largest share of a pair of teeth, times what the base pitch deviation makes of the "
        "square of the maximum contact pressure on the path",
        error="share_error",
    )
    K_H: float | None = quantity(
        "1", "both together: maximum line load over the mean one that the standard takes", error="error"
    )
    share_error: float | None = quantity("1", "estimated relative error of the transverse load factor")
    no_face: str = quantity("", "why there is no separate K_Hbeta")
    no_share: str = quantity("", "why there is no separate K_Halpha")
    error: float | None = quantity("1", "estimated relative error of the product")
    helical: bool = quantity("1", "whether lines of contact cross the face", no_error=EXACT)
    deviation: float = quantity(
        "m", "base pitch deviation of the loaded contact", shown="um", no_error=EXACT, default=0.0
    )
    K_H_unequal: float | None = quantity(
        "1",
        "maximum line load over the mean one with the base pitch deviation, of lines of contact; in no safety",
        default=None,
        error="error",
    )
    worst_share: WorstShare | None = part(
        "where the deviation makes a pair carry more; None without one", default=None
    )


def loaded_factors(cycle: MeshCycle, pitches: UnequalPitches | None = None) -> LoadedFactors:
    """Load factors of a mesh cycle by finite elements, with a base pitch deviation where its contact is given.

    A spur pair has K_Hbeta from cells of its face, and K_Halpha from the shares of its pairs of teeth. Without a
    deviation that is the largest share: 1 below a contact ratio of 2 while a single pair carries the load somewhere,
    and less where teeth deflect so far that tip edges take over before. A base pitch deviation makes a pair carry more
    at A (taking over early) or at E (late), where flanks are more curved: with the share X and the radius of relative
    curvature rho at places from A to E,

        K_Halpha = max(X) max(X_f/rho)/max(X/rho),

    the square of the ratio of maximum Hertz pressures, the larger one of both signs of the deviation.

    Of a helical pair the maximum line load over the mean of all lines of contact is both together; the nominal stress
    is of that mean (Z_eps = 1/sqrt(eps_alpha) from an overlap ratio of 1 on). With the deviation it stands beside: it
    is that of a corner of the face where a line begins at A or ends at E, which end relief takes away.

    Parameters
    ----------
    cycle : MeshCycle
        By coupled finite elements.
    pitches : UnequalPitches, optional
        The same contact with base pitches that differ.

    Raises
    ------
    InputError
        For a cycle without contacts of finite elements.

    References
    ----------
    ISO 6336-1:2006, clauses 7.2 and 8.2: definitions of K_Hbeta and K_Halpha, method A: the maximum load of a tooth
    over that of gears without deviations.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import mesh_cycle
    >>> pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> found = loaded_factors(mesh_cycle(pair, 600.0, model="fem", pairs="coupled"))
    >>> found.K_Hbeta is None, 0.92 < found.K_Halpha < 0.94
    (True, True)
    """
    contact = cycle.contact
    if contact is None:
        allowed = "must be of coupled finite elements for factors of the loaded contact"
        raise InputError.at("cycle", "", allowed, 'take model = "fem" with pairs = "coupled"')
    deviation = 0.0 if pitches is None else pitches.deviation
    if contact.lines is not None:
        lines, unequal = contact.lines, None if pitches is None else _of_lines(pitches)
        return LoadedFactors(
            None,
            None,
            lines.greatest_line_load_factor,
            None,
            TOGETHER,
            TOGETHER,
            lines.error,
            helical=True,
            deviation=deviation,
            K_H_unequal=unequal,
        )
    share, share_error, no_share = None, None, SHARED
    if contact.pair.contact_ratio < 2.0:
        share, share_error, no_share = *_of_shares(cycle, pitches), ""
    added: dict[str, Any] = {
        "helical": False,
        "deviation": deviation,
        "worst_share": None if pitches is None else worst_share(pitches),
    }
    face = contact.face
    if face is None:
        return LoadedFactors(None, share, share, share_error, EVEN, no_share, share_error, **added)
    beta = face.greatest_face_load_factor
    error = face.error + (share_error or 0.0)
    product = beta * (1.0 if share is None else share)
    return LoadedFactors(beta, share, product, share_error, "", no_share, error, **added)


def _of_lines(pitches: UnequalPitches) -> float:
    """Maximum line load over the mean one with the deviation, of both signs the larger."""
    lines = [cycle.contact.lines for cycle in pitches.unequal if cycle.contact is not None]
    return max(each.greatest_line_load_factor for each in lines if each is not None)


def _of_shares(cycle: MeshCycle, pitches: UnequalPitches | None) -> tuple[float, float | None]:
    """K_Halpha of a spur pair and its error: of the largest share, and of the positions at which pressures are."""
    share, error = cycle.greatest_load_share, cycle.errors.get("greatest_load_share")
    if pitches is None:
        return share, error
    whole = pressure_ratio(pitches)
    return share * whole, (error or 0.0) + _change([pressure_ratio(pitches, half) for half in HALVES], whole)


def _change(halves: list[float], whole: float) -> float:
    """Largest relative change with half as many positions."""
    return max(abs(half / whole - 1.0) for half in halves)


def pressure_ratio(pitches: UnequalPitches, taken: slice = ALL) -> float:
    """Square of the maximum Hertz pressure from A to E with the deviation over that without, of both signs the larger.

    Parameters
    ----------
    pitches : UnequalPitches
        Of a spur pair.
    taken : slice
        Positions that count.
    """
    even, *unequal = (_squares(cycle, taken) for cycle in (pitches.even, *pitches.unequal))
    return max(unequal) / even


def worst_share(pitches: UnequalPitches) -> WorstShare:
    """Place from A to E at which the deviation adds the most to a pair's share, relative to that without.

    Parameters
    ----------
    pitches : UnequalPitches
        Of a spur pair.
    """
    ratio, share, place, early = max(_ratios(pitches, ALL))
    halves = [max(_ratios(pitches, half))[0] for half in HALVES]
    return WorstShare(ratio, share, place, early, _change(halves, ratio))


def _ratios(pitches: UnequalPitches, taken: slice) -> Iterator[tuple[float, float, float, bool]]:
    """Largest ratio of shares of each sign, the share and the place after A, and whether pairs take over early."""
    even, start = pitches.even, _pair(pitches.even).points.A
    inside = (_on_path(even) & (even.load_share > 0.0))[taken]
    before, places = even.load_share[taken][inside], even.rho1[taken][inside]
    for cycle in pitches.unequal:
        share = cycle.load_share[taken][inside]
        at = int(np.argmax(share / before))
        yield (
            float(share[at] / before[at]),
            float(share[at]),
            float(places[at] - start),
            cycle is pitches.early,
        )


def _squares(cycle: MeshCycle, taken: slice) -> float:
    """Maximum of share over radius of relative curvature from A to E [1/m], to which squares of pressures go."""
    line, inside = _pair(cycle).line_of_action, _on_path(cycle)
    rho = np.where(inside, cycle.rho1, 0.5 * line)
    values = np.where(inside, cycle.load_share, 0.0) * line / (rho * (line - rho))
    return float(values[taken].max())


def _on_path(cycle: MeshCycle) -> Booleans:
    """Contacts from A to E (positions, pairs); tip edges beyond have no pressure of Hertz."""
    points = _pair(cycle).points
    with np.errstate(invalid="ignore"):
        return np.asarray((cycle.rho1 >= points.A) & (cycle.rho1 <= points.E))


def _pair(cycle: MeshCycle) -> GearPair:
    assert cycle.contact is not None
    return cycle.contact.pair
