"""What commands give, in one form: data, files, page, lines and picture; and the record of a run.

Public, in `flankfilm`: `Results`.
"""
