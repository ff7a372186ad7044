"""Flows of the oscillators: exact or in steps, the period map, and motions from a state."""
