"""A laboratory's tests through the statistics of the simulated ones, and beside them."""

from collections.abc import Mapping

import pandas as pd

from rockfrag.errors import InputError
from rockfrag.stages.job import Job, Results
from rockfrag.stages.pedestal import pedestal_tables
from rockfrag.study.study import Study

_KEY = ["object", "pedestal", "earthquake", "floor"]
_CURVES = ("configuration", "im", "unit", "theta", "theta_lower", "theta_upper", "beta")


def run(job: Job[Study]) -> Results:
    """Yield the laboratory's tests, and what their statistics say."""
    from rockfrag.shaketable.definitions import DEFINITION
    from rockfrag.shaketable.tests_table import read_measured

    study = job.study
    if study.measured_tests is None:
        raise ValueError("the study has no measured tests")
    simulated = job.table("tests")
    found = measured_tables(
        read_measured(study.measured_tests),
        simulated[simulated["definition"] == DEFINITION],
        {name: block.slenderness for name, block in study.specimens.items()},
        study.seed,
        study.fragility.confidence,
    )
    yield from found.items()
    job.log.info("measured tests: %d", len(found["measured/tests"]))


def measured_tables(
    measured: pd.DataFrame,
    simulated: pd.DataFrame,
    slenderness: Mapping[str, float],
    seed: int,
    level: float,
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
        found = pedestal_tables(measured, seed, slenderness)
        effects = found["effects"]
        notes += list(found["notes"]["note"])
    except InputError as error:
        notes.append(f"No effect of the pedestal: {error}")
    curves = _curves(measured, level, notes)
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
    from rockfrag.fragility import fit_step_tests
    from rockfrag.fragility.ida_curves import fragility_row, table_hash

    rows = []
    digest = table_hash(measured)
    for (object_name, side), tests in measured.groupby(["object", "pedestal"], sort=True):
        name = f"P&{object_name}" if side == "P" else str(object_name)
        try:
            fit = fit_step_tests(tests, level=level)
        except InputError as error:
            notes.append(f"No fragility curve of {name}: {error}")
            continue
        rows.append(fragility_row(fit, {"configuration": name}, "step_tests", digest))
    return pd.DataFrame(rows) if rows else pd.DataFrame(columns=list(_CURVES))
