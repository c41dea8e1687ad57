"""Reading the IDA curves of a study for the stages behind them, part by part."""

from collections.abc import Iterable, Iterator

import numpy as np
import pandas as pd

from rockfrag.outcomes.limit_states import OVERTURNS
from rockfrag.shaketable.swept import Swept, read_swept
from rockfrag.stages.job import Job
from rockfrag.study.study import Study
from rockfrag.system.system import System


def ida_curves_of(
    job: Job[Study], configuration: System, *, state: str = OVERTURNS
) -> Iterator[Swept]:
    """Yield the outcomes of a configuration, see :func:`rockfrag.shaketable.swept.read_swept`."""
    study = job.study
    jobs = range(study.ida_jobs)
    files = (job.file(study.ida_file(configuration, run)) for run in jobs)
    yield from read_swept(files, state=state)


MOST_LEVELS = 200
"""Intensity levels of a motion that stand in a table of tests; of more every so many-th does."""


def rows_of(parts: Iterable[Swept]) -> pd.DataFrame:
    """Put outcomes of IDA curves of one configuration into a table with a row a test.

    Columns: ``earthquake``, ``floor``, ``motion``, ``amplitude_g`` and ``overturned`` (0 or 1).
    """
    tables = []
    for part in parts:
        chosen = slice(None, None, -(-part.amplitude_g.size // MOST_LEVELS))
        amplitude = part.amplitude_g[chosen]
        about = part.about[["earthquake", "floor", "motion"]]
        rows = about.loc[about.index.repeat(amplitude.size)].reset_index(drop=True)
        overturned = part.overturned[:, chosen].ravel().astype(np.int64)
        tables.append(
            rows.assign(amplitude_g=np.tile(amplitude, len(about)), overturned=overturned)
        )
    return pd.concat(tables, ignore_index=True)
