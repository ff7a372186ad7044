"""Oscillators of several freedoms with one mesh: their equation, coordinates, exact flow and branches."""
