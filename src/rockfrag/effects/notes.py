"""Notes on pairs of tests: the population, pairs left out or bounded, and what the steps of the protocol hide.

In: the pairs of :mod:`rockfrag.effects.paired_tests`. Out: notes without a full stop, which stand in the table
``pedestal/notes`` and in the report. Theory: ``docs/pedestal.md``, "What a series of steps can know" and "Which
test, and about what".
"""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

MOST_NAMED = 100  # pairs and tests that notes call by their names; of more the number

Row = Mapping[Any, Any]  # a row of a table

NO_RATIO = "no pair has a known ratio, not even a bound: raise or lower the amplitudes of the protocol"


def notes_on_left_out(
    bounded: Sequence[Row], lost: Sequence[Row], unpaired: Sequence[Row]
) -> list[str]:
    """Notes on what is not among the complete pairs.

    Parameters
    ----------
    bounded : pairs of which one test gives a bound only, with ``d`` and ``bound``
    lost : pairs of which both tests are unfinished
    unpaired : tests without a partner, with the ``missing`` side

    Returns
    -------
    The notes, none if all pairs are complete.
    """
    notes = []
    if bounded:
        names = _named(
            bounded, lambda row: f"{_name(row)} {row['bound']} {math.exp(row['d']):.3g}"
        )
        notes.append(
            f"{_counted(len(bounded), 'pair')} in the means with the bound of P/NP, because one of the two "
            f"tests never overturned, or did so at its first step ({names}): the true means lie further on that "
            "side"
        )
    if lost:
        notes.append(
            f"{_counted(len(lost), 'pair')} left out because both tests are unfinished ({_named(lost, _name)})"
        )
    if unpaired:
        names = _named(unpaired, lambda row: f"{_name(row)} without {row['missing']}")
        notes.append(
            f"{_counted(len(unpaired), 'test')} without a partner left out ({names})"
        )
    return notes


def _counted(n: int, noun: str) -> str:
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"


def _name(row: Row) -> str:
    return f"{row['object']}/{row['motion']}"


def _named(rows: Sequence[Row], words: Callable[[Row], str]) -> str:
    """Names of the first rows, and the number of the others."""
    rest = len(rows) - MOST_NAMED
    more = f" and {rest} more" if rest > 0 else ""
    return ", ".join(map(words, rows[:MOST_NAMED])) + more


def note_on_population(earthquakes: int) -> str:
    """Note on the earthquakes of which the tested ones are a sample.

    Parameters
    ----------
    earthquakes : their number

    Returns
    -------
    The note, with the smallest p value that sign flips over so many can give.
    """
    if earthquakes == 1:
        return (
            "the inference is about further motions of this one earthquake on the tested floors, not about other "
            "earthquakes"
        )
    return (
        f"the inference is about earthquakes of which these {earthquakes} are a sample, for the objects and "
        f"floors tested; sign flips over {earthquakes} earthquakes cannot give a p value below "
        f"{2.0 ** (1 - earthquakes):.3g}"
    )


def notes_on_ties(tied: int, pairs: int, widest: float) -> list[str]:
    """Notes on pairs whose two tests have the same amplitude.

    Parameters
    ----------
    tied, pairs : numbers of such pairs and of all
    widest : largest half-width to which ln P/NP of a tied pair is known [-]; 0 without steps

    Returns
    -------
    The notes, none without ties.
    """
    if not tied:
        return []
    which = f"{tied} of {pairs} pairs"
    if pairs == 1:
        which = "the two tests of the only pair"
    if widest == 0:
        return [
            f"{which} agree in their amplitudes; the table does not give the steps (lower_g, upper_g), so the "
            "difference that they exclude is not known"
        ]
    notes = [
        f"{which} overturned in the same step, which excludes a change of {100 * math.expm1(widest):.1f} % or "
        "more and no smaller one; no interval is narrower than the steps of the pairs that agree"
    ]
    if tied / pairs > 0.5:
        notes.append(
            "most pairs agree, so the intervals are wider than their level says: in simulations nominal 90 % "
            "intervals contained the truth in 99 to 100 %, and less than 1 % of tables without effect had p < "
            "0.05; a few pairs that differ do not allow sharper statements"
        )
    return notes
