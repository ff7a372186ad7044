"""Numerical settings of finite elements that a user could have to know: they decide errors, cost and remarks."""

from __future__ import annotations

from dataclasses import dataclass

from base import Faults, Limit

__all__ = ["USUAL_OPTIONS", "Options"]

PART = Limit.above(0.0, 1.0)
SIZE = Limit(0.0)
LIMITS = {
    "finest": Limit(1, 5, whole=True, remedy="4 meets a tolerance of 2e-6"),
    "order": Limit(1.0, 4.0, remedy="3 is measured, 4 the limit"),
    "fit": PART,
    "sampling": PART,
    "measured_points": Limit(0, whole=True),
    "large_deflection": SIZE,
    "large_shift": SIZE,
    "wide_contact": SIZE,
}


@dataclass(frozen=True)
class Options:
    """Numerical settings of `fem.compliance` and `fem.mesh_cycle`; a tolerance and what is computed are keywords there.

    Attributes
    ----------
    finest : int
        Most refinements that a tolerance may ask for, 1 to 5. Where they do not meet it the error stays above it.
    order : float
        Order p of convergence that the error of the mesh is taken from, its change by the last refinement over
        2^p - 1; 1 to 4. The displacement at a load has 4 in the limit, 3 to 3.7 on meshes in use, lowest at the tip.
    fit : float
        Part of the tolerance that interpolation between loads along a flank may leave; there are 32 loads, 48 or 64
        where it leaves more. So little that errors are those of the mesh, whose sign and place nested meshes show;
        those of a fit wave.
    sampling : float
        Part of the tolerance that arcs of the mesh cycle may leave out between their samples.
    measured_points : int
        Points of a measured deviation or wear up to which each ends an arc.
    large_deflection : float
        Deflection [modules] above which the cycle warns that laws of the first order leave something out.
    large_shift : float
        Give of shafts along the line of action [modules] above which it does: the path of contact gets shorter by as
        much, the contact ratio less by a third of it.
    wide_contact : float
        Half-width of a contact over its radius of relative curvature above which it does.

    Examples
    --------
    >>> from fem import Options, compliance
    >>> from gears import Gear, GearPair
    >>> pair = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3)
    >>> compliance(pair, 1e-5, options=Options(finest=1)).error > 1e-5
    True
    """

    finest: int = 4
    order: float = 3.0
    fit: float = 0.03
    sampling: float = 0.1
    measured_points: int = 20
    large_deflection: float = 0.03
    large_shift: float = 0.1
    wide_contact: float = 0.07

    @property
    def gain(self) -> float:
        """How much further the next finer mesh would be than the change to this one."""
        return float(2.0**self.order - 1.0)

    def check(self, faults: Faults) -> None:
        """Note everything that is wrong."""
        faults.fields(self, LIMITS, "options.")


USUAL_OPTIONS = Options()
"""What counts unless options are given."""
