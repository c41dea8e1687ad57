"""Log scores of motions (earthquakes) that a curve was not fitted to: they are held out in turn.

In: outcomes or brackets with the number of their group, (n,). Out: a log score a group [-], p values of equal
scores, and fractions of bootstrap samples. Theory: ``docs/fragility.md``, "Which intensity measure?".

Tests under one motion, and motions of one earthquake, hang together; criteria such as AIC count them as
independent and become too sure.  Here whole groups are held out, each group's log score under the curve
of the others is one observation, and two measures are compared group by group.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import special, stats

from rockfrag.fragility.batch_glm import fit_batch
from rockfrag.fragility.censored import Brackets, bracket_log_scores
from rockfrag.fragility.observations import MOST_VALUES, Floats, cells, counts

FOLDS = 20  # groups are held out one by one up to so many, and beyond in so many blocks
WORST_SCORE = -20.0  # log score of an outcome that a curve calls impossible [-]


def outcome_scores(
    logs: Floats,
    overturned: Floats,
    trials: Floats,
    group: NDArray[np.intp],
    fitted: int | None = None,
) -> Floats:
    """Log score of each group's outcomes under the probit fitted to the other folds, (groups,); NaN for one fold.

    Parameters
    ----------
    logs
        Logarithms of one or more measures, shape (n, k), of which the curve knows the first ``fitted``; the others
        only take part in putting tests into cells, so that scores with and without them compare.
    overturned, trials, group : numbers of tests of each row, and its group, shape (n,)
    fitted : number of measures that the curve knows; None for all

    Returns
    -------
    The log scores [-], shape (groups,); NaN for one fold.
    """
    # cells of rows that are near each other in every measure, and their means
    most = (
        int(MOST_VALUES ** (1.0 / logs.shape[1]))
        if len(logs) > MOST_VALUES
        else len(logs)
    )
    parts = [cells(column, most)[0] for column in logs.T]
    cell = np.unique(np.column_stack(parts), axis=0, return_inverse=True)[1].ravel()
    n = np.bincount(cell)
    values = np.column_stack([np.bincount(cell, column) / n for column in logs.T])
    fell, total = counts(group, cell, overturned), counts(group, cell, trials)
    fold = np.arange(len(fell)) % FOLDS
    if fold.max() == 0:
        return np.full(len(fell), np.nan)
    member = (fold == np.arange(fold.max() + 1)[:, None]).astype(np.float64)
    design = np.column_stack([np.ones(len(values)), values[:, :fitted]])
    # the penalty keeps separated folds finite and hardly moves the others
    fits = fit_batch(
        design,
        fell.sum(axis=0) - member @ fell,
        total.sum(axis=0) - member @ total,
        penalised=True,
        tolerance=1e-6,
    )
    eta = np.nan_to_num(fits.coefficients, nan=0.0) @ design.T
    log_fell = np.maximum(special.log_ndtr(eta), WORST_SCORE)[fold]
    log_stood = np.maximum(special.log_ndtr(-eta), WORST_SCORE)[fold]
    return np.asarray((fell * log_fell + (total - fell) * log_stood).sum(axis=1))


def capacity_scores(brackets: Brackets, group: NDArray[np.intp]) -> Floats:
    """Log probability of each group's brackets under the lognormal fitted to the other folds.

    Parameters
    ----------
    brackets, group : bounds of n amplitudes, and the group of each, shape (n,)

    Returns
    -------
    The log scores [-], shape (groups,).
    """
    groups = int(group.max()) + 1
    fold = np.arange(groups) % FOLDS
    if fold.max() == 0:
        return np.full(groups, np.nan)
    weights = (fold[group] != np.arange(fold.max() + 1)[:, None]).astype(np.float64)
    scores = bracket_log_scores(brackets, weights)
    own = np.maximum(scores[fold[group], np.arange(group.size)], WORST_SCORE)
    return np.asarray(np.bincount(group, own, minlength=groups))


def paired_p(best: Floats, other: Floats) -> float:
    """Two-sided p value of equal mean scores, t over the groups [-]; 1 where all agree, NaN of one group.

    Parameters
    ----------
    best, other : log scores by group, shape (groups,)
    """
    difference = best - other
    if difference.size < 2 or np.isnan(difference).any():
        return float("nan")
    if np.ptp(difference) < 1e-12:
        return 1.0
    return float(stats.ttest_1samp(difference, 0.0).pvalue)


def fraction_best(scores: Floats, replicates: int, seed: int) -> Floats:
    """Fraction of bootstrap samples of the groups in which each measure scores best, shape (measures,).

    Parameters
    ----------
    scores : log scores, shape (measures, groups)
    replicates, seed : of the bootstrap
    """
    groups = scores.shape[1]
    rng = np.random.default_rng(seed)
    drawn = rng.multinomial(groups, np.full(groups, 1.0 / groups), size=replicates)
    winner = (scores @ drawn.T).argmax(axis=0)
    return np.asarray(np.bincount(winner, minlength=len(scores)) / replicates)
