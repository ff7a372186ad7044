"""Motions that are followed for long: sweeps, run-ups, spectra and Lyapunov exponents."""
