"""What a file with a curve must say about it, so that nobody uses it for more than it is."""

import math
from collections.abc import Hashable, Mapping
from typing import Any

from rockfrag.fragility.model_error import CUT, MODEL_ERRORS

REJECTED = 0.05  # a curve is said not to describe its data below this p value [-]
OF_THE_MODEL = MODEL_ERRORS[CUT]
"""Error of the model in curves of studies, whose bodies are cut blocks."""


def total_beta(beta: float, beta_statistical: float) -> float:
    """β of the motions with that of the median's estimate and of the model, added as squares [-].

    A statistical part that is not known (NaN) is left out.
    """
    known = beta_statistical if math.isfinite(beta_statistical) else 0.0
    return math.sqrt(beta**2 + known**2 + OF_THE_MODEL.blind**2)


def curve_facts(row: Mapping[Hashable, Any]) -> str:
    """Say of a row of a fragility table what it rests on, in sentences; empty where nothing is known."""
    parts = []
    if _known(row, "n_motions"):
        earthquakes = (
            f" of {int(row['n_earthquakes'])} earthquakes" if _known(row, "n_earthquakes") else ""
        )
        parts.append(f"{int(row['n_motions'])} motions{earthquakes}.")
    if _known(row, "theta_lower") and _known(row, "beta_lower"):
        parts.append(
            f"{100 * float(row['level']):g} % limits: theta {row['theta_lower']:.4g} to "
            f"{row['theta_upper']:.4g}, beta {_beta_limits(row)}."
        )
    elif "theta_lower" in row:
        parts.append("No confidence limits.")
    if _known(row, "beta"):
        statistical = float(row.get("beta_statistical", math.nan))
        median = f"{statistical:.3f}" if math.isfinite(statistical) else "not known"
        parts.append(
            f"Beta of the motions {float(row['beta']):.3f}, of the estimated median {median}, of the model "
            f"{OF_THE_MODEL.blind:.3f}; together {total_beta(float(row['beta']), statistical):.3f}. "
            f"That of the model is of a {CUT}: {OF_THE_MODEL.words}."
        )
    if _known(row, "p_fit"):
        parts.append(f"Goodness of fit p = {float(row['p_fit']):.3f}.")
        if float(row["p_fit"]) < REJECTED and _known(row, "theta_isotonic"):
            parts.append(_nonparametric(row))
    if row.get("influential"):
        parts.append(
            f"Without {row['influential']} theta is {float(row['influence']):.2f} times as large."
        )
    if row.get("record_set_sha256"):
        parts.append(f"Record set {row['record_set_sha256']}.")
    if row.get("warnings"):
        parts.append(str(row["warnings"]))
    return " ".join(parts)


def _beta_limits(row: Mapping[Hashable, Any]) -> str:
    """Limits of β, or that the estimate is one: that of tests which a single threshold separates."""
    if row["beta_lower"] <= 0 and row["beta_upper"] <= row.get("beta", math.inf):
        return f"at most {row['beta_upper']:.4g} (not resolved)"
    return f"{row['beta_lower']:.4g} to {row['beta_upper']:.4g}"


def _known(row: Mapping[Hashable, Any], name: str) -> bool:
    value = row.get(name)
    return value is not None and math.isfinite(float(value))


def _nonparametric(row: Mapping[Hashable, Any]) -> str:
    """Median and dispersion of the curve that stands in the place of a rejected one."""
    words = []
    for name in ("theta", "beta"):
        value, low, high = (
            float(row.get(f"{name}_isotonic{end}", math.nan)) for end in ("", "_lower", "_upper")
        )
        if math.isfinite(value):
            words.append(f"{name} {value:.4g} ({low:.4g} to {high:.4g})")
    return f"Use the nonparametric monotone curve instead: {', '.join(words)}."
