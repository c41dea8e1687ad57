"""What a design could have seen, printed beside each "slight" difference."""

import math

from scipy import optimize, stats

from rockfrag.pedestal.cluster_means import Estimate

POWER = 0.80
LEVEL = 0.05
SD_PAIR = 0.134
"""Scatter of d per pair from tolerances of geometry and restitution [-]."""
MOST_UNITS = 100_000


def power_of_t(ratio: float, sd: float, n: int, level: float = LEVEL) -> float:
    """Power of the two-sided one-sample t test on n values of ln ratio.

    Parameters
    ----------
    ratio
        True ratio [-].
    sd
        Standard deviation of one value [-].
    n
        Number of values, at least 2.
    """
    if n < 2 or sd <= 0:
        raise ValueError("power needs two values and a positive standard deviation")
    critical = float(stats.t.ppf(1 - level / 2, n - 1))
    shift = abs(math.log(ratio)) * math.sqrt(n) / sd
    upper = float(stats.nct.sf(critical, n - 1, shift))
    # the far tail underflows to NaN for large shifts, where it is nothing
    lower = float(stats.nct.cdf(-critical, n - 1, shift))
    return upper + (lower if math.isfinite(lower) else 0.0)


def detectable_ratio(n: int, sd: float = SD_PAIR, power: float = POWER) -> float:
    """Smallest ratio above one that n values show with the given power [-].

    With sd = 0.134 per pair these are 1.066, 1.126 and 1.154 for 36, 12 and 9 pairs.  One value, or
    values without scatter, detect nothing or everything: infinite and 1.
    """
    if n < 2 or math.isnan(sd):
        return math.inf
    if sd == 0:
        return 1.0
    # |ln ratio| in units of sd/√n; 60 is ample even for two values (t at one degree of freedom)
    unit = sd / math.sqrt(n)
    root = optimize.brentq(
        lambda z: power_of_t(math.exp(z * unit), sd, n) - power, 1e-6, 60.0, xtol=1e-10
    )
    return math.exp(float(root) * unit)


def units_needed(effect: Estimate, power: float = POWER) -> float:
    """How many units like those at hand would show the observed mean with the given power.

    Infinite if the observed mean is zero, NaN if there is one unit only.
    """
    if math.isnan(effect.se):
        return math.nan
    if effect.mean == 0:
        return math.inf
    if effect.se == 0:
        return 2.0
    low, high = 2, MOST_UNITS
    if power_of_t(effect.ratio, effect.sd, high) < power:
        return math.inf
    while low < high:
        middle = (low + high) // 2
        if power_of_t(effect.ratio, effect.sd, middle) >= power:
            high = middle
        else:
            low = middle + 1
    return float(low)


def power_note(effect: Estimate, unit: str = "event") -> str:
    """Say in words what the data could have shown and how much more would be needed."""
    if effect.units < 2:
        return f"one {unit}: no power can be stated"
    detectable = 100 * (detectable_ratio(effect.units, effect.sd) - 1)
    needed = units_needed(effect)
    more = (
        f"more than {MOST_UNITS} {unit}s for the change seen"
        if math.isinf(needed)
        else f"{needed:.0f} {unit}s for the change seen"
    )
    return (
        f"80 % power: {effect.units} {unit}s show a change of {detectable:.1f} % or more; "
        f"needed: {more}, before any adjustment"
    )
