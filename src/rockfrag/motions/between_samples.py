"""Values of a motion between its samples, for records whose components were sampled at unlike times; compiled.

In: samples of any unit. Out: values on the straight lines between them. Theory: ``docs/motions.md``.
"""

from rockfrag.base.arrays import Floats
from rockfrag.runtime.machine_code import cached_njit


@cached_njit()
def fill_between(
    samples: Floats, dt: float, begin: float, step: float, found: Floats
) -> None:
    """Take values of samples [any unit] on the straight lines between them.

    Parameters
    ----------
    samples : values ``dt`` seconds apart
    dt : between them [s]
    begin, step : first time, and between the times at which values are wanted [s]
    found : those values; beyond the samples the first or last one
    """
    last, j = samples.size - 1, 0
    for i in range(found.size):
        x = begin + i * step
        if x <= 0.0:
            found[i] = samples[0]
            continue
        while j < last and (j + 1) * dt <= x:
            j += 1
        if j >= last:
            found[i] = samples[last]
            continue
        slope = (samples[j + 1] - samples[j]) / ((j + 1) * dt - j * dt)
        found[i] = slope * (x - j * dt) + samples[j]
