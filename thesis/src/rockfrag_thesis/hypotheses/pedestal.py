"""C29, C31 to C33, C49: what the pedestal does on the whole, and to each tower."""

import numpy as np

from rockfrag_thesis.hypotheses.contrasts import slope_effect
from rockfrag_thesis.hypotheses.evidence import Evidence
from rockfrag_thesis.hypotheses.hypothesis import Result, hypothesis
from rockfrag_thesis.hypotheses.orders import (
    PAIRS,
    Part,
    Parts,
    effect_hypothesis,
    order_hypothesis,
)
from rockfrag_thesis.hypotheses.outcomes import ONE_INTERVAL, SEEN, same


def _changed(tests: Evidence) -> str:
    """How many pairs change by more than the steps of their series of levels."""
    table = tests.table
    steps = table.get("resolution", 0.0)
    return (
        f"pairs: {len(table)}, of which {int((table['d'] > steps).sum())} gain and "
        f"{int((table['d'] < -steps).sum())} lose by more than their steps"
    )


effect_hypothesis(29, "an increase over all pairs", "P/NP of all pairs")


@order_hypothesis(49, rule="as C29, which says the same", more=_changed)
def c49(tests: Evidence) -> Parts:
    """The effect over all pairs."""
    return {"P/NP of all pairs": Part(tests.effect())}


@hypothesis(
    31,
    evidence=PAIRS,
    rule=f"slope of ln P/NP on H/B inside each earthquake: over the range of H/B within ±{100 * SEEN:.0f} %",
    error_rate=ONE_INTERVAL,
)
def c31(tests: Evidence) -> Result:
    """No trend of the effect with slenderness."""
    table = tests.table.assign(slenderness=tests.table["object"].map(tests.slenderness))
    over = slope_effect(table, "slenderness").times(float(np.ptp(table["slenderness"])))
    return same(over, f"P/NP of the most slender over that of the least {over.text()}")


@order_hypothesis(
    32, rule="P/NP of T3 exceeds that of T1 and of T2, earthquake by earthquake", several=True
)
def c32(tests: Evidence) -> Parts:
    """T3's effect over T1's and T2's."""
    return {
        f"P/NP of T3 over {other}": Part(tests.lead("object", "T3", other))
        for other in ("T1", "T2")
    }


effect_hypothesis(
    33, "an increase of T2; “nearly opposite” cannot be tested", "P/NP of T2", object="T2"
)
