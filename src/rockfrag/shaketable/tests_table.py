"""The table of tests, one schema for simulated and for measured ones.

One row is one test: a configuration under a motion, its amplitude raised until it overturns or the
limit is reached.

===============  ==================================================================================
test             name of the test
configuration    what was tested: the object, and the pedestal that it stood on, if any
object, pedestal  what is tested; ``P`` on its pedestal, ``NP`` without
earthquake, floor     earthquake; floor of the building, ``ground`` without one
motion           name of the input motion
lower_g          largest amplitude known to be survived [g], 0 if none
upper_g          amplitude at which it overturned [g]; NaN if it never did
amplitude_g      the figure reported for the test [g]; NaN if there is none
censored         ``none``, or ``right`` if it did not overturn up to ``lower_g``
overturned_body  ``statue``, ``pedestal``, or empty
repetition       1, 2, …
remark           anything else
definition       how the bounds were found (``step_protocol``, ``measured``, …)
===============  ==================================================================================
"""

import pandas as pd

COLUMNS = (
    *("test", "configuration", "object", "pedestal", "earthquake", "floor", "motion"),
    *("lower_g", "upper_g", "amplitude_g", "censored", "overturned_body"),
    *("repetition", "remark", "definition"),
)

PEDESTALS = ("P", "NP")
CENSORED = ("none", "right")
BODIES = ("", "statue", "pedestal")


def as_tests_table(rows: list[dict[str, object]]) -> pd.DataFrame:
    """Return rows as a table with the columns and types of the schema, also if there are none.

    Rows without a ``configuration`` are of the object alone, or of the object on its one pedestal.
    """
    named = [
        {"configuration": f"P&{row['object']}" if row["pedestal"] == "P" else row["object"], **row}
        for row in rows
    ]
    table = pd.DataFrame(named, columns=list(COLUMNS))
    for column in COLUMNS:
        if column.endswith("_g"):
            table[column] = table[column].astype("float64")
        elif column == "repetition":
            table[column] = table[column].astype("int64")
        else:
            table[column] = table[column].astype("str")
    return table
