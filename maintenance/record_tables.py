"""Write into docs/formats.md what text is read how, from the readers' own tables.

.venv/bin/python maintenance/record_tables.py
"""

import sys
from pathlib import Path

from rockfrag.records.parsing.quantities import read_unit
from rockfrag.records.parsing.vocabulary import languages

PAGE = Path(__file__).resolve().parents[1] / "docs" / "formats.md"
BEGIN, END = (
    "<!-- begin of what is read how -->\n",
    "<!-- end of what is read how -->\n",
)
WRITINGS = (
    *("g", "g's", "gn", "milli_g", "mg", "µg", "%g", "g/10", "10-3 g", "10⁻³ g"),
    *("0.001 g", "m/s²", "m/s/s", "m·s⁻²", "m_s2", "ms2", "mps2", "м/с²", "cm/sec2"),
    *("CM/SEC/SEC", "cms2", "cm/seg2", "gal", "mGal", "µGal", "mm/s^2", "µm/s²"),
    *("ft/s²", "in/s2", "g x1000", "m/s2 x 100", "1000*g", "x9.81 m/s2", "yd/s2"),
    *("furlong/s2", "counts", "kN", "cm/s", "mm"),
)
"""Writings of units that the table shows."""


def table() -> str:
    """Return the table, as it stands on the page between its marks."""
    lines = ["| written | read as | m/s² |", "|---|---|---|"]
    for words in WRITINGS:
        unit = read_unit(words)
        if unit.factor:
            row = "refused: the factor may be meant either way", "—"
        elif unit.quantity == "acceleration":
            row = unit.name, f"{unit.to_si:.6g}"
        else:
            known = f"{unit.quantity}: left out, refused alone"
            row = known if unit.quantity else "refused: not known", "—"
        lines.append(f"| `{words}` | {row[0]} | {row[1]} |")
    concepts = ("time", "acceleration", "vertical", "interval", "rate", "count", "unit")
    lines += ["", "| language | " + " | ".join(concepts) + " |"]
    lines.append("|---" * (len(concepts) + 1) + "|")
    for language, words in languages().items():
        cells = (", ".join(words.get(concept, ())[:3]) for concept in concepts)
        lines.append(f"| {language} | " + " | ".join(cells) + " |")
    return "\n".join(lines).replace("*", "…").replace("1000…g", "1000*g") + "\n"


def page_with_table(page: str) -> str:
    """Return the page with the table of today."""
    before, _, rest = page.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{table()}\n{END}{after}"


def main() -> int:
    """Write the page."""
    text = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(page_with_table(text), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
