"""C25 to C33, C49, C53, C54: what the towers' slenderness and the pedestal do.

In: amplitudes [g] of tests with and without the pedestal. Out: an outcome a hypothesis. Theory:
``docs/hypotheses.md``, ``docs/pedestal.md``.
"""

import itertools
import math

import numpy as np
import pandas as pd

from rockfrag.effects.cluster_means import Estimate, t_estimate
from rockfrag.system import geometry
from rockfrag.system.blocks import Stack
from rockfrag_thesis.hypotheses.contrasts import contrast, power_note, slope_effect
from rockfrag_thesis.hypotheses.evidence import PEDESTAL, Evidence
from rockfrag_thesis.hypotheses.hypothesis import (
    Finding,
    Result,
    Undecidable,
    hypothesis,
)
from rockfrag_thesis.hypotheses.orders import (
    Part,
    Parts,
    effect_hypothesis,
    order,
    order_hypothesis,
)
from rockfrag_thesis.hypotheses.outcomes import (
    LEVEL,
    all_of,
    decided,
    p_nonzero,
    ratios,
    same,
)

TOWERS = ("T1", "T2", "T3")  # the towers from the squattest to the most slender


def _fall(rows: pd.DataFrame) -> Estimate:
    """Fall of ln a from one unit of H/B to the next, inside each earthquake."""
    return slope_effect(rows, "slenderness", "ln_a").times(-1)


def _earthquake_means(tests: Evidence) -> pd.DataFrame:
    """Arithmetic mean amplitude by earthquake, a column per tower [g]."""
    names = [tests.level("object", name) for name in TOWERS]
    rows = tests.amplitudes
    means = rows.pivot_table(
        index="earthquake", columns="object", values="a_g", aggfunc="mean"
    )
    return means[names].dropna()


@hypothesis(25)
def c25(tests: Evidence) -> Result:
    """The slope, and the bend at T2; equilibrium alone (a as B/H) has a bend of -6 %."""
    means = _earthquake_means(tests)
    _, (low, middle, high) = zip(*means.items(), strict=True)
    bend = t_estimate(np.log(2 * middle / (low + high)))
    falls = order({"fall of a per unit of H/B": Part(_fall(tests.amplitudes))})
    straight = same(bend, f"T2 over the straight line {bend.text()}")
    return Result(
        all_of(falls.finding, straight.finding),
        f"{straight.figure}; {falls.figure}",
        straight.estimate,
        straight.lower,
        straight.upper,
        p=max(falls.p, straight.p),
        p_of=straight.p_of if straight.p >= falls.p else falls.p_of,
        remark=straight.remark or falls.remark,
    )


@order_hypothesis(26)
def c26(tests: Evidence) -> Parts:
    """The fall on both sides."""
    rows = tests.amplitudes
    return {
        f"fall of {side} per unit of H/B": Part(_fall(rows[rows["side"] == side]))
        for side in ("P", "NP")
    }


@hypothesis(27)
def c27(tests: Evidence) -> Result:
    """Equal relative decrease from T1 to T3."""
    difference = tests.lead("object", "T3", "T1")
    return same(
        difference, f"decrease with P over decrease without {difference.text()}"
    )


@hypothesis(28)
def c28(tests: Evidence) -> Result:
    """Decreases by floor; as a description of plots it says no more than that the figures differ."""
    span = float(np.ptp(list(tests.slenderness.values()))) if tests.slenderness else 0.0
    if span == 0:
        raise Undecidable("the towers must differ in slenderness")
    falls = pd.DataFrame(
        [
            (earthquake, floor, span * _fall(rows).mean)
            for (earthquake, floor), rows in tests.amplitudes.groupby(
                ["earthquake", "floor"], observed=True
            )
            if len(set(rows["slenderness"])) > 1
        ],
        columns=["earthquake", "floor", "fall"],
    )
    table = falls.pivot_table(
        index="earthquake", columns="floor", values="fall"
    ).dropna()
    if table.shape[1] < 2:
        raise Undecidable("two towers on each of two floors are needed")
    pairs = {
        f"{first} over {other}": t_estimate(table[first] - table[other])
        for first, other in itertools.combinations(table.columns, 2)
    }
    p_differ = {name: len(pairs) * p_nonzero(pair) for name, pair in pairs.items()}
    widest = min(p_differ, key=p_differ.__getitem__)
    alike = [same(pair, "") for pair in pairs.values()]
    all_alike = all(statement.finding is Finding.FOR for statement in alike)
    finding = decided(p_differ[widest] < LEVEL, all_alike)
    pair = pairs[widest]
    p_alike = max(each.p for each in alike)
    means = ", ".join(
        f"{floor} {math.exp(-fall):.3f}" for floor, fall in table.mean().items()
    )
    return Result(
        finding,
        f"mean of the most slender tower over that of the squattest: {means}; decrease on {widest} {pair.text()}",
        *ratios(pair),
        p=min(1.0, p_differ[widest], p_alike),
        p_of="no difference"
        if p_differ[widest] <= p_alike
        else "a difference of 10 % or more",
        remark=power_note(pair) if finding is Finding.OPEN else "",
    )


def stack_slenderness(tests: Evidence) -> pd.DataFrame:
    """Slenderness of the standing stack, height of the common centre over half the base's width.

    Returns object, alone, stacked [-]; Undecidable without a pedestal among the specimens.
    """
    bodies = tests.specimens
    if PEDESTAL not in bodies or len(bodies) < 2:
        raise Undecidable("there is no pedestal, or nothing else, among the specimens")
    base = bodies[PEDESTAL]
    rows = []
    for name in sorted(set(bodies) - {PEDESTAL}):
        height = geometry.common_arm(Stack(base, bodies[name]).pile, 1)[1]
        rows.append((name, bodies[name].h / bodies[name].b, height / base.b))
    return pd.DataFrame(rows, columns=["object", "alone", "stacked"])


@hypothesis(30)
def c30(tests: Evidence) -> Result:
    """Geometry of the stack; about its strength see C29."""
    table = stack_slenderness(tests)
    ratio = table["stacked"] / table["alone"]
    stacked = ", ".join(f"{value:.2f}" for value in table["stacked"])
    alone = ", ".join(f"{value:.2f}" for value in table["alone"])
    return Result(
        Finding.AGAINST if (ratio <= 1).all() else Finding.OPEN,
        f"stack {stacked} against {alone} of the towers alone ({', '.join(table['object'])})",
        float(ratio.max()),
        basis="computed",
        remark="the common centre rises, but the base widens more"
        if (ratio <= 1).all()
        else "a stack is more slender than its tower; about its strength see C29",
    )


def _changed(tests: Evidence) -> str:
    """How many pairs change by more than the steps of their series of levels."""
    table = tests.table
    steps = table.get("resolution", 0.0)
    return (
        f"pairs: {len(table)}, of which {int((table['d'] > steps).sum())} gain and "
        f"{int((table['d'] < -steps).sum())} lose by more than their steps"
    )


effect_hypothesis(29, "P/NP of all pairs")


@order_hypothesis(49, more=_changed)
def c49(tests: Evidence) -> Parts:
    """The effect over all pairs."""
    return {"P/NP of all pairs": Part(tests.effect())}


@hypothesis(31)
def c31(tests: Evidence) -> Result:
    """No trend of the effect with slenderness."""
    table = tests.table.assign(slenderness=tests.table["object"].map(tests.slenderness))
    over = slope_effect(table, "slenderness").times(float(np.ptp(table["slenderness"])))
    return same(over, f"P/NP of the most slender over that of the least {over.text()}")


@order_hypothesis(32)
def c32(tests: Evidence) -> Parts:
    """T3's effect over T1's and T2's."""
    return {
        f"P/NP of T3 over {other}": Part(tests.lead("object", "T3", other))
        for other in ("T1", "T2")
    }


effect_hypothesis(33, "P/NP of T2", object="T2")


@order_hypothesis(53)
def c53(tests: Evidence) -> Parts:
    """T1 above T2 above T3."""
    names = [tests.level("object", name) for name in TOWERS]
    return {
        f"{flat} over {slender}": Part(
            contrast(tests.amplitudes, "object", flat, slender, value="ln_a")
        )
        for flat, slender in itertools.pairwise(names)
    }


@hypothesis(54)
def c54(tests: Evidence) -> Result:
    """Error of three extrapolations to T3; scatter alone makes none of them miss the mean."""
    means = _earthquake_means(tests)
    names, (squat, middle, slender) = zip(*means.items(), strict=True)
    s1, s2, s3 = map(tests.slenderness.__getitem__, names)
    weight = (s3 - s1) / (s2 - s1)
    inverse = (1 / s3 - 1 / s1) / (1 / s2 - 1 / s1)
    reached = float(slender.mean())
    # errors as fractions of one mean: a ratio in each earthquake would be biased by its scatter
    misses = {
        "a on H/B": (squat + weight * (middle - squat) - slender) / reached,
        "ln a on H/B": np.log(squat)
        + weight * np.log(middle / squat)
        - np.log(slender),
        "a on B/H": (squat + inverse * (middle - squat) - slender) / reached,
    }
    errors = {name: t_estimate(miss) for name, miss in misses.items()}
    p_miss = max(p_nonzero(error) for error in errors.values())
    own = errors["a on H/B"]
    reaches = same(own, "")
    finding = decided(p_miss < LEVEL, reaches.finding is Finding.FOR)
    return Result(
        finding,
        "predicted over observed mean of T3: "
        + ", ".join(f"{name} {error.text()}" for name, error in errors.items()),
        *ratios(own),
        p=min(1.0, p_miss, reaches.p),
        p_of="no error" if p_miss <= reaches.p else reaches.p_of,
        remark=power_note(own) if finding is Finding.OPEN else "",
    )
