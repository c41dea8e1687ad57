"""Findings of a campaign on a shake table, in words that follow from its tables.

In: tables of the stages of a campaign (``agreement``, ``fragility``, ``tests``). Out: a
:class:`rockfrag.report.part.Finding` each; fractions of outcomes that are right [-], medians and dispersions over
measured ones [-].

Theory: ``docs/campaigns.md``, "What is compared".
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import pandas as pd

from rockfrag.campaign.comparison import REPEATS
from rockfrag.fragility.observations import name_and_unit
from rockfrag.report.part import Finding
from rockfrag.stages.campaign import IN_PLANE, OURS, VOTES
from rockfrag.words.sentences import (
    agree,
    counted,
    estimate,
    estimates,
    number,
    of_all,
    probability,
    sentence,
)

LEVEL = 0.05  # a difference between programs is stated below this adjusted p value [-]

Row = Mapping[Any, Any]  # a row of a table


def percent_text(row: Row) -> str:
    """Fraction of outcomes that are right, with its interval, in per cent."""
    right = estimate(100 * row["right"], 100 * row["lower"], 100 * row["upper"], 1)
    return f"{right} %"


def better_text(row: Row) -> str:
    """Percentage points by which the simulation is better, with limits; a dash for itself."""
    if math.isnan(row["better"]):
        return "–"
    lower, upper = row["better_lower"], row["better_upper"]
    return f"{number(100 * row['better'], 1)} [{number(100 * lower, 1)}, {number(100 * upper, 1)}]"


def who_text(name: str) -> str:
    """Predictor of outcomes in words: thresholds by their measure, codes by their name."""
    if name in (OURS, IN_PLANE):
        return "simulation" + name.removeprefix(OURS)
    for start in ("threshold on ", "probit on "):
        if name.startswith(start):
            measures = name.removeprefix(start).split(" and ")
            return start + " and ".join(
                name_and_unit(measure)[0] for measure in measures
            )
    return name


def _p_text(value: float) -> str:
    text = probability(value)
    return text if text.startswith("<") else f"= {text}"


def campaign_findings(tables: Mapping[str, pd.DataFrame]) -> list[Finding]:
    """Findings of a campaign, the most important first.

    Parameters
    ----------
    tables : tables of its stages by name

    Returns
    -------
    The findings.
    """
    ours, *others = tables["agreement"].to_dict("records")
    found = [_predicted(ours)]
    found += [beside_plane(ours, row) for row in others if row["who"] == IN_PLANE]
    # tests repeated by the laboratory are the ceiling of all models, not one of them
    rivals = [row for row in others if row["who"] not in (REPEATS, IN_PLANE)]
    if rivals:
        found.append(_beside_rivals(rivals))
    found += fragility_found(tables["fragility"])
    return [*found, *_wrong(tables["tests"])]


def _predicted(ours: Row) -> Finding:
    """Finding on how many outcomes the simulation predicts."""
    return Finding(
        f"The simulation predicts {number(100 * ours['right'], 1)} % of the outcomes",
        f"{sentence(_tests(ours['missed']))} overturned in the laboratory only, "
        f"{_tests(ours['false_alarms'])} in the simulation only.",
        f"Tests whose motions were not used to fit unmeasured properties: {percent_text(ours)} predicted.",
    )


def _tests(mean: float, noun: str = "test") -> str:
    """Mean number of tests, rounded, with its noun."""
    return counted(round(mean), noun)


def beside_plane(ours: Row, plane: Row) -> Finding:
    """Finding on whether simulation in space predicts better than in one plane.

    Parameters
    ----------
    ours, plane : rows of the table ``agreement``

    Returns
    -------
    The finding.
    """
    compared = "no gain over one plane"
    if plane["p"] < LEVEL and plane["better_lower"] > 0:
        compared = "better than in one plane"
    elif plane["p"] < LEVEL and plane["better_upper"] < 0:
        compared = "worse than in one plane"
    return Finding(
        f"Simulation in space is {compared}: {number(100 * ours['right'], 1)} and "
        f"{number(100 * plane['right'], 1)} % of the outcomes predicted",
        "All other figures here are of the simulation in space.",
        f"In one plane {percent_text(plane)} with {_tests(plane['missed'])} missed and "
        f"{_tests(plane['false_alarms'], 'false alarm')}: in space better by {better_text(plane)} percentage "
        f"points (p {_p_text(plane['p'])}).",
    )


def _beside_rivals(rivals: Sequence[Row]) -> Finding:
    """Finding on the best of the alternatives, its p value adjusted for their number (Bonferroni)."""
    best = max(rivals, key=lambda row: float(row["right"]))
    name, alternatives = who_text(best["who"]), counted(len(rivals), "alternative")
    adjusted = min(1.0, best["p"] * len(rivals))
    is_clear = adjusted < LEVEL
    if is_clear and best["better_lower"] > 0:
        headline = f"The simulation is better than {name}, the best of {alternatives}"
    elif is_clear and best["better_upper"] < 0:
        headline = f"{name.capitalize()} is better"
    else:
        headline = f"The simulation is not distinguishable from {name}, the best of {alternatives}"
    # an estimate with a negative limit is not written as a ratio is
    difference = better_text(best)
    if best["better_lower"] > 0:
        lower, upper = 100 * best["better_lower"], 100 * best["better_upper"]
        difference = estimate(100 * best["better"], lower, upper, 1)
    return Finding(
        headline,
        "",
        f"{sentence(name)} predicts {percent_text(best)} of the same tests: a difference of {difference} "
        f"percentage points (p {_p_text(best['p'])}; p {_p_text(adjusted)} after Bonferroni’s adjustment for "
        f"{alternatives}).",
    )


class _Ratios(NamedTuple):
    """Simulated over measured median and dispersion, with limits, in words."""

    median: str
    dispersion: str


def fragility_found(fragility: pd.DataFrame) -> list[Finding]:
    """Finding on the simulated curve over the measured one, none where no curve rises.

    Parameters
    ----------
    fragility : the table of that name

    Returns
    -------
    One finding or none.
    """
    measure = least_dispersed(fragility)
    rows = fragility[
        (fragility["measure"] == measure) & fragility["theta_ratio"].notna()
    ]
    if rows.empty:
        return []
    medians = estimates(rows, "theta_ratio", 2)
    dispersions = estimates(rows, "beta_ratio", 2)
    ratios = map(_Ratios, medians, dispersions)
    by_who = dict(zip(rows["who"], ratios, strict=True))
    ours, votes = by_who[OURS], by_who[VOTES]
    return [
        Finding(
            f"Simulated over measured {name_and_unit(measure)[0]} of overturning: median {ours.median}, "
            f"dispersion {ours.dispersion}",
            f"Fitted to fractions of plausible trials, not to majorities: median {votes.median}, dispersion "
            f"{votes.dispersion}.",
        )
    ]


def least_dispersed(fragility: pd.DataFrame) -> str:
    """Column of the measure in which the measured curve has the least dispersion."""
    measured = fragility[fragility["who"] == "measured"]
    return str(measured.set_index("measure")["beta"].fillna(math.inf).idxmin())


def _wrong(tests: pd.DataFrame) -> list[Finding]:
    """Finding on the wrong predictions that are near-critical, none where all are right."""
    near, wrong = tests["near_critical"], ~tests["right"]
    if not wrong.any():
        return []
    both, count = int((wrong & near).sum()), int(wrong.sum())
    return [
        Finding(
            f"{sentence(of_all(both, count, 'wrong prediction'))} {agree(both, count, 'is', 'are')} near-critical",
            f"Plausible ways to set up the object disagree about the outcome in {int(near.sum())} of {len(tests)} "
            "tests; the unmeasured properties do not decide the others.",
        )
    ]
