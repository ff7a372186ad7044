"""How long the report of a run takes, and how large it is: python benchmarks/report_time.py [SCENE].

Results come from the cache or are computed first; the least of five pages counts, and the first one apart, which loads
matplotlib and its fonts.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

from flankfilm.cache import keep_compiled_code

EXAMPLE = Path(__file__).parents[1] / "examples" / "article.toml"


def main() -> None:
    keep_compiled_code()
    from flankfilm.run import run_scene
    from flankfilm.scene import read_scene

    scene = read_scene(Path(sys.argv[1]) if len(sys.argv) > 1 else EXAMPLE)
    bare = scene.model_copy(update={"wants": tuple(w for w in scene.wants if w not in ("report", "vtk"))})
    with tempfile.TemporaryDirectory() as place:
        results = run_scene(bare, Path(place) / "run")
        from flankfilm.report.contents import write_report

        spent = []
        for _ in range(6):
            start = time.process_time()
            page = write_report(results)
            spent.append(time.process_time() - start)
        size = page.stat().st_size
    print(
        f"{scene.title}: first {spent[0]:.2f} s, then {min(spent[1:]):.2f} s of one core, {size / 1e6:.2f} MB"
    )


if __name__ == "__main__":
    main()
