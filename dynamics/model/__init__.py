"""Oscillators: stiffness, excitation, forces of contact, drive trains, and the protocol of all of them."""
