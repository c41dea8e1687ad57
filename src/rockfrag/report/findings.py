"""What a study found, in sentences made of its tables; none is said that they do not support."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.report.part import Finding
from rockfrag.report.wording import (
    counted,
    decimals_of,
    estimate,
    estimates,
    has_interval,
    listed,
    number,
    of_all,
    sentence,
)
from rockfrag.shaketable.readings import READING

FRICTION = 0.6
"""Coefficient of friction of dry stone on stone, with which demands are compared [-]."""

_RATIO_DECIMALS = 3


_MOST_CONFIGURATIONS = 6
"""So many are named with their numbers in a sentence."""


def strength_found(curves: pd.DataFrame, level: str) -> Finding | None:
    """Say at which peak half of the motions overturn each configuration; None without a curve.

    Parameters
    ----------
    curves
        Rows of :func:`rockfrag.fragility.fragility_table` with a median, of any measures and readings. Where the
        lognormal curve is rejected the median of the curve without a form is told.
    level
        Level of the intervals in words, such as ``90 %``.
    """
    if curves.empty:
        return None
    rows = curves[
        (curves["im"] == curves["im"].iloc[0]) & (curves["estimator"] == "mean_probability")
    ]
    if rows.empty:
        return None
    measure, unit = rows["im"].iloc[0], rows["unit"].iloc[0]
    rejected = (rows["p_fit"] < REJECTED) & rows["theta_isotonic"].notna()
    for name in ("theta", "theta_lower", "theta_upper"):
        without_form = rows[name.replace("theta", "theta_isotonic")]
        rows = rows.assign(**{name: rows[name].mask(rejected, without_form)})
    decimals = min(max(decimals_of(value, 2) for value in rows["theta"]), 3)
    texts = estimates(rows, ("theta", "theta_lower", "theta_upper"), decimals)
    named = [f"{name} {text}" for name, text in zip(rows["configuration"], texts, strict=True)]
    low, high = (
        rows.loc[rows["theta"].idxmin()].to_dict(),
        rows.loc[rows["theta"].idxmax()].to_dict(),
    )
    one = len(rows) == 1 or number(low["theta"], decimals) == number(high["theta"], decimals)
    span = (
        f"{number(low['theta'], decimals)} {unit}"
        if one
        else f"{number(low['theta'], decimals)} ({low['configuration']}) to "
        f"{number(high['theta'], decimals)} {unit} ({high['configuration']})"
    )
    shown = named[:_MOST_CONFIGURATIONS]
    rest = f" and {len(named) - len(shown)} more in the table" if len(shown) < len(named) else ""
    sure = f", with {level} intervals" if any("[" in text for text in texts) else ""
    return Finding(
        f"It takes a {measure} of {span} to overturn in half of the cases",
        f"Medians{sure}: {', '.join(shown)}{rest} {unit}.{_formless(rows, rejected)}",
    )


def _formless(rows: pd.DataFrame, rejected: pd.Series) -> str:
    """Whose median is that of a curve without a form, as the lognormal one does not describe the tests."""
    if not rejected.any():
        return ""
    if rejected.all():
        return (
            " No lognormal curve describes the tests: these are medians of curves without a form."
        )
    names = listed(rows.loc[rejected, "configuration"].tolist())
    return (
        f" For {names} a lognormal curve does not describe the tests: the median is that of a curve without "
        "a form."
    )


def recorded_found(recorded: pd.DataFrame) -> Finding:
    """Say what the motions as recorded overturn, and how much that depends on their exact strength.

    Parameters
    ----------
    recorded
        As :func:`rockfrag.stages.sweep.as_recorded` returns it, of every configuration.
    """
    cases, fallen = len(recorded), int(recorded["overturned"].sum())
    near = int(recorded["share_near"].between(0, 1, inclusive="neither").sum())
    by_name = recorded.groupby("configuration", sort=False)["overturned"].agg(["sum", "size"])
    motions = int(by_name["size"].max())
    if fallen in (0, cases):
        what = "overturns nothing" if fallen == 0 else "overturns everything"
        headline = f"In a repeat {'the one motion' if motions == 1 else f'each of {motions} motions'} {what}"
    elif len(by_name) <= _MOST_CONFIGURATIONS:
        each = [f"{name} under {row['sum']}" for name, row in by_name.iterrows()]
        fall = "falls" if fallen == 1 else "fall"
        headline = f"In a repeat of {counted(motions, 'motion')} there {fall} {listed(each)}"
    else:
        headline = (
            f"In a repeat of the motions as recorded {of_all(fallen, cases, 'case')} overturn"
        )
    sure = (
        "None of these verdicts is another if the shaking is a tenth weaker or stronger."
        if near == 0
        else f"{sentence(of_all(near, cases, 'verdict'))} {'depends' if near == 1 else 'depend'} on the exact "
        "strength: within a tenth of it there are amplitudes that overturn and others that are survived."
    )
    return Finding(headline, sure)


def amplitudes_found(tests: pd.DataFrame) -> Finding:
    """Say how many tests have an amplitude, why the others have none, and what fell."""
    known = tests[tests["amplitude_g"].notna()]
    first = tests[tests["amplitude_g"].isna() & tests["upper_g"].notna()]
    never = tests[tests["amplitude_g"].isna() & tests["upper_g"].isna()]
    if len(known):
        share = of_all(len(known), len(tests), "simulated test")
        verb = "has" if len(known) == 1 else "have"
        headline = f"{sentence(share)} {verb} an overturning amplitude"
        low, high = number(known["amplitude_g"].min(), 2), number(known["amplitude_g"].max(), 2)
        span = f"is {low} g" if low == high else f"lies between {low} and {high} g"
        words = [
            "The amplitude, the peak of the motion in the last run survived before the first "
            f"overturning, {span}."
        ]
    elif len(never) == len(tests):
        headline = "Nothing overturned"
        words = []
    else:
        headline = "No test has an overturning amplitude"
        words = []
    if len(never):
        highest = tests["lower_g"].max()
        words.append(
            f"Not overturned, up to {number(highest, 2)} g at most: {listed(list(never['test']))}."
        )
    if len(first):
        words.append(f"Overturned at the first step already: {listed(list(first['test']))}.")
    words += _fallen(tests)
    return Finding(headline, " ".join(words))


def _fallen(tests: pd.DataFrame) -> list[str]:
    """Say whether objects or pedestals fell, where something stood on a pedestal."""
    on_pedestal = tests[(tests["pedestal"] == "P") & (tests["overturned_body"] != "")]
    if on_pedestal.empty:
        return []
    pedestals = int((on_pedestal["overturned_body"] == "pedestal").sum())
    if pedestals == 0:
        return ["It was always the object that fell, never the pedestal."]
    falls = of_all(pedestals, len(on_pedestal), "test on a pedestal", "tests on a pedestal")
    return [f"In {falls} that overturned it was the pedestal that fell."]


def objects_compared(means: pd.DataFrame, slenderness: Mapping[str, float]) -> list[Finding]:
    """Say whether more slender objects overturn earlier, where there are two of them or more."""
    rows = means[(means["by"] == "configuration") & means["mean_g"].notna()]
    parts, falling, most = [], [], 0
    for side, words in (("NP", "alone"), ("P", "on a pedestal")):
        own = rows[rows["pedestal"] == side]
        own = own.assign(slenderness=own["object"].map(slenderness))
        own = own.sort_values("slenderness", kind="stable")
        if own["slenderness"].nunique() < 2:
            continue
        each = listed(
            [
                f"{row['configuration']} {number(row['mean_g'], 3)} g"
                for row in own.to_dict("records")
            ]
        )
        parts.append(f"{words} {each}")
        falling.append(bool((np.diff(own["mean_g"].to_numpy(dtype=float)) < 0).all()))
        most = max(most, int(own["motions"].max()))
    if not parts:
        return []
    headline = (
        "More slender objects overturn earlier"
        if all(falling)
        else "Overturning does not simply follow slenderness"
    )
    text = (
        f"Geometric mean amplitude, in the order of slenderness, over "
        f"{counted(most, 'motion')} that overturned all of them: {'; '.join(parts)}."
    )
    return [Finding(headline, text)]


def mean_sentence(means: pd.DataFrame) -> str:
    """Say over which motions means are taken, and which had to be left out."""
    rows = means[means["by"] == "configuration"]
    most, of = int(rows["motions"].max()), int(rows["of"].max())
    if most == of:
        every = "the one motion" if of == 1 else f"all {of} motions"
        return f"Means are over {every}, each of which overturned everything compared."
    if most == 0:
        return (
            f"None of the {of} motions overturned everything compared, so no means are compared."
            if of > 1
            else "The one motion did not overturn everything compared, so no means are compared."
        )
    return (
        f"Means are over the {counted(most, 'motion')} of {of} that overturned everything compared; "
        "the others give bounds only."
    )


def windows_found(windows: pd.DataFrame, tests: pd.DataFrame) -> Finding:
    """Say how often an object survives a stronger motion than one that overturned it."""
    fallen = windows[windows["first_upper"].notna()]
    with_windows = int((fallen["windows"] > 0).sum())
    if fallen.empty:
        return Finding(
            "No sweep overturns",
            "So there is no amplitude above which survival could be asked for.",
        )
    share = of_all(with_windows, len(fallen), "overturning sweep")
    verb = "has" if with_windows == 1 or len(fallen) == 1 else "have"
    headline = f"{sentence(share)} {verb} survival windows"
    if with_windows == 0:
        return Finding(
            "No sweep has survival windows",
            "Above the first overturning amplitude everything overturned.",
        )
    text = (
        "There are amplitudes that are survived above one that overturns, so the amplitude found "
        "depends on how it is raised."
    )
    wide = tests.pivot_table(index="test", columns="reading", values="amplitude_g")
    if {"first_overturning", "always_overturning"} <= set(wide.columns):
        both = wide[["first_overturning", "always_overturning"]].dropna()
        if len(both):
            factor = float(np.exp(np.log(both.iloc[:, 1] / both.iloc[:, 0]).mean()))
            text += (
                " The amplitude above which every run overturns is in the geometric mean "
                f"{factor:.2f} times that of the first overturning "
                f"({of_all(len(both), len(fallen), 'sweep')} in which both are known)."
            )
    return Finding(headline, text)


def ratio_text(row: Mapping[Any, Any]) -> str:
    """A ratio with its interval: ``1.010 [0.990, 1.030]``."""
    return estimate(row["ratio"], row["lower"], row["upper"], _RATIO_DECIMALS)


def ratio_of(effects: pd.DataFrame) -> Callable[[str, str], str]:
    """Return a function of scope and level that words the ratio P/NP there."""
    rows = effects[effects["reading"] == READING] if len(effects) else effects

    def text(scope: str, level: str) -> str:
        found = rows[(rows["scope"] == scope) & (rows["level"] == level)] if len(rows) else rows
        if found.empty:
            return "no pair with both amplitudes known"
        row = found.to_dict("records")[0]
        return f"P/NP {estimate(row['ratio'], row['lower'], row['upper'], 2)}"

    return text


def pedestal_effect(effects: pd.DataFrame) -> list[Finding]:
    """Say by what factor the pedestal changes the amplitude, over all pairs and on each floor."""
    whole = effects[effects["scope"] == "whole"]
    here = whole[whole["reading"] == READING]
    if here.empty:
        return [
            Finding(
                "The pedestal's effect is not known",
                "No object overturned both with and without its pedestal under the same motion.",
            )
        ]
    row = here.to_dict("records")[0]
    words = (_ratio_sentence(row), _meaning(row), _steps(row))
    found = [Finding(_headline(row), " ".join(word for word in words if word))]
    others = whole[whole["reading"] != READING].to_dict("records")
    if others:
        listing = "; ".join(
            f"{str(one['reading']).replace('_', ' ')} {ratio_text(one)} "
            f"({counted(int(one['pairs']), 'pair')})"
            for one in others
        )
        found[0] = Finding(
            found[0].headline, f"{found[0].text} Other readings of the same sweeps: {listing}."
        )
    floors = effects[(effects["scope"] == "floor") & (effects["reading"] == READING)]
    return [*found, *_by_floor(floors)]


def _headline(row: Mapping[Any, Any]) -> str:
    change = "raises" if row["ratio"] > 1 else "lowers"
    size = number(100 * abs(row["ratio"] - 1), 1)
    if not has_interval(row["lower"], row["upper"], _RATIO_DECIMALS):
        if size == "0.0":
            return "With and without pedestal the amplitudes are the same"
        return f"In {counted(int(row['pairs']), 'pair')} the pedestal {change} the amplitude by {size} %"
    if row["lower"] <= 1 <= row["upper"]:
        if row["equivalent"]:
            return "The pedestal changes the overturning amplitude by less than 10 %"
        return "The pedestal's mean effect cannot be told from none"
    return f"The pedestal {change} the overturning amplitude by {size} %"


def _ratio_sentence(row: Mapping[Any, Any]) -> str:
    pairs, units = int(row["pairs"]), counted(int(row["units"]), str(row["unit"]))
    bounds = int(row["at_bound"])
    text = (
        "Amplitude with over amplitude without pedestal"
        + (f", geometric mean of {pairs} pairs" if pairs > 1 else ", of the one pair")
        + (f", {bounds} of which with one test that gives a bound only" if bounds else "")
        + f": {ratio_text(row)}"
    )
    if has_interval(row["lower"], row["upper"], _RATIO_DECIMALS):
        return f"{text} (95 % interval over {units})."
    if int(row["units"]) < 2:
        return f"{text}; from {units} there is no interval."
    return (
        f"{text}, the same over {units}: the steps of the amplitudes show no scatter, "
        "so there is no interval."
    )


def _steps(row: Mapping[Any, Any]) -> str:
    """What the steps of the amplitudes leave open, where pairs overturned in the same step."""
    tied, pairs = int(row["tied"]), int(row["pairs"])
    if tied == 0 or not row["resolution_ratio"] > 1:
        return ""
    return (
        f"{sentence(of_all(tied, pairs, 'pair'))} overturned in the same step; effects below "
        f"{100 * (row['resolution_ratio'] - 1):.1f} % are hidden by the steps."
    )


def _meaning(row: Mapping[Any, Any]) -> str:
    if not has_interval(row["lower"], row["upper"], _RATIO_DECIMALS):
        return ""
    if row["equivalent"]:
        return "A change of more than 10 % either way is excluded at the 5 % level."
    detectable = row["detectable_ratio"]
    if row["lower"] <= 1 <= row["upper"] and math.isfinite(detectable) and detectable > 1.0005:
        return (
            f"With this scatter, only changes of {100 * (detectable - 1):.0f} % or more would be "
            "found with 80 % power."
        )
    return ""


def _by_floor(rows: pd.DataFrame) -> list[Finding]:
    if len(rows) < 2:
        return []
    parts = [f"{row['level']} {ratio_text(row)}" for row in rows.to_dict("records")]
    text = f"Amplitude with over without pedestal: {'; '.join(parts)}."
    known = np.array(
        [
            has_interval(low, high, _RATIO_DECIMALS)
            for low, high in rows[["lower", "upper"]].to_numpy(dtype=float)
        ]
    )
    clear = rows[known & ((rows["lower"] > 1) | (rows["upper"] < 1))]
    if not known.any():
        return [Finding("By floor there are ratios without intervals", text)]
    headline = (
        "On no floor is the pedestal's effect distinguishable from none"
        if clear.empty
        else f"The pedestal's effect shows on {of_all(len(clear), len(rows), 'floor')}"
    )
    return [Finding(headline, text)]


def model_allowed(validity: pd.DataFrame) -> list[Finding]:
    """Say how much friction rocking without sliding needs, and whether a block would have jumped."""
    if validity.empty:
        return []
    demand = validity["friction_demand"].to_numpy(dtype=float)
    lifted = int((validity["least_normal_force_n"] <= 0).sum())
    tests = len(validity)
    enough = int((demand <= FRICTION).sum())
    known = demand[np.isfinite(demand)]
    headline = (
        f"With a coefficient of friction of {FRICTION:g}, {of_all(enough, tests, 'test')} would "
        "rock without sliding"
    )
    words = []
    if known.size > 1:
        words.append(
            f"The coefficient needed lies between {known.min():.2f} and {known.max():.2f}, "
            f"with a median of {np.median(known):.2f}."
        )
    elif known.size == 1:
        words.append(f"The coefficient needed is {known[0]:.2f}.")
    if known.size < tests:
        words.append(f"In {of_all(tests - known.size, tests, 'test')} no friction would be enough.")
    words.append(
        "No block would have lifted off its support."
        if lifted == 0
        else f"In {of_all(lifted, tests, 'test')} a block would have lifted off."
    )
    return [Finding(headline, " ".join(words))]


def sliding_found(sliding: pd.DataFrame) -> Finding:
    """Say in how many cases bodies slid and flew, how far, and how many verdicts that changed.

    Parameters
    ----------
    sliding
        As :func:`rockfrag.stages.validity.sliding_table` returns it.
    """
    cases, slid, flew, saved, felled = (
        int(sliding[name].sum()) for name in ("cases", "slid", "flew", "saved", "felled")
    )
    if slid == flew == 0:
        return Finding(
            "Nothing slides or flies",
            f"In none of {counted(cases, 'case')} friction is asked for more than there is, so everything rocks "
            "as on surfaces that hold.",
        )
    where = max(sliding.to_dict("records"), key=lambda one: float(one["largest_slip_m"]))
    words = [
        f"The largest slip is {number(100 * where['largest_slip_m'], 1)} cm ({where['configuration']}); "
        + ("nothing flies." if flew == 0 else f"bodies fly in {of_all(flew, cases, 'case')}.")
    ]
    if saved == felled == 0:
        words.append("No verdict is another than that of surfaces that hold.")
    else:
        words.append(
            "Sliding and flight save what would overturn on surfaces that hold in "
            f"{of_all(saved, cases, 'case')}, and overturn what would stand in {of_all(felled, cases, 'case')}."
        )
    return Finding(f"Bodies slide in {of_all(slid, cases, 'case')}", " ".join(words))
