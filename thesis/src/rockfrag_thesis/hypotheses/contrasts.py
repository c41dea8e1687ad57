"""Contrasts and slopes of amplitudes and of the pedestal's effect, and what their design could have shown.

In: amplitudes [g] of tests. Out: differences of ln amplitude with intervals. Theory: ``docs/hypotheses.md``,
``docs/pedestal.md``.
"""

import math

import pandas as pd

from rockfrag.effects.cluster_means import (
    LEVEL,
    POWER,
    Estimate,
    TooFewUnitsError,
    detectable_ratio,
    resolution_of,
    t_estimate,
    tied_resolution,
)

MOST_UNITS = 100_000


def slope_effect(table: pd.DataFrame, x: str = "s_c", value: str = "d") -> Estimate:
    """Slope of ``value`` on ``x``: least squares inside each earthquake, then t over the earthquakes.

    Only differences between the objects of one motion (and one side, if there is a column side) enter.
    """
    by_motion = [
        table[name]
        for name in ("earthquake", "motion", "side")
        if name in table.columns
    ]
    across = table[x] - table[x].groupby(by_motion).transform("mean")
    hidden = tied_resolution(table[value], resolution_of(table))
    sums = pd.DataFrame(
        {"xy": across * table[value], "xx": across**2, "hidden": across.abs() * hidden}
    )
    by_earthquake = sums.groupby(table["earthquake"]).sum()
    by_earthquake = by_earthquake[by_earthquake["xx"] > 0]
    resolution = (by_earthquake["hidden"] / by_earthquake["xx"]).mean()
    return t_estimate(
        by_earthquake["xy"] / by_earthquake["xx"], resolution=float(resolution)
    )


def contrast(
    table: pd.DataFrame,
    factor: str,
    level: str,
    reference: str,
    *,
    block: str = "earthquake",
    value: str = "d",
) -> Estimate:
    """Difference of the mean of ``value`` between two levels of a factor, ``level`` minus ``reference``.

    Like is compared with like: both levels must be there for the same object, earthquake, floor (and side). They
    are compared within each ``block``: the earthquakes for floors and objects, the floors for two earthquakes.
    """
    design = ("earthquake", "floor", "object", "side")
    matched = [name for name in design if name in table.columns and name != factor]
    work = table.assign(known=resolution_of(table))
    cells = work.pivot_table(
        index=matched,
        columns=factor,
        values=[value, "known"],
        aggfunc="mean",
        observed=True,
    )
    for wanted in (level, reference):
        if (value, wanted) not in cells:
            raise TooFewUnitsError(f"no row has {factor} {wanted}")
    difference = (cells[value, level] - cells[value, reference]).dropna()
    known = (cells["known", level] + cells["known", reference]).reindex(
        difference.index
    )
    hidden = pd.Series(tied_resolution(difference, known), index=difference.index)
    resolution = float(hidden.groupby(level=block).mean().mean())
    return t_estimate(difference.groupby(level=block).mean(), resolution=resolution)


def power_of_t(ratio: float, sd: float, n: int) -> float:
    """Power of the two-sided one-sample t test on n ≥ 2 values of ln ratio with a standard deviation [-]."""
    from statsmodels.stats.power import TTestPower

    size = abs(math.log(ratio)) / sd
    # the two-sided power less the chance to reject on the wrong side, which underflows to NaN
    found = TTestPower().power(
        effect_size=size, nobs=n, alpha=LEVEL / 2, alternative="larger"
    )
    return float(found)


def units_needed(effect: Estimate) -> float:
    """How many units like those at hand would show the observed mean with 80 % power.

    Infinite if the observed mean lies within the resolution or needs more than `MOST_UNITS`, NaN if
    there is no scatter to judge by.
    """
    if not effect.se > 0:
        return math.nan
    if abs(effect.mean) <= max(effect.resolution, 0.0):
        return math.inf
    from statsmodels.stats.power import TTestPower

    if power_of_t(effect.ratio, effect.sd, MOST_UNITS) < POWER:
        return math.inf
    if power_of_t(effect.ratio, effect.sd, 2) >= POWER:
        return 2.0
    found = TTestPower().solve_power(
        abs(effect.mean) / effect.sd, alpha=LEVEL / 2, power=POWER, alternative="larger"
    )
    return float(math.ceil(found))


def power_note(effect: Estimate, unit: str = "earthquake") -> str:
    """Say in words what the data could have shown and how much more would be needed."""
    if effect.units < 2:
        return f"one {unit} alone has no power"
    if not effect.se > 0:
        return f"all {unit}s agree and their steps are not known, so the power is not known"
    detectable = 100 * (detectable_ratio(effect) - 1)
    seen = f"{effect.units} {unit}s can detect a change of {detectable:.1f} % or more (80 % power)"
    if abs(effect.mean) <= effect.resolution:
        finest = 100 * math.expm1(effect.resolution)
        return f"{seen}; the change found is within the {finest:.1f} % that the steps resolve"
    needed = units_needed(effect)
    if math.isinf(needed):
        return f"{seen}; no feasible number of {unit}s can detect the change found"
    return f"{seen}; the change found needs {needed:.0f} {unit}s, before any adjustment"
