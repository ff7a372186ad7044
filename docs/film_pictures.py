"""Draws the films of examples/studies/film_*.toml and examples/starved.toml: python docs/film_pictures.py."""

from __future__ import annotations

from runs import EXAMPLES, example, results, save

from base import SolverError
from flankfilm import figures
from flankfilm.scene.reader import validated
from flankfilm.studies.plan import read_plan


def main() -> None:
    """Write docs/images/film_*.png."""
    for path in sorted((EXAMPLES / "studies").glob("film_*.toml")):
        plan = read_plan(path)
        key = plan.keys[0].rpartition(".")[2]
        try:
            family = {
                f"{key} = {row[0]:g}": results(validated(plan.raw_scene(i)), ("pair", "film"))
                for i, row in enumerate(plan.rows)
            }
        except SolverError as fault:
            print(f"{path.stem}.png is left as it is: {fault}")
            continue
        save({path.stem: figures.film_families(family)})
    save({"film_held": figures.film_changes(example("starved"))})


if __name__ == "__main__":
    main()
