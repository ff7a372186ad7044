"""Laws beside tip corners are kept by what decides them: rows of a study whose gears are equal there compute none."""

from __future__ import annotations

from dataclasses import replace

import fem
from fem.laws.corner_laws import laws_of_corners
from fem.laws.mesh_setup import MeshSetup
from gears import GearDeviations, Lead, PitchDeviations, ProfileDeviation, TipRelief

RHO = (4e-3, 14e-3)


def kept(pair, bodies, **options):
    return laws_of_corners(MeshSetup(pair, **options), bodies)


def test_gears_of_equal_shape_size_and_material_are_the_very_same(article_pair):
    first, again = (fem.compliance(article_pair, tolerance=0.02, tip_edges=True) for _ in range(2))
    assert first is not again
    assert first.pinion is again.pinion
    assert first.coarse_flanks[1] is again.coarse_flanks[1]
    assert first.tip_strips[0] is again.tip_strips[0]
    larger = fem.compliance(replace(article_pair, module=2.5e-3), tolerance=0.02)
    assert larger.pinion is not first.pinion


def test_laws_are_those_of_equal_gears_whatever_their_lead_and_place(article_pair):
    bodies = fem.compliance(article_pair, tolerance=0.02)
    laws = kept(article_pair, bodies)
    crowned = replace(article_pair, pinion=replace(article_pair.pinion, lead=Lead(crowning=5e-6)))
    assert kept(crowned, replace(fem.compliance(article_pair, tolerance=0.02), pair=crowned)) is laws
    assert kept(article_pair, bodies, friction=0.05, positions=7, back=True) is laws


def test_laws_differ_by_relief_edges_gears_and_what_they_are_compared_with(article_pair):
    bodies = fem.compliance(article_pair, tolerance=0.02)
    laws = kept(article_pair, bodies)
    relieved = replace(
        article_pair, wheel=replace(article_pair.wheel, tip_relief=TipRelief(amount=5e-6, length=1e-3))
    )
    others = [
        kept(relieved, replace(bodies, pair=relieved)),
        kept(article_pair, bodies, tip_rounding=50e-6),
        kept(article_pair, bodies, beyond_path=False),
        kept(article_pair, bodies.without("hub_windup")),
        kept(article_pair, bodies.coarser),
        kept(article_pair, bodies.doubtful("fit")),
    ]
    assert laws not in others
    assert len({id(other) for other in others}) == len(others)
    thinner = replace(article_pair, face_width=0.5 * article_pair.face_width)
    assert kept(thinner, fem.compliance(thinner, tolerance=0.02)) is not kept(article_pair, bodies)


def test_deviations_count_by_their_curves_not_by_pitches(article_pair):
    bodies = fem.compliance(article_pair, tolerance=0.02)
    teeth = article_pair.pinion.teeth

    def deviating(amount, late):
        pitches = PitchDeviations((0.0, late, *(0.0,) * (teeth - 2)))
        return GearDeviations(ProfileDeviation(RHO, (0.0, amount)), pitches), None

    laws = kept(article_pair, bodies, deviations=deviating(2e-6, 1e-6))
    assert kept(article_pair, bodies, deviations=deviating(2e-6, 3e-6)) is laws
    assert kept(article_pair, bodies, deviations=deviating(3e-6, 1e-6)) is not laws
    assert kept(article_pair, bodies) is not laws
