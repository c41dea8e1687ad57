"""What a file with a curve must say about it, so that nobody uses it for more than it is."""

import math
from collections.abc import Hashable, Mapping
from typing import Any

from rockfrag.fragility.model_error import CUT, MODEL_ERRORS
from rockfrag.sentences import sayer

REJECTED = 0.05  # a curve is said not to describe its data below this p value [-]
OF_THE_MODEL = MODEL_ERRORS[CUT]
"""Error of the model in curves of studies, whose bodies are cut blocks."""


def total_beta(beta: float, beta_statistical: float) -> float:
    """β of the motions with that of the median's estimate and of the model, added as squares [-].

    A statistical part that is not known (NaN) is left out.
    """
    known = beta_statistical if math.isfinite(beta_statistical) else 0.0
    return math.sqrt(beta**2 + known**2 + OF_THE_MODEL.blind**2)


_say = sayer(
    "rockfrag.fragility",
    "curve_facts.j2",
    {"REJECTED": REJECTED, "OF_THE_MODEL": OF_THE_MODEL, "CUT": CUT, "total_beta": total_beta}
    | {"INFINITE": math.inf, "NAN": math.nan},
)

NUMBERS = (
    *("n_motions", "n_earthquakes", "theta_lower", "beta_lower", "beta", "p_fit"),
    "theta_isotonic",
)


def curve_facts(row: Mapping[Hashable, Any]) -> str:
    """Say of a row of a fragility table what it rests on, in sentences; empty where nothing is known."""
    values = {name: row.get(name) for name in NUMBERS}
    known = {name for name, x in values.items() if x is not None and math.isfinite(float(x))}
    return " ".join(_say("facts", row, known, float(row.get("beta_statistical", math.nan))))
