"""Trials chosen by some motions and judged by others (``docs/campaigns.md``).

A trial that was chosen by a test cannot be judged by it: trials that agree with the tests of four folds about as
well as the best one vote on the fifth.  The best trial alone would follow the noise of the choice.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockfrag.short_repr import short_repr

STANDARD_ERRORS = 2.0
"""A trial is plausible if its fraction of right outcomes is within this many standard errors of the best."""

FEWEST_VOTERS = 10
"""Plausible trials below which votes say little: with ten they are tenths."""

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class Validated:
    """What cross-validation says of each test."""

    # fraction of plausible trials under which the object overturns in each test, chosen by tests with other
    # motions, shape (repeats, tests)
    votes: Floats

    __repr__ = short_repr

    @property
    def outcomes(self) -> Bools:
        """Overturned where at least half of the votes say so, shape (repeats, tests)."""
        return self.votes >= 0.5

    @property
    def mean_votes(self) -> Floats:
        """Votes averaged over the repeats, shape (tests,)."""
        return np.asarray(self.votes.mean(axis=0))

    @property
    def outcome(self) -> Bools:
        """One outcome a test: by the votes averaged over the repeats, shape (tests,)."""
        return self.mean_votes >= 0.5


def folds_by_group(
    groups: NDArray[np.int64], count: int, rng: np.random.Generator
) -> NDArray[np.int64]:
    """Assign each test to a fold such that tests of one group, a number from 0 up, share it."""
    order = rng.permutation(int(groups.max()) + 1)
    return np.asarray(order[groups] % count)


def divisions(
    groups: NDArray[np.int64], *, folds: int, repeats: int, seed: int
) -> Iterator[tuple[int, Bools]]:
    """Yield for each fold of random divisions by group the division, and which tests are outside the fold."""
    rng = np.random.default_rng(seed)
    for repeat in range(repeats):
        fold = folds_by_group(groups, folds, rng)
        for number in range(folds):
            yield repeat, fold != number


def clustered_error(values: Floats, groups: NDArray[np.int64]) -> float:
    """Standard error of a mean whose values share their chance within a group.

    Sum of the groups' deviations (Cameron and Miller, 2015, J. Human Resources 50: 317-372) with the
    correction G/(G - 1) for G groups; NaN for one group.
    """
    sums = np.bincount(groups, values - values.mean())[np.unique(groups)]
    count = len(sums)
    if count < 2:
        return float("nan")
    return float(np.sqrt(count / (count - 1) * np.sum(sums**2)) / len(values))


def plausible_trials(right: Bools, groups: NDArray[np.int64]) -> Bools:
    """Say which trials agree with tests about as well as the best; ``right`` has the shape (trials, tests)."""
    fraction = right.mean(axis=1)
    best = int(fraction.argmax())
    error = clustered_error(right[best].astype(np.float64), groups)
    # with one group there is no standard error, and only the best remain
    slack = STANDARD_ERRORS * error if np.isfinite(error) else 0.0
    return np.asarray(fraction >= fraction[best] - slack - 1e-12)


def cross_validate(
    outcomes: Bools,
    measured: Bools,
    groups: NDArray[np.int64],
    *,
    asked: Bools | None = None,
    **division: int,
) -> Validated:
    """Let trials that are plausible by the tests of other motions vote on each test.

    ``outcomes`` are simulated, shape (trials, tests), ``measured`` has the shape (tests,); ``division`` is that of
    :func:`divisions`. ``asked`` is what the plausible trials vote on, if not the outcomes that they are chosen by.
    """
    right = outcomes == measured
    answers = outcomes if asked is None else asked
    votes = np.empty((division["repeats"], len(measured)))
    for repeat, chosen_by in divisions(groups, **division):
        voters = plausible_trials(right[:, chosen_by], groups[chosen_by])
        votes[repeat, ~chosen_by] = answers[voters][:, ~chosen_by].mean(axis=0)
    return Validated(votes)
