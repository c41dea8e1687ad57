"""The table of hypotheses: every hypothesis with its kind, its rule, what came out, and the word for it.

In: all hypotheses and the results of a study. Out: one table. Docs: ``docs/hypotheses.md``.
"""

import warnings
from collections.abc import Iterable, Mapping, Sequence

import pandas as pd

from rockfrag.effects.cluster_means import TooFewUnitsError, holm
from rockfrag.records.motion import Motion
from rockfrag.simulation.ensemble import LightBodies
from rockfrag.system.blocks import Block, Stack
from rockfrag_thesis.hypotheses import (  # noqa: F401  (each enters its hypotheses when it is loaded)
    blocks,
    earthquakes,
    floors,
    protocol,
    slenderness,
    spectra,
    stacks,
)
from rockfrag_thesis.hypotheses.evidence import Evidence
from rockfrag_thesis.hypotheses.hypothesis import (
    HYPOTHESES,
    Finding,
    Hypothesis,
    Kind,
    Result,
    Undecidable,
    outcome,
)
from rockfrag_thesis.hypotheses.setting import Setting, make_setting

# numbers of the hypotheses about theory; the others are about tests
THEORY = range(1, 25)

COLUMNS = (
    *(
        "number",
        "hypothesis",
        "source",
        "kind",
        "evidence",
        "rule",
        "error_rate",
        "finding",
    ),
    *("outcome", "figure", "estimate", "lower", "upper", "unit", "p", "p_of", "p_holm"),
    *("basis", "remark"),
)
"""Columns of the table of hypotheses, ``hypotheses.csv``."""


def theory_table(
    specimens: Mapping[str, Block],
    motions: Sequence[Motion],
    *,
    seed: int,
    threads: int | None = None,
    assemblies: Mapping[str, Stack] | None = None,
) -> pd.DataFrame:
    """Compute C1 to C24 for specimens and ground motions; returns ``COLUMNS``.

    A hypothesis about which they cannot speak (no stack, no motion) is open, with the reason. A specimen named "P"
    is the pedestal: without ``assemblies``, stacks by name, others stand on it. Motions are as recorded.
    """
    setting = make_setting(specimens, motions, seed, threads, assemblies)
    return _table(
        _row(hypothesis, setting, "simulated")
        for hypothesis in _hypotheses(theory=True)
    )


def hypothesis_table(tests: Evidence) -> pd.DataFrame:
    """Test C25 to C58 on one table of tests; returns ``COLUMNS``.

    A hypothesis about which the table cannot speak (a floor that was not tested, a column that is absent, a single
    object) is open, with the reason.
    """
    # a table that cannot be used is the user's error, and no hypothesis's
    _ = tests.clean
    return _table(
        _row(hypothesis, tests, tests.basis) for hypothesis in _hypotheses(theory=False)
    )


def _hypotheses(theory: bool) -> list[Hypothesis]:
    return [HYPOTHESES[n] for n in sorted(HYPOTHESES) if (n in THEORY) == theory]


def _row(
    hypothesis: Hypothesis, evidence: Setting | Evidence, basis: str
) -> dict[str, str | float]:
    """Row of a hypothesis: what its test finds in the evidence, open where the data cannot decide it."""
    try:
        with warnings.catch_warnings():
            # the hypotheses are about pure rocking, whose limits the chapter on validity counts
            warnings.simplefilter("ignore", LightBodies)
            result = hypothesis.test(evidence)
    except (Undecidable, TooFewUnitsError) as reason:
        result = Result(
            Finding.OPEN, "no figure", remark=f"these data cannot decide it: {reason}"
        )
    if hypothesis.kind is Kind.IDENTITY:
        basis = "computed"
    basis = result.basis or basis
    return {
        **vars(hypothesis),
        **vars(result),
        "hypothesis": hypothesis.text,
        "kind": str(hypothesis.kind),
        "finding": str(result.finding),
        "outcome": outcome(hypothesis.kind, basis, result.finding),
        "basis": basis,
    }


def _table(rows: Iterable[dict[str, str | float]]) -> pd.DataFrame:
    table = pd.DataFrame(list(rows), columns=list(COLUMNS))
    # many hypotheses are tested on one table: what still stands when all of them are counted
    table["p_holm"] = holm(table["p"])
    return table
