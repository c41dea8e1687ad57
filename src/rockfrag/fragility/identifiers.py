"""Curves and names of configurations as other programs take them, names kept distinct."""

import hashlib
import math
from collections import Counter
from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility.observations import Floats
from rockfrag.outcomes.limit_states import OVERTURNS, limit_state_named, limit_states

LONGEST = 75  # characters of an identifier that OpenQuake takes
STEP = 0.01  # β with which an exact threshold, a step, is written [-]; the formats take no step


def identifiers(names: Iterable[str], others: str = "") -> dict[str, str]:
    """Return an identifier for each name: ASCII letters, digits and ``others``; all else becomes ``_``.

    Where two would be equal, or one would be too long, a digest of the name follows.
    """
    plain = {
        name: "".join(c if c.isascii() and (c.isalnum() or c in others) else "_" for c in name)
        for name in dict.fromkeys(names)
    }
    count = Counter(plain.values())
    for name, text in plain.items():
        if count[text] > 1 or len(text) > LONGEST:
            digest = hashlib.sha256(name.encode()).hexdigest()[:8]
            plain[name] = f"{text[: LONGEST - 9]}_{digest}"
    return plain


@dataclass(frozen=True)
class StateCurve:
    """Curve of one limit state."""

    row: Mapping[Hashable, Any]  # its row of the fragility table
    theta: float
    beta: float  # that of a step is ``STEP``
    # points of the non-parametric fragility function; empty where the lognormal one stands
    levels: Floats
    fraction: Floats


def curves_by_name(
    export: str,
    table: pd.DataFrame,
    by: str,
    others: str,
    fractions: pd.DataFrame | None,
    prefix: str = "",
) -> dict[str, dict[str, StateCurve]]:
    """Return the curves of a fragility table by the identifier of ``by`` and by limit state, the milder first."""
    if table.empty:
        raise InputError(f"{export}: there is no curve to write; give at least one row.")
    known = identifiers(map(str, table[by]), others)
    curves: dict[str, dict[str, StateCurve]] = {}
    for row in table.to_dict("records"):
        name = prefix + known[str(row[by])]
        states = curves.setdefault(name, {})
        state = limit_state_named(str(row.get("state", OVERTURNS))).name
        if state in states:
            raise InputError(
                f"{export}: {name!r} has two curves; choose one estimator and one measure for each."
            )
        theta, beta = float(str(row["theta"])), float(str(row["beta"]))
        if row.get("link", "probit") != "probit" or not (theta > 0 and 0 < beta < math.inf):
            raise InputError(
                f"{export}: {str(row[by])!r} has no lognormal curve; leave the row out."
            )
        points = np.empty((0, 2))
        if fractions is not None:
            own = (fractions[by].astype(str) == str(row[by])) & (fractions["state"] == state)
            points = fractions.loc[own, ["x", "fraction"]].to_numpy(dtype=np.float64)
        states[state] = StateCurve(row, theta, max(beta, STEP), points[:, 0], points[:, 1])
    order = [state.name for state in limit_states()]
    return {
        name: {state: states[state] for state in order if state in states}
        for name, states in curves.items()
    }
