"""The page: one HTML file that loads nothing from outside, with its figures inside as text and lines.

In: an answer and sections (:mod:`rockfrag.report.part`) with tables, of which :class:`Column` says what is shown.
Out: HTML; the same contents give the same bytes. Templates in ``templates/`` only lay out.

Docs: ``docs/report.md``.
"""

import base64
import json
import math
import re
import zlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
from markupsafe import Markup

from rockfrag.base.figure_style import (
    BAND,
    BLUE,
    GREEN,
    GREY,
    GUIDE,
    PURPLE,
    RED,
    save_figure,
)
from rockfrag.report.part import Answer, FigureSpec, Section
from rockfrag.runtime.processes import in_processes
from rockfrag.words.catalogue import FIRST, catalogue
from rockfrag.words.findings import finding
from rockfrag.words.numbers import kept_together
from rockfrag.words.sentences import estimates, number, probability, sentence


def in_a_page(value: Any) -> Any:
    """Return a value as a page prints it: numbers stay on a line with their units.

    Parameters
    ----------
    value : what a template prints, of any type

    Returns
    -------
    Text with no-break spaces between numbers and units; HTML and what is no text as it is.
    """
    return kept_together(value) if type(value) is str else value


TEMPLATES = Environment(
    loader=PackageLoader("rockfrag.report"),
    autoescape=select_autoescape(default=True),
    undefined=StrictUndefined,
    finalize=in_a_page,
)
"""Scripts, styles and elements of pages."""

_PIXELS_PER_POINT = 96 / 72 * 1.22
_LONGEST_LINE = 28
_LONG_COLUMN = 2  # so many columns more is a column of sentences
_NOTHING = Markup("")

_SCHEME = {
    "#000000": "ink",
    "#ffffff": "paper",
    GREY: "rule",
    BAND: "band",
    "#cccccc": "faint",
    GUIDE: "rule",
    BLUE.lower(): "blue",
    RED.lower(): "red",
    GREEN.lower(): "green",
    PURPLE.lower(): "violet",
}
"""Colours of drawings that follow the reader's scheme, light or dark, and their names in the style."""


Row = Mapping[Any, Any]  # a row of a table

Words = Callable[[pd.DataFrame], Iterable[str]]


@dataclass(frozen=True)
class Column:
    """A column of a table on the page; made by :func:`column`, :func:`estimated` and :func:`p_values`."""

    name: str  # Column of the data
    title: str  # What its head says, with the unit
    # Decimals of numbers, or what words the column of a table; None for text
    shown: int | Words | None = None
    # Whether text is of numbers and stands to the right, as they do
    numeric: bool = False


_UNITS = {unit: unit for unit in ("m", "cm", "mm", "kg", "g", "rad", "bit")} | {
    "deg": "°"
}


def usual_title(name: str) -> str:
    """Head of a column by its name: ``width_cm`` becomes ``Width [cm]``."""
    stem, _, unit = name.rpartition("_")
    words = f"{stem} [{_UNITS[unit]}]" if stem and unit in _UNITS else name
    return sentence(words.replace("_", " "))


def column(
    name: str, title: str = "", *, decimals: int | None = None, numeric: bool = False
) -> Column:
    """Column of numbers or text.

    Parameters
    ----------
    name, title : column of the data, and its head; by default the name in words with its unit
    decimals : of numbers; None for text
    numeric : whether text is of numbers and stands to the right, as they do

    Returns
    -------
    The :class:`Column`.
    """
    return Column(name, title or usual_title(name), decimals, numeric)


def by_row(words: Callable[[Row], str]) -> Words:
    """Words of a column, row by row.

    Parameters
    ----------
    words : text of a row

    Returns
    -------
    The function that a :class:`Column` takes as ``shown``.
    """
    return lambda table: [words(row) for row in table.to_dict("records")]


def estimated(
    name: str,
    title: str = "",
    decimals: int | None = None,
    limits: tuple[str, str] | None = None,
) -> Column:
    """Column of estimates with their limits, see :func:`rockfrag.words.sentences.estimates`.

    Parameters
    ----------
    name, title : column of the data, and its head; by default the name in words with its unit
    decimals : of the estimates; by default three digits of the smallest
    limits : columns of lower and upper limit; by default the name with ``_lower`` and ``_upper``

    Returns
    -------
    The :class:`Column`.
    """
    return Column(
        name,
        title or usual_title(name),
        lambda table: estimates(table, name, decimals, limits),
    )


def p_values(name: str, title: str = "") -> Column:
    """Column of p values.

    Parameters
    ----------
    name, title : column of the data, and its head; by default the name in words

    Returns
    -------
    The :class:`Column`.
    """
    return Column(
        name, title or usual_title(name), lambda table: map(probability, table[name])
    )


def cell(value: Any, digits: int | None) -> str:
    """Format one cell: numbers to their digits, truth as yes or no, and a dash for what is missing."""
    if value is None or value is pd.NA:
        return "–"
    if isinstance(value, float) and not math.isfinite(value):
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if digits is not None and not isinstance(value, str):
        return number(value, digits)
    return str(value) if str(value) else "–"


MOST_TABLE_ROWS = 500
"""Rows of a table on the page; of more the first so many, and the name of the file that has all."""


def table_html(
    table: pd.DataFrame,
    columns: Sequence[Column],
    caption: str,
    file: str = "",
    *,
    language: str = FIRST,
) -> Markup:
    """Table on the page, empty without rows.

    Parameters
    ----------
    table, columns : the data, and what is shown of them
    caption, file
        What stands above it, and the file with all rows; where it is named ``MOST_TABLE_ROWS`` are shown.
    language : of what is said of rows that are not shown

    Returns
    -------
    HTML.
    """
    if table.empty:
        return Markup("")
    if file and len(table) > MOST_TABLE_ROWS:
        cut = finding("table_cut", shown=MOST_TABLE_ROWS, n=len(table), file=file)
        caption += f" {catalogue(language).say(cut)}"
        table = table.iloc[:MOST_TABLE_ROWS]
    head = [(column.title, _kind(table, column)) for column in columns]
    records = table.to_dict("records")
    texts = [
        column.shown(table)
        if callable(column.shown)
        else [cell(row[column.name], column.shown) for row in records]
        for column in columns
    ]
    rows = list(zip(*texts, strict=True))
    room = len(columns) + _LONG_COLUMN * [kind for _, kind in head].count("long")
    return framed(caption, head, rows, room)


def framed(
    caption: str,
    head: Sequence[tuple[str, str]],
    rows: Sequence[Sequence[str | Markup]],
    room: int,
) -> Markup:
    """Table from titles and kinds of columns; the more room they need, the sooner its rows become lists.

    Parameters
    ----------
    caption, head : what stands above it, and title and kind (``number``, ``short``, ``long``) of each column
    rows, room : texts or HTML of the cells, and the number of columns, long ones counted more than once

    Returns
    -------
    HTML.
    """
    size = "few" if room <= 4 else "some" if room <= 7 else "many"
    template = TEMPLATES.get_template("table.html.j2")
    return Markup(
        template.render(caption=caption, head=head, rows=rows, room=size).strip()
    )


def text_table(
    titles: Sequence[str],
    rows: Iterable[Sequence[str]],
    caption: str,
    numeric: Sequence[str] = (),
) -> Markup:
    """Table of texts under their titles.

    Parameters
    ----------
    titles, rows, caption : heads of the columns, texts of the cells, and what stands above
    numeric : titles of columns of numbers, which stand to the right

    Returns
    -------
    HTML.
    """
    columns = [Column(title, title, numeric=title in numeric) for title in titles]
    return table_html(pd.DataFrame(rows, columns=list(titles)), columns, caption)


def _kind(table: pd.DataFrame, column: Column) -> str:
    """Class of a column's cells: numbers, texts that stay on one line, texts that wrap."""
    if column.shown is not None or column.numeric:
        return "number"
    longest = table[column.name].astype(str).str.len().max()
    return "long" if longest > _LONGEST_LINE else "short"


class Picture(NamedTuple):
    """A drawn figure on the page."""

    spec: FigureSpec
    # Width on a wide screen [px], a little above the printed one so that text reads well
    width: int
    inline: Markup  # The drawing as part of the page: its text can be searched


def inline_svg(svg: str, name: str, alt: str) -> Markup:
    """Return a drawing of matplotlib as an element of a page that holds several.

    Identifiers that nothing refers to go, the others get the figure's name before them; the style
    sheet, which would change the whole page, becomes attributes.
    """
    start = re.search(r"<svg[^>]*>", svg)
    if start is None:
        raise ValueError(f"{name}: this is no SVG")
    inner = svg[start.end() : svg.rindex("</svg>")]
    for noise in (r"<metadata>.*?</metadata>", r"<style.*?</style>", r"<!--.*?-->"):
        inner = re.sub(noise, "", inner, flags=re.DOTALL)
    wanted = set(re.findall(r'(?:url\(#|href="#)([^")]+)', inner))

    def own(found: re.Match[str]) -> str:
        return f' id="{name}-{found[1]}"' if found[1] in wanted else ""

    inner = re.sub(r' id="([^"]*)"', own, inner)
    inner = re.sub(r'(url\(#|href="#)', rf"\g<1>{name}-", inner)
    inner = re.sub(r">\s+<", "><", inner)
    for colour, name in _SCHEME.items():
        inner = inner.replace(colour, f"var(--{name})")
    box = re.search(r'viewBox="([^"]*)"', start[0])
    # the drawing is matplotlib's, which has escaped every name in it
    return Markup(
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
        'viewBox="{}" role="img" aria-label="{}" stroke-linejoin="round">{}</svg>'
    ).format(box[1] if box else "", alt, Markup(inner.strip()))


TERMS: Mapping[str, Mapping[str, str]] = json.loads(
    resources.files("rockfrag.report").joinpath("terms.json").read_text("utf-8")
)
"""Meaning by term in each language; a term such as ``PGA, PGV`` is used where one of its parts is."""


def terms_used(text: str, language: str = FIRST) -> dict[str, str]:
    """Return the terms that the visible text of a page uses with their meanings, in alphabetical order."""
    terms = TERMS.get(language, {})

    def occurs(term: str) -> bool:
        """Whether it is there as a word of its own, abbreviations as they are written."""
        flags = re.NOFLAG if term.isupper() or len(term) < 3 else re.IGNORECASE
        return (
            re.search(rf"(?<![\w/&]){re.escape(term)}(?![\w/&])", text, flags)
            is not None
        )

    used = [name for name in terms if any(map(occurs, name.split(", ")))]
    return {name: terms[name] for name in sorted(used, key=str.lower)}


def draw_all(
    specs: Sequence[FigureSpec],
    folder: Path,
    processes: int = 1,
    endings: Sequence[str] = ("svg", "png"),
) -> dict[str, Picture]:
    """Draw figures into a folder and return them by name; whoever draws, the bytes are the same.

    Parameters
    ----------
    specs : the figures
    folder : of their files, which is made
    processes : that draw at once
    endings : of the files, ``svg`` among them
    """
    folder.mkdir(parents=True, exist_ok=True)

    def drawn(spec: FigureSpec) -> None:
        save_figure(spec.draw(), *(folder / f"{spec.name}.{end}" for end in endings))

    in_processes(drawn, specs, processes)
    found = {}
    for spec in specs:
        svg = (folder / f"{spec.name}.svg").read_text(encoding="utf-8")
        (points,) = re.findall(r'<svg[^>]* width="([0-9.]+)pt"', svg)
        width = round(float(points) * _PIXELS_PER_POINT)
        found[spec.name] = Picture(spec, width, inline_svg(svg, spec.name, spec.alt))
    return found


@dataclass(frozen=True)
class Page:
    """A page; the same contents give the same bytes."""

    title: str
    lead: str
    answer: Answer
    sections: Sequence[Section] = ()  # Chapters in order, which open on demand
    # What gives the same results again
    provenance: Mapping[str, str] = field(default_factory=dict)
    basis: str = "simulated"  # The page warns of what is not ``measured``
    live: Markup = _NOTHING  # See :func:`rockfrag.report.live.live_kernel`
    language: str = FIRST  # Of what stands on every page

    @property
    def figures(self) -> dict[str, tuple[FigureSpec, str]]:
        """Figures by name, each with the title of the chapter where it stands first."""
        parts: list[tuple[Any, str]] = [(self.answer.figure, "The answer")]
        parts += [
            (part, section.title) for section in self.sections for part in section.parts
        ]
        found: dict[str, tuple[FigureSpec, str]] = {}
        for part, title in parts:
            if isinstance(part, FigureSpec):
                found.setdefault(part.name, (part, title))
        return found

    @property
    def words(self) -> str:
        """All that the page says in words, its tables included."""
        answer = self.answer
        words = [sentence.said for sentence in answer.sentences]
        words += [*answer.advice, *answer.rests_on, *answer.could_change]
        for section in self.sections:
            words += [section.title, section.message, *section.paragraphs]
            for part in section.parts:
                words.append(
                    part.caption if isinstance(part, FigureSpec) else part.striptags()
                )
        return " ".join(words)

    def html(self, folder: Path | None = None, processes: int = 1) -> str:
        """Return the page, which loads nothing from outside; its figures are drawn into a folder, if any."""
        environment = TEMPLATES.overlay(
            trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True
        )
        style = ["style.css", "live.css"] if self.live else ["style.css"]
        with TemporaryDirectory(prefix="rockfrag.") as scratch:
            specs = [spec for spec, _ in self.figures.values()]
            # the page holds the lines alone
            endings = ("svg", "png") if folder else ("svg",)
            pictures = draw_all(specs, folder or Path(scratch), processes, endings)
        return environment.get_template("report.html.j2").render(
            vars(self),
            shell=catalogue(self.language).texts,
            pictures=pictures,
            glossary=terms_used(self.words, self.language),
            style=Markup(
                "".join(environment.get_template(name).render() for name in style)
            ),
            script=Markup(environment.get_template("page.js").render()),
        )


def scripts_of(*names: str) -> Markup:
    """Scripts of the package as text of a page.

    Parameters
    ----------
    names : files in ``templates/`` without ``.js``

    Returns
    -------
    The scripts, one after the other.
    """
    return Markup(
        "\n".join(TEMPLATES.get_template(f"{name}.js").render() for name in names)
    )


def base64_text(content: bytes) -> str:
    """Bytes as text of a page.

    Parameters
    ----------
    content : any bytes

    Returns
    -------
    Base 64.
    """
    return base64.b64encode(content).decode("ascii")


def zipped_text(content: bytes) -> str:
    """Compress bytes into text of a page.

    Parameters
    ----------
    content : any bytes

    Returns
    -------
    Base 64 of the compressed bytes (zlib).
    """
    return base64_text(zlib.compress(content, 9))


def json_text(data: Any) -> Markup:
    """Data as JSON in a script: a name in it may hold anything, but never the script's end.

    Parameters
    ----------
    data : what JSON can hold

    Returns
    -------
    The text, safe inside an element ``script``.
    """
    return Markup(json.dumps(data, separators=(",", ":")).replace("<", "\\u003c"))
