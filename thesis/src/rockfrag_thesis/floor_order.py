"""What a table of tests says about the floors: margins by which hypotheses C34 to C44 hold.

A margin is the least of the differences of logarithms that a hypothesis says are positive
(`rockfrag_thesis.hypotheses.orders`); the means are as stated where it is positive.  A margin of 0.02 is
2 %: smaller ones mean nothing, whatever their sign.  These are point values without inference, for
following a hypothesis along an axis of assumptions.
"""

import math
from collections.abc import Mapping

import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.effects.cluster_means import TooFewUnitsError
from rockfrag.system.blocks import Block
from rockfrag_thesis.hypotheses import HYPOTHESES as ALL_HYPOTHESES
from rockfrag_thesis.hypotheses import Evidence, Undecidable
from rockfrag_thesis.hypotheses.floors import floor_steps
from rockfrag_thesis.hypotheses.orders import ORDERS, Differences, margin

HYPOTHESES: Mapping[str, str] = {
    f"C{number}": ALL_HYPOTHESES[number].text for number in range(34, 45)
}
"""Hypotheses about floors by number."""


def floor_margins(
    tests: pd.DataFrame, bodies: Mapping[str, Block] | None = None
) -> dict[str, float]:
    """Margins of the hypotheses about floors in tests of one definition, on ``GF``, ``F3`` and ``F5``.

    Bodies are specimens by name; without them those of the thesis.

    Returns a margin [-] by number of hypothesis; NaN where the tests cannot speak about it. ``order`` is that of
    the thesis's order of the floors for lone towers, ground highest and 3rd lowest: the smaller of the steps from
    F3 to F5 and from F5 to GF. A floor that is missing, or tests without pairs, are an InputError.
    """
    evidence = Evidence(tests, "simulated", bodies=bodies)
    try:
        steps = floor_steps(evidence)
    except (Undecidable, TooFewUnitsError) as reason:
        raise InputError(
            f"tests: {reason}; the hypotheses about floors need all of them."
        ) from None
    margins = {name: _margin(ORDERS[int(name[1:])], evidence) for name in HYPOTHESES}
    return margins | {"order": margin(steps)}


def _margin(differences: Differences, evidence: Evidence) -> float:
    try:
        return margin(differences(evidence))
    except (Undecidable, TooFewUnitsError):
        return math.nan


TIE = 1e-9
"""Margins below this are ties up to rounding: the amplitudes of two tests are the same of the IDA curve."""


def margins_table(tests: pd.DataFrame, bodies: Mapping[str, Block]) -> pd.DataFrame:
    """Margins of the hypotheses about floors for every building of a sensitivity study.

    Bodies are specimens by name.

    Returns a row per building, reading and hypothesis: ``axis``, ``value``, ``label``, ``definition``,
    ``hypothesis``, ``margin``, ``holds`` and ``credible``.
    """
    keys = ["axis", "value", "label", "credible", "definition"]
    rows = []
    for values, group in tests.groupby(keys, sort=False):
        about = dict(zip(keys, values, strict=True))
        rows += [
            {**about, "hypothesis": name, "margin": margin, "holds": margin > TIE}
            for name, margin in floor_margins(group, bodies).items()
        ]
    columns = [
        "axis",
        "value",
        "label",
        "definition",
        "hypothesis",
        "margin",
        "holds",
        "credible",
    ]
    return pd.DataFrame(rows, columns=columns)
