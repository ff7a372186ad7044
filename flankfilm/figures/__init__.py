"""One plot function for each kind of result; each returns a matplotlib figure."""
