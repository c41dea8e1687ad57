"""Intervals of figures that are no means: the jackknife over earthquakes (Tukey 1958)."""

import math
from collections.abc import Sequence

from rockfrag.pedestal.cluster_means import Estimate, t_estimate


def jackknife(whole: float, without: Sequence[float]) -> Estimate:
    """Figure of all data with its t interval from what it is without each earthquake in turn, shape (k,).

    It is centred on ``whole``, with the standard error of Tukey's k pseudovalues and k - 1 degrees of freedom; a
    figure that is not finite is a TooFewUnitsError.
    """
    k = len(without)
    pseudo = t_estimate([k * whole - (k - 1) * fewer for fewer in without])
    half = (pseudo.upper - pseudo.lower) / 2
    zero = Estimate(whole, pseudo.se, k, whole - half, whole + half, math.nan)
    p = 2 * min(zero.p_above(0.0), zero.p_below(0.0))
    return Estimate(whole, pseudo.se, k, whole - half, whole + half, p)
