"""C25 to C33, C53, C54: what the towers' slenderness does."""

import itertools
import math

import numpy as np
import pandas as pd
from scipy import stats

from rockfrag.pedestal.bootstrap import rank_probabilities, share_largest
from rockfrag.pedestal.cluster_means import Array, Estimate, contrast, slope_effect, t_estimate
from rockfrag.pedestal.equivalence import equivalence
from rockfrag.rocking.bodies import Stack
from rockfrag.thesis.specimens import THESIS_BODIES
from rockfrag.thesis.statements.evidence import Evidence, Undecidable
from rockfrag.thesis.statements.ledger import ClaimResult
from rockfrag.thesis.statements.results import ratio_result
from rockfrag.thesis.statements.verdicts import all_of, direction, extreme, same

AICC_MARGIN = 2.0
FLATTEST, STEEPEST = "T1", "T3"


def _aicc(rows: pd.DataFrame, x: pd.Series) -> float:
    """Corrected AIC of a = motion and side + slope·x by least squares (Hurvich and Tsai 1989)."""
    block = rows["motion"] + "|" + rows["side"]
    y = (rows["a_g"] - rows["a_g"].groupby(block).transform("mean")).to_numpy()
    centred = (x - x.groupby(block).transform("mean")).to_numpy()
    residual = y - centred * (centred @ y) / (centred @ centred)
    n, k = len(rows), block.nunique() + 2
    if n - k - 1 <= 0:
        raise Undecidable("too few tests for an information criterion")
    variance = float(residual @ residual) / n
    if variance <= 0:
        raise Undecidable("the amplitudes have no scatter about the line")
    return n * math.log(variance) + 2 * k + 2 * k * (k + 1) / (n - k - 1)


def c25(evidence: Evidence) -> ClaimResult:
    """Linear fall with slenderness: the slope, the bend at T2, and AICc of H/B against B/H."""
    rows = evidence.amplitudes
    low, middle, high = (evidence.level("object", name) for name in ("T1", "T2", "T3"))
    means = rows.pivot_table(index="event", columns="object", values="a_g", aggfunc="mean").dropna()
    ends = (means[low] + means[high]) / 2
    bend = t_estimate(np.log(means[middle] / ends))
    slope = slope_effect(rows, "slenderness", "ln_a")
    linear, inverse = _aicc(rows, rows["slenderness"]), _aicc(rows, 1 / rows["slenderness"])
    falls = direction(slope, -1)
    straight = equivalence(bend)
    verdict = falls
    if falls == "supported" and not straight.shown():
        verdict = "contradicted" if bend.p < 0.05 else "undecided"
    better = "H/B" if linear < inverse else "B/H"
    return ratio_result(
        25,
        "slope of ln a on H/B inside each event, t over events; mean of T2 against the middle of T1 "
        "and T3, equivalence ±10 %; AICc of H/B against B/H",
        f"T2 over the straight line {bend.text()}; change per unit of H/B {slope.text()}; AICc H/B "
        f"{linear:.1f}, B/H {inverse:.1f}",
        verdict,
        evidence.basis,
        bend,
        more=f"AICc prefers {better}"
        + ("" if abs(linear - inverse) >= AICC_MARGIN else ", by less than 2, so hardly")
        + "; equilibrium alone gives B/H",
    )


def _slopes(evidence: Evidence) -> dict[str, Estimate]:
    rows = evidence.amplitudes
    return {
        side: slope_effect(rows[rows["side"] == side], "slenderness", "ln_a")
        for side in ("P", "NP")
    }


def c26(evidence: Evidence) -> ClaimResult:
    """The fall on both sides."""
    slopes = _slopes(evidence)
    verdict = all_of([direction(one, -1) for one in slopes.values()])
    weakest = max(slopes.values(), key=lambda one: one.mean)
    return ratio_result(
        26,
        "slope of ln a on H/B inside each event, t over events, P and NP each at 5 %",
        f"factor per unit of H/B: P {slopes['P'].text()}, NP {slopes['NP'].text()}",
        verdict,
        evidence.basis,
        weakest,
        more="the figure is the weaker of the two",
    )


def c27(evidence: Evidence) -> ClaimResult:
    """Equal relative decrease from T1 to T3."""
    low, high = evidence.level("object", FLATTEST), evidence.level("object", STEEPEST)
    difference = contrast(evidence.table, "object", high, low)
    verdict = same(difference)
    return ratio_result(
        27,
        "decrease of ln a from T1 to T3, P minus NP, event by event; equivalence ±10 %",
        f"decrease with P over decrease without {difference.text()}, equivalence p "
        f"{equivalence(difference).p:.3f}",
        verdict,
        evidence.basis,
        difference,
    )


def _repeated_measures(grid: Array) -> tuple[float, float]:
    """F and p of columns (floors) with rows (events) as blocks."""
    rows, columns = grid.shape
    grand = grid.mean()
    between = rows * np.sum((grid.mean(axis=0) - grand) ** 2) / (columns - 1)
    residual = grid - grid.mean(axis=0) - grid.mean(axis=1, keepdims=True) + grand
    free = (rows - 1) * (columns - 1)
    within = float(np.sum(residual**2)) / free
    if within < 1e-24:
        return math.nan, math.nan
    f = float(between / within)
    return f, float(stats.f.sf(f, columns - 1, free))


def c28(evidence: Evidence) -> ClaimResult:
    """Slopes of ln a on H/B by floor, events as blocks."""
    rows = evidence.amplitudes
    slopes = {
        (event, floor): slope_effect(part, "slenderness", "ln_a").mean
        for (event, floor), part in rows.groupby(["event", "floor"])
        if len(set(part["slenderness"])) > 1
    }
    grid = pd.Series(slopes).rename_axis(["event", "floor"]).reset_index(name="slope")
    wide = grid.pivot_table(index="event", columns="floor", values="slope").dropna()
    if wide.shape[0] < 2 or wide.shape[1] < 2:
        raise Undecidable("slopes for two events and two floors are needed")
    f, p = _repeated_measures(wide.to_numpy())
    span = max(evidence.slenderness.values()) - min(evidence.slenderness.values())
    names = sorted(wide.columns)
    pairs = {
        f"{one} against {other}": t_estimate(span * (wide[one] - wide[other]))
        for i, one in enumerate(names)
        for other in names[i + 1 :]
    }
    widest = max(pairs, key=lambda name: abs(pairs[name].mean))
    verdict = "undecided"
    if p < 0.05:
        verdict = "supported"
    elif all(equivalence(one).shown() for one in pairs.values()):
        verdict = "contradicted"
    figure = pairs[widest]
    return ratio_result(
        28,
        "slope of ln a on H/B by event and floor; F test of floors with events as blocks; "
        "equivalence ±10 % of all pairs of floors over the range of H/B",
        f"F = {f:.2f}, p = {p:.3f}; decrease over the range, {widest}: ratio {figure.text()}",
        verdict,
        evidence.basis,
        figure,
    )


def c29(evidence: Evidence) -> ClaimResult:
    """The whole effect of the pedestal."""
    effect = evidence.effect()
    verdict = direction(effect, +1)
    return ratio_result(
        29,
        "mean of ln(P/NP) of all pairs, t over events; equivalence ±10 %",
        f"P/NP {effect.text()}, p = {effect.p:.3f}, equivalence p = {equivalence(effect).p:.3f}",
        verdict,
        evidence.basis,
        effect,
    )


def stack_slenderness(evidence: Evidence) -> pd.DataFrame:
    """Slenderness of the standing stack, height of the common centre over half the base's width.

    Returns
    -------
    pandas.DataFrame
        tower, alone, stacked [-].
    """
    bodies = evidence.bodies or THESIS_BODIES
    rows = []
    for name in sorted(set(bodies) - {"P"}):
        arm = Stack(bodies["P"], bodies[name]).common_arm(1)
        rows.append((name, bodies[name].h / bodies[name].b, arm.y / bodies["P"].b))
    return pd.DataFrame(rows, columns=["object", "alone", "stacked"])


def c30(evidence: Evidence) -> ClaimResult:
    """Geometry of the stack, computed from the specimens."""
    table = stack_slenderness(evidence)
    ratio = float((table["stacked"] / table["alone"]).max())
    more_slender = bool((table["stacked"] > table["alone"]).any())
    stacked = ", ".join(f"{value:.2f}" for value in table["stacked"])
    alone = ", ".join(f"{value:.2f}" for value in table["alone"])
    return ClaimResult(
        30,
        "height of the common centre of gravity over half the pedestal's width, from the specimens",
        f"stack {stacked} against {alone} of the towers alone ({', '.join(table['object'])})",
        "undecided" if more_slender else "contradicted",
        evidence.basis,
        ratio,
        ratio,
        ratio,
        remark="exact; the common centre rises, but the base widens more"
        if not more_slender
        else "the stack is more slender for a tower, see C29 for its strength",
    )


def c31(evidence: Evidence) -> ClaimResult:
    """No trend of the effect with slenderness."""
    table = evidence.table
    slope = slope_effect(table)
    span = float(np.ptp(table["slenderness"]))
    over = slope.times(span)
    verdict = same(over)
    r = (
        float(np.corrcoef(table["slenderness"], table["d"])[0, 1])
        if np.ptp(table["d"]) > 0
        else 0.0
    )
    return ratio_result(
        31,
        "slope of d on H/B inside each event, t over events; equivalence ±10 % over the range",
        f"change of P/NP over the range of H/B {over.text()}; correlation over pairs {r:.2f}",
        verdict,
        evidence.basis,
        over,
    )


def c32(evidence: Evidence) -> ClaimResult:
    """T3's effect against T1's and T2's."""
    table = evidence.table
    top = evidence.level("object", "T3")
    others = [evidence.level("object", name) for name in ("T1", "T2")]
    differences = {other: contrast(table, "object", top, other) for other in others}
    verdict, decisive = extreme(differences)
    p_largest = share_largest(rank_probabilities(table, "object", "motion", evidence.seed), top)
    one = differences[decisive]
    return ratio_result(
        32,
        "d of T3 minus d of T1 and of T2, event by event, each one-sided at 5 %; bootstrap over "
        "motions",
        f"P/NP of T3 over that of {decisive} {one.text()}; T3 is largest with probability "
        f"{p_largest:.2f}",
        verdict,
        evidence.basis,
        one,
    )


def c33(evidence: Evidence) -> ClaimResult:
    """T2's slight increase."""
    effect = evidence.effect(object="T2")
    p = evidence.p_holm("object", evidence.level("object", "T2"))
    verdict = direction(effect, +1, p=p, slight=True)
    return ratio_result(
        33,
        "mean of d of T2, t over events, Holm over the towers",
        f"P/NP of T2 {effect.text()}, p (Holm) = {p:.3f}",
        verdict,
        evidence.basis,
        effect,
        more="'nearly opposite' and 'still increases' cannot both be the sign",
    )


def c53(evidence: Evidence) -> ClaimResult:
    """T1 above T2 above T3."""
    rows = evidence.amplitudes
    objects = [evidence.level("object", name) for name in ("T1", "T2", "T3")]
    steps = {
        f"{flat} over {slender}": contrast(rows, "object", flat, slender, value="ln_a")
        for flat, slender in itertools.pairwise(objects)
    }
    verdict, decisive = extreme(steps)
    one = steps[decisive]
    return ratio_result(
        53,
        "ln a of T1 minus T2 and of T2 minus T3, event by event, each one-sided at 5 %",
        f"{decisive} {one.text()}",
        verdict,
        evidence.basis,
        one,
        more="the figure is the weaker of the two steps",
    )


def c54(evidence: Evidence) -> ClaimResult:
    """Predict T3 from T1 and T2, motion by motion, and look at the error."""
    rows = evidence.amplitudes
    objects = [evidence.level("object", name) for name in ("T1", "T2", "T3")]
    wide = rows.pivot_table(index=["event", "motion", "side"], columns="object", values="ln_a")
    wide = wide[objects].dropna()
    if wide.empty:
        raise Undecidable("no motion overturned all three towers on one side")
    s1, s2, s3 = (evidence.slenderness[name] for name in objects)
    weight = (s3 - s1) / (s2 - s1)
    predicted = wide[objects[0]] + weight * (wide[objects[1]] - wide[objects[0]])
    error = (predicted - wide[objects[2]]).abs().groupby("event").mean()
    size = t_estimate(error)
    bound = math.log(1.1)
    verdict = "undecided"
    if size.p_above(bound) < 0.05:
        verdict = "supported"
    elif size.p_below(bound) < 0.05:
        verdict = "contradicted"
    return ratio_result(
        54,
        "line of ln a through T1 and T2 prolonged to T3, motion by motion and side; mean absolute "
        "error by event, t over events, against 10 %",
        f"mean error of the prediction, as a factor {size.text()}",
        verdict,
        evidence.basis,
        size,
        more="contains the scatter of the tests themselves",
    )
