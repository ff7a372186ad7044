"""Remedies of studies, of optimisations and of the folders that keep their rows: applied as worded, and accepted.

What a case does to the file is taken from the words of the fault, as in `test_remedies`.
"""

from __future__ import annotations

import copy
import json
import re
from pathlib import Path

import pytest

from base import InputError
from flankfilm.files.folder import locked
from flankfilm.optimisation.task import read_task
from flankfilm.processes.worker_processes import cores
from flankfilm.studies.execution import Execution
from flankfilm.studies.kept import Work, kept_rows
from flankfilm.studies.plan import read_plan
from flankfilm.studies.row import RowResult
from flankfilm.studies.study_file import MOST_ROWS
from flankfilm.studies.table import Columns
from tests.flankfilm.program import EXAMPLES
from tests.flankfilm.test_remedies import BASE, NUMBER

ROOT = Path(__file__).parents[2]
SHIFT, OTHER = "pair.pinion.profile_shift", "pair.wheel.profile_shift"
SPAN = {"from": -0.2, "to": 0.4}
STUDY = {"scene": BASE, "outputs": ["contact_ratio"], "vary": {SHIFT: {**SPAN, "steps": 4}}}
TASK = {"scene": BASE, "minimise": ["specific_sliding"], "vary": {SHIFT: SPAN}}


def written(value):
    """TOML of a value, every key in quotes."""
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{json.dumps(key)} = {written(inner)}' for key, inner in value.items())} }}"
    return f"[{', '.join(map(written, value))}]" if isinstance(value, list) else json.dumps(value)


def faults(kind, raw, folder):
    path = folder / "file.toml"
    path.write_text("".join(f"{key} = {written(value)}\n" for key, value in raw.items()), encoding="utf-8")
    try:
        {"study": read_plan, "task": read_task}[kind](path)
    except InputError as error:
        return error.faults
    return ()


def edited(raw, changes):
    """Keys given by their path, a tuple; None takes one out."""
    raw = copy.deepcopy(raw)
    for (*above, last), value in changes.items():
        table = raw
        for name in above:
            table = table.setdefault(name, {})
        if value is None:
            del table[last]
        else:
            table[last] = value
    return raw


MANY = {SHIFT: {**SPAN, "steps": MOST_ROWS}}
FOLLOWERS = {f"key{n}": {"of": SHIFT} for n in range(6)}
AT = ("vary", SHIFT)
CASES = [
    # kind of file, what is wrong with it, where the fault is, words of it, what they say
    ("study", {("outputs",): ["contact_ratios"]}, "outputs", r"Did you mean (\w+)", lambda n: {("outputs",): [n]}),
    ("study", {("outputs",): ["colour"]}, "outputs", r"Allowed: (\w+)", lambda n: {("outputs",): [n]}),
    ("study", {("outputs",): []}, "outputs", r"must have at least 1 entries()",
     lambda n: {("outputs",): ["contact_ratio"]}),
    ("study", {("desing",): "grid"}, "desing", r"is not a key of the study. Did you mean (\w+)",
     lambda n: {("desing",): None, (n,): "grid"}),
    ("study", {("design",): "grids"}, "design", r"Did you mean '(\w+)'", lambda n: {("design",): n}),
    ("study", {("design",): "sobol"}, "samples", rf"Such as samples = {NUMBER}", lambda n: {("samples",): int(n)}),
    ("study", {("samples",): 8}, "samples", r"(Leave it out)", lambda n: {("samples",): None}),
    ("study", {("samples",): 8}, "samples", r'take design = "(\w+)"', lambda n: {("design",): n}),
    ("study", {("samples",): "8", ("design",): "sobol"}, "samples", r"(Write it without quotes)$",
     lambda n: {("samples",): 8}),
    ("study", {("samples",): 0, ("design",): "sobol"}, "samples", rf"must be at least {NUMBER}",
     lambda n: {("samples",): int(n)}),
    ("study", {(*AT, "steps"): None}, f"vary.{SHIFT}.steps", rf"Such as steps = {NUMBER}",
     lambda n: {(*AT, "steps"): int(n)}),
    ("study", {(*AT, "steps"): 1}, f"vary.{SHIFT}.steps", rf"must be at least {NUMBER}",
     lambda n: {(*AT, "steps"): int(n)}),
    ("study", {(*AT, "from"): 0.9}, f"vary.{SHIFT}.from", r"(Give the smaller number first)",
     lambda n: {(*AT, "from"): 0.4, (*AT, "to"): 0.9}),
    ("study", {(*AT, "log"): True}, f"vary.{SHIFT}.from", r"(leave log out)", lambda n: {(*AT, "log"): None}),
    ("study", {(*AT, "log"): True}, f"vary.{SHIFT}.from", rf"more than {NUMBER} .*(?=Raise it)",
     lambda n: {(*AT, "from"): float(n) + 0.1}),
    ("study", {(*AT, "fron"): -0.2}, f"vary.{SHIFT}.fron", r"is not a key of the study. Did you mean (\w+)\?$",
     lambda n: {(*AT, "fron"): None, (*AT, n): -0.2}),
    ("study", {AT: 0.3}, f"vary.{SHIFT}", r"must be a (list), such as \[1, 2\]", lambda n: {AT: [0.3]}),
    ("study", {AT: []}, f"vary.{SHIFT}", r"must have at least 1 (entries)", lambda n: {AT: [0.3]}),
    ("study", {("vary",): {}}, "vary", r'Such as "([\w.]+)"', lambda n: {("vary", n): [0.1, 0.2]}),
    ("study", {AT: [0.1, 9.0]}, f"row 1: {SHIFT}", rf"at most {NUMBER}", lambda n: {AT: [0.1, float(n)]}),
    ("study", {("vary",): {"pair.pinion.teeth": {"from": 20, "to": 40, "steps": 5}}}, "row 0: pair.pinion.teeth",
     r"Add (whole) = true", lambda n: {("vary", "pair.pinion.teeth", n): True}),
    ("study", {("vary",): {"pair.pinion.tteth": [30]}}, "row 0: pair.pinion.tteth", r"Did you mean (\w+)",
     lambda n: {("vary",): {f"pair.pinion.{n}": [30]}}),
    ("study", {("vary",): {"pair.module_mm.x": [1.0]}}, "row 0: pair.module_mm.x", r"(Name a key of the scene)",
     lambda n: {("vary",): {"pair.module_mm": [1.0]}}),
    ("study", {("design",): "list", ("vary",): {SHIFT: [0.1, 0.2], OTHER: [0.0]}}, "vary",
     r"(Give each as many)", lambda n: {("vary", OTHER): [0.0, 0.1]}),
    ("study", {("design",): "list", ("vary",): {SHIFT: [0.1, 0.2], OTHER: [0.0]}}, "vary",
     r'take design = "(\w+)"', lambda n: {("design",): n}),
    ("study", {("vary",): {**MANY, OTHER: [0.0, 0.1]}}, "vary", r"(Take fewer steps)",
     lambda n: {("vary",): {SHIFT: {**SPAN, "steps": 5}, OTHER: [0.0, 0.1]}}),
    ("study", {("vary",): MANY, ("follow",): FOLLOWERS}, "vary", r"(Take fewer rows)",
     lambda n: {("vary", SHIFT, "steps"): 2, ("follow",): {}}),
    ("study", {("follow",): {OTHER: {"of": "pair.shift"}}}, f"follow.{OTHER}.of", r"Follow one that is: ([\w.]+)",
     lambda n: {("follow", OTHER, "of"): n}),
    ("study", {("follow",): {OTHER: {"of": SHIFT, "tims": 2.0}}}, f"follow.{OTHER}.tims",
     r"is not a key of the study. Did you mean (\w+)",
     lambda n: {("follow", OTHER, "tims"): None, ("follow", OTHER, n): -1.0}),
    ("study", {("follow",): {SHIFT: {"of": SHIFT}}}, SHIFT, r"Take it out of (\w+)", lambda n: {(n,): {}}),
    ("study", {("set",): {SHIFT: 0.1}}, SHIFT, r"Take it out of (\w+)", lambda n: {(n,): {}}),
    ("study", {("vary",): {"film.model": ["ehl", "none"]}, ("follow",): {OTHER: {"of": "film.model"}}}, "follow",
     r'Vary both, with design = "(\w+)"', lambda n: {("design",): n, ("follow",): {}, ("vary", OTHER): [0.0, 0.1]}),
    ("study", {("scene",): None}, "scene", r"is (required)", lambda n: {("scene",): BASE}),
    ("study", {("scene",): 3}, "scene", r"must be (text) in quotes",
     lambda n: {("scene",): (EXAMPLES / "article.toml").as_posix()}),
    ("task", {("minimise",): []}, "minimise", r'Such as \["(\w+)"\]', lambda n: {("minimise",): [n]}),
    ("task", {("minimise",): ["specific_slidng"]}, "minimise", r"Did you mean (\w+)", lambda n: {("minimise",): [n]}),
    ("task", {("minimise",): ["contact_ratio"] * 6}, "minimise", rf"must have at most {NUMBER} entries",
     lambda n: {("minimise",): ["contact_ratio"] * int(n)}),
    ("task", {("maximise",): ["specific_sliding"]}, "maximise", r"(Take it out of one)",
     lambda n: {("maximise",): []}),
    ("task", {("minimize",): ["contact_ratio"]}, "minimize", r"is not a key of the optimisation. Did you mean (\w+)",
     lambda n: {("minimize",): None, (n,): ["contact_ratio"]}),
    ("task", {("limits",): {"contact_ratio": {}}}, "limits.contact_ratio", r"Give (\w+) or at_most",
     lambda n: {("limits", "contact_ratio", n): 1.2}),
    ("task", {("limits",): {"contact_ratio": {"atleast": 1.2}}}, "limits.contact_ratio.atleast",
     r"Did you mean (\w+)\?$", lambda n: {("limits", "contact_ratio"): {n: 1.2}}),
    ("task", {("limits",): {"contct_ratio": {"at_least": 1.2}}}, "limits", r"Did you mean (\w+)",
     lambda n: {("limits",): {n: {"at_least": 1.2}}}),
    ("task", {("limits",): {"contact_ratio": {"at_least": 1.6, "at_most": 1.5}}}, "limits.contact_ratio.at_least",
     rf"at_most = {NUMBER}. Lower it", lambda n: {("limits", "contact_ratio", "at_least"): float(n)}),
    ("task", {("evaluations",): 3}, "evaluations", rf"must be at least {NUMBER}", lambda n: {("evaluations",): int(n)}),
    ("task", {("population",): 2000}, "population", rf"must be at most {NUMBER}", lambda n: {("population",): int(n)}),
    ("task", {("vary",): {}}, "vary", r'Such as "([\w.]+)"', lambda n: {("vary", n): SPAN}),
    ("task", {(*AT, "from"): 0.4}, f"vary.{SHIFT}.from", r"(Give the smaller number first)",
     lambda n: {(*AT, "to"): 0.5}),
    ("task", {AT: [0.1, 0.2]}, f"vary.{SHIFT}", r"must be a (table)", lambda n: {AT: SPAN}),
    ("task", {(*AT, "from"): -5.0}, SHIFT, rf"at least {NUMBER}", lambda n: {(*AT, "from"): float(n)}),
    ("task", {(*AT, "to"): 5.0}, SHIFT, rf"at most {NUMBER}", lambda n: {(*AT, "to"): float(n)}),
    ("task", {("vary",): {"pair.pinion.teeth": {"from": 20, "to": 40}}}, "pair.pinion.teeth",
     r"Add (whole) = true", lambda n: {("vary", "pair.pinion.teeth", n): True}),
]  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "changes", "where", "words", "edit"),
    CASES,
    ids=[f"{at} {one[0]} {one[2]}" for at, one in enumerate(CASES)],
)
def test_remedies_of_files_with_rows(tmp_path, kind, changes, where, words, edit):
    whole = {"study": STUDY, "task": TASK}[kind]
    assert faults(kind, whole, tmp_path) == ()
    wrong = edited(whole, changes)
    found = faults(kind, wrong, tmp_path)
    fault = next((one for one in found if one.where == where), None)
    assert fault is not None, [str(one) for one in found]
    said = re.search(words, str(fault))
    assert said, str(fault)
    assert [str(one) for one in faults(kind, edited(wrong, edit(said[1])), tmp_path)] == []


def test_both_ends_of_ranges_are_judged_at_once(tmp_path):
    wrong = edited(
        TASK, {("vary", SHIFT): {"from": -5.0, "to": 5.0}, ("vary", OTHER): {"from": -6.0, "to": 0.0}}
    )
    assert sorted(one.value for one in faults("task", wrong, tmp_path)) == ["-5.0", "-6.0", "5.0"]


@pytest.mark.parametrize(("read", "kind"), [(read_plan, "study"), (read_task, "optimisation")])
@pytest.mark.parametrize("text", [None, "no = table = "], ids=["missing", "no TOML"])
def test_the_page_that_a_fault_names_has_a_file_to_start_from(tmp_path, read, kind, text):
    path = tmp_path / "file.toml"
    if text is not None:
        path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as error:
        read(path)
    said = re.search(rf"tart from the {kind} in ([\w/]+\.md)", str(error.value))
    assert said, str(error.value)
    begin = re.search(r"```toml\n(.*?)```", (ROOT / said[1]).read_text(encoding="utf-8"), re.DOTALL)
    assert begin
    path.write_text(
        begin[1].replace("../article.toml", (EXAMPLES / "article.toml").as_posix()), encoding="utf-8"
    )
    assert read(path)


class TestFolders:
    """Of rows that are kept: the remedies name an option of the command."""

    @pytest.fixture
    def work(self):
        return Work("study", "Rows", {"rows": [1]}, Columns(("key",), ("contact_ratio",)))

    @pytest.fixture
    def held(self, tmp_path, work):
        """A folder with a row."""
        with kept_rows(tmp_path / "held", work, False) as kept:
            kept.add([1.0], RowResult(0, (1.5,), 0.1))
        return tmp_path / "held"

    def damage(self, held, how):
        note = held / "study.json"
        if how == "no note":
            note.unlink()
        elif how == "torn note":
            note.write_text("{")
        elif how == "no table":
            note.write_text("[]")
        elif how == "other code":
            text = note.read_text()
            note.write_text(re.sub(r'"code_sha256": "\w+"', '"code_sha256": "0"', text))

    @pytest.mark.parametrize("how", ["no note", "torn note", "no table", "other code", "other study"])
    def test_another_folder(self, held, work, how):
        self.damage(held, how)
        mine = Work("study", "Rows", {"rows": [2]}, work.columns) if how == "other study" else work
        with pytest.raises(InputError, match="Name another folder with --out"), kept_rows(held, mine, True):
            pass
        with kept_rows(held.with_name("another"), mine, True) as kept:
            assert kept.lines == ()

    def test_resume(self, held, work):
        with pytest.raises(InputError, match="Add --resume"), kept_rows(held, work, False):
            pass
        with kept_rows(held, work, True) as kept:
            assert len(kept.lines) == 1

    def test_another_one_at_work(self, held, work):
        with locked(held):
            with (
                pytest.raises(InputError, match="Wait for it, or name another --out"),
                kept_rows(held, work, True),
            ):
                pass
            with kept_rows(held.with_name("another"), work, True):
                pass
        with kept_rows(held, work, True) as kept:
            assert len(kept.lines) == 1

    def test_workers(self):
        with pytest.raises(InputError, match="Leave it out for one worker on each core"):
            Execution(workers=0)
        with Execution().staff() as staff:
            assert staff.count == cores()
