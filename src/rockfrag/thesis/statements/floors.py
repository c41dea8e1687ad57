"""C34 to C44, C50, C51: what the floors do."""

import math

import numpy as np
import pandas as pd

from rockfrag.pedestal.bootstrap import rank_probabilities, share_largest
from rockfrag.pedestal.cluster_means import (
    Estimate,
    contrast,
    mean_effect,
    sampled_unit,
    t_estimate,
    unit_means,
)
from rockfrag.pedestal.equivalence import MARGIN
from rockfrag.pedestal.permutation import sign_flip_test
from rockfrag.thesis.floor_order import FLOORS
from rockfrag.thesis.statements.evidence import Evidence, Undecidable
from rockfrag.thesis.statements.ledger import ClaimResult
from rockfrag.thesis.statements.results import ratio_result
from rockfrag.thesis.statements.verdicts import all_of, direction, extreme, remark

TOWERS = ("T1", "T2", "T3")
SIGNS = {"GF": (1, 1, 1), "F3": (1, -1, -1), "F5": (-1, -1, -1)}
"""Signs of the effect that C38 claims, by floor for T1, T2, T3."""


def _one_floor(evidence: Evidence, number: int, floor: str, sign: int, slight: bool) -> ClaimResult:
    effect = evidence.effect(floor=floor)
    p = evidence.p_holm("floor", evidence.level("floor", floor))
    verdict = direction(effect, sign, p=p, slight=slight)
    return ratio_result(
        number,
        f"mean of d on {floor}, t over events, Holm over the floors",
        f"P/NP {effect.text()}, p (Holm) = {p:.3f}",
        verdict,
        evidence.basis,
        effect,
    )


def c34(evidence: Evidence) -> ClaimResult:
    """An increase on the ground floor, and no noticeable one above."""
    ground = evidence.effect(floor="GF")
    p = evidence.p_holm("floor", evidence.level("floor", "GF"))
    upper = {floor: evidence.effect(floor=floor) for floor in ("F3", "F5")}
    noticeable = math.log1p(MARGIN)
    verdicts = [direction(ground, +1, p=p)]
    for floor, one in upper.items():
        adjusted = evidence.p_holm("floor", evidence.level("floor", floor))
        if adjusted < 0.05 and one.mean > 0:
            verdicts.append("contradicted")
        else:
            verdicts.append("supported" if one.p_below(noticeable) < 0.05 else "undecided")
    verdict = all_of(verdicts)
    above = ", ".join(f"{floor} {one.text()}" for floor, one in upper.items())
    return ratio_result(
        34,
        "d on GF above zero (t over events, Holm) and an increase of 10 % or more excluded on F3 and "
        "on F5 (one-sided 5 %)",
        f"P/NP GF {ground.text()}, {above}",
        verdict,
        evidence.basis,
        ground,
        more="the figure is that of GF",
    )


def c35(evidence: Evidence) -> ClaimResult:
    """Increase on the ground floor."""
    return _one_floor(evidence, 35, "GF", +1, slight=False)


def c36(evidence: Evidence) -> ClaimResult:
    """Slight decrease on the 3rd floor."""
    return _one_floor(evidence, 36, "F3", -1, slight=True)


def c37(evidence: Evidence) -> ClaimResult:
    """Slight decrease on the 5th floor."""
    return _one_floor(evidence, 37, "F5", -1, slight=True)


def c38(evidence: Evidence) -> ClaimResult:
    """Nine signs."""
    agree, verdicts, clear = 0, [], 0
    most: Estimate | None = None
    for floor, signs in SIGNS.items():
        for object_name, sign in zip(TOWERS, signs, strict=True):
            effect = evidence.effect(floor=floor, object=object_name)
            cell = f"{evidence.level('floor', floor)}/{evidence.level('object', object_name)}"
            one = direction(effect, sign, p=evidence.p_holm("cell", cell), slight=True)
            verdicts.append(one)
            agree += effect.mean * sign > 0
            clear += one == "supported"
            if most is None or effect.mean * sign < most.mean:
                most = effect.times(sign)
    assert most is not None
    verdict = all_of(verdicts)
    return ClaimResult(
        38,
        "sign of d in the nine cells floor x tower, t over events, Holm over the cells",
        f"{agree} of 9 signs as claimed, {clear} of them beyond doubt; the cell furthest against "
        f"the claim, as ratio in its direction, {most.text()}",
        verdict,
        evidence.basis,
        float(agree),
        math.nan,
        math.nan,
        unit="cells of 9",
        remark=remark(
            verdict, most, more=f"a cell has {most.units} values, too few for sign flips at 5 %"
        ),
    )


def _first_object(evidence: Evidence, number: int, floor: str, sign: int) -> ClaimResult:
    table = evidence.part(floor=floor)
    first, *others = (evidence.level("object", name) for name in TOWERS)
    oriented = table.assign(d=sign * table["d"])
    differences = {other: contrast(oriented, "object", first, other) for other in others}
    verdict, decisive = extreme(differences)
    own = mean_effect(oriented[oriented["object"] == first])
    if own.mean <= 0 and own.p < 0.05:
        verdict = "contradicted"
    one = differences[decisive]
    word = "increase" if sign > 0 else "decrease"
    return ratio_result(
        number,
        f"{word} of T1 on {floor} minus that of T2 and of T3, event by event, each one-sided at 5 %",
        f"T1's {word} over that of {decisive}, as ratio {one.text()}; T1's own as ratio "
        f"{own.text()}",
        verdict,
        evidence.basis,
        one,
    )


def c39(evidence: Evidence) -> ClaimResult:
    """T1's increase on the ground floor."""
    return _first_object(evidence, 39, "GF", +1)


def c40(evidence: Evidence) -> ClaimResult:
    """T1's decrease on the 5th floor."""
    return _first_object(evidence, 40, "F5", -1)


def c41(evidence: Evidence) -> ClaimResult:
    """Size of the change by floor, whatever its sign."""
    table = evidence.table
    ground, *others = (evidence.level("floor", name) for name in FLOORS)
    signs = np.sign(table.groupby("floor")["d"].mean())
    sized = table.assign(d=table["d"] * table["floor"].map(signs))
    differences = {other: contrast(sized, "floor", ground, other) for other in others}
    verdict, decisive = extreme(differences)
    p_largest = share_largest(rank_probabilities(sized, "floor", "event", evidence.seed), ground)
    one = differences[decisive]
    return ratio_result(
        41,
        "change on GF minus that on F3 and on F5, each in the direction of its floor's mean, event "
        "by event, each one-sided at 5 %; bootstrap over events",
        f"change on GF over that on {decisive}, as ratio {one.text()}; GF is largest with "
        f"probability {p_largest:.2f}",
        verdict,
        evidence.basis,
        one,
        more="directions are read from the data, which flatters small changes",
    )


def _largest_floor(evidence: Evidence, number: int, side: str, floor: str) -> ClaimResult:
    rows = evidence.amplitudes
    rows = rows[rows["side"] == side]
    top, *others = (
        evidence.level("floor", name)
        for name in (floor, *(name for name in FLOORS if name != floor))
    )
    differences = {other: contrast(rows, "floor", top, other, value="ln_a") for other in others}
    verdict, decisive = extreme(differences)
    ranks = rank_probabilities(rows, "floor", "event", evidence.seed, value="ln_a")
    p_largest = share_largest(ranks, top)
    means = rows.groupby("floor")["a_g"].mean()
    one = differences[decisive]
    return ratio_result(
        number,
        f"ln a of {side} on {floor} minus that on the other floors, event by event, each one-sided "
        "at 5 %; bootstrap over events",
        f"{floor} over {decisive} {one.text()}; arithmetic means "
        + ", ".join(f"{name} {means[name]:.3f} g" for name in (top, *others))
        + f"; {floor} is largest with probability {p_largest:.2f}",
        verdict,
        evidence.basis,
        one,
    )


def c42(evidence: Evidence) -> ClaimResult:
    """With the pedestal the 5th floor is highest."""
    return _largest_floor(evidence, 42, "P", "F5")


def c43(evidence: Evidence) -> ClaimResult:
    """Without it the ground floor is."""
    return _largest_floor(evidence, 43, "NP", "GF")


def c44(evidence: Evidence) -> ClaimResult:
    """The 3rd floor is lowest for every tower, with and without pedestal."""
    rows = evidence.amplitudes
    low, *others = (evidence.level("floor", name) for name in ("F3", "GF", "F5"))
    differences: dict[str, Estimate] = {}
    smallest = 0
    for (object_name, side), part in rows.groupby(["object", "side"]):
        means = part.groupby("floor")["a_g"].mean()
        smallest += means.idxmin() == low
        for other in others:
            name = f"{other} over {low} for {object_name} {side}"
            differences[name] = contrast(part, "floor", other, low, value="ln_a")
    verdict, decisive = extreme(differences)
    one = differences[decisive]
    return ratio_result(
        44,
        "ln a on GF and on F5 minus that on F3, for every tower and side, event by event, each "
        "one-sided at 5 %",
        f"F3 has the smallest mean for {smallest} of {len(differences) // 2} configurations; "
        f"{decisive} {one.text()}",
        verdict,
        evidence.basis,
        one,
        more="the figure is the decisive comparison",
    )


def c50(evidence: Evidence) -> ClaimResult:
    """Both upper floors together, and how many pairs decrease."""
    floors = [evidence.level("floor", name) for name in ("F3", "F5")]
    table = evidence.table[evidence.table["floor"].isin(floors)]
    effect = mean_effect(table)
    verdict = direction(effect, -1, slight=True)
    down = int((table["d"] < 0).sum())
    half_a_pair = 0.5 * table["event"].nunique() / len(table)
    share = t_estimate(
        (table["d"] < 0).astype(float).groupby(table["event"]).mean(), resolution=half_a_pair
    )
    few = share.lower > 0.5
    if verdict == "supported" and not few:
        verdict = "undecided"
    return ratio_result(
        50,
        "mean of d on F3 and F5, t over events; share of pairs that decrease, t over events against "
        "one half",
        f"P/NP {effect.text()}; {down} of {len(table)} pairs decrease",
        verdict,
        evidence.basis,
        effect,
    )


def c51(evidence: Evidence) -> ClaimResult:
    """The test that was not made."""
    rows = evidence.part(floor="GF")
    effect = mean_effect(rows)
    p = evidence.p_holm("floor", evidence.level("floor", "GF"))
    flips = sign_flip_test(unit_means(rows, sampled_unit(rows)))
    verdict = direction(effect, +1, p=p)
    return ratio_result(
        51,
        "mean of d on GF, t over events, Holm over the floors; sign flips over events",
        f"P/NP {effect.text()}, p = {effect.p:.3f}, Holm {p:.3f}, sign flips {flips.p:.3f}",
        verdict,
        evidence.basis,
        effect,
        more=f"no test was made in the thesis; {flips.units} events give no sign-flip p below "
        f"{flips.smallest_p:.3g}",
    )


def floor_means(evidence: Evidence) -> pd.DataFrame:
    """Arithmetic mean amplitude by floor and side [g], for the thesis's contradictions.

    Raises
    ------
    Undecidable
        If a floor of the thesis is missing.
    """
    for floor in FLOORS:
        evidence.level("floor", floor)
    rows = evidence.amplitudes
    means = rows.pivot_table(index="floor", columns="side", values="a_g", aggfunc="mean")
    if means.isna().any(axis=None):
        raise Undecidable("a floor was tested on one side only")
    return means
