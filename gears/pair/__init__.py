"""Two gears in mesh: geometry, path of contact, checks, warm gears, inspection, and their shafts."""
