"""Constants that decide answers by their nature, each with the test that fails when it is doubled.

They are definitions and laws: no error of an answer contains them. A slow test doubles each, and sees its test fail
(``tests/benchmarks/test_constants.py``).
"""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["LAWS", "OPEN", "SHAPES"]

LAWS: Mapping[str, str] = {
    "fem.elasticity.flank_samples.CORNER_CLEARANCE": "tests/fem/test_fit_errors.py"
    "::test_a_load_at_a_tip_corner_is_one_a_hundredth_of_a_module_before_it",
    "gears.closed_form.cantilever.SHEAR_FACTOR": "tests/gears/test_closed_form.py"
    "::test_shear_of_a_rectangle_is_a_fifth_more_than_that_of_its_mean",
    "gears.closed_form.contact_stress.LARGEST_RATIO": "tests/gears/test_closed_form.py"
    "::test_stress_of_spur_gears_falls_with_the_contact_ratio",
    "gears.closed_form.root_stress.STEEPEST": "tests/gears/test_helical_closed_forms.py"
    "::test_helix_factor_counts_overlap_to_one_and_the_angle_to_30_degrees",
    "gears.closed_form.tooth_stiffness.CORRECTION": "tests/validation/test_gears_iso6336.py::test_worked_values",
    "gears.closed_form.tooth_stiffness.FACE_STIFFNESS": "tests/gears/test_face_load.py"
    "::test_stiffness_over_the_face_is_that_of_the_mesh_less_fifteen_per_cent",
    "gears.closed_form.tooth_stiffness.LIGHT_LOAD": "tests/gears/test_closed_form.py"
    "::test_iso_light_load_and_modulus",
    "fem.laws.cut_off.JOIN": "tests/fem/test_cut_off.py::test_the_correction_is_that_of_narrow_strips",
    "fem.fields.grids.DROPPED": "tests/fem/test_formats.py::test_mantissas_in_pictures_are_rounded_to_eleven_bits",
    "ehl.discrete.asperities.MEAN_OVER_DEVIATION": "tests/ehl/test_mixed.py::test_roughness_of_drawings",
    "ehl.discrete.asperities.PEAKS_OVER_MEAN": "tests/ehl/test_mixed.py::test_roughness_of_drawings",
    "ehl.discrete.asperities.USUAL_NUMBER": "tests/ehl/test_mixed.py::test_roughness_of_drawings",
    "ehl.discrete.asperities.USUAL_SLENDERNESS": "tests/ehl/test_mixed.py::test_roughness_of_drawings",
    "ehl.discrete.equations.LOAD": "tests/ehl/test_solver.py"
    "::test_the_film_converges_at_second_order_or_better[2.0-1.0]",
    "ehl.discrete.flash._SHAPE": "tests/ehl/test_flash.py"
    "::test_both_surfaces_are_as_hot_as_the_moving_source_makes_them",
    "ehl.discrete.solids._LN_LEAST": "tests/ehl/test_flash.py"
    "::test_both_surfaces_are_as_hot_as_the_moving_source_makes_them",
    "ehl.oil.lubricant._POLE": "tests/ehl/test_lubricant.py"
    "::test_oil_thickens_by_roelands_law_as_it_cools_towards_135_below_zero",
    "ehl.oil.measured._POLE": "tests/ehl/test_measured.py::test_a_table_of_roelands_law_is_roelands_law",
    "ehl.oil.oil_grades._T100": "tests/validation/test_iso_viscosity.py"
    "::test_walther_meets_its_two_viscosities_and_is_straight_between",
    "ehl.oil.oil_grades._T15": "tests/validation/test_iso_viscosity.py::test_typical_gear_oil",
    "ehl.oil.oil_grades._T40": "tests/validation/test_iso_viscosity.py"
    "::test_walther_meets_its_two_viscosities_and_is_straight_between",
    "ehl.oil.oil_grades._ZERO": "tests/validation/test_iso_viscosity.py"
    "::test_a_grade_gives_back_its_viscosity_and_index",
    "ehl.oil.rheology.ROELANDS_LN_VISCOSITY": "tests/ehl/test_lubricant.py"
    "::test_an_oil_thinner_than_the_pole_of_the_law_is_refused",
    "ehl.oil.rheology.ROELANDS_PRESSURE": "tests/ehl/test_lubricant.py"
    "::test_derived_index_gives_roelands_law_in_its_usual_form",
    "ehl.oil.rheology._DENSITY_LIMIT": "tests/ehl/test_lubricant.py::test_density_limits",
    "ehl.oil.rheology._DENSITY_RISE": "tests/ehl/test_lubricant.py::test_density_limits",
    "ehl.solving.levels._DROP": "tests/ehl/test_spike.py::test_a_spike_asked_for_is_resolved",
    "gears.pair.thermal_expansion.ROOM": "tests/gears/test_thermal_expansion.py"
    "::test_all_of_one_temperature_and_material_keeps_its_angles",
}
"""Test of a constant, by the constant's name."""

SHAPES: Mapping[str, str] = {
    "dynamics.attraction.basins.UNDECIDED": "a label",
    "fem.contact.cell_laws.WITHIN": "degree of a table whose formulas stand beside it",
    "fem.influence.fillet_waves.SHEAR": "an index",
    "fem.stress.root_peaks.OTHER": "an index",
    "fem.influence.tip_strips.RATIO": "laws by strips count on it",
}
"""Constants that arrays are shaped by: changed alone, there is no answer."""

OPEN: Mapping[str, str] = {}
"""Constants that decide an answer beyond its error, which is known and not resolved."""
