"""Curves and names of configurations as other programs take them, names kept distinct."""

import hashlib
import math
from collections import Counter
from collections.abc import Hashable, Iterable, Mapping
from typing import Any

import pandas as pd

from rockfrag.errors import InputError
from rockfrag.outcomes.limit_states import OVERTURNS, limit_state_named, limit_states

Row = Mapping[Hashable, Any]

LONGEST = 75  # characters of an identifier that OpenQuake takes


def identifiers(names: Iterable[str], others: str = "") -> dict[str, str]:
    """Return an identifier for each name: ASCII letters, digits and ``others``; all else becomes ``_``.

    Where two would be equal, or one would be too long, a digest of the name follows.
    """
    plain = {
        name: "".join(c if c.isascii() and (c.isalnum() or c in others) else "_" for c in name)
        for name in dict.fromkeys(names)
    }
    count = Counter(plain.values())
    return {
        name: text if count[text] == 1 and len(text) <= LONGEST else _with_digest(text, name)
        for name, text in plain.items()
    }


def curves_by_name(
    export: str, table: pd.DataFrame, by: str, others: str, prefix: str = ""
) -> dict[str, dict[str, Row]]:
    """Return the rows of a fragility table by the identifier of ``by`` and by limit state, the milder first."""
    if table.empty:
        raise InputError(f"{export}: there is no curve to write; give at least one row.")
    known = identifiers(map(str, table[by]), others)
    rows: dict[str, dict[str, Row]] = {}
    for row in table.to_dict("records"):
        name = prefix + known[str(row[by])]
        states = rows.setdefault(name, {})
        state = limit_state_named(str(row.get("state", OVERTURNS))).name
        if state in states:
            raise InputError(
                f"{export}: {name!r} has two curves; choose one estimator and one measure for each."
            )
        states[state] = row
    order = [state.name for state in limit_states()]
    return {
        name: {state: states[state] for state in order if state in states}
        for name, states in rows.items()
    }


def lognormal_of(export: str, row: Row, by: str) -> tuple[float, float]:
    """Return median and β of the lognormal curve of a row."""
    theta, beta = float(str(row["theta"])), float(str(row["beta"]))
    if row.get("link", "probit") != "probit" or not (theta > 0 and 0 < beta < math.inf):
        raise InputError(f"{export}: {str(row[by])!r} has no lognormal curve; leave the row out.")
    return theta, beta


def _with_digest(text: str, name: str) -> str:
    digest = hashlib.sha256(name.encode()).hexdigest()[:8]
    return f"{text[: LONGEST - 9]}_{digest}"
