"""A scene checked, and run from its first stage to its report."""
