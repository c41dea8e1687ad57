"""Tables of fragilities in two intensity measures: coefficients with what is known of them, contours, cells."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility.observations import name_and_unit
from rockfrag.fragility.vector import VectorFragility, fit_vector
from rockfrag.fragility.vector_checks import VectorChecks, check_vector

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
            fits.append({**about, **_fit_row(fit, checks)})
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


def _fit_row(fit: VectorFragility, checks: VectorChecks) -> dict[str, object]:
    coefficients = (*fit.coefficients, 0.0)[:4]
    return {
        **dict(zip(("c0", "c1", "c2", "c12"), coefficients, strict=True)),
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
    return f"{name_and_unit(first)[0]} and {name_and_unit(second)[0]}"
