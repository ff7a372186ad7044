"""The page of `flankfilm app`: form, live answers and runs, without a browser but for its transport."""
