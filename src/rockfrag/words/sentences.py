"""Numbers, names and lists in words, as reports and messages print them.

In: numbers, tables of estimates with limits, names. Out: texts; nothing here ever prints NaN, infinity or an empty
interval. Docs: ``docs/report.md``, "How it is told".
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

MOST_LISTED = 8  # more names than this are not listed in a sentence, but counted

_FAR = 1000.0  # a limit so many times off its estimate is none

# longer names are cut in figures, where they would push everything else aside
LONGEST_NAME = 24


def number(value: float, decimals: int) -> str:
    """A number with its decimals and a real minus sign; a dash where there is none.

    Parameters
    ----------
    value, decimals : the number, and how many decimals it has

    Returns
    -------
    The text.
    """
    if not math.isfinite(value):
        return "–"
    return f"{value:.{decimals}f}".replace("-", "−")


def decimals_of(value: float, significant: int = 3) -> int:
    """Decimals that show so many digits of a value: 2 of 1.23, 0 of 123.

    Parameters
    ----------
    value : the number
    significant : digits that shall be seen

    Returns
    -------
    Number of decimals.
    """
    if not math.isfinite(value) or value == 0:
        return significant
    return max(0, significant - 1 - math.floor(math.log10(abs(value))))


def estimate(value: float, lower: float, upper: float, decimals: int) -> str:
    """An estimate with its limits, ``1.01 [0.98, 1.04]``; without them where they say nothing.

    Limits say nothing where there are none, or where they are the same to the decimals shown: a set of steps
    cannot show that something is exactly so. An estimate that is its own upper limit, with none below, is a
    bound: ``≤ 0.04``.

    Parameters
    ----------
    value, lower, upper : estimate and limits, in any unit
    decimals : of all of them

    Returns
    -------
    The text.
    """
    if not math.isfinite(value):
        return "–"
    middle = number(value, decimals)

    def end(limit: float) -> str:
        is_near = value / _FAR < limit < value * _FAR
        return number(limit, decimals) if is_near else "open"

    low, high = end(lower), end(upper)
    if lower <= 0 and upper <= value:
        # such as the dispersion of tests that a single threshold separates: only a bound is known
        return f"≤ {middle}"
    if low == high or not has_interval(lower, upper, decimals):
        return middle
    return f"{middle} [{low}, {high}]"


def estimates(
    table: pd.DataFrame,
    name: str,
    decimals: int | None = None,
    limits: tuple[str, str] | None = None,
) -> list[str]:
    """Estimates of a table in words, of a column and those of its limits, by default ``_lower`` and ``_upper``.

    The decimals are the same for all; by default they show three digits of the smallest value.

    Parameters
    ----------
    table, name : table, and column of the estimates
    decimals : of all; None for three digits of the smallest
    limits : columns of the limits

    Returns
    -------
    A text a row.
    """
    values = table[[name, *(limits or (f"{name}_lower", f"{name}_upper"))]].to_numpy(
        dtype=float
    )
    if decimals is None:
        decimals = min(
            max((decimals_of(value) for value in values[:, 0]), default=3), 3
        )
    return [estimate(value, lower, upper, decimals) for value, lower, upper in values]


def has_interval(lower: float, upper: float, decimals: int) -> bool:
    """Whether limits of a positive quantity have a width that the decimals show.

    Parameters
    ----------
    lower, upper : limits, in any unit
    decimals : that are shown

    Returns
    -------
    Whether the limits differ as they are shown.
    """
    if math.isnan(lower) or math.isnan(upper):
        return False
    if lower <= 0 and math.isinf(upper):
        return False
    return number(lower, decimals) != number(upper, decimals)


def probability(p: float) -> str:
    """A p value; those too small to tell apart are bounded, never zero.

    Parameters
    ----------
    p : the p value [-]

    Returns
    -------
    The text.
    """
    if not math.isfinite(p):
        return "–"
    return "< 0.001" if p < 0.001 else f"{p:.3f}"


def counted(n: int, word: str, many: str | None = None) -> str:
    """``1 record``, ``2 records``, ``no record``.

    Parameters
    ----------
    n : number of things
    word, many : what one is called, and several, else with an s

    Returns
    -------
    The text.
    """
    if n == 0:
        return f"no {word}"
    return f"{n} {word}" if n == 1 else f"{n} {many or word + 's'}"


def of_all(n: int, total: int, word: str, many: str | None = None) -> str:
    """``3 of 12 tests``, ``all 12 tests``, ``none of 12 tests``, ``the only test``, ``no test``.

    Parameters
    ----------
    n, total : number of things, and of all
    word, many : what one is called, and several, else with an s

    Returns
    -------
    The text.
    """
    noun = word if total == 1 else many or word + "s"
    if n == 0:
        return f"none of {total} {noun}" if total > 1 else f"no {noun}"
    if n == total:
        return f"all {total} {noun}" if total > 1 else f"the only {noun}"
    return f"{n} of {total} {noun}"


def agree(n: int, total: int, word: str, many: str) -> str:
    """The verb that goes with :func:`of_all`: ``needs`` of one, of none and of the only one, else ``need``.

    Parameters
    ----------
    n, total : number of things, and of all
    word, many : verb of one, and of several

    Returns
    -------
    The verb.
    """
    return word if n in (0, 1) or total == 1 else many


def listed(names: Sequence[str]) -> str:
    """``a``, ``a and b``, ``a, b and c``; of many the first ones and how many more.

    Parameters
    ----------
    names : in their order

    Returns
    -------
    The text.
    """
    if len(names) > MOST_LISTED:
        return f"{', '.join(names[:MOST_LISTED])} and {len(names) - MOST_LISTED} more"
    if len(names) < 2:
        return "".join(names)
    return f"{', '.join(names[:-1])} and {names[-1]}"


LONGEST_LABEL = 40


def label(name: str) -> str:
    """A name that a reader looks up elsewhere, whole wherever a figure has room for it.

    Parameters
    ----------
    name : whole

    Returns
    -------
    The name, of at most :data:`LONGEST_LABEL` characters.
    """
    return shortened(name, LONGEST_LABEL)


def shortened(name: str, longest: int = LONGEST_NAME) -> str:
    """A name of at most ``longest`` characters; the middle of a longer one is left out.

    Parameters
    ----------
    name, longest : whole name, and number of characters that it may have

    Returns
    -------
    The name, with ``…`` where something is left out.
    """
    if len(name) <= longest:
        return name
    head = (longest - 1) // 2
    return f"{name[: longest - 1 - head]}…{name[-head:]}"


def amplitude(test: Mapping[Any, Any]) -> str:
    """The amplitude [g] of a test, or the bound that is known of it: ``0.523``, ``> 2.000``, ``< 0.100``.

    Parameters
    ----------
    test : with ``lower_g``, ``upper_g`` and ``amplitude_g`` [g]

    Returns
    -------
    The text.
    """
    if math.isfinite(test["amplitude_g"]):
        return number(test["amplitude_g"], 3)
    if math.isfinite(test["upper_g"]):
        return f"< {number(test['upper_g'], 3)}"
    return f"> {number(test['lower_g'], 3)}" if test["lower_g"] > 0 else "–"


def sentence(words: str) -> str:
    """The words with a capital letter first.

    Parameters
    ----------
    words : without a capital letter

    Returns
    -------
    The words.
    """
    return words[:1].upper() + words[1:]
