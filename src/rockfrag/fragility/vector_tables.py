"""Fragilities in two intensity measures as tables, their test of fit, and what the outcomes say without them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import optimize, special

from rockfrag.errors import InputError
from rockfrag.fragility import observations
from rockfrag.fragility.checks import binned_deviance, refitted_deviance
from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.fragility.observations import Floats
from rockfrag.fragility.vector import VectorFragility, design_of, fit_vector

BINS = 10  # bins of the fitted probability in which observed and fitted numbers are compared
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
    overturned, motion : columns of the outcome and of the motion; None where each test has a motion of its own
        In simulated data each motion has one capacity, so that its tests depend on each other as in an incremental
        dynamic analysis.
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
    capacity = np.random.default_rng(seed).normal(size=(replicates, int(motions.max()) + 1))
    fell, expected, trials = (
        np.asarray(np.bincount(bins, values), dtype=np.float64)
        for values in (outcome, special.ndtr(eta), np.ones(eta.size))
    )
    own = binned_deviance(fell, expected, trials)
    at_once = max(MOST_DRAWN // eta.size, 1)
    simulated = np.concatenate(
        [
            refitted_deviance(design, 1.0 * (eta > part[:, motions]), np.ones(eta.size), bins)
            for part in np.split(capacity, range(at_once, replicates, at_once))
        ]
    )
    p_fit = float((1 + np.sum(simulated >= own - 1e-9)) / (1 + simulated.size))
    return VectorChecks(p_fit, _surface_table(fit, logs, outcome))


def _surface_table(fit: VectorFragility, logs: list[Floats], outcome: Floats) -> pd.DataFrame:
    (row, first), (column, second) = (observations.cells(values, MOST_CELLS) for values in logs)
    shape = (first.size, second.size)
    flat = row * shape[1] + column
    tests = np.bincount(flat, minlength=first.size * second.size).reshape(shape)
    fell = np.bincount(flat, outcome, minlength=first.size * second.size).reshape(shape)
    probability = monotone_probability(fell.astype(np.float64), tests.astype(np.float64))
    i, j = np.nonzero(tests)
    x, y = np.exp(first[i]), np.exp(second[j])
    return pd.DataFrame(
        {
            fit.measures[0]: x,
            fit.measures[1]: y,
            "tests": tests[i, j],
            "overturned": fell[i, j].astype(np.int64),
            "probability": probability[i, j],
            "fitted": fit.probability(x, y),
        }
    )


def monotone_probability(overturned: Floats, tests: Floats) -> Floats:
    """Probability of overturning by cell that rises along rows and columns and is closest to what was observed.

    Weighted least squares under both orders, by alternating projections (Dykstra and Robertson 1982, Annals of
    Statistics 10: 708-716). Arrays have the shape (rows, columns); cells without tests follow their neighbours.
    """
    weight = np.maximum(tests, 1e-9)
    value = np.where(tests > 0, overturned / weight, overturned.sum() / tests.sum())
    by_row, by_column = np.zeros_like(value), np.zeros_like(value)
    for _ in range(MOST_CYCLES):
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
    """Isotonic regression of each row."""
    pairs = zip(values, weights, strict=True)
    return np.array([optimize.isotonic_regression(v, weights=w).x for v, w in pairs])


PROBABILITIES = (0.1, 0.5, 0.9)  # probabilities of overturning of which contours are given [-]
POINTS = 40  # points of a contour, over the values of the second measure
MOST_TESTS = 100_000
"""Tests of one fit; of more every so many-th is taken, which changes limits over earthquakes little."""

FITS = (
    *("first", "second", "c0", "c1", "c2", "c12", "aic", "tests", "overturned", "earthquakes"),
    *("p_interaction", "likelihood_ratio", "p_fit", "method", "warnings"),
)
CONTOURS = ("first", "second", "probability", "of", "at", "value", "lower", "upper")
CELLS = ("first", "second", "at_first", "at_second", "tests", "overturned", "probability", "fitted")


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
    """Fit every pair of measures to every table of tests, by name; ``warnings`` say which fits are not possible.

    ``label`` is the column in which names of the tables stand; ``earthquake`` and ``motion`` are None where each
    test is one of its own; ``seed`` is of the test of fit.
    """
    fits: list[dict[str, object]] = []
    contours, cells = [], []
    for name, table in tests.items():
        used = table.iloc[:: -(-len(table) // MOST_TESTS)]
        for pair in pairs:
            about = {label: name, "first": pair[0], "second": pair[1]}
            try:
                fit = fit_vector(used, pair, earthquake=earthquake, level=level, source=name)
            except InputError as error:
                fits.append({**about, "method": "none", "warnings": str(error)})
                continue
            checks = check_vector(fit, used, motion=motion, seed=seed)
            values = (
                *(*fit.coefficients, 0.0)[:4],
                *(fit.aic, fit.n, fit.n_overturned, fit.n_earthquakes, fit.interaction.p),
                *(fit.interaction.likelihood_ratio, checks.p_fit, fit.method),
                " ".join(fit.warnings),
            )
            fits.append({**about, **dict(zip(FITS[2:], values, strict=True))})
            contours.append(_contours(fit, used).assign(**about))
            # measures are named alike for every pair, whose tables are joined
            surface = checks.surface.rename(columns=dict(zip(pair, CELLS[2:4], strict=True)))
            cells.append(surface.assign(**about))
    return VectorTables(
        pd.DataFrame(fits, columns=[label, *FITS]),
        _joined(contours, [label, *CONTOURS]),
        _joined(cells, [label, *CELLS]),
    )


def _joined(parts: list[pd.DataFrame], columns: list[str]) -> pd.DataFrame:
    if not parts:
        return pd.DataFrame(columns=columns)
    return pd.concat(parts, ignore_index=True)[columns]


def _contours(fit: VectorFragility, tests: pd.DataFrame) -> pd.DataFrame:
    logs = np.log(tests[list(fit.measures)].to_numpy(dtype=np.float64))
    of = int(np.argmax(np.array(fit.coefficients[1:3]) * logs.std(axis=0)))
    other = np.exp(np.linspace(logs[:, 1 - of].min(), logs[:, 1 - of].max(), POINTS))
    parts = []
    for probability in PROBABILITIES:
        value, lower, upper = fit.contour(probability, other, of)
        limits = pd.DataFrame({"at": other, "value": value, "lower": lower, "upper": upper})
        parts.append(limits.assign(probability=probability, of=fit.measures[of]))
    return pd.concat(parts, ignore_index=True)


def describe_pair(first: str, second: str) -> str:
    """Two measures in words: ``PGA and PGV/PGA``."""
    return f"{observations.name_and_unit(first)[0]} and {observations.name_and_unit(second)[0]}"
