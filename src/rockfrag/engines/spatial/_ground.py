"""The ground's motion as an analysis reads it: the field of an interval, and the largest that is still to come.

In: accelerations of the ground, shape (n, 3) [m/s²]. Out: the effective gravity of an interval, equation 1, and
extremes. Theory: ``docs/space.md``, "Steps".
"""

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _case as case

# intervals that a body at rest passes at once where the ground cannot move it
WINDOW = 16


@kernel
def set_field(field, acceleration, k, scale, dt, g):
    """Fill s.field for interval k: effective gravity at its beginning [m/s²], its rate [m/s³], and g.

    The ground is at rest one sample after the last.
    """
    last = acceleration.shape[0] - 1
    for i in range(3):
        now = scale * acceleration[k, i] if k <= last else 0.0
        then = scale * acceleration[k + 1, i] if k < last else 0.0
        field[i], field[3 + i] = -now, -(then - now) / dt
    field[2] -= g
    field[case.GRAVITY] = g


@kernel
def fill_peaks(acceleration, peaks):
    """Fill the largest horizontal and vertical acceleration from each sample on, and in WINDOW of them: (n, 4)."""
    level, lift = 0.0, 0.0
    for k in range(acceleration.shape[0] - 1, -1, -1):
        across = algebra.norm(acceleration[k, 0], acceleration[k, 1])
        along = abs(acceleration[k, 2])
        level, lift = max(level, across), max(lift, along)
        peaks[k, 0], peaks[k, 1], peaks[k, 2], peaks[k, 3] = level, lift, across, along
    part = 1
    while part < WINDOW:
        # the largest of twice as many samples
        look_ahead(peaks, part)
        part *= 2
    look_ahead(peaks, 1)


@kernel
def look_ahead(peaks, part):
    """Let each of the last two columns of ``peaks`` be at least what it is ``part`` samples later."""
    for k in range(peaks.shape[0] - part):
        for i in range(2, 4):
            peaks[k, i] = max(peaks[k, i], peaks[k + part, i])


@kernel
def note_soon(s, peaks, k, scale, dt):
    """Fill s.soon: largest horizontal and vertical acceleration soon [m/s²], and how long that is [s].

    ``peaks`` are those of :func:`fill_peaks`, ``k`` the interval.
    """
    inside = k < peaks.shape[0]
    for i in range(2):
        s.soon[i] = scale * peaks[k, 2 + i] if inside else 0.0
    s.soon[2] = (WINDOW - 1) * dt
