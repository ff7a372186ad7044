"""Tables that a scene names: measured flanks and transmission errors, read from files."""
