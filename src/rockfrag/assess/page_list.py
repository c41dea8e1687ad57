"""The list that the one-file page saves, as keys of ``statue.yaml``.

In: ``objects.csv``, whose columns are the fields of the page's form and whose cells hold their units. Out: of each
row its keys, and the hazard curve that was pasted into the page. Docs: ``docs/app.md``, "What it says".
"""

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rockfrag.assess.app.form import Field, form_fields
from rockfrag.assess.hazard.curve import (
    HazardCurve,
    make_curve,
    rates_of,
    read_measure,
)
from rockfrag.base.errors import InputError
from rockfrag.collections.exported_table import table_cells, table_titles

SHAKING = ("measure", "level", "years", "hazard")
"""Columns that say the place's shaking, of which several keys may follow."""

FORM = form_fields(())
FIELDS = tuple(field.name for field in FORM)
"""Columns of the list: the fields of the page's form."""

KEYS_OF_SHAKING = ("pga", "pgv", "sa", "return_period", "return_period_years", "hazard")
"""Keys of ``statue.yaml`` that the list says itself."""

MARKS = ("measure", "level")  # Columns that no inventory has


@dataclass(frozen=True)
class ListedObject:
    """A row of the list."""

    line: int  # Of the file, at which the row begins
    name: str
    settings: Mapping[str, Any]  # Keys of ``statue.yaml``, the shaking among them


@dataclass(frozen=True)
class PageList:
    """Objects that were kept in the page, at one place."""

    objects: Sequence[ListedObject]
    hazard: HazardCurve | None  # The curve that was pasted; None where none was


def is_page_list(path: str | os.PathLike[str]) -> bool:
    """Whether a table is a list that the page saved.

    Parameters
    ----------
    path : CSV file with a header line

    Returns
    -------
    Whether :func:`read_page_list` is to read it.
    """
    return set(MARKS) <= set(table_titles(path)) <= set(FIELDS)


def read_page_list(path: str | os.PathLike[str]) -> PageList:
    """Read the objects of a list that the page saved.

    Parameters
    ----------
    path : CSV file with a header line; cells may hold line breaks

    Returns
    -------
    The objects, and the hazard of their place.

    Raises
    ------
    InputError
        If a row has another number of cells, or other shaking than the rows above it: a list is of one place.
    """
    titles, rows = table_cells(path)
    objects = []
    shaking: dict[str, str] = {}
    for line, cells in rows:
        if len(cells) != len(titles):
            raise InputError(
                f"{path}, line {line}: expected {len(titles)} cells as in the header, found {len(cells)}."
            )
        form = dict(zip(titles, cells, strict=True))
        own = {name: form.get(name, "") for name in SHAKING}
        shaking = shaking or own
        _check_shaking(own, shaking, f"{path}, line {line}")
        objects.append(ListedObject(line, form.get("name", ""), _settings(form)))
    curve, pasted = None, shaking["hazard"]
    if pasted:
        curve = _curve(pasted, shaking["measure"], f"{path}, column hazard")
    return PageList(objects, curve)


def _check_shaking(own: dict[str, str], first: dict[str, str], where: str) -> None:
    """Refuse a row whose place shakes otherwise than that of the first one."""
    for column, text in own.items():
        if text != first[column]:
            above = first[column][:40]
            raise InputError(
                f"{where}, column {column}: {text[:40]!r} differs from {above!r} above; a list is of one place: "
                "save the objects of each place in a list of their own."
            )


def _settings(form: Mapping[str, str]) -> dict[str, Any]:
    """Keys of ``statue.yaml`` of a row; a building is one only where a floor is given, as in the form."""
    given = {name: _with_point(text) for name, text in form.items() if text}
    settings: dict[str, Any] = {}
    for field in FORM:
        if field.name not in given or field.name in SHAKING:
            continue
        *home, key = field.key
        if home == ["building"] and "floor" not in given:
            continue
        value = _value(field, given[field.name])
        if value is False:
            # a box that is not ticked
            continue
        # keys of the pedestal and of the building stand in mappings of their own
        place = settings.setdefault(home[0], {}) if home else settings
        place[key] = value
    return settings | _level(given)


def _value(field: Field, text: str) -> Any:
    """What a cell says, as ``statue.yaml`` has it."""
    if field.kind == "number":
        return _number(text)
    if field.kind == "flag":
        return text.lower() == "true"
    return text


def _level(given: Mapping[str, str]) -> dict[str, Any]:
    """Settings of the level and its return period, of the form's fields."""
    settings: dict[str, Any] = {}
    measure = given.get("measure", "PGA")
    if "level" in given:
        period = re.fullmatch(r"SA\((.*)\)", measure)
        key = "sa" if period else measure.lower()
        level = given["level"]
        settings[key] = [f"{period[1]} s", level] if period else level
    if "years" in given:
        settings["return_period"] = given["years"]
    return settings


_COMMA = re.compile(r"^([-+]?\d+),(\d+)")


def _with_point(text: str) -> str:
    """A number with a decimal point, as the form takes either."""
    return _COMMA.sub(r"\1.\2", text)


def _number(text: str) -> float | str:
    """A number; what is none stays as it is, and is refused with the other keys."""
    try:
        return float(text)
    except ValueError:
        return text


def _curve(text: str, measure: str, where: str) -> HazardCurve:
    """The curve of lines of a level and its rate; a heading may say what else stands for the rate."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    heading = ""
    if lines and re.search("[a-df-zA-DF-Z]", lines[0]):
        heading = lines.pop(0).lower()
    points = sorted(_point(line, where) for line in lines)
    often = [value for _, value in points]
    if probability := re.search(r"poe(?:_?(\d+))?", heading):
        rates = list(rates_of(often, float(probability[1] or 50), where))
    elif re.search(r"return|tr\b|anni|periodo", heading):
        if min(often, default=1) <= 0:
            raise InputError(f"{where}: a return period must be above 0 years.")
        rates = [1 / value for value in often]
    else:
        rates = often
    return make_curve(
        read_measure(measure, where), [level for level, _ in points], rates, where
    )


def _point(line: str, where: str) -> tuple[float, float]:
    """Level and how often it is exceeded, the two numbers of a line.

    A blank, a semicolon, a tabulator or a comma stands between them; ``where``: for messages.
    """
    cells = [cell for cell in re.split(r"[;\s]+|,(?=\s)", line) if cell]
    if len(cells) == 1:
        cells = line.split(",")
    numbers = [_number(_with_point(cell)) for cell in cells]
    if len(numbers) != 2 or any(isinstance(number, str) for number in numbers):
        raise InputError(
            f"{where}: expected a level and how often it is exceeded, found {line[:40]!r}."
        )
    level, often = numbers
    return float(level), float(often)
