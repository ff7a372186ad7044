"""Files and folders of a user: claimed, locked, kept, opened again; results as plain data.

Public, in `flankfilm`: `open_results`.
"""
