"""Words of factors above samples: ``multiply by 0.001``, ``1 unit = 0.001 g``, ``0.06 mg/LSB``.

Whoever writes them means one way or the other, so that none is applied: a file that has one is refused.
"""

import re
from functools import cache

from rockfrag.records.parsing.number_fields import number_in
from rockfrag.records.parsing.statements import IS, NUMBER, VALUE
from rockfrag.records.parsing.vocabulary import alternatives

_MULTIPLIED = re.compile(
    r"\b(?:multipl(?!ex)|moltiplic|multiplik|divi[ds]|dividier|умнож|раздел)\w*"
)
# data x 1e-6, 1 unit = 0.001 g
_TIMES_A_NUMBER = re.compile(
    rf"\b(?:data|values?|numbers|valores|datos|werte|daten|dati|valori|valeurs|données)\s*[x×*]\s*{VALUE}"
    rf"|\b(?:1|one)\s+unit\w*\s*(?:[=:]|is|corresponds to)\s*(?!1\b(?![.,]\d)){VALUE}"
)
# the size of a digit of a recorder: a factor where the samples are whole numbers
_SIZE_OF_DIGIT = re.compile(
    rf"\b(?:lsb|digits?|counts?|cnt|bits?)\s*[=:]\s*{VALUE}"
    rf"|{VALUE}\s*\(?[^\W\d_][^\s\d]*\)?\s*(?:/|\bper\b)\s*(?:lsb|digit|count|cnt|bit)\b"
)
_LONGEST_IMPERATIVE = 80
_LONE_FACTOR = re.compile(r"\W*[x×*]\s*(?:10|0?[.,]\d|\d+e|1\d*)[\d\s^.,+-]*\W*")
# a scale of these is no factor of the samples, nor is a ratio such as 1:50
_OTHER_SCALE = (
    r"(?<!full )(?<!full-)(?<!time )(?<!length )(?<!richter )(?<!magnitude )(?<!quality )(?<!q )(?<!safety )"
    r"(?<!damping )(?<!intensity )(?<!full_)"
)


@cache
def _factor() -> re.Pattern[str]:
    """Pattern of a factor in words, with its value."""
    return re.compile(
        rf"{_OTHER_SCALE}{alternatives('factor')}{IS}"
        rf"(?:by|of|con|with|mit|por|per|par)?\s*(?P<value>[+-]?{VALUE})(?!\s*:\s*\d)"
    )


def states_factor(line: str) -> bool:
    """Tell whether a line states a factor that the samples are still to be multiplied by.

    Parameters
    ----------
    line
        Folded, of the words above the samples.

    Returns
    -------
    bool
        Whether it does; a factor of one is none.
    """
    found = _factor().search(line)
    alone = _LONE_FACTOR.fullmatch(line) is not None
    numbers = {number_in(word) for word in NUMBER.findall(line)} - {1.0}
    in_a_sentence = (
        _MULTIPLIED.search(line) and numbers and len(line) <= _LONGEST_IMPERATIVE
    )
    if in_a_sentence or _TIMES_A_NUMBER.search(line):
        return True
    return alone or (found is not None and number_in(found["value"]) != 1)


def states_size_of_digit(line: str) -> bool:
    """Tell whether a folded line says what one digit of a recorder is worth, a factor of whole numbers."""
    return _SIZE_OF_DIGIT.search(line) is not None
