"""Which intensity measure foretells overturning best, and how sure is that choice?"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
import statsmodels.api as sm
from numpy.typing import NDArray
from scipy import stats

from rockfrag.errors import InputError
from rockfrag.fragility.batch_glm import fit_batch
from rockfrag.fragility.intervals import Interval, bootstrap_draws, interval_over_motions
from rockfrag.fragility.lognormal import FragilityFit, fit_lognormal
from rockfrag.fragility.observations import Floats, Outcomes, numbers, outcomes_from_table
from rockfrag.fragility.surface import FragilitySurface, fit_surface

EQUAL_AIC = 2.0
"""Differences of AIC up to this do not tell two measures apart (Burnham and Anderson, 2002)."""
SUFFICIENT_P = 0.05
"""A residual's dependence on a column is named below this p value."""


@dataclass(frozen=True)
class MeasureChoice:
    """Comparison of intensity measures on the same tests.

    Attributes
    ----------
    recommended
        Column of the recommended measure; empty where no measure has a rising curve.
    name
        The same as the field writes it, for example ``PGV``.
    table
        One row per measure, best first: ``measure``, ``im``, ``unit``, ``theta``, ``beta``
        (efficiency: the smaller the better), ``beta_lower``, ``beta_upper``, ``aic``,
        ``delta_aic``, ``auc``, ``chosen_share`` (share of bootstrap samples of motions in which it
        has the least AIC), and ``p_<column>`` for the sufficiency against each given column.
    pair
        Probit surface in the best measure and the one that adds most to it; None for a single
        measure.
    words
        The recommendation with its reasons, for a report.
    """

    recommended: str
    name: str
    table: pd.DataFrame
    pair: FragilitySurface | None
    words: str


def area_under_curve(outcomes: Outcomes) -> float:
    """Probability that an overturned test had the larger measure than a survived one; ties half.

    NaN where all tests agree.
    """
    fell, stood = outcomes.overturned, outcomes.trials - outcomes.overturned
    _, level = np.unique(outcomes.im, return_inverse=True)
    falls, stands = np.bincount(level, fell), np.bincount(level, stood)
    if falls.sum() == 0 or stands.sum() == 0:
        return float("nan")
    below = np.cumsum(stands) - stands
    return float((falls * (below + 0.5 * stands)).sum() / (falls.sum() * stands.sum()))


def sufficiency(outcomes: Outcomes, fit: FragilityFit, column: Floats) -> float:
    """Test a linear dependence of the verdict's residual on ``column``, shape (n,); p value.

    The residual is verdict minus fitted probability; the regression's standard error is robust to
    dependence within a motion (event where known). A measure is sufficient for a property, such as
    magnitude or distance, on which nothing of its residual depends (Luco and Cornell, 2007,
    Earthquake Spectra 23: 357-392). NaN with fewer than three groups or a constant column.
    """
    if not np.isfinite(fit.theta):
        return float("nan")
    residual = outcomes.overturned / outcomes.trials - fit.probability(outcomes.im)
    return dependence_p_value(residual, column, outcomes.event)


def dependence_p_value(residual: Floats, column: Floats, groups: NDArray[np.object_]) -> float:
    """Test a linear dependence of residuals on a column, robust to dependence within groups."""
    codes, names = pd.factorize(pd.Series(groups))
    if len(names) < 3 or np.ptp(column) == 0:
        return float("nan")
    scaled = (column - column.mean()) / column.std()
    result = sm.OLS(residual, sm.add_constant(scaled)).fit(
        cov_type="cluster", cov_kwds={"groups": codes, "use_correction": True}
    )
    error = float(np.sqrt(result.cov_params()[1, 1]))
    if error == 0:
        return float("nan")
    return float(2.0 * stats.t.sf(abs(float(result.params[1])) / error, len(names) - 1))


def recommend_measure(
    table: pd.DataFrame,
    measures: Sequence[str],
    *,
    given: Sequence[str] = (),
    overturned: str = "overturned",
    motion: str | None = "motion",
    event: str | None = None,
    level: float = 0.90,
    replicates: int = 200,
    seed: int = 0,
    source: str = "table",
) -> MeasureChoice:
    """Compare intensity measures on the same tests and recommend one, in words.

    The measure with the least AIC is recommended. Measures within 2 of it are named as equals, with
    the more efficient one (smaller β) first.

    Parameters
    ----------
    table
        One row per test, with a column per measure.
    measures
        Columns of the measures, at least one.
    given
        Columns (magnitude, distance, …) against which sufficiency is tested.
    overturned, motion, event
        Names of columns.
    level
        Of the limits of β.
    replicates, seed
        Bootstrap over motions (events where given) for ``chosen_share``.
    """
    if not measures:
        raise InputError("measures: name at least one column with an intensity measure.")
    rows, data = [], {}
    extra = {column: numbers(table, column, source) for column in given}
    for column in measures:
        outcomes = outcomes_from_table(
            table, column, overturned=overturned, motion=motion, event=event, source=source
        )
        data[column] = outcomes
        fit = fit_lognormal(outcomes)
        interval = interval_over_motions(outcomes, level=level)
        rows.append(
            _row(column, outcomes, fit, interval)
            | {f"p_{name}": sufficiency(outcomes, fit, values) for name, values in extra.items()}
        )
    compared = pd.DataFrame(rows)
    share = _chosen_share(list(data.values()), replicates, seed)
    compared["chosen_share"] = compared["measure"].map(dict(zip(measures, share, strict=True)))
    compared = ranked(compared)
    if compared["theta"].isna().all():
        return MeasureChoice("", "", compared, None, recommendation(compared, None, given))
    best = str(compared["measure"].iloc[0])
    pair = _best_pair(table, best, [c for c in measures if c != best], overturned, source)
    words = recommendation(compared, pair, given)
    return MeasureChoice(best, str(compared["im"].iloc[0]), compared, pair, words)


def ranked(compared: pd.DataFrame, efficiency: str = "beta") -> pd.DataFrame:
    """Sort measures: least AIC first, within 2 of it by efficiency, those without a curve last."""
    # without a likelihood (brackets that all overlap) a measure cannot be compared either
    rising = compared["theta"].notna() & compared["aic"].notna()
    delta = compared["aic"] - compared.loc[rising, "aic"].min()
    near = rising & (delta <= EQUAL_AIC)
    order = compared.assign(
        delta_aic=delta, late=~rising, rank=np.where(near, compared[efficiency], np.inf)
    ).sort_values(["late", "rank", "aic", "measure"], kind="stable")
    return order.drop(columns=["late", "rank"]).reset_index(drop=True)


def _row(
    column: str, outcomes: Outcomes, fit: FragilityFit, interval: Interval
) -> dict[str, float | str]:
    return {
        "measure": column,
        "im": outcomes.name,
        "unit": outcomes.unit,
        "theta": fit.theta,
        "beta": fit.beta,
        "beta_lower": interval.beta[0],
        "beta_upper": interval.beta[1],
        "aic": fit.aic,
        "auc": area_under_curve(outcomes),
    }


def _chosen_share(data: Sequence[Outcomes], replicates: int, seed: int) -> Floats:
    """Share of bootstrap samples of motions in which each measure has the largest likelihood."""
    weights = drawn_rows(data[0].event, replicates, seed)
    likelihood = np.empty((len(data), replicates))
    for k, outcomes in enumerate(data):
        design = np.column_stack([np.ones(outcomes.im.size), outcomes.log_im])
        # the penalty keeps separated samples finite and hardly moves the others
        fit = fit_batch(
            design,
            weights * outcomes.overturned,
            weights * outcomes.trials,
            penalised=True,
            tolerance=1e-5,
        )
        likelihood[k] = np.where(fit.coefficients[:, 1] > 0, fit.log_likelihood, -np.inf)
    return share_likeliest(likelihood[:, np.isfinite(likelihood).any(axis=0)])


def drawn_rows(event: NDArray[np.object_], replicates: int, seed: int) -> Floats:
    """How often each row is in each bootstrap sample of whole events, shape (replicates, n)."""
    codes, names = pd.factorize(pd.Series(event))
    return bootstrap_draws(len(names), replicates, seed)[:, codes].astype(np.float64)


def share_likeliest(likelihood: Floats) -> Floats:
    """Share of samples in which each measure is the likeliest, (measures, samples) to (measures,)."""
    measures, samples = likelihood.shape
    winner = likelihood.argmax(axis=0)
    return np.asarray(np.bincount(winner, minlength=measures) / max(samples, 1))


def _best_pair(
    table: pd.DataFrame, best: str, others: Sequence[str], overturned: str, source: str
) -> FragilitySurface | None:
    pairs = []
    for other in others:
        try:
            pairs.append(fit_surface(table, (best, other), overturned=overturned, source=source))
        except InputError:
            # proportional measures (PGA and a/(g tan α) of one block) tell nothing together
            continue
    return min(pairs, key=lambda pair: pair.aic) if pairs else None


def recommendation(table: pd.DataFrame, pair: FragilitySurface | None, given: Sequence[str]) -> str:
    """Put a ranked table of measures into words."""
    if table["theta"].isna().all():
        return "The probability of overturning rises in none of the measures."
    if table["aic"].isna().all():
        return (
            "The brackets of all motions overlap, so the measures cannot be compared; more "
            "motions or smaller steps are needed."
        )
    best = table.iloc[0]
    parts = []
    others = table.iloc[1:]
    equal = others[(others["delta_aic"] <= EQUAL_AIC) & others["theta"].notna()]
    clear = others[others["delta_aic"] > EQUAL_AIC]
    parts.append(
        f"{best['im']} is recommended: AIC {best['aic']:.1f}, β = {best['beta']:.2f}, "
        f"AUC {best['auc']:.3f}."
    )
    if len(equal):
        listed = ", ".join(
            f"{row.im} (AIC {row.aic:.1f}, β = {row.beta:.2f})" for row in equal.itertuples()
        )
        parts.append(f"The tests do not tell it from {listed}; it is named for its smaller β.")
    if len(clear):
        row = clear.sort_values("aic").iloc[0]
        parts.append(
            f"The next is {row['im']} with AIC {row['aic']:.1f}, β = {row['beta']:.2f}, "
            f"AUC {row['auc']:.3f}."
        )
    if len(others):
        parts.append(
            f"It has the least AIC in {best['chosen_share']:.0%} of bootstrap samples of the "
            "motions."
        )
    if pair is not None:
        name = table.loc[table["measure"] == pair.measures[1], "im"].iloc[0]
        lone = table.loc[table["measure"] == pair.measures[0], "aic"].iloc[0]
        helps = pair.aic < lone - EQUAL_AIC
        parts.append(
            f"Adding {name} {'lowers' if helps else 'does not lower'} the AIC "
            f"({pair.aic:.1f} for both)"
            + ("; use the surface in both measures." if helps else ", so one measure is enough.")
        )
    for column in given:
        p = float(best[f"p_{column}"])
        if np.isnan(p):
            parts.append(f"Its sufficiency against {column} cannot be tested with these motions.")
        elif p < SUFFICIENT_P:
            parts.append(f"It is not sufficient: what it leaves depends on {column} (p = {p:.3f}).")
        else:
            parts.append(f"Nothing shows that what it leaves depends on {column} (p = {p:.2f}).")
    return " ".join(parts)
