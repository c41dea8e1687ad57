"""A laboratory's tests through the statistics of the simulated ones, and beside them."""

from collections.abc import Mapping

import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility import fit_step_tests, fragility_row, table_hash
from rockfrag.rocking.bodies import Block
from rockfrag.stages.pedestal import pedestal_tables
from rockfrag.thesis.statements import ledger

MEASURED_TABLES = (
    "measured/tests",
    "measured/beside",
    "measured/fragility",
    "measured/effects",
    "measured/claims",
    "measured/notes",
)
"""Tables of :func:`measured_tables`."""

_KEY = ("object", "pedestal", "event", "floor")
_CURVES = ("configuration", "im", "unit", "theta", "theta_lower", "theta_upper", "beta")


def measured_tables(
    measured: pd.DataFrame,
    simulated: pd.DataFrame,
    measures: pd.DataFrame,
    blocks: Mapping[str, Block],
    seed: int,
    level: float,
) -> dict[str, pd.DataFrame]:
    """Fit fragility, the pedestal's effect and the statements to measured tests.

    Parameters
    ----------
    measured
        Table of tests as :func:`rockfrag.shaketable.read_measured` returns it.
    simulated
        Tests of one reading of the simulation.
    measures
        Intensity measures of the motions.
    blocks
        Blocks by the ledger's names.
    seed
        Seed of the bootstrap.
    level
        Of the limits of the curves.

    Returns
    -------
    The tables named in ``MEASURED_TABLES``; what the tests cannot carry is empty, with the reason
    in ``measured/notes``.
    """
    notes: list[str] = []
    slenderness = {name: block.slenderness for name, block in blocks.items()}
    effects, claims = pd.DataFrame(columns=["reading", "scope"]), pd.DataFrame(columns=["number"])
    if measured.empty:
        notes.append("The table of measured tests has no rows yet.")
    try:
        found = pedestal_tables(measured, seed, slenderness)
        effects = found["effects"]
        notes += list(found["notes"]["note"])
    except InputError as error:
        notes.append(f"No effect of the pedestal: {error}")
    if _compares_objects(measured):
        claims = ledger(measured, basis="measured", seed=seed, measures=measures, bodies=blocks)
    else:
        notes.append(
            "No statement tested: they compare objects, so they need two objects overturned by the same "
            "motions, with and without pedestal, in two events."
        )
    curves = _curves(measured, level, notes)
    return {
        "measured/tests": measured,
        "measured/beside": beside(measured, simulated),
        "measured/fragility": curves,
        "measured/effects": effects,
        "measured/claims": claims,
        "measured/notes": pd.DataFrame({"note": notes}, dtype=str),
    }


def _compares_objects(measured: pd.DataFrame) -> bool:
    """Whether two objects overturned by the same motion on each side, in two events or more."""
    known = measured[measured["amplitude_g"].notna()]
    for side in ("P", "NP"):
        rows = known[known["pedestal"] == side]
        objects = rows.groupby(["event", "motion"])["object"].nunique()
        if objects[objects > 1].reset_index()["event"].nunique() < 2:
            return False
    return True


def beside(measured: pd.DataFrame, simulated: pd.DataFrame) -> pd.DataFrame:
    """Put each measured test beside its simulated counterpart.

    Returns
    -------
    The measured tests with ``simulated_g``, the simulated amplitude (NaN without a counterpart or
    where it is censored), and ``ratio``, measured over simulated amplitude.
    """
    known = simulated.drop_duplicates(list(_KEY)).set_index(list(_KEY))["amplitude_g"]
    keys = measured[list(_KEY)].itertuples(index=False, name=None)
    values = [float(known.get(key, float("nan"))) for key in keys]
    columns = [*_KEY, "repetition", "lower_g", "upper_g", "amplitude_g", "censored"]
    table = measured[columns].assign(simulated_g=values)
    return table.assign(ratio=table["amplitude_g"] / table["simulated_g"])


def _curves(measured: pd.DataFrame, level: float, notes: list[str]) -> pd.DataFrame:
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
