"""Effect of a pedestal as tables: every scope with interval, equivalence, multiplicity and power.

In: a table of tests, or its pairs (:mod:`rockfrag.effects.paired_tests`). Out: :class:`PedestalStudy`, ratios
with over without pedestal [-] with 95 % limits and p values [-]. Theory: ``docs/pedestal.md``, "Which test, and
about what".
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.base.short_repr import short_repr
from rockfrag.effects import cluster_means
from rockfrag.effects.cluster_means import Array
from rockfrag.effects.notes import NO_RATIO, note_on_population, notes_on_ties
from rockfrag.effects.paired_tests import Pairs, pair_tests

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
    "scope",
    "level",
    "pairs",
    "unit",
    "units",
    "ratio",
    "lower",
    "upper",
    "p",
    "p_holm",
    "p_bh",
    "p_sign_flip",
    "smallest_p",
    "p_equivalence",
    "equivalent",
    "detectable_ratio",
    "resolution_ratio",
    "tied",
    "at_bound",
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
    """Effect of the pedestal in one table of tests.

    Parameters
    ----------
    pairs, effects : tests sorted into pairs; see `effects_table`
    whole, without_earthquake
        Tests of the whole: method, estimate, lower, upper (as ratios), p, smallest_p, units, remark; see
        `leave_one_earthquake_out`.
    ranks : factor, level, mean ratio, p_largest, p_smallest
    notes : on the population, on pairs left out, and on the steps, in words
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

    Parameters
    ----------
    table, floors : pairs, and the order of their floors

    Returns
    -------
    A row a level of a scope. Limits are of 95 %; p_holm adjusts within the scope, p_bh over all rows;
    p_equivalence is of ±10 %; detectable_ratio has 80 % power; up to resolution_ratio the steps of the
    amplitudes leave the mean open; tied pairs have equal amplitudes on both sides; of those at_bound one test
    never overturned.
    """
    rows: list[dict[str, object]] = []
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
            level = "/".join(map(str, key)) if isinstance(key, tuple) else "all"
            row = _effect_row(pairs, sampled[place])
            rows.append({"scope": scope, "level": level, **row})
    result = pd.DataFrame(rows)
    holm = result.groupby("scope")["p"].transform(cluster_means.holm)
    result = result.assign(
        p_holm=holm, p_bh=cluster_means.benjamini_hochberg(result["p"])
    )
    return result[EFFECT_COLUMNS]


def _effect_row(pairs: pd.DataFrame, sampled: cluster_means.Units) -> dict[str, object]:
    """Columns of `effects_table` of one group of pairs, but for its scope and adjusted p values."""
    effect = sampled.effect()
    flips = cluster_means.sign_flip_test(sampled.d)
    equivalence = cluster_means.equivalence(effect)
    return {
        "pairs": len(pairs),
        "unit": "earthquake" if len(set(pairs["earthquake"])) > 1 else "motion",
        "units": effect.units,
        "ratio": effect.ratio,
        "lower": effect.ratio_lower,
        "upper": effect.ratio_upper,
        "p": effect.p,
        "p_sign_flip": flips.p,
        "smallest_p": flips.smallest_p,
        "p_equivalence": equivalence,
        "equivalent": equivalence < EQUIVALENCE_LEVEL,
        "detectable_ratio": cluster_means.detectable_ratio(effect),
        "resolution_ratio": math.exp(effect.resolution),
        "tied": pairs["tied"].sum(),
        "at_bound": pairs["at_bound"].sum(),
    }


def _whole_tests(table: pd.DataFrame, seed: int) -> pd.DataFrame:
    """Tests of the effect over all pairs: limits, t and sign flips."""
    effect = cluster_means.mean_effect(table)
    unit = "earthquake" if len(set(table["earthquake"])) > 1 else "motion"
    flips = cluster_means.sign_flip_test(cluster_means.earthquake_means(table), seed)
    remark = "keeps its level in the crossed design; the conclusions rest on it"
    if effect.upper <= effect.mean + effect.resolution:
        remark += "; the limits are the width of the steps, not of the scatter"
    by_t = {
        "method": f"t on the means of {unit}s",
        "estimate": effect.ratio,
        "lower": effect.ratio_lower,
        "upper": effect.ratio_upper,
        "p": effect.p,
        "smallest_p": math.nan,
        "units": effect.units,
        "remark": remark,
    }
    by_flips = {
        "method": "sign flips over earthquakes",
        "estimate": effect.ratio,
        "lower": math.nan,
        "upper": math.nan,
        "p": flips.p,
        "smallest_p": flips.smallest_p,
        "units": flips.units,
        "remark": "exact" if flips.exact else f"drawn with seed {seed}",
    }
    return pd.DataFrame([by_t, by_flips], columns=WHOLE_COLUMNS)


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
    """Study the effect of the pedestal in one table of tests, simulated or measured alike.

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
        return PedestalStudy(
            pairs,
            effects=pd.DataFrame(columns=EFFECT_COLUMNS),
            whole=pd.DataFrame(columns=WHOLE_COLUMNS),
            without_earthquake=pd.DataFrame(columns=cluster_means.WITHOUT_COLUMNS),
            ranks=pd.DataFrame(columns=RANK_COLUMNS),
            notes=(*pairs.notes(), NO_RATIO),
        )
    tied = table["d"].abs() < cluster_means.ROUNDING
    widest = float(table.loc[tied, "resolution"].max())
    return PedestalStudy(
        pairs,
        effects=effects_table(table, list(tests["floor"].astype(str).unique())),
        whole=_whole_tests(table, seed),
        without_earthquake=cluster_means.leave_one_earthquake_out(table),
        ranks=_ranks(table, seed),
        notes=(
            note_on_population(table["earthquake"].nunique()),
            *pairs.notes(),
            *notes_on_ties(int(tied.sum()), len(table), widest),
        ),
    )


def rank_probabilities(
    table: pd.DataFrame, factor: str, cluster: str, seed: int, *, within: bool = False
) -> pd.DataFrame:
    """Fraction of resampled data in which each level of a factor has the largest and the smallest mean of ``d``.

    Parameters
    ----------
    table, factor : pairs, and the column whose levels are ranked
    cluster : column of what is drawn, all rows of it together: earthquake or motion
    seed : of the random numbers
    within
        Draws clusters separately inside each level (the motions of each earthquake); otherwise the same ones for
        all levels, which keeps the dependence between levels.

    Returns
    -------
    A row a level: level, mean [-], p_largest, p_smallest [-]; tied levels divide their draw.
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
    largest = drawn == drawn.max(axis=1, keepdims=True)
    smallest = drawn == drawn.min(axis=1, keepdims=True)
    return pd.DataFrame(
        {
            "level": levels,
            "mean": mean,
            "p_largest": _mean_part(largest),
            "p_smallest": _mean_part(smallest),
        }
    )


def _mean_part(at_end: NDArray[np.bool_]) -> Array:
    """Mean over draws, (draws, levels), of the part of a draw that each level has; tied levels divide it."""
    return np.asarray((at_end / at_end.sum(axis=1, keepdims=True)).mean(axis=0))


def _resampled(means: Array, rng: np.random.Generator) -> Array:
    """Means of ``DRAWS`` samples of n out of n with replacement, some at a time so that memory stays small."""
    n = len(means)
    at_once = max(1, DRAWN_AT_ONCE // max(n, 1))
    sizes = (min(at_once, DRAWS - begin) for begin in range(0, DRAWS, at_once))
    return np.concatenate(
        [means[rng.integers(0, n, size=(size, n))].mean(axis=1) for size in sizes]
    )
