"""Where the thesis contradicts itself, and what makes each a contradiction.

Most need no data: the sentences exclude each other.  Where a table of tests is at hand it says which
of the two holds there, if either.
"""

import itertools

import pandas as pd

from rockfrag.pedestal.cluster_means import mean_effect
from rockfrag_thesis.hypotheses.evidence import Evidence
from rockfrag_thesis.hypotheses.floors import FIFTH, GROUND, THIRD, TOWERS, floor_means
from rockfrag_thesis.hypotheses.hypothesis import Undecidable
from rockfrag_thesis.hypotheses.slenderness import stack_slenderness

UPPER = (THIRD, FIFTH)
COLUMNS = ("hypotheses", "what", "why", "in_these_tests")


def orderings_of_floor_means() -> int:
    """Orders of the four means (P and NP on GF and 5th) that satisfy C35, C37, C42, C43 together.

    The reason why these four contradict each other: there is none among the 24.
    """
    names = ("P GF", "P F5", "NP GF", "NP F5")
    count = 0
    for order in itertools.permutations(range(4)):
        rank = dict(zip(names, order, strict=True))
        count += (
            rank["P GF"] > rank["NP GF"]
            and rank["P F5"] < rank["NP F5"]
            and rank["P F5"] > rank["P GF"]
            and rank["NP GF"] > rank["NP F5"]
        )
    return count


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
    return "P/NP " + ", ".join(f"{level} {effect.ratio:.3f}" for level, effect in effects.items())


def _upper_cells(evidence: Evidence) -> str:
    cells = {
        f"{tower} {floor}": evidence.effect(object=tower, floor=floor)
        for floor in UPPER
        for tower in TOWERS
    }
    return "P/NP " + ", ".join(f"{name} {cell.ratio:.3f}" for name, cell in cells.items())


def _stack(evidence: Evidence) -> str:
    table = stack_slenderness(evidence)
    return ", ".join(
        f"{row.object} {row.stacked:.2f} on the pedestal, {row.alone:.2f} alone"
        for row in table.itertuples()
    )


def _nothing(_: Evidence) -> str:
    return ""


_ROWS = (
    (
        "C42 with C43, C35, C37",
        "on which floor the mean with pedestal is largest",
        "NP is largest on GF (C43), P exceeds NP there (C35), P falls below NP on the 5th (C37): so P "
        "on GF exceeds P on the 5th, against C42; of the 24 orders of these four means "
        f"{orderings_of_floor_means()} satisfy all four hypotheses",
        _four_means,
    ),
    (
        "C47 with C48",
        "which earthquake shows the largest increase",
        "chapter 4 says Loma Prieta's is the most distinguished, chapter 5 that Friuli's is "
        "significant and Loma Prieta's much smaller",
        lambda evidence: _by(evidence, "earthquake"),
    ),
    (
        "C38 with C50",
        "how many exceptions there are on the upper floors",
        "section 4.4 has one anomaly (T1 on the 3rd floor), chapter 5 a few exceptions",
        _upper_cells,
    ),
    (
        "C32 with C39",
        "which tower gains most",
        "the increase is most significant for T3 (C32) but T1's on the only floor with an increase "
        "is much greater than the others' (C39); both hold only if T1 loses more above than it gains",
        lambda evidence: _by(evidence, "object"),
    ),
    (
        "C29 with C34, C36, C37",
        "whether the pedestal raises the acceleration",
        "the main observation is an increase, yet two of the three floors decrease",
        lambda evidence: _by(evidence, "floor"),
    ),
    (
        "C30",
        "whether the stack is more slender than the tower",
        "the common centre rises, but the base widens more: by Table 3.1 the stack's height of the "
        "common centre over half its base is below the tower's H/B",
        _stack,
    ),
    (
        "C55",
        "what the reported acceleration is",
        "the abstract has the acceleration that leads to overturning, section 3.4 the one just before "
        "overturning; they differ by the step of the protocol",
        _nothing,
    ),
    (
        "abstract with 3.3, Tab. 3.3, 4.4",
        "the year of the Loma Prieta earthquake",
        "the abstract has 1986, the rest 17 October 1989, which is right",
        _nothing,
    ),
    (
        "C46 (4.4)",
        "what Northridge's towers with the pedestal are compared with",
        "the sentence compares those with the pedestal with those 'with the pedestal'; the second "
        "must be 'without', as chapter 5 has it",
        _nothing,
    ),
    (
        "C33",
        "the sign of T2's effect",
        "'nearly opposite' to an increase and 'still an increase' exclude each other as signs",
        lambda evidence: _by(evidence, "object"),
    ),
)


def contradictions(evidence: Evidence | None = None) -> pd.DataFrame:
    """Table of the thesis's contradictions with itself.

    Parameters
    ----------
    evidence
        Tests that show what holds there; without it that column is empty, C30 excepted.

    Returns
    -------
    pandas.DataFrame
        hypotheses, what, why, in_these_tests.
    """
    rows = []
    for hypotheses, what, why, look in _ROWS:
        seen = ""
        if evidence is not None:
            try:
                seen = look(evidence)
            except Undecidable as reason:
                seen = f"cannot be said: {reason}"
        rows.append((hypotheses, what, why, seen))
    return pd.DataFrame(rows, columns=list(COLUMNS))
