"""What a study found, in sentences made of its tables; none is said that they do not support."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.fragility.compared import Compared, compared_curves
from rockfrag.report.part import Finding
from rockfrag.report.sides import WITH_PEDESTAL, Sides
from rockfrag.report.wording import (
    agree,
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
from rockfrag.shaketable.definitions import DEFINITION

FRICTION = 0.6
"""Coefficient of friction of dry stone on stone, with which demands are compared [-]."""

_RATIO_DECIMALS = 3


_MOST_CONFIGURATIONS = 6
"""So many are named with their numbers in a sentence."""


def strength_found(curves: pd.DataFrame, level: str) -> Finding | None:
    """Say at which peak each configuration overturns with a probability of one half; None without a curve."""
    if curves.empty:
        return None
    found = headline_curves(curves)
    rows = found.rows[found.rows["theta"].notna()]
    if rows.empty:
        return None
    measure, unit = rows["im"].iloc[0], rows["unit"].iloc[0]
    decimals = min(max(decimals_of(value, 2) for value in rows["theta"]), 3)
    texts = estimates(rows, "theta", decimals)
    named = [f"{name} {text}" for name, text in zip(rows["configuration"], texts, strict=True)]
    printed = [number(value, decimals) for value in rows["theta"]]
    least, most = (
        printed[int(place)] for place in (rows["theta"].argmin(), rows["theta"].argmax())
    )
    # what differs in no digit that is shown is named together
    low, high = (
        [name for name, text in zip(rows["configuration"], printed, strict=True) if text == end]
        for end in (least, most)
    )
    are, them = ("is", "it") if len(low) == 1 else ("are", "them")
    headline = (
        f"A {measure} of {least} {unit} overturns {listed(low)} with 50 % probability"
        if least == most
        else f"{listed(low)} {are} the most fragile: a {measure} of {least} {unit} overturns {them} with 50 % "
        f"probability, while {listed(high)} {'needs' if len(high) == 1 else 'need'} {most} {unit}"
    )
    shown = named[:_MOST_CONFIGURATIONS]
    rest = f" and {len(named) - len(shown)} more in the table" if len(shown) < len(named) else ""
    sure = f" with {level} intervals" if any("[" in text for text in texts) else ""
    estimator = (
        f"All are medians of nonparametric (monotone) curves, because a lognormal curve is rejected for "
        f"{listed(found.rejected)}."
        if found.nonparametric
        else "All are medians of lognormal curves."
    )
    return Finding(headline, "", f"Medians{sure}, in {unit}: {', '.join(shown)}{rest}. {estimator}")


def headline_curves(curves: pd.DataFrame) -> Compared:
    """Curves that the first page compares: of the first measure, all outcomes counted, by one estimator."""
    first = curves["im"] == (curves["im"].iloc[0] if len(curves) else "")
    known = curves[first & (curves["estimator"] == "mean_probability") & curves["theta"].notna()]
    return compared_curves(known)


ONE_MOTION = Finding(
    "One motion: no fragility can be given",
    "A fragility needs the motions of several earthquakes; one of them says nothing about how much they differ.",
)
"""Said in place of curves where a study has a single record."""


def recorded_found(recorded: pd.DataFrame) -> Finding:
    """Say what the motions as recorded overturn, and how much that depends on their exact strength."""
    analyses, fallen = len(recorded), int(recorded["overturned"].sum())
    near = int(recorded["fraction_near"].between(0, 1, inclusive="neither").sum())
    by_name = recorded.groupby("configuration", sort=False)["overturned"].agg(["sum", "size"])
    motions = int(by_name["size"].max())
    subject = "the only motion" if motions == 1 else f"all {motions} motions"
    each = [f"{name} {row['sum']}" for name, row in by_name.iterrows()]
    numbers = f"Motions that overturn, of {motions}: {', '.join(each)}." if motions > 1 else ""
    if fallen in (0, analyses):
        what = "nothing" if fallen == 0 else "everything"
        verb = "overturns" if motions == 1 else "overturn"
        who = subject if fallen else subject.replace("all ", "the ")
        headline, numbers = f"At recorded strength {who} {verb} {what}", ""
    elif len(by_name) == 1:
        headline = f"At recorded strength {_overturn(fallen, motions)} {by_name.index[0]}"
        numbers = ""
    elif motions == 1:
        fell = by_name["sum"] > 0
        here, not_here = (listed([str(name) for name in by_name.index[it]]) for it in (fell, ~fell))
        headline = f"At recorded strength {subject} overturns {here}, and not {not_here}"
    else:
        counts = {str(name): int(n) for name, n in by_name["sum"].items()}
        low, high = min(counts, key=counts.__getitem__), max(counts, key=counts.__getitem__)
        least, most = counts[low], counts[high]
        headline = (
            f"At recorded strength {_overturn(least, motions)} each object"
            if least == most
            else f"At recorded strength {least} ({low}) to {most} ({high}) of {motions} motions overturn the "
            f"object"
        )
    if len(by_name) > _MOST_CONFIGURATIONS:
        numbers = (
            f"{sentence(of_all(fallen, analyses, 'analysis', 'analyses'))} end in overturning."
        )
    sure = (
        "No outcome changes if the motion is scaled by anything within ±10 %."
        if near == 0
        else f"{sentence(of_all(near, analyses, 'outcome'))} {agree(near, analyses, 'flips', 'flip')} if "
        "the motion is scaled within ±10 %."
    )
    return Finding(headline, sure, numbers)


def _overturn(n: int, motions: int) -> str:
    return f"{of_all(n, motions, 'motion')} {agree(n, motions, 'overturns', 'overturn')}"


def amplitudes_found(tests: pd.DataFrame) -> Finding:
    """Say how many tests overturn, at which amplitudes, and what fell."""
    known = tests[tests["amplitude_g"].notna()]
    first = tests[tests["amplitude_g"].isna() & tests["upper_g"].notna()]
    never = tests[tests["amplitude_g"].isna() & tests["upper_g"].isna()]
    fallen = len(known) + len(first)
    headline = "No simulated test overturns"
    if fallen:
        verb = agree(fallen, len(tests), "overturns", "overturn")
        headline = f"{sentence(of_all(fallen, len(tests), 'simulated test'))} {verb}"
    words = []
    if len(known):
        low, high = number(known["amplitude_g"].min(), 2), number(known["amplitude_g"].max(), 2)
        headline += f", at {low} g" if low == high else f", at {low} to {high} g"
        words.append("The amplitude is the largest peak survived before the first overturning.")
    elif fallen:
        headline += ", at the first step"
    if len(never):
        highest = tests["lower_g"].max()
        words.append(
            f"Not overturned by up to {number(highest, 2)} g: {listed(list(never['test']))}."
        )
    if len(first):
        words.append(
            f"Overturned at the first step, so that only an upper bound is known: {listed(list(first['test']))}."
        )
    words += _fallen(tests)
    return Finding(headline, "", " ".join(words))


def _fallen(tests: pd.DataFrame) -> list[str]:
    """Say whether objects or pedestals fell, where something stood on a pedestal."""
    on_pedestal = tests[(tests["pedestal"] == "P") & (tests["overturned_body"] != "")]
    if on_pedestal.empty:
        return []
    itself = on_pedestal["overturned_body"].isin(["statue"]) | (
        on_pedestal["overturned_body"] == on_pedestal["object"]
    )
    below = int((~itself).sum())
    if below == 0:
        return ["The object always fell, never what it stood on."]
    falls = of_all(below, len(on_pedestal), "test on a pedestal", "tests on a pedestal")
    return [f"What the object stood on fell first in {falls} that overturned."]


def objects_compared(means: pd.DataFrame, slenderness: Mapping[str, float]) -> list[Finding]:
    """Say whether more slender objects overturn at lower amplitudes, where there are two of them or more."""
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
        "More slender objects overturn at lower amplitudes"
        if all(falling)
        else "The overturning amplitude does not simply follow slenderness"
    )
    numbers = (
        f"Geometric mean amplitudes over the {counted(most, 'motion')} that overturned all of them, by increasing "
        f"slenderness: {'; '.join(parts)}."
    )
    return [Finding(headline, "", numbers)]


def mean_sentence(means: pd.DataFrame) -> str:
    """Say over which motions means are taken, and which had to be left out."""
    rows = means[means["by"] == "configuration"]
    most, of = int(rows["motions"].max()), int(rows["of"].max())
    if most == of:
        every = "the only motion" if of == 1 else f"all {of} motions"
        return f"Means are over {every}, each of which overturned everything compared."
    if most == 0:
        return (
            f"None of the {of} motions overturned everything compared, so no means are compared."
            if of > 1
            else "The only motion did not overturn everything compared, so no means are compared."
        )
    return (
        f"Means are over the {counted(most, 'motion')} of {of} that overturned everything compared; "
        "the others give bounds only."
    )


def resurrections_found(resurrections: pd.DataFrame, tests: pd.DataFrame) -> Finding:
    """Say how often an object survives a stronger motion than one that overturned it."""
    fallen = resurrections[resurrections["first_upper"].notna()]
    with_resurrections = int((fallen["resurrections"] > 0).sum())
    if fallen.empty:
        return Finding("Nothing overturns, so no stronger motion can be survived")
    if with_resurrections == 0:
        return Finding("Every motion stronger than the first that overturned also overturns")
    fraction = of_all(with_resurrections, len(fallen), "analysis", "analyses")
    survived = "the object survives a stronger motion than one that overturned it"
    headline = f"Non-monotone response: in {fraction} {survived}"
    text = "The overturning amplitude therefore depends on how the motion is raised."
    wide = tests.pivot_table(index="test", columns="definition", values="amplitude_g")
    if not {"first_overturning", "always_overturning"} <= set(wide.columns):
        return Finding(headline, text)
    both = wide[["first_overturning", "always_overturning"]].dropna()
    if both.empty:
        return Finding(headline, text)
    factor = float(np.exp(np.log(both.iloc[:, 1] / both.iloc[:, 0]).mean()))
    numbers = (
        f"The amplitude above which every run overturns is on average {factor:.2f} times that of the first "
        f"overturning (geometric mean of {of_all(len(both), len(fallen), 'analysis', 'analyses')} in which both "
        "are known)."
    )
    return Finding(headline, text, numbers)


def ratio_text(row: Mapping[Any, Any]) -> str:
    """A ratio with its interval: ``1.010 [0.990, 1.030]``."""
    return estimate(row["ratio"], row["lower"], row["upper"], _RATIO_DECIMALS)


def ratio_of(effects: pd.DataFrame, about: Sides = WITH_PEDESTAL) -> Callable[[str, str], str]:
    """Return a function of scope and level that words the ratio of amplitudes there."""
    rows = effects[effects["definition"] == DEFINITION] if len(effects) else effects

    def text(scope: str, level: str) -> str:
        found = rows[(rows["scope"] == scope) & (rows["level"] == level)] if len(rows) else rows
        if found.empty:
            return "no pair with both amplitudes known"
        row = found.to_dict("records")[0]
        return f"{about.ratio} {estimate(row['ratio'], row['lower'], row['upper'], 2)}"

    return text


def pedestal_effect(effects: pd.DataFrame, about: Sides = WITH_PEDESTAL) -> list[Finding]:
    """Say by what factor what is compared changes the amplitude, over all pairs and on each floor."""
    whole = effects[effects["scope"] == "whole"]
    here = whole[whole["definition"] == DEFINITION]
    if here.empty:
        return [
            Finding(
                f"The effect of {about.change} is not known",
                f"No object overturned both {about.both} under the same motion.",
            )
        ]
    row = here.to_dict("records")[0]
    numbers = [_ratio_sentence(row, about), _steps(row)]
    others = whole[whole["definition"] != DEFINITION].to_dict("records")
    if others:
        listing = "; ".join(
            f"{str(other['definition']).replace('_', ' ')} {ratio_text(other)} "
            f"({counted(int(other['pairs']), 'pair')})"
            for other in others
        )
        numbers.append(f"Other ways to read the amplitude: {listing}.")
    floors = effects[(effects["scope"] == "floor") & (effects["definition"] == DEFINITION)]
    found = Finding(
        _headline(row, about), _meaning(row), " ".join(word for word in numbers if word)
    )
    return [found, *_by_floor(floors, about)]


def _headline(row: Mapping[Any, Any], about: Sides) -> str:
    change_of = sentence(about.change)
    change = "raises" if row["ratio"] > 1 else "lowers"
    size = number(100 * abs(row["ratio"] - 1), 1)
    if not has_interval(row["lower"], row["upper"], _RATIO_DECIMALS):
        if size == "0.0":
            return f"The amplitudes {about.both} are the same"
        return f"{change_of} {change} the amplitude by {size} % in {counted(int(row['pairs']), 'pair')}"
    if row["lower"] <= 1 <= row["upper"]:
        if row["equivalent"]:
            return f"{change_of} changes the overturning amplitude by less than 10 %"
        return f"The mean effect of {about.change} is not distinguishable from zero"
    return f"{change_of} {change} the overturning amplitude by {size} %"


def _ratio_sentence(row: Mapping[Any, Any], about: Sides) -> str:
    pairs, units = int(row["pairs"]), counted(int(row["units"]), UNIT[str(row["unit"])])
    bounds = int(row["at_bound"])
    text = (
        about.divided
        + (f", geometric mean of {pairs} pairs" if pairs > 1 else ", of the only pair")
        + (f", {bounds} of which have one test that gives a bound only" if bounds else "")
        + f": {ratio_text(row)}"
    )
    if has_interval(row["lower"], row["upper"], _RATIO_DECIMALS):
        return f"{text} (95 % interval over {units})."
    if int(row["units"]) < 2:
        return f"{text}; from {units} there is no interval."
    return f"{text}, the same for {units}: the steps of the amplitudes show no scatter, so there is no interval."


def _steps(row: Mapping[Any, Any]) -> str:
    """What the steps of the amplitudes leave open, where pairs overturned in the same step."""
    tied, pairs = int(row["tied"]), int(row["pairs"])
    if tied == 0 or not row["resolution_ratio"] > 1:
        return ""
    return (
        f"{sentence(of_all(tied, pairs, 'pair'))} overturned in the same step; the steps hide "
        f"effects below {100 * (row['resolution_ratio'] - 1):.1f} %."
    )


def _meaning(row: Mapping[Any, Any]) -> str:
    if not has_interval(row["lower"], row["upper"], _RATIO_DECIMALS):
        return ""
    if row["equivalent"]:
        return "A change of 10 % or more is excluded (5 % level)."
    detectable = row["detectable_ratio"]
    if row["lower"] <= 1 <= row["upper"] and math.isfinite(detectable) and detectable > 1.0005:
        return (
            f"With this scatter only changes of {100 * (detectable - 1):.0f} % or more can be detected "
            "(80 % power)."
        )
    return ""


def _by_floor(rows: pd.DataFrame, about: Sides) -> list[Finding]:
    if len(rows) < 2:
        return []
    parts = [f"{row['level']} {ratio_text(row)}" for row in rows.to_dict("records")]
    numbers = f"{about.divided}: {'; '.join(parts)}."
    known = np.array(
        [
            has_interval(low, high, _RATIO_DECIMALS)
            for low, high in rows[["lower", "upper"]].to_numpy(dtype=float)
        ]
    )
    clear = rows[known & ((rows["lower"] > 1) | (rows["upper"] < 1))]
    if not known.any():
        return [Finding("The ratios by floor have no intervals", "", numbers)]
    headline = (
        f"The effect of {about.change} is not distinguishable from zero on any floor"
        if clear.empty
        else f"{sentence(about.change)} has an effect on {of_all(len(clear), len(rows), 'floor')}"
    )
    return [Finding(headline, "", numbers)]


def model_allowed(validity: pd.DataFrame) -> list[Finding]:
    """Say how much friction rocking without sliding needs, and whether a block would have jumped."""
    if validity.empty:
        return []
    tests = len(validity)
    lifted = int((validity["least_normal_force_n"] <= 0).sum())
    beyond = int((~np.isfinite(validity["friction_demand"].astype(float))).sum())
    words = [f"Friction coefficient needed: {'; '.join(_demands(validity))}."]
    if beyond:
        words.append(f"No friction would be enough in {of_all(beyond, tests, 'test')}.")
    words.append(
        "No block would have lifted off its support."
        if lifted == 0
        else f"A block would have lifted off in {of_all(lifted, tests, 'test')}."
    )
    return [Finding(friction_sentence(validity), "", " ".join(words))]


_WHERE = {"P": "with the pedestal", "NP": "without"}


def _sides(validity: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """Tests by side, where both sides were tested."""
    sides = {side: validity[validity["pedestal"] == side] for side in _WHERE}
    return {} if any(part.empty for part in sides.values()) else sides


def friction_sentence(validity: pd.DataFrame) -> str:
    """Say how many tests need more friction than dry stone has, with and without a pedestal; no full stop."""

    def beyond(part: pd.DataFrame) -> int:
        return int((~(part["friction_demand"].astype(float) <= FRICTION)).sum())

    sides = _sides(validity)
    needs = f"a friction coefficient above {FRICTION:g}"
    if not sides:
        n = beyond(validity)
        verb = agree(n, len(validity), "requires", "require")
        return f"{sentence(of_all(n, len(validity), 'test'))} {verb} {needs}"
    each = [
        f"{of_all(beyond(part), len(part), 'test')} {_WHERE[side]}" for side, part in sides.items()
    ]
    verb = agree(beyond(sides["P"]), len(sides["P"]), "requires", "require")
    return f"{sentence(each[0])} {verb} {needs}, and {each[1]}"


def _demands(validity: pd.DataFrame) -> list[str]:
    """Range and median of the friction needed, with and without a pedestal where both were tested."""
    parts = {_WHERE[side]: part for side, part in _sides(validity).items()} or {"": validity}
    words = []
    for where, part in parts.items():
        demand = part["friction_demand"].to_numpy(dtype=float)
        known = demand[np.isfinite(demand)]
        if known.size == 0:
            continue
        span = f"{known.min():.2f} to {known.max():.2f} (median {np.median(known):.2f})"
        words.append(f"{where} {span if known.size > 1 else f'{known[0]:.2f}'}".strip())
    return words or ["none known"]


UNIT = {"earthquake": "earthquake", "motion": "motion", "floor": "floor"}
"""Words for what an interval is taken over."""


def sliding_found(sliding: pd.DataFrame) -> Finding:
    """Say in how many analyses bodies slid and flew, how far, and how many outcomes that changed."""
    cases, slid, flew, saved, felled = (
        int(sliding[name].sum()) for name in ("cases", "slid", "flew", "saved", "felled")
    )
    if slid == flew == 0:
        return Finding(
            "Nothing slides or flies",
            f"The friction needed never exceeds the friction available in "
            f"{counted(cases, 'analysis', 'analyses')}.",
        )
    where = max(sliding.to_dict("records"), key=lambda row: float(row["largest_slip_m"]))
    words = [
        f"The largest slip is {number(100 * where['largest_slip_m'], 1)} cm ({where['configuration']}); "
        + ("nothing flies." if flew == 0 else f"bodies fly in {_analyses(flew, cases)}.")
    ]
    if saved == felled == 0:
        text = "Sliding changes no outcome."
    else:
        text = (
            f"Sliding and flight prevent overturning in {_analyses(saved, cases)} and cause it in "
            f"{_analyses(felled, cases)}."
        )
    return Finding(f"Bodies slide in {_analyses(slid, cases)}", text, " ".join(words))


def _analyses(n: int, total: int) -> str:
    return of_all(n, total, "analysis", "analyses")
