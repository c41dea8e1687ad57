"""What the words above the samples of a text file state: count, interval, unit, quantity, components.

Words of many languages are understood (:mod:`.vocabulary`); lines are compared without accents and capitals.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache

from rockfrag.base.plausible import LONGEST_STEP, SHORTEST_STEP
from rockfrag.records.parsing.directions import is_direction
from rockfrag.records.parsing.factor_words import states_factor, states_size_of_digit
from rockfrag.records.parsing.format import stated
from rockfrag.records.parsing.number_fields import number_in
from rockfrag.records.parsing.peak_in_words import peaks_in_words
from rockfrag.records.parsing.quantities import (
    Unit,
    has_factor,
    looks_like_unit,
    read_unit,
)
from rockfrag.records.parsing.stated_peak import StatedPeak
from rockfrag.records.parsing.statements import (
    FRACTION,
    IS,
    NUMBER,
    UNIT_BEHIND_VALUE,
    VALUE,
)
from rockfrag.records.parsing.vocabulary import (
    OF_SPECTRA,
    alternatives,
    folded,
    words_for,
)

# motions that were fitted to a spectrum
_OF_MATCHED = re.compile(r"compat|match|target|design|consist|adjust|fitted|scaled")
_LAST_BRACKET = re.compile(r"[(\[](?P<inside>[^()\[\]]+)[)\]]\s*$")
_LONGEST_TITLE = 4  # words, without units
_STEP_BEFORE = re.compile(
    rf"(?P<value>{VALUE})\s*(?:s|sec\w*)\.?\s+(?:time\s+)?(?:intervals?|steps?|spacing)\b"
)
_ENGLISH_COUNT = (
    r"\b(?:no\.?|number|num\.?|nr\.?|total)\s*(?:of\s+)?(?:acc\w*\s+)?"
    r"(?:data\s+|time\s+)?(?:points?|pts|samples?|data|values?|steps?)"
)
# words that with a sign and at the end of a statement are a count, where the number is none of a place
_BARE_COUNT = (
    r"\bcounts?|(?:\b(?:data|record)\s+)?\blength|(?<![\w.])n|длина(?:\s+записи)?"
)
_LARGEST_ANGLE = 360
_LEAST_FREQUENCY = 50.0  # [Hz] that the word frequency alone states
_UNSURE_STEP = r"delta|interval(?:l?o)?s?|passo|шаг|步长|步長"
# for a key that no count of a day or of a place has, and that a message may therefore call impossible
_OF_SAMPLING = re.compile(
    "sampl|muestr|amostr|echantillon|campion|abtast|дискрет|采样|ornek"
)
_SHOWN = 60
# in the place of a unit; A-1 may be the name of an instrument
_SHORT_WORDS = re.compile(r"(?!\W*[^\W\d_]+-\d)(?=.*[^\W\d_]).{1,14}")
_PER_SECOND = re.compile(r"[^\W\d_]+\s*/\s*s[ec]*(?:\^?2|/s)$")
_IMPERATIVE = re.compile("multipl|divide|divid")
_QUANTITY = r"\b(?P<quantity>acc|vel|dis(?=p))(?:[a-z]*\.?)"
_IN_UNIT = re.compile(r"(?:\bin\s+|[(\[{]\s*)(?P<rest>[^)\]}]+)")
_ONE_VALUE = re.compile(
    r"\b(?:pga|pgv|pgd|peak|max\w*|largest|min\w*|full\s*scale|filter|pico|picco|sensitiv\w*)\b"
)
_VALUE_OF = re.compile(r"[=:]\s*[-+]?\.?\d")
_LIST = r"^\W*(?:components?|channels?|directions?|orientations?|componentes?|canales)\s*[=:]\s*(.+)$"
_KEYS = {
    "earthquake": r"^\W*(?:event|earthquake|evento|sismo|terremoto)\b[^:=]*[:=]\s*(\S.*)$",
    "station": r"^\W*(?:recording\s+)?(?:station|estaci[oó]n|stazione|istasyon)\b[^:=]*[:=]\s*(\S.*)$",
}


@dataclass(frozen=True)
class StatedFacts:
    """What is stated, None or empty where it is not."""

    npts: int | None = None  # number of samples
    dt: float | None = None  # interval [s]
    duration: float | None = None  # of the whole record [s]
    rounding: float = 0.0  # one unit of the duration's last digit [s]
    unit: str = ""  # canonical unit of acceleration
    other_unit: str = ""  # unit of another quantity, where a line says unit
    # what the samples are, where words say so: ``acceleration``, ``velocity``, ``force``, …
    quantity: str = ""
    # names of the components, in the order of the columns
    components: tuple[str, ...] = ()
    # a factor that the samples are still to be multiplied by, with its words
    factor: str = ""
    # what one digit of a recorder is worth, with its words
    digit: str = ""
    peaks: tuple[StatedPeak, ...] = ()
    # ``earthquake`` and ``station``
    details: dict[str, str] = field(default_factory=dict)
    # two statements that exclude each other, one that cannot be, or a unit that is not known, in words
    contradiction: str = ""


@cache
def _patterns() -> dict[str, re.Pattern[str]]:
    """Return the patterns that are made of the words of all languages."""
    samples = alternatives("samples")
    is_value = rf"{IS}(?P<value>{FRACTION}){UNIT_BEHIND_VALUE}"
    return {
        "step": re.compile(
            rf"(?P<key>{alternatives('interval')}|(?<![\w.])δt|\bintervals?\s+of)"
            rf"{is_value}"
        ),
        "unsure step": re.compile(
            rf"(?<![^\W\d_])(?P<key>{_UNSURE_STEP})(?![^\W\d_]){is_value}"
        ),
        "rate": re.compile(rf"(?P<key>{alternatives('rate')}){is_value}"),
        "unsure rate": re.compile(
            rf"(?P<key>{alternatives('sampling')})(?:\s+(?:at|every)\b)?{is_value}"
        ),
        "frequency": re.compile(
            rf"\W*(?P<key>{alternatives('frequency')}){is_value}\W*"
        ),
        "rate before": re.compile(
            rf"(?P<value>{VALUE})\s*(?:sps\b|{samples}\s*(?:/|per|por|al|par|pro)\s*s)"
        ),
        "count": re.compile(
            rf"(?:{alternatives('count')}|{_ENGLISH_COUNT}|(?P<unsure>\bsamples|\bpoints)|(?P<bare>{_BARE_COUNT}))"
            rf"{IS}(?P<count>\d+)(?![\d.,]*\d)(?!\s*(?:hz|s\b|sec|/|per))"
            rf"(?(bare)\s*(?P<of>{samples})?\s*(?:$|[,;)]))"
        ),
        "counted": re.compile(
            rf"^\s*(?P<count>\d+)\s+(?:data\s+)?{samples}(?!\s*(?:/|per|por))"
        ),
        # that of strong or felt shaking is another one, and has more words
        "duration": re.compile(rf"\W*{alternatives('duration')}{is_value}\W*"),
        "unit": re.compile(
            rf"{alternatives('unit')}(?:\s*\([^)]*\))?\s*"
            r"(?P<sign>of|are|is|in|for\s+\w+)?\s*(?P<colon>[=:])?(?P<rest>.*)$"
        ),
        "quantity in": re.compile(
            rf"(?:{_QUANTITY}|{alternatives('acceleration')})[^,;:(\[=\d]{{0,40}}?"
            r"(?:\b(?:in|en|em)\s+(?:units?\s+(?:of\s+)?)?|[:(\[,=_]\s*)(?P<rest>.+)$"
        ),
    }


def stated_facts(lines: Sequence[str]) -> StatedFacts:
    """Return what lines of words state about the samples below them.

    Parameters
    ----------
    lines : the uppermost first, without the titles of columns

    Returns
    -------
    The facts; a contradiction among them, in words.
    """
    plain = [folded(line) for line in lines]
    steps = list(dict.fromkeys(step for line in plain for step in _steps(line)))
    counts = list(dict.fromkeys(count for line in plain for count in _counts(line)))
    units = list(dict.fromkeys(filter(None, map(_unit_in_so_many_words, plain))))
    others = [u.name for line in plain for u in _other_units(line)]
    impossible = [s for s in steps if not SHORTEST_STEP <= s <= LONGEST_STEP]
    if impossible:
        wrong = (
            f"the header states an interval of {impossible[0]:g} s, which no record has "
            f"(as a rate it would be {1 / impossible[0]:g} s)"
        )
    else:
        statements: dict[str, Sequence[float | int | str]]
        statements = {"intervals of": steps, "counts of": counts, "units of": units}
        wrong = next(filter(None, map(_two_of, statements.items())), "")
    quantity, unit, problem = _quantity_and_unit(plain)
    duration, rounding = next(filter(None, map(_duration, plain)), (None, 0.0))
    return StatedFacts(
        npts=counts[0] if counts else None,
        dt=steps[0] if steps else None,
        duration=duration,
        rounding=rounding,
        unit=units[0] if units else unit,
        other_unit=next(iter(others), ""),
        quantity="acceleration" if units else quantity,
        components=tuple(re.findall(r"[^\s,;]+", stated(_LIST, lines))),
        factor=_first_line(lines, states_factor),
        digit=_first_line(lines, states_size_of_digit),
        peaks=peaks_in_words(lines),
        details={key: stated(pattern, lines) for key, pattern in _KEYS.items()},
        contradiction=wrong or problem,
    )


def _first_line(lines: Sequence[str], says: Callable[[str], bool]) -> str:
    """First of some lines that says something in plain words (``folded``); empty if none does."""
    return next((line for line in lines if says(folded(line))), "")


def factor_beside_unit(line: str) -> str:
    """Return that a line of a header has a factor which the samples may still have to be multiplied by.

    Parameters
    ----------
    line
        Of any header, as it stands there.

    Returns
    -------
    str
        What is wrong, in words; empty where nothing is.
    """
    plain = folded(line)
    unit = _patterns()["unit"].search(plain)
    units = _units_in(unit["rest"]) if unit else []
    of_motion = [u for u in units if u.quantity == "acceleration"]
    # a factor elsewhere in a header may tell how the record was made
    if _IMPERATIVE.search(plain) and states_factor(plain):
        return f"{line.strip()[:_SHOWN]!r} is a factor that is not applied here"
    return _problem_of_factor(plain, of_motion[0]) if of_motion else ""


def _two_of(statement: tuple[str, Sequence[float | int | str]]) -> str:
    """Return in words that one fact is stated in two ways; empty if it is not.

    ``statement``: words for the fact, and the different values that were found for it.
    """
    what, found = statement
    if len(found) < 2 or _close(found):
        return ""
    both = (f"{v:g}" if isinstance(v, float) else str(v) for v in found[:2])
    return f"the header states {what} " + " and ".join(both)


def _close(found: Sequence[float | int | str]) -> bool:
    """Tell whether statements of one fact are numbers that differ by rounding only, to a ten-thousandth."""
    numbers = [value for value in found if isinstance(value, float)]
    return len(numbers) == len(found) and max(numbers) - min(numbers) <= 1e-4 * max(
        numbers
    )


def _steps(line: str) -> list[float]:
    """Return the intervals [s] that a folded line states, as a step or a rate.

    A word that may mean something else, such as DT, counts with a sign of equality behind it alone. What is not
    called a sampling interval has to be one that records have.
    """
    found = []
    for name in ("step", "unsure step"):
        for match in _patterns()[name].finditer(line):
            unit = read_unit(_unit_of(match))
            is_other = unit.quantity in ("angle", "displacement", "frequency")
            if name == "unsure step" and (not match["sign"] or is_other):
                continue
            value = _value_in(match)
            if unit.quantity == "frequency":
                found += _intervals(value, _unit_of(match))
                continue
            seconds = unit.to_si if unit.quantity == "time" else 1.0
            step = float(f"{value * seconds:.12g}")
            sure = _OF_SAMPLING.search(match["key"]) and step > 0
            if sure or SHORTEST_STEP <= step <= LONGEST_STEP:
                found.append(step)
    before = [number_in(m["value"]) for m in _STEP_BEFORE.finditer(line)]
    found += [step for step in before if SHORTEST_STEP <= step <= LONGEST_STEP]
    return found + _steps_of_rates(line)


def _steps_of_rates(line: str) -> list[float]:
    """Return the intervals [s] of the rates that a folded line states."""
    found = []
    for name in ("rate", "unsure rate"):
        for match in _patterns()[name].finditer(line):
            unit, value = _unit_of(match), _value_in(match)
            seconds = read_unit(unit)
            per_second = re.match(r"k?hz|sps|[^\W\d_]+\s*(?:/|p[eo]r)\s*s", unit)
            if seconds.quantity == "time":
                found.append(float(f"{value * seconds.to_si:.12g}"))
            elif per_second or name == "rate" or unit in ("samples", "pts", "points"):
                found += _intervals(value, unit)
    for match in _patterns()["rate before"].finditer(line):
        found += _intervals(number_in(match["value"]), "")
    bare = _patterns()["frequency"].fullmatch(line)
    # that of a filter, of a machine or of an instrument is another one, and mostly lower
    if bare and read_unit(_unit_of(bare)).quantity == "frequency":
        steps = _intervals(_value_in(bare), _unit_of(bare))
        found += [step for step in steps if step <= 1 / _LEAST_FREQUENCY]
    return [step for step in found if SHORTEST_STEP <= step <= LONGEST_STEP]


def _duration(line: str) -> tuple[float, float] | None:
    """Return the duration [s] that a folded line states and one unit of its last digit [s], if it states one."""
    match = _patterns()["duration"].fullmatch(line)
    if match is None:
        return None
    unit = read_unit(_unit_of(match))
    if unit.quantity not in ("", "time") or not (match["sign"] or unit.quantity):
        return None
    seconds = unit.to_si if unit.quantity == "time" else 1.0
    decimals = re.search(r"[.,](\d+)", match["value"])
    digit = 10.0 ** -len(decimals[1]) if decimals else 1.0
    return _value_in(match) * seconds, digit * seconds


def _value_in(match: re.Match[str]) -> float:
    """Return the value of a match, which may be a part of a second such as 1/200."""
    first, *others = [number_in(word) for word in NUMBER.findall(match["value"])]
    if not others:
        return first
    # one over the second number
    return 1 / others[0] if others[0] else 0.0


def _unit_of(match: re.Match[str]) -> str:
    """Return the unit that stands behind a value, in brackets before it or at the end of its key."""
    behind = (match["unit"] or "").strip()
    if re.match(r"°|k?hz|sps|.*(?:/|\bp[eo]r\b)", behind) or read_unit(behind).quantity:
        return behind
    if behind in ("samples", "pts", "points"):
        return behind
    return (match["note"] or match["note2"] or match["behind"] or "").strip()


def _intervals(rate: float, unit: str) -> list[float]:
    """Return the interval [s] of a rate, none of a rate of zero."""
    rate *= 1000 if "khz" in unit else 1
    return [float(f"{1 / rate:.9g}")] if rate > 0 else []


def _counts(line: str) -> list[int]:
    """Return the numbers of samples that a folded line states."""
    found = [
        m
        for m in _patterns()["count"].finditer(line)
        if (m["sign"] or m["of"] or not (m["unsure"] or m["bare"]))
        and (int(m["count"]) > _LARGEST_ANGLE or not m["bare"])
    ]
    counted = _patterns()["counted"].match(line)
    every = (*found, *([counted] if counted else []))
    return [int(m["count"]) for m in every if int(m["count"])]


def _units_in(words: str) -> list[Unit]:
    """Return the units in folded words that are known, from left to right."""
    found = []
    for part in re.split(r"[,;]|\s+(?:and|y|und|et|e)\s+|[()\[\]]", words):
        tokens = part.strip(" .:=\"'").split()
        start = 0
        while start < len(tokens):
            unit, end = _unit_at(tokens, start)
            if unit is not None:
                found.append(unit)
            start = end
    return found


def _unit_at(tokens: list[str], start: int) -> tuple[Unit | None, int]:
    """Return the longest unit that begins with a token, None if none does, and the place behind it."""
    for end in range(len(tokens), start, -1):
        unit = read_unit(" ".join(tokens[start:end]))
        if not unit.quantity:
            continue
        if start and NUMBER.fullmatch(tokens[start - 1]):
            # a number before a unit is a factor that was not understood
            words = " ".join(tokens[start - 1 : end])
            return Unit(words, unit.quantity, factor=words), end
        return unit, end
    return None, start + 1


def _unit_in_so_many_words(line: str) -> str:
    """Return the unit of acceleration of a folded line that has the word unit, or nothing."""
    match = _patterns()["unit"].search(line)
    units = _units_in(match["rest"]) if match else []
    known = [u.name for u in units if u.quantity == "acceleration" and not u.factor]
    return next(iter(known), "")


def _other_units(line: str) -> list[Unit]:
    """Return the units of a folded line that states a unit with a colon, if none is of acceleration."""
    match = _patterns()["unit"].search(line)
    units = _units_in(match["rest"]) if match and match["colon"] else []
    of_motion = any(u.quantity == "acceleration" for u in units)
    return [] if of_motion else [u for u in units if u.quantity != "time"]


def _unknown_unit(words: str) -> str:
    """Return what words in the place of a unit are, if they are a unit that is not known."""
    first = re.split(r"[,;]|\s{2,}", words.strip(" .:=\"'([{"))[0].strip(" )]}\"'.")
    known = not first or is_direction(first) or read_unit(first).quantity
    return "" if known or not looks_like_unit(first) else first


def _quantity_and_unit(lines: Sequence[str]) -> tuple[str, str, str]:
    """Return quantity and unit of acceleration that the line nearest the numbers states, and what is wrong.

    ``lines``: folded; each of the three is empty where nothing is stated, or wrong.
    """
    for line in reversed(lines):
        explicit = _patterns()["unit"].search(line)
        units = _units_in(explicit["rest"]) if explicit else []
        if explicit and (problem := _problem_of_unit(line, explicit, units)):
            return "", "", problem
        others = [u.quantity for u in units if u.quantity != "time"]
        if others:
            return others[0], "", ""
        # one value, as of a velocity of waves, is not what the samples are
        of_one = _VALUE_OF.search(line) and not (_steps(line) or _counts(line))
        if _ONE_VALUE.search(line) or of_one:
            continue
        quantity, unit, problem = _of_named_quantity(line)
        if quantity or problem:
            return quantity, unit, problem
    if any(words_for("acceleration").search(line) for line in lines):
        return "acceleration", "", ""
    return next(filter(None, map(_other_quantity, lines[::-1])), ""), "", ""


def _other_quantity(line: str) -> str:
    """Return the quantity other than acceleration that a folded line is the title of, or nothing.

    A title has few words, and no value: ``Velocity time history``, ``Kraft [kN]``, ``Скорость, см/с``.
    """
    if _ONE_VALUE.search(line) or _VALUE_OF.search(line):
        return ""
    words = re.split(r"[\s_:;,()\[\]]+", line.strip(" _:;,()[].\"'"))
    units = {read_unit(word).quantity for word in words[1:]} - {"", "time"}
    has_value = any(map(NUMBER.match, words))
    if has_value or len(words) - len(units) > _LONGEST_TITLE or "acceleration" in units:
        return ""
    if OF_SPECTRA.search(line):
        return "" if _OF_MATCHED.search(line) else "spectrum"
    ending = _LAST_BRACKET.search(line)
    unit = read_unit(ending["inside"]) if ending else Unit("")
    if unit.quantity not in ("", "time", "frequency", "acceleration"):
        return unit.quantity
    # as in vitesse du sol, and in ground velocity
    named = words[0] if len(words) - len(units) != 2 else " ".join(words[:2])
    for quantity in ("velocity", "displacement"):
        if words_for(quantity).search(named):
            return quantity
    other = words_for("other").match(words[0])
    return other[0] if other and (units or len(words) == 1) else ""


def _problem_of_unit(line: str, explicit: re.Match[str], units: list[Unit]) -> str:
    """Return why the unit of a line that has the word unit cannot be used, or nothing."""
    stated_so = explicit["sign"] or explicit["colon"]
    # a number before a unit is no word of a sentence
    stated_so = stated_so or re.match(r"\s*[\d.]", explicit["rest"])
    unknown = _unknown_unit(explicit["rest"]) if stated_so and not units else ""
    if explicit["colon"] and not units and _SHORT_WORDS.fullmatch(explicit["rest"]):
        unknown = explicit["rest"].strip()
    if unknown:
        return f"the header states the unit {unknown!r}, which is not known here"
    of_motion = [u for u in units if u.quantity == "acceleration"]
    return _problem_of_factor(line, of_motion[0]) if of_motion else ""


def _problem_of_factor(line: str, unit: Unit) -> str:
    """Return that a line has a factor beside a unit which may be meant either way, or nothing."""
    if unit.factor or _has_factor_outside_units(line):
        return f"{line.strip()[:_SHOWN]!r} has a factor that may be meant either way"
    return ""


def _has_factor_outside_units(line: str) -> bool:
    """Tell whether a line has a factor that is no part of a unit, as that of ``in 10-3 g`` is."""
    left = line
    for part in re.split(r"[,;()\[\]]|\bin\b|\bof\b|[=:]", line):
        unit = read_unit(part)
        if unit.quantity and not unit.factor:
            left = left.replace(part, " ", 1)
    return has_factor(left)


def _of_named_quantity(line: str) -> tuple[str, str, str]:
    """Return quantity, unit of acceleration and what is wrong of a line such as ``Acceleration in m/s2``.

    All are empty where the line says nothing of these. A bare ``in g`` or ``in mg`` may belong to a value in the
    line, and counts only where the line names a quantity or samples.
    """
    match = _patterns()["quantity in"].search(line) or _IN_UNIT.search(line)
    if not match:
        unit = _sure_unit(line) or _lone_unit_with_factor(line)
        if unit is None:
            return "", "", ""
        return "acceleration", unit.name, _problem_of_factor(line, unit)
    units = _units_in(match["rest"])
    # values in mg are the samples, whose unit that is as well as where a quantity is named
    of_samples = words_for("samples").search(line[: match.start()])
    named = match.re is not _IN_UNIT or of_samples is not None
    first = units[0] if units else Unit("")
    if first.quantity == "acceleration":
        if named or first.name not in ("g", "mg"):
            problem = _problem_of_factor(line, first)
            return "acceleration", "" if problem else first.name, problem
    elif named and first.quantity not in ("", "time"):
        return first.quantity, "", ""
    elif not units and (unknown := _unknown_unit(match["rest"])):
        is_unit = (re.search(r"[/^]", unknown) and named) or _PER_SECOND.match(unknown)
        problem = f"the header states the unit {unknown!r}, which is not known here"
        return ("", "", problem) if is_unit else ("", "", "")
    return "", "", ""


def _lone_unit_with_factor(line: str) -> Unit | None:
    """Return the unit of acceleration of a line that is that and a factor, such as ``thousandths of g``."""
    if len(line.split()) > _LONGEST_TITLE or not has_factor(line):
        return None
    return next((u for u in _units_in(line) if u.quantity == "acceleration"), None)


def _sure_unit(line: str) -> Unit | None:
    """Return the unit of acceleration that a line has for sure; None if it has none.

    Either the whole line is a unit without a factor (``g``, ``cm/s2``), or one of its words is, with seconds in
    it, and is no value's: of ``Corrected accelerogram, cm/s2`` but not of ``PGA 12.3 cm/s2``. A ``g`` among words
    may be a gram.
    """
    whole = read_unit(line)
    if whole.quantity == "acceleration" and not whole.factor:
        return whole
    # words, but a number is not parted from what follows it, nor a unit from its stroke
    parts = map(read_unit, re.split(r"(?<![\d.])[,;\s]+(?![/\d])", line))
    return next(
        (u for u in parts if u.quantity == "acceleration" and "/s" in u.name), None
    )
