"""The titles of the columns of a text file: time and its unit, quantities, directions, by one grammar."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from rockfrag.records.parsing.directions import is_direction, names_direction
from rockfrag.records.parsing.number_fields import NumberTable
from rockfrag.records.parsing.quantities import (
    Unit,
    has_factor,
    looks_like_unit,
    read_unit,
)
from rockfrag.records.parsing.vocabulary import (
    OF_SPECTRA,
    folded,
    spaced,
    without,
    words_for,
)

_LETTERS = {"acceleration": "a", "velocity": "v", "displacement": "[du]"}
"""Single letters for quantities, where they stand alone."""

_INDEX = re.compile(
    r"^(?:no|nr|index|idx|i|samples?|points?|steps?|rows?|counter|line)\W*(?:no|nr|number|index|id)?\W*$|^#$"
)
_SPECTRAL = re.compile(r"\b(?:psa|psv|sa|sv|sd|rotd\d*)\b")
_LETTERS_OF_UNITS = frozenset("NVACKJW%")
_NO_QUANTITY = frozenset({"-", ""})
_AMBIGUOUS = frozenset("vud")
# letters in brackets that are units of other quantities and directions
_DOUBTFUL = re.compile(r"[\[({]\s*([NV])\s*[\])}]")
_WORD = re.compile(r"[^\W_]")
_BRACKETED = re.compile(r"[\[({](?P<inside>(?:[^\[\](){}]|\([^()]*\))*)[\])}]")
_UNKNOWN_UNIT = re.compile(r"[^\W\d_]{1,10}[/^²][^\W_^]{0,6}[\^²]?\d?")
_LIKE_UNIT = re.compile(r"[^\W\d_]\s*[/^²]")
_BEFORE_UNITS = re.compile(
    r"(?i)in|of|units?|unit|values?|en|de|unidades|einheiten|unites|fraction|raw|corr?(?:ected)?|filt(?:ered)?|acc\w*"
)
_LIKE_ACCELERATION = re.compile(r"/\s*s\w*\s*(?:\^|\*\*)?\s*(?:2|/\s*s)")
_UNREADABLE = re.compile("[\x80-\x9f\ufffd]")  # of an encoding that was not known
_SEPARATOR = re.compile(r"[\s_.,:/-]+")
# words that stand in sentences above columns and never in titles
_SENTENCE = re.compile(
    r"(?i)^(?:in|of|the|and|at|from|to|for|by|de|del|la|el|en|der|die|das|von|und|di|du|des|et|is|are"
    r"|=|:|component|comp|station|direction|orientation|units?|unidades|event|earthquake)$|[=:]$|^[\[({].*[\])}]$"
)


# a fact and its value
_NO_TITLE = re.compile(r"[=:]\s*(?:[+-]?\d.*)?$|^[+-]?\d*[.,]\d+$")


@dataclass(frozen=True)
class Column:
    """What a title says of its column."""

    title: str
    # ``time``, ``index``, ``spectrum``, ``acceleration``, ``force``, …; empty if it does not say
    quantity: str
    unit: str  # canonical unit of acceleration, or of a time
    component: str
    # why the numbers cannot be taken as they stand, in words; empty if they can
    problem: str = ""

    @property
    def seconds(self) -> float | None:
        """Seconds of a unit of a time column, None where its unit is not known."""
        found = read_unit(self.unit)
        if not self.unit:
            return 1.0
        return found.to_si if found.quantity == "time" else None

    @property
    def is_said_acceleration(self) -> bool:
        """Whether a word of the title is acceleration, whatever its unit is."""
        return bool(words_for("acceleration").search(folded(spaced(self.title))))

    @property
    def is_named_magnitude(self) -> bool:
        """Whether the title speaks of the length of a vector and not of one of its components."""
        return bool(words_for("magnitude").search(folded(spaced(self.title))))


def column_titles(table: NumberTable, row: str) -> tuple[list[Column], int]:
    """Return the columns that the titles above a table name, none where it has no titles, and the lines they take.

    Parameters
    ----------
    table
        Where the numbers begin, and what stands above them: the titles directly, or with a line of units between.
    row
        The first of the numbers, which shows how titles are separated.

    Returns
    -------
    columns : list
        As many as a row has numbers, or none.
    lines : int
        Lines of words, the last ones above the numbers, that are titles, units and rulers.
    """
    every = [words for _, words in table.words]
    above = [words for words in every if _WORD.search(words)]
    if not above:
        return [], 0
    separators: list[str] = (
        []
        if table.decimal_comma
        else [mark for mark in (";", ",", "\t") if mark in row]
    )
    for words, units, taken in _places(above, separators, table.columns):
        for cells in _splits(words, separators, table.columns, row):
            columns = _columns(cells, units)
            if _are_titles(columns, _by_blanks(words, cells)):
                first = [i for i, line in enumerate(every) if _WORD.search(line)][
                    -taken
                ]
                return columns, len(every) - first
    return [], 0


def _places(
    above: list[str], separators: list[str], width: int
) -> Iterator[tuple[str, list[str], int]]:
    """Yield where titles may stand: above a line of units, or last; words, units, and lines that both take."""
    units = next(iter(_splits(above[-1], separators, width)), [])
    if len(above) > 1 and units and all(map(_is_unit, units)):
        yield above[-2], units, 2
    yield above[-1], [""] * width, 1


def are_titles_of_other_columns(words: str) -> bool:
    """Tell whether words are titles, of more or fewer columns than there are."""
    cells = [cell for cell in re.split(r"[\t,;]|\s{2,}", words) if cell.strip()]
    found = [_column(cell, "", first=False) for cell in cells]
    known = [c for c in found if c.quantity and not has_factor(c.title)]
    return len(cells) > 1 and len(known) > 1


def column_of(title: str, unit: str) -> Column:
    """Return what a title says of a column of samples whose unit stands elsewhere, empty where it does not."""
    return _column(title, unit, first=False)


def _is_unit(cell: str) -> bool:
    """Tell whether a cell of a line of units is one, known here or not."""
    bare = cell.strip("[](){} ")
    if bare in _NO_QUANTITY or bare in _LETTERS_OF_UNITS or read_unit(cell).quantity:
        return True
    return _UNKNOWN_UNIT.fullmatch(bare) is not None and not is_direction(bare)


def _by_blanks(words: str, cells: list[str]) -> bool:
    """Tell whether single blanks are all that separates the titles, as it does the words of a sentence."""
    apart = re.search(r"\S\s{2,}\S", words) and len(re.split(r"\s{2,}", words)) == len(
        cells
    )
    return not apart and " " in words.strip() and not any(" " in c for c in cells)


def _are_titles(columns: list[Column], by_blanks: bool) -> bool:
    """Tell titles from a sentence that happens to have as many words as there are columns.

    A lone title needs a unit of acceleration, or words of one. Of several, separated otherwise than by single
    blanks (``by_blanks``), one that is known is enough; of those that may be words of a sentence all have to be,
    or most have to name directions.
    """
    known = [column.quantity for column in columns]
    if any(_NO_TITLE.search(column.title) for column in columns):
        return False
    if len(columns) == 1:
        # above one column any words may stand; with a unit they are its title
        stated = bool(columns[0].unit or columns[0].problem)
        title = columns[0].title
        doubtful = columns[0].problem and (
            _DOUBTFUL.search(title) or _LIKE_ACCELERATION.search(folded(title))
        )
        return bool(doubtful) or (stated and known == ["acceleration"])
    bare_units = [bool(read_unit(column.title).quantity) for column in columns]
    if not by_blanks:
        named = (k for k, bare in zip(known, bare_units, strict=True) if not bare)
        return any(named) or all(known) or any(column.problem for column in columns)
    if any(_SENTENCE.search(column.title) for column in columns):
        return False
    directed = sum(names_direction(column.title) for column in columns)
    return (
        all(known)
        or known[0] not in ("", "acceleration", "velocity", "displacement")
        # one title that is not known does not take the others' names away
        or (directed > 1 and 2 * directed > len(columns))
    )


def _splits(
    words: str, separators: list[str], width: int, row: str = ""
) -> Iterator[list[str]]:
    """Yield the ways in which words make as many titles as a row has columns.

    A last title whose column is empty in the ``row`` below is none of them.
    """
    if words.startswith("#"):
        # the title of a column of numbers, or else the mark of a comment
        marks = [r"\s{2,}"] if words[1:2] == " " else separators or ["\t"]
        numbered = [c.strip(" \t\"'") for c in re.split("|".join(marks), words)]
        if len(numbered) == width and all(numbered):
            yield numbered
            return
        words = words.lstrip("# \t")
    patterns = [r"[\"']\s*[,;\t]\s*[\"']", *map(re.escape, separators)]
    patterns += [r"\s{2,}|\t", r"\s+(?![\[(])", r"\s+"]
    if not separators:
        patterns.append(",")
    for pattern in patterns:
        cells = [
            cell.strip(" \t\"'") for cell in re.split(pattern, words.rstrip(" \t,;"))
        ]
        # tables that programs write number their rows in a column without a title
        cells[0] = cells[0] or "#"
        if row.rstrip(" ").endswith(tuple(separators)) and len(cells) == width + 1:
            cells = cells[:-1]
        if len(cells) == width and all(cells):
            yield cells


def _columns(titles: list[str], units: list[str]) -> list[Column]:
    """Columns of titles and of the units below them.

    A letter that may be a quantity or a direction (v, u, d …) is a direction of acceleration where another title
    is one: beside N and E a V is the vertical, beside a it is the velocity.
    """
    columns = [
        _column(title, unit, first=number == 0)
        for number, (title, unit) in enumerate(zip(titles, units, strict=True))
    ]
    others = [c for c in columns if c.quantity != "time"]
    directed = any(
        c.title.lower() not in _AMBIGUOUS
        and (is_direction(c.title) or _has_direction_beside_word(c))
        for c in others
    )
    columns = [
        Column(title=c.title, quantity="acceleration", unit="", component=c.title)
        if directed and c.title.lower() in _AMBIGUOUS and not c.unit
        else c
        for c in columns
    ]
    return _with_doubtful_letters(columns)


def _has_direction_beside_word(column: Column) -> bool:
    """Tell whether a title is a word for acceleration and a direction, such as ``L Acceleration``."""
    return column.component != column.title and is_direction(column.component)


def _with_doubtful_letters(columns: list[Column]) -> list[Column]:
    """Columns with a problem where a letter, as in ``Acc (V)``, may be a unit (volts) or a direction (vertical).

    It may where no other column names a direction, where several have the same letter, where the title names a
    direction beside it, and of velocity.
    """
    named = sum(
        names_direction(c.component) or is_direction(c.component) for c in columns
    )
    letters = [_DOUBTFUL.search(c.title) for c in columns]
    every = [match[1] for match in letters if match]
    found = []
    for column, match in zip(columns, letters, strict=True):
        is_doubtful = match is not None and (
            named == 1
            or every.count(match[1]) > 1
            or " " in column.component
            or column.quantity == "velocity"
        )
        if match and is_doubtful and not column.unit:
            problem = f"({match[1]}) may be a unit or a direction"
            column = replace(column, problem=problem)
        found.append(column)
    return found


@dataclass(frozen=True)
class _Title:
    """A title taken apart."""

    words: str  # without its unit
    unit: Unit  # with an empty name if none is stated
    problem: str = ""


def _column(title: str, unit_below: str, first: bool) -> Column:
    """What a column holds by its title: quantity, unit and direction."""
    found = _taken_apart(title, unit_below)
    words, unit = found.words, found.unit
    bare = folded(spaced(words)).strip(" _-.:,/")
    quantity = _quantity(title, bare, unit, first)
    if quantity == "time":
        return Column(title, "time", _time_unit(title, bare, unit), "")
    component = " ".join(spaced(words).replace("[]", "").split())
    if quantity in _LETTERS:
        kept = without(quantity, component)
        if kept == component:
            letter = _LETTERS[quantity]
            kept = re.sub(
                rf"(?i)(?<![^\W\d_]){letter}(?![^\W\d_])", " ", component, count=1
            )
        component = kept
    component = " ".join(component.split()).strip(" -.:,/")
    problem = found.problem
    if unit.factor:
        problem = f"{unit.factor!r} has a factor that may be meant either way"
    elif (
        unit.name
        and not (unit.quantity and quantity != "acceleration")
        and unit.quantity != "acceleration"
    ):
        problem = problem or f"{unit.name!r} is no unit of acceleration known here"
    stated = unit.name if unit.quantity == "acceleration" and not problem else ""
    return Column(title, quantity, stated, component, problem)


def _taken_apart(title: str, unit_below: str) -> _Title:
    """Return the words and the unit of a title, and what in it is neither.

    ``unit_below``: cell of a line of units under the title. Brackets hold a unit, a name or something unknown; a
    unit may also end the words.
    """
    title = re.sub(r"\^\{([+-]?\d)\}", r"^\1", title)
    words, unit, problem = title, Unit(""), ""
    for bracketed in _BRACKETED.finditer(title):
        inside = bracketed["inside"].strip()
        known = read_unit(inside)
        is_name = is_direction(inside) and known.quantity in ("", "time")
        if inside and not (is_name and inside == inside.upper()) and known.quantity:
            unit = known
            words = words.replace(bracketed[0], " ")
        elif not is_name and _is_part_of_unit(inside):
            problem = f"{inside!r} is no unit known here"
            words = words.replace(bracketed[0], " ")
        elif is_name or not inside or not looks_like_unit(inside):
            words = words.replace(bracketed[0], f" {inside} ")
        else:
            problem = f"{inside!r} is no unit known here"
            words = words.replace(bracketed[0], " ")
    if not unit.name and unit_below.strip("[](){} ") not in _NO_QUANTITY:
        unit = read_unit(unit_below.strip("[](){}"))
    if not unit.name and not problem:
        words, unit = _unit_behind(words)
    if not unit.name and not problem and (unknown := _unknown_unit_behind(words)):
        problem = f"{unknown!r} is no unit known here"
    if not unit.name and _UNREADABLE.search(title):
        problem = "some of its letters cannot be read; save the file as UTF-8"
    if has_factor(words):
        problem = f"{title!r} has a factor that may be meant either way"
    return _Title(words, unit, problem)


def _is_part_of_unit(inside: str) -> bool:
    """Tell whether words in brackets end with a unit that the words before it change, as in ``sixths of g``."""
    before, unit = _unit_behind(inside)
    parts = [part for part in _SEPARATOR.split(before) if part]
    known = (_BEFORE_UNITS.fullmatch(part) or is_direction(part) for part in parts)
    return unit.quantity == "acceleration" and not all(known)


def _unit_behind(words: str) -> tuple[str, Unit]:
    """Return words without the unit that ends them, and the unit: ``acc_g``, ``acc_m_s2``, ``a / g``."""
    whole = read_unit(words)
    if whole.quantity not in ("", "time") and not is_direction(words):
        return "", whole
    marks = [m for m in _SEPARATOR.finditer(words) if m.start()][-3:][::-1]
    # acc_m_s2 before acc m/s2: the s2 alone is no unit; m_s_2 has three parts
    for mark in [*marks[1:2], *marks[:1], *marks[2:]]:
        tail = words[mark.end() :]
        unit = read_unit(tail)
        # KG and DB are north and east in Turkish
        named = is_direction(tail) and unit.quantity != "acceleration"
        if unit.quantity not in ("", "time") and not named:
            return words[: mark.start()], unit
    return words, Unit("")


def _unknown_unit_behind(words: str) -> str:
    """Return what ends words and looks like a unit, as ``acc furlong/s2``, or nothing."""
    parts = words.split()
    last = parts[-1] if parts else ""
    if not _LIKE_UNIT.search(last) or is_direction(last.replace("/", "-")):
        return ""
    return last


def _quantity(title: str, bare: str, unit: Unit, first: bool) -> str:
    """Return the quantity that the unit of a title names, else its words, else its direction."""
    of_spectra = OF_SPECTRA.search(bare) or _SPECTRAL.search(bare)
    spectrum = words_for("spectrum").match(bare) or of_spectra
    if bare and spectrum:
        return "spectrum"
    by_unit = "" if unit.quantity == "time" else unit.quantity
    if by_unit:
        return by_unit
    named = _named_quantity(bare)
    if not named and _is_time(bare, unit, first):
        return "time"
    if not bare:
        return ""
    other = words_for("other").search(bare)
    directed = is_direction(bare)
    index = _INDEX.match(bare) or words_for("index").fullmatch(bare)
    found = (
        "acceleration" if directed and len(bare) > 1 else "",
        named,
        other[0] if other else "",
        "index" if index else "",
        "acceleration" if directed or names_direction(bare) else "",
    )
    return next(filter(None, found), "")


def _named_quantity(bare: str) -> str:
    """Return the quantity of motion that a word or a letter of a title names, or nothing."""
    for quantity, letter in _LETTERS.items():
        alone = rf"(?<![^\W\d_]){letter}(?![^\W\d_])"
        if words_for(quantity).search(bare) or re.search(alone, bare):
            return quantity
    return ""


def _is_time(bare: str, unit: Unit, first: bool) -> bool:
    """Tell whether a title is one of times, by its word or by its unit."""
    if bare == "t":
        # behind other columns a t is a transverse component
        return first or unit.quantity == "time"
    # NS is no nanosecond
    by_unit = read_unit(bare).quantity == "time" and not is_direction(bare)
    return bool(words_for("time").search(bare)) or by_unit or unit.quantity == "time"


def _time_unit(title: str, bare: str, unit: Unit) -> str:
    """Return the unit of a time column: in brackets, behind the word (``time_ms``), or the title itself."""
    if unit.name:
        return "" if unit.name in {"utc", "gmt", "relative", "rel"} else unit.name
    bracketed = _BRACKETED.search(title)
    if bracketed and not is_direction(bracketed["inside"]):
        inside = folded(bracketed["inside"]).strip()
        return "" if inside in {"utc", "gmt", "relative", "rel"} else inside
    last = re.split(r"[\s/,.:-]+", bare)[-1]
    return last if read_unit(last).quantity == "time" else ""


def components_of(columns: Sequence[Column]) -> list[str]:
    """Return the names of components, the titles where two would have one name."""
    names = [column.component for column in columns]
    return [
        name if names.count(name) == 1 else column.title
        for name, column in zip(names, columns, strict=True)
    ]
