"""Which intensity measure predicts overturning best, and how sure is that choice?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import stats
from statsmodels.regression.linear_model import OLS
from statsmodels.tools.tools import add_constant

from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.fragility import censored, held_out, observations
from rockfrag.fragility.empirical import TableIda
from rockfrag.fragility.ida_curves import scale_power
from rockfrag.fragility.intervals import Interval, interval_over_motions
from rockfrag.fragility.lognormal import FragilityFit, fit_lognormal
from rockfrag.fragility.observations import Floats, Observations, numbers
from rockfrag.words.sentences import Macros

DIFFERENCE_P = 0.05  # two measures differ below this p value of their held-out scores
FEWEST_GROUPS_TO_CHOOSE = 10
"""Below so many motions or earthquakes the words say that the choice is weak."""
SUFFICIENT_P = 0.05  # a residual's dependence on a column is named below this p value


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
    (Luco and Cornell, 2007, Earthquake Spectra 23: 357-392). NaN without a curve, with fewer than three groups or
    a constant column.
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
    extra = {column: numbers(table, column, source) for column in given}
    for column in measures:
        outcomes = observations.observations_from_table(
            table,
            column,
            overturned=overturned,
            motion=motion,
            earthquake=earthquake,
            source=source,
        )
        fit, interval = (
            fit_lognormal(outcomes),
            interval_over_motions(outcomes, level=level),
        )
        residual = outcomes.overturned / outcomes.trials - fit.probability(outcomes.im)
        p = {
            name: dependence_p_value(residual, values, outcomes.earthquake)
            for name, values in extra.items()
        }
        rows.append(_row(column, fit, interval, outcomes, p))
        group = pd.factorize(pd.Series(outcomes.earthquake))[0]
        logs, fell, trials = (
            outcomes.log_im[:, None],
            outcomes.overturned,
            outcomes.trials,
        )
        scores.append(held_out.outcome_scores(logs, fell, trials, group))
        data[column] = outcomes
    found = _selection(rows, np.array(scores), outcomes.n, given, (replicates, seed))
    pair, p_pair, gain = _best_pair(data, found.recommended, group)
    if not pair:
        return found
    words = [found.words, *_say("pair", data[pair].name, p_pair, gain)]
    return replace(found, words=" ".join(words))


def _row(
    column: str,
    fit: FragilityFit,
    interval: Interval,
    outcomes: Observations,
    p: Mapping[str, float],
    **more: float,
) -> dict[str, float | str]:
    """What the table says of one measure before its scores; ``p`` of sufficiency by what is given."""
    about = {"measure": column, "im": fit.im, "unit": fit.unit}
    beta = {
        "theta": fit.theta,
        "beta": fit.beta,
        "beta_lower": interval.beta[0],
        "beta_upper": interval.beta[1],
    }
    fitted = {"aic": fit.aic, "auc": area_under_curve(outcomes)}
    return {
        **about,
        **beta,
        **more,
        **fitted,
        **{f"p_{name}": value for name, value in p.items()},
    }


def _selection(
    rows: Sequence[Mapping[str, float | str]],
    scores: Floats,
    tests: int,
    given: Sequence[str],
    drawn: tuple[int, int],
    efficiency: str = "beta",
    needed: str = "theta",
) -> MeasureSelection:
    """Sort measures: best held-out score first, equals by efficiency, those without a curve last; and recommend.

    ``scores`` are log scores by group (:mod:`rockfrag.fragility.held_out`), shape (measures, groups), of so many
    ``tests``; ``drawn`` are replicates and seed of the bootstrap. Where all lack the column ``needed`` none is
    recommended.
    """
    compared = pd.DataFrame(rows)
    rising = compared["theta"].notna().to_numpy()
    known = rising & np.isfinite(scores).all(axis=1)
    total = np.where(known, scores.sum(axis=1), -np.inf)
    p_worse, fraction = np.full(len(scores), np.nan), np.zeros(len(scores))
    if known.any():
        best = scores[total.argmax()]
        p_worse[:] = [held_out.paired_p(best, score) for score in scores]
        fraction[known] = held_out.fraction_best(scores[known], *drawn)
    near = known & ~(p_worse < DIFFERENCE_P)
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
        scored = table[table["score"].notna()]
        differs = scored["p_worse"] < DIFFERENCE_P
        equal = scored[~differs].iloc[1:].to_dict("records")
        worse = scored[differs].sort_values("score", ascending=False).to_dict("records")
        about = (len(table) > 1, equal, worse, scores.shape[1], given)
        words = _say("choice", table.to_dict("records")[0], *about)
    else:
        words = _say("no_choice", rising.any())
    first = table.iloc[0] if table[needed].notna().any() else {"measure": "", "im": ""}
    return MeasureSelection(
        str(first["measure"]), str(first["im"]), table, " ".join(words)
    )


def _best_pair(
    data: Mapping[str, Observations], best: str, group: NDArray[np.intp]
) -> tuple[str, float, float]:
    """Measure that adds most to the best one, the p value of what it adds, and the gain of score."""
    found = ("", float("nan"), -np.inf)
    for name, other in data.items() if best else ():
        logs = np.column_stack([data[best].log_im, other.log_im])
        proportional = (
            np.linalg.matrix_rank(np.column_stack([np.ones(len(logs)), logs])) < 3
        )
        # proportional measures (PGA and a/(g tan α) of one block) tell nothing together
        if name == best or proportional:
            continue
        outcomes = (other.overturned, other.trials, group)
        both = held_out.outcome_scores(logs, *outcomes)
        alone = held_out.outcome_scores(logs, *outcomes, fitted=1)
        gain = float((both - alone).sum() / other.n)
        if gain > found[2]:
            found = (name, held_out.paired_p(both, alone), gain)
    return found


_say = Macros(
    "rockfrag.fragility",
    "measure_selection.j2",
    DIFFERENCE_P=DIFFERENCE_P,
    SUFFICIENT_P=SUFFICIENT_P,
    FEWEST_GROUPS_TO_CHOOSE=FEWEST_GROUPS_TO_CHOOSE,
    COLUMNS={"mean_period_s": "mean period", "d5_95_s": "significant duration"},
)


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
    ``ida`` knows the ``columns`` that are compared, which must grow with the amplitude; ``measures`` has one row
    per motion as recorded, with ``name`` and ``pga_g``. Sufficiency is tested against ``given`` columns, such as
    ``d5_95_s`` or magnitude. The table has also ``beta_amplitude``: β over the power with which the measure grows
    with the amplitude, which compares Arias intensity fairly with peaks.
    """
    powers = {column: scale_power(column) for column in columns}
    fixed = [column for column, power in powers.items() if power == 0]
    if fixed:
        raise InputError(
            f"measure {fixed[0]!r} does not grow with the amplitude, so no amplitude overturns by "
            "it; name it among the given columns instead."
        )
    amplitude = ida.brackets(ida.resurrections("amplitude_g"), "first", "amplitude_g")
    recorded = measures.set_index("name").loc[list(amplitude.motion)]
    extra = {column: numbers(recorded, column, "measures") for column in given}
    pga = observations.positive(recorded, "pga_g", "measures")
    group = pd.factorize(pd.Series(amplitude.earthquake))[0]
    rows, scores = [], []
    for column, power in powers.items():
        unit_value = observations.positive(recorded, column, "measures") / pga**power
        outcomes = ida.outcomes(column)
        scaled = replace(
            amplitude,
            lower=unit_value * amplitude.lower**power,
            upper=unit_value * amplitude.upper**power,
            name=outcomes.name,
            unit=outcomes.unit,
        )
        fit = censored.fit_brackets(scaled)
        interval = censored.bracket_interval(scaled, level=level)
        # residual of ln capacity of the motions that overturned above a survived step
        seen = np.isfinite(scaled.upper) & (scaled.lower > 0)
        residual = 0.5 * np.log(scaled.lower[seen] * scaled.upper[seen]) - np.log(
            fit.theta
        )
        p = {
            name: dependence_p_value(residual, values[seen], scaled.earthquake[seen])
            for name, values in extra.items()
        }
        rows.append(
            _row(column, fit, interval, outcomes, p, beta_amplitude=fit.beta / power)
        )
        scores.append(held_out.capacity_scores(scaled, group))
    about = (rows, np.array(scores), group.size, given, (200, seed))
    return _selection(*about, "beta_amplitude", needed="score")
