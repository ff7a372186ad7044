"""What the coarse phase of an optimisation saves: root stress against least film over profile shifts, at 0.1 %.

Evaluations and seconds of either phase, and the part of the time that is saved against every point at the scene's
tolerance. One process, nothing from the cache. Run with ``python benchmarks/optimise_phases.py [evaluations]``.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

TASK = """
scene = "{scene}"
minimise = ["root_tension_pinion_MPa"]
maximise = ["least_film_um"]
evaluations = {evaluations}
population = 8
[vary]
"pair.pinion.profile_shift" = {{ from = -0.3, to = 0.6 }}
"pair.wheel.profile_shift" = {{ from = -0.5, to = 0.3 }}
[set]
"tolerance" = 0.001
[limits]
"contact_ratio" = {{ at_least = 1.5 }}
"specific_sliding" = {{ at_most = 4.0 }}
"""


def main(evaluations: int) -> None:
    from flankfilm.cache import keep_compiled_code
    from flankfilm.optimise.files import summary
    from flankfilm.optimise.run import optimise
    from flankfilm.optimise.task import read_task

    keep_compiled_code()
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "task.toml"
        scene = (Path(__file__).parents[1] / "examples" / "article.toml").as_posix()
        path.write_text(TASK.format(scene=scene, evaluations=evaluations), encoding="utf-8")
        task = read_task(path)
        found = optimise(task, Path(name) / "out", workers=1, use_cache=False)
        for tolerance in task.tolerances:
            count = sum(point.tolerance == tolerance for point in found.evaluations)
            print(f"{count} points at {tolerance:g}")
        print("\n".join(summary(found)))


if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 24)
