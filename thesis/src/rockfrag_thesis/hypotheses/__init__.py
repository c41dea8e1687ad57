"""The 58 hypotheses of the thesis, C1 to C58: what each says, what can test it, what came out.

**Where a hypothesis is.**  Its words, source and kind are a row of ``statements.csv``; its rule stands beside the
function that tests it, named after its number (``c35`` is C35), in the file of its group:

====================  ==================================  ================================================
`blocks`              C1, C3 to C8, C20                   the single block
`stacks`              C2, C9 to C13, C21 to C24           how a stack starts, changes its pattern, loses energy
`spectra`             C14 to C19                          response spectra and rocking spectra
`slenderness`         C25 to C28, C30, C53, C54           what the towers' slenderness does
`pedestal`            C29, C31 to C33, C49                what the pedestal does on the whole and by tower
`floors`              C34 to C44, C50, C51                what the floors do
`earthquakes`         C45 to C48, C52                     what the earthquakes do
`protocol`            C55 to C58                          how the figures were obtained
====================  ==================================  ================================================

`hypothesis` has the kinds and the words for what came out, `outcomes`, `orders` and `contrasts` the rules,
`setting` and `evidence` what is looked at, `hypothesis_table` runs them all, and `contradictions` lists where the
thesis contradicts itself.

**How to add a hypothesis.**

1. Write its row in ``statements.csv``, with a number that is not taken, and choose the file of its group.
2. Decide its kind (`hypothesis.Kind`): can data change it at all, does it speak about equations, about what
   was seen in the thesis's plots, or about what a laboratory would find?
3. Where it claims an order ("higher", "largest"), write a function from `Evidence` to named differences that
   are all positive if it is true, and enter it with ``@order_hypothesis(...)``.  Otherwise write one to a
   `Result` and enter it with ``@hypothesis(...)``; use `outcomes.same` for "equal" and "uncorrelated".
4. State the rule so that a reader can apply it to the printed interval, and its error rate.  A threshold
   needs a reason in its docstring, or it is left out.
5. Raise `Undecidable` with the reason where the data cannot speak.
6. Add the outcomes it must get in the synthetic laboratories to ``tests/thesis/test_laboratories.py``.
"""

from rockfrag_thesis.hypotheses.contradictions import contradictions
from rockfrag_thesis.hypotheses.evidence import Evidence
from rockfrag_thesis.hypotheses.hypothesis import (
    HYPOTHESES,
    Finding,
    Hypothesis,
    Kind,
    Result,
    Undecidable,
)
from rockfrag_thesis.hypotheses.hypothesis_table import COLUMNS, hypothesis_table, theory_table

__all__ = [
    "COLUMNS",
    "HYPOTHESES",
    "Evidence",
    "Finding",
    "Hypothesis",
    "Kind",
    "Result",
    "Undecidable",
    "contradictions",
    "hypothesis_table",
    "theory_table",
]
