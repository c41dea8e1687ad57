"""Tables of the documentation, written by the tests that compute them, each once it is complete."""

from pathlib import Path

import pandas as pd

from rockfrag.files import write_text
from rockfrag.lock import locked

DOCS = Path(__file__).resolve().parents[2] / "docs"


def markdown(table: pd.DataFrame, digits: int = 3) -> str:
    """The table as Markdown, numbers with so many digits and gaps for what is missing."""
    rows = [[str(name) for name in table.columns], ["---"] * len(table.columns)]
    rows += [
        ["" if pd.isna(v) else f"{v:.{digits}f}" if isinstance(v, float) else str(v) for v in row]
        for row in table.itertuples(index=False, name=None)
    ]
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def document(file: str, name: str, table: pd.DataFrame, digits: int = 3) -> None:
    """Put a table between the marks ``<!-- name -->`` and ``<!-- end of name -->`` of a document."""
    path = DOCS / file
    head, tail = f"<!-- {name} -->", f"<!-- end of {name} -->"
    # tests that run side by side write tables into the same document
    with locked(DOCS / f".{file}.lock", patience_s=60):
        before, _, rest = path.read_text(encoding="utf-8").partition(head)
        _, found, after = rest.partition(tail)
        assert found, f"{file} has no place for the table {name}"
        write_text(f"{before}{head}\n{markdown(table, digits)}\n{tail}{after}", path)
