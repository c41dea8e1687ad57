"""Mean overturning amplitudes that may be compared: over the same motions, all of them overturning.

A test that never overturned has no amplitude. Left out of one mean and not of another, it would make
objects, floors or sides look different that were merely tested by other motions.
"""

import numpy as np
import pandas as pd

_LABELS = ("configuration", "object", "pedestal", "floor")
COLUMNS = ("by", *_LABELS, "mean_g", "motions", "of")


def mean_amplitudes(tests: pd.DataFrame) -> pd.DataFrame:
    """Geometric means of what is compared, over the motions that overturned all that is compared, a row a mean.

    ``tests`` are of one definition; ``amplitude_g`` [g] is missing where the test has none. ``by`` is what is
    compared: all configurations over the same motions (``configuration``), the floors by side over the same
    records and objects (``floor``), or the same for each object (``object_floor``). ``configuration``, ``object``,
    ``pedestal`` and ``floor`` are empty where all are taken together; ``mean_g`` [g] is missing where no motion
    overturned all; of ``of`` motions ``motions`` did. Repetitions are averaged in the logarithm, and count only if
    each of them overturned.
    """
    known = tests.assign(
        ln_a=np.log(tests["amplitude_g"]),
        # the same record on another floor has another name: that of the record and the floor's
        record=[
            motion.removesuffix(f"_{floor}")
            for motion, floor in tests[["motion", "floor"]].itertuples(index=False)
        ],
    )
    rows = _means("configuration", known, ["configuration"], ["record", "floor"])
    rows += _means("floor", known, ["pedestal", "floor"], ["record", "object"])
    for _, group in known.groupby("object", sort=False):
        rows += _means("object_floor", group, ["pedestal", "floor"], ["record"])
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _means(
    by: str, tests: pd.DataFrame, compared: list[str], units: list[str]
) -> list[dict[str, object]]:
    """Means of each of ``compared`` over the ``units`` in which all of them are known."""
    parts = [part for _, part in tests.groupby(compared, sort=False)]
    ln_a = [
        part.groupby(units)["ln_a"].agg(lambda values: values.mean(skipna=False)) for part in parts
    ]
    table = pd.concat(ln_a, axis=1)
    complete = table.dropna()
    return [
        {
            "by": by,
            **{
                name: str(part[name].iloc[0]) if len(set(part[name])) == 1 else ""
                for name in _LABELS
            },
            "mean_g": float(np.exp(complete.iloc[:, column].mean())) if len(complete) else np.nan,
            "motions": len(complete),
            "of": len(table),
        }
        for column, part in enumerate(parts)
    ]
