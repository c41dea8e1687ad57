"""Made data of known truth for the tests of curves."""

import numpy as np
import pandas as pd


def ida_of(capacities, levels, configuration="T", each=1):
    """IDA curves of motions that overturn above a capacity [g] of their own, so many motions an earthquake."""
    motion = np.repeat(np.arange(len(capacities)), len(levels))
    level = np.tile(levels, len(capacities))
    return pd.DataFrame(
        {
            "configuration": configuration,
            "motion": [f"m{k}" for k in motion],
            "earthquake": [f"e{k // each}" for k in motion],
            "amplitude_g": level,
            "overturned": level > np.asarray(capacities)[motion],
        }
    )


def reading(table, estimator="first_overturning"):
    """The row of a table of curves of one body that has an estimator."""
    return table.set_index("estimator").loc[estimator]
