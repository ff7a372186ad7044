"""Long motions: sweeps, run-ups, spectra and Lyapunov exponents.

Public, in `dynamics`: `LyapunovResult`, `lyapunov_exponents`, `lyapunov_scan`, `RunUp`, `run_up`, `Spectrum`,
`motion_spectrum`, `SweepResult`, `sweep`.
"""
