"""An optimum as a table, a scene that can be run, and a figure."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from flankfilm.dataset import write_csv, write_text
from flankfilm.optimise.run import Optimum
from flankfilm.study.outputs import OUTPUTS


def summary(found: Optimum) -> list[str]:
    """Lines for the terminal."""
    task = found.task
    told = [
        f"{len(found.evaluations)} points, {found.computed} of them computed in {found.seconds:.1f} s, at tolerances "
        f"{task.tolerances[0]:g} and then {task.tolerances[1]:g}"
    ]
    if (both := phases(found)) is not None:
        coarse, fine, saved = both
        told.append(
            f"a point took {coarse:.3g} s at the first tolerance and {fine:.3g} s at the second: {100 * saved:.0f} % "
            "less in all than with every point at the second"
        )
    if len(found.best) > 1:
        told.append(f"{len(found.best)} points on the front, from the least {task.objectives[0]}:")
    for place in found.best[:10]:
        point = found.evaluations[place]
        keys = ", ".join(f"{k} = {v:.6g}" for k, v in zip(task.keys, point.values, strict=True))
        outputs = ", ".join(f"{n} = {v:.5g}" for n, v in zip(task.outputs, point.result.values, strict=True))
        told.append(f"{keys}: {outputs}")
    if len(found.best) > 10:
        told.append(f"{len(found.best) - 10} more in optimum.csv")
    return told


def phases(found: Optimum) -> tuple[float, float, float] | None:
    """Mean cost of a point in either phase [s], and the part that the first one saved; None without both.

    Points that failed are left out: what ends early says nothing of tolerances.
    """
    coarse, fine = found.task.tolerances
    seconds = {
        tolerance: [
            e.result.seconds for e in found.evaluations if e.tolerance == tolerance and not e.result.fault
        ]
        for tolerance in (coarse, fine)
    }
    if not seconds[coarse] or not seconds[fine]:
        return None
    first, second = (float(np.mean(seconds[tolerance])) for tolerance in (coarse, fine))
    spent = sum(seconds[coarse]) + sum(seconds[fine])
    whole = second * (len(seconds[coarse]) + len(seconds[fine]))
    return first, second, 1.0 - spent / whole


def write_optimum(found: Optimum, folder: Path) -> list[Path]:
    """Write ``optimum.csv`` (all points of the front), ``optimum.toml`` (the first one's scene) and the figure."""
    from flankfilm.figures.optimum import optimum
    from flankfilm.figures.style import save

    task = found.task
    chosen = [found.evaluations[place] for place in found.best]
    table, scene, picture = (folder / f"optimum.{suffix}" for suffix in ("csv", "toml", "svg"))
    write_csv(
        table,
        {key: [point.values[i] for point in chosen] for i, key in enumerate(task.keys)}
        | {name: [point.result.values[i] for point in chosen] for i, name in enumerate(task.outputs)},
    )
    raw = task.raw_scene(chosen[0].values, task.tolerances[1])
    write_text(scene, "\n".join(toml(raw)) + "\n")
    units = {name: OUTPUTS[name].unit for name in task.objectives}
    fine = np.array([e.tolerance == task.tolerances[1] for e in found.evaluations])
    save(optimum(found.objectives(), found.best, fine, units), picture)
    return [table, scene, picture]


def toml(raw: Mapping[str, Any], section: str = "") -> Iterator[str]:
    """Lines of TOML for the keys of a scene: sections, with tables inside them inline."""
    plain = {k: v for k, v in raw.items() if section or not isinstance(v, Mapping)}
    for key, value in plain.items():
        yield f"{key} = {_toml(value)}"
    for key, value in raw.items():
        if key not in plain:
            yield ""
            yield f"[{key}]"
            yield from toml(value, key)


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        import json

        return json.dumps(value, ensure_ascii=True)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{k} = {_toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    return repr(value)
