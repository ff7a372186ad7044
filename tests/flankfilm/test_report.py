"""Every figure is drawn from what the files hold; every page opens in a browser, small and large, light and dark."""

from __future__ import annotations

import base64
import inspect
import itertools
import re
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg

from flankfilm import figures
from flankfilm.figures.style import PHONE, narrow, to_svg
from flankfilm.files.cache import Cache
from flankfilm.optimisation.files import dataset as optimum_dataset
from flankfilm.optimisation.optimum import Evaluation, Optimum
from flankfilm.optimisation.page import write_optimum_page
from flankfilm.optimisation.task import read_task
from flankfilm.outcome.results import Results
from flankfilm.output.uncertainty import Uncertainty
from flankfilm.products.catalogue import goals
from flankfilm.products.closed_forms import VERIFICATION
from flankfilm.report.page import Head, Headline, render
from flankfilm.report.run_parts import merged
from flankfilm.runs.dataset import results_dataset, write_data
from flankfilm.runs.report import write_report
from flankfilm.scene import parse_scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import FIELDS
from flankfilm.studies.files import dataset as study_dataset
from flankfilm.studies.page import reference_facts, write_study_page
from flankfilm.studies.plan import plan_of
from flankfilm.studies.row import RowResult
from flankfilm.studies.run import StudyResults
from flankfilm.studies.study_file import StudyFile
from flankfilm.verification.page import write_verification_page
from flankfilm.verification.tables import dataset as verify_dataset
from tests.flankfilm import test_pictures
from tests.flankfilm.pictured import faults_of

SCENE = """
title = "Every picture <b>&amp; one warning"
wants = ["geometry", "closed-forms", "stiffness", "film", "fourier", "sweep", "diagram", "torques", "revolution",
         "root-stress", "report"]
tolerance = 0.05
[pair]
module_mm = 2.0
face_width_mm = 40.0
pinion = { teeth = 23, bore_mm = 20 }
wheel = { teeth = 25, bore_mm = 20, wear = { roll_deg = [15, 25, 35], depth_um = [0, 1, 0] } }
backlash_um = 50
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
density_kg_per_m3 = 7850
[operating]
pinion_torque_Nm = 200
pinion_speed_rpm = 2000
torques_Nm = [100, 200]
[lubricant]
viscosity_Pa_s = 0.075
pressure_viscosity_per_GPa = 19.6
[film]
model = "ehl"
supply = "oil-layer"
oil_layer_um = 0.2
[dynamics]
damping_ratio = 0.05
error_amplitude_um = 10
sweep = { speed_rpm = [12000, 20000], points = 9 }
diagram = { speed_rpm = [16000, 20000], searches = 2, max_period = 1 }
"""
WORN = ", wear = { roll_deg = [15, 25, 35], depth_um = [0, 1, 0] }"
PAIR = SCENE[SCENE.index("[pair]") : SCENE.index("[film]")].replace(WORN, "")
SIMPLE = f'wants = ["stiffness"]\n{PAIR}\n[stiffness]\nmodel = "ishikawa"\npairs = "independent"\n'

OF_A_RUN = (
    figures.diagram, figures.film_along_path, figures.film_changes, figures.film_profiles, figures.film_shares,
    figures.film_stiffness, figures.flanks, figures.fourier, figures.gears_in_mesh, figures.kinematics,
    figures.load_share, figures.mesh_stiffness, figures.over_torque, figures.portraits, figures.revolution,
    figures.resonance, figures.root_stress,
    figures.single_pairs, figures.sweep, figures.tooth_stress, figures.transmission_error,
)  # fmt: skip
OF_OTHERS = {"optimum", "optimum_map", "study", "verification"}


@dataclass(frozen=True)
class Made:
    """A run with its page, and the pages of what is not a run."""

    results: xr.Dataset
    others: dict[str, xr.Dataset]
    pages: dict[str, Path]


def some_study(folder: Path) -> StudyResults:
    (folder / "scene.toml").write_text(SIMPLE, encoding="utf-8")
    raw = {
        "scene": "scene.toml",
        "outputs": ["contact_ratio", "transmission_error_um"],
        "vary": {"pair.module_mm": [1.5, 2.0, 2.5], "operating.pinion_torque_Nm": [100.0, 200.0]},
    }
    plan = plan_of(StudyFile.model_validate(raw), folder)
    rows = [RowResult(i, (1.6 + 0.01 * i, 9.0 - i), 0.1) for i in range(5)]
    rows.append(RowResult(5, (np.nan, np.nan), 0.1, "the mesh <failed>"))
    return StudyResults(plan, tuple(rows), 6, 1.0)


def some_optimum(folder: Path) -> Optimum:
    file = folder / "optimum.toml"
    file.write_text(
        'title = "Trade-off"\nscene = "scene.toml"\nminimise = ["specific_sliding", "transmission_error_um"]\n'
        '[vary]\n"pair.pinion.profile_shift" = { from = 0.0, to = 0.2 }\n'
        '"operating.pinion_torque_Nm" = { from = 100.0, to = 200.0 }\n[limits]\n"contact_ratio" = { at_least = 1.4 }\n',
        encoding="utf-8",
    )
    task = read_task(file)
    found = [
        Evaluation(
            task.tolerances[i // 4],
            (0.02 * i, 100.0 + 13.0 * (5 * i % 8)),
            RowResult(i, (1.0 + 0.1 * i, 9.0 / (i + 1), 1.3 + 0.04 * i, 0.004), 0.1),
        )
        for i in range(8)
    ]
    return Optimum(task, tuple(found), np.array([4, 5, 6, 7]), 8, 1.0)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Made:
    folder = tmp_path_factory.mktemp("report")
    scene = parse_scene(SCENE)
    engine = Engine(scene, Cache(None))
    for stage in (*goals(scene), FIELDS):
        engine[stage]
    values = engine.results()
    data = results_dataset(Computed(scene, values))
    write_data(folder, data)
    run = Results(scene, folder, values, engine.runs, (), 1.0, data)
    pages = {"run": write_report(run, folder)}
    study, verified = some_study(folder), engine[VERIFICATION]
    others = {"study": study_dataset(study), "verification": verify_dataset(verified, scene)}
    best = some_optimum(folder)
    others["optimum"] = others["optimum_map"] = optimum_dataset(best)
    for name in (*others, "none"):
        (folder / name).mkdir()
    pages["study"] = write_study_page(study, others["study"], folder / "study")
    pages["verification"] = write_verification_page(verified, others["verification"], folder / "verification")
    pages["optimum"] = write_optimum_page(best, others["optimum"], folder / "optimum")
    with xr.open_dataset(folder / "results.nc", engine="h5netcdf") as found:
        return Made(found.load(), others, pages)


@pytest.mark.parametrize(
    ("section", "shown"),
    [
        ({}, ["deflection relative to the gear bodies"]),
        ({"reference": "bore"}, ["deflection relative to the bores"]),
        ({"model": "ishikawa"}, []),
    ],
)
def test_a_study_names_the_reference_of_its_deflections(tmp_path, section, shown):
    plan = replace(some_study(tmp_path).plan, scene={"stiffness": section})
    assert [fact.text for fact in reference_facts(plan)] == shown
    assert reference_facts(replace(plan, outputs=("contact_ratio",))) == []
    assert reference_facts(replace(plan, keys=("stiffness.reference",))) == []


def test_every_function_is_tried_here_or_among_the_records():
    tried = {draw.__name__ for draw in OF_A_RUN} | OF_OTHERS | {"film_families"} | test_pictures.DRAWN
    assert tried == set(figures.__all__)


def test_products_draw_every_picture_of_the_run(made):
    drawn_here = {draw.__name__ for draw in OF_A_RUN}
    assert test_pictures.of_products(made.results) == drawn_here & test_pictures.OF_PRODUCTS


SEEN_AT_ONCE = {
    "diagram", "film_along_path", "flanks", "fourier", "mesh_stiffness", "optimum", "optimum_map", "over_torque",
    "resonance", "revolution", "root_stress", "study", "tooth_stress", "verification",
}  # fmt: skip
"""First pictures of sections, which are drawn for a phone as well."""


def drawn(made: Made):
    """Every figure by name, ready to be measured."""
    with narrow():
        for draw in OF_A_RUN:
            if draw.__name__ in SEEN_AT_ONCE:
                yield f"{draw.__name__} for a phone", draw(made.results)
        for name in SEEN_AT_ONCE & made.others.keys():
            yield f"{name} for a phone", getattr(figures, name)(made.others[name])
    for draw in OF_A_RUN:
        yield draw.__name__, draw(made.results)
    for name, data in made.others.items():
        yield name, getattr(figures, name)(data)
    yield "film_families", figures.film_families({"one": made.results, "the same": made.results})


def test_axes_tell_units_legends_cover_no_data_and_nothing_is_cut_off(made):
    faults = {}
    for name, figure in drawn(made):
        assert figure.get_figwidth() == PHONE or "phone" not in name, name
        faults[name] = faults_of(figure)
    assert {name: found for name, found in faults.items() if found} == {}


def test_curves_are_those_of_the_file(made):
    results = made.results
    line = figures.mesh_stiffness(results).axes[0].lines[0]
    secant = results.lubricated_dense_secant_stiffness.values / 0.040 * 1e-9
    assert np.allclose(line.get_ydata(), np.tile(secant, 2), rtol=1e-12)
    series = figures.fourier(results).axes[0].lines[1].get_ydata()
    moving = results.fourier_samples.values / 0.040 * 1e-9
    assert np.mean(series[:200]) == pytest.approx(moving.mean(), rel=1e-3)
    assert str(results.fourier_reference.values) == "body"
    assert str(results.lubricated_reference.values) == "body"  # one value for motion and head
    assert moving.mean() == pytest.approx(
        float(results.lubricated_mean_secant_stiffness) / 0.040 * 1e-9, rel=1e-4
    )
    film = figures.film_along_path(results).axes[0].lines[1]
    assert film.get_ydata().min() == pytest.approx(1e6 * float(results.film_minimum_thickness.min()))
    travel = film.get_xdata()
    assert travel[0] == pytest.approx(1e3 * float(results.film_rho1[0] - results.path_point_rho1[0]))


def test_motion_is_in_micrometres_and_newtons(made):
    results = made.results
    length, force = (float(results[f"oscillator_{name}"]) for name in ("length_scale", "force"))
    up = figures.sweep(results).axes[0].lines[0].get_ydata()
    assert np.allclose(up, 1e6 * length * results.sweep_up.values[:, :, 0].ravel(), rtol=1e-12)
    panels = figures.resonance(results).axes
    for axes, name, unit in zip(
        panels, ("force_factor", "separated", "spread"), (force, 100.0, 1e6 * length), strict=True
    ):
        assert np.allclose(axes.lines[0].get_ydata(), unit * results[f"sweep_{name}_up"].values, rtol=1e-12)
    assert [axes.get_ylabel().split("[")[1] for axes in panels] == ["N]", "%]", "µm]"]


def test_points_that_lie_close_together_do_not_overprint(made):
    places = made.results.path_point_rho1.values.copy()
    places[1] = places[2] - 1e-5
    drawn = figures.load_share(made.results.assign(path_point_rho1=(("path_point",), places)))
    renderer = FigureCanvasAgg(drawn).get_renderer()
    drawn.draw(renderer)
    names = [text.get_window_extent(renderer) for text in drawn.axes[0].texts]
    assert len(names) == 5
    assert not any(one.overlaps(other) for one, other in itertools.combinations(names, 2))


def test_films_are_shown_at_five_points_with_the_hertz_pressure_and_of_rough_flanks_apart(made):
    smooth = figures.film_profiles(made.results)
    named = ["near A", "after B", "C", "before D", "near E", "thin: Hertz pressure, dry"]
    assert [text.get_text() for text in smooth.legends[0].get_texts()] == named
    dry = float(made.results.film_profile_C_hertz_pressure)
    assert any(line.get_ydata().max() == pytest.approx(1e-9 * dry) for line in smooth.axes[0].lines[:-1])
    rough = {}
    for name in (f"film_profile_{point}" for point in ("near_A", "after_B", "C", "before_D", "near_E")):
        film = made.results[f"{name}_pressure"]
        rough[f"{name}_total_pressure"] = (1.25 * film).assign_attrs(film.attrs)
    total, part, _ = figures.film_profiles(made.results.assign(rough)).axes
    assert total.lines[0].get_ydata() == pytest.approx(1.25 * part.lines[0].get_ydata())


def test_every_card_has_its_error_and_no_key_of_a_file(made):
    for name, page in made.pages.items():
        text = page.read_text(encoding="utf-8")
        cards = re.findall(r'<dl class="card"><dt>(.*?)</dt>(.*?)</dl>', text)
        assert cards, name
        for title, rest in cards:
            assert "_" not in title, name
            assert "." not in title, name
            assert 'class="note"' in rest, f"{name}: {title}"
        if name == "run":
            silent = [title for title, rest in cards if not re.search("±|error|as given|exact|none", rest)]
            assert silent == []


@pytest.mark.slow
def test_a_figure_of_the_report_is_drawn_again_from_the_file(made):
    page = made.pages["run"].read_text(encoding="utf-8")
    for name in re.findall(r"flankfilm\.figures\.(\w+)", page):
        assert to_svg(getattr(figures, name)(made.results), name) in page


def test_a_style_of_one_s_own_goes_first_and_leaves_no_trace(made):
    import matplotlib as mpl

    before = dict(mpl.rcParams)
    own = figures.mesh_stiffness(
        made.results,
        style={
            "figure.figsize": (3.4, 2.2),
            "axes.prop_cycle": mpl.cycler(color=["#ff0000"]),
            "font.size": 6.0,
        },
    )
    assert tuple(own.get_size_inches()) == (3.4, 2.2)
    assert {line.get_color() for line in own.axes[0].lines} == {"#ff0000"}
    assert own.axes[0].xaxis.label.get_size() == 6.0
    assert dict(mpl.rcParams) == before


@pytest.mark.parametrize("draw", OF_A_RUN, ids=lambda draw: draw.__name__)
def test_results_that_lack_something_are_refused_with_a_remedy(draw):
    empty = xr.Dataset(attrs={"title": "A motion"})
    with pytest.raises(ValueError, match=r"A motion: no .* to draw; run a scene "):
        draw(empty)


def test_every_function_says_what_it_takes():
    for name in figures.__all__:
        text = inspect.getdoc(getattr(figures, name)) or ""
        assert "Parameters" in text, name


def test_every_text_of_the_pages_belongs_to_something():
    report = Path(figures.__file__).parents[1] / "report"
    prose = tomllib.loads((report / "prose.toml").read_text(encoding="utf-8"))
    assert prose["captions"].keys() <= set(figures.__all__)
    code = "".join(source.read_text(encoding="utf-8") for source in report.parent.rglob("*.py"))
    assert [name for kind in prose.values() for name in kind if f'"{name}"' not in code] == []


def test_pages_are_small(made):
    for name, page in made.pages.items():
        assert page.stat().st_size < 5e6, name


def test_the_snippets_of_the_page_about_reports_run(made, tmp_path, monkeypatch):
    page = Path(__file__).parents[2] / "docs" / "howto" / "report.md"
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "article").symlink_to(made.pages["run"].parent)
    monkeypatch.chdir(tmp_path)
    for code in re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
        exec(compile(code, str(page), "exec"), {})
    assert (tmp_path / "mesh.pdf").read_bytes().startswith(b"%PDF")
    assert "<svg" in (tmp_path / "mesh_one_column.svg").read_text(encoding="utf-8")


def test_the_page_about_reports_names_every_function():
    page = (Path(__file__).parents[2] / "docs" / "howto" / "report.md").read_text(encoding="utf-8")
    assert [name for name in figures.__all__ if f"`{name}`" not in page] == []


EVERY_TEXT = Path(__file__).with_name("page_checks.js").read_text(encoding="utf-8")


@pytest.mark.parametrize(("width", "dark"), [(360, False), (400, True), (1200, False), (1200, True)])
def test_pages_in_a_browser(made, browser, width, dark):
    for name, page in made.pages.items():
        browser.open(page, width, dark=dark)
        found = SimpleNamespace(**browser.run(EVERY_TEXT))
        assert browser.logged == [], name
        assert found.broken == [], f"{name}: images that do not decode"
        assert found.doubled == [], f"{name}: ids that are not unique"
        assert found.astray == [], f"{name}: links and clip paths that lead nowhere"
        assert (found.wide, found.screen) == ([], width), f"{name}: wider than the screen"
        assert found.faint == [], f"{name}: text of too little contrast"
        assert found.tiny == [], f"{name}: text too small to read"
        assert found.figures > 0, name
        assert found.sideways == [], f"{name}: pictures seen at once that scroll sideways"
        assert width < 1200 or found.cut == [], f"{name}: tables that the screen cuts"
        assert found.paper < 0.2 if dark else found.paper > 0.8, f"{name}: the scheme is not followed"


FIRST_SCREEN = """({
  drawing: document.querySelector("figure").getBoundingClientRect().bottom,
  cards: [...document.querySelector(".cards").children].map(one => one.getBoundingClientRect().bottom),
  names: [...document.querySelectorAll("figure svg")].find(one => one.checkVisibility()).outerHTML.slice(0, 4000),
})"""
"""Bottom edges of the drawing and of the figures of a page's head, and the first picture."""


def test_the_first_screen_holds_the_drawing_and_eight_figures(made, browser):
    browser.open(made.pages["run"], 1200, height=800)
    found = SimpleNamespace(**browser.run(FIRST_SCREEN))
    assert "gears_in_mesh-" in found.names
    assert found.drawing <= 800
    assert len(found.cards) == 8
    assert max(found.cards) <= 800


def test_cards_show_the_value_with_all_its_uncertainty_and_a_mark_where_the_tolerance_is_missed():
    one = Headline("power", "827.6", "by films", "W", Uncertainty(0.018, 0.21))
    page = render(Head("A page", [], [one.against(0.01), one.against(0.02)]), [])
    first, second = re.findall(r'<dl class="card">.*?</dl>', page)
    for card in (first, second):
        assert "827.6 <small>W</small> <small>± 23 %</small>" in card
        assert "numerical 1.8 %, model 21 %; by films" in card.replace("\u00a0", " ")
    assert "<strong>! above the tolerance of 1 %</strong>" in first.replace("\u00a0", " ")
    assert "tolerance" not in second


def test_warnings_that_differ_in_one_number_are_one_with_its_range():
    pressures = [
        f"Hertz pressure {one} GPa: above about 1 GPa an extrapolation" for one in ("1.73", "0.9", "1.54")
    ]
    assert merged(pressures) == "Hertz pressure 0.9 to 1.73 GPa: above about 1 GPa an extrapolation"
    assert merged(["depth 2.2 < 4", "depth 2.1 < 3"]) is None
    assert merged(["no number"]) == "no number"


def test_print_is_dark_on_light_and_fits_paper(made, browser):
    browser.open(made.pages["run"], 720, dark=True, media="print")
    assert browser.run("document.documentElement.scrollWidth") <= 720
    ink = browser.run("getComputedStyle(document.body).color")
    assert max(map(int, re.findall(r"\d+", ink)[:3])) < 80
    assert browser.run("getComputedStyle(document.querySelector('nav')).display") == "none"


def test_the_dynamic_factor_at_the_operating_speed_is_seen_at_once(made):
    seen, _, folded = made.pages["run"].read_text(encoding="utf-8").partition('<details class="more">')
    assert "more figures" in folded  # there are more than are seen
    assert "dynamic factor at the operating speed" in seen


UNCUT = """[...document.querySelectorAll("figure")].filter(one =>
  getComputedStyle(one).breakInside !== "avoid" || one.getBoundingClientRect().height > 267 / 25.4 * 96).length"""
"""Pictures of the page as it is printed that a page of A4 would cut."""

UNFOLDED = """document.querySelector("details") && [...document.querySelectorAll("details")].every(one => !one.open
  && getComputedStyle(one, "::details-content").contentVisibility === "visible")"""


def test_pages_print_on_a4_with_whole_pictures_and_what_is_folded(made, browser):
    for name, page in made.pages.items():
        browser.open(page, 688, dark=False, media="print")  # 182 mm
        assert browser.run("document.documentElement.scrollWidth") <= 688, f"{name}: a table is cut"
        assert browser.run(UNCUT) == 0, name
        assert browser.run(UNFOLDED), name
        paper = base64.b64decode(browser.call("Page.printToPDF", preferCSSPageSize=True)["data"])
        sizes = re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", paper)
        assert sizes, name
        for width, height in sizes:
            assert (float(width), float(height)) == pytest.approx((210 / 25.4 * 72, 297 / 25.4 * 72), abs=1.0)
