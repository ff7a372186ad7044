"""Compiled kernels of the stepwise flow; loaded when a motion is first computed.

A law is a function pointer, so that one compiled integrator serves every law. Its arguments: angle, X, V, region,
parameters q, data, out. `out` of length 1 takes the force alone; else it takes the force, its derivatives with
respect to X and V, and those with respect to q. Bit i of the region is 1 where surface i is positive.
"""
