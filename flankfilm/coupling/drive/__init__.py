"""The drive train of a pair: shafts, bearings, motor and load, and their reduction to a few modes.

Public, in `flankfilm.coupling`: `PairDrive`, `pair_drive`, `tilting_mesh`.
"""
