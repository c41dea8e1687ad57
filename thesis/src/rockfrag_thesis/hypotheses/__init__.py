"""The 58 hypotheses of the thesis, C1 to C58: what each says, what can test it, what came out.

The words, source, kind, evidence and rule of a hypothesis stand in ``statements.yaml``; the function that tests
it is named after its number (``c34`` is C34), in the file of its group, whose first line says which.

To add one, write its words, decide its kind (`hypothesis.Kind`), and enter a function from `Evidence` in a file:
named differences that are all positive if it is true with ``@order_hypothesis(...)``, or else a `Result` with
``@hypothesis(...)``. State the rule so that a reader can apply it to the printed interval, and its error rate;
raise `Undecidable` with the reason where the data cannot speak. Add the outcomes that it must get in the synthetic
laboratories to ``thesis/tests/test_laboratories.py``.
"""

from rockfrag_thesis.hypotheses.contradictions import contradictions as contradictions
from rockfrag_thesis.hypotheses.evidence import Evidence as Evidence
from rockfrag_thesis.hypotheses.hypothesis import HYPOTHESES as HYPOTHESES
from rockfrag_thesis.hypotheses.hypothesis import Finding as Finding
from rockfrag_thesis.hypotheses.hypothesis import Undecidable as Undecidable
from rockfrag_thesis.hypotheses.hypothesis_table import COLUMNS as COLUMNS
from rockfrag_thesis.hypotheses.hypothesis_table import (
    hypothesis_table as hypothesis_table,
)
from rockfrag_thesis.hypotheses.hypothesis_table import theory_table as theory_table
