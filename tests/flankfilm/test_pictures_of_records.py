"""`result.plot()`: a figure with units for every record that has one, registered without loading what draws."""

from __future__ import annotations

import importlib
import subprocess
import sys
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import dynamics
import ehl
import flankfilm as ff
from base import InputError, has_picture, plot
from base.views import GROUP
from flankfilm import figures
from flankfilm.figures.film import film_along_path
from flankfilm.figures.records import function
from flankfilm.figures.views import OF_PRODUCT, PICTURES, VIEWS, register
from flankfilm.output import records as records_of_output
from flankfilm.runs.report import _asked
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from gears import Gear, GearPair, closed_form, dimensions
from tests.flankfilm.pictured import PURE
from tests.flankfilm.scenes import CLOSED_FORMS_WITH_FILM, ishikawa

register()

PAIR = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=0.04)
OSCILLATOR = dynamics.GearOscillator(
    stiffness=dynamics.FourierStiffness(mean=1.0, amplitudes=(0.18,), phases=(0.0,)),
    damping_ratio=0.05,
    mean_force=0.1,
    error_amplitude=0.2,
    frequency=0.6,
    half_backlash=0.2,
)


def labels(figure):
    shown = [axes for axes in figure.axes if axes.axison]
    assert shown
    return [text for axes in shown for text in (axes.get_xlabel(), axes.get_ylabel()) if text]


def records():
    path = PAIR.path_of_contact(9)
    yield PAIR
    yield path
    yield closed_form.ishikawa(PAIR, path)
    orbit = dynamics.find_orbit(OSCILLATOR, guess=(0.5, 0.2), periods=1)
    yield orbit
    yield dynamics.trajectory(OSCILLATOR, (0.5, 0.2))
    yield dynamics.continue_branch(orbit, parameter="frequency", bounds=(0.55, 0.65))
    yield dynamics.sweep(OSCILLATOR, parameter="frequency", values=np.linspace(0.5, 0.6, 3), direction="up")
    yield dynamics.multi_sweep(OSCILLATOR, parameter="frequency", values=np.linspace(0.5, 0.6, 3))
    yield dynamics.basins(OSCILLATOR, x=(-1, 1, 6), v=(-1, 1, 6))
    yield ff.mesh_cycle(PAIR, torque=600.0, model="ishikawa")
    oil = ehl.Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
    losses = ff.mesh_losses(PAIR, 300.0, 209.44, oil, model="ishikawa", positions=4)
    yield from (losses, losses.path)


def test_every_name_of_a_picture_is_there():
    for place in (*PICTURES, *(place for place in VIEWS if ":" in place)):
        module, _, name = place.partition(":")
        assert isinstance(getattr(importlib.import_module(module), name), type), place
    register()
    for view in VIEWS.values():
        module, _, name = view.partition(":")
        assert callable(getattr(importlib.import_module(module), name))
    for how in PICTURES.values():
        assert callable(getattr(records_of_output, how.data))
        if how.draw != OF_PRODUCT:
            assert callable(function(how))
            assert how.draw.partition(".")[2] in figures.__all__


@pytest.mark.slow
def test_records_draw_themselves_with_units_and_show_figures_and_picture():
    for record in records():
        figure = record.plot()
        for label in labels(figure):
            assert "[" in label or label in PURE, (type(record), label)
        html = record._repr_html_()
        assert "<script" not in html
        tree = ET.fromstring(f"<div>{html}</div>")
        assert tree.find(".//img") is not None or tree.find(".//svg") is not None, type(record)


def test_a_mesh_cycle_shows_values_errors_and_the_curves_of_the_record():
    cycle = ff.mesh_cycle(PAIR, torque=600.0, model="ishikawa")
    stiffness, error = cycle.plot().axes
    drawn = stiffness.lines[0].get_ydata()
    assert np.allclose(drawn, 1e-6 * np.tile(cycle.dense_secant_stiffness, 2))
    assert np.allclose(error.lines[0].get_ydata(), 1e6 * np.tile(cycle.dense_transmission_error, 2))
    assert stiffness.get_ylabel().endswith("[N/µm]")
    assert error.get_ylabel().endswith("[µm]")


def test_one_without_a_picture_says_which_have_one():
    sizes = dimensions(PAIR)
    assert not has_picture(sizes)
    with pytest.raises(InputError, match=r"has no picture. These have one: .*ehl\.films\.film\.Film"):
        sizes.plot()
    with pytest.raises(InputError, match=r"float\.plot"):
        plot(3.0)


def test_a_run_draws_what_it_went_furthest_for():
    found = run_scene(parse_scene(ishikawa("drawn", "closed-forms", "stiffness")), None, use_cache=False)
    assert any("stiffness" in label for label in labels(found.plot()))
    assert "<img" in found._repr_html_()
    bare = run_scene(parse_scene(ishikawa("drawn", "geometry")), None, use_cache=False)
    assert labels(bare.plot())


ALONE = """
import sys
sys.path.insert(0, {folder!r})
import dynamics, gears
from gears import Gear, GearPair
pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=0.04)
assert not {{"matplotlib", "flankfilm"}} & set(sys.modules)
figure = pair.plot()
assert type(figure).__module__ == "matplotlib.figure"
assert "matplotlib.pyplot" not in sys.modules
"""


def test_the_ground_packages_load_what_draws_by_an_entry_point_alone(tmp_path):
    """The distribution names the function; gears knows nothing of what draws."""
    about = tmp_path / "drawers-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: drawers\nVersion: 1.0\n", encoding="utf-8")
    (about / "entry_points.txt").write_text(
        f"[{GROUP}]\na = flankfilm.figures.views:register\n", encoding="utf-8"
    )
    subprocess.run([sys.executable, "-c", ALONE.format(folder=str(tmp_path))], check=True)


SAVED = """
import matplotlib
matplotlib.use("agg")
from matplotlib import pyplot as plt
from gears import Gear, GearPair
from flankfilm.figures.views import register
register()
pair = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=0.04)
figure = pair.path_of_contact(9).plot()
assert plt.gcf() is figure
plt.savefig("saved.png")
assert plt.imread("saved.png").min() < 0.5
pair._repr_html_()
assert len(plt.get_fignums()) == 1
"""


def test_pyplot_saves_the_picture_and_not_a_blank_one(tmp_path):
    """The figure was not pyplot's, whose `savefig` wrote an empty one."""
    subprocess.run([sys.executable, "-c", SAVED], check=True, cwd=tmp_path)


def test_films_are_not_flattened_by_those_of_hardly_loaded_ends():
    """At the ends of relieved flanks films are ten times as thick, and the axis was as high."""
    found = run_scene(parse_scene(CLOSED_FORMS_WITH_FILM.replace("TITLE", "film")), None, use_cache=False)
    data = found.dataset.copy(deep=True)
    film = data["film_central_thickness"]
    plain = film_along_path(data).axes[0]
    assert plain.get_ylim()[1] > 1e6 * float(film.max())
    assert not any("hardly loaded" in text.get_text() for text in plain.texts)
    film[[0, -1]] *= 12.0
    spiked = film_along_path(data).axes[0]
    assert spiked.get_ylim()[1] < 3.0e6 * float(film.median())
    assert any("hardly loaded" in text.get_text() for text in spiked.texts)


def test_inputs_say_nothing_of_a_film_that_the_scene_does_not_name():
    """They said that it had none, and it was solved."""
    text = CLOSED_FORMS_WITH_FILM.replace("TITLE", "film")
    assert _asked(parse_scene(text))["film"]["model"] == "dowson"
    unnamed = text.partition("[film]")[0]
    assert "film" not in _asked(parse_scene(unnamed))
