"""Closed forms of tooth stiffness against finite elements, figure by figure."""
