"""Draws the films of examples/studies/film_*.toml and examples/starved.toml: python docs/film_pictures.py."""

from __future__ import annotations

import warnings
from pathlib import Path

from flankfilm.cache import Cache, keep_compiled_code, user_cache
from flankfilm.figures import film as film_figures
from flankfilm.figures.style import styled
from flankfilm.report.film_parts import starved_cycles
from flankfilm.scene import Scene, read_scene
from flankfilm.scene.reader import validated
from flankfilm.stages.catalogue import STAGES
from flankfilm.stages.engine import Engine
from flankfilm.study.plan import read_plan

HERE = Path(__file__).parent
EXAMPLES = HERE.parent / "examples"


def engine(scene: Scene) -> Engine:
    """Give an engine that shares results with other runs."""
    return Engine(scene, STAGES, Cache(user_cache() / "results"))


def main() -> None:
    """Write docs/images/film_*.png."""
    keep_compiled_code()
    warnings.simplefilter("ignore")  # a scene's own run shows them
    drawn = {}
    for path in sorted((EXAMPLES / "studies").glob("film_*.toml")):
        plan = read_plan(path)
        key = plan.keys[0].rpartition(".")[2]
        rows = {
            f"{key} = {row[0]:g}": engine(validated(plan.raw_scene(i))) for i, row in enumerate(plan.rows)
        }
        films = {label: row["film"] for label, row in rows.items()}
        start = next(iter(rows.values()))["pair"].points.A
        drawn[path.stem] = film_figures.families(films, start)
    starved = engine(read_scene(EXAMPLES / "starved.toml"))
    drawn["film_held"] = film_figures.stiffness_changes(starved_cycles(starved["film"]), starved["dry cycle"])
    (HERE / "images").mkdir(exist_ok=True)
    with styled():
        for name, figure in drawn.items():
            figure.savefig(HERE / "images" / f"{name}.png", dpi=110)


if __name__ == "__main__":
    main()
