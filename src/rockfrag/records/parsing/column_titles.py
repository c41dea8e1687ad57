"""The titles of the columns of a text file: time and its unit, quantities, components."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from rockfrag.records.parsing.number_fields import NumberTable
from rockfrag.records.parsing.quantities import TO_SI, canonical_unit, quantity_of

_TIME = re.compile(
    r"(?i)^(?:elapsed\s*|relative\s*)?(?:t|times?|sec|seconds?|ms|msec|millis\w*|min|minutes?|zeit|temps|tiempo"
    r"|tempo)(?![a-z])"
)
_INDEX = re.compile(
    r"(?i)^(?:no|nr|index|idx|i|samples?|points?|steps?|rows?|counter|line)\W*(?:no|nr|number|index|id)?\W*$"
    r"|^#$|^number$"
)
_SECONDS = {"(?:s|sek)?": 1.0, "(?:milli|ms).*": 1e-3, "micro.*|[uµμ]s": 1e-6}
_SECONDS |= {"min.*": 60.0, "h|hrs?|hours?": 3600.0}
"""Units of time, as patterns, in seconds."""

_SPECTRA = re.compile(
    r"^(?:period|freq|omega)|\bspectr|\b(?:psa|psv|sa|sv|sd|rotd\d*)\b", re.I
)
_WORDS = {
    "acceleration": re.compile(r"(?<![a-z])a(?:cc(?:el\w*|n)?)?(?![a-z])|accel", re.I),
    "velocity": re.compile(r"(?<![a-z])(?:v|vel(?:oc\w*)?)(?![a-z])", re.I),
    "displacement": re.compile(r"(?<![a-z])(?:d|u|dis(?:pl?\w*)?)(?![a-z])", re.I),
}
_OTHERS = re.compile(
    r"(?i)\b(?P<what>force|load|temp(?:erature)?|resistance|pressure|stress|strain|moment|rotation|angle"
    r"|volt(?:age)?|current|depth|elevation|height|energy|power|humidity|weight|mass|torque|speed|drift|stiffness"
    r"|gyro\w*|friction)s?(?![a-z])"
)
_ORIENTATION = re.compile(
    r"(?i)^(?:[NSEWUD]-?[NSEWUD]|[NEZUVLTXYH]|UP|VERT\w*|H[12]|[BHE][NLGH][ENZ123]|[NS]\d{1,2}[EW]|\d{1,3}"
    r"|north\w*|east\w*|radial|transverse|longitudinal|ch(?:annel)?\W?\d+)$"
)
_NO_QUANTITY = frozenset({"s", "ms", "-", "min"})
_AMBIGUOUS = frozenset("vud")
_BRACKETED = re.compile(r"[\[({](?P<unit>[^\[\](){}]*)[\])}]")


@dataclass(frozen=True)
class Column:
    """What a title says of its column."""

    title: str
    # ``time``, ``index``, ``spectrum``, ``acceleration``, ``force``, …; empty if it does not say
    quantity: str
    unit: str  # canonical unit of acceleration, or of a time
    component: str

    @property
    def seconds(self) -> float | None:
        """Seconds of a unit of a time column, None where its unit is not known."""
        return next(
            (s for unit, s in _SECONDS.items() if re.fullmatch(unit, self.unit)), None
        )


def column_titles(table: NumberTable, row: str) -> list[Column]:
    """Return the columns that the titles above a table name, none where it has no titles.

    The titles stand directly above the numbers, or have a line of units between; ``row``, the first of the
    numbers, shows how titles are separated.
    """
    if not table.words:
        return []
    separators = (
        []
        if table.decimal_comma
        else [mark for mark in (";", ",", "\t") if mark in row]
    )
    above = [words for _, words in table.words]
    words = above[-1]
    units = next(iter(_splits(words, separators, table.columns)), [])
    stated = [canonical_unit(cell.strip("[](){}")) for cell in units]
    if (
        len(above) > 1
        and units
        and all(u in _NO_QUANTITY or quantity_of(u) for u in stated)
    ):
        words = above[-2]
    else:
        units = [""] * table.columns
    for cells in _splits(words, separators, table.columns):
        columns = _columns(cells, units)
        if _are_titles(
            columns, " " in words.strip() and not any(" " in cell for cell in cells)
        ):
            return columns
    return []


def _are_titles(columns: list[Column], by_blanks: bool) -> bool:
    """Tell titles from a sentence that happens to have as many words as there are columns."""
    known = [column.quantity for column in columns]
    if len(columns) == 1:
        # above one column any words may stand; with a unit they are its title
        return bool(columns[0].unit) and known == ["acceleration"]
    if not by_blanks:
        return any(known)
    return all(known) or known[0] not in (
        "",
        "acceleration",
        "velocity",
        "displacement",
    )


def _splits(words: str, separators: list[str], width: int) -> Iterator[list[str]]:
    """Yield the ways in which words make as many titles as a row has columns."""
    patterns = [re.escape(mark) for mark in separators] + [
        r"\s{2,}|\t",
        r"\s+(?![\[(])",
        r"\s+",
    ]
    if not separators:
        patterns.append(",")
    for pattern in patterns:
        cells = [
            cell.strip(" \t\"'") for cell in re.split(pattern, words.rstrip(" \t,;"))
        ]
        # tables that programs write number their rows in a column without a title
        cells[0] = cells[0] or "#"
        if len(cells) == width and all(cells):
            yield cells


def _columns(titles: list[str], units: list[str]) -> list[Column]:
    columns = [
        _column(title, unit, first=number == 0)
        for number, (title, unit) in enumerate(zip(titles, units, strict=True))
    ]
    directed = any(
        _ORIENTATION.match(c.title) and c.title.lower() not in _AMBIGUOUS
        for c in columns
        if c.quantity != "time"
    )
    # beside N and E a V is the vertical, beside a it is the velocity
    return [
        Column(c.title, "acceleration", "", c.title)
        if directed and c.title.lower() in _AMBIGUOUS and not c.unit
        else c
        for c in columns
    ]


def _column(title: str, unit_below: str, first: bool) -> Column:
    bracketed = _BRACKETED.search(title)
    words = (
        title
        if bracketed is None
        else title[: bracketed.start()] + title[bracketed.end() :]
    )
    unit = canonical_unit(
        bracketed["unit"] if bracketed else unit_below.strip("[](){}")
    )
    if _TIME.match(words) and (first or words.strip().lower() != "t"):
        return Column(title, "time", _time_unit(words, unit), "")
    if not unit:
        # acc_g, NS_cm/s2, accel m/s^2
        head, _, last = re.sub(r"[_\s]+", " ", words.strip()).rpartition(" ")
        if head and quantity_of(canonical_unit(last)):
            words, unit = head, canonical_unit(last)
    bare = words.strip(" _-.:,")
    quantity = _quantity(words, unit, bare)
    pattern = _WORDS.get(quantity)
    component = pattern.sub("", words.replace("_", " "), count=1) if pattern else words
    component = " ".join(component.replace("[]", "").split()).strip(" -.:,")
    return Column(title, quantity, unit if unit in TO_SI else "", component)


def _quantity(words: str, unit: str, bare: str) -> str:
    """Return the quantity that the unit of a title names, else its words, else its direction."""
    if not bare or _SPECTRA.search(bare.replace("_", " ")):
        return "spectrum" if bare else ""
    spaced = words.replace("_", " ")
    other, directed = _OTHERS.search(spaced), _ORIENTATION.match(bare)
    found = (
        quantity_of(unit),
        "acceleration" if directed and len(bare) > 1 else "",
        next((name for name, pattern in _WORDS.items() if pattern.search(spaced)), ""),
        other["what"].lower() if other else "",
        "index" if _INDEX.match(bare) else "",
        "acceleration" if directed else "",
    )
    return next(filter(None, found), "")


def _time_unit(words: str, unit: str) -> str:
    """Return the unit of a time column: in brackets, behind the word (``time_ms``), or the title itself."""
    if not unit:
        parts = re.split(r"[\s_/,.:-]+", words.strip().lower())
        unit = canonical_unit(parts[-1]) if parts[-1] else ""
        if unit in {"t", "time", "times", "zeit", "temps", "temp", "tiempo", "tempo"}:
            unit = ""
    return "" if unit in {"utc", "gmt", "relative", "rel"} else unit
