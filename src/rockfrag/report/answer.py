"""What stands first on the page of any study: the question, what was found, what to do, and what it rests on."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.figure_style import BLACK, COLUMN_WIDTH, one_panel, plain_log
from rockfrag.report import findings
from rockfrag.report.figures import GREY, SIDE_COLOUR, SIDE_NAME, drawn_tests
from rockfrag.report.part import Answer, FigureSpec, Finding, Results, figure_of
from rockfrag.report.wording import Macros, said, sentence, shortened

FEW = 10
"""Intervals over fewer earthquakes than this rest on little."""

QUESTIONS = (
    ("As recorded?", "as_recorded"),
    ("With pedestal?", "pedestal"),
    ("How strong?", "fragility"),
    ("How sure?", "grounds"),
    ("Try it", "live"),
)
"""What a keeper asks, and the chapter with the answer; a study without pairs is not asked the second."""


MOST_NAMED = 4
"""So many objects are named in the question."""


says = Macros("rockfrag.report", "answer.j2", {"FEW": FEW, "FRICTION": findings.FRICTION})


def study_answer(results: Results) -> Answer:
    """Return what stands first on the page of a study, made of its tables alone."""
    return Answer(
        asked=said(says.asked(results.objects, results.study, MOST_NAMED))[0],
        sentences=sentences(results),
        figure=_figure(results),
        advice=advice(results),
        rests_on=rests_on(results),
        could_change=could_change(results),
        questions=questions(results),
    )


def questions(results: Results) -> list[tuple[str, str]]:
    """Questions that a study's page answers."""
    study = results.study
    answered = {"pedestal": study.has_pairs, "live": study.simulated_in_page}
    asked = [question for question in QUESTIONS if answered.get(question[1], True)]
    if study.counterparts:
        return [
            ("Compared?" if section == "pedestal" else words, section) for words, section in asked
        ]
    return asked


def has_one_record(results: Results) -> bool:
    """Whether a study has a single record, of which no fragility can be made."""
    return len(results.records) == 1


def sentences(results: Results) -> list[Finding]:
    """How strong the shaking must be, what the motions do as recorded, and what the pedestal changes."""
    recorded = findings.recorded_found(results.table("as_recorded"))
    found = [_strength(results), recorded]
    if has_one_record(results):
        return [findings.amplitudes_found(results.tests), recorded, findings.ONE_MOTION]
    if results.study.has_pairs:
        return [
            *found,
            findings.pedestal_effect(
                results.table("pedestal/effects"), findings.sides_of(results.study)
            )[0],
        ]

    resurrections = findings.resurrections_found(
        results.table("resurrections"), results.table("tests")
    )
    return [
        *found,
        *findings.objects_compared(results.table("mean_amplitudes"), results.slenderness),
        resurrections,
    ][:3]


def _strength(results: Results) -> Finding:
    curves = results.table("fragility")
    known = curves[curves["theta"].notna()]
    return findings.strength_found(known, results.level) or findings.amplitudes_found(results.tests)


def advice(results: Results) -> list[str]:
    """What to do: the weakest first, and what would make the result more robust."""
    weakest: list[str] = []
    if not has_one_record(results):
        curves = findings.headline_curves(results.table("fragility")).rows
        curves = curves[curves["theta"].notna()]
        if len(curves) > 1 and curves["theta"].min() < curves["theta"].max():
            # within what three digits tell
            least = 1.005 * curves["theta"].min()
            weakest = curves.loc[curves["theta"] < least, "configuration"].tolist()
    may_slide = not results.study.slides and _needs_friction(results)
    return said(says.advice(weakest, may_slide, _earthquakes(results)))


def _needs_friction(results: Results) -> bool:
    """Whether any test needs more friction than dry stone has."""
    return bool(
        (~(results.table("validity")["friction_demand"].astype(float) <= findings.FRICTION)).any()
    )


def _earthquakes(results: Results) -> int:
    return int(results.study.catalogue["earthquake"].nunique())


def _figure(results: Results) -> FigureSpec:
    curves = findings.headline_curves(results.table("fragility")).rows
    # amplitudes are peaks of acceleration; a median in another measure has no place beside them
    curves = curves[(curves["unit"] == "g") & curves["theta"].notna()]
    if has_one_record(results):
        curves = curves.iloc[:0]
    names = [configuration.name for configuration in results.study.configurations]
    text = says.answer_figure(sentences(results)[0], results.level if len(curves) else "")
    return figure_of(text, "answer", lambda: strength_figure(results.tests, curves, names))


MOST_ROWS = 24
"""More configurations than this are not legible; the first are drawn."""


def strength_figure(tests: pd.DataFrame, curves: pd.DataFrame, names: Sequence[str]) -> Figure:
    """Draw a row for each configuration: its tests, and its curves with medians of PGA [g], if any."""
    shown = list(names)[:MOST_ROWS]
    with one_panel(COLUMN_WIDTH, 0.8 + 0.33 * len(shown)) as (figure, axes):
        for y, name in enumerate(shown):
            rows = drawn_tests(tests[tests["configuration"] == name])
            colour = SIDE_COLOUR[str(rows["pedestal"].iloc[0])]
            known = ~(rows["up"] | rows["down"])
            # carets to the right and to the left for bounds
            for own, marker, size in ((known, "|", 7), (rows["up"], 5, 5), (rows["down"], 4, 5)):
                x = rows.loc[own, "a"].to_numpy(dtype=float)
                axes.plot(x, np.full(x.size, y + 0.12), ls="", marker=marker, color=colour, ms=size)
            _median(figure, curves[curves["configuration"] == name], y - 0.2)
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
            handles.append(Line2D([], [], ls="", marker="|", color=colour, ms=8, label=words))
        if len(curves):
            words = "median, interval"
            handles.append(Line2D([], [], color=BLACK, marker="D", mfc="white", ms=4, label=words))
        if tests["amplitude_g"].isna().any():
            handles.append(Line2D([], [], ls="", marker=5, color=GREY, label="bound only"))
        if handles:
            figure.legend(handles=handles, loc="outside upper center", ncols=2, handlelength=1.4)
        return figure


def _median(figure: Figure, curve: pd.DataFrame, y: float) -> None:
    """Mark a median and its interval, where there are any."""
    axes = figure.axes[0]
    for row in curve.to_dict("records"):
        limits = [row["theta_lower"], row["theta_upper"]]
        if np.isfinite(limits).all() and limits[0] < limits[1]:
            axes.plot(limits, [y, y], color=BLACK, lw=1.2)
        axes.plot(row["theta"], y, "D", mec=BLACK, mfc="white", ms=4)


def rests_on(results: Results) -> list[str]:
    """What the numbers rest on: model, motions, building, steps."""
    return said(says.rests_on(results.study, _earthquakes(results)))


def could_change(results: Results) -> list[str]:
    """What could change the answer, each with the numbers that say how likely that is."""
    resurrections, curves = results.table("resurrections"), results.table("fragility")
    fallen = resurrections[resurrections["first_upper"].notna()]
    rejected = curves[curves["p_fit"] < 0.05]["configuration"].nunique()
    words = [
        *_friction_words(results),
        *_flight_words(results),
        *said(says.few(_earthquakes(results))),
        *said(says.resurrections(int((fallen["resurrections"] > 0).sum()), len(fallen))),
        *said(says.shape(rejected, curves["configuration"].nunique())),
    ]
    return [sentence(word) for word in words]


def _friction_words(results: Results) -> list[str]:
    """What friction could change, of bodies that slide and of bodies that are assumed not to."""
    if results.study.slides:
        sliding = results.table("sliding")
        other = int(sliding[["saved", "felled"]].to_numpy().sum())
        return said(says.assumed_friction(other, int(sliding["cases"].sum())))
    validity = results.table("validity")
    if validity.empty:
        return []
    needed = findings.friction_sentence(validity) if _needs_friction(results) else ""
    return said(says.sliding(needed))


def _flight_words(results: Results) -> list[str]:
    """In how many analyses the ground falls away so fast that bodies may leave it."""
    from rockfrag.rocking.ensemble import LIGHT

    if not results.study.vertical or results.study.slides:
        return []
    light = int((results.least_gravity_ratio < LIGHT).sum())
    return said(says.flight(light, np.size(results.least_gravity_ratio)))
