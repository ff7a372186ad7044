"""Cases of the closed forms and of the meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.bench.case import Answer, Case, Levels, case, level, over, value
from flankfilm.bench.examples import TORQUE, example_pair
from flankfilm.bench.work_cases import work_geometry, work_rating

if TYPE_CHECKING:
    from base import Array
    from gears import GearPair
    from meshes import SectorMesh


FORMS = {
    "ishikawa": "Ishikawa",
    "potential_energy": "potential energy",
    "weber_banaschek": "Weber-Banaschek",
}


def independent_pairs(pair: GearPair, form: str, positions: int) -> Array:
    """Mesh stiffness at midpoints of equal intervals of one base pitch, pairs added [N/m], (positions,)."""
    from gears import closed_form

    at = (np.arange(positions) + 0.5) / positions * pair.base_pitch
    places = pair.points.A + at[:, None] + np.arange(np.ceil(pair.contact_ratio)) * pair.base_pitch
    inside = places <= pair.points.E
    path = pair.path_at(np.minimum(places, pair.points.E).ravel())
    force = {"force": pair.normal_force(TORQUE)} if form == "weber_banaschek" else {}
    single = np.asarray(getattr(closed_form, form)(pair, path, **force)).reshape(inside.shape)
    summed: Array = np.where(inside, single, 0.0).sum(axis=1)
    return summed


def gears(quick: bool) -> tuple[Case, ...]:
    """Closed forms, and work on the geometry and on ratings."""
    return (closed_forms(quick),) if quick else (closed_forms(quick), work_geometry(), work_rating())


@case("Closed forms", "positions")
def closed_forms(quick: bool) -> Levels:
    """Mean of each closed form's mesh stiffness by the number of positions.

    Pair 36/40: mesh stiffness of independent pairs at midpoints of equal intervals of one base pitch. Errors of the
    mean from sampling alone, where a pair comes in and leaves; what the form itself leaves out is not in them (see the
    finite elements below, and flankfilm verify).
    """
    pair = example_pair()
    counts = (12, 48, 192) if quick else (12, 24, 48, 96, 192, 384, 768)
    label, many = "{} positions".format, 1536 if quick else 6144
    quantities = {form: f"mean, {title}" for form, title in FORMS.items()}

    def means(stiffness: dict[str, Array]) -> Answer:
        values = {quantities[form]: value(curve.mean()) for form, curve in stiffness.items()}
        return Answer(len(next(iter(stiffness.values()))), values)

    def curves(forms: tuple[str, ...], positions: int) -> dict[str, Array]:
        return {form: independent_pairs(pair, form, positions) for form in forms}

    return Levels(
        tuple(over(counts, label, curves, means, (form,), name=title) for form, title in FORMS.items()),
        level(label(many), curves, means, tuple(FORMS), many),
        dict.fromkeys(quantities.values(), 1.0),
    )


def enclosed_area(mesh: SectorMesh) -> float:
    r"""Area inside the boundary's quadratic edges, :math:`\oint (x\,dy - y\,dx)/2` [m^2].

    Simpson's rule is exact: the integrand is a cubic of the edge's parameter.
    """
    edges = np.concatenate(list(mesh.facets.values()))
    first, last, middle = (mesh.points[edges[:, i]] for i in range(3))

    def cross(a: Array, b: Array) -> Array:
        product: Array = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
        return product

    # derivative of the quadratic through the three nodes at its ends and its middle
    at_first = cross(first, 4.0 * middle - 3.0 * first - last)
    at_last = cross(last, 3.0 * last + first - 4.0 * middle)
    return float(np.sum(at_first + 4.0 * cross(middle, last - first) + at_last) / 12.0)


@case("Mesh of one tooth", "unknowns of the sector")
def mesh(quick: bool) -> Levels:
    """How exactly meshes of one tooth keep its outline, by refinement.

    Pinion of the pair 36/40, one sector: gmsh fills the outline, mid-side nodes go onto the exact curves. Errors of
    the area inside the curved edges; a mesh has no separate estimate.
    """
    from meshes import Sizes, mesh_sector

    profile = example_pair().teeth_profiles[0]
    quantity = "area of the sector"

    def area(sector: SectorMesh) -> Answer:
        return Answer(sector.unknowns, {quantity: value(enclosed_area(sector))})

    def scaled(factor: float) -> SectorMesh:
        return mesh_sector(profile, Sizes().scaled(factor))

    factors = (2.0, 1.0) if quick else (2.0, 1.4, 1.0, 0.7, 0.5)
    refinements = (0, 1) if quick else (0, 1, 2)
    label, finest = "refined {} times".format, max(refinements) + 2
    series = (
        over(factors, "edges x {:g}".format, scaled, area, name="edge lengths"),
        over(refinements, label, mesh_sector, area, profile, None, name="refined"),
    )
    return Levels(series, level(label(finest), mesh_sector, area, profile, None, finest), {quantity: 2.0})
