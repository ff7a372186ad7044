"""The steps from a scene to its results; each computed only when something asks for it."""
