"""Studies in parts: the same rows as in one piece, and no study from parts that are missing, strange or changed."""

from __future__ import annotations

import csv
import re

import pytest
import xarray as xr

from base import InputError
from flankfilm.studies.execution import Execution
from flankfilm.studies.parts import Part, merge
from flankfilm.studies.plan import read_plan
from flankfilm.studies.run import run_study
from tests.flankfilm.program import command
from tests.flankfilm.test_study import SHIFTS, study_file

pytestmark = pytest.mark.usefixtures("rows_here")

ALONE = Execution(workers=1)


def run(study, *arguments, **more):
    return command("study", study, *arguments, cwd=study.parent, **more)


def table(folder):
    """Cells of every row but for its cost and its checksum, in the order of the rows."""
    with (folder / "rows.csv").open(newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    columns = [place for place, name in enumerate(head) if name not in ("seconds", head[-1])]
    return sorted(([row[place] for place in columns] for row in rows), key=lambda row: int(row[0]))


@pytest.fixture
def plan(tmp_path):
    return read_plan(study_file(tmp_path, SHIFTS + '\n"pair.module_mm" = [2.0, 2.5]'))


def computed(plan, folder, *parts):
    for part in parts:
        run_study(plan, part.folder(folder), ALONE, rows=part.rows(plan))


def test_parts_are_every_row_once(plan):
    rows = [row for number in range(1, 4) for row in Part(number, 3).rows(plan)]
    assert sorted(rows) == list(range(len(plan.rows)))
    assert list(Part(2, 100).rows(plan)) == [1]
    assert list(Part(99, 100).rows(plan)) == []


def test_merged_parts_are_the_study_in_one_piece(tmp_path, plan):
    study = tmp_path / "study.toml"
    run(study, "--out", tmp_path / "whole", "--workers", "1")
    for number in (2, 3, 1):
        run(study, "--out", tmp_path / "out", "--part", f"{number}/3", "--workers", "1")
        assert not (tmp_path / "out" / "rows.csv").exists()
    run(study, "--out", tmp_path / "out", "--merge")
    assert table(tmp_path / "out") == table(tmp_path / "whole")
    (out, one_piece) = (
        xr.load_dataset(tmp_path / name / "study.nc", engine="h5netcdf") for name in ("out", "whole")
    )
    for name in plan.outputs:
        assert (out[name].values == one_piece[name].values).all()
    assert (tmp_path / "out" / "report.html").exists()
    run(study, "--out", tmp_path / "out", "--merge")
    assert table(tmp_path / "out") == table(tmp_path / "whole")


def test_missing_rows_are_named(tmp_path, plan):
    computed(plan, tmp_path / "out", Part(1, 3), Part(3, 3))
    with pytest.raises(InputError, match=re.escape("3 of 8 rows are missing: 1, 4, 7")):
        merge(plan, tmp_path / "out")
    computed(plan, tmp_path / "out", Part(2, 3))
    assert [row.index for row in merge(plan, tmp_path / "out").result.rows] == list(range(8))


def test_parts_of_several_divisions_join(tmp_path, plan):
    computed(plan, tmp_path / "out", Part(1, 2), Part(1, 4), Part(2, 4), Part(4, 4))
    assert len(merge(plan, tmp_path / "out").result.rows) == 8


def test_a_part_begins_again_only_with_resume(tmp_path, plan):
    part = Part(1, 2)
    computed(plan, tmp_path / "out", part)
    with pytest.raises(InputError, match="--resume"):
        computed(plan, tmp_path / "out", part)
    again = run_study(
        plan, part.folder(tmp_path / "out"), Execution(workers=1, resume=True), rows=part.rows(plan)
    )
    assert (again.computed, len(again.rows)) == (0, 4)


def test_parts_of_another_study_do_not_join(tmp_path, plan):
    computed(plan, tmp_path / "out", Part(1, 2))
    other = read_plan(study_file(tmp_path, SHIFTS + '\n"pair.module_mm" = [2.0, 3.0]'))
    computed(other, tmp_path / "out", Part(2, 2))
    with pytest.raises(InputError, match="holds another study"):
        merge(plan, tmp_path / "out")


def test_a_changed_row_does_not_join(tmp_path, plan):
    computed(plan, tmp_path / "out", Part(1, 2), Part(2, 2))
    rows = Part(2, 2).folder(tmp_path / "out") / "rows.csv"
    rows.write_text(rows.read_text(encoding="utf-8").replace("\n3,", "\n5,", 1), encoding="utf-8")
    with pytest.raises(InputError, match="was changed since it was written"):
        merge(plan, tmp_path / "out")


@pytest.mark.parametrize("text", ["0/3", "4/3", "3", "1/0", "a/b", "-1/3", "1/3/5", ""])
def test_parts_that_there_are_not_are_refused(tmp_path, text):
    path = study_file(tmp_path, SHIFTS)
    done = run(path, "--out", tmp_path / "out", f"--part={text}", status=2)
    assert "Such as --part 3/16" in done.stderr
    assert not (tmp_path / "out").exists()


def test_a_part_is_not_merged_at_once(tmp_path):
    path = study_file(tmp_path, SHIFTS)
    done = run(path, "--out", tmp_path / "out", "--part", "1/2", "--merge", status=2)
    assert "does not go with --merge" in done.stderr
