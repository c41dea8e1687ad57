"""Fragility from anybody's table of tests: overturned yes or no, with intensity measures."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility.empirical import share_in_bins
from rockfrag.fragility.estimators import Fragility, fragility_of
from rockfrag.fragility.goodness import GoodnessOfFit
from rockfrag.fragility.measure_choice import MeasureChoice, recommend_measure
from rockfrag.fragility.observations import Floats, Outcomes, outcomes_from_table, positive
from rockfrag.fragility.surface import FragilitySurface, fit_surface
from rockfrag.fragility.sweeps import fragility_row, table_hash

_YES = {"1", "1.0", "true", "yes", "y", "overturned"}
_NO = {"0", "0.0", "false", "no", "n", "survived"}


@dataclass(frozen=True)
class UserFragility:
    """All that a table of tests says about fragility.

    Attributes
    ----------
    tests
        The table as used: ``motion``, ``event``, ``overturned`` and a column per measure.
    outcomes, fits, goodness
        By measure, in the order given; ``goodness`` only where there is a curve.
    choice
        Recommendation of a measure.
    surface
        Probit surface in the first two measures; None with one measure or where all tests agree.
    table
        Tidy table of curves, see :func:`rockfrag.fragility.sweeps.fragility_table`.
    bins
        Empirical shares in bins, by measure (column ``measure``).
    """

    tests: pd.DataFrame
    outcomes: Mapping[str, Outcomes]
    fits: Mapping[str, Fragility]
    goodness: Mapping[str, GoodnessOfFit]
    choice: MeasureChoice
    surface: FragilitySurface | None
    table: pd.DataFrame
    bins: pd.DataFrame


def fit_user_table(
    path: str | os.PathLike[str],
    measures: Mapping[str, Sequence[str | float]] | Sequence[str],
    *,
    overturned: str = "overturned",
    motion: str | None = None,
    event: str | None = None,
    given: Sequence[str] = (),
    level: float = 0.90,
    replicates: int = 200,
    seed: int = 0,
) -> UserFragility:
    """Read a CSV of tests and fit, compare and judge fragility curves in its measures.

    Parameters
    ----------
    path
        CSV with one row per test.
    measures
        Either columns of the file, named with their unit (``pga_g``, ``pgv_cm_s``), or for each new
        column the columns and numbers whose product it is, for example
        ``{"pga_g": ["pga_g"], "pgv_cm_s": ["pga_g", "pgv_over_pga_s", 980.665]}``.
    overturned
        Column of verdicts: 0/1, yes/no, true/false.
    motion, event
        Columns that name motion and earthquake; without them every test counts as a motion of its
        own.
    given
        Columns against which sufficiency is tested.
    level, replicates, seed
        Of confidence limits and bootstraps.

    Raises
    ------
    InputError
        If the file cannot be read, a column is absent, or a value cannot be used; file, row (the
        header is row 1) and column are named.
    """
    source = Path(path).name
    raw = _read(path, source)
    tests = _tests(raw, measures, overturned, motion, event, given, source)
    columns = list(measures)
    event_column = "event" if event is not None else None
    outcomes, fits, goodness, rows, bins = {}, {}, {}, [], []
    digest = table_hash(tests)
    for column in columns:
        data = outcomes_from_table(tests, column, event=event_column, source=source)
        # rows of one motion are tests at different scales, each with its own verdict
        result = fragility_of(data, level=level, dependence="tests", seed=seed)
        outcomes[column], fits[column] = data, result
        if result.checks.goodness is not None:
            goodness[column] = result.checks.goodness
        rows.append(fragility_row(result, {"source": source, "measure": column}, "cloud", digest))
        bins.append(share_in_bins(data, level=level).assign(measure=column))
    choice = recommend_measure(
        tests,
        columns,
        given=given,
        event=event_column,
        level=level,
        replicates=replicates,
        seed=seed,
        source=source,
    )
    verdict = tests["overturned"]
    surface = None
    if len(columns) > 1 and verdict.nunique() == 2:
        surface = fit_surface(tests, columns[:2], source=source)
    return UserFragility(
        tests,
        outcomes,
        fits,
        goodness,
        choice,
        surface,
        pd.DataFrame(rows),
        pd.concat(bins, ignore_index=True),
    )


def _read(path: str | os.PathLike[str], source: str) -> pd.DataFrame:
    try:
        table = pd.read_csv(path, dtype=str, encoding="utf-8-sig", skipinitialspace=True)
    except FileNotFoundError as error:
        raise InputError(f"{path}: there is no such file; correct the path.") from error
    except (pd.errors.ParserError, pd.errors.EmptyDataError, UnicodeDecodeError) as error:
        reason = str(error).splitlines()[0]
        raise InputError(
            f"{source}: not a readable CSV table ({reason}); mend the file."
        ) from error
    if len(table) == 0:
        raise InputError(f"{source}: there is no row below the header; give at least one test.")
    # a row is named as a spreadsheet shows it, the header being row 1
    return table.rename(columns=str.strip)


def _tests(
    raw: pd.DataFrame,
    measures: Mapping[str, Sequence[str | float]] | Sequence[str],
    overturned: str,
    motion: str | None,
    event: str | None,
    given: Sequence[str],
    source: str,
) -> pd.DataFrame:
    recipes: dict[str, Sequence[str | float]] = (
        dict(measures) if isinstance(measures, Mapping) else {name: [name] for name in measures}
    )
    if not recipes:
        raise InputError("measures: name at least one column with an intensity measure.")
    tests = pd.DataFrame(
        {
            "motion": _text(raw, motion, source),
            "event": _text(raw, event if event is not None else motion, source),
            "overturned": _verdicts(raw, overturned, source),
        }
    )
    for name, factors in recipes.items():
        product = np.ones(len(raw))
        for factor in factors:
            if isinstance(factor, str):
                product = product * _numbers(raw, factor, source, above_zero=True)
            else:
                product = product * float(factor)
        tests[name] = product
        positive(tests, name, source)
    for name in given:
        tests[name] = _numbers(raw, name, source, above_zero=False)
    return tests


def _column(raw: pd.DataFrame, column: str, source: str) -> "pd.Series[str]":
    if column not in raw:
        raise InputError(
            f"{source}: there is no column {column!r}; the file has "
            f"{', '.join(map(str, raw.columns))}."
        )
    return raw[column]


def _text(raw: pd.DataFrame, column: str | None, source: str) -> list[str]:
    if column is None:
        return [f"row {row + 2}" for row in range(len(raw))]
    values = _column(raw, column, source)
    missing = np.flatnonzero(values.isna())
    if missing.size:
        raise InputError(
            f"{source}, row {missing[0] + 2}, column {column!r}: the label is missing; fill it in."
        )
    return [str(value).strip() for value in values]


def _numbers(raw: pd.DataFrame, column: str, source: str, *, above_zero: bool) -> Floats:
    text = _column(raw, column, source)
    values = pd.to_numeric(text, errors="coerce").to_numpy(dtype=np.float64)
    bad = np.flatnonzero(~np.isfinite(values))
    if bad.size:
        found = text.iloc[bad[0]]
        what = "nothing" if pd.isna(found) else repr(found)
        raise InputError(
            f"{source}, row {bad[0] + 2}, column {column!r}: {what} is not a finite number; "
            "correct it or leave the row out."
        )
    if above_zero and (values <= 0).any():
        row = int(np.flatnonzero(values <= 0)[0])
        raise InputError(
            f"{source}, row {row + 2}, column {column!r}: an intensity measure must be above zero "
            f"to have a logarithm, got {values[row]:g}; correct it or leave the row out."
        )
    return values


def _verdicts(raw: pd.DataFrame, column: str, source: str) -> Floats:
    text = _column(raw, column, source).fillna("").str.strip().str.lower()
    known = text.isin(_YES | _NO).to_numpy()
    if not known.all():
        row = int(np.flatnonzero(~known)[0])
        raise InputError(
            f"{source}, row {row + 2}, column {column!r}: {text.iloc[row]!r} is no verdict; write "
            "1 or yes for overturned, 0 or no for survived."
        )
    return np.asarray(text.isin(_YES), dtype=np.float64)
