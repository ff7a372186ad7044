"""Flows of the oscillators: exact or in steps, the period map, and motions from a state.

Public, in `dynamics`: `Trajectory`, `period_map`, `trajectory`.
"""
