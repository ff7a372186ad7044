"""What a run returns: the record, and its picture.

Public, in `flankfilm`: `Results`.
"""
