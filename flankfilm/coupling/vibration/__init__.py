"""The oscillator of a pair: its Fourier stiffness, its excitation, what films damp, and its scales.

Public, in `flankfilm.coupling`: `ErrorSeries`, `error_series`, `unloaded_error`, `FilmDamping`,
`film_damping`, `MeshTable`, `mesh_table`, `PairOscillator`, `pair_oscillator`, `pair_scales`, `DriveOutput`,
`MeshSeries`, `given_series`, `mesh_series`.
"""
