"""What could produce a pedestal effect: P/NP at varied factors against P/NP of the reference model.

Each factor (restitution of an interface, imperfection, base width, mass error, protocol step) is
varied alone.  The effect of a level is the mean of ln ratio there minus that of the reference, pair by
pair, tested over earthquakes as everywhere else.
"""

import itertools
from collections.abc import Mapping

import numpy as np
import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.base.tabular import join_rows
from rockfrag.effects.cluster_means import (
    benjamini_hochberg,
    equivalence,
    holm,
    mean_effects,
)

COLUMNS = ("factor", "level", "reference", "object", "earthquake", "floor", "ratio")
ALL = "all"  # what stands in the column of the floor for all floors together

CHANGES, SAME, OPEN = "changes P/NP", "within ±10 %", "open"
"""What the intervals say of a level: p below 5 % over everything, equivalence, or neither."""


def explain(table: pd.DataFrame) -> pd.DataFrame:
    """Effect of every level of every factor on the ratio P/NP, with intervals.

    The table has a row per factor, level, object, earthquake, floor (and replicate): factor, level (text or
    number), reference (True for the rows of the reference level, one per factor), object, earthquake, floor, ratio
    (a_P over a_NP, NaN where censored), and optionally motion, replicate (averaged in the logarithm) and
    resolution (half-width to which ln ratio is known).

    Returns factor, level, floor ("all" or one floor), ratio, ratio_lower, ratio_upper (P/NP at that level [-]),
    effect, effect_lower, effect_upper (ratio over the reference's [-]), p, p_holm (within the factor), p_bh (over
    everything), pairs, earthquakes, left_out (pairs without a value on either side), p_equivalence (of a change
    within ±10 %), judgement (`CHANGES` where p_bh is below 5 %, `SAME` where p_equivalence is, else `OPEN`; empty
    for the reference).
    """
    missing = [name for name in COLUMNS if name not in table.columns]
    if missing:
        raise InputError(
            f"Explanation study: column(s) {', '.join(missing)} missing; it needs {', '.join(COLUMNS)}."
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
        work["motion"] = (
            work["earthquake"].astype(str) + "/" + work["floor"].astype(str)
        )
    parts = [
        _explain_factor(str(name), rows)
        for name, rows in work.groupby("factor", sort=True)
    ]
    result = join_rows(parts)
    result["p_bh"] = benjamini_hochberg(result["p"])
    choices = [
        result["p_bh"] < 0.05,
        result["p_equivalence"] < 0.05,
        result["p_bh"].isna(),
    ]
    result["judgement"] = np.select(choices, [CHANGES, SAME, ""], OPEN)
    return result


def where_laws_agree(
    effects: pd.DataFrame, laws: Mapping[str, tuple[str, str]]
) -> pd.DataFrame:
    """Leave a judgement open where the laws of one perturbed parameter do not all give it.

    ``laws`` has perturbed parameter and law of each factor that has several.
    """
    known = effects[effects["factor"].isin(laws) & (effects["judgement"] != "")]
    base = known["factor"].map(lambda factor: laws[factor][0])
    kinds = known.groupby([base, known["level"], known["floor"]])[
        "judgement"
    ].transform("nunique")
    judgement = effects["judgement"].copy()
    judgement.loc[kinds.index[kinds > 1]] = OPEN
    return effects.assign(judgement=judgement)


_COLUMNS = [
    *("factor", "level", "floor", "ratio", "ratio_lower", "ratio_upper"),
    *("effect", "effect_lower", "effect_upper", "p", "pairs", "earthquakes", "left_out", "p_equivalence"),
]  # fmt: skip


def _explain_factor(name: str, rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of one factor, the reference level first."""
    marked = rows.loc[rows["reference"].astype(bool), "level"].unique()
    if len(marked) != 1:
        raise InputError(
            f"Explanation study: factor {name} has {len(marked)} reference levels; mark exactly one."
        )
    key = ["object", "earthquake", "floor", "motion"]
    cells = rows.groupby(["level", *key])[["d", "resolution"]].mean().reset_index()
    step = cells.groupby(key)["resolution"].max()
    reference = cells[cells["level"] == marked[0]].set_index(key)["d"]
    levels = sorted(
        cells["level"].unique(), key=lambda level: (level != marked[0], level)
    )
    both = cells.rename(columns={"d": "here"}).drop(columns="resolution")
    both = both.join(reference.rename("reference"), on=key).join(step, on=key)
    both["floor"] = both["floor"].astype(str)
    both = pd.concat([both.assign(floor=ALL), both])
    known = both.dropna(subset=["here", "reference"])
    known = known.assign(scope=known["level"].astype(str) + "/" + known["floor"])
    ratios = mean_effects(known.assign(d=known["here"]), "scope")
    effects = mean_effects(
        known.assign(
            d=known["here"] - known["reference"], resolution=2 * known["resolution"]
        ),
        "scope",
    )
    tried = both.groupby(["level", "floor"]).size()
    pairs = known.groupby(["level", "floor"]).size()
    found: list[dict[str, object]] = []
    floors = [ALL, *sorted(set(known["floor"]) - {ALL})]
    for level, floor in itertools.product(levels, floors):
        scope = f"{level}/{floor}"
        if scope not in effects:
            continue
        ratio, effect = ratios[scope], effects[scope]
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
                "pairs": int(pairs[level, floor]),
                "earthquakes": effect.units,
                "left_out": int(tried[level, floor] - pairs[level, floor]),
                "p_equivalence": equivalence(effect) if level != marked[0] else np.nan,
            }
        )
    # nothing is known of a factor whose tests never overturned
    result = pd.DataFrame(found, columns=_COLUMNS)
    result["p_holm"] = holm(result["p"])
    return result
