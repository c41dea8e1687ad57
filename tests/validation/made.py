"""What several validations draw, and the tables of the documentation that they write once these are complete."""

import math
from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.base.files import write_text
from rockfrag.runtime.lock import locked


def drawn(rng, law, size):
    """Values of mean zero and unit variance: ``normal``, ``t3`` or ``exponential``."""
    if law == "t3":
        return rng.standard_t(3, size=size) / math.sqrt(3)
    return (
        rng.exponential(size=size) - 1
        if law == "exponential"
        else rng.normal(size=size)
    )


def pairs_of(d, **more):
    """Log ratios of one data set, shape (earthquakes, floors, objects), as a table of pairs."""
    names = (
        [f"{letter}{k}" for k in np.indices(d.shape)[at].ravel()]
        for at, letter in enumerate("EFT")
    )
    table = pd.DataFrame(
        dict(zip(("earthquake", "floor", "object"), names, strict=True))
    )
    return table.assign(
        motion=table["earthquake"] + table["floor"], d=d.ravel(), **more
    )


DOCS = Path(__file__).resolve().parents[2] / "docs"


def markdown(table: pd.DataFrame, digits: int = 3) -> str:
    """The table as Markdown, numbers with so many digits and gaps for what is missing."""
    rows = [[str(name) for name in table.columns], ["---"] * len(table.columns)]
    rows += [
        [
            "" if pd.isna(v) else f"{v:.{digits}f}" if isinstance(v, float) else str(v)
            for v in row
        ]
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
