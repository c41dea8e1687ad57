"""Facts beside a curve in files for other programs, in sentences, and the choice of one estimator to compare.

In: rows of a fragility table (:func:`rockfrag.fragility.ida_curves.fragility_table`). Out: sentences on limits,
parts of β, goodness of fit and the record set; and the curves that may be compared (:class:`Compared`).

Theory: ``docs/fragility.md``, "The table and its exports" (β of motions, estimate and model add as squares).
"""

import math
from collections.abc import Hashable, Mapping, Set
from numbers import Real
from typing import Any, NamedTuple

import pandas as pd

from rockfrag.fragility.model_error import CUT, MODEL_ERRORS

REJECTED = 0.05  # a curve is said not to describe its data below this p value [-]
OF_THE_MODEL = MODEL_ERRORS[CUT]
"""Error of the model in curves of studies, whose bodies are cut blocks."""


def total_beta(beta: float, beta_statistical: float) -> float:
    """β of the motions with that of the median's estimate and of the model, added as squares [-].

    A statistical part that is not known (NaN) is left out.

    Parameters
    ----------
    beta, beta_statistical : of the motions, and of the estimate of the median [-]

    Returns
    -------
    The total β [-].
    """
    known = beta_statistical if math.isfinite(beta_statistical) else 0.0
    return math.sqrt(beta**2 + known**2 + OF_THE_MODEL.blind**2)


def curve_facts(row: Mapping[Hashable, Any]) -> str:
    """Facts that a row of a fragility table knows, in sentences.

    Parameters
    ----------
    row : columns of the fragility table by name; any of them may be absent. ``beta_holds_all`` says that β holds
        what is not known too

    Returns
    -------
    The sentences in a row, empty where nothing is known.
    """
    known = {
        name for name, x in row.items() if isinstance(x, Real) and math.isfinite(x)
    }
    facts = []
    if "n_motions" in known:
        earthquakes = ""
        if "n_earthquakes" in known:
            earthquakes = f" of {int(row['n_earthquakes'])} earthquakes"
        facts.append(f"{int(row['n_motions'])} motions{earthquakes}.")
    if "theta_lower" in known and "beta_lower" in known:
        facts.append(
            f"{100 * row['level']:g} % limits: theta {row['theta_lower']:.4g} to {row['theta_upper']:.4g}, "
            f"beta {_beta_limits(row)}."
        )
    elif "theta_lower" in row:
        facts.append("No confidence limits.")
    if "beta" in known and not row.get("beta_holds_all"):
        facts.append(_parts_of_beta(row))
    if "p_fit" in known:
        facts.append(f"Goodness of fit p = {row['p_fit']:.3f}.")
        if row["p_fit"] < REJECTED and "theta_isotonic" in known:
            curve = _nonparametric(row, known)
            facts.append(f"Use the nonparametric monotone curve instead: {curve}.")
    if row.get("influential"):
        facts.append(
            f"Without {row['influential']} theta is {row['influence']:.2f} times as large."
        )
    if row.get("record_set_sha256"):
        facts.append(f"Record set {row['record_set_sha256']}.")
    if row.get("warnings"):
        facts.append(str(row["warnings"]).strip())
    return " ".join(facts)


def _beta_limits(row: Mapping[Hashable, Any]) -> str:
    """Limits of β [-] in words, "at most …" where β itself is the upper one and the lower one is zero."""
    lower, upper = row["beta_lower"], row["beta_upper"]
    # tests in one common step allow any β up to the most that the step could hide (``intervals.step_limits``);
    # where β is that, or unknown, nothing but this bound is known of it
    if lower <= 0 and upper <= row.get("beta", math.inf):
        return f"at most {upper:.4g} (not resolved)"
    return f"{lower:.4g} to {upper:.4g}"


def _parts_of_beta(row: Mapping[Hashable, Any]) -> str:
    """Sentence on β of the motions, of the estimate and of the model, and all together."""
    statistical = float(row.get("beta_statistical", math.nan))
    estimated = f"{statistical:.3f}" if math.isfinite(statistical) else "not known"
    total = total_beta(row["beta"], statistical)
    return (
        f"Beta of the motions {row['beta']:.3f}, of the estimated median {estimated}, of the model "
        f"{OF_THE_MODEL.blind:.3f}; together {total:.3f}. That of the model is of a {CUT}: {OF_THE_MODEL.words}."
    )


def _nonparametric(row: Mapping[Hashable, Any], known: Set[Hashable]) -> str:
    """θ and β of the non-parametric curve with limits, in words."""
    parts = []
    for name in ("theta", "beta"):
        column = f"{name}_isotonic"
        if column in known:
            lower, upper = row[f"{column}_lower"], row[f"{column}_upper"]
            parts.append(f"{name} {row[column]:.4g} ({lower:.4g} to {upper:.4g})")
    return ", ".join(parts)


class Compared(NamedTuple):
    """Curves that may be compared."""

    # rows of the table with ``theta`` and ``beta``, and their limits, all by the same estimator;
    # theta is missing where that estimator gives none
    rows: pd.DataFrame
    # whether the estimator is the monotone curve without an assumed form
    nonparametric: bool
    rejected: list[str]  # configurations whose lognormal curve is rejected


def compared_curves(rows: pd.DataFrame, nonparametric: bool | None = None) -> Compared:
    """Choose one estimator for all curves of a comparison, which are of one measure and one definition.

    Lognormal curves are compared where none of them is rejected by its goodness of fit (p < 0.05). Where one is,
    all are replaced by nonparametric monotone curves: an estimator that is chosen body by body would show
    differences between bodies that are differences between estimators.

    Parameters
    ----------
    rows : rows of a fragility table
    nonparametric : estimator of a larger comparison of which the rows are a part; None lets the rows decide

    Returns
    -------
    The :class:`Compared`.
    """
    below = rows["p_fit"] < REJECTED
    rejected = list(dict.fromkeys(rows.loc[below, "configuration"]))
    if not (bool(rejected) if nonparametric is None else nonparametric):
        return Compared(rows, False, rejected)
    values = {
        f"{name}{end}": rows[f"{name}_isotonic{end}"]
        for name in ("theta", "beta")
        for end in ("", "_lower", "_upper")
        if f"{name}_isotonic{end}" in rows
    }
    return Compared(rows.assign(**values), True, rejected)
