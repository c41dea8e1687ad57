"""Answer on the first screen of the thesis's study: its reports, the model's results, and perturbations.

In: the tables ``pedestal/effects``, ``hypotheses`` and ``sensitivity_analysis/…``, ratios with over without
pedestal [-]. Out: :class:`rockfrag.report.part.Answer`, made of tables alone, so that every number in it can be
looked up there. Docs: ``docs/hypotheses.md``, "The first page".
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.base.figure_style import BAND, BLUE, COLUMN_WIDTH, GREY, ORANGE, panels
from rockfrag.report.answer import study_answer
from rockfrag.report.findings import FRICTION, ratio_text
from rockfrag.report.part import Answer, FigureSpec, Finding, Results
from rockfrag.report.sections.pedestal import NONE, ratio_axis
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag.words.sentences import agree, counted, listed, of_all, sentence
from rockfrag_thesis.hypotheses.floors import FIFTH, FLOORS, GROUND, THIRD
from rockfrag_thesis.hypotheses.hypothesis import Finding as Evidence
from rockfrag_thesis.sections.inverse_problem import (
    asks_inverse_problem,
    goals,
    mechanism_name,
)
from rockfrag_thesis.sections.sensitivity_analysis import asks_sensitivity_analysis
from rockfrag_thesis.sections.signs import perturbations_by_floor
from rockfrag_thesis.settings import settings_of

DISCOVERY_RATE = 0.05
"""Level of the false discovery rate at which a perturbation counts as changing the ratio [-]."""

MOST_NAMED = 3  # so many perturbations are named with their ratios; the table has all

REPORTED_SIDE = {GROUND: 1, THIRD: -1, FIFTH: -1}
"""Whether the thesis reports a ratio above (1) or below one (-1) on a floor (sections 4.3 and 4.4)."""

_ON_FLOOR = {
    Evidence.FOR: "reproduced",
    Evidence.AGAINST: "not reproduced",
    Evidence.OPEN: "undecided",
    Evidence.BOUNDED: "{} of 10 % or more is excluded, a smaller one is not",
}


def thesis_answer(results: Results) -> Answer:
    """Answer on the first screen: reports of the thesis, results of the model, perturbations with an effect."""
    study = results.study
    if not study.has_pairs:
        return study_answer(results)
    effects = results.table("pedestal/effects")
    analysis = "sensitivity_analysis"
    found = first_page(
        effects,
        results.table("hypotheses"),
        results.table(f"{analysis}/effects")
        if asks_sensitivity_analysis(study)
        else None,
        results.table(f"{analysis}/inverse_problem")
        if asks_inverse_problem(study)
        else None,
        settings_of(study).wanted_percent,
    )
    here = effects[effects["definition"] == DEFINITION]
    arrows = " Arrows: thesis." if has_thesis_floors(here) else ""
    return replace(
        study_answer(results),
        asked="Does a pedestal delay overturning on the ground and hasten it on upper floors?",
        sentences=found,
        figure=FigureSpec(
            name="answer",
            alt=(
                "Amplitude with over amplitude without pedestal, with what the thesis reports. "
                f"{found[0].headline}."
            ),
            caption=f"Ratio with/without pedestal, 95 % intervals; grey: ±10 %.{arrows}",
            draw=lambda: ratios_figure(here),
        ),
        advice=_advice(results),
    )


def _advice(results: Results) -> list[str]:
    """Advice to measure the friction that rocking without sliding needs, where that is much."""
    validity = results.table("validity")
    if results.study.slides or validity.empty:
        return []
    with_pedestal = validity[validity["pedestal"] == "P"]
    beyond = int((~(with_pedestal["friction_demand"].astype(float) <= FRICTION)).sum())
    total = len(with_pedestal)
    tests = of_all(beyond, total, "test with", "tests with")
    return [
        f"Measure the friction under the statue: {tests} pedestal {agree(beyond, total, 'needs', 'need')} more "
        f"than {FRICTION:g}."
    ]


def first_page(
    effects: pd.DataFrame,
    hypotheses: pd.DataFrame,
    sensitivity_analysis: pd.DataFrame | None = None,
    inverse_problem: pd.DataFrame | None = None,
    wanted_percent: Mapping[str, float] | None = None,
) -> list[Finding]:
    """Findings on the reports of the thesis, the simulations of a study, and perturbations that have an effect.

    Parameters
    ----------
    effects, hypotheses : of the study's simulations, and the table of all hypotheses
    sensitivity_analysis, inverse_problem : effects of perturbed parameters, and those closest to
        ``wanted_percent``
    wanted_percent : change of P/NP that is asked for on the ``ground`` and ``above`` it [%]

    Returns
    -------
    The findings.
    """
    here = effects[effects["definition"] == DEFINITION]
    found = [_reported(here, hypotheses.set_index("number"))]
    if sensitivity_analysis is not None and len(sensitivity_analysis):
        would = _what_would(sensitivity_analysis)
        if inverse_problem is not None and len(inverse_problem) and wanted_percent:
            nearest = _inverted(inverse_problem, wanted_percent)
            would = replace(would, numbers=f"{would.numbers} {nearest}")
        found.append(would)
    return found


def _reported(effects: pd.DataFrame, hypotheses: pd.DataFrame) -> Finding:
    """Finding on the reports of the thesis beside the results of the model."""
    of_floors = effects[effects["scope"] == "floor"].to_dict("records")
    on_floors = {row["level"]: row for row in of_floors}
    found = {number: Evidence(value) for number, value in hypotheses["finding"].items()}
    all_pairs = effects[effects["scope"] == "whole"].to_dict("records")
    whole = (
        ratio_text(all_pairs[0]) if all_pairs else "no pair with both amplitudes known"
    )
    if not set(FLOORS) <= set(on_floors):
        return Finding(
            "The thesis reports an effect of the pedestal that depends on the floor",
            "",
            f"{_REPORTS} {whole} (95 % interval over earthquakes); this study does not have the thesis’s floors.",
        )
    ratios = [f"{floor} {ratio_text(on_floors[floor])}" for floor in FLOORS]
    pairs = sum(int(on_floors[floor]["pairs"]) for floor in FLOORS)
    stated = {
        GROUND: (35, "a gain"),
        THIRD: (36, "a decrease"),
        FIFTH: (37, "a decrease"),
    }
    outcomes = [
        f"{floor}: {_ON_FLOOR[found[number]].format(change)}"
        for floor, (number, change) in stated.items()
    ]
    # the pedestal matters so little where C12 is true of all landings
    lifts_briefly = hypotheses["estimate"].to_dict().get(12) == 1
    numbers = (
        f"{_REPORTS} {listed(ratios)}, and {whole} over all {counted(pairs, 'pair')} (95 % intervals over "
        f"earthquakes). {'; '.join(outcomes)}. A difference between thesis and model implies an effect that the "
        "model omits."
    )
    if lifts_briefly:
        numbers += (
            " In the model a landing of the statue lifts the pedestal so briefly that it stands still before "
            "the next one."
        )
    headline = (
        f"The thesis reports a gain on the ground floor; {_IN_PURE_ROCKING[found[35]]}"
    )
    return Finding(headline, "", numbers)


_REPORTS = (
    "The thesis reports that its towers overturn later with the pedestal than without it on the ground floor, "
    "significantly so, and slightly earlier on the 3rd and 5th floors; it prints no ratios. For rigid blocks "
    "that only rock, the amplitude with pedestal divided by that without is"
)
"""Sections 4.3, 4.4 and 5 of thesis."""

_IN_PURE_ROCKING = {
    Evidence.FOR: "pure rocking reproduces it",
    Evidence.AGAINST: "pure rocking gives the opposite",
    Evidence.OPEN: "for pure rocking it is undecided",
    Evidence.BOUNDED: "for pure rocking a gain of 10 % or more is excluded, a smaller one is not",
}


def _what_would(sensitivity_analysis: pd.DataFrame) -> Finding:
    """Finding on the perturbations that change the ratio, and on those that have the thesis's pattern."""
    table = perturbations_by_floor(sensitivity_analysis)
    simulated, computed = table[~table["arithmetic"]], table[table["arithmetic"]]
    patterned = list(table.loc[table["beyond_chance"], "name"])
    changing = simulated[simulated["p_adjusted"] < DISCOVERY_RATE]
    size = np.log(simulated["ratio"]).abs()
    largest = simulated.loc[size.nlargest(MOST_NAMED).index].to_dict("records")
    strong = [f"{row['name']} ({ratio_text(row)})" for row in largest]
    numbers = [
        "No perturbation has intervals above 1 on the ground floor and below 1 on both floors above."
    ]
    if patterned:
        numbers = [
            "Ratios above 1 on the ground floor and below 1 on both floors above, intervals included: "
            f"{listed(patterned)}."
        ]
    if total := len(simulated):
        change = agree(len(changing), total, "changes", "change")
        numbers.append(
            f"{sentence(of_all(len(changing), total, 'simulated perturbation'))} {change} the ratio over all "
            f"floors (Benjamini–Hochberg at {100 * DISCOVERY_RATE:g} % over {counted(total, 'test')}); the "
            f"largest {'is' if len(strong) == 1 else 'are'} {listed(strong)}."
        )
    if count := len(computed):
        ratios = computed["ratio"]
        numbers.append(
            f"{sentence(counted(count, 'other'))} {'is' if count == 1 else 'are'} arithmetic, not simulation: a "
            f"mass that is moved but not counted gives {ratios.min():.3f} to {ratios.max():.3f} on all floors "
            "alike."
        )
    produce = agree(len(patterned), len(table), "produces", "produce")
    counts = sentence(of_all(len(patterned), len(table), "perturbation"))
    headline = f"{counts} of the model {produce} its pattern"
    return Finding(headline, "", " ".join(numbers))


def _inverted(
    inverse_problem: pd.DataFrame, wanted_percent: Mapping[str, float]
) -> str:
    """Sentence on the perturbation, and on the two together, that come closest to the effect asked for."""
    everywhere = inverse_problem["acts_on"] == "all floors"
    pairs = inverse_problem["factor_2"] != ""
    kinds = {
        "single one": everywhere & ~pairs,
        "pair": everywhere & pairs,
        "one acting at one place only": ~everywhere,
    }
    nearest = []
    for what, rows in kinds.items():
        for row in inverse_problem[rows].head(1).to_dict("records"):
            both = listed([f"{row[name]:.3f}" for name in wanted_percent])
            mechanism = mechanism_name(row) + _ACTING[row["acts_on"]]
            nearest.append(f"the closest {what} gives {both} ({mechanism})")
    reached, total = int(inverse_problem["reaches"].sum()), len(inverse_problem)
    return (
        f"{sentence(of_all(reached, total, 'mechanism'))} (one perturbation, or two together) "
        f"{agree(reached, total, 'produces', 'produce')} {listed(goals(wanted_percent))}; {listed(nearest)}."
    )


_ACTING = {
    "all floors": "",
    "ground": " on the ground alone",
    "above": " above the ground alone",
}


def has_thesis_floors(effects: pd.DataFrame) -> bool:
    """Whether effects have a floor of which the thesis reports a direction."""
    return bool(
        set(effects.loc[effects["scope"] == "floor", "level"]) & set(REPORTED_SIDE)
    )


def ratios_figure(effects: pd.DataFrame) -> Figure:
    """Draw the ratio with over without pedestal, of all pairs and on each floor, of effects of one definition."""
    whole = effects[effects["scope"] == "whole"]
    floors = effects[effects["scope"] == "floor"]
    rows = [("all pairs", row) for row in whole.to_dict("records")]
    rows += [(str(row["level"]), row) for row in floors.to_dict("records")]
    with panels(COLUMN_WIDTH, 1.0 + 0.33 * len(rows)) as (figure, axes):
        axes.axvspan(NONE[0], NONE[1], color=BAND, lw=0)
        axes.axvline(1.0, color=GREY, lw=0.8)
        drawn = [1 / 1.25, 1.25]
        for y, (name, row) in enumerate(rows):
            limits = [row["lower"], row["upper"]]
            if np.isfinite(limits).all() and limits[0] < limits[1]:
                axes.plot(limits, [y, y], color=BLUE, lw=1.4)
                drawn += limits
            axes.plot(row["ratio"], y, "o", mec=BLUE, mfc="white", ms=5)
            drawn.append(row["ratio"])
            if side := REPORTED_SIDE.get(name):
                arrow = {"arrowstyle": "-|>", "color": ORANGE, "lw": 1.8}
                axes.annotate("", (1.2**side, y), (1.115**side, y), arrowprops=arrow)
        names = [f"{name} ({counted(int(row['pairs']), 'pair')})" for name, row in rows]
        axes.set_yticks(range(len(rows)), names)
        axes.set_ylim(len(rows) - 0.5, -0.5)
        axes.tick_params(axis="y", length=0)
        ratio_axis(axes, drawn)
        handles = [
            Line2D([], [], color=BLUE, marker="o", mfc="white", label="simulated")
        ]
        if has_thesis_floors(effects):
            words = "direction in the thesis"
            handles.append(
                Line2D([], [], color=ORANGE, lw=1.8, marker=">", label=words)
            )
        figure.legend(
            handles=handles, loc="outside upper center", ncols=2, handlelength=1.6
        )
    return figure
