"""Simulation against measurement as a referee wants it: trials chosen by some motions and judged by others.

Trials that agree with the tests of four folds about as well as the best one vote on the fifth.  The best trial
alone would follow the noise of the choice (``docs/campaigns.md``).

In: outcomes of trials × tests, simulated and measured. Out: agreement by fold, votes, ratios of medians θ [-] with
intervals. Theory: ``docs/campaigns.md``, "What is compared".
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import stats

from rockfrag.base.arrays import Flags, Floats
from rockfrag.base.short_repr import short_repr
from rockfrag.fragility.batch_glm import fit_batch

STANDARD_ERRORS = 2.0
"""A trial is plausible if its fraction of right outcomes is within this many standard errors of the best."""

# plausible trials below which votes say little: with ten they are tenths
FEWEST_VOTERS = 10

HALF = 0.5  # an object overturns where at least so many of the votes say so

NEAR_CRITICAL = (0.1, 0.9)
"""A test is near-critical if plausible trials disagree: this fraction of votes or more says each outcome."""

# who gave these outcomes, in the tables
REPEATS = "majority of repeated tests (ceiling)"

REPLICATES = 400
"""Resamples of input motions behind the limits of a fragility and of ratios of fragilities."""


@dataclass(frozen=True)
class MeasuredTests:
    """What a laboratory saw, and how simulated and other outcomes are held against it."""

    overturned: Flags  # shape (tests,)
    # number of each test's input motion, from 0 up, shape (tests,)
    groups: NDArray[np.int64]
    seed: int
    folds: int = 5
    repeats: int = 20  # random divisions into folds
    level: float = 0.9  # of intervals

    __repr__ = short_repr

    def only(self, chosen: Flags) -> "MeasuredTests":
        """Return some of the tests."""
        groups = pd.factorize(self.groups[chosen])[0]
        return replace(self, overturned=self.overturned[chosen], groups=groups)

    def divisions(self) -> Iterator[tuple[int, Flags]]:
        """Yield for each fold the number of the division and the tests that choose its trials, shape (tests,).

        No fold splits a motion: motions are dealt to ``folds`` at random, anew for each of ``repeats`` divisions.
        """
        rng = np.random.default_rng(self.seed)
        for repeat in range(self.repeats):
            fold = rng.permutation(int(self.groups.max()) + 1)[self.groups] % self.folds
            for number in range(self.folds):
                yield repeat, fold != number

    def cross_validate(self, simulated: Flags, asked: Flags | None = None) -> Floats:
        """Let trials that are plausible by the tests of other motions vote on each test.

        Parameters
        ----------
        simulated : outcomes, shape (trials, tests)
        asked : what the plausible trials vote on, of that shape, if not the outcomes that they are chosen by

        Returns
        -------
        Fraction of plausible trials that say so of each test [-], shape (repeats, tests).
        """
        right = simulated == self.overturned
        answers = simulated if asked is None else asked
        votes = np.empty((self.repeats, len(self.overturned)))
        for repeat, chosen_by in self.divisions():
            voters = plausible_trials(right[:, chosen_by], self.groups[chosen_by])
            votes[repeat, ~chosen_by] = answers[voters][:, ~chosen_by].mean(axis=0)
        return votes

    def by_threshold(self, measures: Floats) -> Flags:
        """Outcomes by thresholds on one or two measures that other motions' tests chose.

        On two measures the line of even odds of a probit regression on their logarithms takes the place of the
        threshold.

        Parameters
        ----------
        measures : shape (tests,) or (tests, 2)

        Returns
        -------
        Whether each test overturns by them, shape (repeats, tests).
        """
        outcomes = np.empty((self.repeats, len(self.overturned)), dtype=bool)
        for repeat, chosen_by in self.divisions():
            known, fell = measures[chosen_by], self.overturned[chosen_by]
            asked = ~chosen_by
            if measures.ndim == 1:
                outcomes[repeat, asked] = measures[asked] >= best_threshold(known, fell)
                continue
            failures, trials = fell[None].astype(np.float64), np.ones((1, len(fell)))
            fit = fit_batch(_design(known), failures, trials, penalised=True)
            outcomes[repeat, asked] = (
                _design(measures[asked]) @ fit.coefficients[0] >= 0
            )
        return outcomes

    def agreement(self, name: str, outcomes: Flags) -> dict[str, object]:
        """Fraction of right outcomes with its interval, and both errors, of a set of outcomes.

        Parameters
        ----------
        name : whose they are
        outcomes : shape (tests,), or (repeats, tests), which are averaged

        Returns
        -------
        ``who``, ``right`` with ``lower`` and ``upper`` [-], numbers of ``false_alarms``, ``missed`` and ``tests``.
        """
        each = np.atleast_2d(outcomes)
        right = (each == self.overturned).mean(axis=0)
        fraction, width = float(right.mean()), self._half_width(right)
        return {
            "who": name,
            "right": fraction,
            "lower": max(0.0, fraction - width),
            "upper": min(1.0, fraction + width),
            "false_alarms": float((each & ~self.overturned).sum(axis=1).mean()),
            "missed": float((~each & self.overturned).sum(axis=1).mean()),
            "tests": len(self.overturned),
        }

    def lead(self, ours: Flags, theirs: Flags) -> dict[str, float]:
        """How many more tests are right than by a rival, on the same tests.

        Parameters
        ----------
        ours, theirs : outcomes, shape (tests,) or (repeats, tests)

        Returns
        -------
        ``better`` (difference of the fractions of right outcomes) with ``better_lower`` and ``better_upper`` [-],
            and ``p``: two-sided, by changing the sign of whole groups at random (McNemar's test for tests that are
            not independent).
        """
        right = (np.atleast_2d(ours) == self.overturned).mean(axis=0)
        others = (np.atleast_2d(theirs) == self.overturned).mean(axis=0)
        difference = right - others
        sums = np.bincount(self.groups, difference)
        rng = np.random.default_rng(self.seed)
        found = stats.permutation_test(
            (sums,), np.sum, permutation_type="samples", n_resamples=9999, rng=rng
        )
        mean, width = float(difference.mean()), self._half_width(difference)
        limits = {"better_lower": mean - width, "better_upper": mean + width}
        return {"better": mean, **limits, "p": float(found.pvalue)}

    def _half_width(self, values: Floats) -> float:
        """Half the interval of a mean of values, shape (tests,), by Student's t over the groups."""
        quantile = stats.t.ppf(0.5 + self.level / 2, len(np.unique(self.groups)) - 1)
        return float(quantile * clustered_error(values, self.groups))

    def fragility(
        self, measure: Floats, simulated: Mapping[str, Flags | Floats]
    ) -> pd.DataFrame:
        """Lognormal fragility of the measured and of simulated outcomes, with their ratio.

        The bootstrap draws groups whole.

        Parameters
        ----------
        measure : intensity of each test, shape (tests,)
        simulated : outcomes by name, or the part of votes to overturn [-], shape (tests,) each

        Returns
        -------
        A row per set of outcomes: ``who``, ``theta`` in the unit of the measure and ``beta`` [-] with limits, and,
            for simulated ones, ``theta_ratio`` and ``beta_ratio`` to the measured curve with limits.
        """
        count = int(self.groups.max()) + 1
        draws = np.random.default_rng(self.seed).integers(0, count, (REPLICATES, count))
        drawn = [np.bincount(draw, minlength=count)[self.groups] for draw in draws]
        weights = np.array([np.ones(len(measure)), *drawn])
        measured = curves_of(measure, self.overturned, weights)
        tails, rows = [(1 - self.level) / 2, (1 + self.level) / 2], []
        for name, outcomes in {"measured": self.overturned, **simulated}.items():
            curve = curves_of(measure, outcomes, weights)
            shown = dict(zip(("theta", "beta"), curve.T, strict=True))
            if name != "measured":
                ratio = curve / measured
                shown |= dict(zip(("theta_ratio", "beta_ratio"), ratio.T, strict=True))
            row: dict[str, object] = {"who": name}
            for parameter, values in shown.items():
                row[parameter] = values[0]
                # NaN where no resample gives a curve, as of one kind of outcome
                known = values[1:][np.isfinite(values[1:])]
                limits = np.quantile(known, tails) if known.size else (np.nan, np.nan)
                row[f"{parameter}_lower"], row[f"{parameter}_upper"] = limits
            rows.append(row)
        return pd.DataFrame(rows)


def clustered_error(values: Floats, groups: NDArray[np.int64]) -> float:
    """Standard error of a mean whose values share their chance within a group; NaN for one group.

    Sum of the groups' deviations (Cameron and Miller, 2015, J. Human Resources 50: 317-372) with the correction
    G/(G - 1) for G groups.

    Parameters
    ----------
    values, groups : values, and number of each one's group, shape (n,)
    """
    sums = np.bincount(groups, values - values.mean())[np.unique(groups)]
    count = len(sums)
    if count < 2:
        return float("nan")
    return float(np.sqrt(count / (count - 1) * np.sum(sums**2)) / len(values))


def plausible_trials(right: Flags, groups: NDArray[np.int64]) -> Flags:
    """Trials that agree with tests about as well as the best.

    Parameters
    ----------
    right, groups : whether each prediction is right, shape (trials, tests), and group of each test, shape (tests,)

    Returns
    -------
    Whether each trial is plausible, shape (trials,).
    """
    fraction = right.mean(axis=1)
    best = int(fraction.argmax())
    error = clustered_error(right[best].astype(np.float64), groups)
    # with one group there is no standard error, and only the best remain
    slack = STANDARD_ERRORS * error if np.isfinite(error) else 0.0
    return np.asarray(fraction >= fraction[best] - slack - 1e-12)


def best_threshold(measure: Floats, overturned: Flags) -> float:
    """Return the value of a measure above which "overturned" is right most often, in the measure's unit.

    It lies in the geometric middle between two tests.

    Parameters
    ----------
    measure, overturned : of each test, shape (tests,)
    """
    order = np.argsort(measure, kind="stable")
    values = measure[order]
    # right outcomes, but for a constant, if the first k tests are taken as survived
    first = int(np.cumsum(np.append(0, 1 - 2 * overturned[order])).argmax())
    below, above = np.append(values[0], values), np.append(values, np.inf)
    return float(np.sqrt(below[first] * above[first]))


def _design(measures: Floats) -> Floats:
    """Predictors of a probit: ones and the logarithms of one measure or two, shape (tests, 2 or 3)."""
    return np.column_stack([np.ones(len(measures)), np.log(measures)])


def curves_of(measure: Floats, outcomes: Flags | Floats, weights: Floats) -> Floats:
    """Fit a lognormal curve for each row of weights, (rows, tests): θ and β, (rows, 2); NaN where none rises.

    Parameters
    ----------
    measure, outcomes : values of the measure and outcomes or fractions, shape (tests,)
    weights : of each test, shape (rows, tests)

    Returns
    -------
    θ in the unit of the measure and β [-], shape (rows, 2).
    """
    coefficients = fit_batch(_design(measure), weights * outcomes, weights).coefficients
    slope = np.where(coefficients[:, 1] > 0, coefficients[:, 1], np.nan)
    return np.column_stack([np.exp(-coefficients[:, 0] / slope), 1 / slope])


def by_region(judged: pd.DataFrame, first: str, second: str) -> pd.DataFrame:
    """Thirds of two measures, a row each: limits, ``tests``, ``overturned``, ``simulated``, ``right``.

    Parameters
    ----------
    judged : a row a test, with ``overturned``, ``simulated`` and the measures
    first, second : columns of two measures

    Returns
    -------
    pandas.DataFrame, nine rows at most.
    """
    ends = {
        name: np.quantile(judged[name], [0, 1 / 3, 2 / 3, 1])
        for name in (first, second)
    }
    rows = []
    for thirds in product(range(3), repeat=2):
        inside, row = judged, dict[str, object]()
        for name, k in zip((first, second), thirds, strict=True):
            # number of the third, from 0, that each test lies in
            third = np.searchsorted(ends[name], inside[name], side="right") - 1
            inside = inside[np.clip(third, 0, 2) == k]
            row[f"{name}_from"], row[f"{name}_to"] = ends[name][k : k + 2]
        counts = {name: int(inside[name].sum()) for name in ("overturned", "simulated")}
        rows.append(
            {**row, "tests": len(inside), **counts, "right": inside["right"].mean()}
        )
    return pd.DataFrame(rows)


def majority_of_repeats(settings: NDArray[np.object_], measured: Flags) -> Flags | None:
    """Outcome that most tests at the same setting had, the best that a model can say; None without repeats.

    Parameters
    ----------
    settings, measured : label of the setting and outcome of each test, shape (tests,)

    Returns
    -------
    The outcomes, shape (tests,), or None.
    """
    code = pd.factorize(settings)[0]
    tests = np.bincount(code)
    if tests.max() < 2:
        return None
    fell = np.bincount(code, measured)
    return np.asarray(2 * fell[code] >= tests[code])
