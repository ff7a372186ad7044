"""Errors that are outputs by themselves, and the outputs that they belong to; all others follow from the figures."""

from __future__ import annotations

from collections.abc import Mapping

HELD: Mapping[str, tuple[str, ...]] = {
    "stiffness_error": ("mean_secant_stiffness_N_per_mm_um",),
    "tangent_stiffness_error": ("mean_tangent_stiffness_N_per_mm_um", "mean_stiffness_N_per_mm_um"),
    "transmission_error_error": ("transmission_error_um",),
    "face_load_factor_error": ("face_load_factor",),
    "greatest_line_load_error": ("greatest_line_load_N_per_mm",),
    "shaft_error": tuple(f"shaft_deflection_{gear}_um" for gear in ("pinion", "wheel")),
    "tilt_error": tuple(f"shaft_misalignment_{gear}_um" for gear in ("pinion", "wheel")),
    "tilt_stiffness_error": ("mean_tilt_stiffness_Nm_per_rad",),
    "robust_face_load_factor_error": ("robust_face_load_factor",),
    "root_stress_error": tuple(
        f"root_{kind}_{gear}_MPa" for kind in ("tension", "compression") for gear in ("pinion", "wheel")
    ),
    "least_film_error": ("least_film_um", "film_ratio"),
    "film_error": (
        "least_central_film_um",
        "film_at_C_um",
        *(f"least_film_at_{point}_um" for point in "ABCDE"),
    ),
    "losses_error": (
        "mean_friction",
        "mesh_loss_W",
        "sliding_loss_W",
        "mesh_loss_by_boundary_least_W",
        "mesh_loss_by_boundary_most_W",
    ),
    "losses_error_by_5_MPa": ("mesh_loss_by_5_MPa_W",),
    "losses_error_by_10_MPa": ("mesh_loss_by_10_MPa_W",),
    "flank_temperature_error": ("flank_temperature_K",),
    "efficiency_error": ("mesh_efficiency",),
    "temperature_rise_error": (
        "oil_temperature_rise_K",
        "flank_temperature_rise_pinion_K",
        "flank_temperature_rise_wheel_K",
    ),
    "film_with_heat_error": ("least_film_with_heat_um", "film_ratio_with_heat"),
    "natural_frequency_error": ("natural_frequency_Hz", "resonance_speed_rpm"),
    "greatest_force_factor_error": ("greatest_force_factor",),
    "drive_frequency_error": ("lowest_drive_frequency_Hz", "drive_mesh_frequency_Hz"),
    "drive_sampling_error": ("greatest_bearing_force_N", "greatest_shaft_torque_Nm"),
    "run_up_error": (
        "greatest_run_up_factor",
        "greatest_run_up_bearing_force_N",
        "greatest_run_up_shaft_torque_Nm",
    ),
    "greatest_map_factor_error": (
        "greatest_map_factor",
        "greatest_map_bearing_force_N",
        "greatest_map_shaft_torque_Nm",
    ),
    "contact_loss_error": ("contact_loss_speed_rpm",),
    "jump_error_rising": ("jump_speed_rising_rpm", "jump_frequency_rising"),
    "jump_error_falling": ("jump_speed_falling_rpm", "jump_frequency_falling"),
}

MODEL: Mapping[str, tuple[str, ...]] = {
    "stiffness_model_error": ("mean_secant_stiffness_N_per_mm_um",),
    "tangent_stiffness_model_error": ("mean_tangent_stiffness_N_per_mm_um", "mean_stiffness_N_per_mm_um"),
    "transmission_error_model_error": ("transmission_error_um",),
    "face_load_factor_model_error": ("face_load_factor", "greatest_line_load_N_per_mm"),
    **{
        f"root_stress_model_error_{gear}": (f"root_tension_{gear}_MPa", f"root_compression_{gear}_MPa")
        for gear in ("pinion", "wheel")
    },
    "natural_frequency_model_error": ("natural_frequency_Hz", "resonance_speed_rpm"),
    "greatest_bearing_force_model_error": ("greatest_bearing_force_N",),
    "greatest_shaft_torque_model_error": ("greatest_shaft_torque_Nm",),
    "losses_model_error": ("mesh_loss_W",),
    "mean_friction_model_error": ("mean_friction",),
    "sliding_loss_model_error": ("sliding_loss_W",),
    "efficiency_model_error": ("mesh_efficiency",),
}
