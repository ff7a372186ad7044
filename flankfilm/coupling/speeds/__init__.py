"""Motion over the speed: sweeps, run-ups, maps, spectra, jumps, and what a series leaves out of them.

Public, in `flankfilm.coupling`: `BearingSweep`, `bearing_sweep`, `DriveSweep`, `drive_sweep`, `DynamicMap`,
`dynamic_map`, `Jump`,
`OrderedJumps`, `jumps_to_tolerance`, `SpeedDiagram`, `jump_speeds`, `SpeedRunUp`, `speed_run_up`,
`MotionSpectrum`, `mesh_spectrum`, `over_revolution`, `revolution_error`, `Portrait`, `SpeedSweep`,
`speed_sweep`, `MissedJump`.
"""
