"""What a hypothesis of the thesis is: its words, its kind, the rule that tests it, and what came out.

In: words of ``statements.yaml`` and a function. Out: a row of the table. Docs: ``docs/hypotheses.md``.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any

import yaml


class Kind(StrEnum):
    """What sort of sentence a hypothesis is, which decides what can speak about it."""

    IDENTITY = "identity"
    """True or false by algebra or geometry; no data can change it."""
    PROPERTY = "property of the model"
    """About the equations of rigid blocks: simulations show it, or an exception."""
    DESCRIPTION = "description of the thesis's plots"
    """What the thesis saw in its own 72 tests; other tests show the same or do not."""
    INFERENCE = "inference about the laboratory"
    """What the thesis concludes for such specimens; only measured tests confirm or reject it."""


class Finding(StrEnum):
    """What the evidence says, whatever the word for it."""

    FOR = "for"
    AGAINST = "against"
    OPEN = "open"
    BOUNDED = "bounded"
    """The sign of the change is not shown, but one of 10 % or more in the stated direction is excluded."""
    SPECIMENS_ONLY = "specimens only"
    """It holds for the thesis's specimens, with exceptions among other bodies or inputs."""


UNDECIDED = "undecided"
EXCLUDED = "a change of 10 % or more is excluded"

_FROM_THE_MODEL = {
    Finding.FOR: "reproduced",
    Finding.AGAINST: "not reproduced",
    Finding.OPEN: UNDECIDED,
    Finding.BOUNDED: EXCLUDED,
}
_FROM_A_LABORATORY = _FROM_THE_MODEL | {
    Finding.FOR: "confirmed",
    Finding.AGAINST: "rejected",
}
_ABOUT_THE_MODEL = _FROM_A_LABORATORY | {
    Finding.AGAINST: "refuted",
    Finding.SPECIMENS_ONLY: "confirmed for the specimens, with exceptions elsewhere",
}


def outcome(kind: Kind, basis: str, finding: Finding) -> str:
    """Word for a finding: a simulation reproduces a laboratory or does not, it cannot reject it.

    There is no word (KeyError) for exceptions among the tests of a laboratory.
    """
    if kind in (Kind.IDENTITY, Kind.PROPERTY):
        return _ABOUT_THE_MODEL[finding]
    return (_FROM_A_LABORATORY if basis == "measured" else _FROM_THE_MODEL)[finding]


@dataclass(frozen=True)
class Result:
    """What one test says about one hypothesis."""

    finding: Finding  # What the evidence says
    figure: str  # The result with its interval, in words and digits
    # The figure and its interval in ``unit``; NaN where there is no single figure
    estimate: float = math.nan
    lower: float = math.nan
    upper: float = math.nan
    unit: str = "-"  # Unit of the three, ``-`` for ratios and probabilities
    # Two-sided p value behind the finding [-], where there is inference; NaN elsewhere
    p: float = math.nan
    # The hypothesis that p concerns, such as ``no change``; empty where there is none
    p_of: str = ""
    # What else a reader must know, such as the power needed where the finding is open
    remark: str = ""
    # Where it is not that of the evidence as a whole, such as the geometry of C30 among simulations
    basis: str | None = None


class Undecidable(Exception):
    """The data at hand cannot speak about a hypothesis; the message says why."""


Test = Callable[[Any], Result]


@dataclass(frozen=True)
class Hypothesis:
    """One hypothesis of the thesis, in our own words."""

    number: int  # Its number, 1 to 58 (written C1 to C58); it never changes
    # What it says, where the thesis says it, and what sort of sentence it is, as in ``statements.yaml``
    text: str
    source: str
    kind: Kind
    evidence: str  # What is looked at
    # When it is held to be true, and when false, in words a statistician can repeat
    rule: str
    error_rate: str  # How often the rule errs by chance, or why it cannot
    test: Test  # Function that applies the rule


HYPOTHESES: dict[int, Hypothesis] = {}
"""Hypothesis by number, as far as their modules are loaded; the package loads all 58."""

_STATEMENTS = yaml.safe_load(
    Path(__file__).with_name("statements.yaml").read_text(encoding="utf-8")
)

_ONE_RULE = (
    "The 95 % interval decides: above 1 for it, below 1 against it; if neither and it ends below 1.1, a change "
    "of 10 % or more is excluded"
)
_SEVERAL_RULE = (
    "The 95 % intervals decide: all above 1 for it, one below 1 against it (Bonferroni); if neither, 10 % or "
    "more is excluded where all end below 1.1, or one of those called noticeable (Bonferroni)"
)
"""What is said beside every hypothesis about an order, so that a reader can apply it to the row."""


def hypothesis(number: int, **figures: Any) -> Callable[[Test], Test]:
    """Enter the decorated function as the test of a hypothesis; figures are those that its words leave open."""

    def enter(test: Test) -> Test:
        """Enter the hypothesis of a number with its test."""
        said = _STATEMENTS[number]

        def filled(name: str) -> str:
            words: str = said[name]
            return words.format(one=_ONE_RULE, several=_SEVERAL_RULE, **figures)

        HYPOTHESES[number] = Hypothesis(
            number,
            said["statement"],
            said["source"],
            Kind(said["kind"]),
            filled("evidence"),
            filled("rule"),
            said.get("error_rate", "none: nothing is sampled"),
            test,
        )
        return test

    return enter
