"""Choice of the intensity measure from incremental dynamic analyses, one body at a time.

A motion scaled up and down gives many outcomes but one capacity, so the measures are compared by
how well they predict the bracket of the first overturning of earthquakes that were held out: one
observation per motion.
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility import censored
from rockfrag.fragility.empirical import IdaData, TableIda
from rockfrag.fragility.held_out import capacity_scores
from rockfrag.fragility.ida_curves import scale_power, with_measures
from rockfrag.fragility.measure_selection import (
    MeasureSelection,
    dependence_p_value,
    measure_row,
    ranked,
    recommendation,
)
from rockfrag.fragility.observations import numbers, positive


def recommend_ida_measure(
    ida: pd.DataFrame | IdaData,
    measures: pd.DataFrame,
    columns: Sequence[str],
    *,
    given: Sequence[str] = (),
    earthquake: str | None = "earthquake",
    level: float = 0.90,
    replicates: int = 200,
    seed: int = 0,
) -> MeasureSelection:
    """Compare measures on the IDA curves of one body and recommend one, in words.

    ``ida`` has one row per motion and amplitude of one body, with ``motion``, ``amplitude_g``, ``overturned``,
    or is IDA curves in another form that know the measures; ``measures`` one row per motion as recorded, with
    ``name`` and ``pga_g``. ``columns`` are compared, and must grow with the amplitude; sufficiency is tested
    against ``given`` ones, such as ``d5_95_s`` or magnitude. The table has also ``beta_amplitude``: β over the
    power with which the measure grows with the amplitude, which compares Arias intensity fairly with peaks.
    """
    if not columns:
        raise InputError("columns: name at least one intensity measure.")
    powers = {column: scale_power(column) for column in columns}
    fixed = [column for column, power in powers.items() if power == 0]
    if fixed:
        raise InputError(
            f"measure {fixed[0]!r} does not grow with the amplitude, so no amplitude overturns by "
            "it; name it among the given columns instead."
        )
    if isinstance(ida, pd.DataFrame):
        ida = TableIda(with_measures(ida, measures, columns), earthquake)
    resurrections = ida.resurrections(
        "amplitude_g", ["motion"] if earthquake is None else ["motion", earthquake]
    )
    amplitude = censored.brackets_from_table(
        resurrections,
        lower="first_lower",
        upper="first_upper",
        earthquake=earthquake,
        measure="amplitude_g",
    )
    known = measures.set_index("name")
    place = known.index.get_indexer(pd.Index(resurrections["motion"]))
    extra = {column: numbers(measures, column, "measures")[place] for column in given}
    pga = positive(known.loc[resurrections["motion"]], "pga_g", "measures")
    rows, brackets = [], []
    for column, power in powers.items():
        unit_value = positive(known.loc[resurrections["motion"]], column, "measures") / pga**power
        outcomes = ida.outcomes(column)
        scaled = censored.Brackets(
            unit_value * amplitude.lower**power,
            unit_value * amplitude.upper**power,
            amplitude.motion,
            amplitude.earthquake,
            outcomes.name,
            outcomes.unit,
        )
        fit = censored.fit_brackets(scaled)
        interval = censored.bracket_interval(scaled, level=level)
        # residual of ln capacity of the motions that overturned above a survived step
        seen = np.isfinite(scaled.upper) & (scaled.lower > 0)
        middle = 0.5 * np.log(scaled.lower[seen] * scaled.upper[seen])
        residual = middle - np.log(fit.theta)
        row = measure_row(column, fit, interval, outcomes, beta_amplitude=fit.beta / power)
        for name, values in extra.items():
            row[f"p_{name}"] = dependence_p_value(residual, values[seen], scaled.earthquake[seen])
        rows.append(row)
        brackets.append(scaled)
    group = pd.factorize(pd.Series(amplitude.earthquake))[0]
    scores = np.array([capacity_scores(bracket, group) for bracket in brackets])
    tests = len(amplitude.lower)
    table = ranked(pd.DataFrame(rows), scores, tests, replicates, seed, "beta_amplitude")
    words = recommendation(table, scores.shape[1], given)
    if table["score"].isna().all():
        return MeasureSelection("", "", table, words)
    best = table.iloc[0]
    return MeasureSelection(str(best["measure"]), str(best["im"]), table, words)
