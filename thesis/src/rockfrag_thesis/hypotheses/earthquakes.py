"""C45 to C48, C52: what the earthquakes do.

In: tables of tests. Out: an outcome a hypothesis. Theory: ``docs/hypotheses.md``.
"""

import math
from collections.abc import Mapping

import pandas as pd
from scipy import stats

from rockfrag.effects.cluster_means import LEVEL as POWER_LEVEL
from rockfrag.effects.cluster_means import POWER, Estimate
from rockfrag_thesis.hypotheses.evidence import Evidence
from rockfrag_thesis.hypotheses.hypothesis import Result, Undecidable, hypothesis
from rockfrag_thesis.hypotheses.orders import Part, Parts, Size, order_hypothesis
from rockfrag_thesis.hypotheses.outcomes import LEVEL, decided, jackknife, p_nonzero

EARTHQUAKES = (
    "Friuli",
    "Kobe",
    "Loma Prieta",
    "Northridge",
)
FRIULI, KOBE, LOMA_PRIETA, NORTHRIDGE = EARTHQUAKES
INFERENCE = "about motions of the same earthquakes on the tested floors"


@order_hypothesis(45, unit="motion", more=lambda _: INFERENCE)
def c45(tests: Evidence) -> Parts:
    """Three increases."""
    return {
        f"P/NP in {name}": Part(tests.effect(earthquake=name))
        for name in EARTHQUAKES[:3]
    }


@order_hypothesis(46, unit="motion", more=lambda _: INFERENCE)
def c46(tests: Evidence) -> Parts:
    """One decrease."""
    return {"NP/P in Northridge": Part(tests.effect(earthquake=NORTHRIDGE).times(-1))}


def _lead(tests: Evidence, top: str, others: tuple[str, ...], size: Size) -> Parts:
    """By how much P/NP of one earthquake exceeds that of others, floor by floor."""
    return {
        f"P/NP in {top} over {other}": Part(
            tests.lead("earthquake", top, other, block="floor"), size
        )
        for other in others
    }


@order_hypothesis(47, unit="floor", more=lambda _: f"{INFERENCE}; C48 says otherwise")
def c47(tests: Evidence) -> Parts:
    """Loma Prieta over the other earthquakes."""
    others = tuple(name for name in EARTHQUAKES if name != LOMA_PRIETA)
    return _lead(tests, LOMA_PRIETA, others, Size.SLIGHT)


@order_hypothesis(48, unit="floor", more=lambda _: f"{INFERENCE}; C47 says otherwise")
def c48(tests: Evidence) -> Parts:
    """Friuli's increase, and its lead over Kobe and Loma Prieta."""
    own = Part(tests.effect(earthquake=FRIULI), Size.NOTICEABLE)
    lead = _lead(tests, FRIULI, (KOBE, LOMA_PRIETA), Size.NOTICEABLE)
    return {"P/NP in Friuli": own, **lead}


MEASURES: Mapping[str, str] = {
    "pgv_over_pga_s": "PGV/PGA",
    "mean_period_s": "mean period",
    "d5_95_s": "significant duration",
}
MOTIONS = 12  # motions of the thesis


_Z = float(stats.norm.ppf(1 - POWER_LEVEL / 2) + stats.norm.ppf(POWER))

COULD_BE_FOUND = math.tanh(_Z / math.sqrt(MOTIONS - 3))
"""Correlation that as many independent motions show with 80 % power at 5 % [-] (Fisher's z)."""


def _motions_with_measures(tests: Evidence) -> pd.DataFrame:
    """A row per motion: earthquake, mean d, intensity measures."""
    if tests.measures is None:
        raise Undecidable("the intensity measures of the motions were not given")
    wanted = [name for name in MEASURES if name in tests.measures.columns]
    if not wanted or "name" not in tests.measures:
        raise Undecidable(
            f"the measures lack the columns {', '.join(['name', *MEASURES])}"
        )
    effects = tests.table.groupby(["motion", "earthquake"])["d"].mean().reset_index()
    measures = tests.measures.drop_duplicates("name").set_index("name")[wanted]
    joined = effects.join(measures, on="motion", how="inner")
    if joined["earthquake"].nunique() < 3:
        raise Undecidable(
            "motions of fewer than three earthquakes have measures by their name"
        )
    return joined


def rank_correlation(joined: pd.DataFrame, measure: str) -> Estimate:
    """Spearman's correlation of the motions' d with a measure, in Fisher's z, by jackknife over earthquakes.

    Motions of one earthquake are not independent, so whole earthquakes are left out.
    """
    earthquakes = joined["earthquake"].unique()

    def z(rows: pd.DataFrame) -> float:
        rho = float(stats.spearmanr(rows[measure], rows["d"]).statistic)
        return math.atanh(min(max(rho, -0.999), 0.999))

    return jackknife(
        z(joined),
        [z(joined[joined["earthquake"] != earthquake]) for earthquake in earthquakes],
    )


@hypothesis(52, least=COULD_BE_FOUND, motions=MOTIONS)
def c52(tests: Evidence) -> Result:
    """Rank correlation of the motions' effects with what the motions are like."""
    joined = _motions_with_measures(tests)
    n = len(joined)
    if joined["d"].round(9).value_counts().iloc[0] > n / 2:
        raise Undecidable(
            "most motions have the same effect to the step, so there is nothing to order"
        )
    found = {
        label: rank_correlation(joined, name)
        for name, label in MEASURES.items()
        if name in joined and joined[name].notna().all() and joined[name].nunique() > 2
    }
    if not found:
        raise Undecidable("no measure is known for all motions")
    p = {name: p_nonzero(estimate) for name, estimate in found.items()}
    strongest = min(p, key=p.__getitem__)
    bound = math.atanh(COULD_BE_FOUND)
    p_none = max(
        max(estimate.p_above(-bound), estimate.p_below(bound))
        for estimate in found.values()
    )
    p_some = min(1.0, p[strongest] * len(p) / 2)
    estimate = found[strongest]
    return Result(
        decided(p_none < LEVEL <= p_some, p_some < LEVEL),
        f"motions: {n}; earthquakes: {joined['earthquake'].nunique()}; "
        + ", ".join(
            f"{name} ρ = {math.tanh(each.mean):.2f} [{math.tanh(each.lower):.2f}, {math.tanh(each.upper):.2f}]"
            for name, each in found.items()
        ),
        math.tanh(estimate.mean),
        math.tanh(estimate.lower),
        math.tanh(estimate.upper),
        p=min(1.0, 2 * min(p_some, p_none)),
        p_of="no correlation"
        if p_some <= p_none
        else f"a correlation of {COULD_BE_FOUND:.2f} or more",
        remark=f"the figure is that of the {strongest}",
    )
