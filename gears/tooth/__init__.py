"""One gear: rack, profile and fillet, blank, deviations, lead, material, and outlines to draw."""
