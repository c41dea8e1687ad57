"""Fragility in two intensity measures: fit, limits, interaction, contours, goodness of fit, tables.

P(overturn | IM1, IM2) = Φ(c0 + c1 ln IM1 + c2 ln IM2 + c12 ln IM1 ln IM2). Every statement takes the earthquake as
the unit: limits by a jackknife that leaves out an earthquake at a time (Tukey 1958), and a score test of the
interaction summed by earthquake (Cameron and Miller 2015, sec. VI).

In: a table of tests, a row a test, with two columns of measures. Out: :class:`VectorFragility` and its
:class:`VectorChecks`, or the tidy :class:`VectorTables`. Theory: ``docs/fragility.md``, "Two intensity measures".
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy import optimize, special, stats

from rockfrag.base.errors import InputError
from rockfrag.fragility import observations
from rockfrag.fragility.batch_glm import fit_batch
from rockfrag.fragility.checks import binned_deviance, refitted_deviance
from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.fragility.held_out import outcome_scores
from rockfrag.fragility.intervals import FEWEST_GROUPS, all_but_one, half_width
from rockfrag.fragility.observations import Floats

MOST_FOR_THE_PLANE = 20_000
"""Tests up to which separation is found exactly; a linear programme of more takes too long."""

INTERACTION_LEVEL = 0.05
"""Level of the test by which an interaction of the two measures earns its place."""

LARGEST_COEFFICIENT = 60.0
"""A replicate with a larger coefficient is separated; it is fitted with the penalised likelihood."""


@dataclass(frozen=True)
class Interaction:
    """Whether the effect of one measure depends on the other.

    Attributes
    ----------
    p : p value of no interaction, score test summed by earthquake [-]; NaN with fewer than three earthquakes
    likelihood_ratio : 2 ln (L with / L without) [-], tests counted as independent as in other programs
    kept : whether the fit has it: p below ``INTERACTION_LEVEL``, and held-out earthquakes score better
    """

    p: float
    likelihood_ratio: float
    kept: bool


@dataclass(frozen=True)
class VectorFragility:
    """P(overturn | IM1, IM2) with limits over earthquakes.

    Attributes
    ----------
    measures : columns of the two measures
    coefficients, covariance
        Of 1, ln IM1, ln IM2 and, where it earned its place, ln IM1 ln IM2; the covariance is from the expected
        information, which takes tests for independent.
    log_likelihood, method, interaction : of the fit, and the test of an interaction
    replicates : coefficients without one earthquake each, shape (earthquakes, coefficients)
    n, n_overturned, n_earthquakes : tests, those that overturned, and earthquakes
    level, warnings : two-sided confidence level of limits, and what a reader must know before using it
    """

    measures: tuple[str, str]
    coefficients: tuple[float, ...]
    covariance: tuple[tuple[float, ...], ...]
    log_likelihood: float
    method: str
    replicates: Floats
    interaction: Interaction
    n: int
    n_overturned: int
    n_earthquakes: int
    level: float
    warnings: tuple[str, ...]

    @property
    def aic(self) -> float:
        """Akaike's criterion of the fit."""
        return 2.0 * len(self.coefficients) - 2.0 * self.log_likelihood

    def probability(self, first: ArrayLike, second: ArrayLike) -> Floats:
        """Probability of overturning at values of the two measures, which broadcast [-]."""
        x = np.log(np.asarray(first, np.float64))
        y = np.log(np.asarray(second, np.float64))
        slopes = zip(self.coefficients[1:], (x, y, x * y), strict=False)
        return np.asarray(
            special.ndtr(sum((c * v for c, v in slopes), self.coefficients[0]))
        )

    def contour(
        self, probability: float, second: ArrayLike, of: int = 0
    ) -> tuple[Floats, Floats, Floats]:
        """Values of one measure at which overturning has a probability, at values of the other, with limits.

        Parameters
        ----------
        probability : of overturning [-]
        second : values of the other measure, shape (n,)
        of : measure that is asked for, 0 the first, 1 the second

        Returns
        -------
        Value, lower and upper limit, shape (n,) each; the value is NaN where the probability does not rise with
            the measure, limits are 0 and infinity where the earthquakes set none.
        """
        other = np.log(np.atleast_1d(np.asarray(second, dtype=np.float64)))
        # Φ⁻¹(p) = c0 + c1 x + c2 y + c12 x y is linear in the logarithm sought;
        # of the fit and of those without an earthquake each, (coefficients, fits, 1)
        c = np.vstack([self.coefficients, self.replicates]).T[:, :, np.newaxis]
        slope = c[1 + of] + (c[3] if self.interaction.kept else 0.0) * other
        level = float(stats.norm.ppf(probability)) - c[0] - c[2 - of] * other
        with np.errstate(divide="ignore", invalid="ignore"):
            logs = np.where(slope > 0, level / slope, np.nan)
        centre, left_out = logs[0], logs[1:]
        half = np.full(other.shape, np.inf)
        if len(left_out) > 1:
            half = half_width(left_out, self.level)
        # where a slope nearly vanishes a limit is beyond all numbers
        with np.errstate(over="ignore"):
            return np.exp(centre), np.exp(centre - half), np.exp(centre + half)

    def mean_over(self, first: ArrayLike, second: ArrayLike) -> Floats:
        """Probability in the first measure alone, (n,): the mean over the second one's values of some records.

        ``second`` has the shape (records,), or (n, records) where it changes with the first.
        """
        x = np.atleast_1d(np.asarray(first, dtype=np.float64))[:, np.newaxis]
        return np.asarray(self.probability(x, np.asarray(second)).mean(axis=-1))


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
    table, measures : one row a test, and the columns of the two measures, such as ``pga_g`` and ``pgv_over_pga_s``
    overturned, earthquake
        Columns of outcome (0 or 1) and earthquake; None where each test has an earthquake of its own.
    level, source, try_interaction
        Two-sided confidence level of limits [-]; what messages call the table; whether to test an interaction,
        which takes most of the time: without it none is kept.

    Returns
    -------
    The :class:`VectorFragility`, with replicates by earthquake.
    """
    if not 0.0 < level < 1.0:
        raise InputError(
            f"level: a confidence level lies between 0 and 1, got {level:g}."
        )
    logs = [np.log(observations.positive(table, column, source)) for column in measures]
    outcome = observations.read_observations(table, overturned, source)
    if outcome.min() == outcome.max():
        raise InputError(
            f"{source}, column {overturned!r}: all {outcome.size} tests have the outcome "
            f"{outcome[0]:g}; a surface needs both."
        )
    design = design_of(logs, interaction=False)
    if np.linalg.matrix_rank(design) < 3:
        raise InputError(
            f"{source}: the measures {', '.join(measures)} are proportional to each other (or "
            "constant) in these tests; choose fewer."
        )
    group = pd.factorize(pd.Series(observations.labels(table, earthquake, source)))[0]
    fit, interaction = _fitted(design, outcome), Interaction(np.nan, np.nan, kept=False)
    product = design_of(logs, interaction=True)
    is_estimable = np.linalg.matrix_rank(product) == 4 and "penalised" not in fit.method
    if try_interaction and is_estimable:
        full = _fitted(product, outcome)
        interaction = _interaction(fit, full, product, outcome, group)
        if interaction.kept:
            fit, design = full, product
    groups = int(group.max()) + 1
    replicates = _replicates(design, outcome, group, fit.coefficients)
    names = [observations.name_and_unit(column)[0] for column in measures]
    covariance = np.linalg.inv(fit.information).tolist()
    return VectorFragility(
        measures,
        coefficients=tuple(fit.coefficients.tolist()),
        covariance=tuple(tuple(row) for row in covariance),
        log_likelihood=fit.log_likelihood,
        method=fit.method,
        replicates=replicates,
        interaction=interaction,
        n=int(outcome.size),
        n_overturned=int(outcome.sum()),
        n_earthquakes=groups,
        level=level,
        warnings=tuple(_notes(names, fit, replicates, groups)),
    )


def _notes(names: list[str], fit: "_Fit", replicates: Floats, groups: int) -> list[str]:
    """Warnings about a fit in two measures, a sentence each.

    ``names``: of the measures; ``replicates``: coefficients without each earthquake, shape (earthquakes,
    coefficients); ``groups``: number of earthquakes.
    """
    notes = []
    if "penalised" in fit.method:
        notes.append(
            "A line in the two measures separates all tests that overturned from those that survived: the fit is "
            "penalised, and how steep it is remains open."
        )
    if groups < 2:
        notes.append(
            "All tests come from one earthquake: there are no limits for others."
        )
    elif groups < FEWEST_GROUPS:
        notes.append(
            f"Limits from {groups} earthquakes were not validated ({FEWEST_GROUPS} are the fewest that were)."
        )
    for k, name in enumerate(names, start=1):
        if fit.coefficients[k] <= 0:
            notes.append(
                f"The probability does not rise with {name} at given other measure; there is no contour in it."
            )
        elif (replicates[:, k] <= 0).any():
            notes.append(
                f"Whether the probability rises with {name} hangs on single earthquakes."
            )
    return notes


class _Fit(NamedTuple):
    """Probit of a design: coefficients, (k,), their expected information, (k, k), and how they were found."""

    coefficients: Floats
    information: Floats
    log_likelihood: float
    method: str


def _fitted(design: Floats, outcome: Floats) -> _Fit:
    """Fit a probit; under separation (found exactly, by linear programming) the likelihood is penalised.

    ``design``: predictors, shape (tests, k); ``outcome``: 1 for overturned, shape (tests,).
    """
    fell, trials = outcome[None, :], np.ones((1, outcome.size))
    # among so many tests no plane parts what a fit does not find parted
    apart = outcome.size <= MOST_FOR_THE_PLANE and linearly_separable(design, outcome)
    fit = fit_batch(design, fell, trials, penalised=apart, tolerance=1e-11)
    method = "probit, maximum likelihood"
    if not apart and not fit.converged[0]:
        apart = True
        fit = fit_batch(design, fell, trials, penalised=True, tolerance=1e-11)
    if apart:
        method = "probit, penalised likelihood (Firth)"
    eta = design @ fit.coefficients[0]
    log_likelihood = float(special.log_ndtr(np.where(outcome > 0, eta, -eta)).sum())
    return _Fit(fit.coefficients[0], fit.information[0], log_likelihood, method)


def design_of(logs: list[Floats], interaction: bool) -> Floats:
    """Return the predictors: ones, the logarithms of the measures and, if asked for, their product.

    Parameters
    ----------
    logs : ln of the measures, shape (tests,) each
    interaction : whether the product is wanted

    Returns
    -------
    The predictors, shape (tests, 3) or (tests, 4).
    """
    product = [logs[0] * logs[1]] if interaction else []
    return np.column_stack([np.ones(logs[0].size), *logs, *product])


def linearly_separable(design: Floats, outcome: Floats) -> bool:
    """Tell whether a plane parts overturned from survived tests (ties on the plane allowed).

    Solves for the direction c, |c| ≤ 1, that maximises Σ s x·c subject to s x·c ≥ 0, with s = ±1 the outcome; a
    maximum above zero means separation (Konis, 2007, ch. 4).

    Parameters
    ----------
    design : predictors x, shape (tests, k)
    outcome : 1 for overturned, 0 for survived, shape (tests,)
    """
    signed = np.where(outcome > 0, 1.0, -1.0)[:, None] * design
    found = optimize.linprog(
        -signed.sum(axis=0),
        A_ub=-signed,
        b_ub=np.zeros(len(signed)),
        bounds=(-1.0, 1.0),
    )
    return bool(-found.fun > 1e-9)


def _replicates(
    design: Floats, outcome: Floats, group: NDArray[np.intp], start: Floats
) -> Floats:
    """Coefficients without one earthquake (or block of many) each, shape (earthquakes, k); empty with one alone.

    Parameters
    ----------
    design : predictors, shape (tests, k)
    outcome, group : 1 for overturned, and number of the earthquake, shape (tests,)
    start : coefficients of the fit to all, shape (k,)
    """
    groups = int(group.max()) + 1
    if groups < 2:
        return np.empty((0, design.shape[1]))
    weights = all_but_one(groups)[:, group]
    fit = fit_batch(design, weights * outcome, weights, start=start)
    coefficients = fit.coefficients.copy()
    wild = ~fit.converged | ~(np.abs(coefficients) < LARGEST_COEFFICIENT).all(axis=1)
    if wild.any():
        again = fit_batch(
            design, (weights * outcome)[wild], weights[wild], penalised=True
        )
        coefficients[wild] = again.coefficients
    return coefficients


def _interaction(
    plain: _Fit, full: _Fit, design: Floats, outcome: Floats, group: NDArray[np.intp]
) -> Interaction:
    """Test whether the product of the logarithms, the last column, adds to the fit without it.

    The p value is two-sided, of a score test over groups of dependent tests: the efficient score of the product,
    with what the others explain of it taken out, is summed by group; Student's t of these sums has one degree of
    freedom less than there are groups.

    Parameters
    ----------
    plain, full : fits without and with the product
    design : predictors with the product, shape (tests, 4)
    outcome, group : 1 for overturned, and number of the earthquake, shape (tests,)
    """
    groups, p = int(group.max()) + 1, float("nan")
    others, last = design[:, :-1], design[:, -1]
    if groups > 2:
        eta = np.clip(others @ plain.coefficients, -8.0, 8.0)
        density = stats.norm.pdf(eta)
        variance = special.ndtr(eta) * special.ndtr(-eta)
        weighted = others * (density**2 / variance)[:, np.newaxis]
        # of the product, what a weighted regression on the others leaves
        left = last - others @ np.linalg.solve(weighted.T @ others, weighted.T @ last)
        score = np.bincount(
            group, left * (outcome - special.ndtr(eta)) * density / variance
        )
        spread = float(np.sqrt(groups * score.var(ddof=1)))
        if spread != 0:
            p = float(2.0 * stats.t.sf(abs(score.sum()) / spread, groups - 1))
    ratio = 2.0 * (full.log_likelihood - plain.log_likelihood)
    scores_of = partial(
        outcome_scores, design[:, 1:], outcome, np.ones(outcome.size), group
    )
    # log score of held-out earthquakes with all columns, less that with the two measures alone
    gain = (scores_of() - scores_of(fitted=2)).sum()
    kept = bool(p < INTERACTION_LEVEL and gain > 0 and "penalised" not in full.method)
    return Interaction(p, ratio, kept)


# bins of the fitted probability in which observed and fitted numbers are compared
BINS = 10
MOST_CELLS = 12  # cells of each measure in the non-parametric surface
TOLERANCE = 1e-9
"""Change of a probability at which the alternating projections of the surface end [-]."""

MOST_DRAWN = 4_000_000  # outcomes that are drawn at once, which bounds the memory

MOST_CYCLES = 5_000  # cycles of alternating projections; some hundreds are usual


@dataclass(frozen=True)
class VectorChecks:
    """Test of fit and non-parametric surface of a fragility in two measures.

    Attributes
    ----------
    p_fit : p value of the hypothesis that the fit describes the outcomes, by parametric bootstrap [-]
    surface
        A row per cell of the two measures that has tests: the measures' columns (geometric means of the cell's
        row and column), ``tests``, ``overturned``, ``probability`` (rising in both measures) and ``fitted``.
    """

    p_fit: float
    surface: pd.DataFrame

    @property
    def rejected(self) -> bool:
        """Whether the fit does not describe its outcomes."""
        return self.p_fit < REJECTED


def check_vector(
    fit: VectorFragility,
    table: pd.DataFrame,
    *,
    overturned: str = "overturned",
    motion: str | None = "motion",
    replicates: int = 200,
    seed: int = 0,
) -> VectorChecks:
    """Judge a fragility in two measures by the outcomes that it was fitted to.

    Parameters
    ----------
    fit, table : the fit and its table, one row a test
    overturned, motion : columns of the outcome and of the motion, which has one capacity; None for one a test
    replicates, seed : of the parametric bootstrap

    Returns
    -------
    The :class:`VectorChecks`.
    """
    logs = [np.log(observations.positive(table, column)) for column in fit.measures]
    outcome = observations.read_observations(table, overturned)
    design = design_of(logs, fit.interaction.kept)
    eta = design @ np.array(fit.coefficients)
    # bins with about equally many tests, in order of the fitted probability
    bins, values = observations.cells(eta, BINS)
    bins = bins if values.size > 1 else np.zeros(eta.size, dtype=np.intp)
    motions = pd.factorize(pd.Series(observations.labels(table, motion, "table")))[0]
    fell = np.bincount(bins, outcome).astype(np.float64)
    expected = np.bincount(bins, special.ndtr(eta)).astype(np.float64)
    number = np.bincount(bins).astype(np.float64)
    own = binned_deviance(fell, expected, number)
    # each motion has one capacity, in standard deviations of ln capacity, by which all of its tests fall or stand
    capacity = np.random.default_rng(seed).normal(
        size=(replicates, int(motions.max()) + 1)
    )
    simulated = _simulated_deviances(design, eta, bins, capacity, motions)
    p_fit = float((1 + np.sum(simulated >= own - 1e-9)) / (1 + simulated.size))
    return VectorChecks(p_fit, _surface_table(fit, logs, outcome))


def _simulated_deviances(
    design: Floats,
    eta: Floats,
    bins: NDArray[np.intp],
    capacity: Floats,
    motions: NDArray[np.intp],
) -> Floats:
    """Deviances of the bins when the fit is true, each after a fit of its own, shape (replicates,).

    Parameters
    ----------
    design, eta : design matrix, shape (tests, coefficients), and fitted probit of each test [-]
    bins, motions : of each test
    capacity : of each motion in standard deviations, shape (replicates, motions)
    """
    at_once = max(MOST_DRAWN // eta.size, 1)
    found = []
    for begin in range(0, len(capacity), at_once):
        falls = eta > capacity[begin : begin + at_once, motions]
        overturned = falls.astype(np.float64)
        found.append(refitted_deviance(design, overturned, np.ones(eta.size), bins))
    return np.concatenate(found)


def _surface_table(
    fit: VectorFragility, logs: list[Floats], outcome: Floats
) -> pd.DataFrame:
    """Tests by cell of both measures, with the observed and the fitted probability: ``VectorChecks.surface``.

    ``logs``: ln of both measures, shape (tests,) each; ``outcome``: 1 for overturned, shape (tests,).
    """
    row, first = observations.cells(logs[0], MOST_CELLS)
    column, second = observations.cells(logs[1], MOST_CELLS)
    tests = observations.counts(row, column, np.ones(outcome.size))
    fell = observations.counts(row, column, outcome)
    probability = monotone_probability(fell, tests)
    i, j = np.nonzero(tests)
    x, y = np.exp(first[i]), np.exp(second[j])
    return pd.DataFrame(
        {
            fit.measures[0]: x,
            fit.measures[1]: y,
            "tests": tests[i, j].astype(np.int64),
            "overturned": fell[i, j].astype(np.int64),
            "probability": probability[i, j],
            "fitted": fit.probability(x, y),
        }
    )


def monotone_probability(overturned: Floats, tests: Floats) -> Floats:
    """Probability of overturning by cell that rises along rows and columns and is closest to what was observed.

    Weighted least squares under both orders, by alternating projections (Dykstra and Robertson 1982, Annals of
    Statistics 10: 708-716).

    Parameters
    ----------
    overturned, tests : numbers of tests by cell, shape (rows, columns); cells without tests follow their
        neighbours

    Returns
    -------
    The probability [-], shape (rows, columns).
    """
    weight = np.maximum(tests, 1e-9)
    value = np.where(tests > 0, overturned / weight, overturned.sum() / tests.sum())
    by_row, by_column = np.zeros_like(value), np.zeros_like(value)
    for _ in range(MOST_CYCLES):
        # each projection starts from the last one with what the same projection took away before
        along = _rising(value + by_row, weight)
        by_row = value + by_row - along
        across = _rising((along + by_column).T, weight.T).T
        by_column = along + by_column - across
        moved = float(np.abs(across - value).max())
        value = across
        if moved < TOLERANCE:
            break
    return np.asarray(np.clip(value, 0.0, 1.0))


def _rising(values: Floats, weights: Floats) -> Floats:
    """Isotonic regression of each row: the closest values that never fall, shape (rows, columns).

    ``values``, ``weights``: shape (rows, columns).
    """
    pairs = zip(values, weights, strict=True)
    return np.array([optimize.isotonic_regression(v, weights=w).x for v, w in pairs])


# probabilities of overturning of which contours are given [-]
PROBABILITIES = (0.1, 0.5, 0.9)
POINTS = 40  # points of a contour, over the values of the second measure
MOST_TESTS = 100_000
"""Tests of one fit; of more every so many-th is taken, which changes limits over earthquakes little."""

FITS = (
    "first",
    "second",
    "c0",
    "c1",
    "c2",
    "c12",
    "aic",
    "tests",
    "overturned",
    "earthquakes",
    "p_interaction",
    "likelihood_ratio",
    "p_fit",
    "method",
    "warnings",
)
CONTOURS = ("first", "second", "probability", "of", "at", "value", "lower", "upper")
CELLS = (
    "first",
    "second",
    "at_first",
    "at_second",
    "tests",
    "overturned",
    "probability",
    "fitted",
)


@dataclass(frozen=True)
class VectorTables:
    """Tidy tables of fits in two measures."""

    # a row a fit: the labels given, the columns of the two measures, coefficients of 1, ln first, ln
    # second and their product (0 where it earned no place), AIC, numbers, p values and warnings
    fits: pd.DataFrame
    # a row a point: the value of the measure ``of`` (``value``, with limits ``lower`` and ``upper``)
    # at which overturning has ``probability``, where the other one is ``at``.  ``of`` is the measure
    # that decides more over the tests: the contour may run along the other one
    contours: pd.DataFrame
    # a row a cell of the two measures: tests, those that overturned, the probability that rises in
    # both measures, and the fitted one
    cells: pd.DataFrame


def vector_tables(
    tests: Mapping[str, pd.DataFrame],
    pairs: tuple[tuple[str, str], ...],
    *,
    label: str = "configuration",
    earthquake: str | None = "earthquake",
    motion: str | None = "motion",
    level: float = 0.90,
    seed: int = 0,
) -> VectorTables:
    """Fit every pair of measures to every table of tests; ``warnings`` say which fits are not possible.

    Parameters
    ----------
    tests, pairs : tables of tests by name, a row a test, and the pairs of their columns of measures
    label : column of the result that has the names of the tables
    earthquake, motion : columns of labels; None where each test is one of its own
    level, seed : of limits [-], and of the test of fit

    Returns
    -------
    The :class:`VectorTables`.
    """
    fits: list[dict[str, object]] = []
    contours, cells = [], []
    for name, table in tests.items():
        every = math.ceil(len(table) / MOST_TESTS)
        used = table.iloc[::every]
        for pair in pairs:
            about = {label: name, "first": pair[0], "second": pair[1]}
            try:
                fit = fit_vector(
                    used, pair, earthquake=earthquake, level=level, source=name
                )
            except InputError as error:
                fits.append({**about, "method": "none", "warnings": str(error)})
                continue
            checks = check_vector(fit, used, motion=motion, seed=seed)
            fits.append({**about, **_fit_row(fit, checks)})
            contours.append(_contours(fit, used).assign(**about))
            # measures are named alike for every pair, whose tables are joined
            alike = {pair[0]: "at_first", pair[1]: "at_second"}
            surface = checks.surface.rename(columns=alike)
            cells.append(surface.assign(**about))
    return VectorTables(
        pd.DataFrame(fits, columns=[label, *FITS]),
        _joined(contours, [label, *CONTOURS]),
        _joined(cells, [label, *CELLS]),
    )


def _fit_row(fit: VectorFragility, checks: VectorChecks) -> dict[str, object]:
    """Columns of ``FITS`` behind the two measures; a product that earned no place has the coefficient 0."""
    c0, c1, c2, c12 = (*fit.coefficients, 0.0)[:4]
    return {
        "c0": c0,
        "c1": c1,
        "c2": c2,
        "c12": c12,
        "aic": fit.aic,
        "tests": fit.n,
        "overturned": fit.n_overturned,
        "earthquakes": fit.n_earthquakes,
        "p_interaction": fit.interaction.p,
        "likelihood_ratio": fit.interaction.likelihood_ratio,
        "p_fit": checks.p_fit,
        "method": fit.method,
        "warnings": " ".join(fit.warnings),
    }


def _joined(parts: list[pd.DataFrame], columns: list[str]) -> pd.DataFrame:
    """Tables one below the other with these columns; without parts a table without rows."""
    if not parts:
        return pd.DataFrame(columns=columns)
    return pd.concat(parts, ignore_index=True)[columns]


def _contours(fit: VectorFragility, tests: pd.DataFrame) -> pd.DataFrame:
    """Lines of one probability each, a row a point, with the columns of ``CONTOURS`` behind both measures.

    The value is that of the measure which decides more over the tests: the one whose ln, times its coefficient,
    scatters more.
    """
    logs = np.log(tests[list(fit.measures)].to_numpy(dtype=np.float64))
    of = int(np.argmax(np.array(fit.coefficients[1:3]) * logs.std(axis=0)))
    other = np.exp(np.linspace(logs[:, 1 - of].min(), logs[:, 1 - of].max(), POINTS))
    parts = []
    for probability in PROBABILITIES:
        value, lower, upper = fit.contour(probability, other, of)
        limits = pd.DataFrame(
            {"at": other, "value": value, "lower": lower, "upper": upper}
        )
        parts.append(limits.assign(probability=probability, of=fit.measures[of]))
    return pd.concat(parts, ignore_index=True)
