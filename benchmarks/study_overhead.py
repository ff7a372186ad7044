"""Overhead of a study on two processes over the work of its rows, and how long a thousand rows take.

The same rows of a geometry study (profile shifts and bores, tolerance 0.5 %, no film) are computed one after the other
in one process, then by the command ``flankfilm study`` with two processes, from nothing each time. The work is the CPU
time of the former, without its imports; all that the command and its processes use beyond it is overhead: starting
Python, importing, handing over, writing rows, the dataset and the figure. A study of two rows tells what does not grow
with the rows. Run with ``python benchmarks/study_overhead.py [rows] [film]``.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

STUDY = """
title = "Geometry"
scene = "{scene}"
outputs = ["mean_secant_N_per_mm_um", "transmission_error_um", "specific_sliding"]
design = "sobol"
samples = {rows}
[vary]
"pair.pinion.profile_shift" = {{ from = -0.2, to = 0.5 }}
"pair.wheel.profile_shift" = {{ from = -0.2, to = 0.4 }}
"pair.pinion.bore_mm" = {{ from = 20.0, to = 50.0 }}
[set]
"film.model" = "{film}"
"""
ONE_THREAD = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")


def study_file(folder: Path, rows: int, film: str) -> Path:
    """Write the study."""
    path = folder / f"study{rows}.toml"
    scene = (Path(__file__).parents[1] / "examples" / "article.toml").as_posix()
    path.write_text(STUDY.format(scene=scene, rows=rows, film=film), encoding="utf-8")
    return path


def work(path: Path) -> list[float]:
    """CPU seconds of every row in this process, the first one computed once before."""
    from flankfilm.study.plan import read_plan
    from flankfilm.study.row import Row, compute_row

    plan = read_plan(path)
    rows = [Row(i, plan.raw_scene(i), plan.outputs, False) for i in range(len(plan.rows))]
    compute_row(rows[0])
    seconds = []
    for row in rows:
        began = time.process_time()
        if fault := compute_row(row).fault:
            print(f"row {row.index}: {fault}")
        seconds.append(time.process_time() - began)
    return seconds


def used(path: Path, out: Path) -> tuple[float, float]:
    """CPU seconds of the command with all its processes, and wall seconds."""
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = [
        sys.executable,
        "-m",
        "flankfilm",
        "study",
        str(path),
        "--out",
        str(out),
        "--workers",
        "2",
        "--no-cache",
    ]
    subprocess.run(command, check=True, capture_output=True, env={**os.environ, **ONE_THREAD})
    wall, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall


def main(rows: int, film: str) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        many, few = study_file(folder, rows, film), study_file(folder, 2, film)
        used(few, folder / "warm")
        each = work(many)
        whole, wall = used(many, folder / "many")
        fixed = min(used(few, folder / f"few{i}")[0] for i in range(2)) - 2 * sum(each) / rows
        mean = sum(each) / rows
        per_row = (whole - fixed) / rows - mean
        print(
            f"{rows} rows, film {film}: work {sum(each):.1f} s of CPU ({mean:.3f} s a row), the study {whole:.1f} s"
        )
        print(
            f"overhead {100 * (whole / sum(each) - 1):+.1f} %; fixed {fixed:.2f} s, {1e3 * per_row:+.0f} ms a row"
        )
        print(
            f"wall {wall:.0f} s with the machine as busy as it was; on two free cores {whole / 2:.0f} s at the least"
        )
        thousand = fixed + 1000 * (mean + per_row)
        print(
            f"a thousand rows: {thousand:.0f} s of CPU, {thousand / 120:.1f} min on two cores that are free"
        )
        print(f"overhead of a thousand rows: {100 * (thousand / (1000 * mean) - 1):+.1f} %")


if __name__ == "__main__":
    os.environ.update(ONE_THREAD)
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100, sys.argv[2] if len(sys.argv) > 2 else "none")
