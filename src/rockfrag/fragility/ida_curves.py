"""Fragility of every configuration in every intensity measure, as one tidy table: the source of all exports.

In: incremental dynamic analyses (IDA), a row per configuration, motion and amplitude [g], with the measures of the
motions. Out: :func:`fragility_table`, a row a curve with θ in the unit of its measure, β [-] and limits; and what
figures draw (:class:`FragilityTables`). Theory: ``docs/fragility.md``, "The table and its exports".
"""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.fragility.curve_facts import total_beta
from rockfrag.fragility.empirical import TableIda, fraction_in_bins, local_fraction
from rockfrag.fragility.estimators import Fragility, fit_incremental, fragility_of
from rockfrag.fragility.fractions import knots_of
from rockfrag.fragility.observations import Floats, Observations, positive
from rockfrag.motions.intensity import declared, measure_of
from rockfrag.records.motion import Motion


def scale_power(measure: str) -> int:
    """Power of the amplitude with which a measure grows: 1 for peaks, 2 for Arias, 0 for periods.

    Parameters
    ----------
    measure : column of the measure, such as ``pga_g``

    Returns
    -------
    The power.
    """
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

    Parameters
    ----------
    ida : a row per motion and amplitude, with ``motion`` and ``amplitude_g`` [g]
    measures, columns : a row per motion as recorded, with ``name`` and ``pga_g``, and the columns to add

    Returns
    -------
    The rows with the measures; ``pga_g`` is the amplitude itself.
    """
    if measures["name"].duplicated().any():
        twice = measures.loc[measures["name"].duplicated(), "name"].iloc[0]
        raise InputError(f"measures: motion {twice!r} has two rows; leave one out.")
    known = measures.set_index("name")
    missing = sorted(set(ida["motion"]) - set(known.index))
    if missing:
        raise InputError(
            f"measures: there is no row for motion {missing[0]!r}; add it."
        )
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
    """SHA-256 of names, intervals and samples of a set of motions, whatever their order.

    Parameters
    ----------
    motions : the set

    Returns
    -------
    The digest, 64 hexadecimal digits.
    """
    digest = hashlib.sha256()
    for motion in sorted(motions, key=lambda motion: motion.name):
        samples = np.ascontiguousarray(motion.acceleration, dtype="<f8")
        head = f"{motion.name}\x00{motion.dt!r}\x00{samples.size}\x00"
        digest.update(head.encode("utf-8"))
        digest.update(samples.tobytes())
    return digest.hexdigest()


def table_hash(table: pd.DataFrame) -> str:
    """SHA-256 of a table's text, for data that are no records; the order of the rows counts.

    Parameters
    ----------
    table : any table

    Returns
    -------
    The digest, 64 hexadecimal digits.
    """
    text = table.to_csv(index=False, lineterminator="\n")
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def fragility_row(
    fragility: Fragility, labels: Mapping[str, Any], estimator: str, record_set: str
) -> dict[str, Any]:
    """Row of the fragility table, see :func:`fragility_table`.

    Parameters
    ----------
    fragility, labels : the curve, and the columns by which it differs from others
    estimator, record_set : definition of the curve, and digest of its motions

    Returns
    -------
    The values by column.
    """
    fit, interval, checks = fragility.fit, fragility.interval, fragility.checks
    fractions = checks.fractions
    of_fit = ("se_log_theta", "se_beta", "log_likelihood", "aic", "link", "method")
    counted = ("n", "n_overturned", "n_motions")
    of_checks = ("largest_residual", "influential", "influence")
    return {
        **labels,
        "im": fit.im,
        "unit": fit.unit,
        "estimator": estimator,
        **_limited("theta", fit.theta, interval.theta),
        **_limited("beta", fit.beta, interval.beta),
        "level": interval.level,
        "interval_method": interval.method,
        "resampled": interval.over,
        "groups": interval.groups,
        **{name: getattr(fit, name) for name in (*of_fit, *counted)},
        "n_earthquakes": interval.groups
        if interval.over == "earthquake"
        else fit.n_motions,
        "p_fit": checks.p_fit,
        "fit_test": checks.test,
        **{name: getattr(checks, name) for name in of_checks},
        **_limited("theta_isotonic", fractions.theta, fractions.theta_limits),
        **_limited("beta_isotonic", fractions.beta, fractions.beta_limits),
        "beta_statistical": fragility.beta_statistical,
        "beta_total": total_beta(fit.beta, fragility.beta_statistical),
        "record_set_sha256": record_set,
        "warnings": " ".join(fragility.warnings),
    }


def _limited(name: str, value: float, limits: tuple[float, float]) -> dict[str, float]:
    """Value and limits of a quantity as columns ``name``, ``name_lower`` and ``name_upper``."""
    return {name: value, f"{name}_lower": limits[0], f"{name}_upper": limits[1]}


@dataclass(frozen=True)
class FragilityTables:
    """Fragility of every configuration, as tables."""

    curves: pd.DataFrame  # see :func:`fragility_table`
    # bands, bins: what figures draw of the curves of mean probability
    bands: pd.DataFrame
    bins: pd.DataFrame
    fractions: pd.DataFrame  # see :func:`fraction_points`


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
        One row per configuration, motion and amplitude, with ``motion``, ``amplitude_g``, ``overturned``, the
        columns ``by`` and ``earthquake``, and the measures (:func:`with_measures`).
    columns, by, earthquake
        Columns of the measures, of what tells the curves apart, and of the earthquake, whose resampling gives the
        limits; None resamples motions.
    record_set, level : hash of the motions (:func:`record_set_hash`), and confidence level of the limits

    Returns
    -------
    pandas.DataFrame
        One row per curve: the columns ``by``, ``im``, ``unit``, ``estimator`` (``mean_probability`` for each
        measure; ``first_overturning`` and ``always_overturning`` for the amplitude), ``theta``, ``beta`` with
        limits, ``level``, ``interval_method``, ``resampled``, ``groups``; fields of
        :class:`rockfrag.fragility.lognormal.FragilityFit`, of :class:`rockfrag.fragility.checks.Checks` and of
        :class:`rockfrag.fragility.fractions.Fractions` (``theta_isotonic``, ``beta_isotonic``);
        ``beta_statistical``, ``beta_total`` (with the model's), ``record_set_sha256``, ``warnings``.
    """
    for column in by:
        if column not in ida:
            raise InputError(
                f"IDA curve: there is no column {column!r}; correct the name."
            )
    parts = (
        (dict(zip(by, key, strict=True)), TableIda(part, earthquake))
        for key, part in ida.groupby(list(by), sort=True)
    )
    return tables_of_ida_curves(
        parts, columns, record_set=record_set, level=level
    ).curves


def tables_of_ida_curves(
    ida_curves: Iterable[tuple[Mapping[str, Any], TableIda]],
    columns: Sequence[str],
    *,
    record_set: str = "",
    level: float = 0.90,
) -> FragilityTables:
    """Fit as :func:`fragility_table` does, to labelled IDA curves in any form, and keep what figures draw too.

    Parameters
    ----------
    ida_curves, columns : labels and IDA curves of each configuration, and the columns of the measures
    record_set, level : as of :func:`fragility_table`

    Returns
    -------
    The :class:`FragilityTables`.
    """
    rows: list[dict[str, Any]] = []
    bands, bins, fractions = [], [], []
    for labels, ida in ida_curves:
        for column in columns:
            outcomes = ida.outcomes(column)
            if column in ("amplitude_g", "pga_g"):
                result = fit_incremental(ida, amplitude=column, level=level)
                definitions = {
                    "mean_probability": result.probability,
                    "first_overturning": result.first,
                    "always_overturning": result.always,
                }
            else:
                definitions = {"mean_probability": fragility_of(outcomes, level=level)}
            bands.append(
                curve_points(labels, definitions["mean_probability"], outcomes)
            )
            bins.append(outcome_bins(labels, definitions["mean_probability"], outcomes))
            for name, fragility in definitions.items():
                rows.append(fragility_row(fragility, labels, name, record_set))
                fractions.append(
                    fraction_points({**labels, "estimator": name}, fragility)
                )
    return FragilityTables(
        curves=pd.DataFrame(rows),
        bands=pd.concat(bands, ignore_index=True),
        bins=pd.concat(bins, ignore_index=True),
        fractions=pd.concat(fractions, ignore_index=True),
    )


POINTS = 120  # points of a curve, in equal ratios
_TAIL = 2.6
"""Standard deviations on either side of the median within which a curve is drawn: 0.5 to 99.5 %."""


def levels_drawn(curve: Fragility, outcomes: Observations, points: int) -> Floats:
    """Levels of a measure in equal ratios from where a curve leaves zero to where it reaches one.

    Parameters
    ----------
    curve, outcomes : the curve, and the tests that it was fitted to
    points : number of levels

    Returns
    -------
    The levels in the unit of the measure, shape (points,).
    """
    fit = curve.fit
    lowest, highest = 0.8 * float(outcomes.im.min()), 1.25 * float(outcomes.im.max())
    low, high = lowest, highest
    if np.isfinite(fit.theta):
        # a nearly flat curve may not stretch the range, nor amplitudes far above it
        low = max(low, fit.theta * np.exp(-_TAIL * fit.beta))
        high = min(high, fit.theta * np.exp(_TAIL * fit.beta))
    if low >= high:
        low, high = lowest, highest
    return np.asarray(np.geomspace(low, high, points))


def curve_points(
    labels: Mapping[str, Any], curve: Fragility, outcomes: Observations
) -> pd.DataFrame:
    """Points of one curve over the range of its data: ``x``, ``probability``, its limits, and what needs no curve.

    ``local`` is the fraction of overturned tests near x, which may fall where the curve cannot (missing where all
    tests are at one value), ``fraction`` with its limits the non-parametric fragility function. Without a curve
    ``probability`` is missing.

    Parameters
    ----------
    labels : columns by which the curve differs from others
    curve, outcomes : the curve, and the tests that it was fitted to

    Returns
    -------
    pandas.DataFrame, ``POINTS`` rows, ``x`` in the unit of the measure and the others [-].
    """
    fit, x = curve.fit, levels_drawn(curve, outcomes, POINTS)
    nothing = np.full(POINTS, np.nan)
    probability, lower, upper = nothing, nothing, nothing
    if np.isfinite(fit.theta):
        probability = fit.probability(x)
        lower, upper = curve.interval.band(x)
    inside = (
        (x >= outcomes.im.min())
        & (x <= outcomes.im.max())
        & (np.ptp(outcomes.log_im) > 0)
    )
    local = nothing.copy()
    if inside.any():
        local[inside] = local_fraction(outcomes, x[inside])
    names = ("fraction", "fraction_lower", "fraction_upper")
    fractions = dict(zip(names, curve.checks.fractions.at(x), strict=True))
    points = _about(labels, curve, POINTS).assign(x=x, probability=probability)
    return points.assign(lower=lower, upper=upper, local=local, **fractions)


def fraction_points(labels: Mapping[str, Any], curve: Fragility) -> pd.DataFrame:
    """Points of the non-parametric fragility function, if the fitted one is rejected; no row otherwise.

    ``fraction`` of overturned tests never falls, and is straight over ln ``x`` between the points.

    Parameters
    ----------
    labels, curve : columns by which the curve differs from others, and the curve

    Returns
    -------
    pandas.DataFrame: the labels, ``im``, ``unit``, ``x`` in that unit, ``fraction``, ``lower``, ``upper`` [-].
    """
    fractions = curve.checks.fractions
    x = (
        knots_of(fractions.im, fractions.fraction)[0]
        if curve.checks.rejected
        else np.empty(0)
    )
    fraction, lower, upper = fractions.at(x) if x.size else (x, x, x)
    return _about(labels, curve, x.size).assign(
        x=x, fraction=fraction, lower=lower, upper=upper
    )


def outcome_bins(
    labels: Mapping[str, Any], curve: Fragility, outcomes: Observations
) -> pd.DataFrame:
    """Fractions of overturned tests in bins under the labels of their curve, where the measure is called ``x``."""
    names = {"im": "x", "im_lower": "x_lower", "im_upper": "x_upper"}
    table = fraction_in_bins(outcomes).rename(columns=names)
    return pd.concat([_about(labels, curve, len(table)), table], axis=1)


def _about(labels: Mapping[str, Any], curve: Fragility, rows: int) -> pd.DataFrame:
    """Labels and measure of a curve, in every row."""
    columns = {**labels, "im": curve.fit.im, "unit": curve.fit.unit}
    return pd.DataFrame(columns, index=pd.RangeIndex(rows))
