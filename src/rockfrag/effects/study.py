"""The pedestal effect as tables: every scope with interval, equivalence, multiplicity and power."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from rockfrag.base.short_repr import short_repr
from rockfrag.effects import cluster_means
from rockfrag.effects.cluster_means import Array
from rockfrag.effects.paired_tests import SAY, Pairs, pair_tests

SCOPES: Mapping[str, tuple[str, ...]] = {
    "whole": (),
    "floor": ("floor",),
    "earthquake": ("earthquake",),
    "object": ("object",),
    "cell": ("floor", "object"),
}
"""What is averaged together; each is a family for Holm's adjustment."""

MOST_RANKED = 100
"""Levels of a factor, such as earthquakes, that are ranked; of more, which one is largest says little."""

EFFECT_COLUMNS = [
    *("scope", "level", "pairs", "unit", "units", "ratio", "lower", "upper"),
    *(
        "p",
        "p_holm",
        "p_bh",
        "p_sign_flip",
        "smallest_p",
        "p_equivalence",
        "equivalent",
    ),
    *("detectable_ratio", "resolution_ratio", "tied", "at_bound"),
]
WHOLE_COLUMNS = [
    "method",
    "estimate",
    "lower",
    "upper",
    "p",
    "smallest_p",
    "units",
    "remark",
]
EQUIVALENCE_LEVEL = 0.05  # equivalence is shown below this p value [-]
RANK_COLUMNS = ["factor", "level", "ratio", "p_largest", "p_smallest"]
DRAWS = 9_999  # samples drawn of motions or earthquakes
DRAWN_AT_ONCE = 2_000_000
"""Numbers drawn at a time; the stream of random numbers does not depend on it."""


@dataclass(frozen=True)
class PedestalStudy:
    """Everything about P against NP for one table of tests.

    Parameters
    ----------
    pairs, effects : tests sorted into pairs; see `effects_table`
    whole, without_earthquake
        Tests of the whole: method, estimate, lower, upper (as ratios), p, smallest_p, units, remark; see
        `leave_one_earthquake_out`.
    ranks : factor, level, mean ratio, p_largest, p_smallest
    notes : in words: population, what was left out, what the steps cannot tell
    """

    pairs: Pairs
    effects: pd.DataFrame
    whole: pd.DataFrame
    without_earthquake: pd.DataFrame
    ranks: pd.DataFrame
    notes: tuple[str, ...]

    __repr__ = short_repr


def effects_table(table: pd.DataFrame, floors: Sequence[str] = ()) -> pd.DataFrame:
    """Ratio P/NP for every scope of pairs (`Pairs.table`), with floors in the given order.

    Limits are of 95 %; p_holm adjusts within the scope, p_bh over all rows; p_equivalence is of ±10 %;
    detectable_ratio has 80 % power; up to resolution_ratio the steps of the amplitudes leave the mean open; tied
    pairs have equal amplitudes on both sides; of those at_bound one test never overturned.
    """
    rows: list[list[object]] = []
    known = [name for name in floors if name in set(table["floor"])]
    floor = pd.Categorical(
        table["floor"], [*known, *sorted(set(table["floor"]) - set(known))]
    )
    tied, at_bound = table["d"].abs() < cluster_means.ROUNDING, table["bound"] != ""
    table = table.assign(floor=floor, tied=tied, at_bound=at_bound)
    for scope, columns in SCOPES.items():
        groups = table.groupby(list(columns) or np.zeros(len(table)), observed=True)
        sampled = cluster_means.sampled_units(
            table.assign(group=groups.ngroup()), "group"
        )
        for place, (key, pairs) in enumerate(groups):
            effect = sampled[place].effect()
            flips = cluster_means.sign_flip_test(sampled[place].d)
            same = cluster_means.equivalence(effect)
            level = "/".join(map(str, key)) if isinstance(key, tuple) else "all"
            unit = "earthquake" if len(set(pairs["earthquake"])) > 1 else "motion"
            estimate = (effect.ratio, effect.ratio_lower, effect.ratio_upper, effect.p)
            open_to = (
                cluster_means.detectable_ratio(effect),
                math.exp(effect.resolution),
            )
            rows.append(
                [
                    *(scope, level, len(pairs), unit, effect.units, *estimate, flips.p),
                    *(flips.smallest_p, same, same < EQUIVALENCE_LEVEL, *open_to),
                    *pairs[["tied", "at_bound"]].sum(),
                ]
            )
    given = [name for name in EFFECT_COLUMNS if name not in ("p_holm", "p_bh")]
    result = pd.DataFrame(rows, columns=given)
    holm = result.groupby("scope")["p"].transform(cluster_means.holm)
    result = result.assign(
        p_holm=holm, p_bh=cluster_means.benjamini_hochberg(result["p"])
    )
    return result[EFFECT_COLUMNS]


def _whole_tests(table: pd.DataFrame, seed: int) -> pd.DataFrame:
    effect = cluster_means.mean_effect(table)
    unit = "earthquake" if len(set(table["earthquake"])) > 1 else "motion"
    flips = cluster_means.sign_flip_test(cluster_means.earthquake_means(table), seed)
    remark = "keeps its level in the crossed design; the conclusions rest on it"
    if effect.upper <= effect.mean + effect.resolution:
        remark += "; the limits are the width of the steps, not of the scatter"
    estimate, nan = (
        (effect.ratio, effect.ratio_lower, effect.ratio_upper, effect.p),
        math.nan,
    )
    drawn = "exact" if flips.exact else f"drawn with seed {seed}"
    of_t = (f"t on the means of {unit}s", *estimate, nan, effect.units, remark)
    flipped = (effect.ratio, nan, nan, flips.p, flips.smallest_p, flips.units, drawn)
    rows = [of_t, ("sign flips over earthquakes", *flipped)]
    return pd.DataFrame(rows, columns=WHOLE_COLUMNS)


def _ranks(table: pd.DataFrame, seed: int) -> pd.DataFrame:
    """Rank probabilities of d: objects over motions, floors over earthquakes, earthquakes over their motions.

    Of many levels none is ranked. Floors share the earthquake and objects the motion, so they are drawn together.
    """
    parts = []
    clusters = {"object": "motion", "floor": "earthquake", "earthquake": "motion"}
    for factor, cluster in clusters.items():
        if table[factor].nunique() > MOST_RANKED:
            continue
        within = factor == "earthquake"
        ranks = rank_probabilities(table, factor, cluster, seed, within=within)
        ranks.insert(0, "factor", factor)
        parts.append(ranks.assign(mean=np.exp(ranks["mean"])))
    return pd.concat(parts, ignore_index=True).rename(columns={"mean": "ratio"})


def study_pedestal(
    tests: pd.DataFrame, *, seed: int, slenderness: Mapping[str, float] | None = None
) -> PedestalStudy:
    """Do everything for one table of tests, simulated or measured alike.

    Parameters
    ----------
    tests, seed
        See :func:`rockfrag.effects.paired_tests.check_tests`; the seed of the bootstrap and of drawn sign flips.
    slenderness : height over width by object [-]; needed only for slopes on it

    Returns
    -------
    The :class:`PedestalStudy`.
    """
    pairs = pair_tests(tests, slenderness)
    table = pairs.table
    if table.empty:
        columns = (
            EFFECT_COLUMNS,
            WHOLE_COLUMNS,
            cluster_means.WITHOUT_COLUMNS,
            RANK_COLUMNS,
        )
        effects, whole, without, ranks = (
            pd.DataFrame(columns=names) for names in columns
        )
        notes = (*pairs.notes(), *SAY("no_ratio"))
        return PedestalStudy(pairs, effects, whole, without, ranks, notes)
    tied = table["d"].abs() < cluster_means.ROUNDING
    widest = float(table.loc[tied, "resolution"].max())
    population = SAY("population", table["earthquake"].nunique())
    notes = (
        *population,
        *pairs.notes(),
        *SAY("ties", int(tied.sum()), len(table), widest),
    )
    effects = effects_table(table, list(tests["floor"].astype(str).unique()))
    without = cluster_means.leave_one_earthquake_out(table)
    whole, ranks = _whole_tests(table, seed), _ranks(table, seed)
    return PedestalStudy(pairs, effects, whole, without, ranks, notes)


def rank_probabilities(
    table: pd.DataFrame, factor: str, cluster: str, seed: int, *, within: bool = False
) -> pd.DataFrame:
    """How often each level of a factor has the largest and the smallest mean of ``d`` in resampled data.

    All rows of a drawn ``cluster`` (earthquake or motion) come. ``within`` draws clusters separately inside each
    level (the motions of each earthquake); otherwise the same ones for all levels, which keeps what the levels
    share. Columns: level, mean, p_largest, p_smallest; ties share their draw.
    """
    rng = np.random.default_rng(seed)
    levels = sorted(table[factor].unique())
    if len(levels) == 1:
        drawn = np.zeros((1, 1))
    elif within:
        means = [
            rows.groupby(cluster)["d"].mean().to_numpy()
            for _, rows in table.groupby(factor)
        ]
        drawn = np.column_stack([_resampled(of_level, rng) for of_level in means])
    else:
        cells = table.pivot_table(
            index=cluster, columns=factor, values="d", aggfunc="mean"
        )
        drawn = _resampled(cells[levels].dropna().to_numpy(), rng)
    mean = table.groupby(factor)["d"].mean()[levels].to_numpy()
    ends = (
        drawn == extreme(drawn, axis=1, keepdims=True) for extreme in (np.max, np.min)
    )
    largest, smallest = (
        (at / at.sum(axis=1, keepdims=True)).mean(axis=0) for at in ends
    )
    found = {
        "level": levels,
        "mean": mean,
        "p_largest": largest,
        "p_smallest": smallest,
    }
    return pd.DataFrame(found)


def _resampled(means: Array, rng: np.random.Generator) -> Array:
    """Means of ``DRAWS`` samples of n out of n with replacement, some at a time so that memory stays small."""
    n = len(means)
    at_once = max(1, DRAWN_AT_ONCE // max(n, 1))
    sizes = (min(at_once, DRAWS - begin) for begin in range(0, DRAWS, at_once))
    return np.concatenate(
        [means[rng.integers(0, n, size=(size, n))].mean(axis=1) for size in sizes]
    )
