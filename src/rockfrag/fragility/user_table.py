"""Fragility from anybody's table of tests: overturned yes or no, with intensity measures.

In: a text file, a row a test. Out: :class:`UserFragility`, a curve by measure with limits and checks, the
recommended measure, and the fragility in the first two. Docs: ``docs/fragility.md``, "A user's table".
"""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from rockfrag.base.short_repr import short_repr
from rockfrag.fragility.checks import GoodnessOfFit
from rockfrag.fragility.empirical import fraction_in_bins
from rockfrag.fragility.estimators import Fragility, fragility_of
from rockfrag.fragility.ida_curves import fragility_row, table_hash
from rockfrag.fragility.measure_selection import MeasureSelection, recommend_measure
from rockfrag.fragility.observations import Observations, observations_from_table
from rockfrag.fragility.tests_file import Measures, read_tests
from rockfrag.fragility.vector import VectorTables, vector_tables


@dataclass(frozen=True)
class UserFragility:
    """Fragility from a table of tests.

    Attributes
    ----------
    tests : the table as used: ``motion``, ``earthquake``, ``overturned`` and a column per measure
    outcomes, fits, choice : by measure, in the order given, and the recommendation of a measure
    two_measures : fragility in the first two measures with contours and cells; None with one measure
    table, bins
        Tidy table of curves, see :func:`rockfrag.fragility.ida_curves.fragility_table`, and empirical fractions in
        bins, by measure (column ``measure``).
    """

    tests: pd.DataFrame
    outcomes: Mapping[str, Observations]
    fits: Mapping[str, Fragility]
    choice: MeasureSelection
    two_measures: VectorTables | None
    table: pd.DataFrame
    bins: pd.DataFrame

    __repr__ = short_repr

    @property
    def goodness(self) -> dict[str, GoodnessOfFit]:
        """Goodness of fit by measure, where there is a curve."""
        found = {name: fit.checks.goodness for name, fit in self.fits.items()}
        return {
            name: goodness for name, goodness in found.items() if goodness is not None
        }


def fit_user_table(
    path: str | os.PathLike[str],
    measures: Measures,
    *,
    overturned: str = "overturned",
    motion: str | None = None,
    earthquake: str | None = None,
    given: Sequence[str] = (),
    level: float = 0.90,
    replicates: int = 200,
    seed: int = 0,
) -> UserFragility:
    """Read a table of tests from a text file and fit, compare and judge fragility curves in its measures.

    Parameters
    ----------
    path : text file with one row per test
    measures
        As of :func:`rockfrag.fragility.tests_file.read_tests`, for example
        ``{"pga_g": ["pga_g"], "pgv_cm_s": ["pga_g", "pgv_over_pga_s", 980.665]}``.
    overturned, motion, earthquake, given : columns; sufficiency is tested against the last
    level, replicates, seed : of confidence limits and bootstraps

    Returns
    -------
    The :class:`UserFragility`.
    """
    source = Path(path).name
    tests = read_tests(
        path,
        measures,
        overturned=overturned,
        motion=motion,
        earthquake=earthquake,
        given=given,
    )
    columns = list(measures)
    earthquake_column = "earthquake" if earthquake is not None else None
    outcomes = {
        column: observations_from_table(
            tests, column, earthquake=earthquake_column, source=source
        )
        for column in columns
    }
    # rows of one motion are tests at different scales, each with its own outcome
    fits = {
        column: fragility_of(data, level=level, dependence="tests", seed=seed)
        for column, data in outcomes.items()
    }
    digest = table_hash(tests)
    rows = [
        fragility_row(fit, {"source": source, "measure": column}, "cloud", digest)
        for column, fit in fits.items()
    ]
    bins = [
        fraction_in_bins(data, level=level).assign(measure=column)
        for column, data in outcomes.items()
    ]
    choice = recommend_measure(
        tests,
        columns,
        given=given,
        earthquake=earthquake_column,
        level=level,
        replicates=replicates,
        seed=seed,
        source=source,
    )
    both = None
    if len(columns) > 1:
        both = vector_tables(
            {"measured": tests},
            ((columns[0], columns[1]),),
            earthquake=earthquake_column,
            motion="motion" if motion is not None else None,
            level=level,
            seed=seed,
        )
    return UserFragility(
        tests=tests,
        outcomes=outcomes,
        fits=fits,
        choice=choice,
        two_measures=both,
        table=pd.DataFrame(rows),
        bins=pd.concat(bins, ignore_index=True),
    )
