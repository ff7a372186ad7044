"""Processes of a command: how it ends, what it shows on the way, and those that it starts."""
