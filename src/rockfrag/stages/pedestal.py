"""The pedestal's effect, for each definition of the tests, as tidy tables."""

from collections.abc import Mapping

import pandas as pd

from rockfrag.errors import InputError
from rockfrag.stages.job import Job, Results
from rockfrag.study.study import Study
from rockfrag.tabular import join_rows

PEDESTAL_TABLES = ("pairs", "effects", "whole", "without_earthquake", "ranks", "notes")
"""Tables of :func:`pedestal_tables`, each written under ``pedestal/``."""


def run(job: Job[Study]) -> Results:
    """Yield the pedestal's effect in every form."""
    from rockfrag.pedestal.paired_tests import with_counterparts

    slenderness = {name: block.slenderness for name, block in job.study.specimens.items()}
    tests, origin = with_counterparts(job.table("tests"), job.study.counterparts)
    slenderness |= {name: slenderness[tested] for name, tested in origin.items()}
    found = pedestal_tables(tests, job.study.seed, slenderness)
    for name, table in found.items():
        yield f"pedestal/{name}", table
    pairs = found["pairs"]
    # every definition of the amplitudes has the same pairs
    several = pairs.groupby("definition").size()
    job.log.info(
        "pairs of an arrangement and its counterpart: %d", several.max() if len(several) else 0
    )


def pedestal_tables(
    tests: pd.DataFrame, seed: int, slenderness: Mapping[str, float]
) -> dict[str, pd.DataFrame]:
    """Estimate the pedestal's effect once per reading of the tests.

    Returns the tables named in ``PEDESTAL_TABLES``, see :class:`rockfrag.pedestal.PedestalStudy`, each with the
    column ``definition`` first.
    """
    from rockfrag.pedestal import study_pedestal

    if tests.empty:
        raise InputError("tests: there is no row; the pedestal's effect needs tests.")
    parts: dict[str, list[pd.DataFrame]] = {name: [] for name in PEDESTAL_TABLES}
    # a table that cannot follow the weakest motion has tested nothing
    untested = (tests["censored"] == "right") & (tests["lower_g"] == 0)
    for definition, rows in tests[~untested].groupby("definition", sort=False):
        if rows["pedestal"].nunique() < 2:
            continue
        found = study_pedestal(rows, seed=seed, slenderness=slenderness)
        tables = (found.pairs.table, found.effects, found.whole, found.without_earthquake)
        notes = pd.DataFrame({"note": list(found.notes)})
        for name, table in zip(PEDESTAL_TABLES, (*tables, found.ranks, notes), strict=True):
            labelled = table.copy()
            labelled.insert(0, "definition", definition)
            parts[name].append(labelled)
    if not parts["pairs"]:
        raise InputError("tests: no reading has tests with and without a pedestal.")
    return {name: join_rows(tables) for name, tables in parts.items()}
