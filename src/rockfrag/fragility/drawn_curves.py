"""Points of fragility curves for drawing: the curve with its band, and the outcomes that it is fitted to."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.fragility.empirical import fraction_in_bins, local_fraction
from rockfrag.fragility.estimators import Fragility
from rockfrag.fragility.observations import Observations

POINTS = 120  # points of a curve, in equal ratios
_TAIL = 2.6
"""Standard deviations on either side of the median within which a curve is drawn: 0.5 to 99.5 %."""


def curve_points(
    labels: Mapping[str, Any], curve: Fragility, outcomes: Observations
) -> pd.DataFrame:
    """Points of one curve over the range of its data: ``x``, ``probability``, its limits, and what needs no curve.

    ``local`` is the fraction of overturned tests near x, which may fall where the curve cannot (missing where all
    tests are at one value), ``fraction`` with its limits the non-parametric fragility function. Without a curve
    ``probability`` is missing.
    """
    fit = curve.fit
    low, high = 0.8 * float(outcomes.im.min()), 1.25 * float(outcomes.im.max())
    if np.isfinite(fit.theta):
        # a nearly flat curve may not stretch the range, nor amplitudes far above it
        low = max(low, fit.theta * np.exp(-_TAIL * fit.beta))
        high = min(high, fit.theta * np.exp(_TAIL * fit.beta))
    if not low < high:
        low, high = 0.8 * float(outcomes.im.min()), 1.25 * float(outcomes.im.max())
    x = np.geomspace(low, high, POINTS)
    nothing = np.full(POINTS, np.nan)
    lower, upper = curve.interval.band(x) if np.isfinite(fit.theta) else (nothing, nothing)
    inside = (x >= outcomes.im.min()) & (x <= outcomes.im.max()) & (np.ptp(outcomes.log_im) > 0)
    local = nothing.copy()
    if inside.any():
        local[inside] = local_fraction(outcomes, x[inside])
    fraction, fraction_lower, fraction_upper = curve.checks.fractions.at(x)
    return pd.DataFrame(
        {
            **labels,
            "im": fit.im,
            "unit": fit.unit,
            "x": x,
            "probability": fit.probability(x) if np.isfinite(fit.theta) else nothing,
            "lower": lower,
            "upper": upper,
            "local": local,
            "fraction": fraction,
            "fraction_lower": fraction_lower,
            "fraction_upper": fraction_upper,
        }
    )


def fraction_points(labels: Mapping[str, Any], curve: Fragility) -> pd.DataFrame:
    """Points of the non-parametric fragility function, if the fitted one is rejected; no row otherwise.

    ``fraction`` of overturned tests never falls, and is straight over ln ``x`` between the points.
    """
    fractions = curve.checks.fractions
    x = fractions.knots()[0] if curve.checks.rejected else np.empty(0)
    fraction, lower, upper = fractions.at(x) if x.size else (x, x, x)
    about = pd.DataFrame(
        {**labels, "im": curve.fit.im, "unit": curve.fit.unit}, index=pd.RangeIndex(x.size)
    )
    return about.assign(x=x, fraction=fraction, lower=lower, upper=upper)


def outcome_bins(
    labels: Mapping[str, Any], curve: Fragility, outcomes: Observations
) -> pd.DataFrame:
    """Fractions of overturned tests in bins under the labels of their curve, where the measure is called ``x``."""
    names = {"im": "x", "im_lower": "x_lower", "im_upper": "x_upper"}
    table = fraction_in_bins(outcomes).rename(columns=names)
    about = pd.DataFrame({**labels, "im": curve.fit.im, "unit": curve.fit.unit}, index=table.index)
    return pd.concat([about, table], axis=1)
