"""The report: one HTML page that loads nothing from outside."""

import base64
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
from markupsafe import Markup

from rockfrag.report.findings import Finding

_PIXELS_PER_POINT = 96 / 72 * 1.22
_LONGEST_LINE = 24
_COLUMN = round(252 * _PIXELS_PER_POINT)


@dataclass(frozen=True)
class Column:
    """A column of a table on the page.

    Attributes
    ----------
    name
        Column of the data.
    title
        What its head says, with the unit.
    digits
        Decimals of numbers, or None for text.
    """

    name: str
    title: str
    digits: int | None = None


@dataclass(frozen=True)
class Picture:
    """A figure on the page: a path to an SVG, and its caption."""

    path: Path
    caption: str

    @property
    def width(self) -> int:
        """Width on a wide screen [px], a little above the printed one so that text reads well."""
        found = re.search(rb'<svg[^>]* width="([0-9.]+)pt"', self.path.read_bytes())
        return round(float(found[1]) * _PIXELS_PER_POINT) if found else _COLUMN

    @property
    def wide(self) -> bool:
        """Whether it needs more than a column, so that it scrolls on a narrow screen."""
        return self.width > 1.5 * _COLUMN

    @property
    def source(self) -> Markup:
        """The SVG as a data address, so that figures share no identifiers and load nothing."""
        data = base64.b64encode(self.path.read_bytes()).decode("ascii")
        return Markup("data:image/svg+xml;base64,") + data


def cell(value: Any, digits: int | None) -> str:
    """Format one cell: numbers to their digits, truth as yes or no, and a dash for what is missing."""
    if value is None or value is pd.NA or (isinstance(value, float) and math.isnan(value)):
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if digits is not None and not isinstance(value, str):
        return f"{value:.{digits}f}".replace("-", "−")
    return str(value) if str(value) else "–"


def _kind(values: pd.Series, column: Column) -> str:
    """Class of a column's cells: numbers, texts that stay on one line, texts that wrap."""
    if column.digits is not None:
        return "number"
    return "long" if values.astype(str).str.len().max() > _LONGEST_LINE else "short"


def table_html(table: pd.DataFrame, columns: Sequence[Column], caption: str) -> Markup:
    """Render a table that scrolls inside its own frame where the screen is narrow."""
    head = Markup("").join(
        Markup('<th class="{}">{}</th>').format("" if c.digits is None else "number", c.title)
        for c in columns
    )
    kinds = {c.name: _kind(table[c.name], c) for c in columns}
    rows = Markup("").join(
        Markup("<tr>{}</tr>").format(
            Markup("").join(
                Markup('<td class="{}">{}</td>').format(kinds[c.name], cell(row[c.name], c.digits))
                for c in columns
            )
        )
        for row in table.to_dict("records")
    )
    return _framed(caption, head, rows)


def comparison_html(comparison: pd.DataFrame, caption: str) -> Markup:
    """Render computed values with the printed ones below them, a row per name.

    Parameters
    ----------
    comparison
        See :func:`rockfrag.thesis.printed_tables.compare`.
    caption
        What the table shows.
    """
    # a lone block has no pattern 3: the order of the columns is that of the fullest row
    fullest = max((part for _, part in comparison.groupby("name")), key=len)
    quantities = fullest[["quantity", "unit"]].to_numpy().tolist()
    rows: dict[tuple[str, str], Any] = {
        (r["name"], r["quantity"]): r for r in comparison.to_dict("records")
    }
    head = Markup("<th>Name</th>") + Markup("").join(
        Markup('<th class="number">{}{}</th>').format(name, "" if unit == "-" else f" [{unit}]")
        for name, unit in quantities
    )
    body = Markup("").join(
        Markup("<tr><td>{}</td>{}</tr>").format(
            name,
            Markup("").join(_compared(rows.get((name, quantity))) for quantity, _ in quantities),
        )
        for name in dict.fromkeys(comparison["name"])
    )
    printed = comparison["printed"].ne("").any()
    note = " Below each value the printed one; ✓ where they agree to its digits." if printed else ""
    return _framed(caption + note, head, body)


def _compared(row: Mapping[str, Any] | None) -> Markup:
    if row is None:
        return Markup('<td class="number">–</td>')
    printed = Markup("")
    if row["printed"]:
        sign = "✓" if row["agrees"] else "≠"
        printed = Markup("<br><small>{} {}</small>").format(row["printed"], sign)
    return Markup('<td class="number">{}{}</td>').format(cell(row["computed"], 4), printed)


def _framed(caption: str, head: Markup, rows: Markup) -> Markup:
    return Markup(
        '<figure class="table"><figcaption>{}</figcaption><div class="scroll" tabindex="0"><table>'
        "<thead><tr>{}</tr></thead><tbody>{}</tbody></table></div></figure>"
    ).format(caption, head, rows)


@dataclass(frozen=True)
class Section:
    """A part of the page: paragraphs, then tables and figures in order."""

    anchor: str
    title: str
    paragraphs: Sequence[str] = ()
    parts: Sequence[Markup | Picture] = ()

    @property
    def blocks(self) -> list[tuple[str, Any]]:
        """Parts with neighbouring pictures in one row."""
        blocks: list[tuple[str, Any]] = []
        for part in self.parts:
            if isinstance(part, Markup):
                blocks.append(("html", part))
            elif blocks and blocks[-1][0] == "pictures":
                blocks[-1][1].append(part)
            else:
                blocks.append(("pictures", [part]))
        return blocks


def render(
    title: str,
    lead: str,
    findings: Sequence[Finding],
    sections: Sequence[Section],
    provenance: Mapping[str, str],
    basis: str = "simulated",
) -> str:
    """Return the page as HTML; the same arguments give the same bytes.

    ``basis`` says whether its figures are ``simulated`` or ``measured``; the page warns of the first.
    """
    environment = Environment(
        loader=PackageLoader("rockfrag.report"),
        autoescape=select_autoescape(default=True),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    style = environment.get_template("style.css").render()
    return environment.get_template("report.html.j2").render(
        title=title,
        lead=lead,
        findings=findings,
        sections=sections,
        provenance=provenance,
        basis=basis,
        style=Markup(style),
    )
