"""The rival without mechanics: a test overturns if an intensity measure exceeds a threshold.

Thresholds are chosen in the same folds as trials are.  On two measures the line of even odds of a probit
regression on their logarithms takes the place of the threshold.
"""

import numpy as np
from numpy.typing import NDArray

from rockfrag.campaign.validation import Bools, Floats, folds_by_group
from rockfrag.fragility.batch_glm import fit_batch


def best_threshold(measure: Floats, overturned: Bools) -> float:
    """Return the value of a measure above which "overturned" is right most often, in the measure's unit."""
    order = np.argsort(measure, kind="stable")
    fell = overturned[order]
    # right outcomes if the first k tests are taken as survived
    right = np.concatenate([[0], np.cumsum(~fell)]) + np.concatenate(
        [np.cumsum(fell[::-1])[::-1], [0]]
    )
    first = int(right.argmax())
    sorted_measure = measure[order]
    if first == 0:
        return float(sorted_measure[0])
    if first == len(measure):
        return float("inf")
    return float(np.sqrt(sorted_measure[first - 1] * sorted_measure[first]))


def cross_validated_threshold(
    measures: Floats,
    overturned: Bools,
    groups: NDArray[np.int64],
    *,
    folds: int,
    repeats: int,
    seed: int,
) -> Bools:
    """Outcomes by thresholds on one or two measures that tests of other motions chose, shape (repeats, tests).

    The folds are those of :func:`rockfrag.campaign.validation.cross_validate`.
    """
    rng = np.random.default_rng(seed)
    outcomes = np.empty((repeats, len(overturned)), dtype=bool)
    for repeat in range(repeats):
        fold = folds_by_group(groups, folds, rng)
        for number in range(folds):
            chosen_by = fold != number
            outcomes[repeat, ~chosen_by] = _predicted(
                measures[chosen_by], overturned[chosen_by], measures[~chosen_by]
            )
    return outcomes


def _predicted(known: Floats, overturned: Bools, asked: Floats) -> Bools:
    if known.ndim == 1:
        return np.asarray(asked >= best_threshold(known, overturned))
    fit = fit_batch(
        _design(known),
        overturned[None].astype(np.float64),
        np.ones((1, len(overturned))),
        penalised=True,
    )
    return np.asarray(_design(asked) @ fit.coefficients[0] >= 0)


def _design(measures: Floats) -> Floats:
    return np.column_stack([np.ones(len(measures)), np.log(measures)])
