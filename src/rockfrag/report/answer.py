"""What stands first on the page of any study: the question, what was found, what to do, and what it rests on."""

from collections.abc import Sequence
from functools import partial

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.base.figure_style import BLACK, COLUMN_WIDTH, panels, plain_log
from rockfrag.report import findings
from rockfrag.report.figures import GREY, SIDE_COLOUR, SIDE_NAME, drawn_tests
from rockfrag.report.part import Answer, Finding, Results, Says
from rockfrag.simulation.ensemble import LIGHT
from rockfrag.words.sentences import sentence, shortened

FEW = 10  # intervals over fewer earthquakes than this rest on little
MOST_NAMED = 4  # so many objects are named in the question


says = Says("rockfrag.report", "answer.j2", FEW=FEW, FRICTION=findings.FRICTION)


def study_answer(results: Results) -> Answer:
    """Return what stands first on the page of a study, made of its tables alone."""
    curves, found = _headline_curves(results), sentences(results)
    # amplitudes are peaks of acceleration; a median in another measure has no place beside them
    curves = curves[curves["unit"] == "g"]
    names = [configuration.name for configuration in results.study.configurations]
    draw, level = partial(strength_figure, results.tests, curves, names), results.level
    return Answer(
        asked=says("asked", results.objects, results.study, MOST_NAMED)[0],
        sentences=found,
        figure=says.figure("answer", draw, found[0], level if len(curves) else ""),
        advice=advice(results),
        rests_on=says("rests_on", results.study, _earthquakes(results)),
        could_change=could_change(results),
        questions=list(says.pairs("questions", results.study).items()),
    )


def has_one_record(results: Results) -> bool:
    """Whether a study has a single record, of which no fragility can be made."""
    return len(results.records) == 1


def sentences(results: Results) -> list[Finding]:
    """How strong the shaking must be, what the motions do as recorded, and what the pedestal changes."""
    table, about = results.table, findings.sides_of(results.study)
    amplitudes = findings.amplitudes_found(results.tests)
    recorded = findings.recorded_found(table("as_recorded"))
    if has_one_record(results):
        return [amplitudes, recorded, findings.ONE_MOTION]
    curves = table("fragility").dropna(subset=["theta"])
    found = [findings.strength_found(curves, results.level) or amplitudes, recorded]
    if results.study.has_pairs:
        return [*found, findings.pedestal_effect(table("pedestal/effects"), about)[0]]
    compared = findings.objects_compared(
        table("mean_amplitudes"), results.study.slenderness
    )
    resurrections = findings.resurrections_found(table("resurrections"), table("tests"))
    return [*found, *compared, resurrections][:3]


def advice(results: Results) -> list[str]:
    """What to do: the weakest first, and what would make the result more robust."""
    curves, weakest = _headline_curves(results), []
    theta = curves["theta"]
    if theta.min() < theta.max():
        # within what three digits tell
        weakest = list(curves.loc[theta < 1.005 * theta.min(), "configuration"])
    may_slide = not results.study.slides and _needs_friction(results)
    return says("advice", weakest, may_slide, _earthquakes(results))


def _headline_curves(results: Results) -> pd.DataFrame:
    """Curves that the first page compares, none of a single record."""
    curves = findings.headline_curves(results.table("fragility")).rows.dropna(
        subset=["theta"]
    )
    return curves.iloc[:0] if has_one_record(results) else curves


def _needs_friction(results: Results) -> bool:
    """Whether any test needs more friction than dry stone has."""
    demand = results.table("validity")["friction_demand"].astype(float)
    return bool((~(demand <= findings.FRICTION)).any())


def _earthquakes(results: Results) -> int:
    return int(results.study.catalogue["earthquake"].nunique())


MOST_ROWS = 24  # more configurations than this are not legible; the first are drawn


def strength_figure(
    tests: pd.DataFrame, curves: pd.DataFrame, names: Sequence[str]
) -> Figure:
    """Draw a row for each configuration: its tests, and its curves with medians of PGA [g], if any."""
    shown = list(names)[:MOST_ROWS]
    with panels(COLUMN_WIDTH, 0.8 + 0.33 * len(shown)) as (figure, axes):
        for y, name in enumerate(shown):
            rows = drawn_tests(tests[tests["configuration"] == name])
            colour = SIDE_COLOUR[str(rows["pedestal"].iloc[0])]
            known = ~(rows["up"] | rows["down"])
            # carets to the right and to the left for bounds
            for own, marker, size in (
                (known, "|", 7),
                (rows["up"], 5, 5),
                (rows["down"], 4, 5),
            ):
                x = rows.loc[own, "a"].to_numpy(dtype=float)
                axes.plot(
                    x,
                    np.full(x.size, y + 0.12),
                    ls="",
                    marker=marker,
                    color=colour,
                    ms=size,
                )
            below = y - 0.2
            for row in curves[curves["configuration"] == name].to_dict("records"):
                limits = [row["theta_lower"], row["theta_upper"]]
                if np.isfinite(limits).all() and limits[0] < limits[1]:
                    axes.plot(limits, [below, below], color=BLACK, lw=1.2)
                axes.plot(row["theta"], below, "D", mec=BLACK, mfc="white", ms=4)
        axes.set_ylim(len(shown) - 0.4, -0.6)
        axes.set_yticks(range(len(shown)), [shortened(name, 20) for name in shown])
        axes.tick_params(axis="y", length=0)
        axes.set(xscale="log", xlabel="Overturning amplitude [g]")
        low, high = axes.get_xlim()
        axes.set_xlim(min(low, 0.8 * high), high)
        plain_log(axes, "x")
        sides = list(dict.fromkeys(tests["pedestal"]))
        handles = []
        for side in sides if len(sides) > 1 else []:
            words, colour = f"tests {SIDE_NAME[side]}", SIDE_COLOUR[side]
            handles.append(
                Line2D([], [], ls="", marker="|", color=colour, ms=8, label=words)
            )
        if len(curves):
            words = "median, interval"
            handles.append(
                Line2D([], [], color=BLACK, marker="D", mfc="white", ms=4, label=words)
            )
        if tests["amplitude_g"].isna().any():
            handles.append(
                Line2D([], [], ls="", marker=5, color=GREY, label="bound only")
            )
        if handles:
            figure.legend(
                handles=handles, loc="outside upper center", ncols=2, handlelength=1.4
            )
        return figure


def could_change(results: Results) -> list[str]:
    """What could change the answer, each with the numbers that say how likely that is."""
    study, curves = results.study, results.table("fragility")
    friction = results.table("sliding" if study.slides else "validity")
    needed = ""
    if not study.slides and _needs_friction(results):
        needed = findings.friction_sentence(friction)
    lifts = study.vertical and not study.slides
    ratios = results.least_gravity_ratio if lifts else np.ones(0)
    fallen = results.table("resurrections").dropna(subset=["first_upper"])
    rejected = curves.loc[curves["p_fit"] < 0.05, "configuration"]
    words = [
        *says("sliding", study.slides, friction, needed),
        *says("flight", int((ratios < LIGHT).sum()), ratios.size),
        *says("few", _earthquakes(results)),
        *says("resurrections", int((fallen["resurrections"] > 0).sum()), len(fallen)),
        *says("shape", rejected.nunique(), curves["configuration"].nunique()),
    ]
    return [sentence(word) for word in words]
