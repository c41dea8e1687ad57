"""The pedestal's effect, for each definition of the tests and of a laboratory's, which stand beside them.

In: tables of tests. Out: ratios of amplitudes P/NP with intervals. Theory: ``docs/pedestal.md``.
"""

from collections.abc import Mapping

import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.base.tabular import join_rows
from rockfrag.effects import study_pedestal
from rockfrag.effects.paired_tests import with_counterparts
from rockfrag.fragility import fit_step_tests
from rockfrag.fragility.ida_curves import fragility_row, table_hash
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag.shaketable.tests_table import read_measured
from rockfrag.stages.job import Job, Results
from rockfrag.study.study import Study

PEDESTAL_TABLES = ("pairs", "effects", "whole", "without_earthquake", "ranks", "notes")
"""Tables of :func:`pedestal_tables`, each written under ``pedestal/``."""


def run(job: Job[Study]) -> Results:
    """Yield the pedestal's effect in every form."""
    slenderness = job.study.slenderness
    tests, origin = with_counterparts(job.table("tests"), job.study.counterparts)
    slenderness |= {name: slenderness[tested] for name, tested in origin.items()}
    found = pedestal_tables(tests, job.study.seed, slenderness)
    for name, table in found.items():
        yield f"pedestal/{name}", table
    pairs = found["pairs"]
    # every definition of the amplitudes has the same pairs
    several = pairs["definition"].value_counts().max() if len(pairs) else 0
    job.log.info("pairs of an arrangement and its counterpart: %d", several)


def pedestal_tables(
    tests: pd.DataFrame, seed: int, slenderness: Mapping[str, float]
) -> dict[str, pd.DataFrame]:
    """Estimate the pedestal's effect once per reading of the tests.

    Returns the tables named in ``PEDESTAL_TABLES``, see :class:`rockfrag.effects.PedestalStudy`, each with the
    column ``definition`` first.
    """
    if tests.empty:
        raise InputError("tests: there is no row; the pedestal's effect needs tests.")
    parts: dict[str, list[pd.DataFrame]] = {name: [] for name in PEDESTAL_TABLES}
    # a table that cannot follow the weakest motion has tested nothing
    untested = (tests["censored"] == "right") & (tests["lower_g"] == 0)
    for definition, rows in tests[~untested].groupby("definition", sort=False):
        if rows["pedestal"].nunique() < 2:
            continue
        found = study_pedestal(rows, seed=seed, slenderness=slenderness)
        tables = (
            found.pairs.table,
            found.effects,
            found.whole,
            found.without_earthquake,
        )
        notes = pd.DataFrame({"note": list(found.notes)})
        for name, table in zip(
            PEDESTAL_TABLES, (*tables, found.ranks, notes), strict=True
        ):
            labelled = table.copy()
            labelled.insert(0, "definition", definition)
            parts[name].append(labelled)
    if not parts["pairs"]:
        raise InputError("tests: no reading has tests with and without a pedestal.")
    return {name: join_rows(tables) for name, tables in parts.items()}


_KEY = ["object", "pedestal", "earthquake", "floor"]
_CURVES = ("configuration", "im", "unit", "theta", "theta_lower", "theta_upper", "beta")


def run_measured(job: Job[Study]) -> Results:
    """Yield the laboratory's tests, and what their statistics say."""
    study = job.study
    if study.measured_tests is None:
        raise ValueError("the study has no measured tests")
    simulated = job.table("tests")
    simulated = simulated[simulated["definition"] == DEFINITION]
    found = measured_tables(read_measured(study.measured_tests), simulated, study)
    yield from found.items()
    job.log.info("measured tests: %d", len(found["measured/tests"]))


def measured_tables(
    measured: pd.DataFrame, simulated: pd.DataFrame, study: Study
) -> dict[str, pd.DataFrame]:
    """Fit fragility and the pedestal's effect to tests as :func:`rockfrag.shaketable.read_measured` returns them.

    Returns the tables by their names; what the tests cannot carry is empty, with the reason in
    ``measured/notes``.
    """
    notes: list[str] = []
    effects = pd.DataFrame(columns=["definition", "scope"])
    if measured.empty:
        notes.append("The table of measured tests has no rows yet.")
    try:
        found = pedestal_tables(measured, study.seed, study.slenderness)
        effects = found["effects"]
        notes += list(found["notes"]["note"])
    except InputError as error:
        notes.append(f"No effect of the pedestal: {error}")
    curves = _curves(measured, study.fragility.confidence, notes)
    return {
        "measured/tests": measured,
        "measured/beside": beside(measured, simulated),
        "measured/fragility": curves,
        "measured/effects": effects,
        "measured/notes": pd.DataFrame({"note": notes}, dtype=str),
    }


def beside(measured: pd.DataFrame, simulated: pd.DataFrame) -> pd.DataFrame:
    """Put each measured test beside its simulated counterpart.

    Adds ``simulated_g``, the simulated amplitude (NaN without a counterpart or where it is censored), and
    ``ratio``, measured over simulated amplitude.
    """
    known = simulated.drop_duplicates(_KEY)[[*_KEY, "amplitude_g"]]
    columns = [*_KEY, "repetition", "lower_g", "upper_g", "amplitude_g", "censored"]
    table = measured[columns].merge(
        known.rename(columns={"amplitude_g": "simulated_g"}), how="left", on=_KEY
    )
    return table.assign(ratio=table["amplitude_g"] / table["simulated_g"])


def _curves(measured: pd.DataFrame, level: float, notes: list[str]) -> pd.DataFrame:
    """Curves of the measured tests by object and side; what none can be fitted to is noted."""
    rows = []
    digest = table_hash(measured)
    for (object_name, side), tests in measured.groupby(
        ["object", "pedestal"], sort=True
    ):
        name = f"P&{object_name}" if side == "P" else str(object_name)
        try:
            fit = fit_step_tests(tests, level=level)
        except InputError as error:
            notes.append(f"No fragility curve of {name}: {error}")
            continue
        rows.append(fragility_row(fit, {"configuration": name}, "step_tests", digest))
    return pd.DataFrame(rows) if rows else pd.DataFrame(columns=list(_CURVES))
