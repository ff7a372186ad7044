"""Long motions: sweeps, run-ups, spectra and Lyapunov exponents."""
