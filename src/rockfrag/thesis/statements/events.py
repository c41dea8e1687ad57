"""C45 to C49 and C52: what the earthquakes do."""

import math

import numpy as np
import pandas as pd
from scipy import stats

from rockfrag.pedestal.bootstrap import rank_probabilities, share_largest
from rockfrag.pedestal.cluster_means import Estimate, contrast, t_estimate
from rockfrag.pedestal.multiplicity import holm
from rockfrag.thesis.statements.evidence import Evidence, Undecidable
from rockfrag.thesis.statements.ledger import ClaimResult
from rockfrag.thesis.statements.results import ratio_result
from rockfrag.thesis.statements.verdicts import all_of, direction, extreme, remark

EVENTS = ("Friuli", "Kobe", "Loma Prieta", "Northridge")
MEASURES = {
    "pgv_over_pga_s": "PGV/PGA",
    "mean_period_s": "mean period",
    "d5_95_s": "significant duration",
}
WEAK = 0.3
"""Correlation below which "no correlation" is a fair word [-]."""
ONE_EVENT = "inference is about motions of the same event on the tested floors"


def _event_effects(evidence: Evidence, names: tuple[str, ...]) -> dict[str, Estimate]:
    return {name: evidence.effect(event=name) for name in names}


def _p_holm(evidence: Evidence, name: str) -> float:
    return evidence.p_holm("event", evidence.level("event", name))


def c45(evidence: Evidence) -> ClaimResult:
    """Three increases."""
    effects = _event_effects(evidence, EVENTS[:3])
    verdicts = [direction(one, +1, p=_p_holm(evidence, name)) for name, one in effects.items()]
    verdict = all_of(verdicts)
    weakest = min(effects.values(), key=lambda one: one.mean)
    return ratio_result(
        45,
        "mean of d of each of the three events, t over its motions, Holm over the events",
        "P/NP " + ", ".join(f"{name} {one.text()}" for name, one in effects.items()),
        verdict,
        evidence.basis,
        weakest,
        unit="motion",
        more=f"the figure is the smallest of them; {ONE_EVENT}",
    )


def c46(evidence: Evidence) -> ClaimResult:
    """One decrease."""
    effect = evidence.effect(event="Northridge")
    p = _p_holm(evidence, "Northridge")
    verdict = direction(effect, -1, p=p)
    return ratio_result(
        46,
        "mean of d of Northridge, t over its motions, Holm over the events",
        f"P/NP {effect.text()}, p (Holm) = {p:.3f}",
        verdict,
        evidence.basis,
        effect,
        unit="motion",
        more=ONE_EVENT,
    )


def c47(evidence: Evidence) -> ClaimResult:
    """Loma Prieta against the other events, floor by floor."""
    table = evidence.table
    top = evidence.level("event", "Loma Prieta")
    others = [evidence.level("event", name) for name in EVENTS if name != "Loma Prieta"]
    differences = {other: contrast(table, "event", top, other, block="floor") for other in others}
    verdict, decisive = extreme(differences)
    ranks = rank_probabilities(table, "event", "motion", evidence.seed, within=True)
    p_largest = share_largest(ranks, top)
    one = differences[decisive]
    return ratio_result(
        47,
        "d of Loma Prieta minus that of each other event, floor by floor, each one-sided at 5 %; "
        "bootstrap over motions",
        f"Loma Prieta over {decisive} {one.text()}; it is largest with probability {p_largest:.2f}",
        verdict,
        evidence.basis,
        one,
        unit="floor",
        more="see C48, which says otherwise",
    )


def c48(evidence: Evidence) -> ClaimResult:
    """Friuli significant, and above Loma Prieta and Kobe."""
    table = evidence.table
    top = evidence.level("event", "Friuli")
    others = [evidence.level("event", name) for name in ("Kobe", "Loma Prieta")]
    own = evidence.effect(event="Friuli")
    p = _p_holm(evidence, "Friuli")
    differences = {other: contrast(table, "event", top, other, block="floor") for other in others}
    exceeds, decisive = extreme(differences)
    verdict = all_of([direction(own, +1, p=p), exceeds])
    one = differences[decisive]
    return ratio_result(
        48,
        "mean of d of Friuli, t over its motions, Holm over the events; d of Friuli minus that of "
        "Kobe and of Loma Prieta, floor by floor, each one-sided at 5 %",
        f"P/NP Friuli {own.text()}, p (Holm) = {p:.3f}; over {decisive} {one.text()}",
        verdict,
        evidence.basis,
        own,
        unit="motion",
        more="see C47, which says otherwise",
    )


def c49(evidence: Evidence) -> ClaimResult:
    """How many pairs gain."""
    table = evidence.table
    # a pair that does not change counts half for each side
    gain = (np.sign(table["d"]) + 1) / 2
    half_a_pair = 0.5 * table["event"].nunique() / len(table)
    share = t_estimate(gain.groupby(table["event"]).mean(), resolution=half_a_pair)
    off = Estimate(
        share.mean - 0.5, share.se, share.units, share.lower - 0.5, share.upper - 0.5, math.nan
    )
    verdict = "undecided"
    if off.p_above(0.0) < 0.025:
        verdict = "supported"
    elif off.p_below(0.0) < 0.025 or (table["d"] == 0).all():
        verdict = "contradicted"
    effect = evidence.effect()
    return ClaimResult(
        49,
        "share of pairs with a higher amplitude on the pedestal, t over events against one half",
        f"{int((table['d'] > 0).sum())} of {len(table)} pairs higher, "
        f"{int((table['d'] < 0).sum())} lower; mean P/NP {effect.text()}",
        verdict,
        evidence.basis,
        share.mean,
        max(0.0, share.lower),
        min(1.0, share.upper),
        remark=remark(verdict, effect),
    )


def _motions_with_measures(evidence: Evidence) -> pd.DataFrame:
    if evidence.measures is None:
        raise Undecidable("the intensity measures of the motions were not given")
    wanted = [name for name in MEASURES if name in evidence.measures.columns]
    if not wanted or "name" not in evidence.measures:
        raise Undecidable(f"the measures lack the columns {', '.join(['name', *MEASURES])}")
    effects = evidence.table.groupby(["motion", "event"])["d"].mean().reset_index()
    measures = evidence.measures.drop_duplicates("name").set_index("name")[wanted]
    joined = effects.join(measures, on="motion", how="inner")
    if len(joined) < 4:
        raise Undecidable(f"only {len(joined)} motions of the tests have measures by their name")
    return joined


def motions_needed(correlation: float) -> int:
    """Motions that show a correlation with 80 % power at 5 % (Fisher's z)."""
    z = stats.norm.ppf(0.975) + stats.norm.ppf(0.8)
    return math.ceil((float(z) / math.atanh(correlation)) ** 2 + 3)


def c52(evidence: Evidence) -> ClaimResult:
    """Rank correlation of the motions' effects with what the motions are like."""
    joined = _motions_with_measures(evidence)
    n = len(joined)
    found = []
    for name, label in MEASURES.items():
        if name not in joined or joined[name].isna().any() or np.ptp(joined["d"]) == 0:
            continue
        rho, p = stats.spearmanr(joined[name], joined["d"])
        found.append((label, float(rho), float(p)))
    if not found:
        raise Undecidable("the effect or a measure does not vary from motion to motion")
    adjusted = holm([p for _, _, p in found])
    label, rho, _ = max(found, key=lambda row: abs(row[1]))
    half = float(stats.norm.ppf(0.975)) * math.sqrt(1.06 / (n - 3))
    z = math.atanh(np.clip(rho, -0.999999, 0.999999))
    lower, upper = math.tanh(z - half), math.tanh(z + half)
    verdict = "undecided"
    if np.nanmin(adjusted) < 0.05:
        verdict = "contradicted"
    elif max(abs(lower), abs(upper)) < WEAK:
        verdict = "supported"
    return ClaimResult(
        52,
        "Spearman's correlation of the motions' mean d with PGV/PGA, mean period and significant "
        "duration, Holm over the three; |ρ| below 0.3 counts as none",
        f"{n} motions; "
        + ", ".join(
            f"{name} ρ = {value:.2f} (Holm p {p:.2f})"
            for (name, value, _), p in zip(found, adjusted, strict=True)
        ),
        verdict,
        evidence.basis,
        rho,
        lower,
        upper,
        remark=f"the figure is the largest, {label}; with {n} motions nothing below "
        f"|ρ| = {detectable_correlation(n):.2f} shows with 80 % power, |ρ| = {WEAK} needs "
        f"{motions_needed(WEAK)} motions",
    )


def detectable_correlation(n: int) -> float:
    """Smallest correlation that n motions show with 80 % power at 5 % (Fisher's z)."""
    z = float(stats.norm.ppf(0.975) + stats.norm.ppf(0.8))
    return math.tanh(z / math.sqrt(n - 3))
