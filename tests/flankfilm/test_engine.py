"""Stages run once, only when asked for, and come from the cache when nothing they depend on changed."""

from __future__ import annotations

import time
import warnings
from importlib import import_module
from pkgutil import iter_modules
from typing import get_args

import numpy as np
import pytest

from flankfilm import products, stages
from flankfilm.coupling.films.film_law import FilmLaw
from flankfilm.files.cache import Cache
from flankfilm.products.catalogue import PRODUCTS, goals
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import Scene, parse_scene, template
from flankfilm.scene.schema import Want
from flankfilm.stages.engine import Engine, KeptPart, Stage, StageRun
from flankfilm.stages.mesh import FILM
from tests.flankfilm.scenes import CLOSED_FORMS_WITH_FILM


def scene(changes: dict[str, str] | None = None):
    text = template()
    for old, new in (changes or {}).items():
        assert old in text
        text = text.replace(old, new, 1)
    return parse_scene(text)


def counting(calls: list[str]) -> Stage[str]:
    """A stage that stands on another; both note that they were computed."""

    def of(name: str, section: str, *needs: Stage[str]) -> Stage[str]:
        def compute(run: Engine) -> str:
            calls.append(name)
            return "+".join([name, *(run[need] for need in needs)])

        def inputs(scene: Scene) -> dict[str, object]:
            return {section: getattr(scene, section).model_dump()}

        return Stage(name, name, compute, inputs, needs, ("gears",))

    return of("oil", "lubricant", of("teeth", "pair"))


def test_a_stage_runs_once(tmp_path):
    calls: list[str] = []
    oil = counting(calls)
    engine = Engine(scene(), Cache(None))
    assert engine[oil] == engine[oil] == "oil+teeth"
    assert calls == ["oil", "teeth"]


def test_a_change_of_lubricant_meshes_nothing_again(tmp_path):
    calls: list[str] = []
    oil = counting(calls)
    Engine(scene(), Cache(tmp_path))[oil]
    calls.clear()
    thicker = scene({"viscosity_Pa_s = 0.075": "viscosity_Pa_s = 0.08"})
    Engine(thicker, Cache(tmp_path))[oil]
    assert calls == ["oil"]


@pytest.mark.parametrize(
    "change",
    [
        {'supply = "flooded"': 'supply = "oil-layer"\noil_layer_um = 0.1'},
        {'supply = "flooded"': 'supply = "meniscus"\nmeniscus_half_widths = 1.5'},
        {'stiffness = "approach"': 'stiffness = "tangent"'},
        {'# grid = "graded"': 'grid = "article"'},
    ],
)
def test_a_change_of_the_films_keys_computes_the_film_again(change):
    before, after = (Engine(scene(c), Cache(None)).inputs(FILM) for c in ({}, change))
    assert before != after


def test_a_kept_result_needs_nothing_below_it(tmp_path):
    calls: list[str] = []
    oil = counting(calls)
    Engine(scene(), Cache(tmp_path))[oil]
    calls.clear()
    again = Engine(scene(), Cache(tmp_path))
    assert again[oil] == "oil+teeth"
    assert calls == []
    assert again.runs["oil"].cached


def test_time_of_a_stage_excludes_those_it_asks_for():
    def teeth(run: Engine) -> str:
        time.sleep(0.2)
        return "teeth"

    below = Stage("teeth", "teeth", teeth, lambda scene: {})
    oil = Stage("oil", "oil", lambda run: "oil+" + run[below], lambda scene: {}, (below,))
    engine, began = Engine(scene(), Cache(None)), time.perf_counter()
    engine[oil]
    whole = time.perf_counter() - began
    # a stage that counted the other's time as well would make the sum 0.2 s longer than all took
    assert engine.runs["teeth"].seconds >= 0.2
    assert 0 <= engine.runs["oil"].seconds <= whole - engine.runs["teeth"].seconds


def test_warnings_are_gathered_once_each():
    def warn(engine: Engine) -> int:
        for pressure in (1.1, 1.2):
            warnings.warn(f"Hertz pressure {pressure} GPa: above about 1 GPa", UserWarning, stacklevel=2)
        return 1

    stage = Stage("warns", "warns", warn, lambda s: {})
    engine = Engine(scene(), Cache(None))
    engine[stage]
    assert len(engine.runs["warns"].warnings) == 1


def stages_of(*packages):
    """Stages that the modules of packages declare."""
    names = [f"{p.__name__}.{module.name}" for p in packages for module in iter_modules(p.__path__)]
    modules = map(import_module, names)
    return {thing for module in modules for thing in vars(module).values() if isinstance(thing, Stage)}


def test_each_stage_has_a_name_of_its_own():
    declared = stages_of(stages, products)
    assert len({stage.name for stage in declared}) == len(declared)
    assert all(set(stage.needs) <= declared for stage in declared)


def test_every_want_and_every_stage_that_is_shown_belongs_to_one_product():
    shown = [*(stage for product in PRODUCTS for stage in set(product.solved.values()))]
    assert len(shown) == len(set(shown))
    prefixes = [prefix for product in PRODUCTS for prefix in product.solved]
    assert len(prefixes) == len(set(prefixes))
    assert {"report"} == {*get_args(Want)} - {product.name for product in PRODUCTS}
    files = [file for product in PRODUCTS for file in product.tables]
    assert len(files) == len(set(files))


@pytest.mark.parametrize(
    ("wants", "asked"),
    [
        ('["geometry"]', {"pair"}),
        ('["stiffness"]', {"dry cycle", "references", "plan", "mesh"}),
        ('["sweep"]', {"fourier", "scaling", "sweep"}),
    ],
)
def test_only_what_is_wanted_is_asked_for(wants: str, asked: set[str]):
    text = '["stiffness", "film", "sweep", "vtk", "report"]'
    assert {stage.name for stage in goals(scene({text: wants}))} == asked


def test_the_film_law_meets_value_and_slope_and_stays_positive():
    law = FilmLaw(
        np.array([1e-3, 3e-3]), np.array([1000.0, 500.0]), np.array([4e-7, 6e-7]), np.array([0.13, 0.1])
    )
    at_films = np.array([[1e-3, 3e-3, np.nan]])
    separation, slope = law(at_films, np.array([[1000.0, 500.0, 70.0]]))
    assert separation[0] == pytest.approx([4e-7, 6e-7, 0.0], rel=1e-12)
    assert slope[0] == pytest.approx([-0.13 * 4e-7 / 1000.0, -0.1 * 6e-7 / 500.0, 0.0], rel=1e-12)
    assert law.stiffness(at_films)[0] == pytest.approx([*(-1 / slope[0, :2]), np.inf], rel=1e-12)
    between = np.array([[1.5e-3, 2e-3, 0.0, 9.0]])
    force = np.array([[700.0, 800.0, 300.0, 400.0]])
    apart = (law(between, force + 1e-3)[0] - law(between, force - 1e-3)[0]) / 2e-3
    assert law(between, force)[1] == pytest.approx(apart, rel=1e-6)
    same = np.full((1, 4), 700.0)
    ends = law(at_films[:, :2], same[:, :2])[0][0]
    # beyond the first and the last film the law goes on by half a step and no more
    before, after = 1.5 * ends[0] - 0.5 * ends[1], 1.5 * ends[1] - 0.5 * ends[0]
    weighted = [0.75 * ends[0] + 0.25 * ends[1], 0.5 * ends.sum(), before, after]
    assert law(between, same)[0][0] == pytest.approx(weighted, rel=1e-12)
    assert np.all(np.isfinite(law(between, np.zeros((1, 4)))[0]))


@pytest.mark.slow
def test_films_at_few_positions_change_the_mesh_as_films_at_many(monkeypatch):
    changes = []
    for positions in (40, 120):
        monkeypatch.setattr("flankfilm.coupling.films.films.FILM_POSITIONS", positions)
        given = scene()
        dowson = given.film.model_copy(update={"model": "dowson", "stiffness": "dowson-central"})
        by_formula = given.model_copy(update={"film": dowson})
        film = Engine(by_formula, Cache(None))[FILM]
        changes.append((film.secant_stiffness_change, film.stiffness_change))
    assert np.allclose(*changes, rtol=0.02)


def test_parts_of_a_result_are_kept_for_other_scenes(tmp_path):
    computed = []

    def compute(run: Engine) -> list[str]:
        def part(name: str) -> str:
            made = StageRun(name.upper(), "", 0.0, cached=False)  # any record
            return run.parts("part", {"of": name}, lambda: computed.append(name) or made).name

        return [part(name) for name in run.scene.title.split()]

    stage = Stage("whole", "whole", compute, lambda s: {}, (), ("flankfilm",), by_parts=True)

    started = []

    def run(title: str) -> Engine:
        started.clear()
        engine = Engine(scene().model_copy(update={"title": title}), Cache(tmp_path), started.append)
        assert engine[stage] == title.upper().split()
        return engine

    assert not run("a b").runs["whole"].cached
    assert started == [stage]
    assert not run("b c").runs["whole"].cached
    assert started == [stage]
    assert run("c a").runs["whole"].cached
    assert started == []
    assert computed == ["a", "b", "c"]


@pytest.mark.parametrize("odd", [3, (1.0, ()), ("text", 1), {"a": 1}])
def test_an_entry_of_another_type_is_computed_again(tmp_path, odd):
    """Under the right name and digest, but not what the stage gives, nor what its parts are."""
    calls: list[str] = []
    oil = counting(calls)
    Engine(scene(), Cache(tmp_path))[oil]
    calls.clear()
    for path in list(tmp_path.iterdir()):
        Cache(tmp_path).put(path.name, odd)
    assert Engine(scene(), Cache(tmp_path))[oil] == "oil+teeth"
    assert calls == ["oil", "teeth"]

    record = StageRun("oil", "oil", 0.0, cached=False)
    key = Cache(tmp_path).key("part", {}, ("flankfilm",))
    Cache(tmp_path).put(key, odd)
    part = KeptPart(Cache(tmp_path), ("flankfilm",), lambda: None)
    assert part("part", {}, lambda: record) == record
    assert part("part", {}, lambda: None) == record  # which is kept now
    assert part.hits == [False, True]


def test_the_cost_of_a_run_is_told_by_its_stages():
    found = run_scene(parse_scene(CLOSED_FORMS_WITH_FILM), None, use_cache=False)
    assert found.cost.parts.keys() == found.runs.keys() > {"pair", "dry cycle", "film"}
    # what is between the stages is no stage's
    assert 0.0 < sum(found.cost.parts.values()) <= found.cost.seconds
