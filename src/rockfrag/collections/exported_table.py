"""Tables of collections as museums export them, read into objects of an inventory.

Such a table has a row an object, a title, a text of dimensions or columns of numbers, and whatever else its museum
keeps. What is read of each object is said; what has to be asked before it can be assessed is said too, and nothing
is guessed. In goes a CSV file, out come :class:`CollectedObject` and the table that ``rockfrag assess`` reads.
"""

import csv
import io
import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.base.files import FORMULA, LONGEST_NAME, file_name
from rockfrag.base.text_files import table_encoding
from rockfrag.collections.dimension_text import (
    METRES,
    Dimensions,
    Length,
    read_dimensions,
)
from rockfrag.collections.materials import solid_of

NAMES = ("title", "name", "object name", "objectname", "object title", "titel", "titre")
NUMBERS = (
    *("object number", "objectnumber", "accession number", "accession_number"),
    *("accessionnumber", "accessionnum", "inventory number", "objectid", "object id"),
    *("inventarnummer", "id", "uuid"),
)
MATERIALS = (
    *("medium", "material", "materials", "materials and techniques", "technique"),
    *("materialien", "matériau", "matériaux", "matière", "materia", "materiali"),
    *("materiale", "materiales", "materiaal", "materialen", "classification material"),
)
TEXTS = ("dimensions", "dimension", "size", "maße", "abmessungen", "afmetingen")
SIDES = ("height", "width", "depth", "diameter")
MOST_BYTES = 512 * 2**20


@dataclass(frozen=True)
class CollectedObject:
    """One row of an exported table.

    Attributes
    ----------
    name : its name, which no other row bears
    line : line of the file at which the row begins
    text : its dimensions as they stand
    dimensions : what was understood of them
    material : what it is made of, as it stands; empty where that is not stated
    """

    name: str
    line: int
    text: str
    dimensions: Dimensions
    material: str = ""

    @property
    def mass(self) -> float | None:
        """Mass that is stated, or that of a solid box or cylinder of its material [kg]; None without either."""
        size, solid = self.dimensions, solid_of(self.material)
        if size.mass is not None or solid is None or size.height is None:
            return size.mass
        if size.width is None and size.diameter is not None:
            base = math.pi / 4 * size.diameter.low**2
        elif size.width is not None and size.depth is not None:
            base = size.width.low * size.depth.low
        else:
            return None
        return solid.density * base * size.height.high

    @property
    def understood(self) -> str:
        """What was understood of its size and its material, in words."""
        said, solid = self.dimensions.understood, solid_of(self.material)
        if solid is None or self.dimensions.mass is not None or self.mass is None:
            return said
        between = f"{solid.low:.0f} to {solid.high:.0f} kg/m³"
        return f"{said}, solid {self.material} of {between} ({solid.source})"

    @property
    def question(self) -> str:
        """What has to be asked before it can be assessed; empty where nothing has."""
        size = self.dimensions
        if size.question:
            return size.question
        if size.height is None:
            return "no height is stated; give it"
        if size.width is None and size.diameter is None:
            return "neither width nor diameter is stated; give one"
        return ""


def is_export(path: str | os.PathLike[str]) -> bool:
    """Whether a table is a museum's: it has a text of dimensions, or heights under a title such as Height (cm).

    Parameters
    ----------
    path : CSV file with a header line; an inventory of ``rockfrag assess`` is none

    Returns
    -------
    Whether :func:`read_export` is to read it.
    """
    titles = table_titles(path)
    named = {title.strip().casefold() for title in titles}
    if "name" in named and any(_OF_INVENTORY.fullmatch(title) for title in named):
        return False
    columns = {_plain_title(title): i for i, title in enumerate(titles)}
    if _first(columns, TEXTS) is not None:
        return True
    # without a title of its objects it is nobody's export
    return _first(columns, NAMES) is not None and "height" in _columns_of_sides(columns)


_OF_INVENTORY = re.compile(r"width(_[a-z]+)?")
"""Title of a column that every inventory has."""


def read_export(path: str | os.PathLike[str], order: str = "") -> list[CollectedObject]:
    """Read the objects of an exported table.

    Parameters
    ----------
    path : CSV file with a header line; cells may hold line breaks
    order : order of lengths that its texts do not name, such as ``HWD``

    Returns
    -------
    An object for each row, in the order of the rows.

    Raises
    ------
    InputError
        If the file cannot be read, or has neither a text of dimensions nor a column of heights.
    """
    titles, rows = table_cells(path)
    columns = {_plain_title(title): i for i, title in enumerate(titles)}
    text_at = _first(columns, TEXTS)
    sides = _columns_of_sides(columns)
    if text_at is None and "height" not in sides:
        raise InputError(
            f"{path}: expected a column Dimensions, or one of heights with its unit such as Height (cm); "
            f"found {', '.join(titles)[:300]}."
        )
    name_at, number_at = _first(columns, NAMES), _first(columns, NUMBERS)
    material_at = _first(columns, MATERIALS)
    taken: set[str] = set()
    found = []
    for line, cells in rows:
        if len(cells) != len(titles):
            raise InputError(
                f"{path}, line {line}: expected {len(titles)} cells as in the header, found {len(cells)}; "
                "a text that holds the separator needs double quotes."
            )
        title = "" if name_at is None else cells[name_at]
        number = "" if number_at is None else cells[number_at]
        name = _own_name(title, number, line, taken)
        text = "" if text_at is None else " ".join(cells[text_at].split())
        stated = {side: cells[at] for side, (at, _) in sides.items()}
        units = {side: unit for side, (_, unit) in sides.items()}
        size = _of_numbers(stated, units, f"{path}, line {line}")
        if size is None:
            size = read_dimensions(text, order)
        material = "" if material_at is None else " ".join(cells[material_at].split())
        found.append(CollectedObject(name, line, text, size, material))
    return found


def inventory_table(objects: Sequence[CollectedObject]) -> pd.DataFrame:
    """Make the inventory of objects of which nothing has to be asked, as ``rockfrag assess`` reads it.

    Parameters
    ----------
    objects : objects of an export

    Returns
    -------
    A row an object: ``name``, ``width_m``, ``height_m``, ``depth_m``, ``mass_kg``, ``round``.
    """
    rows = [inventory_cells(each) for each in objects if not each.question]
    columns = ["name", "width_m", "height_m", "depth_m", "mass_kg", "round"]
    table = pd.DataFrame(rows, columns=columns)
    return table[
        [name for name in columns if (table[name] != "").any() or name in columns[:3]]
    ]


def inventory_cells(collected: CollectedObject) -> dict[str, str]:
    """Cells of an object in an inventory.

    Of a range the height is its upper limit and a side its lower one: what topples first.

    Parameters
    ----------
    collected : an object of which nothing has to be asked

    Returns
    -------
    Texts by column; empty where nothing is stated.
    """
    size = collected.dimensions
    width = size.width or size.diameter
    assert width is not None and size.height is not None
    return {
        "name": collected.name,
        "width_m": _written(width.low),
        "height_m": _written(size.height.high),
        "depth_m": _written(size.depth.low) if size.depth else "",
        "mass_kg": "" if (mass := collected.mass) is None else _written(mass),
        "round": "" if size.width else "yes",
    }


def _written(value: float) -> str:
    """A number without the noise of the conversion of its unit."""
    return f"{value:.6g}"


def table_titles(path: str | os.PathLike[str]) -> list[str]:
    """Titles of the columns of a table.

    Parameters
    ----------
    path : file, if it is one

    Returns
    -------
    The titles; none of what is no CSV file, or cannot be read.
    """
    if Path(path).suffix.lower() != ".csv" or not Path(path).is_file():
        return []
    try:
        return table_cells(path)[0]
    except InputError:
        return []


def table_cells(
    path: str | os.PathLike[str],
) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Read the cells of a CSV file, which may hold line breaks.

    Parameters
    ----------
    path : of the file, which messages name

    Returns
    -------
    The titles, and of each row the line at which it begins and its cells.
    """
    encoding = table_encoding(path)
    if Path(path).stat().st_size > MOST_BYTES:
        raise InputError(
            f"{path}: is larger than {MOST_BYTES // 2**20} MiB; divide it."
        )
    text = Path(path).read_text(encoding=encoding)
    head = text.partition("\n")[0]
    delimiter = max((",", ";", "\t"), key=head.count)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter)
    rows: list[tuple[int, list[str]]] = []
    line = 1
    try:
        for cells in reader:
            if any(cell.strip() for cell in cells):
                rows.append((line, [cell.strip() for cell in cells]))
            line = reader.line_num + 1
    except csv.Error as error:
        raise InputError(f"{path}: is not a readable CSV file ({error}).") from error
    if len(rows) < 2:
        raise InputError(
            f"{path}: expected a header line and a row or more, found {len(rows)} lines."
        )
    (_, titles), *rest = rows
    return titles, rest


def _plain_title(title: str) -> str:
    return " ".join(title.casefold().replace("_", " ").split())


def _first(columns: Mapping[str, int], names: Sequence[str]) -> int | None:
    """Place of the first of several columns that is there."""
    return next(
        (
            columns[_plain_title(name)]
            for name in names
            if _plain_title(name) in columns
        ),
        None,
    )


def _columns_of_sides(columns: Mapping[str, int]) -> dict[str, tuple[int, str]]:
    """Place and unit of the columns that hold a side as a number: ``Height (cm)``, ``height_cm``."""
    found = {}
    for title, at in columns.items():
        stated = re.fullmatch(r"(\w+)\s*(?:\((\w+)\.?\)|(\w+))", title)
        if stated and stated[1] in SIDES and (stated[2] or stated[3]) in METRES:
            found[stated[1]] = at, stated[2] or stated[3]
    return found


def _of_numbers(
    stated: Mapping[str, str], units: Mapping[str, str], where: str
) -> Dimensions | None:
    """Size of an object out of columns of numbers; None where its height is not among them."""
    lengths = {}
    for side, text in stated.items():
        if not text:
            continue
        try:
            value = float(text)
        except ValueError:
            raise InputError(
                f"{where}, column {side}: expected a number, found {text!r}."
            ) from None
        if math.isfinite(value) and value > 0:
            metres = value * METRES[units[side]]
            lengths[side] = Length(metres, metres)
    return Dimensions().with_lengths(lengths) if "height" in lengths else None


def _own_name(title: str, number: str, line: int, taken: set[str]) -> str:
    """A name that no row above bears, that shows in tables and gives a file name of its own.

    Parameters
    ----------
    title, number : of the object; its number in the collection tells two of one title apart
    line : of the table, for an object without a title
    taken : folded file names of the rows above; that of this row is added
    """
    words = "".join(c if c.isprintable() else " " for c in title)
    words = " ".join(words.split()).lstrip("".join(FORMULA)).strip() or f"line {line}"
    suffix = f" ({' '.join(number.split())})" if number and number.isprintable() else ""
    count = 1
    name = words[:LONGEST_NAME]
    while file_name(name).casefold() in taken or not any(c.isalnum() for c in name):
        mark = suffix if suffix and count == 1 else f"{suffix} {count + 1}"
        name = f"{words[: LONGEST_NAME - len(mark)]}{mark}"
        count += 1
    taken.add(file_name(name).casefold())
    return name
