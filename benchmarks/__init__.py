"""Long comparisons and studies of the project itself; outside the wheel."""
