"""Face-load and transverse load factors of the loaded contact over a mesh cycle, as method A of ISO 6336-1 has them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from base import InputError, quantity, record
from base.results import EXACT

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

EVEN = "the load is even along the face: add [alignment]"
TOGETHER = "lines of contact cross the face: K_H is both together"
SHARED = "with a contact ratio of 2 and more the nominal stress is not that of a single pair"


@record
class LoadedFactors:
    """Load factors of a loaded contact; None where it has none."""

    headline = ("K_H",)

    K_Hbeta: float | None = quantity("1", "face-load factor, maximum over the mesh cycle", error="error")
    K_Halpha: float | None = quantity(
        "1", "transverse load factor: largest share of a pair of teeth", error="share_error"
    )
    K_H: float | None = quantity(
        "1", "both together: maximum line load over the mean one that the standard takes", error="error"
    )
    share_error: float | None = quantity("1", "estimated relative error of the largest share")
    no_face: str = quantity("", "why there is no separate K_Hbeta")
    no_share: str = quantity("", "why there is no separate K_Halpha")
    error: float | None = quantity("1", "estimated relative error of the product")
    helical: bool = quantity("1", "whether lines of contact cross the face", no_error=EXACT)


def loaded_factors(cycle: MeshCycle) -> LoadedFactors:
    """Load factors of a mesh cycle by finite elements.

    A spur pair has K_Hbeta from cells of its face, and K_Halpha from the largest share of a pair of teeth: 1 below a
    contact ratio of 2 while a single pair carries the load somewhere, with deviations or without, and less where teeth
    deflect so far that tip edges take over before. Of a helical pair the maximum
    line load over the mean of all lines of contact is both together; the nominal stress is of that mean
    (Z_eps = 1/sqrt(eps_alpha) from an overlap ratio of 1 on).

    Parameters
    ----------
    cycle : MeshCycle
        By coupled finite elements.

    Raises
    ------
    InputError
        For a cycle without contacts of finite elements.

    References
    ----------
    ISO 6336-1:2006, clauses 7.2 and 8.2: definitions of K_Hbeta and K_Halpha, method A.

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
    if (lines := contact.lines) is not None:
        return LoadedFactors(
            None, None, lines.greatest_line_load_factor, None, TOGETHER, TOGETHER, lines.error, helical=True
        )
    shares = contact.pair.contact_ratio < 2.0
    share = cycle.greatest_load_share if shares else None
    share_error = cycle.errors.get("greatest_load_share") if shares else None
    no_share = "" if shares else SHARED
    face = contact.face
    if face is None:
        return LoadedFactors(None, share, share, share_error, EVEN, no_share, share_error, helical=False)
    beta = face.greatest_face_load_factor
    error = face.error + (share_error or 0.0)
    product = beta * (1.0 if share is None else share)
    return LoadedFactors(beta, share, product, share_error, "", no_share, error, helical=False)
