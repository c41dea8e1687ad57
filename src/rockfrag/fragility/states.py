"""Curve of rocking, which starts at a peak acceleration that is known exactly."""

import pandas as pd

from rockfrag.fragility.censored import Brackets
from rockfrag.fragility.estimators import Fragility, fragility_of_brackets
from rockfrag.fragility.observations import (
    labels,
    name_and_unit,
    positive,
)


def fit_uplift(
    motions: pd.DataFrame,
    im: str,
    *,
    level: float = 0.90,
) -> Fragility:
    """Curve of P(rock | IM) from motions scaled to the peak acceleration at which rocking starts.

    That peak is exact, so each motion (a row with ``motion``, ``earthquake`` and the measure ``im`` at that scale)
    gives its measure at uplift exactly; in the peak acceleration itself the curve is a step, given as a β of
    next to nothing.
    """
    at = positive(motions, im)
    names = labels(motions, "motion", "table")
    earthquakes = labels(motions, "earthquake", "table")
    return fragility_of_brackets(Brackets(at, at, names, earthquakes, *name_and_unit(im)), level)
