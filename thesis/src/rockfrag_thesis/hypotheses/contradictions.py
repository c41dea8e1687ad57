"""Where the thesis contradicts itself, and what makes each a contradiction.

Most need no data: the sentences exclude each other.  Where a table of tests is at hand it says which
of the two holds there, if either.

In: the statements, and a table of tests. Out: an outcome a pair. Docs: ``docs/hypotheses.md``.
"""

from collections.abc import Callable, Mapping
from pathlib import Path

import pandas as pd

from rockfrag.effects.cluster_means import mean_effect
from rockfrag_thesis.hypotheses.evidence import Evidence
from rockfrag_thesis.hypotheses.floors import FIFTH, GROUND, THIRD, TOWERS, floor_means
from rockfrag_thesis.hypotheses.hypothesis import Undecidable
from rockfrag_thesis.hypotheses.slenderness import stack_slenderness

UPPER = (THIRD, FIFTH)


def _four_means(evidence: Evidence) -> str:
    means = floor_means(evidence)
    floors = [evidence.level("floor", name) for name in (GROUND, FIFTH)]
    return ", ".join(
        f"{side} {floor} {means[side].to_dict()[floor]:.3f} g"
        for side in ("P", "NP")
        for floor in floors
    )


def _by(evidence: Evidence, scope: str) -> str:
    effects = {
        str(level): mean_effect(rows)
        for level, rows in evidence.table.groupby(scope, observed=True)
    }
    return "P/NP " + ", ".join(
        f"{level} {effect.ratio:.3f}" for level, effect in effects.items()
    )


def _upper_cells(evidence: Evidence) -> str:
    cells = {
        f"{tower} {floor}": evidence.effect(object=tower, floor=floor)
        for floor in UPPER
        for tower in TOWERS
    }
    return "P/NP " + ", ".join(
        f"{name} {cell.ratio:.3f}" for name, cell in cells.items()
    )


def _stack(evidence: Evidence) -> str:
    table = stack_slenderness(evidence)
    return ", ".join(
        f"{row.object} {row.stacked:.2f} on the pedestal, {row.alone:.2f} alone"
        for row in table.itertuples()
    )


_SHOWN: Mapping[str, Callable[[Evidence], str]] = {
    "floor means": _four_means,
    "by earthquake": lambda evidence: _by(evidence, "earthquake"),
    "by object": lambda evidence: _by(evidence, "object"),
    "by floor": lambda evidence: _by(evidence, "floor"),
    "upper cells": _upper_cells,
    "stack": _stack,
}
"""What a table of tests says of a contradiction, by the word in the column ``shown``."""


def contradictions(evidence: Evidence) -> pd.DataFrame:
    """Table of the thesis's contradictions with itself: hypotheses, what, why, in_these_tests."""
    table = pd.read_csv(
        Path(__file__).with_name("contradictions.csv"),
        comment="#",
        keep_default_na=False,
    )
    seen = [_seen(evidence, shown) for shown in table.pop("shown")]
    return table.assign(in_these_tests=seen)


def _seen(evidence: Evidence, shown: str) -> str:
    """What a table of tests says of one contradiction; empty where there is nothing to look at."""
    if not shown:
        return ""
    try:
        return _SHOWN[shown](evidence)
    except Undecidable as reason:
        return f"cannot be said: {reason}"
