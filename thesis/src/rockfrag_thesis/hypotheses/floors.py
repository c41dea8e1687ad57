"""C34 to C44, C50, C51: what the floors do.

Most say something about orders: a function returns differences that are positive if it is so.

In: amplitudes [g] of tests on floors. Out: an outcome a hypothesis. Theory: ``docs/hypotheses.md``.
"""

import math
from dataclasses import replace

import pandas as pd

from rockfrag.effects.cluster_means import (
    earthquake_means,
    mean_effect,
    sign_flip_test,
)
from rockfrag_thesis.hypotheses.contrasts import contrast
from rockfrag_thesis.hypotheses.evidence import Evidence
from rockfrag_thesis.hypotheses.hypothesis import (
    Finding,
    Result,
    Undecidable,
    hypothesis,
)
from rockfrag_thesis.hypotheses.orders import (
    Part,
    Parts,
    Size,
    effect_hypothesis,
    order,
    order_hypothesis,
)
from rockfrag_thesis.hypotheses.outcomes import SEEN

FLOORS = ("GF", "F3", "F5")
GROUND, THIRD, FIFTH = FLOORS
TOWERS = ("T1", "T2", "T3")


@order_hypothesis(34)
def c34(tests: Evidence) -> Parts:
    """The ground floor's increase, and by how much those above stay below a noticeable one."""
    parts = {"P/NP on GF": Part(tests.effect(floor=GROUND), Size.NOTICEABLE)}
    for floor in (THIRD, FIFTH):
        rows = tests.part(floor=floor)
        below = mean_effect(rows.assign(d=math.log1p(SEEN) - rows["d"]))
        parts[f"{1 + SEEN:g} over P/NP on {floor}"] = Part(below)
    return parts


effect_hypothesis(35, "P/NP on GF", floor=GROUND)
effect_hypothesis(36, "NP/P on F3", -1, floor=THIRD)
effect_hypothesis(37, "NP/P on F5", -1, floor=FIFTH)


SIGNS = {GROUND: (1, 1, 1), THIRD: (1, -1, -1), FIFTH: (-1, -1, -1)}
"""Signs of the effect that C38 claims, by floor for T1, T2, T3."""


@order_hypothesis(38)
def c38(tests: Evidence) -> Parts:
    """The effect in each of the nine cells, in the direction claimed."""
    return {
        f"{'P/NP' if sign > 0 else 'NP/P'} of {tower} on {floor}": Part(
            tests.effect(floor=floor, object=tower).times(sign)
        )
        for floor, signs in SIGNS.items()
        for tower, sign in zip(TOWERS, signs, strict=True)
    }


def _first_tower(tests: Evidence, floor: str, sign: int) -> Parts:
    """T1's change on a floor, and by how much it exceeds those of T2 and T3."""
    rows = tests.part(floor=floor)
    rows = rows.assign(d=sign * rows["d"])
    first, *others = (tests.level("object", name) for name in TOWERS)
    ratio = "P/NP" if sign > 0 else "NP/P"
    own = mean_effect(rows[rows["object"] == first])
    return {f"{ratio} of {first}": Part(own, Size.NOTICEABLE)} | {
        f"{ratio} of {first} over {other}": Part(
            contrast(rows, "object", first, other), Size.NOTICEABLE
        )
        for other in others
    }


@order_hypothesis(39)
def c39(tests: Evidence) -> Parts:
    """T1's increase on the ground floor, and its lead."""
    return _first_tower(tests, GROUND, +1)


@order_hypothesis(40)
def c40(tests: Evidence) -> Parts:
    """T1's decrease on the 5th floor, and its lead."""
    return _first_tower(tests, FIFTH, -1)


@order_hypothesis(41)
def c41(tests: Evidence) -> Parts:
    """Whether |x| > |y| for the effects x on GF and y above: x - y and x + y have the sign of x."""
    table = tests.table
    ground, *others = (tests.level("floor", name) for name in FLOORS)
    sign = 1.0 if tests.effect(floor=GROUND).mean >= 0 else -1.0
    parts = {}
    for other in others:
        mirrored = table.assign(
            d=table["d"].where(table["floor"] != other, -table["d"])
        )
        for word, rows in (("change", table), ("opposite change", mirrored)):
            lead = contrast(rows, "floor", ground, other).times(sign)
            parts[f"change on {ground} over the {word} on {other}"] = Part(lead)
    return parts


def _over(rows: pd.DataFrame, floor: str, other: str) -> Part:
    """By how much the amplitudes on one floor exceed those on another."""
    return Part(contrast(rows, "floor", floor, other, value="ln_a"))


def _leading_floor(tests: Evidence, side: str, floor: str) -> Parts:
    """By how much the amplitudes of a side on one floor exceed those on the others."""
    rows = tests.amplitudes[tests.amplitudes["side"] == side]
    top = tests.level("floor", floor)
    others = [tests.level("floor", name) for name in FLOORS if name != floor]
    return {
        f"{side} on {top} over {other}": _over(rows, top, other) for other in others
    }


@order_hypothesis(42, more=lambda tests: _means(tests, "P"))
def c42(tests: Evidence) -> Parts:
    """With the pedestal, the 5th floor over the others."""
    return _leading_floor(tests, "P", FIFTH)


@order_hypothesis(43, more=lambda tests: _means(tests, "NP"))
def c43(tests: Evidence) -> Parts:
    """Without the pedestal, the ground floor over the others."""
    return _leading_floor(tests, "NP", GROUND)


@order_hypothesis(44)
def c44(tests: Evidence) -> Parts:
    """The other floors over the 3rd, for every tower on both sides."""
    low, *others = (tests.level("floor", name) for name in (THIRD, GROUND, FIFTH))
    return {
        f"{name} {side} on {other} over {low}": _over(rows, other, low)
        for (name, side), rows in tests.amplitudes.groupby(["object", "side"])
        for other in others
    }


@hypothesis(50)
def c50(tests: Evidence) -> Result:
    """The decrease on both upper floors together, and how many pairs are exceptions."""
    floors = [tests.level("floor", name) for name in (THIRD, FIFTH)]
    rows = tests.table[tests.table["floor"].isin(floors)]
    steps = rows.get("resolution", 0.0)
    down, up = int((rows["d"] < -steps).sum()), int((rows["d"] > steps).sum())
    found = order(
        {"NP/P on F3 and F5": Part(mean_effect(rows).times(-1))},
        more=f"pairs: {len(rows)}, of which {down} decrease and {up} increase by more than their steps",
    )
    if found.finding is Finding.FOR and down <= up:
        return replace(found, finding=Finding.OPEN)
    return found


@hypothesis(51)
def c51(tests: Evidence) -> Result:
    """The test that the thesis did not make."""
    rows = tests.part(floor=GROUND)
    flips = sign_flip_test(earthquake_means(rows))
    return order(
        {"P/NP on GF": Part(mean_effect(rows), Size.NOTICEABLE)},
        more=f"the thesis made no test; sign flips give p = {flips.p:.3f}, and {flips.units} earthquakes "
        f"cannot give less than {flips.smallest_p:.3g}",
    )


def floor_steps(tests: Evidence) -> Parts:
    """The thesis's order of the floors for lone towers: 3rd below 5th below ground."""
    rows = tests.amplitudes[tests.amplitudes["side"] == "NP"]
    third, fifth = tests.level("floor", THIRD), tests.level("floor", FIFTH)
    ground = tests.level("floor", GROUND)
    return {
        f"NP on {first} over {other}": _over(rows, first, other)
        for first, other in ((fifth, third), (ground, fifth))
    }


def floor_means(tests: Evidence) -> pd.DataFrame:
    """Arithmetic mean amplitude by floor and side [g], as the thesis plots it; Undecidable without a floor."""
    for floor in FLOORS:
        tests.level("floor", floor)
    rows = tests.amplitudes
    means = rows.pivot_table(
        index="floor", columns="side", values="a_g", aggfunc="mean"
    )
    if means.isna().any(axis=None):
        raise Undecidable("a floor was tested on one side only")
    return means


def _means(tests: Evidence, side: str) -> str:
    means = floor_means(tests)[side].to_dict()
    return "arithmetic means " + ", ".join(
        f"{name} {means[name]:.3f} g" for name in means
    )
