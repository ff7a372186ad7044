"""Stiffness and nominal stresses of a pair by ISO 6336, of spur and of helical gears."""

from __future__ import annotations

import gears
from base import Cost, InputError, Stopwatch, part, record
from gears.closed_form.record import STANDARD

__all__ = ["Standards", "standards"]


@record
class Standards:
    """What ISO 6336 says of a pair under a torque, all factors K = 1."""

    stiffness: gears.closed_form.Iso6336Stiffness = part("stiffness by ISO 6336-1")
    contact: gears.closed_form.Iso6336ContactStress = part("nominal contact stress by ISO 6336-2")
    root: gears.closed_form.Iso6336RootStress | None = part(
        "nominal root stress by ISO 6336-3, None where the standard gives none"
    )
    root_fault: str = part("why the standard gives no root stress; empty where it does")
    cost: Cost
    converged: bool = True
    message: str = ""

    no_error = STANDARD

    def __repr__(self) -> str:
        """One line: stiffness, and stresses of both gears."""
        roots = () if self.root is None else (1e-6 * stress for stress in self.root.stresses)
        shown = " and ".join(f"{stress:.5g}" for stress in roots) or "no"
        contact = f"sigma_H0 {1e-6 * self.contact.stresses[0]:.5g} MPa"
        return (
            f"Standards(c_gamma {self.stiffness.c_gamma:.5g} N/(mm um), {contact}, sigma_F0 {shown} MPa, "
            f"{self.cost.seconds:.3g} s)"
        )

    @property
    def error(self) -> None:
        """Model error, which a closed form cannot know: None stands for unknown, never for zero."""
        return


def standards(pair: gears.GearPair, torque: float) -> Standards:
    """Stiffness, contact and root stress of a pair by ISO 6336-1, 6336-2 and 6336-3.

    Parameters
    ----------
    pair : gears.GearPair
        Spur or helical.
    torque : float
        Of the pinion [N m]; its sign does not count.

    Returns
    -------
    Standards

    Raises
    ------
    InputError
        Without torque, and for a contact ratio that ISO 6336-2 does not have.

    Examples
    --------
    >>> from math import radians
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, helix_angle=radians(20.0))
    >>> found = standards(pair, 600.0)
    >>> round(found.stiffness.c_gamma, 2), round(found.contact.Z_beta, 4), round(found.root.Y_beta, 4)
    (18.49, 1.0316, 0.8333)
    """
    from gears import closed_form as forms

    watch, force = Stopwatch(), abs(pair.normal_force(torque))
    stiffness, contact = forms.iso6336(pair, force=force), forms.iso6336_2(pair, force)
    try:
        root, fault = forms.iso6336_3(pair, force), ""
    except InputError as error:
        root, fault = None, "; ".join(map(str, error.faults))
    return Standards(stiffness, contact, root, fault, Cost(watch.seconds))
