"""Proper scores of probabilities that were said of tests before their outcomes were used, and who scores better.

In: probabilities of overturning and outcomes, shape (tests,). Out: Brier and logarithmic scores, with the
difference to ours and its interval. Source: Brier (1950), Good (1952). Docs: ``docs/scores.md``.
"""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import stats

from rockfrag.base.arrays import Flags, Floats

LEAST = 1e-3  # probability below which nobody is taken to be surer
LEVEL = 0.90  # of intervals


def said_of_arrangements(toppled: Flags) -> Floats:
    """Probability of each test from outcomes in arrangements, or with errors of the model.

    Parameters
    ----------
    toppled : shape (arrangements, tests)

    Returns
    -------
    Probabilities, shape (tests,), of which none is 0 or 1: half of one is added to both sides.
    """
    return np.asarray((toppled.sum(axis=0) + 0.5) / (len(toppled) + 1))


def brier(said: Floats, happened: Flags) -> Floats:
    """Squared error of each probability.

    Parameters
    ----------
    said, happened : probabilities and outcomes, shape (tests,)

    Returns
    -------
    Squared errors, shape (tests,).
    """
    return np.asarray((said - happened) ** 2)


def log_score(said: Floats, happened: Flags) -> Floats:
    """Minus the logarithm of the probability said of what happened.

    Parameters
    ----------
    said, happened : probabilities and outcomes, shape (tests,)

    Returns
    -------
    Scores [nat], shape (tests,).
    """
    sure = np.clip(said, LEAST, 1 - LEAST)
    return np.asarray(-np.log(np.where(happened, sure, 1 - sure)))


def scores_table(
    said: Mapping[str, Floats], happened: Flags, groups: NDArray[np.int64]
) -> pd.DataFrame:
    """Scores of all who said something, the first being ours.

    Parameters
    ----------
    said : probabilities by who said them, shape (tests,) each
    happened, groups : outcomes, and numbers of the input motions whose tests are not independent

    Returns
    -------
    A row for each: ``who``, ``tests``, ``brier``, ``log``, ``right`` (fraction on the right side of one half), and
    ``worse`` with ``worse_lower`` and ``worse_upper``, by how much its logarithmic score is above ours.
    """
    ours = log_score(next(iter(said.values())), happened)
    rows = []
    for who, probabilities in said.items():
        each = log_score(probabilities, happened)
        low, high = mean_limits(each - ours, groups)
        rows.append(
            {
                "who": who,
                "tests": happened.size,
                "brier": float(brier(probabilities, happened).mean()),
                "log": float(each.mean()),
                "right": float(((probabilities >= 0.5) == happened).mean()),
                "worse": float((each - ours).mean()),
                "worse_lower": low,
                "worse_upper": high,
            }
        )
    return pd.DataFrame(rows)


def mean_limits(values: Floats, groups: NDArray[np.int64]) -> tuple[float, float]:
    """Limits of a mean by Student's t over groups whose values are not independent.

    Parameters
    ----------
    values, groups : shape (tests,) each

    Returns
    -------
    Lower and upper limit (90 %).
    """
    # sums of a group vary independently (clustered standard error)
    sums = np.bincount(groups, values - values.mean())
    count = sums.size
    error = np.sqrt((sums**2).sum() * count / max(count - 1, 1)) / values.size
    width = float(stats.t.ppf(0.5 + LEVEL / 2, max(count - 1, 1)) * error)
    return float(values.mean()) - width, float(values.mean()) + width
