"""Fragility in two intensity measures with what is known of it: interval, interaction, contours, one measure.

Tests under motions of one earthquake depend on each other.  Every statement here therefore takes the earthquake as
the unit: limits by a jackknife that leaves out an earthquake at a time (Tukey 1958), and a score test of the
interaction whose contributions are summed by earthquake (Cameron and Miller 2015, sec. VI).  A likelihood-ratio
test that counts tests as independent finds an interaction that is not there in 7 to 16 of 100 laboratories
(``docs/fragility.md``).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy import special, stats

from rockfrag.errors import InputError
from rockfrag.fragility.batch_glm import fit_batch
from rockfrag.fragility.held_out import outcome_scores
from rockfrag.fragility.intervals import FEWEST_GROUPS, all_but_one, jackknife_error, student
from rockfrag.fragility.observations import Floats, labels, name_and_unit, positive
from rockfrag.fragility.observations import read_observations as read_observations
from rockfrag.fragility.surface import FragilitySurface, design_of, fit_surface

INTERACTION_LEVEL = 0.05
"""Level of the test by which an interaction of the two measures earns its place."""

LARGEST_COEFFICIENT = 60.0
"""A replicate with a larger coefficient is separated; it is fitted with the penalised likelihood."""


@dataclass(frozen=True)
class Interaction:
    """Whether the effect of one measure depends on the other.

    Attributes
    ----------
    p
        p value of no interaction, score test with contributions summed by earthquake [-]; NaN with fewer than
        three earthquakes.
    likelihood_ratio
        2 ln (L with / L without) [-]; tests counted as independent, for comparison with other programs.
    score_gain
        Gain of the mean log score of held-out earthquakes [-]; NaN with one earthquake.
    kept
        Whether the fit has the interaction: p below ``INTERACTION_LEVEL`` and a gain of the score.
    """

    p: float
    likelihood_ratio: float
    score_gain: float
    kept: bool


NOT_TRIED = Interaction(np.nan, np.nan, np.nan, kept=False)
"""Of tests that allow no test of an interaction, or where none was asked for."""


@dataclass(frozen=True)
class VectorFragility:
    """P(overturn | IM1, IM2) with limits over earthquakes.

    Attributes
    ----------
    surface
        The fit: coefficients of 1, ln IM1, ln IM2 and, where it earned its place, ln IM1 ln IM2.
    replicates
        Coefficients without one earthquake each, shape (earthquakes, coefficients).
    interaction
        Test of the interaction.
    n, n_overturned, n_earthquakes
        Tests, those that overturned, and earthquakes.
    level
        Two-sided confidence level of limits.
    warnings
        What a reader must know before using it.
    """

    surface: FragilitySurface
    replicates: Floats
    interaction: Interaction
    n: int
    n_overturned: int
    n_earthquakes: int
    level: float
    warnings: tuple[str, ...]

    @property
    def measures(self) -> tuple[str, str]:
        """Columns of the two measures."""
        first, second = self.surface.measures
        return first, second

    def probability(self, first: ArrayLike, second: ArrayLike) -> Floats:
        """Probability of overturning at values of the two measures, which broadcast [-]."""
        return self.surface.probability(first, second)

    def band(self, first: ArrayLike, second: ArrayLike) -> tuple[Floats, Floats]:
        """Limits of the probability at values of the two measures, which broadcast to one shape [-]."""
        x, y = np.broadcast_arrays(np.log(np.asarray(first)), np.log(np.asarray(second)))
        design = design_of([x.ravel(), y.ravel()], self.interaction.kept)
        centre = (design @ np.array(self.surface.coefficients)).reshape(x.shape)
        half = self._half_width(self.replicates @ design.T).reshape(x.shape)
        return np.asarray(special.ndtr(centre - half)), np.asarray(special.ndtr(centre + half))

    def contour(
        self, probability: float, second: ArrayLike, of: int = 0
    ) -> tuple[Floats, Floats, Floats]:
        """Value of one measure at which overturning has a probability, at given values of the other.

        Parameters
        ----------
        probability
            Between 0 and 1 [-].
        second
            Values of the other measure, shape (n,).
        of
            Which measure is asked for: 0 the first, 1 the second.

        Returns
        -------
        value, lower, upper
            The contour and its limits, each of shape (n,); NaN where the probability does not rise with the
            measure, limits of 0 and infinity where the earthquakes set none.
        """
        other = np.log(np.atleast_1d(np.asarray(second, dtype=np.float64)))
        centre = _log_contour(
            np.array([self.surface.coefficients]), probability, other, of, self.interaction.kept
        )[0]
        left_out = _log_contour(self.replicates, probability, other, of, self.interaction.kept)
        half = self._half_width(left_out)
        return np.exp(centre), np.exp(centre - half), np.exp(centre + half)

    def mean_over(self, first: ArrayLike, second: ArrayLike, weights: ArrayLike = 1.0) -> Floats:
        """Probability in the first measure alone: the mean over the second one's values of a set of records.

        Parameters
        ----------
        first
            Values of the first measure, shape (n,).
        second
            Values of the second one by record, shape (records,), or (n, records) where they change with the first.
        weights
            Weight of each record, shape (records,).

        Returns
        -------
        Array of shape (n,).
        """
        x = np.atleast_1d(np.asarray(first, dtype=np.float64))[:, np.newaxis]
        y = np.asarray(second, dtype=np.float64)
        w = np.broadcast_to(np.asarray(weights, dtype=np.float64), y.shape[-1:])
        return np.asarray(self.probability(x, y) @ w / w.sum())

    def _half_width(self, left_out: Floats) -> Floats:
        """Half the width of limits, from values without one earthquake each; infinite where there are none."""
        if len(left_out) < 2:
            return np.full(left_out.shape[1], np.inf)
        half = student(self.level, len(left_out)) * jackknife_error(left_out)
        return np.where(np.isfinite(half), half, np.inf)


def _log_contour(
    coefficients: Floats, probability: float, other: Floats, of: int, interaction: bool
) -> Floats:
    """Logarithm of the measure asked for, shape (fits, n); NaN where the probability does not rise with it."""
    c = coefficients.T[:, :, np.newaxis]
    product = c[3] if interaction else 0.0
    slope = c[1 + of] + product * other
    level = float(stats.norm.ppf(probability)) - c[0] - c[2 - of] * other
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(slope > 0, level / slope, np.nan))


def fit_vector(
    table: pd.DataFrame,
    measures: tuple[str, str],
    *,
    overturned: str = "overturned",
    earthquake: str | None = "earthquake",
    level: float = 0.90,
    source: str = "table",
    try_interaction: bool = True,
) -> VectorFragility:
    """Fit the probability of overturning in two intensity measures.

    Parameters
    ----------
    table
        One row a test.
    measures
        Columns of the two measures, such as ``pga_g`` and ``pgv_over_pga_s``.
    overturned
        Column with the outcomes (0 or 1).
    earthquake
        Column with the earthquake of each test; None where each test is one of its own.
    level
        Two-sided confidence level of limits [-].
    source
        What messages call the table.
    try_interaction
        Whether to test an interaction, which takes most of the time; without it none is kept.

    Returns
    -------
    VectorFragility
        The fit, with replicates by earthquake and the test of an interaction.

    Raises
    ------
    InputError
        If a value is missing or out of range, all tests agree, or the measures are proportional to each other.
    """
    if not 0.0 < level < 1.0:
        raise InputError(f"level: a confidence level lies between 0 and 1, got {level:g}.")
    plain = fit_surface(table, measures, overturned=overturned, source=source)
    logs = [np.log(positive(table, column, source)) for column in measures]
    outcome = read_observations(table, overturned, source)
    group = pd.factorize(pd.Series(labels(table, earthquake, source)))[0]
    interaction = NOT_TRIED
    if try_interaction:
        interaction = _interaction(table, plain, logs, outcome, group, overturned, source)
    surface = plain
    if interaction.kept:
        surface = fit_surface(
            table, measures, interaction=True, overturned=overturned, source=source
        )
    design = design_of(logs, interaction.kept)
    groups = int(group.max()) + 1
    replicates = _replicates(design, outcome, group, np.array(surface.coefficients))
    return VectorFragility(
        surface,
        replicates,
        interaction,
        int(outcome.size),
        int(outcome.sum()),
        groups,
        level,
        _notes(surface, replicates, groups),
    )


def _replicates(design: Floats, outcome: Floats, group: NDArray[np.intp], start: Floats) -> Floats:
    """Coefficients without one earthquake (or block of many) each; empty with one earthquake."""
    groups = int(group.max()) + 1
    if groups < 2:
        return np.empty((0, design.shape[1]))
    weights = all_but_one(groups, 0)[:, group]
    fit = fit_batch(design, weights * outcome, weights, start=start)
    coefficients = fit.coefficients.copy()
    wild = ~fit.converged | ~(np.abs(coefficients) < LARGEST_COEFFICIENT).all(axis=1)
    if wild.any():
        again = fit_batch(design, (weights * outcome)[wild], weights[wild], penalised=True)
        coefficients[wild] = again.coefficients
    return coefficients


def _interaction(
    table: pd.DataFrame,
    plain: FragilitySurface,
    logs: Sequence[Floats],
    outcome: Floats,
    group: NDArray[np.intp],
    overturned: str,
    source: str,
) -> Interaction:
    """Test whether the product of the logarithms adds to the fit without it."""
    design = design_of(logs, interaction=True)
    if np.linalg.matrix_rank(design) < 4 or "penalised" in plain.method:
        return NOT_TRIED
    p = interaction_p(np.array(plain.coefficients), design, outcome, group)
    full = fit_surface(
        table, plain.measures, interaction=True, overturned=overturned, source=source
    )
    ratio = 2.0 * (full.log_likelihood - plain.log_likelihood)
    ones = np.ones(outcome.size)
    predictors = design[:, 1:]
    gain = (
        outcome_scores(predictors, outcome, ones, group)
        - outcome_scores(predictors, outcome, ones, group, fitted=2)
    ).sum() / outcome.size
    kept = bool(p < INTERACTION_LEVEL and gain > 0 and "penalised" not in full.method)
    return Interaction(p, ratio, float(gain), kept)


def interaction_p(
    coefficients: Floats, design: Floats, outcome: Floats, group: NDArray[np.intp]
) -> float:
    """Two-sided p value of the last column of a probit design, by a score test over groups of dependent tests [-].

    The efficient score of the last column, with what the others explain of it taken out, is summed by group;
    Student's t of these sums has one degree of freedom less than there are groups.  NaN with fewer than three
    groups.  ``coefficients``, shape (k - 1,), are those of the fit without the last column.
    """
    groups = int(group.max()) + 1
    if groups < 3:
        return float("nan")
    others, last = design[:, :-1], design[:, -1]
    eta = np.clip(others @ coefficients, -8.0, 8.0)
    density = stats.norm.pdf(eta)
    variance = special.ndtr(eta) * special.ndtr(-eta)
    weighted = others * (density**2 / variance)[:, np.newaxis]
    left = last - others @ np.linalg.solve(weighted.T @ others, weighted.T @ last)
    score = np.bincount(group, left * (outcome - special.ndtr(eta)) * density / variance)
    spread = float(np.sqrt(groups * score.var(ddof=1)))
    if spread == 0:
        return float("nan")
    return float(2.0 * stats.t.sf(abs(score.sum()) / spread, groups - 1))


def _notes(surface: FragilitySurface, replicates: Floats, groups: int) -> tuple[str, ...]:
    notes = []
    if "penalised" in surface.method:
        notes.append(
            "A line in the two measures separates all tests that overturned from those that survived: the fit is "
            "penalised, and how steep it is remains open."
        )
    if groups < 2:
        notes.append("All tests come from one earthquake: there are no limits for others.")
    elif groups < FEWEST_GROUPS:
        notes.append(
            f"Limits from {groups} earthquakes were not validated ({FEWEST_GROUPS} are the fewest that were)."
        )
    for at, column in enumerate(surface.measures):
        slopes = replicates[:, 1 + at]
        if surface.coefficients[1 + at] <= 0:
            notes.append(
                f"The probability does not rise with {name_and_unit(column)[0]} at given other measure; there "
                "is no contour in it."
            )
        elif len(slopes) and (slopes <= 0).any():
            notes.append(
                f"Whether the probability rises with {name_and_unit(column)[0]} hangs on single earthquakes."
            )
    return tuple(notes)
