"""Findings of a study, in words that follow from its tables.

In: tables of the results of a study, as its stages write them. Out: a :class:`rockfrag.report.part.Finding` each,
with headline, text and numbers; a sentence is said only where the numbers support it.

Docs: ``docs/report.md``, "How it is told"; theory of what is said: ``docs/fragility.md`` and ``docs/pedestal.md``.
"""

import math
import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from rockfrag.fragility.curve_facts import Compared, compared_curves
from rockfrag.report.part import Finding
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag.study.scaling import LARGEST_FACTOR
from rockfrag.study.study import Study
from rockfrag.words import sentences as wording
from rockfrag.words.sentences import agree, counted, listed, number, of_all, sentence

# coefficient of friction of dry stone on stone, with which demands are compared [-]
FRICTION = 0.6

MOST_CONFIGURATIONS = 6  # so many are named with their numbers in a sentence
_RATIO_DECIMALS = 3
_LEAST_DETECTABLE = 1.0005  # ratio above which a detectable change is worth a sentence


class Sides(NamedTuple):
    """Two sides of a comparison."""

    change: str = "the pedestal"  # Subject of a sentence about what the difference does
    ratio: str = "with/without pedestal"  # The ratio of amplitudes
    # An arrangement and its counterpart, after "amplitude"
    first: str = "with pedestal"
    second: str = "without pedestal"

    @property
    def divided(self) -> str:
        """Numerator and denominator of the ratio in words, from "amplitude" on, without a capital letter."""
        return f"amplitude {self.first} divided by that {self.second.removesuffix(' pedestal')}"

    @property
    def both(self) -> str:
        """Both sides, after "amplitude"."""
        return f"{self.first.removesuffix(' pedestal')} and {self.second}"


WITH_PEDESTAL = Sides()  # the comparison unless arrangements name their counterparts


OF_ARRANGEMENTS = Sides(
    change="an arrangement instead of the one it is compared with",
    ratio="arrangement/the other",
    first="of an arrangement",
    second="of the other",
)


def sides_of(study: Study) -> Sides:
    """Sides of the comparison in a study.

    Parameters
    ----------
    study : the study, with the counterparts of its arrangements

    Returns
    -------
    The :class:`Sides`.
    """
    if not study.counterparts:
        return WITH_PEDESTAL
    ((name, other), *more) = study.counterparts.items()
    if more or study.with_and_alone:
        return OF_ARRANGEMENTS
    return Sides(
        change=f"{name} instead of {other}",
        ratio=f"{name}/{other}",
        first=f"of {name}",
        second=f"of {other}",
    )


def _analyses(n: int, total: int) -> str:
    return of_all(n, total, "analysis", "analyses")


# --------------------------------------------------------------------------- strength


def strength_found(curves: pd.DataFrame, level: str) -> Finding | None:
    """Peak at which each configuration overturns with a probability of one half; None without a curve.

    Parameters
    ----------
    curves : rows of a fragility table
    level : confidence of their intervals in words, such as ``90 %``

    Returns
    -------
    The finding.
    """
    if curves.empty:
        return None
    found = headline_curves(curves)
    rows = found.rows[found.rows["theta"].notna()]
    if rows.empty:
        return None
    decimals = min(max(wording.decimals_of(value, 2) for value in rows["theta"]), 3)
    named = rows["configuration"] + " " + wording.estimates(rows, "theta", decimals)
    numbers = [_medians(list(named), str(rows["unit"].iloc[0]), level)]
    if found.nonparametric:
        numbers.append(
            "All are medians of nonparametric (monotone) curves, because a lognormal curve is rejected for "
            f"{listed(found.rejected)}."
        )
    else:
        numbers.append("All are medians of lognormal curves.")
    return Finding(_strongest_and_weakest(rows, decimals), "", " ".join(numbers))


def _strongest_and_weakest(rows: pd.DataFrame, decimals: int) -> str:
    """Headline on the configurations with the least and the largest median of a fragility table, with limits."""
    measure, unit = rows["im"].iloc[0], rows["unit"].iloc[0]
    printed = rows["theta"].map(lambda value: number(value, decimals))
    # words on the first screen, brackets behind a click
    said = [
        re.sub(r"\[(.*), (.*)\]", r"(\1 to \2)", text)
        for text in wording.estimates(rows, "theta", decimals)
    ]
    of = dict(zip(printed, said, strict=True))
    least = number(rows["theta"].min(), decimals)
    most = number(rows["theta"].max(), decimals)
    # what differs in no digit that is shown is named together
    weakest = rows[printed == least]
    strongest = rows[printed == most]
    names = list(weakest["configuration"])
    if least == most:
        return f"A {measure} of {of[least]} {unit} overturns {listed(names)} with 50 % probability"
    if not do_not_overlap(weakest, strongest):
        all_names = listed(list(rows["configuration"]))
        return (
            f"A {measure} of {of[least]} to {of[most]} {unit} overturns {all_names} with 50 % probability; "
            "their intervals overlap, so that none is shown to be the most fragile"
        )
    is_one = len(weakest) == 1
    return (
        f"{listed(names)} {'is' if is_one else 'are'} the most fragile: a {measure} of {of[least]} {unit} "
        f"overturns {'it' if is_one else 'them'} with 50 % probability, while "
        f"{listed(list(strongest['configuration']))} {'needs' if len(strongest) == 1 else 'need'} {of[most]} "
        f"{unit}"
    )


def do_not_overlap(weaker: pd.DataFrame, stronger: pd.DataFrame) -> bool:
    """Whether the intervals of some medians lie below those of others; unknown where one has no interval.

    Parameters
    ----------
    weaker, stronger : rows with ``theta_upper`` and ``theta_lower``, in one unit

    Returns
    -------
    Whether none of them overlap.
    """
    return bool(weaker["theta_upper"].max() < stronger["theta_lower"].min())


def _medians(named: Sequence[str], unit: str, level: str) -> str:
    """Medians of the first configurations, with their limits where they have some."""
    intervals = f" with {level} intervals" if any("[" in name for name in named) else ""
    rest = len(named) - MOST_CONFIGURATIONS
    more = f" and {rest} more in the table" if rest > 0 else ""
    shown = ", ".join(named[:MOST_CONFIGURATIONS])
    return f"Medians{intervals}, in {unit}: {shown}{more}."


def headline_curves(curves: pd.DataFrame) -> Compared:
    """Curves that the first page compares: of the first measure, all outcomes counted, by one estimator.

    Parameters
    ----------
    curves : rows of a fragility table

    Returns
    -------
    The :class:`rockfrag.fragility.curve_facts.Compared`.
    """
    first = curves["im"] == (curves["im"].iloc[0] if len(curves) else "")
    known = curves[
        first & (curves["estimator"] == "mean_probability") & curves["theta"].notna()
    ]
    return compared_curves(known)


ONE_MOTION = Finding(
    "One motion: no fragility can be given",
    "A fragility needs the motions of several earthquakes; one of them says nothing about how much they differ.",
)
"""Stands in place of curves where a study has a single record."""


# --------------------------------------------------------------------------- motions as recorded


def recorded_found(recorded: pd.DataFrame) -> Finding:
    """Number of motions that overturn as recorded, and how much that depends on their exact strength.

    Parameters
    ----------
    recorded : the table ``as_recorded``, a row per configuration and motion

    Returns
    -------
    The finding.
    """
    overturned = recorded.groupby("configuration", sort=False)["overturned"].sum()
    counts = {str(name): int(count) for name, count in overturned.items()}
    motions = int(recorded["configuration"].value_counts().max())
    total = len(recorded)
    fallen = sum(counts.values())
    numbers = ""
    if len(counts) > MOST_CONFIGURATIONS:
        numbers = f"{sentence(_analyses(fallen, total))} end in overturning."
    elif motions > 1 and len(counts) > 1 and 0 < fallen < total:
        each = ", ".join(f"{name} {count}" for name, count in counts.items())
        numbers = f"Motions that overturn, of {motions}: {each}."
    near = int(recorded["fraction_near"].between(0, 1, inclusive="neither").sum())
    text = "No outcome changes if the motion is scaled by anything within ±10 %."
    if near:
        text = (
            f"{sentence(of_all(near, total, 'outcome'))} {agree(near, total, 'flips', 'flip')} if the motion is "
            "scaled within ±10 %."
        )
    headline = f"At recorded strength {_recorded_outcomes(counts, motions, total)}"
    return Finding(headline, text, numbers)


def _recorded_outcomes(counts: Mapping[str, int], motions: int, total: int) -> str:
    """Configurations that so many motions overturn, after "at recorded strength"."""
    fallen = sum(counts.values())
    subject = "the only motion" if motions == 1 else f"all {motions} motions"
    verb = "overturns" if motions == 1 else "overturn"
    if fallen == total:
        return f"{subject} {verb} everything"
    if fallen == 0:
        return f"{subject.replace('all ', 'the ')} {verb} nothing"
    low = min(counts, key=counts.__getitem__)
    high = max(counts, key=counts.__getitem__)
    if len(counts) == 1:
        return f"{_overturning(fallen, motions)} {low}"
    if motions == 1:
        fell = [name for name, count in counts.items() if count]
        stood = [name for name, count in counts.items() if not count]
        return f"{subject} overturns {listed(fell)}, and not {listed(stood)}"
    if counts[low] == counts[high]:
        return f"{_overturning(counts[low], motions)} each object"
    return f"{counts[low]} ({low}) to {counts[high]} ({high}) of {motions} motions overturn the object"


def _overturning(n: int, motions: int) -> str:
    """Words for so many motions, of all, that overturn."""
    return (
        f"{of_all(n, motions, 'motion')} {agree(n, motions, 'overturns', 'overturn')}"
    )


# --------------------------------------------------------------------------- overturning amplitudes


def amplitudes_found(tests: pd.DataFrame) -> Finding:
    """Number of tests that overturn, their amplitudes, and the bodies that fell.

    Parameters
    ----------
    tests : tests of one definition of overturning intensity

    Returns
    -------
    The finding.
    """
    known, unknown = tests["amplitude_g"].dropna(), tests[tests["amplitude_g"].isna()]
    survived = unknown["upper_g"].isna()
    at_once = list(unknown.loc[~survived, "test"])
    never = list(unknown.loc[survived, "test"])
    fallen = len(known) + len(at_once)
    headline = "No simulated test overturns"
    if fallen:
        headline = (
            f"{sentence(of_all(fallen, len(tests), 'simulated test'))} "
            f"{agree(fallen, len(tests), 'overturns', 'overturn')}{_amplitude_range(known)}"
        )
    numbers = []
    if len(known):
        numbers.append(
            "The amplitude is the largest peak survived before the first overturning."
        )
    if never:
        numbers.append(
            f"Not overturned by up to {number(tests['lower_g'].max(), 2)} g: {listed(never)}."
        )
    if at_once:
        numbers.append(
            f"Overturned at the first step, so that only an upper bound is known: {listed(at_once)}."
        )
    numbers += _fallen_bodies(tests)
    return Finding(headline, "", " ".join(numbers))


def _amplitude_range(known: pd.Series) -> str:
    """Range of known amplitudes [g], behind "overturn"."""
    if not len(known):
        return ", at the first step"
    low, high = number(known.min(), 2), number(known.max(), 2)
    return f", at {low} g" if low == high else f", at {low} to {high} g"


def _fallen_bodies(tests: pd.DataFrame) -> list[str]:
    """Sentence on whether the object or its support fell first, in tests on a pedestal that overturned."""
    on_pedestal = tests[(tests["pedestal"] == "P") & (tests["overturned_body"] != "")]
    if on_pedestal.empty:
        return []
    fell = on_pedestal["overturned_body"]
    below = int((~fell.isin(["statue"]) & (fell != on_pedestal["object"])).sum())
    if not below:
        return ["The object always fell, never what it stood on."]
    counts = of_all(
        below, len(on_pedestal), "test on a pedestal", "tests on a pedestal"
    )
    return [f"What the object stood on fell first in {counts} that overturned."]


def objects_compared(
    means: pd.DataFrame, slenderness: Mapping[str, float]
) -> list[Finding]:
    """Effect of slenderness on the overturning amplitude, where objects differ in it.

    Parameters
    ----------
    means : the table ``mean_amplitudes`` [g]
    slenderness : height over width by object [-]

    Returns
    -------
    One finding, or none without two objects of different slenderness.
    """
    rows = means[(means["by"] == "configuration") & means["mean_g"].notna()]
    parts, falling, most = [], [], 0
    for side, words in (("NP", "alone"), ("P", "on a pedestal")):
        own = rows[rows["pedestal"] == side]
        own = own.assign(slenderness=own["object"].map(slenderness))
        own = own.sort_values("slenderness", kind="stable")
        if own["slenderness"].nunique() < 2:
            continue
        each = own["configuration"] + own["mean_g"].map(" {:.3f} g".format)
        parts.append(f"{words} {listed(list(each))}")
        falling.append(bool((own["mean_g"].diff().iloc[1:] < 0).all()))
        most = max(most, int(own["motions"].max()))
    if not parts:
        return []
    headline = "The overturning amplitude does not simply follow slenderness"
    if all(falling):
        headline = "More slender objects overturn at lower amplitudes"
    numbers = (
        f"Geometric mean amplitudes over the {counted(most, 'motion')} that overturned all of them, by increasing "
        f"slenderness: {'; '.join(parts)}."
    )
    return [Finding(headline, "", numbers)]


def mean_sentence(means: pd.DataFrame) -> str:
    """Motions over which means are taken, and those that had to be left out, in a sentence.

    Parameters
    ----------
    means : the table ``mean_amplitudes``

    Returns
    -------
    The sentence.
    """
    rows = means[means["by"] == "configuration"]
    most, of = int(rows["motions"].max()), int(rows["of"].max())
    if most == of:
        whole = "the only motion" if of == 1 else f"all {of} motions"
        return f"Means are over {whole}, each of which overturned everything compared."
    if most == 0 and of > 1:
        return f"None of the {of} motions overturned everything compared, so no means are compared."
    if most == 0:
        return "The only motion did not overturn everything compared, so no means are compared."
    return (
        f"Means are over the {counted(most, 'motion')} of {of} that overturned everything compared; the others "
        "give bounds only."
    )


def resurrections_found(resurrections: pd.DataFrame, tests: pd.DataFrame) -> Finding:
    """Number of analyses in which an object survives a stronger motion than one that overturned it.

    Parameters
    ----------
    resurrections : the table of that name, a row an IDA curve
    tests : tests of all definitions of overturning intensity

    Returns
    -------
    The finding.
    """
    fallen = resurrections[resurrections["first_upper"].notna()]
    if fallen.empty:
        return Finding("Nothing overturns, so no stronger motion can be survived")
    survived = int((fallen["resurrections"] > 0).sum())
    if not survived:
        return Finding(
            "Every motion stronger than the first that overturned also overturns"
        )
    wide = tests.pivot_table(index="test", columns="definition", values="amplitude_g")
    both = (
        wide.reindex(columns=["first_overturning", "always_overturning"])
        .dropna()
        .astype(float)
    )
    numbers = ""
    if len(both):
        ratios = np.log(both["always_overturning"] / both["first_overturning"])
        numbers = (
            "The amplitude above which every run overturns is on average "
            f"{np.exp(ratios.mean()):.2f} times that of the first overturning (geometric mean of "
            f"{_analyses(len(both), len(fallen))} in which both are known)."
        )
    return Finding(
        f"Non-monotone response: in {_analyses(survived, len(fallen))} the object survives a stronger motion than "
        "one that overturned it",
        "The overturning amplitude therefore depends on how the motion is raised.",
        numbers,
    )


# --------------------------------------------------------------------------- effect of the pedestal


def ratio_text(row: Mapping[Any, Any]) -> str:
    """Ratio with its interval: ``1.010 [0.990, 1.030]``.

    Parameters
    ----------
    row : with ``ratio``, ``lower`` and ``upper`` [-]

    Returns
    -------
    The text.
    """
    return wording.estimate(row["ratio"], row["lower"], row["upper"], _RATIO_DECIMALS)


def ratio_of(
    effects: pd.DataFrame,
    sides: Sides = WITH_PEDESTAL,
    scope: str = "whole",
    level: str = "all",
) -> str:
    """Ratio of amplitudes over all pairs, or over those of a level of a scope, in words.

    Parameters
    ----------
    effects : table of :func:`rockfrag.effects.study.effects_table` by definition
    sides, scope, level : the comparison, and the pairs of it

    Returns
    -------
    The words.
    """
    for row in effects.to_dict("records"):
        if (row["definition"], row["scope"], row["level"]) == (
            DEFINITION,
            scope,
            level,
        ):
            ratio = wording.estimate(row["ratio"], row["lower"], row["upper"], 2)
            return f"{sides.ratio} {ratio}"
    return "no pair with both amplitudes known"


def pedestal_effect(
    effects: pd.DataFrame, sides: Sides = WITH_PEDESTAL
) -> list[Finding]:
    """Factor by which a comparison changes the amplitude, over all pairs and on each floor.

    Parameters
    ----------
    effects : table of :func:`rockfrag.effects.study.effects_table` by definition
    sides : the comparison

    Returns
    -------
    A finding of all pairs, and one of the floors where there are several.
    """
    whole = effects[effects["scope"] == "whole"]
    here = whole[whole["definition"] == DEFINITION]
    if here.empty:
        return [
            Finding(
                f"The effect of {sides.change} is not known",
                f"No object overturned both {sides.both} under the same motion.",
            )
        ]
    row = here.to_dict("records")[0]
    others = whole[whole["definition"] != DEFINITION].to_dict("records")
    floors = effects[
        (effects["scope"] == "floor") & (effects["definition"] == DEFINITION)
    ]
    found = [_effect(row, others, sides)]
    if len(floors) > 1:
        found.append(_effect_by_floor(floors, sides))
    return found


def _effect(
    row: Mapping[Any, Any], others: Sequence[Mapping[Any, Any]], sides: Sides
) -> Finding:
    """Finding on an effect, with its numbers and what else they say."""
    has_width = wording.has_interval(row["lower"], row["upper"], _RATIO_DECIMALS)
    numbers = [_ratio_and_units(row, sides, has_width)]
    pairs, tied = int(row["pairs"]), int(row["tied"])
    if tied and row["resolution_ratio"] > 1:
        hidden = 100 * (row["resolution_ratio"] - 1)
        numbers.append(
            f"{sentence(of_all(tied, pairs, 'pair'))} overturned in the same step; the steps hide effects below "
            f"{hidden:.1f} %."
        )
    if others:
        each = [
            f"{other['definition'].replace('_', ' ')} {ratio_text(other)} ({counted(int(other['pairs']), 'pair')})"
            for other in others
        ]
        numbers.append(f"Other ways to read the amplitude: {'; '.join(each)}.")
    headline = _effect_headline(row, sides, has_width)
    text = _detectable(row) if has_width else ""
    return Finding(headline, text, " ".join(numbers))


def _is_one_inside(row: Mapping[Any, Any]) -> bool:
    """Whether the interval of a ratio holds 1."""
    return bool(row["lower"] <= 1 <= row["upper"])


def _effect_headline(row: Mapping[Any, Any], sides: Sides, has_width: bool) -> str:
    """Headline of an effect: that it raises, lowers or does not change the amplitudes."""
    size = number(100 * abs(row["ratio"] - 1), 1)
    moves = f"{'raises' if row['ratio'] > 1 else 'lowers'} the"
    change = sentence(sides.change)
    if not has_width and size == "0.0":
        return f"The amplitudes {sides.both} are the same"
    if not has_width:
        pairs = counted(int(row["pairs"]), "pair")
        return f"{change} {moves} amplitude by {size} % in {pairs}"
    if _is_one_inside(row) and row["equivalent"]:
        return f"{change} changes the overturning amplitude by less than 10 %"
    if _is_one_inside(row):
        return f"The mean effect of {sides.change} is not distinguishable from zero"
    return f"{change} {moves} overturning amplitude by {size} %"


def _detectable(row: Mapping[Any, Any]) -> str:
    """Sentence on the changes that an interval excludes or could have shown."""
    if row["equivalent"]:
        return "A change of 10 % or more is excluded (5 % level)."
    ratio = row["detectable_ratio"]
    if not _is_one_inside(row) or not math.isfinite(ratio):
        return ""
    if ratio <= _LEAST_DETECTABLE:
        return ""
    return f"With this scatter only changes of {100 * (ratio - 1):.0f} % or more can be detected (80 % power)."


def _ratio_and_units(row: Mapping[Any, Any], sides: Sides, has_width: bool) -> str:
    """Ratio with its interval, the pairs that it is of, and the units that were resampled."""
    pairs = int(row["pairs"])
    units = counted(int(row["units"]), row["unit"])
    of = f"geometric mean of {pairs} pairs" if pairs > 1 else "of the only pair"
    bounds = ""
    if at_bound := int(row["at_bound"]):
        bounds = f", {at_bound} of which have one test that gives a bound only"
    if has_width:
        interval = f" (95 % interval over {units})."
    elif int(row["units"]) < 2:
        interval = f"; from {units} there is no interval."
    else:
        interval = f", the same for {units}: the steps of the amplitudes show no scatter, so there is no interval."
    return f"{sentence(sides.divided)}, {of}{bounds}: {ratio_text(row)}{interval}"


def _effect_by_floor(floors: pd.DataFrame, sides: Sides) -> Finding:
    """Finding on whether an effect differs between floors.

    Parameters
    ----------
    floors : a row a floor, in ``level`` by its name, with a ratio of amplitudes and its 95 % interval, ``lower``
        and ``upper``
    sides : words for what is compared

    Returns
    -------
    The finding; an effect is clear on a floor where the interval does not hold 1.
    """
    limits = floors[["lower", "upper"]].to_numpy(dtype=float)
    known = np.array(
        [wording.has_interval(low, high, _RATIO_DECIMALS) for low, high in limits]
    )
    clear = known & ((floors["lower"] > 1) | (floors["upper"] < 1))
    count = int(clear.sum())
    if not known.any():
        headline = "The ratios by floor have no intervals"
    elif not count:
        headline = f"The effect of {sides.change} is not distinguishable from zero on any floor"
    else:
        headline = f"{sentence(sides.change)} has an effect on {of_all(count, len(floors), 'floor')}"
    each = [f"{row['level']} {ratio_text(row)}" for row in floors.to_dict("records")]
    return Finding(headline, "", f"{sentence(sides.divided)}: {'; '.join(each)}.")


# --------------------------------------------------------------------------- validity of the model


def model_allowed(validity: pd.DataFrame) -> Finding:
    """Friction that rocking without sliding needs, and whether a block would have lifted off.

    Parameters
    ----------
    validity : the table of that name, a row a test

    Returns
    -------
    The finding.
    """
    demands = {
        where: part[np.isfinite(part)] for where, part in _demands(validity).items()
    }
    tests = len(validity)
    beyond = tests - sum(map(len, demands.values()))
    lifted = int((validity["least_normal_force_n"] <= 0).sum())
    numbers = [f"Friction coefficient needed: {_demand_ranges(demands)}."]
    if beyond:
        numbers.append(
            f"No friction would be enough in {of_all(beyond, tests, 'test')}."
        )
    if lifted:
        numbers.append(
            f"A block would have lifted off in {of_all(lifted, tests, 'test')}."
        )
    else:
        numbers.append("No block would have lifted off its support.")
    return Finding(friction_sentence(validity), "", " ".join(numbers))


def _demands(validity: pd.DataFrame) -> dict[str, pd.Series]:
    """Friction that tests need, with and without a pedestal where both were tested."""
    demand = validity["friction_demand"].astype(float)
    on_pedestal = validity["pedestal"] == "P"
    if on_pedestal.nunique() < 2:
        return {"": demand}
    return {"with the pedestal": demand[on_pedestal], "without": demand[~on_pedestal]}


def _demand_ranges(demands: Mapping[str, pd.Series]) -> str:
    """Range and median of the friction needed at each place [-]."""
    parts = []
    for where, known in demands.items():
        if not len(known):
            continue
        words = f"{where} {known.min():.2f}".strip()
        if len(known) > 1:
            words += f" to {known.max():.2f} (median {known.median():.2f})"
        parts.append(words)
    return "; ".join(parts) or "none known"


def friction_sentence(validity: pd.DataFrame) -> str:
    """Number of tests that need more friction than dry stone has, with and without a pedestal; no full stop.

    Parameters
    ----------
    validity : the table of that name, a row a test

    Returns
    -------
    The sentence.
    """
    parts: list[str] = []
    for where, demand in _demands(validity).items():
        n, total = int((~(demand <= FRICTION)).sum()), len(demand)
        words = f"{of_all(n, total, 'test')} {where}".strip()
        if not parts:
            verb = agree(n, total, "requires", "require")
            words = (
                f"{sentence(words)} {verb} a friction coefficient above {FRICTION:g}"
            )
        parts.append(words)
    return ", and ".join(parts)


def sliding_found(sliding: pd.DataFrame) -> Finding:
    """Number of analyses in which bodies slid and flew, how far, and outcomes that this changed.

    Parameters
    ----------
    sliding : the table of that name, a row a configuration; slips in metres

    Returns
    -------
    The finding.
    """
    cases = int(sliding["cases"].sum())
    slid = int(sliding["slid"].sum())
    flew = int(sliding["flew"].sum())
    saved, felled = int(sliding["saved"].sum()), int(sliding["felled"].sum())
    if slid == flew == 0:
        text = (
            "The friction needed never exceeds the friction available in "
            f"{counted(cases, 'analysis', 'analyses')}."
        )
        return Finding("Nothing slides or flies", text)
    text = "Sliding changes no outcome."
    if saved or felled:
        text = (
            f"Sliding and flight prevent overturning in {_analyses(saved, cases)} and cause it in "
            f"{_analyses(felled, cases)}."
        )
    farthest = sliding.iloc[int(sliding["largest_slip_m"].argmax())]
    slip = number(100 * farthest["largest_slip_m"], 1)
    flies = f"bodies fly in {_analyses(flew, cases)}" if flew else "nothing flies"
    return Finding(
        f"Bodies slide in {_analyses(slid, cases)}",
        text,
        f"The largest slip is {slip} cm ({farthest['configuration']}); {flies}.",
    )


def scaled_far(scaling: pd.DataFrame, tests: pd.DataFrame) -> str:
    """Sentence on the tests that overturn under a motion scaled by more than :data:`LARGEST_FACTOR`.

    Parameters
    ----------
    scaling : peak of each motion as recorded or felt, ``pga_g`` [g], by ``motion``
    tests : a row a test, with ``motion`` and ``upper_g``, the amplitude that overturned [g]

    Returns
    -------
    The sentence, empty if there is no such test.
    """
    fallen = tests.dropna(subset=["upper_g"])
    if fallen.empty:
        return ""
    factors = fallen["upper_g"] / fallen["motion"].map(
        scaling.set_index("motion")["pga_g"]
    )
    far = factors > LARGEST_FACTOR
    if not far.any():
        return ""
    motions = list(dict.fromkeys(fallen.loc[far, "motion"]))
    return (
        f"Scaling: {of_all(int(far.sum()), len(fallen), 'test')} that overturned needed more than "
        f"{LARGEST_FACTOR:g} times the motion (at most {factors.max():.3g} times: {listed(motions)}); small "
        "earthquakes scaled so far are not large ones."
    )
