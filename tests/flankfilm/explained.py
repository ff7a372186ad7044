"""Looks through a dataset of results for figures that say nothing of their error."""

from __future__ import annotations

import xarray as xr

KINDS = {"error", "error_variable", "error_note"}


def unexplained(data: xr.Dataset) -> list[str]:
    """Variables that have not one of an error, the name of a variable with as many errors, and a reason for none."""
    found = []
    for name in map(str, data.variables):
        about = data[name].attrs
        partner = about.get("error_variable")
        if len(KINDS & set(about)) != 1 or (partner and data[partner].dims != data[name].dims):
            found.append(f"{name}: {about}")
        if about["units"] == "" and "error" in about:
            found.append(f"{name} is a name with an error")
    return found
