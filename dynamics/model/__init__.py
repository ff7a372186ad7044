"""Oscillators: stiffness, excitation, forces of contact, drive trains, and the protocol of all of them.

Public, in `dynamics`: `PowerContact`, `SmoothedBacklash`, `SqueezeFilm`, `modal_damping`, `rayleigh_damping`,
`DriveOscillator`, `FourierFit`, `fit_fourier`, `Options`, `GearOscillator`, `Scaling`, `SmoothOscillator`,
`restoring_force`, `FourierStiffness`, `TabulatedContact`, `CompiledLaw`, `Surface`.
"""
