"""What the words above the samples of a text file state: count, interval, unit, quantity, components."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, field

from rockfrag.base.plausible import LONGEST_STEP, SHORTEST_STEP
from rockfrag.records.parsing.format import stated
from rockfrag.records.parsing.number_fields import number_in
from rockfrag.records.parsing.quantities import TO_SI, canonical_unit, quantity_of

_VALUE = r"(?:\d+[.,]\d+|\d+\.?|[.,]\d+)(?:[EeDd][+-]?\d+)?"
_IS = r"[\s\"']*(?:\((?P<note>[^)]*)\)|\[(?P<note2>[^\]]*)\])?[\s\"',]*(?P<sign>[=:]|\bis\b)?[\s\"',]*"
_STEP = re.compile(
    r"(?i)(?:\b(?:dt|d\.t\.|delta[\s_-]*t|time[\s_-]*(?:step|increment|interval|spacing)|timestep"
    r"|sampl\w*[\s_-]*(?:step|increment|interval|period|spacing|time)|spaced\s+at|intervals?\s+of)"
    r"|(?<![\w.])Δt|\b(?P<unsure>delta|interval))"
    rf"{_IS}(?P<value>{_VALUE})\s*(?P<unit>ms|msec\w*|millis\w*|[uµ]s|microsec\w*|min\w*|deg\w*|km|°)?"
)
_STEP_BEFORE = re.compile(
    rf"(?P<value>{_VALUE})\s*(?:s|sec\w*)\.?\s+(?:time\s+)?(?:intervals?|steps?|spacing)\b",
    re.I,
)
_RATE = re.compile(
    rf"(?i)\bsampl\w*[\s_-]*(?P<named>rate|freq\w*)?(?:\s+at\b)?{_IS}(?P<value>{_VALUE})\s*"
    r"(?P<unit>k?hz|sps|samples|pts|points)?|(?<![\w.])fs\s*(?:\([^)]*\))?\s*[=:]\s*(?P<value2>[\d.]+)"
    r"|(?P<value3>[\d.]+)\s*(?:sps\b|(?:samples?|pts|points)\s*(?:/|per)\s*s)"
)
_COUNT = re.compile(
    r"(?i)(?:\b(?:npts|npoints|ndata|nsamples?|npt|(?:no\.?|number|num\.?|nr\.?|total)\s*(?:of\s+)?(?:acc\w*\s+)?"
    r"(?:data\s+|time\s+)?(?:points?|pts|samples?|data|values?|steps?))|(?P<unsure>\bsamples|\bpoints))"
    rf"{_IS}(?P<count>\d+)(?![\d.,]*\d)(?!\s*(?:hz|s\b|sec|/|per))"
)
_COUNTED = re.compile(
    r"^\s*(?P<count>\d+)\s+(?:data\s+)?(?:points?|samples?|values?)\b(?!\s*(?:/|per))",
    re.I,
)
_UNIT_WORDS = re.compile(
    r"\bunits?\b(?:\s*\([^)]*\))?\s*(?:of|are|is|in|for\s+\w+)?\s*[=:]?(?P<rest>.*)$",
    re.I,
)
_QUANTITY = r"\b(?P<quantity>acc|vel|dis(?=p))(?:[a-z]*\.?)"
_QUANTITY_IN = re.compile(
    rf"(?i){_QUANTITY}[^,;:(\[=\d]{{0,40}}?(?:\bin\s+(?:units?\s+(?:of\s+)?)?|[:(\[,=_]\s*)(?P<rest>.+)$"
)
_NAMED_QUANTITY = re.compile(rf"{_QUANTITY}", re.I)
_IN_UNIT = re.compile(r"(?:\bin\s+|[(\[{]\s*)(?P<rest>[^)\]}]+)", re.I)
_ONE_VALUE = re.compile(
    r"\b(?:pga|pgv|pgd|peak|max\w*|largest|min\w*|full\s*scale|filter)\b", re.I
)
_VALUE_OF = re.compile(r"[=:]\s*[-+]?\.?\d")
_UNIT_TOKEN = re.compile(
    r"[\s\"'=:(\[{]*(?P<unit>(?:[a-z%°µ]+[\w%°^*²-]*(?:\.[a-z-]+\d?)?(?:\s*/\s*\(?\s*[a-z\d]+\)?(?:\^|\*\*)?[\d²]*)*))",
    re.I,
)
_LIST = r"^\W*(?:components?|channels?|directions?|orientations?)\s*[=:]\s*(.+)$"
_FACTOR = re.compile(
    rf"\b(?:scal(?:e|ing)|conversion|calibration)[\s_-]*factor{_IS}(?P<value>[+-]?{_VALUE})",
    re.I,
)
_KEYS = {
    "earthquake": r"^\W*(?:event|earthquake)\b[^:=]*[:=]\s*(\S.*)$",
    "station": r"^\W*(?:recording\s+)?station\b[^:=]*[:=]\s*(\S.*)$",
}
_SECONDS = {"ms": 1e-3, "mi": 1e-3, "us": 1e-6, "µs": 1e-6}


@dataclass(frozen=True)
class StatedFacts:
    """What is stated, None or empty where it is not."""

    npts: int | None = None  # number of samples
    dt: float | None = None  # interval [s]
    unit: str = ""  # canonical unit of acceleration
    # what the samples are, where words say so: ``acceleration``, ``velocity``, ``force``, …
    quantity: str = ""
    # names of the components, in the order of the columns
    components: tuple[str, ...] = ()
    # a factor that the samples are still to be multiplied by, with its words
    factor: str = ""
    # ``earthquake`` and ``station``
    details: dict[str, str] = field(default_factory=dict)
    contradiction: str = ""  # two statements that exclude each other, in words


def stated_facts(lines: Sequence[str]) -> StatedFacts:
    """Return what lines of words, the uppermost first, state about the samples below them."""
    steps = list(dict.fromkeys(step for line in lines for step in _steps(line)))
    counts = list(dict.fromkeys(count for line in lines for count in _counts(line)))
    behind = (_units_in(m["rest"]) for line in lines if (m := _UNIT_WORDS.search(line)))
    # of each line that has the word unit one of acceleration
    units = list(
        dict.fromkeys(
            u for found in behind for u in [u for u in found if u in TO_SI][:1]
        )
    )
    contradiction = next(
        (
            f"the header states {what} "
            + " and ".join(
                f"{v:g}" if isinstance(v, float) else str(v) for v in found[:2]
            )
            for what, found in (
                ("intervals of", steps),
                ("counts of", counts),
                ("units of", units),
            )
            if len(found) > 1 and not _close(found)
        ),
        "",
    )
    quantity, unit = _quantity_and_unit(lines)
    return StatedFacts(
        npts=counts[0] if counts else None,
        dt=steps[0] if steps else None,
        unit=units[0] if units else unit,
        quantity="acceleration" if units else quantity,
        components=tuple(re.findall(r"[^\s,;]+", stated(_LIST, lines))),
        factor=next(
            (
                x
                for x in lines
                if (m := _FACTOR.search(x)) and number_in(m["value"]) != 1
            ),
            "",
        ),
        details={key: stated(pattern, lines) for key, pattern in _KEYS.items()},
        contradiction=contradiction,
    )


def _steps(line: str) -> list[float]:
    """Return the intervals [s] that a line states, as a step or a rate."""
    found = []
    for match in _STEP.finditer(line):
        unit = (match["unit"] or "").lower()
        if match["unsure"] and (not match["sign"] or unit.startswith(("d", "k", "°"))):
            continue
        note = (match["note"] or match["note2"] or "").strip().lower()
        factor = next(
            (f for u, f in _SECONDS.items() if (unit or note).startswith(u)), 1.0
        )
        factor = 60.0 if (unit or note).startswith("min") else factor
        found.append(float(f"{number_in(match['value']) * factor:.12g}"))
    found += [number_in(match["value"]) for match in _STEP_BEFORE.finditer(line)]
    for match in _RATE.finditer(line):
        words = match["value"] or match["value2"] or match["value3"]
        note = (
            f"{match['note'] or ''}{match['note2'] or ''}{match['unit'] or ''}".lower()
        )
        sure = match["named"] or match["unit"] or match["value2"] or match["value3"]
        rate = number_in(words.rstrip(".")) if sure and words.strip(".") else 0.0
        if rate > 0:
            rate *= 1000 if "khz" in note else 1
            found.append(float(f"{1 / rate:.9g}"))
    return [step for step in found if SHORTEST_STEP <= step <= LONGEST_STEP]


def _counts(line: str) -> list[int]:
    found = [m for m in _COUNT.finditer(line) if m["sign"] or not m["unsure"]]
    counted = _COUNTED.match(line)
    return [
        int(m["count"])
        for m in (*found, *([counted] if counted else []))
        if int(m["count"])
    ]


def _units_in(words: str) -> list[str]:
    """Return what may be units in words, canonical, from left to right."""
    parts = re.split(
        r"[,;]|\s+and\s+|(?<=[\w)\]])\s+(?![/\d])|[()\[\]]", words, flags=re.I
    )
    tokens = (_UNIT_TOKEN.match(part) for part in parts)
    return [canonical_unit(token["unit"]) for token in tokens if token]


def _quantity_and_unit(lines: Sequence[str]) -> tuple[str, str]:
    """Return the quantity and the unit of acceleration that the line nearest the numbers states."""
    for line in reversed(lines):
        explicit = _UNIT_WORDS.search(line)
        held = (
            next(iter(map(quantity_of, _units_in(explicit["rest"])[:1])), "")
            if explicit
            else ""
        )
        if held:
            return held, ""
        # one value, as of a velocity of waves, is not what the samples are
        of_one = _VALUE_OF.search(line) and not (
            _STEP.search(line) or _COUNT.search(line)
        )
        if _ONE_VALUE.search(line) or of_one:
            continue
        match = _QUANTITY_IN.search(line) or _IN_UNIT.search(line)
        first = next(iter(_units_in(match["rest"])), "") if match else _sure_unit(line)
        named = match.groupdict().get("quantity") if match else None
        if first in TO_SI and (named or first not in ("g", "mg") or not match):
            return "acceleration", first
        if named and quantity_of(first):
            return quantity_of(first), ""
    last = [
        m["quantity"].lower()
        for line in lines[-1:]
        if (m := _NAMED_QUANTITY.match(line))
    ]
    everywhere = any(
        m["quantity"].lower() == "acc"
        for x in lines
        for m in _NAMED_QUANTITY.finditer(x)
    )
    if last and not everywhere:
        return {"vel": "velocity", "dis": "displacement"}[last[0]], ""
    return "", ""


def _sure_unit(line: str) -> str:
    """Return a unit that only an acceleration has, if a line has one that is not of a value in it."""
    return next(
        (
            unit
            for part in re.split(r"(?<![\d.])[,;\s]+(?![/\d])", line)
            if (unit := canonical_unit(part)) in TO_SI and "/s" in unit
        ),
        canonical_unit(line),
    )


def _close(found: Sequence[float | int | str]) -> bool:
    """Tell whether statements of one fact are numbers that differ by rounding only, to a ten-thousandth."""
    numbers = [value for value in found if isinstance(value, float)]
    return len(numbers) == len(found) and max(numbers) - min(numbers) <= 1e-4 * max(
        numbers
    )
