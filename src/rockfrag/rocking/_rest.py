"""Skipping the rest of a body: when the ground next moves it."""

from rockfrag.rocking._compile import kernel

BLOCK = 16
"""Samples under one entry of the tables of extremes that rest is skipped with."""


@kernel
def uplift(k, tau, low, high, factor, samples, highest, lowest, end):
    """Sample and time within it at which a body at rest rises, and the acceleration; -1 if it stays.

    It rises where ``factor × samples`` leaves [low, high], which holds 0 (thesis eq. 2.1).  ``tau``: time since
    sample k; ``highest``, ``lowest``: extremes of each BLOCK of ``samples``; ``end``: the last sample.
    """
    a0 = factor * samples[k]
    a1 = factor * samples[k + 1]
    now = a0 + tau * (a1 - a0)
    if low <= now <= high and low <= a1 <= high:
        least = low / factor
        most = high / factor
        if factor < 0.0:
            least, most = most, least
        m = _next_uplift(samples, highest, lowest, k + 1, end, least, most)
        if m < 0:
            return -1, 0.0, 0.0
        k = m - 1
        tau = 0.0
        a0 = factor * samples[k]
        a1 = factor * samples[m]
        now = a0
    if low <= now <= high:
        limit = high if a1 > a0 else low
        tau = min(max(tau, (limit - a0) / (a1 - a0)), 1.0 - 1e-9)
        now = limit
    return k, tau, now


@kernel
def _next_uplift(samples, highest, lowest, k, end, low, high):
    """First sample after k, up to ``end``, outside [low, high]; -1 if there is none."""
    m = k + 1
    while m <= end:
        if m % BLOCK == 0:
            j = m // BLOCK
            while m + BLOCK <= end + 1 and highest[j] <= high and lowest[j] >= low:
                j += 1
                m += BLOCK
            if m > end:
                break
        if samples[m] > high or samples[m] < low:
            return m
        m += 1
    return -1
