"""The scene file: its sections and the keys of the scene itself.

A key carries its unit (`module_mm`); values become SI by `flankfilm.building.pair`. Bounds are the ground's, wide
enough for every gear that is made and narrow enough to catch a wrong unit.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from base import InputError, Limit
from flankfilm.scene.sections.alignment import AlignmentSection
from flankfilm.scene.sections.bearings import BearingsSection
from flankfilm.scene.sections.dynamics import DynamicsSection
from flankfilm.scene.sections.film import FilmSection
from flankfilm.scene.sections.gears import PairSection
from flankfilm.scene.sections.heat import HeatSection
from flankfilm.scene.sections.key import Traits, key
from flankfilm.scene.sections.lubricant import LubricantSection
from flankfilm.scene.sections.materials import MaterialSection
from flankfilm.scene.sections.operating import OperatingSection, StiffnessSection
from flankfilm.scene.sections.rating import RatingSection
from flankfilm.scene.sections.roughness import RoughnessSection
from flankfilm.scene.sections.section import Section
from flankfilm.scene.sections.shafts import ShaftsSection
from flankfilm.scene.wants import WANTS

__all__ = ["Scene", "Want", "parse_tolerance"]

if TYPE_CHECKING:
    Want = str
else:
    Want = Literal[tuple(WANTS)]

TOLERANCE = Limit(1e-5, 0.4)


def parse_tolerance(value: Any, name: str = "") -> Any:
    """Read a tolerance such as ``"0.5%"``, ``"0.005"`` or 0.005.

    Parameters
    ----------
    value : Any
        A text or a number; anything else is handed back for the scene to refuse.
    name : str
        What a fault calls it.

    Raises
    ------
    InputError
        For a text that is no number, or out of bounds.

    Examples
    --------
    >>> parse_tolerance("0.5%")
    0.005
    """
    if not isinstance(value, str):
        return value
    number, percent, rest = value.strip().partition("%")
    try:
        share = float(number) / (100.0 if percent else 1.0)
    except ValueError:
        share = float("nan")
    if rest or not TOLERANCE.holds(share):
        allowed = f"must be from {TOLERANCE.low:g} to {TOLERANCE.high:g}, or the same in per cent"
        raise InputError.at(name, value, allowed, "Such as 0.5%")
    return share


class Scene(Section):
    """A whole scene file."""

    title: str = key("title of the report", "", example="A spur-gear pair", max_length=200)
    wants: Annotated[tuple[Want, ...], Field(strict=False)] = key(
        "results to compute, any of these; nothing else is computed",
        example=("stiffness", "film", "sweep", "vtk", "report"),
        min_length=1,
        max_length=20,
    )
    tolerance: Annotated[float, BeforeValidator(parse_tolerance)] = key(
        'relative error allowed for the wanted figures, also as "0.5%"; the report shows how it was split',
        0.005,
        limit=TOLERANCE,
        shown=True,
    )
    pair: PairSection | None = key("Geometry of the pair", None, shown=True)
    material: MaterialSection | None = key(
        "Material of both gears, or of each in material.pinion and material.wheel", None, shown=True
    )
    heat: HeatSection | None = key(
        "Temperatures, by which gears and housing grow; all at 20 degC if left out", None
    )
    alignment: AlignmentSection | None = key(
        "Axes out of parallel, and cells of the face; parallel if left out",
        None,
        traits=Traits(finite_elements=True, along_face=True),
    )
    operating: OperatingSection | None = key("Load and speed", None, shown=True)
    lubricant: LubricantSection | None = key("Oil: properties, or grade and temperature", None, shown=True)
    roughness: RoughnessSection | None = key(
        "Rough flanks make the film mixed: asperities carry a share of the load; smooth if left out", None
    )
    stiffness: StiffnessSection = key("Where the mesh stiffness comes from", StiffnessSection(), shown=True)
    film: FilmSection = key("The oil film", FilmSection(model="none"), shown=True)
    dynamics: DynamicsSection | None = key("Torsional vibration of the pair", None, shown=True)
    rating: RatingSection | None = key(
        "Rating by ISO 6336 and by scuffing: grade, steels, life; none if left out", None
    )
    shafts: ShaftsSection | None = key(
        "Shafts, bearings, motor and load, with which the wanted sweep is of the drive train; rigid if left out",
        None,
    )

    bearings: BearingsSection | None = key(
        "Bearings of both gears on rigid shafts, for the wanted bearing forces of a helical pair", None
    )

    @property
    def as_given(self) -> dict[str, Any]:
        """What the scene was made from, as a file has it: without defaults and without what is None."""
        return self.model_dump(mode="json", exclude_unset=True, exclude_none=True)

    @property
    def rpm(self) -> float | None:
        """Speed of the pinion [rpm]; None where the scene does not say it."""
        return None if self.operating is None else self.operating.pinion_speed_rpm

    @property
    def reference(self) -> Literal["body", "bore", "teeth"] | None:
        """What the scene says that deflections by finite elements are measured against; None where it does not."""
        return self.stiffness.reference or (
            None if self.dynamics is None else self.dynamics.stiffness_reference
        )

    @property
    def tip_edges(self) -> bool:
        """Whether tip edges may touch outside the path: of spur pairs unless something else is given."""
        asked = self.stiffness.contact_beyond_path
        return asked if asked is not None else self.pair is None or not self.pair.helical

    @property
    def bore_inertia(self) -> tuple[float, float]:
        """What turns with the bores of pinion and wheel beside their own bodies [kg m2]."""
        return (0.0, 0.0) if self.dynamics is None else self.dynamics.extra_inertia_kg_m2.each

    @property
    def shafts_under_face(self) -> ShaftsSection | None:
        """[shafts] where they bend and twist under cells of the face; None elsewhere.

        [alignment] asks for cells, and a helix always has them.
        """
        cells = self.alignment is not None or (self.pair is not None and self.pair.helical)
        return self.shafts if cells and self.shafts is not None and self.shafts.bends else None

    @property
    def face(self) -> dict[str, Any] | None:
        """What decides how the load varies along the face beside the gears, as plain values; None where nothing."""
        under = self.shafts_under_face
        if self.alignment is None and under is None:
            return None
        alignment = (
            {} if self.alignment is None else self.alignment.model_dump(exclude={"in_plane_tolerance_um"})
        )
        if under is None:
            return alignment
        return alignment | {"shafts": [None if shaft is None else shaft.bent for shaft in under.each]}
