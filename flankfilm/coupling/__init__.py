"""Lubricated mesh cycle, oscillator of a pair, jump speeds, verification: plain SI arguments in, records out.

Knows no scene and no files. Start with :func:`lubricated_cycle`.

Public, in `flankfilm`: `FilmModel`, `film_along_path`, `lubricated_cycle`, `mesh_losses`, `mesh_cycle`,
`single_pair_stiffness`, `compare_closed_forms`, `dynamic_map`, `jump_speeds`, `speed_run_up`, `mesh_spectrum`,
`revolution_error`, `speed_sweep`, `error_series`, `unloaded_error`, `pair_oscillator`.
"""

import lazy_loader as _lazy

__getattr__, __dir__, __all__ = _lazy.attach_stub(__name__, __file__)
