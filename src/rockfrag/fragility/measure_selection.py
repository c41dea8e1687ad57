"""Selection of the intensity measure that predicts overturning best, and how sure the choice is.

In: a table of tests with columns of measures, or the IDA curves of one body. Out: :class:`MeasureSelection`, a
row a measure with efficiency β, log score of what was held out [-], sufficiency, and the recommendation in
sentences.

Theory: ``docs/fragility.md``, "Which intensity measure?"; sufficiency after Luco and Cornell (2007, Earthquake
Spectra 23: 357-392).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import stats
from statsmodels.regression.linear_model import OLS
from statsmodels.tools.tools import add_constant

from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.fragility import censored, held_out, observations
from rockfrag.fragility.censored import Brackets
from rockfrag.fragility.empirical import TableIda
from rockfrag.fragility.ida_curves import scale_power
from rockfrag.fragility.intervals import Interval, interval_over_motions
from rockfrag.fragility.lognormal import FragilityFit, fit_lognormal
from rockfrag.fragility.observations import Floats, Observations, numbers
from rockfrag.fragility.recommendation import (
    CANNOT_COMPARE,
    DIFFERENCE_P,
    NONE_RISES,
    Choice,
    choice_text,
    pair_text,
)


@dataclass(frozen=True)
class MeasureSelection:
    """Comparison of intensity measures on the same tests.

    Attributes
    ----------
    recommended, name : its column and what the field calls it, such as ``PGV``; empty where no curve rises
    table
        One row per measure, best first: ``measure``, ``im``, ``unit``, ``theta``, ``beta``
        (efficiency: the smaller the better), ``beta_lower``, ``beta_upper``, ``aic``, ``auc``,
        ``score`` (mean log probability of what was held out, per test [-]; the larger the better),
        ``p_worse`` (p value of scoring as the best does, t over motions or earthquakes), ``chosen_fraction``
        (fraction of bootstrap samples of motions or earthquakes in which it scores best), and ``p_<column>``
        for the sufficiency against each given column.
    words : the recommendation with its reasons, for a report
    """

    recommended: str
    name: str
    table: pd.DataFrame
    words: str

    __repr__ = short_repr


def area_under_curve(outcomes: Observations) -> float:
    """Probability that an overturned test had the larger measure than a survived one; ties half.

    Parameters
    ----------
    outcomes : outcomes with their measure

    Returns
    -------
    The area [-], from 0 to 1; NaN where all tests agree.
    """
    fell, stood = outcomes.overturned, outcomes.trials - outcomes.overturned
    _, level = np.unique(outcomes.im, return_inverse=True)
    falls, stands = np.bincount(level, fell), np.bincount(level, stood)
    if falls.sum() == 0 or stands.sum() == 0:
        return float("nan")
    below = np.cumsum(stands) - stands
    return float((falls * (below + 0.5 * stands)).sum() / (falls.sum() * stands.sum()))


def dependence_p_value(
    residual: Floats, column: Floats, groups: NDArray[np.object_]
) -> float:
    """Return the p value of a linear dependence of residuals on a column, robust to dependence within groups.

    A measure is sufficient for a property, such as magnitude or distance, on which nothing of its residual depends
    (Luco and Cornell, 2007, Earthquake Spectra 23: 357-392).

    Parameters
    ----------
    residual, column, groups : residuals, the property and the labels of dependent tests, shape (n,)

    Returns
    -------
    The p value [-]; NaN without a curve, with fewer than three groups or a constant column.
    """
    codes, names = pd.factorize(pd.Series(groups))
    if len(names) < 3 or np.ptp(column) == 0 or not np.isfinite(residual).all():
        return float("nan")
    scaled = (column - column.mean()) / column.std()
    result = OLS(residual, add_constant(scaled)).fit(
        cov_type="cluster", cov_kwds={"groups": codes, "use_correction": True}
    )
    error = float(np.sqrt(result.cov_params()[1, 1])) or float("nan")
    return float(2.0 * stats.t.sf(abs(float(result.params[1])) / error, len(names) - 1))


def recommend_measure(
    table: pd.DataFrame,
    measures: Sequence[str],
    *,
    given: Sequence[str] = (),
    overturned: str = "overturned",
    motion: str | None = "motion",
    earthquake: str | None = None,
    level: float = 0.90,
    replicates: int = 200,
    seed: int = 0,
    source: str = "table",
) -> MeasureSelection:
    """Compare intensity measures on the same tests and recommend one, in words.

    Motions (earthquakes where given) are held out in turn and predicted from the others; the measure with
    the best score is recommended. Measures that the scores do not tell from it are named as equals,
    with the more efficient one (smaller β) first.

    Parameters
    ----------
    table, measures : one row per test, and its columns of measures
    given, overturned, motion, earthquake
        Columns of what sufficiency is tested against (magnitude, distance, …), and of each test.
    level, replicates, seed, source
        Of the limits of β; of the bootstrap over motions (earthquakes where given) for ``chosen_fraction``; what
        messages call the table.

    Returns
    -------
    The :class:`MeasureSelection`.
    """
    if not measures:
        raise InputError(
            "measures: name at least one column with an intensity measure."
        )
    rows, data, scores = [], {}, []
    properties = {column: numbers(table, column, source) for column in given}
    for column in measures:
        outcomes = observations.observations_from_table(
            table,
            column,
            overturned=overturned,
            motion=motion,
            earthquake=earthquake,
            source=source,
        )
        fit = fit_lognormal(outcomes)
        interval = interval_over_motions(outcomes, level=level)
        residual = outcomes.overturned / outcomes.trials - fit.probability(outcomes.im)
        p = {
            name: dependence_p_value(residual, values, outcomes.earthquake)
            for name, values in properties.items()
        }
        rows.append(_row(column, fit, interval, outcomes, p))
        group = pd.factorize(pd.Series(outcomes.earthquake))[0]
        logs = outcomes.log_im[:, None]
        scores.append(
            held_out.outcome_scores(logs, outcomes.overturned, outcomes.trials, group)
        )
        data[column] = outcomes
    found = _select(
        rows,
        np.array(scores),
        tests=outcomes.n,
        given=given,
        replicates=replicates,
        seed=seed,
    )
    pair, p_pair, gain = _best_pair(data, found.recommended, group)
    if not pair:
        return found
    added = pair_text(data[pair].name, p_pair, gain)
    return replace(found, words=f"{found.words} {added}")


def _row(
    column: str,
    fit: FragilityFit,
    interval: Interval,
    outcomes: Observations,
    p: Mapping[str, float],
    **more: float,
) -> dict[str, float | str]:
    """Row of one measure before its scores.

    Parameters
    ----------
    column : of the measure
    fit, interval, outcomes : the curve in it, its limits, and the tests
    p : p values of sufficiency by the columns given
    **more : further columns, behind the limits of β
    """
    return {
        "measure": column,
        "im": fit.im,
        "unit": fit.unit,
        "theta": fit.theta,
        "beta": fit.beta,
        "beta_lower": interval.beta[0],
        "beta_upper": interval.beta[1],
        **more,
        "aic": fit.aic,
        "auc": area_under_curve(outcomes),
        **{f"p_{name}": value for name, value in p.items()},
    }


def _select(
    rows: Sequence[Mapping[str, float | str]],
    scores: Floats,
    *,
    tests: int,
    given: Sequence[str],
    replicates: int,
    seed: int,
    efficiency: str = "beta",
    needed: str = "theta",
) -> MeasureSelection:
    """Sort measures, best held-out score first, equals by efficiency, those without a curve last; recommend one.

    Parameters
    ----------
    rows : a row a measure (:func:`_row`)
    scores : log scores by group (:mod:`rockfrag.fragility.held_out`), shape (measures, groups)
    tests : their number
    given : columns that sufficiency was tested against
    replicates, seed : of the bootstrap
    efficiency : column by which equals are sorted
    needed : column without which no measure is recommended
    """
    compared = pd.DataFrame(rows)
    rising = compared["theta"].notna().to_numpy()
    known = rising & np.isfinite(scores).all(axis=1)
    total = np.where(known, scores.sum(axis=1), -np.inf)
    p_worse, fraction = np.full(len(scores), np.nan), np.zeros(len(scores))
    if known.any():
        best = scores[total.argmax()]
        p_worse[:] = [held_out.paired_p(best, score) for score in scores]
        fraction[known] = held_out.fraction_best(scores[known], replicates, seed)
    near = known & ~(p_worse < DIFFERENCE_P)
    # late, rank and total are there to sort by; the last puts the larger score first
    table = compared.assign(
        score=np.where(known, total / tests, np.nan),
        p_worse=p_worse,
        chosen_fraction=fraction,
        late=~rising,
        rank=np.where(near, compared[efficiency], np.inf),
        total=-total,
    ).sort_values(
        ["late", "rank", "total", "measure"], kind="stable", ignore_index=True
    )
    table = table.drop(columns=["late", "rank", "total"])
    if known.any():
        words = choice_text(_choice_of(table, scores.shape[1], given))
    elif rising.any():
        words = CANNOT_COMPARE
    else:
        words = NONE_RISES
    first = table.iloc[0] if table[needed].notna().any() else {"measure": "", "im": ""}
    return MeasureSelection(str(first["measure"]), str(first["im"]), table, words)


def _choice_of(table: pd.DataFrame, groups: int, given: Sequence[str]) -> Choice:
    """Best measure of a sorted table, its equals and those that score worse; ``groups``: number held out."""
    scored = table[table["score"].notna()]
    differs = scored["p_worse"] < DIFFERENCE_P
    worse = scored[differs].sort_values("score", ascending=False)
    return Choice(
        best=table.to_dict("records")[0],
        several=len(table) > 1,
        equal=scored[~differs].iloc[1:].to_dict("records"),
        worse=worse.to_dict("records"),
        groups=groups,
        given=given,
    )


def _best_pair(
    data: Mapping[str, Observations], best: str, group: NDArray[np.intp]
) -> tuple[str, float, float]:
    """Measure that adds most to the best one, the p value of what it adds, and the gain of score a test.

    ``data``: outcomes by measure; ``group``: number of each test's group, shape (tests,). Without any the name is
    empty.
    """
    found = ("", float("nan"), -np.inf)
    for name, other in data.items() if best else ():
        logs = np.column_stack([data[best].log_im, other.log_im])
        proportional = (
            np.linalg.matrix_rank(np.column_stack([np.ones(len(logs)), logs])) < 3
        )
        # proportional measures (PGA and a/(g tan α) of one block) tell nothing together
        if name == best or proportional:
            continue
        scores_of = partial(
            held_out.outcome_scores, logs, other.overturned, other.trials, group
        )
        both, alone = scores_of(), scores_of(fitted=1)
        gain = float((both - alone).sum() / other.n)
        if gain > found[2]:
            found = (name, held_out.paired_p(both, alone), gain)
    return found


def recommend_ida_measure(
    ida: TableIda,
    measures: pd.DataFrame,
    columns: Sequence[str],
    *,
    given: Sequence[str] = (),
    level: float = 0.90,
    seed: int = 0,
) -> MeasureSelection:
    """Compare measures on the IDA curves of one body and recommend one, in words.

    A motion scaled up and down gives many outcomes but one capacity, so the measures are compared by how well
    they predict the bracket of the first overturning of earthquakes that were held out: one observation a motion.

    Parameters
    ----------
    ida, columns : IDA curves, and the columns that are compared, which must grow with the amplitude
    measures : one row per motion as recorded, with ``name``, ``pga_g`` and the ``columns``
    given : columns of ``measures`` against which sufficiency is tested, such as ``d5_95_s`` or magnitude
    level, seed : of the limits of β [-], and of the bootstrap

    Returns
    -------
    The :class:`MeasureSelection`. Its table has also ``beta_amplitude``: β over the power with which the measure
    grows with the amplitude, which compares Arias intensity fairly with peaks.
    """
    powers = _powers_of_amplitude(columns)
    by_amplitude = ida.brackets(
        ida.resurrections("amplitude_g"), "first", "amplitude_g"
    )
    recorded = measures.set_index("name").loc[list(by_amplitude.motion)]
    properties = {column: numbers(recorded, column, "measures") for column in given}
    earthquake = pd.factorize(pd.Series(by_amplitude.earthquake))[0]
    rows, scores = [], []
    for column, power in powers.items():
        outcomes = ida.outcomes(column)
        brackets = replace(
            _brackets_in(by_amplitude, recorded, column, power),
            name=outcomes.name,
            unit=outcomes.unit,
        )
        fit = censored.fit_brackets(brackets)
        interval = censored.bracket_interval(brackets, level=level)
        p = _sufficiency(brackets, fit.theta, properties)
        rows.append(
            _row(column, fit, interval, outcomes, p, beta_amplitude=fit.beta / power)
        )
        scores.append(held_out.capacity_scores(brackets, earthquake))
    return _select(
        rows,
        np.array(scores),
        tests=earthquake.size,
        given=given,
        replicates=200,
        seed=seed,
        efficiency="beta_amplitude",
        needed="score",
    )


def _powers_of_amplitude(columns: Sequence[str]) -> dict[str, int]:
    """Power of the amplitude with which each measure grows: 1 of a peak, 2 of Arias intensity [-]."""
    powers = {column: scale_power(column) for column in columns}
    fixed = [column for column, power in powers.items() if power == 0]
    if fixed:
        raise InputError(
            f"measure {fixed[0]!r} does not grow with the amplitude, so no amplitude overturns by "
            "it; name it among the given columns instead."
        )
    return powers


def _brackets_in(
    by_amplitude: Brackets, recorded: pd.DataFrame, column: str, power: float
) -> Brackets:
    """Brackets of the first overturning in another measure than the peak acceleration [g].

    A motion whose measure is m at its recorded peak a has m (x/a)^power at the peak x.  ``recorded`` has a row for
    each motion of the brackets, in their order.
    """
    recorded_pga = observations.positive(recorded, "pga_g", "measures")
    at_recorded = observations.positive(recorded, column, "measures")
    at_one_g = at_recorded / recorded_pga**power
    return replace(
        by_amplitude,
        lower=at_one_g * by_amplitude.lower**power,
        upper=at_one_g * by_amplitude.upper**power,
    )


def _sufficiency(
    brackets: Brackets, median: float, properties: Mapping[str, Floats]
) -> dict[str, float]:
    """Return p values of a dependence of ln capacity on properties of the motions, by their names [-].

    The capacity of a motion is the geometric middle of its bracket; motions whose bracket is open have none.
    """
    closed = np.isfinite(brackets.upper) & (brackets.lower > 0)
    ln_capacity = 0.5 * np.log(brackets.lower[closed] * brackets.upper[closed])
    residual = ln_capacity - np.log(median)
    return {
        name: dependence_p_value(residual, values[closed], brackets.earthquake[closed])
        for name, values in properties.items()
    }
