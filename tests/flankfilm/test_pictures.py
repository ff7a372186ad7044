"""Every picture: drawn from a dataset, once, with units, and with nothing covered or cut off.

Those of the report's run are tried in `test_report`, which refuses a function that neither file draws.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest
import xarray as xr
from matplotlib.figure import Figure

from base import InputError
from flankfilm import coupling, figures
from flankfilm.figures.reading import drawable
from flankfilm.figures.records import dataset, function
from flankfilm.figures.style import THEME, sheet, to_svg
from flankfilm.figures.views import OF_PRODUCT, PICTURES, register
from flankfilm.products.catalogue import PRODUCTS
from flankfilm.products.product import Product
from flankfilm.report.page import _prose
from flankfilm.runs.pictures import first
from tests.flankfilm import pictured
from tests.flankfilm.pictured import RECORDS, faults_of

register()

OF_RUNS: dict[str, tuple[Any, ...]] = {
    "face": (
        figures.flank_map, figures.film_map, figures.face_load_factor, figures.line_load_models,
        figures.root_face_map, figures.mesh_cycle,
    ),
    "losses": (
        figures.losses_along_path, figures.temperatures_along_path, figures.temperature_field,
        figures.heat_along_path,
    ),
    "train": (
        figures.drive_modes, figures.drive_sweep, figures.drive_run_up, figures.drive_map, figures.spectrum,
        figures.run_up, figures.waterfall, figures.dynamic_map,
    ),
    "error_curve": (figures.excitation,),
    "helical": (
        figures.lines_of_contact, figures.line_load_map, figures.load_centre, figures.film_line_map,
        figures.bearing_sweep,
    ),
}  # fmt: skip
"""Run, or record, to the functions that are drawn from it."""

OF_RECORDS = {how.draw.partition(".")[2] for how in PICTURES.values() if how.draw != OF_PRODUCT}

OF_PRODUCTS = {name for product in PRODUCTS for name in product.pictures}

RENDERED = {"Frame", "animate_cycle", "teeth_scene", "tooth_picture", "view_cycle"}
"""What VTK draws; see test_report_animation and test_face_pictures."""

DRAWN = {draw.__name__ for drawn in OF_RUNS.values() for draw in drawn} | OF_RECORDS | RENDERED


def test_every_record_that_draws_itself_is_tried():
    assert set(RECORDS) == set(PICTURES)


@pytest.mark.slow
@pytest.mark.parametrize("place", RECORDS)
def test_a_record_draws_itself_by_the_function_of_its_dataset(place: str):
    record = RECORDS[place]()
    assert f"{type(record).__module__}:{type(record).__qualname__}" == place
    picture = record.plot()
    assert faults_of(picture) == []
    assert any(axes.lines or axes.collections or axes.patches for axes in picture.axes)
    assert not blank(picture)
    again = drawing(place)(dataset(record))
    assert lines_of(again) == lines_of(picture)


def drawing(place: str) -> Callable[[xr.Dataset], Figure]:
    """Function that draws a record: its own, or the first of its product."""
    how = PICTURES[place]
    return getattr(figures, first(dataset(RECORDS[place]()))) if how.draw == OF_PRODUCT else function(how)


WENT_FURTHEST = {
    "outline_pinion": "gears_in_mesh",
    "single_pair_rho1": "single_pairs",
    "rating_S_H": "safeties",
    "dry_secant_stiffness": "mesh_stiffness",
    "film_central_thickness": "film_along_path",
    "losses_path_friction_coefficient": "losses_along_path",
    "sweep_force_factor_up": "resonance",
    "drive_mode_shapes": "drive_modes",
    "drive_sweep_force_factor_up": "drive_sweep",
    "diagram_branch": "diagram",
    "spectrum_force": "spectrum",
    "run_up_peak_up": "run_up",
    "dynamic_map_factor": "dynamic_map",
}
"""Variable to what a run that has it, and those above it, draws."""


def test_a_run_draws_the_first_picture_of_its_last_product():
    there = xr.Dataset()
    assert first(there) == ""
    for variable, name in WENT_FURTHEST.items():
        there[variable] = 1.0
        assert first(there) == name


@pytest.mark.parametrize(
    "product", [product for product in PRODUCTS if product.pictures], ids=lambda p: p.name
)
def test_every_picture_of_a_product_is_a_function_with_a_caption(product: Product):
    assert set(product.pictures) <= set(figures.__all__) & set(_prose()["captions"])


def test_every_caption_is_of_a_picture_of_a_product():
    assert set(_prose()["captions"]) == OF_PRODUCTS | {"verification"}


@pytest.mark.slow
@pytest.mark.parametrize("name", OF_RUNS)
def test_pictures_of_runs_keep_to_the_same(name: str):
    made = getattr(pictured, name)()
    data: xr.Dataset = getattr(made, "dataset", None)
    for draw in OF_RUNS[name]:
        assert faults_of(draw(data if data is not None else dataset(made))) == [], draw.__name__
    if data is not None:
        assert of_products(data) >= {draw.__name__ for draw in OF_RUNS[name]} & OF_PRODUCTS


def of_products(data: xr.Dataset) -> set[str]:
    """Pictures of all products that a run has the variables of."""
    return {name for product in PRODUCTS for name in drawable(product.pictures, data)}


def lines_of(figure: Figure) -> list[tuple[int, ...]]:
    """Points of every curve."""
    return [tuple(line.get_xydata().shape) for axes in figure.axes for line in axes.lines]


def blank(figure: Figure) -> bool:
    """Whether a panel shows nothing."""
    return not all(
        any(line.get_xydata().size for line in axes.lines) or axes.collections or axes.patches or axes.images
        for axes in figure.axes
        if axes.axison
    )


SINGLE = ("gears.pair.path:PathOfContact", "gears.closed_form.record:ClosedForm")


def axes_of(count: int) -> Any:
    return Figure(figsize=(6.0, 2.5 * count), layout="constrained").subplots(count)


@pytest.mark.parametrize("place", SINGLE)
def test_a_picture_of_one_panel_is_drawn_into_given_axes(place: str):
    axes = axes_of(1)
    figure = RECORDS[place]().plot(ax=axes)
    assert figure is axes.figure
    assert axes.lines
    assert axes.get_legend() is not None
    assert faults_of(figure) == []


def test_one_of_several_panels_takes_as_many_axes_and_says_so():
    cycle = pictured.cycle()
    panels = axes_of(2)
    assert cycle.plot(panels) is panels[0].figure
    assert all(len(axes.lines) for axes in panels)
    shared = Figure().subplots(2, sharex=True)
    assert cycle.plot(shared) is shared[0].figure
    for wrong in (axes_of(1), list(axes_of(3)), "axes"):
        with pytest.raises(InputError, match=r"must be 2 axes, one for each panel.*figure\.subplots\(2\)"):
            cycle.plot(ax=wrong)


def test_a_stiffness_per_face_needs_the_width_and_is_that_of_the_whole_face_without_it():
    cycle = pictured.cycle()
    whole = figures.mesh_cycle(dataset(cycle)).axes[0]
    per_face = figures.mesh_cycle(dataset(cycle).assign(pair_face_width=0.04)).axes[0]
    assert whole.get_ylabel() == "stiffness [N/µm]"
    assert per_face.get_ylabel() == "stiffness [N/(mm µm)]"
    ratio = whole.lines[0].get_ydata() / per_face.lines[0].get_ydata()
    assert ratio == pytest.approx(40.0)


def broken(draw: Callable[[Any], None]) -> list[str]:
    """Faults of a picture after something was done to its panel."""
    figure = RECORDS[SINGLE[0]]().plot()
    draw(figure.axes[0])
    return faults_of(figure)


@pytest.mark.parametrize(
    ("fault", "draw"),
    [
        ("'radius' has no unit", lambda axes: axes.set_ylabel("radius")),
        ("a legend covers data", lambda axes: axes.legend(loc="center")),
        ("numbers of", lambda axes: axes.set_xticks([8.0, 8.01], ["8.00", "8.01"])),
        ("1e6 stands apart", lambda axes: axes.set_ylim(0.0, 3e6)),
        ("something is cut off", lambda axes: axes.set_ylabel(f"{60 * 'wide'} [-]")),
        ("titles of two panels", lambda axes: [way.set_label_coords(0.5, 0.5) for way in (axes.xaxis, axes.yaxis)]),
    ],
)  # fmt: skip
def test_faults_are_seen(fault: str, draw: Callable[[Any], None]):
    assert any(fault in found for found in broken(draw)), broken(draw)


def test_a_given_series_has_no_samples_and_may_be_over_its_mean():
    picture = coupling.given_series(1.0, (0.2,), (0.0,)).plot()
    assert faults_of(picture) == []
    left, right = picture.axes
    assert left.get_ylabel() == "stiffness [-]"
    assert left.lines[0].get_ydata().max() == pytest.approx(1.2)
    assert [bar.get_height() for bar in right.patches] == pytest.approx([0.2])


def test_ids_of_an_inline_drawing_begin_with_its_name_and_its_colours_follow_the_page():
    with sheet() as (drawn, (axes,)):
        axes.plot([0.0, 1.0], [0.0, 1.0], "o-", label="#0072b2:#0072b2")
        axes.plot([0.0, 1.0], [1.0, 0.0], color="#123456")
    text = to_svg(drawn, "own")
    ids = set(re.findall(r'\bid="(.*?)"', text))
    used = re.findall(r'(?:url\(|href=")#(.*?)[")]', text)
    assert used
    assert set(used) <= ids
    assert all(name.startswith("own-") for name in ids)
    assert f"stroke: var({THEME['#0072b2']},#0072b2)" in text
    assert "stroke: #123456" in text
    # not a colour alone: words that hold one
    assert f">#0072b2:var({THEME['#0072b2']},#0072b2)<" in text
