"""Error against cost: what is measured, with solvers of known order and cost, and the command."""

from __future__ import annotations

import csv
import json
import math
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from base import InputError
from flankfilm.bench.case import Answer, Case, PeerWork, Series, Value, level, true_error
from flankfilm.bench.catalogue import SOLVERS
from flankfilm.bench.element_cases import elements
from flankfilm.bench.examples import TORQUE, example_pair
from flankfilm.bench.gear_cases import enclosed_area, independent_pairs
from flankfilm.bench.machine import this_machine
from flankfilm.bench.measuring import Row, gain, measure, timed
from flankfilm.bench.peers import ask
from flankfilm.bench.pictures import error_against_cost
from flankfilm.bench.run import Bench, bench
from flankfilm.bench.stepwise_cases import stepwise
from flankfilm.bench.tables import clock, number, read_bench, remarks, summaries, write_tables
from flankfilm.bench.work_cases import work_contact, work_film, work_geometry
from flankfilm.coupling import mesh_cycle
from tests.flankfilm.program import flankfilm


def trapezoids(count: int) -> tuple[int, float]:
    """Integral of exp from 0 to 1: error 1/(12 n^2) relative, in the limit of many."""
    x = np.linspace(0.0, 1.0, count + 1)
    return count, float(np.trapezoid(np.exp(x), x))


def answered(found: tuple[int, float]) -> Answer:
    count, integral = found
    return Answer(count, {"integral": Value(np.array([integral]), 1.0 / count**2)})


def second_order(counts: tuple[int, ...] = (4, 8, 16, 32), peers: tuple[PeerWork, ...] = ()) -> Case:
    series = Series("trapezoids", tuple(level(f"{n}", trapezoids, answered, n) for n in counts))
    finest = level("4096", trapezoids, answered, 4096)
    return Case("rule", "Trapezoidal rule", "exp", "n", (series,), finest, {"integral": 2.0}, peers)


def row(error: float, cpu: float) -> Row:
    return Row("", "", "", "q", 1.0, cpu, cpu, cpu, 1, error, math.nan)


def bench_of(case: Case) -> Bench:
    return Bench(this_machine(), math.nan, True, 1, (measure("own", case, 1),), (), (), 1.0)


def test_true_errors_fall_with_the_order_of_the_rule():
    rows = measure("own", second_order(), repeat=2).rows
    assert [r.size for r in rows] == [4, 8, 16, 32]
    assert np.array([r.error for r in rows]) == pytest.approx(
        1 / (12 * np.array([4, 8, 16, 32.0]) ** 2), 0.01
    )
    assert [r.estimate for r in rows] == [1 / 16, 1 / 64, 1 / 256, 1 / 1024]


def test_ratios_of_estimate_and_error_are_those_of_the_rule():
    (one,) = summaries([measure("own", second_order(), repeat=1)])
    assert one.ratios == pytest.approx((12, 12), rel=0.01)


def test_ratios_leave_out_errors_that_the_finest_solution_cannot_tell():
    # 1/12 of the estimate of 4096: half of the levels below are within three times of it
    (one,) = summaries([measure("own", second_order((32, 2048)), repeat=1)])
    assert one.ratios[1] == pytest.approx(12, rel=0.01)
    assert one.ratios[0] == one.ratios[1]


@pytest.mark.parametrize(("order", "factor"), [(1, 10.0), (2, math.sqrt(10.0)), (4, 10**0.25)])
def test_a_tenth_of_the_error_costs_what_the_order_says(order: int, factor: float):
    # work in proportion to n, error to n^-order
    assert gain(tuple(row(n**-order, n) for n in (1.0, 3.0, 10.0, 30.0))) == pytest.approx(factor)


def test_levels_that_are_beaten_in_both_do_not_count():
    good = tuple(row(1 / n, n) for n in (1.0, 10.0, 100.0))
    assert gain((*good, row(0.5, 500.0))) == pytest.approx(gain(good))
    assert math.isnan(gain(good[:1]))


def test_the_warm_up_is_not_timed():
    calls = []

    def work() -> tuple[int, float]:
        calls.append(None)
        time.sleep(0.2 if len(calls) <= 2 else 0.0)  # the finest and the warm-up
        return 4, 1.0

    series = Series("sleeper", (level("only", work, answered),))
    found = measure("own", Case("s", "s", "", "n", (series,), level("finest", work, answered)), repeat=1)
    assert found.rows[0].wall < 0.1


def test_short_work_is_repeated_and_sleep_is_no_processor_time():
    _, short = timed(lambda: None, 2)
    assert short.repeats > 50
    _, slept = timed(lambda: time.sleep(0.03), 2)
    assert slept.repeats == 2
    assert slept.cpu < 0.02 < slept.wall


def test_states_are_compared_over_their_largest_component():
    found, finest = np.array([1.01, 0.001]), np.array([1.0, 0.0])
    assert true_error(Value(found), Value(finest, over_largest=True)) == pytest.approx(0.01)
    assert math.isnan(true_error(Value(found), Value(finest[:1])))


@pytest.mark.parametrize("reason", ["refused: n is odd", "not converged"])
def test_a_level_that_fails_keeps_its_reason_and_the_rest_goes_on(reason: str):
    def work(count: int) -> tuple[int, float]:
        if count == 8 and reason.startswith("refused"):
            raise ValueError(reason)
        return trapezoids(count)

    def answer(found: tuple[int, float]) -> Answer:
        one = answered(found)
        return Answer(one.size, one.values, reason if found[0] == 8 else "")

    series = Series("trapezoids", tuple(level(f"{n}", work, answer, n) for n in (4, 8, 16)))
    finest = level("4096", work, answer, 4096)
    rows = measure("own", Case("r", "r", "", "n", (series,), finest), repeat=1).rows
    assert [r.failure for r in rows] == ["", reason, ""]
    assert math.isnan(rows[1].error)


def test_a_finest_solution_that_fails_leaves_no_errors():
    def refuse() -> tuple[int, float]:
        raise ValueError("too fine")

    case = second_order()
    broken = Case("b", "b", "", "n", case.series, level("finest", refuse, answered))
    rows = measure("own", broken, repeat=1).rows
    assert {r.failure for r in rows} == {"the finest solution failed: too fine"}
    assert error_against_cost(measure("own", broken, 1)) is not None


def test_the_area_inside_curved_edges_is_that_of_the_corners_and_bows():
    from meshes import mesh_sector

    mesh = mesh_sector(example_pair().teeth_profiles[0])
    corner, side = mesh.points[mesh.triangles[:, :3]], mesh.points[mesh.triangles[:, 3:]]

    def doubled(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]

    edges = np.roll(corner, -1, axis=1) - corner
    bows = side - (corner + np.roll(corner, -1, axis=1)) / 2
    triangles = doubled(edges[:, 0], edges[:, 1]) / 2
    # a parabola over a chord encloses two thirds of chord times rise
    segments = (2 / 3) * -doubled(edges, bows).sum(axis=1)
    assert enclosed_area(mesh) == pytest.approx(float((triangles + segments).sum()), rel=1e-12)


def test_what_is_written_reads_back(tmp_path):
    found = bench_of(second_order())
    write_tables(found, tmp_path)
    again = read_bench(tmp_path / "bench.json")
    assert again.cases == found.cases
    assert again.machine.libraries == found.machine.libraries
    with (tmp_path / "error_against_cost.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(r["error"]) for r in rows] == [r.error for r in found.cases[0].rows]


PEER = {
    "peer": "fake",
    "version": "7",
    "runs": [{"level": "a", "seconds": 2.0, "first": 3.0, "values": [3.0]}],
}


def interpreter(folder: Path, body: str) -> Path:
    """Program that takes an interpreter's arguments and answers by itself."""
    path = folder / "python-of-peers"
    program = folder / "peer.py"
    program.write_text(f"import json, sys, time\ngiven = json.load(sys.stdin)\n{body}\n")
    path.write_text(
        f'#!/bin/sh\nexec "{sys.executable}" "{program}"\n'
    )  # a shebang takes no path with a space
    path.chmod(0o755)
    return path


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ("print(json.dumps({'missing': 'No module named x'}))", "not in that environment: No module named x"),
        ("sys.exit('it broke')", "it broke"),
        ("print('hello')", "printed no result"),
        ("time.sleep(30)", "took longer than 0.5 s"),
    ],
)
def test_peers_that_are_missing_or_fail_are_told_by_name(tmp_path, body: str, reason: str):
    case = second_order(peers=(PeerWork("ross_stiffness", {"n": 5}, "integral"),))
    found = ask(interpreter(tmp_path, body), case, 1, longest=0.5 if "sleep" in body else 60.0)
    assert [(row.peer, row.failure) for row in found] == [("ross_stiffness", reason)]
    assert remarks(replace(bench_of(case), peers=tuple(found))) == [f"ross_stiffness: {reason}"]


def test_a_peer_gets_the_work_and_its_values_are_compared(tmp_path):
    answer = f"assert given == {{'n': 5, 'repeat': 4}}; print('noise'); print(json.dumps({PEER})); print(1)"
    case = second_order(peers=(PeerWork("ross_stiffness", {"n": 5}, "integral"),))
    (found,) = ask(interpreter(tmp_path, answer), case, 4)
    assert (found.peer, found.version, found.cpu, found.first) == ("fake", "7", 2.0, 3.0)
    assert found.error == pytest.approx(3.0 / (math.e - 1.0) - 1.0, rel=1e-6)


@pytest.mark.slow
def test_the_scripts_for_scipy_and_compiled_code_agree_with_the_exact_flow():
    flow = next(case for case in SOLVERS["motion"](True) if case.key == "motion_flow")
    rows = ask(Path(sys.executable), flow, 1)
    scipy = [r for r in rows if r.peer.startswith("scipy")]
    assert scipy[-1].error < 1e-11 < 1e-6 < scipy[0].error < 1e-3
    compiled = [r for r in rows if r.peer.startswith("compiled DOP853")]
    assert compiled[-1].error < 1e-11 < 1e-6 < compiled[0].error < 1e-3
    assert all(r.failure == "" or r.failure.startswith("not in that environment") for r in rows)


def test_all_faults_are_told_at_once_and_nothing_is_made(tmp_path):
    with pytest.raises(InputError) as caught:
        bench(tmp_path / "new", ["motion", "wings"], repeat=0, against=str(tmp_path / "python"))
    assert [fault.where for fault in caught.value.faults] == ["--only", "--repeat", "--against"]
    assert not (tmp_path / "new").exists()
    (tmp_path / "taken").touch()
    with pytest.raises(InputError) as caught:
        bench(tmp_path / "taken", ["wings"])
    assert len(caught.value.faults) == 2


def test_solvers_whose_work_no_other_program_knows_are_told(tmp_path):
    with pytest.raises(InputError, match="compliance and motion"):
        bench(tmp_path / "new", ["gears"], against=sys.executable)


@pytest.mark.slow
def test_the_command_measures_and_writes(tmp_path):
    done = flankfilm(
        "bench", "--quick", "--only", "gears", "mesh", "--repeat", "1", "--out", "out", cwd=tmp_path
    )
    assert "preparing gears" in done.stderr
    assert "Closed forms" in done.stdout
    found = json.loads((tmp_path / "out" / "bench.json").read_text())
    assert [case["solver"] for case in found["cases"]] == ["gears", "mesh"]
    assert [call["solver"] for call in found["first_calls"]] == ["gears", "mesh"]
    assert all(call["kept"] > call["again"] > 0 for call in found["first_calls"])
    errors = {r["quantity"]: r["error"] for case in found["cases"] for r in case["rows"]}
    assert 0 < errors["area of the sector"] < 1e-6
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"report.html", "closed_forms.svg", "mesh.svg", "overview.svg", "first_calls.csv"} <= names
    page = (tmp_path / "out" / "report.html").read_text()
    assert page.count("<svg") == 4
    assert found["machine"]["libraries"]["numpy"] in page


def test_faults_of_the_command_give_status_2_and_no_traceback(tmp_path):
    done = flankfilm(
        "bench", "--only", "wings", "motion", "--against", "no-such-python", cwd=tmp_path, status=2
    )
    assert "2 faults" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_curved_sides_and_higher_orders_are_nearer_to_the_finest_energy():
    rows = measure("elements", elements(True), repeat=1).rows
    finer = {row.series: row.error for row in rows if row.level == "refined 1 times"}
    assert finer["P3 curved"] < finer["P2 curved"] < finer["P2 straight"] < finer["P1"] < 0.05


def test_steps_of_a_contact_with_exponent_1_agree_with_the_exact_flow():
    one = stepwise()[0]
    assert one.finest is not None
    exact = one.finest.answer(one.finest.work()).values["state"]
    states = next(series for series in one.series if series.name == "states alone")
    found = [step.answer(step.work()).values["state"] for step in (states.levels[0], states.levels[-1])]
    assert true_error(found[1], exact) < 1e-12 < true_error(found[0], exact) < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize("build", [work_geometry, work_contact, work_film])
def test_works_whose_time_alone_counts_have_rows_without_errors(build):
    found = measure("work", build(), repeat=1)
    assert {row.failure for row in found.rows} == {""}
    assert all(math.isnan(row.error) and row.cpu > 0 for row in found.rows)
    assert found.finest == ""


@pytest.mark.parametrize("form", ["ishikawa", "weber_banaschek"])  # the third is taken without a force here
def test_pairs_added_are_those_of_the_mesh_cycle(form):
    """The benchmark's own sum against the cycle whose pairs have no body in common, which solves for the deflection."""
    pair = example_pair()
    options = {"model": form.replace("_", "-"), "pairs": "independent", "positions": 10}
    cycle = mesh_cycle(pair, torque=TORQUE, **options)
    # the cycle's force is shared among pairs, on which the Hertz part of one form depends
    allowed = 0.05 if form == "weber_banaschek" else 1e-9
    np.testing.assert_allclose(independent_pairs(pair, form, 10), cycle.secant_stiffness, rtol=allowed)


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(math.nan, "-"), (5e-7, "0.5 µs"), (9.99e-4, "999 µs"), (1e-3, "1 ms"), (0.999, "999 ms"), (1.0, "1 s")],
)
def test_times_are_told_in_the_unit_that_suits_them(seconds, text):
    assert clock(seconds) == text


def test_errors_are_told_in_two_digits_and_missing_ones_by_a_dash():
    assert [number(one) for one in (0.0123, 1.06e-9, math.nan, math.inf)] == ["1.2e-02", "1.1e-09", "-", "-"]
