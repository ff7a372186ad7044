"""Report of a rating: every figure with its limit, verdict and source, and why factors of ours are missing."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
import xarray as xr

from flankfilm.coupling import LoadedFactors, own_rating
from flankfilm.coupling.rating.loaded_factors import EVEN, TOGETHER
from flankfilm.figures import safeties
from flankfilm.output.variables import of_record
from flankfilm.report.page import Part
from flankfilm.report.rating_parts import headlines, section
from flankfilm.stages.rating import RATING
from gears.rating import Rating
from tests.flankfilm.pictured import PAIR, faults_of, rating
from tests.flankfilm.test_rating_scene import WHOLE, engine, put


def page(rated: Rating, own: Any = None) -> Part:
    data = [of_record("rating", rated)]
    if rated.spectrum is not None:
        data.append(of_record("rating_spectrum", rated.spectrum))
    if own is not None:
        data.append(of_record("rating_own", own))
    return section(rated, own, xr.merge(data))


def cells(part: Part) -> dict[str, tuple[str, ...]]:
    return {row[0]: row[1:] for table in part.tables for row in table.rows}


def test_every_safety_has_limit_verdict_and_source():
    rated = rating()
    rows = cells(page(rated))
    for gear, name in enumerate(("pinion", "wheel")):
        value, limit, safety, required, verdict = rows[f"pitting of the {name}, sigma_H"][:5]
        assert float(limit.split()[0]) / float(value.split()[0]) == pytest.approx(rated.S_H[gear], abs=1e-3)
        assert (float(safety), required) == (pytest.approx(rated.S_H[gear], abs=1e-3), "1")
        assert verdict == ("enough" if rated.S_H[gear] >= 1.0 else "not enough")
    assert rows["dynamic factor K_v"][:2] == (f"{rated.factors.K_v:.4f}", "ISO 6336-1, method B")
    assert rows["face-load factor K_Hbeta"][1] == "ISO 6336-1, method C"
    assert rows["work hardening factor Z_W"][-1] == "given"
    assert rows["1"][0] == "400"
    assert {"safeties", "spectrum_damage"} <= {
        drawing.function.rpartition(".")[2] for drawing in page(rated).figures
    }


@pytest.mark.parametrize("helical", [False, True])
def test_factors_of_ours_say_how_they_are_found_or_why_not(helical: bool):
    rated = rating()
    why = TOGETHER if helical else EVEN
    share = None if helical else 1.0
    no_share = TOGETHER if helical else ""
    loaded = LoadedFactors(None, share, 1.2, share and 1e-3, why, no_share, 0.01, helical=helical)
    own = own_rating(rated, PAIR, loaded=loaded)
    rows = cells(page(rated, own))
    assert rows["dynamic factor K_v"][-1] == "none: no wanted motion"
    assert rows["face-load factor K_Hbeta"][-1] == f"none: {why}"
    assert rows["K_Hbeta K_Halpha"][2] == f"{own.K_H:.4f}"
    assert rows["pitting of the pinion, sigma_H"][-2] == f"{own.S_H[0]:.3f}"
    named = {headline.name: headline for headline in headlines(rated, own)}
    assert f"{min(own.S_F):.3f} ±" in named["safety against breakage"].note
    drawn = safeties(xr.merge([of_record("rating", rated), of_record("rating_own", own)]))
    assert faults_of(drawn) == []


def test_what_has_no_result_is_said():
    back = engine(put(WHOLE, operating__pinion_torque_Nm=-300.0))[RATING]
    part = page(back)
    assert any(note.startswith("Scuffing gives no result: ") for note in part.notes)
    assert "scuffing, theta_int" not in cells(part)


def test_a_pair_at_resonance_says_so_in_its_head():
    fast = engine(put(WHOLE, operating__pinion_speed_rpm=12000.0))[RATING]
    shown = {headline.name: headline for headline in headlines(fast, None)}
    assert shown["resonance ratio N"].text == f"{fast.factors.N:.3f}"
    assert "advises against" in shown["resonance ratio N"].note
    assert "resonance ratio N" not in {headline.name for headline in headlines(rating(), None)}


def test_a_safety_without_a_result_says_why_in_the_head():
    back = engine(put(WHOLE, operating__pinion_torque_Nm=-300.0))[RATING]
    shown = {headline.name: headline for headline in headlines(back, None)}
    assert (shown["safety against scuffing"].text, "driving pinion" in shown["safety against scuffing"].note) == (
        "none", True,
    )  # fmt: skip


def test_the_verdict_of_our_own_factors_is_said():
    rated = rating()
    loaded = LoadedFactors(None, 1.0, 1.0, 1e-3, EVEN, "", 0.01, helical=False)
    fewer, more = (
        own_rating(rated, PAIR, loaded=replace(loaded, K_Halpha=share))
        for share in (1.0, 2.0 * min(rated.S_H) ** 2)
    )
    assert "against pitting, below 1" in page(rated, more).paragraphs[0]
    assert ("below" in page(rated, fewer).paragraphs[0]) == (min(fewer.S_H) < 1.0 or min(fewer.S_F) < 1.4)
    assert "our own" not in page(rated).paragraphs[0]
