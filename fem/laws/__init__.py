"""Contacts one by one: which teeth may touch, where, and the law of force and approach of each.

The setup of a pair, relief and deviations, tips outside the path of contact, and flanks that end at a tip corner.

Public, in `fem`: `unloaded_transmission_error`, `Film`.
"""
