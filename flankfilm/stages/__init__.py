"""The steps from a scene to its results; each computed only where something needs it."""
