"""Stress and displacement of the loaded teeth; over the mesh cycle for ParaView."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.figures.reading import Pictures
from flankfilm.output import drawing_data as drawn
from flankfilm.output.variables import of_quantities
from flankfilm.products.product import Product, section_of
from flankfilm.report.page import Part, pictures, said
from flankfilm.report.text import number
from flankfilm.scene import Scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Stage
from flankfilm.stages.mesh import FIELDS, MESH, PAIR, along_the_face

if TYPE_CHECKING:
    import xarray as xr

    from fem.fields.surface_frames import SurfaceFrame, Surfaces
    from flankfilm.coupling import LoadedFields

PICTURES: Pictures = {"tooth_stress": "field_von_mises"}


def goals(scene: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
    """Fields at the pitch point; of a load that varies along the face, and of helical pairs, the files alone."""
    if "vtk" in wants:
        yield MESH if along_the_face(scene) else FIELDS


def variables(computed: Computed) -> Iterator[xr.Dataset]:
    """Stress near the mesh."""
    fields, pair = computed.get(FIELDS), computed.get(PAIR)
    if fields is not None and pair is not None:
        yield of_quantities("field", drawn.near_mesh(pair, (fields.pinion, fields.wheel)))


def section(stage: LoadedFields, results: xr.Dataset) -> Part:
    """Picture of the loaded teeth."""
    peak = max(float(np.nanmax(field.von_mises_Pa)) for field in (stage.pinion, stage.wheel))
    note = said("peak", peak=number(1e-6 * peak))
    drawn = pictures(results, PICTURES)
    return Part("fields", "Loaded teeth", figures=drawn, notes=(note,))


def in_space(
    surfaces: tuple[Surfaces, Mapping[float, SurfaceFrame]] | None, results: xr.Dataset
) -> Iterator[Part]:
    """Section with the pair that turns, of surfaces that were kept while the files for ParaView were written."""
    if surfaces is None:
        return
    from flankfilm.figures.rendering.turning import turning
    from flankfilm.figures.rendering.turning_page import inset

    teeth, frames = surfaces
    shown = turning(list(frames), list(frames.values()), teeth, results)
    yield Part("turning", "Loaded teeth in three dimensions", (said("turning"),), inset=inset(shown))


PRODUCT = Product(
    name="vtk",
    goals=goals,
    variables=variables,
    solved={"field": FIELDS},
    pictures=PICTURES,
    sections=section_of(FIELDS, section),
)
