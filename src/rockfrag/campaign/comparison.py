"""Simulation against measurement as a referee wants it: fractions with intervals, both errors, rivals, regions."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import stats

from rockfrag.campaign.validation import Bools, Floats, Validated, clustered_error, divisions
from rockfrag.fragility.batch_glm import fit_batch

NEAR_CRITICAL = (0.1, 0.9)
"""A test is near-critical if plausible trials disagree: this fraction of votes or more says each outcome."""

REPEATS = "majority of repeated tests (ceiling)"
"""Who gave these outcomes, in the tables."""


def agreement_row(
    name: str, outcomes: Bools, measured: Bools, groups: NDArray[np.int64], level: float
) -> dict[str, object]:
    """Fraction of right outcomes with an interval (t over the groups), and both errors; repeats are averaged."""
    each = np.atleast_2d(outcomes)
    right = (each == measured).mean(axis=0)
    error = clustered_error(right, groups)
    width = stats.t.ppf(0.5 + level / 2, len(np.unique(groups)) - 1) * error
    fraction = float(right.mean())
    return {
        "who": name,
        "right": fraction,
        "lower": max(0.0, fraction - width),
        "upper": min(1.0, fraction + width),
        "false_alarms": float((each & ~measured).sum(axis=1).mean()),
        "missed": float((~each & measured).sum(axis=1).mean()),
        "tests": len(measured),
    }


def paired_row(
    ours: Bools, theirs: Bools, measured: Bools, groups: NDArray[np.int64], level: float, seed: int
) -> dict[str, float]:
    """How many more tests are right than by a rival, on the same tests.

    Returns ``better`` (difference of the fractions of right outcomes) with ``better_lower`` and ``better_upper``
    (Student's t over the groups) and ``p``: two-sided, by changing the sign of whole groups at random (McNemar's
    test for tests that are not independent).
    """
    difference = (np.atleast_2d(ours) == measured).mean(axis=0) - (
        np.atleast_2d(theirs) == measured
    ).mean(axis=0)
    sums = np.bincount(groups, difference)
    width = stats.t.ppf(0.5 + level / 2, len(sums) - 1) * clustered_error(difference, groups)
    found = stats.permutation_test(
        (sums,),
        np.sum,
        permutation_type="samples",
        n_resamples=9999,
        rng=np.random.default_rng(seed),
    )
    mean = float(difference.mean())
    return {
        "better": mean,
        "better_lower": mean - width,
        "better_upper": mean + width,
        "p": float(found.pvalue),
    }


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
    measures: Floats, overturned: Bools, groups: NDArray[np.int64], **division: int
) -> Bools:
    """Outcomes by thresholds on one or two measures that tests of other motions chose, shape (repeats, tests).

    On two measures the line of even odds of a probit regression on their logarithms takes the place of the
    threshold. ``division`` is that of :func:`rockfrag.campaign.validation.cross_validate`.
    """
    outcomes = np.empty((division["repeats"], len(overturned)), dtype=bool)
    for repeat, chosen_by in divisions(groups, **division):
        known, asked = measures[chosen_by], measures[~chosen_by]
        outcomes[repeat, ~chosen_by] = _predicted(known, overturned[chosen_by], asked)
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


def fragility_beside(
    measure: Floats,
    measured: Bools,
    simulated: Mapping[str, Bools | Floats],
    groups: NDArray[np.int64],
    *,
    level: float,
    replicates: int,
    seed: int,
) -> pd.DataFrame:
    """Lognormal fragility of the measured and of simulated outcomes, with their ratio.

    ``simulated`` has outcomes by name, or the part of votes to overturn, shape (tests,) each; the bootstrap draws
    groups whole. A row per set of outcomes: ``who``, ``theta`` and ``beta`` with limits, and, for simulated ones,
    ``theta_ratio`` and ``beta_ratio`` to the measured curve with limits.
    """
    rng = np.random.default_rng(seed)
    count = int(groups.max()) + 1
    draws = rng.integers(0, count, (replicates, count))
    weights = np.stack([np.bincount(draw, minlength=count)[groups] for draw in draws]).astype(
        np.float64
    )
    weights = np.vstack([np.ones((1, len(measure))), weights])
    curves = {
        name: curves_of(measure, outcomes, weights)
        for name, outcomes in {"measured": measured, **simulated}.items()
    }
    tails = [(1 - level) / 2, (1 + level) / 2]
    rows = []
    for name, curve in curves.items():
        row: dict[str, object] = {"who": name}
        for i, parameter in enumerate(("theta", "beta")):
            row[parameter] = curve[0, i]
            row[f"{parameter}_lower"], row[f"{parameter}_upper"] = _limits(curve[1:, i], tails)
            if name != "measured":
                ratio = curve[:, i] / curves["measured"][:, i]
                row[f"{parameter}_ratio"] = ratio[0]
                limits = _limits(ratio[1:], tails)
                row[f"{parameter}_ratio_lower"], row[f"{parameter}_ratio_upper"] = limits
        rows.append(row)
    return pd.DataFrame(rows)


def _limits(values: Floats, tails: Sequence[float]) -> Floats:
    """Quantiles of what is a number; NaN where no resample gives a curve, as of one kind of outcome."""
    known = values[np.isfinite(values)]
    return np.quantile(known, tails) if known.size else np.full(len(tails), np.nan)


def curves_of(measure: Floats, outcomes: Bools | Floats, weights: Floats) -> Floats:
    """Fit a lognormal curve for each row of weights, (rows, tests): θ and β, (rows, 2); NaN where none rises."""
    design = np.column_stack([np.ones(len(measure)), np.log(measure)])
    coefficients = fit_batch(design, weights * outcomes, weights).coefficients
    slope = np.where(coefficients[:, 1] > 0, coefficients[:, 1], np.nan)
    return np.column_stack([np.exp(-coefficients[:, 0] / slope), 1 / slope])


def by_region(
    tests: pd.DataFrame, first: str, second: str, outcome: Bools, measured: Bools
) -> pd.DataFrame:
    """Thirds of two measures, a row each: limits, ``tests``, ``overturned``, ``simulated``, ``right``."""
    ends, third = {}, {}
    for name in (first, second):
        values = tests[name].to_numpy()
        ends[name] = np.quantile(values, [0, 1 / 3, 2 / 3, 1])
        third[name] = np.clip(np.searchsorted(ends[name], values, side="right") - 1, 0, 2)
    rows = []
    for i in range(3):
        for j in range(3):
            inside = (third[first] == i) & (third[second] == j)
            row: dict[str, object] = {}
            for name, k in ((first, i), (second, j)):
                row[f"{name}_from"], row[f"{name}_to"] = ends[name][k : k + 2]
            row["tests"] = int(inside.sum())
            row["overturned"] = int(measured[inside].sum())
            row["simulated"] = int(outcome[inside].sum())
            row["right"] = (
                float((outcome == measured)[inside].mean()) if inside.any() else float("nan")
            )
            rows.append(row)
    return pd.DataFrame(rows)


def judged_tests(tests: pd.DataFrame, validated: Validated, measured: Bools) -> pd.DataFrame:
    """Each test with its votes, its outcome, whether that is right, and whether it is near-critical."""
    votes = validated.mean_votes
    return tests.assign(
        votes_to_overturn=votes,
        simulated=validated.outcome,
        right=validated.outcome == measured,
        near_critical=(votes > NEAR_CRITICAL[0]) & (votes < NEAR_CRITICAL[1]),
    )


def majority_of_repeats(settings: NDArray[Any], measured: Bools) -> Bools | None:
    """Outcome that most tests at the same setting had, the best that a model can say; None without repeats."""
    code = pd.factorize(settings)[0]
    tests = np.bincount(code)
    if tests.max() < 2:
        return None
    fell = np.bincount(code, measured)
    return np.asarray(2 * fell[code] >= tests[code])
