"""Fragility of every configuration of an IDA curve in every intensity measure, as one tidy table."""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility.curve_facts import total_beta
from rockfrag.fragility.drawn_curves import curve_points, fraction_points, outcome_bins
from rockfrag.fragility.estimators import Fragility, fit_incremental, fragility_of
from rockfrag.fragility.ida_data import IdaData, TableIda
from rockfrag.fragility.observations import positive
from rockfrag.motions.declared import declared, measure_of
from rockfrag.records.motion import Motion


def scale_power(measure: str) -> int:
    """Power of the amplitude with which a measure grows: 1 for peaks, 2 for Arias, 0 for periods."""
    found = measure_of(measure)
    if found is None:
        known = ", ".join(dict.fromkeys(measure.name for measure in declared()))
        raise InputError(
            f"measure {measure!r}: it is not known how it grows with the amplitude of a scaled motion; choose "
            f"one of {known}, with a unit behind it."
        )
    return found.power


def with_measures(
    ida: pd.DataFrame, measures: pd.DataFrame, columns: Sequence[str]
) -> pd.DataFrame:
    """Add intensity measures of the scaled motions to the rows of an IDA curve, which have ``amplitude_g``.

    ``measures`` has one row per motion as recorded, with ``name`` and ``pga_g``; ``pga_g`` of the result is the
    amplitude itself.
    """
    if measures["name"].duplicated().any():
        twice = measures.loc[measures["name"].duplicated(), "name"].iloc[0]
        raise InputError(f"measures: motion {twice!r} has two rows; leave one out.")
    known = measures.set_index("name")
    missing = sorted(set(ida["motion"]) - set(known.index))
    if missing:
        raise InputError(f"measures: there is no row for motion {missing[0]!r}; add it.")
    rows = known.loc[ida["motion"]].reset_index()
    amplitude = positive(ida, "amplitude_g", "ida")
    factor = amplitude / positive(rows, "pga_g", "measures")
    added = {
        column: amplitude
        if column == "pga_g"
        else positive(rows, column, "measures") * factor ** scale_power(column)
        for column in columns
    }
    return ida.assign(**added)


def record_set_hash(motions: Iterable[Motion]) -> str:
    """SHA-256 of names, intervals and samples of a set of motions, whatever their order, in hexadecimal digits."""
    digest = hashlib.sha256()
    for motion in sorted(motions, key=lambda motion: motion.name):
        samples = np.ascontiguousarray(motion.acceleration, dtype="<f8")
        head = f"{motion.name}\x00{motion.dt!r}\x00{samples.size}\x00"
        digest.update(head.encode("utf-8"))
        digest.update(samples.tobytes())
    return digest.hexdigest()


def table_hash(table: pd.DataFrame) -> str:
    """SHA-256 of a table's text, for data that are no records; the order of the rows counts."""
    text = table.to_csv(index=False, lineterminator="\n")
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def fragility_row(
    fragility: Fragility, labels: Mapping[str, Any], estimator: str, record_set: str
) -> dict[str, Any]:
    """Return one row of the fragility table, see :func:`fragility_table`."""
    fit, interval, checks = fragility.fit, fragility.interval, fragility.checks
    fractions = checks.fractions
    return {
        **labels,
        "im": fit.im,
        "unit": fit.unit,
        "estimator": estimator,
        "theta": fit.theta,
        "theta_lower": interval.theta[0],
        "theta_upper": interval.theta[1],
        "beta": fit.beta,
        "beta_lower": interval.beta[0],
        "beta_upper": interval.beta[1],
        "level": interval.level,
        "interval_method": interval.method,
        "resampled": interval.over,
        "groups": interval.groups,
        "se_log_theta": fit.se_log_theta,
        "se_beta": fit.se_beta,
        "log_likelihood": fit.log_likelihood,
        "aic": fit.aic,
        "link": fit.link,
        "method": fit.method,
        "n": fit.n,
        "n_overturned": fit.n_overturned,
        "n_motions": fit.n_motions,
        "n_earthquakes": interval.groups if interval.over == "earthquake" else fit.n_motions,
        "p_fit": checks.p_fit,
        "fit_test": checks.test,
        "largest_residual": checks.largest_residual,
        "influential": checks.influential,
        "influence": checks.influence,
        "theta_isotonic": fractions.theta,
        "theta_isotonic_lower": fractions.theta_limits[0],
        "theta_isotonic_upper": fractions.theta_limits[1],
        "beta_isotonic": fractions.beta,
        "beta_isotonic_lower": fractions.beta_limits[0],
        "beta_isotonic_upper": fractions.beta_limits[1],
        "beta_statistical": fragility.beta_statistical,
        "beta_total": total_beta(fit.beta, fragility.beta_statistical),
        "record_set_sha256": record_set,
        "warnings": " ".join(fragility.warnings),
    }


@dataclass(frozen=True)
class FragilityTables:
    """Fragility of every configuration, as tables."""

    curves: pd.DataFrame  # see :func:`fragility_table`
    # bands, bins: what figures draw of the curves of mean probability, see
    # :mod:`rockfrag.fragility.drawn_curves`
    bands: pd.DataFrame
    bins: pd.DataFrame
    # points of the non-parametric fragility function of those that are rejected, see
    # :func:`rockfrag.fragility.drawn_curves.fraction_points`
    fractions: pd.DataFrame


def fragility_table(
    ida: pd.DataFrame,
    columns: Sequence[str] = ("amplitude_g",),
    *,
    by: Sequence[str] = ("configuration",),
    earthquake: str | None = "earthquake",
    record_set: str = "",
    level: float = 0.90,
) -> pd.DataFrame:
    """Fit every configuration of an IDA curve in every measure: the source of all exports.

    Parameters
    ----------
    ida
        One row per configuration, motion and amplitude, with ``motion``, ``amplitude_g``,
        ``overturned``, the columns ``by`` and ``earthquake``, and the measures
        (:func:`with_measures`).
    columns
        Columns of the intensity measures.
    by
        Columns that tell the curves apart.
    earthquake
        Column of the earthquake, whose resampling gives the limits; None resamples motions.
    record_set
        Hash of the motions (:func:`record_set_hash`).
    level
        Confidence level of the limits.

    Returns
    -------
    pandas.DataFrame
        One row per curve: the columns ``by``, ``im``, ``unit``, ``estimator``
        (``mean_probability`` for each measure; ``first_overturning`` and ``always_overturning``
        for the amplitude), ``theta``, ``beta`` with limits, ``level``, ``interval_method``,
        ``resampled``, ``groups``, standard errors, ``log_likelihood``, ``aic``, ``link``,
        ``method``, ``n``, ``n_overturned``, ``n_motions``, ``n_earthquakes``; ``p_fit``, ``fit_test``,
        ``largest_residual``, ``influential``, ``influence`` (see
        :class:`rockfrag.fragility.checks.Checks`); ``theta_isotonic``, ``beta_isotonic`` with limits (see
        :class:`rockfrag.fragility.fractions.Fractions`); ``beta_statistical`` and ``beta_total`` (with the
        model's uncertainty, :mod:`rockfrag.fragility.curve_facts`); ``record_set_sha256``, ``warnings``.
    """
    for column in by:
        if column not in ida:
            raise InputError(f"IDA curve: there is no column {column!r}; correct the name.")
    parts = (
        (dict(zip(by, key, strict=True)), TableIda(part, earthquake))
        for key, part in ida.groupby(list(by), sort=True)
    )
    return tables_of_ida_curves(
        parts, columns, earthquake=earthquake, record_set=record_set, level=level
    ).curves


def tables_of_ida_curves(
    ida_curves: Iterable[tuple[Mapping[str, Any], IdaData]],
    columns: Sequence[str],
    *,
    earthquake: str | None = "earthquake",
    record_set: str = "",
    level: float = 0.90,
) -> FragilityTables:
    """Fit as :func:`fragility_table` does, to labelled IDA curves in any form, and keep what figures draw too."""
    rows: list[dict[str, Any]] = []
    bands, bins, fractions = [], [], []
    for labels, ida in ida_curves:
        for column in columns:
            outcomes = ida.outcomes(column)
            if column in ("amplitude_g", "pga_g"):
                result = fit_incremental(ida, amplitude=column, earthquake=earthquake, level=level)
                definitions = {
                    "mean_probability": result.probability,
                    "first_overturning": result.first,
                    "always_overturning": result.always,
                }
            else:
                definitions = {"mean_probability": fragility_of(outcomes, level=level)}
            bands.append(curve_points(labels, definitions["mean_probability"], outcomes))
            bins.append(outcome_bins(labels, definitions["mean_probability"], outcomes))
            for name, fragility in definitions.items():
                rows.append(fragility_row(fragility, labels, name, record_set))
                fractions.append(fraction_points({**labels, "estimator": name}, fragility))
    return FragilityTables(
        pd.DataFrame(rows),
        pd.concat(bands, ignore_index=True),
        pd.concat(bins, ignore_index=True),
        pd.concat(fractions, ignore_index=True),
    )
