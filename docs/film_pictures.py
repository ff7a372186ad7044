"""Draws the films of examples/studies/film_*.toml and examples/starved.toml: python docs/film_pictures.py."""

from __future__ import annotations

from runs import EXAMPLES, example, results, save

from base import SolverError
from flankfilm import figures
from flankfilm.figures.reading import key_words
from flankfilm.scene.reader import validated
from flankfilm.stages.mesh import FILM, PAIR
from flankfilm.studies.plan import read_plan


def main() -> None:
    """Write docs/images/film_*.png."""
    for path in sorted((EXAMPLES / "studies").glob("film_*.toml")):
        plan = read_plan(path)
        name, unit = key_words(plan.keys[0])
        try:
            family = {
                f"{name} {row[0]:g} {unit}": results(validated(plan.raw_scene(i)), (PAIR, FILM))
                for i, row in enumerate(plan.rows)
            }
        except SolverError as fault:
            print(f"{path.stem}.png is left as it is: {fault}")
            continue
        save({path.stem: figures.film_families(family)})
    save({"film_held": figures.film_changes(example("starved"))})


if __name__ == "__main__":
    main()
