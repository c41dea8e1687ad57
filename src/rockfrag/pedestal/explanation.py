"""What could produce a pedestal effect: P/NP at varied factors against P/NP of the reference model.

Each factor (restitution of an interface, imperfection, base width, mass error, protocol step) is
varied alone.  The effect of a level is the mean of ln ratio there minus that of the reference, pair by
pair, tested over events as everywhere else.
"""

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.pedestal.cluster_means import mean_effect
from rockfrag.pedestal.equivalence import equivalence
from rockfrag.pedestal.multiplicity import benjamini_hochberg, holm

COLUMNS = ("factor", "level", "reference", "object", "event", "floor", "ratio")
CHANGES, SAME, OPEN = "changes P/NP", "within ±10 %", "open"
"""What the intervals say of a level: p below 5 % over everything, equivalence, or neither."""


def explain(table: pd.DataFrame) -> pd.DataFrame:
    """Effect of every level of every factor on the ratio P/NP, with intervals.

    Parameters
    ----------
    table
        One row per factor, level, object, event, floor (and replicate): factor, level (text or
        number), reference (True for the rows of the reference level, one level per factor), object,
        event, floor, ratio (a_P over a_NP, NaN where censored), and optionally motion, replicate
        (such as a number of a perturbed copy) and resolution (half-width to which ln ratio is known).
        Replicates are averaged in the logarithm.

    Returns
    -------
    pandas.DataFrame
        factor, level, floor ("all" or one floor), ratio, ratio_lower, ratio_upper (P/NP at that
        level [-]), effect, effect_lower, effect_upper (ratio over the reference's [-]), p, p_holm
        (within the factor), p_bh (over everything), pairs, events, left_out (pairs without a value
        on either side), p_equivalence (of a change within ±10 %), judgement (`CHANGES` where p_bh is
        below 5 %, `SAME` where p_equivalence is, else `OPEN`; empty for the reference).

    Raises
    ------
    InputError
        If a column is missing, a ratio is not positive, or a factor has no or several references.
    """
    missing = [name for name in COLUMNS if name not in table.columns]
    if missing:
        raise InputError(
            f"Explanation study: column(s) {', '.join(missing)} missing; it needs "
            f"{', '.join(COLUMNS)}."
        )
    bad = np.flatnonzero((table["ratio"] <= 0) | np.isinf(table["ratio"].astype(float)))
    if bad.size:
        raise InputError(
            f"Explanation study, row {bad[0] + 1}: ratio is {table['ratio'].iloc[bad[0]]}; it must "
            "be a positive number, or empty where a test never overturned."
        )
    work = table.assign(d=np.log(table["ratio"].astype(float)))
    if "resolution" not in work:
        work["resolution"] = 0.0
    if "motion" not in work:
        work["motion"] = work["event"].astype(str) + "/" + work["floor"].astype(str)
    parts = [_explain_factor(str(name), rows) for name, rows in work.groupby("factor", sort=True)]
    result = pd.concat(parts, ignore_index=True)
    result["p_bh"] = benjamini_hochberg(result["p"])
    choices = [result["p_bh"] < 0.05, result["p_equivalence"] < 0.05, result["p_bh"].isna()]
    result["judgement"] = np.select(choices, [CHANGES, SAME, ""], OPEN)
    return result


def _explain_factor(name: str, rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of one factor, the reference level first."""
    marked = rows.loc[rows["reference"].astype(bool), "level"].unique()
    if len(marked) != 1:
        raise InputError(
            f"Explanation study: factor {name} has {len(marked)} reference levels; mark exactly one."
        )
    key = ["object", "event", "floor", "motion"]
    cells = rows.groupby(["level", *key])[["d", "resolution"]].mean().reset_index()
    step = cells.groupby(key)["resolution"].max()
    reference = cells[cells["level"] == marked[0]].set_index(key)["d"]
    levels = sorted(cells["level"].unique(), key=lambda level: (level != marked[0], level))
    found: list[dict[str, object]] = []
    for level in levels:
        here = cells[cells["level"] == level].set_index(key)["d"]
        both = pd.DataFrame({"here": here, "reference": reference, "resolution": step})
        known = both.dropna().reset_index()
        if known.empty:
            continue
        for floor in ("all", *sorted(known["floor"].unique())):
            part = known if floor == "all" else known[known["floor"] == floor]
            total = (
                len(both)
                if floor == "all"
                else int((both.index.get_level_values("floor") == floor).sum())
            )
            ratio = mean_effect(part.assign(d=part["here"]))
            change = part.assign(
                d=part["here"] - part["reference"], resolution=2 * part["resolution"]
            )
            effect = mean_effect(change)
            found.append(
                {
                    "factor": name,
                    "level": level,
                    "floor": floor,
                    "ratio": ratio.ratio,
                    "ratio_lower": ratio.ratio_lower,
                    "ratio_upper": ratio.ratio_upper,
                    "effect": effect.ratio,
                    "effect_lower": effect.ratio_lower,
                    "effect_upper": effect.ratio_upper,
                    "p": effect.p if level != marked[0] else np.nan,
                    "pairs": len(part),
                    "events": effect.units,
                    "left_out": total - len(part),
                    "p_equivalence": equivalence(effect).p if level != marked[0] else np.nan,
                }
            )
    result = pd.DataFrame(found)
    result["p_holm"] = holm(result["p"])
    return result
