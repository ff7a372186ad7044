"""Gear data in and out: REXS files, tooth profiles as points and drawings."""
