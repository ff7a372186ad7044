"""gears."""
