"""Studies: design of the rows, what a killed or failing one leaves behind, and what may not be mixed."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from base import InputError
from flankfilm.files.folder import locked
from flankfilm.studies.execution import Execution
from flankfilm.studies.outputs import OUTPUTS
from flankfilm.studies.plan import read_plan
from flankfilm.studies.run import run_study
from flankfilm.studies.table import Columns, append, read_lines
from tests.flankfilm.program import EXAMPLES, SCRIPT, command, flankfilm

GEOMETRY = """
scene = "{scene}"
outputs = ["contact_ratio", "specific_sliding"]
design = "{design}"
{more}
[vary]
{vary}
"""


def study_file(folder, vary, design="grid", more=""):
    path = folder / "study.toml"
    scene = (EXAMPLES / "article.toml").as_posix()
    path.write_text(GEOMETRY.format(scene=scene, design=design, more=more, vary=vary), encoding="utf-8")
    return path


SHIFTS = '"pair.pinion.profile_shift" = { from = -0.2, to = 0.4, steps = 4 }'


def run(*arguments, **more):
    return flankfilm("study", *arguments, **more)


class TestDesign:
    def test_a_grid_takes_every_combination(self, tmp_path):
        plan = read_plan(study_file(tmp_path, SHIFTS + '\n"pair.module_mm" = [1.0, 2.0, 3.0]'))
        assert len(plan.rows) == 12
        assert plan.rows[0] == (-0.2, 1.0)
        assert plan.rows[-1] == (0.4, 3.0)
        assert plan.raw_scene(4)["pair"]["pinion"]["profile_shift"] == 0.0
        assert plan.raw_scene(4)["pair"]["wheel"]["profile_shift"] == 0.0

    def test_a_list_goes_side_by_side(self, tmp_path):
        plan = read_plan(study_file(tmp_path, SHIFTS + '\n"pair.module_mm" = [1.0, 2.0, 3.0, 4.0]', "list"))
        assert plan.rows[2] == (0.2, 3.0)
        with pytest.raises(InputError, match="equally many"):
            read_plan(study_file(tmp_path, SHIFTS + '\n"pair.module_mm" = [1.0, 2.0]', "list"))

    def test_a_key_follows_another(self, tmp_path):
        follow = '\n[follow]\n"pair.wheel.profile_shift" = { of = "pair.pinion.profile_shift", times = -1.0 }'
        plan = read_plan(study_file(tmp_path, SHIFTS + follow))
        assert all(first == -second for first, second in plan.rows)
        assert plan.varied == 1

    @pytest.mark.parametrize("design", ["latin-hypercube", "sobol"])
    def test_samples_fill_the_ranges_evenly(self, tmp_path, design):
        vary = (
            '"pair.pinion.profile_shift" = { from = -0.2, to = 0.4 }\n'
            '"pair.module_mm" = { from = 0.1, to = 10.0, log = true }\n'
            '"pair.pinion.teeth" = { from = 30, to = 60, whole = true }'
        )
        plan = read_plan(study_file(tmp_path, vary, design, "samples = 64\nseed = 5"))
        shift, module, teeth = (np.array(column) for column in zip(*plan.rows, strict=True))
        # one of 64 samples in each 64th of a range (Sobol: net in base 2; Latin hypercube: by construction)
        for unit in ((shift + 0.2) / 0.6, np.log(module / 0.1) / np.log(100)):
            assert len({math.floor(64 * u) for u in unit * (1 - 1e-12)}) >= 63
        assert teeth.dtype == int
        assert teeth.min() >= 30
        assert teeth.max() <= 60
        again = read_plan(study_file(tmp_path, vary, design, "samples = 64\nseed = 5"))
        assert again.rows == plan.rows

    @pytest.mark.parametrize(
        ("vary", "design", "more", "message"),
        [
            ('"pair.pinion.tooth" = [30, 31]', "grid", "", "tooth"),
            ('"pair.module_mm" = [1.0, -1.0]', "grid", "", "row 1: pair.module_mm"),
            ('"pair.module_mm" = { from = 1.0, to = 2.0 }', "grid", "", "steps: is required by a grid"),
            ('"pair.module_mm" = { from = 1.0, to = 2.0 }', "sobol", "", "samples: is required"),
            ('"pair.module_mm" = { from = 2.0, to = 1.0, steps = 3 }', "grid", "", "must lie below"),
            (
                '"pair.module_mm" = { from = 0.0, to = 1.0, steps = 3, log = true }',
                "grid",
                "",
                "more than 0 with log",
            ),
            ('"title.deep" = [1]', "grid", "", "not a section"),
            ("", "grid", "", "needs a key"),
        ],
    )
    def test_faults_name_the_key(self, tmp_path, vary, design, more, message):
        with pytest.raises(InputError, match=message):
            read_plan(study_file(tmp_path, vary, design, more))

    def test_all_unknown_outputs_are_named(self, tmp_path):
        path = study_file(tmp_path, SHIFTS)
        path.write_text(path.read_text().replace('"contact_ratio"', '"colour", "smell"'))
        with pytest.raises(InputError) as found:
            read_plan(path)
        assert len(found.value.faults) == 2


class TestRows:
    def test_rows_are_those_of_single_runs(self, tmp_path):
        from flankfilm.building.pair import gear_pair
        from flankfilm.scene.reader import validated

        plan = read_plan(study_file(tmp_path, SHIFTS))
        found = run_study(plan, tmp_path / "out", Execution(workers=1))
        for row in found.rows:
            pair = gear_pair(validated(plan.raw_scene(row.index)))
            assert row.values[0] == pair.contact_ratio
        kept = pd.read_csv(tmp_path / "out" / "rows.csv")
        assert sorted(kept["row"]) == [0, 1, 2, 3]
        assert set(kept["contact_ratio"]) == {row.values[0] for row in found.rows}

    @pytest.mark.usefixtures("rows_here")
    def test_a_row_that_fails_says_why_and_the_others_go_on(self, tmp_path):
        plan = read_plan(study_file(tmp_path, '"pair.pinion.tip_alteration" = [0.0, 0.9, -0.1]'))
        found = run_study(plan, tmp_path / "out", Execution(workers=1))
        assert [bool(row.fault) for row in found.rows] == [False, True, False]
        assert "pair.pinion.tip_alteration" in found.rows[1].fault
        assert math.isnan(found.rows[1].values[0])
        kept = pd.read_csv(tmp_path / "out" / "rows.csv").set_index("row")
        assert "tip_alteration" in kept.fault[1]

    @pytest.mark.slow
    def test_a_process_that_dies_costs_its_row_alone(self, tmp_path, monkeypatch):
        """A row that ends its process, as the kernel does for want of memory."""
        monkeypatch.setattr("flankfilm.studies.workers.compute_row", die_or_count)
        from flankfilm.studies.row import Row
        from flankfilm.studies.workers import Workers

        rows = [Row(index, {"die": index == 2}, ("contact_ratio",)) for index in range(5)]
        with Workers("processes", 1) as workers:
            results = {result.index: result for result in workers.computed(rows)}
            again = list(workers.computed([Row(7, {"die": False}, ("contact_ratio",))]))
        assert again[0].values == (7.0,)
        assert sorted(results) == [0, 1, 2, 3, 4]
        assert "died" in results[2].fault
        assert [results[i].values[0] for i in (0, 1, 3, 4)] == [0.0, 1.0, 3.0, 4.0]

    @pytest.mark.usefixtures("rows_here")
    def test_a_torn_last_line_is_cut_off_and_its_row_computed_again(self, tmp_path):
        plan = read_plan(study_file(tmp_path, SHIFTS))
        found = run_study(plan, tmp_path / "out", Execution(workers=1))
        path, columns = tmp_path / "out" / "rows.csv", Columns(plan.keys, plan.outputs)
        whole = path.read_bytes()
        for cut in range(1, len(whole.splitlines()[-1]) + 1):
            path.write_bytes(whole[:-cut])
            assert len(read_lines(path, columns)) == 3
            assert path.read_bytes().endswith(b"\n")
        again = run_study(plan, tmp_path / "out", Execution(workers=1, resume=True))
        assert again.computed == 1
        assert [r.values for r in again.rows] == [r.values for r in found.rows]

    def test_values_read_back_to_the_last_digit(self, tmp_path):
        from flankfilm.studies.row import RowResult

        columns = Columns(("pair.module_mm",), ("contact_ratio", "specific_sliding"))
        for index, value in enumerate((math.pi, 1e-300, float("nan"), -0.0)):
            result = RowResult(index, (value, 1 / 3), 0.1, 'a "fault", of two words')
            append(tmp_path / "rows.csv", columns, (2.0,), result)
        found = [line.result for line in read_lines(tmp_path / "rows.csv", columns)]
        assert found[0].values == (math.pi, 1 / 3)
        assert found[1].values[0] == 1e-300
        assert math.isnan(found[2].values[0])
        assert math.copysign(1, found[3].values[0]) == -1
        assert found[0].fault == 'a "fault", of two words'


def die_or_count(row):
    """Stand in for a row's work."""
    from flankfilm.studies.row import RowResult

    if row.scene["die"]:
        os._exit(9)
    return RowResult(row.index, (float(row.index),), 0.0)


@pytest.mark.usefixtures("rows_here")
class TestFolder:
    def test_another_study_is_kept_out(self, tmp_path):
        out = tmp_path / "out"
        run_study(read_plan(study_file(tmp_path, SHIFTS)), out, Execution(workers=1))
        with pytest.raises(InputError, match="--resume"):
            run_study(read_plan(study_file(tmp_path, SHIFTS)), out, Execution(workers=1))
        other = read_plan(study_file(tmp_path, SHIFTS.replace("0.4", "0.5")))
        with pytest.raises(InputError, match="another study"):
            run_study(other, out, Execution(workers=1, resume=True))

    def test_rows_of_other_code_are_not_mixed_in(self, tmp_path, monkeypatch):
        plan = read_plan(study_file(tmp_path, SHIFTS))
        run_study(plan, tmp_path / "out", Execution(workers=1))
        monkeypatch.setattr("flankfilm.studies.kept.code_digest", lambda packages: "other")
        with pytest.raises(InputError, match="other code"):
            run_study(plan, tmp_path / "out", Execution(workers=1, resume=True))

    def test_two_at_once_do_not_share_a_folder(self, tmp_path):
        with locked(tmp_path), pytest.raises(InputError, match="at work"), locked(tmp_path):
            pass

    @pytest.mark.slow
    def test_killed_at_any_moment_it_goes_on_to_the_same_numbers(self, tmp_path):
        vary = '"pair.pinion.profile_shift" = { from = -0.2, to = 0.4, steps = 60 }'
        path = study_file(tmp_path, vary)
        whole = run_study(read_plan(path), tmp_path / "whole", Execution(workers=1))
        rows = tmp_path / "out" / "rows.csv"
        for lines in (1, 15, 40):
            busy = subprocess.Popen(
                [
                    str(SCRIPT),
                    "study",
                    str(path),
                    "--out",
                    str(tmp_path / "out"),
                    "--workers",
                    "1",
                    "--resume",
                ],
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            while busy.poll() is None and (not rows.exists() or rows.read_bytes().count(b"\n") < lines):
                time.sleep(0.002)
            busy.send_signal(signal.SIGKILL)
            busy.wait()
        run(path, "--out", tmp_path / "out", "--workers", "1", "--resume")
        with xr.open_dataset(tmp_path / "out" / "study.nc", engine="h5netcdf") as found:
            assert found.contact_ratio.values.tolist() == [row.values[0] for row in whole.rows]
            assert found["pair.pinion.profile_shift"].values.tolist() == [row[0] for row in whole.plan.rows]
            assert found.contact_ratio.attrs["units"] == "1"

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            (lambda text: text.replace("\n1,", "\n9,", 1), "line [0-9]+: was changed"),
            (lambda text: text.replace("0.4", "0.5", 1), "was changed since it was written"),
            (lambda text: text + "garbage\n", "was changed since it was written"),
            (lambda text: text.encode().replace(b"row", b"\xff\xfe", 1), "must be a table of rows"),
        ],
    )
    def test_rows_that_somebody_changed_are_refused_with_their_line(self, tmp_path, change, message):
        plan, rows = read_plan(study_file(tmp_path, SHIFTS)), tmp_path / "out" / "rows.csv"
        run_study(plan, tmp_path / "out", Execution(workers=1))
        changed = change(rows.read_text(encoding="utf-8"))
        rows.write_bytes(changed if isinstance(changed, bytes) else changed.encode())
        with pytest.raises(InputError, match=message):
            run_study(plan, tmp_path / "out", Execution(workers=1, resume=True))

    def test_a_row_that_the_plan_does_not_have_is_refused(self, tmp_path):
        plan = read_plan(study_file(tmp_path, SHIFTS))
        found = run_study(plan, tmp_path / "out", Execution(workers=1))
        columns = Columns(plan.keys, plan.outputs)
        append(tmp_path / "out" / "rows.csv", columns, (0.4,), replace(found.rows[0], index=77))
        with pytest.raises(InputError, match=r"row 77.*0 to 3"):
            run_study(plan, tmp_path / "out", Execution(workers=1, resume=True))

    @pytest.mark.parametrize("note", ["", "{", "[1]", "null", '{"study": 1}', "[" * 100_000])
    def test_a_note_that_somebody_changed_is_refused(self, tmp_path, note):
        plan = read_plan(study_file(tmp_path, SHIFTS))
        run_study(plan, tmp_path / "out", Execution(workers=1))
        (tmp_path / "out" / "study.json").write_text(note)
        with pytest.raises(InputError, match=r"study\.json|another study"):
            run_study(plan, tmp_path / "out", Execution(workers=1, resume=True))

    def test_rows_that_only_wanted_memory_are_computed_again(self, tmp_path):
        from flankfilm.studies.row import NOT_COMPUTED, RowResult

        plan = read_plan(study_file(tmp_path, SHIFTS))
        found = run_study(plan, tmp_path / "out", Execution(workers=1))
        rows = tmp_path / "out" / "rows.csv"
        lines = rows.read_text(encoding="utf-8").splitlines(keepends=True)
        rows.write_text("".join(line for line in lines if not line.startswith("2,")), encoding="utf-8")
        dead = RowResult(2, (math.nan,) * len(plan.outputs), 0.1, f"{NOT_COMPUTED}its process died twice")
        append(rows, Columns(plan.keys, plan.outputs), plan.rows[2], dead)
        again = run_study(plan, tmp_path / "out", Execution(workers=1, resume=True))
        assert again.computed == 1
        assert [row.values for row in again.rows] == [row.values for row in found.rows]
        assert "not computed" not in rows.read_text(encoding="utf-8")


class TestCommand:
    @pytest.mark.usefixtures("rows_here")
    def test_some_rows_failed_is_a_status_of_its_own(self, tmp_path):
        path = study_file(tmp_path, '"pair.pinion.tip_alteration" = [0.0, 0.9]')
        done = command("study", path, "--out", "out", cwd=tmp_path, status=4)
        assert "row 1 failed" in done.stdout

    @pytest.mark.usefixtures("rows_here")
    def test_a_tolerance_in_percent_stands_on_the_page(self, tmp_path):
        scene = (EXAMPLES / "article.toml").read_text(encoding="utf-8")
        assert "tolerance = 0.005" in scene
        percent = scene.replace("tolerance = 0.005", 'tolerance = "0.5%"')
        (tmp_path / "scene.toml").write_text(percent, encoding="utf-8")
        path = study_file(tmp_path, '"pair.pinion.profile_shift" = [0.0, 0.1]')
        path.write_text(
            path.read_text(encoding="utf-8").replace((EXAMPLES / "article.toml").as_posix(), "scene.toml"),
            encoding="utf-8",
        )
        command("study", path, "--out", "out", cwd=tmp_path)
        assert "tolerance of each row 0.5" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")

    @pytest.mark.slow
    def test_the_study_of_sliding_is_written_and_drawn(self, tmp_path):
        done = run(study_file(tmp_path, SHIFTS), "--out", tmp_path / "out", "--workers", "1")
        assert "4 rows, 4 of them computed" in done.stdout
        assert "<svg" in (tmp_path / "out" / "study.svg").read_text(encoding="utf-8")

    @pytest.mark.slow
    def test_all_rows_failed_is_a_failure(self, tmp_path):
        path = study_file(tmp_path, '"pair.pinion.tip_alteration" = [0.9, 0.95]')
        assert "row 0 failed" in run(path, "--out", tmp_path / "out", status=3).stdout

    @pytest.mark.slow
    @pytest.mark.filterwarnings("ignore")  # of the cluster's own start and end
    def test_a_cluster_gives_the_same_rows_to_the_last_digit(self, tmp_path):
        import dask

        plan = read_plan(study_file(tmp_path, SHIFTS))
        here = run_study(plan, tmp_path / "here", Execution(workers=1))
        with dask.config.set({"scheduler-address": ""}):  # as where the variable is set to nothing
            there = run_study(plan, tmp_path / "there", Execution("dask", workers=1))
        assert [row.values for row in here.rows] == [row.values for row in there.rows]

    @pytest.mark.parametrize("kind", ["dask", "mpi"])
    def test_an_executor_that_is_not_installed_is_named(self, tmp_path, monkeypatch, kind):
        monkeypatch.setitem(sys.modules, "dask", None)
        monkeypatch.setitem(sys.modules, "mpi4py", None)
        path = study_file(tmp_path, SHIFTS)
        done = command("study", path, "--out", "o", "--executor", kind, cwd=tmp_path, status=2)
        assert {"dask": "distributed", "mpi": "mpi4py"}[kind] in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("path", sorted((EXAMPLES / "studies").glob("*.toml")), ids=lambda path: path.stem)
def test_every_example_is_in_order_and_its_first_row_computes(path):
    from flankfilm.studies.row import Row, compute_row

    plan = read_plan(path)
    result = compute_row(Row(0, plan.raw_scene(0), plan.outputs))
    assert result.fault == ""
    for name, value in zip(plan.outputs, result.values, strict=True):
        assert math.isfinite(value) or "nan where" in OUTPUTS[name].meaning, name


def test_outputs_carry_their_unit_in_the_name():
    suffixes = {
        "mm": "_mm",
        "um": "_um",
        "deg": "_deg",
        "GPa": "_GPa",
        "MPa": "_MPa",
        "m/s": "_m_per_s",
        "%": "_percent",
    }
    for name, output in OUTPUTS.items():
        assert name.endswith(suffixes.get(output.unit, "")), name
