"""What a study found, in sentences made of its tables."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from rockfrag.shaketable.readings import READING

FLOOR_NAMES = {"GF": "the ground floor", "F3": "the 3rd floor", "F5": "the 5th floor"}


@dataclass(frozen=True)
class Finding:
    """One finding: a headline, and the sentences that carry it."""

    headline: str
    text: str


def all_findings(
    tests: pd.DataFrame,
    effects: pd.DataFrame | None,
    windows: pd.DataFrame,
    validity: pd.DataFrame,
    comparisons: Sequence[pd.DataFrame],
    claims: pd.DataFrame | None,
) -> list[Finding]:
    """Return the findings in the order in which a reader wants them.

    Parameters
    ----------
    tests
        Table of tests with all readings.
    effects
        The pedestal's effect by reading and scope, or None if there are no pairs.
    windows
        Survival windows of every sweep.
    validity
        Contact forces of every test.
    comparisons
        Printed and computed tables.
    claims
        The ledger of statements, or None.
    """
    laboratory = tests[tests["reading"] == READING]
    found = [amplitudes_found(laboratory)]
    if effects is not None:
        found += [pedestal_effect(effects), pedestal_by_floor(effects)]
    found += [
        slenderness_effect(laboratory),
        readings_differ(tests, windows),
        model_allowed(validity),
    ]
    printed = pd.concat(comparisons, ignore_index=True) if comparisons else pd.DataFrame()
    if len(printed) and printed["agrees"].notna().any():
        found.append(printed_tables(printed))
    if claims is not None and len(claims):
        found.append(ledger(claims))
    return found


def amplitudes_found(tests: pd.DataFrame) -> Finding:
    """Say how many tests have an amplitude, and why the others have none."""
    known = int((tests["censored"] == "none").sum())
    open_ended = tests[tests["censored"] != "none"]
    low, high = tests["amplitude_g"].min(), tests["amplitude_g"].max()
    headline = f"{known} of {len(tests)} simulated tests have an overturning amplitude"
    text = (
        f"The amplitude, the peak of the motion in the last run survived before the first "
        f"overturning, lies between {low:.2f} and {high:.2f} g."
    )
    if len(open_ended):
        names = ", ".join(open_ended["test"])
        text += f" Not overturned up to the largest amplitude: {names}."
    by_pedestal = int((tests["overturned_body"] == "pedestal").sum())
    text += (
        " It was always the object that fell, never the pedestal."
        if by_pedestal == 0
        else f" In {by_pedestal} tests the pedestal fell."
    )
    return Finding(headline, text)


def ratio_text(ratio: float, lower: float, upper: float) -> str:
    """A ratio with its interval: ``1.010 [0.990, 1.030]``."""
    return f"{ratio:.3f} [{lower:.3f}, {upper:.3f}]"


def pedestal_effect(effects: pd.DataFrame) -> Finding:
    """Say by what factor the pedestal changes the amplitude, over all pairs."""
    whole = effects[effects["scope"] == "whole"].set_index("reading")
    row = effects[(effects["scope"] == "whole") & (effects["reading"] == READING)].to_dict(
        "records"
    )[0]
    size = 100 * abs(row["ratio"] - 1)
    change = "raises" if row["ratio"] > 1 else "lowers"
    if row["lower"] <= 1 <= row["upper"]:
        headline = "The pedestal's mean effect cannot be told from none"
        if row["equivalent"]:
            headline = "In the ideal model the pedestal changes next to nothing"
    else:
        headline = f"The pedestal {change} the overturning amplitude by {size:.1f} %"
    text = (
        f"Amplitude with over amplitude without pedestal, geometric mean of {int(row['pairs'])} "
        f"pairs: {ratio_text(row['ratio'], row['lower'], row['upper'])} (95 % interval over "
        f"{int(row['units'])} {row['unit']}s)."
    )
    if row["equivalent"]:
        text += " A change of more than 10 % either way is excluded at the 5 % level."
    elif math.isfinite(row["detectable_ratio"]):
        text += (
            f" With this scatter, only changes of {100 * (row['detectable_ratio'] - 1):.0f} % or "
            "more would be detected with 80 % power."
        )
    others = [name for name in whole.index if name != READING]
    if others:
        parts = [
            f"{name.replace('_', ' ')} {ratio_text(*whole.loc[name, ['ratio', 'lower', 'upper']])}"
            for name in others
        ]
        text += f" Other readings of the same sweeps: {'; '.join(parts)}."
    return Finding(headline, text)


def pedestal_by_floor(effects: pd.DataFrame) -> Finding:
    """Say by what factor the pedestal changes the amplitude on each floor."""
    rows = effects[(effects["scope"] == "floor") & (effects["reading"] == READING)]
    parts = [
        f"{FLOOR_NAMES.get(row['level'], row['level'])} "
        f"{ratio_text(row['ratio'], row['lower'], row['upper'])}"
        for row in rows.to_dict("records")
    ]
    clear = rows[(rows["lower"] > 1) | (rows["upper"] < 1)]
    headline = (
        "On no floor is the pedestal's effect distinguishable from none"
        if clear.empty
        else f"The pedestal's effect shows on {len(clear)} of {len(rows)} floors"
    )
    return Finding(headline, f"Amplitude with over without pedestal: {'; '.join(parts)}.")


def slenderness_effect(tests: pd.DataFrame) -> Finding:
    """Say how the mean amplitude changes from object to object."""
    means = (
        tests.dropna(subset=["amplitude_g"])
        .groupby(["pedestal", "object"], sort=True)["amplitude_g"]
        .mean()
    )
    parts, falling = [], True
    for side, words in (("NP", "alone"), ("P", "on the pedestal")):
        if side in means.index.get_level_values(0):
            one = means[side]
            falling &= bool((np.diff(one.to_numpy()) < 0).all())
            listed = ", ".join(f"{object_name} {value:.3f} g" for object_name, value in one.items())
            parts.append(f"{words}: {listed}")
    headline = (
        "More slender objects overturn earlier, alone and on the pedestal"
        if falling
        else "The mean amplitude does not fall in the order of the objects"
    )
    return Finding(headline, f"Mean amplitude {'; '.join(parts)}.")


def model_allowed(validity: pd.DataFrame) -> Finding:
    """Say what friction the model needs, and whether a block would have jumped."""
    friction = validity["friction_demand"]
    jumps = int((validity["least_normal_force_n"] <= 0).sum())
    text = (
        f"Without sliding, half of the tests need a coefficient of friction above "
        f"{friction.median():.2f} somewhere and the most demanding one {friction.max():.2f}."
    )
    headline = "Pure rocking needs more friction than most surfaces have"
    if friction.median() < 0.6:
        headline = "Pure rocking needs friction that ordinary surfaces have"
    text += (
        " No block would have lifted off its support."
        if jumps == 0
        else f" In {jumps} tests a block would have lifted off."
    )
    return Finding(headline, text)


def readings_differ(tests: pd.DataFrame, windows: pd.DataFrame) -> Finding:
    """Say how often an object survives a stronger motion than one that overturned it."""
    with_windows = windows["windows"] > 0
    wide = tests.pivot_table(index="test", columns="reading", values="amplitude_g")
    text = (
        f"{int(with_windows.sum())} of {len(windows)} sweeps have amplitudes that are survived "
        "above one that overturns, so the amplitude found depends on how the laboratory raises it."
    )
    if {"first_overturning", "always_overturning"} <= set(wide.columns):
        both = wide[["first_overturning", "always_overturning"]].dropna()
        factor = float(np.exp(np.log(both.iloc[:, 1] / both.iloc[:, 0]).mean()))
        text += (
            " The amplitude above which every run overturns is on average "
            f"{factor:.2f} times that of the first overturning."
        )
    share = 100 * with_windows.mean()
    return Finding(f"{share:.0f} % of the sweeps have survival windows", text)


def printed_tables(comparison: pd.DataFrame) -> Finding:
    """Say how many printed values are reproduced."""
    known = comparison.dropna(subset=["agrees"])
    right = int(known["agrees"].sum())
    text = "Computed values are rounded to the digits printed in the thesis, with g = 9.81 m/s²."
    if right < len(known):
        wrong = known[~known["agrees"].astype(bool)]
        text += f" Different: {', '.join(wrong['name'] + ' ' + wrong['quantity'])}."
    return Finding(
        f"{right} of {len(known)} printed values of Tables 3.1, 3.3 and 4.1 come out", text
    )


def ledger(claims: pd.DataFrame) -> Finding:
    """Say how the thesis's statements fare."""
    counts = claims["verdict"].value_counts()
    parts = [
        f"{int(counts.get(verdict, 0))} {verdict}"
        for verdict in ("supported", "contradicted", "undecided")
    ]
    return Finding(
        f"Of {claims['number'].nunique()} statements tested, {parts[0]} and {parts[1]}",
        f"By simulation: {', '.join(parts)}. A statement about the laboratory's measurements is "
        "tested on the simulated counterparts; each verdict says on what it rests.",
    )
