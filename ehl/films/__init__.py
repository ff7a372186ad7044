"""Films and the functions that solve for them: smooth and rough, with heat, in time, and their responses.

Public, in `ehl`: `DEFINITIONS`, `Film`, `FilmErrors`, `Spike`, `hertz_approach`, `FilmResponse`, `film_response`,
`solve_mixed`, `MixedFilm`, `MixedThermalFilm`, `solve_mixed_thermal`, `solve`, `solve_path`, `StiffnessRow`,
`stiffness_table`, `Losses`, `ThermalFilm`, `solve_thermal`, `with_load_slopes`, `TractionCurve`, `traction_curve`,
`solve_transient`, `TransientFilm`.
"""
