"""Cost of what surrounds the solvers: the rows of a study and the report of a run."""

from __future__ import annotations

import os
import subprocess
import tempfile
from functools import partial
from pathlib import Path

from flankfilm.bench.case import Levels, case, work
from flankfilm.processes.worker_processes import module, python

STUDY = """
title = "Geometry"
scene = "scene.toml"
outputs = ["contact_ratio", "mean_secant_stiffness_N_per_mm_um", "transmission_error_um"]
design = "sobol"
samples = {rows}
[vary]
"pair.pinion.profile_shift" = {{ from = -0.2, to = 0.5 }}
"pair.wheel.profile_shift" = {{ from = -0.2, to = 0.4 }}
"pair.pinion.bore_mm" = {{ from = 20.0, to = 50.0 }}
[set]
"film.model" = "none"
"""


@case("Studies and reports", "rows")
def work_application(quick: bool) -> Levels:
    """Rows computed here and by the command on two processes; the report of the scene that they vary.

    Rows of a study of profile shifts and a bore, without film and cache: one after the other in this process, and by
    the command on two processes, whose wall time alone counts (what it needs beside the rows is in that of two rows);
    the page of a run.
    """
    from flankfilm.runs.report import write_report
    from flankfilm.runs.run_scene import run_scene
    from flankfilm.scene import read_scene, template
    from flankfilm.scene.wants import WANTS
    from flankfilm.studies.plan import read_plan
    from flankfilm.studies.row import Row, compute_row

    folder = tempfile.TemporaryDirectory(prefix="flankfilm-bench-")
    place = Path(folder.name)
    (place / "scene.toml").write_text(template(), encoding="utf-8")
    counts = (2, 8) if quick else (2, 32)
    for rows in counts:
        (place / f"study{rows}.toml").write_text(STUDY.format(rows=rows), encoding="utf-8")
    plan = read_plan(place / f"study{counts[-1]}.toml")
    tasks = [Row(i, plan.raw_scene(i), plan.outputs, use_cache=False) for i in range(counts[-1])]
    scene = read_scene(place / "scene.toml")
    wanted = tuple(want for want in scene.wants if not WANTS[want].file)
    results = run_scene(scene.model_copy(update={"wants": wanted}), place / "run")

    def study(rows: int) -> None:
        with tempfile.TemporaryDirectory(dir=place) as out:
            command = python(*module("flankfilm", "study", f"study{rows}.toml", "--out", out))
            options = ["--workers", "2", "--no-cache"]
            one_thread = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
            subprocess.run(
                [*command, *options, "--resume"], check=True, capture_output=True, cwd=place, env=one_thread
            )

    def rows_here() -> object:
        # the folder lives as long as what is measured in it
        return folder, [compute_row(task) for task in tasks]

    return Levels(
        (
            work("rows in this process", rows_here, counts[-1]),
            *(work(f"study of {rows} rows", partial(study, rows), rows) for rows in counts),
            work("report of a run", lambda: write_report(results, place / "run")),
        )
    )
