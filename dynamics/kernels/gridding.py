"""Steps in time with a mesh force that is given on a grid of angles and depths."""

from dynamics.kernels.compiling import DIVERGED, FINE, FloatArray, IntArray, helper, plain_kernel


@helper
def between(forces: FloatArray, lowest: float, spacing: float, place: float, depth: float) -> float:
    """Force at a place of the angles, counted in rows, and a depth: straight between samples, and beyond the last."""
    rows, columns = forces.shape
    across = (depth - lowest) / spacing
    if across <= 0.0:
        return 0.0
    column = min(int(across), columns - 2)
    across -= column
    row = int(place)
    along = place - row
    row -= rows if row >= rows else 0
    after = row + 1 if row + 1 < rows else 0
    here: float = forces[row, column] + across * (forces[row, column + 1] - forces[row, column])
    there: float = forces[after, column] + across * (forces[after, column + 1] - forces[after, column])
    return here + along * (there - here)


@helper
def dot(first: FloatArray, second: FloatArray) -> float:
    """Sum of products."""
    total = 0.0
    for i in range(len(first)):
        total += first[i] * second[i]
    return total


@plain_kernel
def step_through(
    forces: FloatArray, figures: FloatArray, places: FloatArray, errors: FloatArray, rates: FloatArray,
    over: FloatArray, columns: IntArray, loaded: FloatArray, reads: FloatArray, pushed: FloatArray, state: FloatArray,
    room: FloatArray, skip: int, peaks: FloatArray, periods: int,
) -> int:  # fmt: skip
    """Follow a state through equal steps of a period; returns the flag.

    `peaks` gets the maximum forces of windows of so many `periods`, one after the other, after `skip` periods.

    The linear part moves exactly, z = A z + `loaded`[step], the row i of A with the entries `over`[i] in `columns`[i],
    and `loaded` what forces add in each step; the mesh pushes it along `pushed` before and after each step by half of
    what it does in one. `reads`: displacement and speed of the mesh of a state. `figures`: lowest depth and spacing of
    the grid, half the backlash, 1 if the back flanks can touch, what a force changes of the speed in half a step,
    damping of the mesh in contact, and how much less it is without. `places`, (steps + 1, 2): rows of the grid for
    front and back flanks; `errors`, (steps + 1,): error of the angle; `rates`, (steps, 2): the rate that the damper
    feels, before and after a step.
    """
    lowest, spacing, half_backlash, back, push, damping, freed = figures
    size, steps, entries = len(state), len(rates), over.shape[1]
    peaks[:] = 0.0
    y = dot(reads[0], state) - errors[0]
    force = between(forces, lowest, spacing, places[0, 0], y - half_backlash)
    if back > 0.0:
        force -= between(forces, lowest, spacing, places[0, 1], -y - half_backlash)
    for period in range(skip + len(peaks) * periods):
        window, greatest = (period - skip) // periods, 0.0
        for step in range(steps):
            drag = damping * rates[step, 0]
            if force == 0.0:
                drag += freed * (dot(reads[1], state) - rates[step, 0])
            for i in range(size):
                state[i] += push * (drag - force) * pushed[i]
            for i in range(size):
                total = loaded[step, i]
                for j in range(entries):
                    total += over[i, j] * state[columns[i, j]]
                room[i] = total
            for i in range(size):
                state[i] = room[i]
            y = dot(reads[0], state) - errors[step + 1]
            force = between(forces, lowest, spacing, places[step + 1, 0], y - half_backlash)
            if back > 0.0:
                force -= between(forces, lowest, spacing, places[step + 1, 1], -y - half_backlash)
            drag = damping * rates[step, 1]
            if force == 0.0:
                drag += freed * (dot(reads[1], state) - rates[step, 1])
            for i in range(size):
                state[i] += push * (drag - force) * pushed[i]
            greatest = max(greatest, force)
        if not abs(y) < 1e150:
            return DIVERGED
        if window >= 0:
            peaks[window] = max(peaks[window], greatest)
    return FINE
