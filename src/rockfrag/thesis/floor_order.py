"""What a table of tests says about the floors: margins by which statements C34 to C44 hold.

A margin is a difference of logarithms of overturning amplitudes, or of effects of the pedestal
d = ln a(P) - ln a(NP); the statement holds where it is positive. A margin of 0.02 is 2 %: smaller ones
mean nothing, whatever their sign. These are point values without inference, for following a statement
along an axis of assumptions.
"""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from rockfrag.errors import InputError

FLOORS = ("GF", "F3", "F5")

STATEMENTS: Mapping[str, str] = {
    "C34": "the pedestal helps only on the ground floor",
    "C35": "the pedestal helps on the ground floor",
    "C36": "it harms on the 3rd floor",
    "C37": "it harms on the 5th floor",
    "C38": "the same signs for each tower, except T1 on the 3rd",
    "C39": "T1 gains more on the ground floor than the others",
    "C40": "T1 loses more on the 5th floor than the others",
    "C41": "the effect is largest on the ground floor",
    "C42": "with pedestal the mean is largest on the 5th floor",
    "C43": "without pedestal the mean is largest on the ground floor",
    "C44": "the mean is smallest on the 3rd floor for each tower, with and without pedestal",
}


def floor_margins(tests: pd.DataFrame) -> dict[str, float]:
    """Margins of the statements about floors in one table of tests.

    Parameters
    ----------
    tests
        Table of tests of one reading, with floors ``GF``, ``F3``, ``F5`` and each tower ``P`` and
        ``NP``; repetitions are averaged. Censored tests enter with the amplitude they survived,
        which is the least that they can be.

    Returns
    -------
    Margin [-] by number of statement. ``order`` is that of the thesis's order of the floors for lone
    towers, ground highest and 3rd lowest: the smaller of the two logarithmic steps from F3 to F5 and
    from F5 to GF between the means.

    Raises
    ------
    InputError
        If a floor or one of the pairs is missing.
    """
    amplitude = _amplitudes(tests)
    effect = np.log(amplitude["P"]) - np.log(amplitude["NP"])
    by_floor = effect.groupby("floor").mean()
    by_object = _by_object(effect)
    means = amplitude.groupby("floor").mean()
    step = np.log(means.loc[["GF", "F5", "F3"], "NP"].to_numpy())
    margins = {
        "C34": min(by_floor["GF"], -by_floor["F3"], -by_floor["F5"]),
        "C35": by_floor["GF"],
        "C36": -by_floor["F3"],
        "C37": -by_floor["F5"],
        "C38": _signs(by_object),
        "C39": _first_against_others(by_object["GF"]),
        "C40": _first_against_others(-by_object["F5"]),
        "C41": abs(by_floor["GF"]) - max(abs(by_floor["F3"]), abs(by_floor["F5"])),
        "C42": _lead(means["P"], "F5"),
        "C43": _lead(means["NP"], "GF"),
        "C44": _third_is_smallest(amplitude),
        "order": min(step[0] - step[1], step[1] - step[2]),
    }
    return {name: float(value) for name, value in margins.items()}


TIE = 1e-9
"""Margins below this are ties up to rounding: the amplitudes of two tests are the same of the sweep."""


def margins_table(tests: pd.DataFrame) -> pd.DataFrame:
    """Margins of the statements about floors for every building of a sensitivity study.

    Parameters
    ----------
    tests
        As :func:`rockfrag.shaketable.sensitivity.building_sensitivity` returns them.

    Returns
    -------
    One row per building, reading and statement: ``axis``, ``value``, ``label``, ``reading``,
    ``statement``, ``margin``, ``holds`` and ``credible``.
    """
    keys = ["axis", "value", "label", "credible", "reading"]
    rows = []
    for values, one in tests.groupby(keys, sort=False):
        about = dict(zip(keys, values, strict=True))
        rows += [
            {**about, "statement": name, "margin": margin, "holds": margin > TIE}
            for name, margin in floor_margins(one).items()
        ]
    columns = ["axis", "value", "label", "reading", "statement", "margin", "holds", "credible"]
    return pd.DataFrame(rows, columns=columns)


def _amplitudes(tests: pd.DataFrame) -> pd.DataFrame:
    """Amplitude [g] by tower, event and floor, a column each with and without pedestal."""
    known = tests.assign(amplitude=tests["amplitude_g"].fillna(tests["lower_g"]))
    known = known[known["floor"].isin(FLOORS)]
    table = known.pivot_table(
        index=["object", "event", "floor"], columns="pedestal", values="amplitude", aggfunc="mean"
    )
    missing = [name for name in ("P", "NP") if name not in table.columns]
    missing += [name for name in FLOORS if name not in table.index.get_level_values("floor")]
    if missing:
        raise InputError(f"tests: nothing about {', '.join(missing)}; the floors need all of them.")
    if table.isna().to_numpy().any() or not (table > 0).to_numpy().all():
        object_name, event, floor = table.index[~(table > 0).all(axis=1)][0]
        raise InputError(
            f"tests: {object_name}, {event}, {floor} has no positive amplitude with and without pedestal."
        )
    return table


def _by_object(values: pd.Series) -> pd.DataFrame:
    """Mean over the events, a row per tower and a column per floor."""
    return (
        values.rename("value")
        .reset_index()
        .pivot_table(index="object", columns="floor", values="value", aggfunc="mean")
    )


def _signs(effect: pd.DataFrame) -> float:
    """Least margin of the expected signs: + on GF, - on F3 except for T1, - on F5."""
    signed = pd.concat([effect["GF"], -effect["F3"], -effect["F5"]], axis=1)
    signed.loc[signed.index[0], "F3"] *= -1
    return float(signed.to_numpy().min())


def _first_against_others(effect: pd.Series) -> float:
    return float(effect.iloc[0] - effect.iloc[1:].max()) if effect.size > 1 else float("nan")


def _lead(means: pd.Series, floor: str) -> float:
    others = [float(value) for name, value in means.items() if name != floor]
    return float(np.log(means[floor] / max(others)))


def _third_is_smallest(amplitude: pd.DataFrame) -> float:
    margins = []
    for pedestal in ("P", "NP"):
        means = _by_object(amplitude[pedestal])
        others = np.minimum(means["GF"], means["F5"])
        margins.append(float(np.log(others / means["F3"]).min()))
    return min(margins)
