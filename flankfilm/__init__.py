"""flankfilm."""
