"""Answer on the first screen of a study's page: the question, findings, advice, grounds and doubts.

In: the results of a study. Out: :class:`rockfrag.report.part.Answer`, made of tables alone, so that every number
in it can be looked up there; its figure shows overturning amplitudes and medians as peaks [g].

Docs: ``docs/report.md``, "How it is told" and "Five questions of a keeper".
"""

from collections.abc import Sequence
from functools import partial

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.base.figure_style import BLACK, COLUMN_WIDTH, GREY, panels, plain_log
from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.report import findings
from rockfrag.report.figures import SIDE_COLOUR, SIDE_NAME, drawn_tests
from rockfrag.report.part import Answer, FigureSpec, Finding, Results, joined
from rockfrag.simulation.ensemble import LIGHT
from rockfrag.study.study import Study
from rockfrag.words.sentences import counted, listed, of_all, shortened

FEW = 10  # intervals over fewer earthquakes than this rest on little
MOST_NAMED = 4  # so many objects are named in the question


def study_answer(results: Results) -> Answer:
    """Answer on the first screen of a study's page.

    Parameters
    ----------
    results : tables of the study

    Returns
    -------
    The :class:`rockfrag.report.part.Answer`.
    """
    curves, found = _headline_curves(results), sentences(results)
    # amplitudes are peaks of acceleration; a median in another measure has no place beside them
    curves = curves[curves["unit"] == "g"]
    names = [configuration.name for configuration in results.study.configurations]
    medians = ""
    if len(curves):
        medians = f"Diamonds are medians with {results.level} intervals."
    figure = FigureSpec(
        name="answer",
        alt=f"Overturning amplitude of each configuration. {found[0].said}",
        caption=joined(
            "Peak acceleration that overturns, one mark per test; arrows are bounds.",
            medians,
        ),
        draw=partial(strength_figure, results.tests, curves, names),
    )
    return Answer(
        asked=_question(results.objects, results.study),
        sentences=found,
        figure=figure,
        advice=advice(results),
        rests_on=_rests_on(results),
        could_change=could_change(results),
        questions=_questions(results.study),
    )


def _question(names: Sequence[str], study: Study) -> str:
    """The question that the study asks, in words."""
    objects = listed(names)
    if len(names) > MOST_NAMED:
        objects = f"the {len(names)} objects"
    sides = ""
    if study.counterparts:
        sides = ", in each arrangement and in the one it is compared with"
    elif study.has_pairs:
        sides = f", with and without {'its' if len(names) == 1 else 'their'} pedestal"
    return f"How strong must shaking be to overturn {objects}{sides}?"


def _rests_on(results: Results) -> list[str]:
    """Model and motions on which the results of a study rest, a sentence or two each."""
    study, earthquakes = results.study, _earthquakes(results)
    if study.slides:
        model = "Rigid blocks that rock, slide and fly in the plane of the motion; impacts follow Coulomb's law."
    else:
        model = (
            "Rigid blocks that rock in the plane of the motion and neither slide nor jump. Energy loss at impact "
            "follows Housner (conservation of angular momentum)."
        )
    if study.vertical:
        model += " The vertical components of the records act too."
    amplitudes = study.amplitudes
    motions = (
        f"{counted(len(results.records), 'record')} of {counted(earthquakes, 'earthquake')}, each scaled to "
        f"{counted(len(amplitudes.values_g), 'amplitude')} from {amplitudes.lowest_g:g} to "
        f"{amplitudes.highest_g:g} g."
    )
    if study.building is None:
        return [model, motions]
    floors = f"The floor motions are those of a building model ({study.building.name}), not measured."
    return [model, motions, floors]


def _questions(study: Study) -> list[tuple[str, str]]:
    """Questions of a keeper of the objects, each with the anchor of the chapter that answers it."""
    questions = [("As recorded?", "as_recorded")]
    if study.has_pairs:
        compared = "Compared?" if study.counterparts else "With pedestal?"
        questions.append((compared, "pedestal"))
    questions += [("How strong?", "fragility"), ("How sure?", "grounds")]
    if study.simulated_in_page:
        questions.append(("Try it", "live"))
    return questions


def has_one_record(results: Results) -> bool:
    """Whether a study has a single record, of which no fragility can be made.

    Parameters
    ----------
    results : tables of the study

    Returns
    -------
    Whether it has.
    """
    return len(results.records) == 1


def sentences(results: Results) -> list[Finding]:
    """How strong the shaking must be, what the motions do as recorded, and what the pedestal changes."""
    table, sides = results.table, findings.sides_of(results.study)
    amplitudes = findings.amplitudes_found(results.tests)
    recorded = findings.recorded_found(table("as_recorded"))
    if has_one_record(results):
        return [amplitudes, recorded, findings.ONE_MOTION]
    curves = table("fragility").dropna(subset=["theta"])
    found = [findings.strength_found(curves, results.level) or amplitudes, recorded]
    if results.study.has_pairs:
        return [*found, findings.pedestal_effect(table("pedestal/effects"), sides)[0]]
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
    earthquakes = _earthquakes(results)
    words = []
    if weakest:
        words.append(f"Secure {listed(weakest)} first.")
    if may_slide:
        words.append(
            "Measure the friction of the contact surfaces: the objects may slide instead of rock."
        )
    if earthquakes < FEW and not (weakest and may_slide):
        number = "one is" if earthquakes == 1 else f"{earthquakes} are"
        words.append(f"Add records of other earthquakes; {number} too few.")
    return words


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
    return len({about["earthquake"] for about in results.records})


MOST_ROWS = 24  # more configurations than this are not legible; the first are drawn


def strength_figure(
    tests: pd.DataFrame, curves: pd.DataFrame, names: Sequence[str]
) -> Figure:
    """Draw a row for each configuration: its tests, and its curves with medians of PGA [g], if any."""
    shown = list(names)[:MOST_ROWS]
    with panels(COLUMN_WIDTH, 0.8 + 0.33 * len(shown)) as (figure, axes):
        for y, name in enumerate(shown):
            _draw_tests(axes, tests[tests["configuration"] == name], y + 0.12)
            _draw_medians(axes, curves[curves["configuration"] == name], y - 0.2)
        axes.set_ylim(len(shown) - 0.4, -0.6)
        axes.set_yticks(range(len(shown)), [shortened(name, 20) for name in shown])
        axes.tick_params(axis="y", length=0)
        axes.set(xscale="log", xlabel="Overturning amplitude [g]")
        low, high = axes.get_xlim()
        axes.set_xlim(min(low, 0.8 * high), high)
        plain_log(axes, "x")
        if handles := _marks(tests, curves):
            figure.legend(
                handles=handles, loc="outside upper center", ncols=2, handlelength=1.4
            )
        return figure


def _draw_tests(axes: Axes, tests: pd.DataFrame, y: float) -> None:
    """Draw the amplitudes of one configuration at a height; carets to the right and to the left are bounds."""
    rows = drawn_tests(tests)
    colour = SIDE_COLOUR[str(rows["pedestal"].iloc[0])]
    known = ~(rows["up"] | rows["down"])
    for own, marker, size in (
        (known, "|", 7),
        (rows["up"], 5, 5),
        (rows["down"], 4, 5),
    ):
        x = rows.loc[own, "a"].to_numpy(dtype=float)
        heights = np.full(x.size, y)
        axes.plot(x, heights, ls="", marker=marker, color=colour, ms=size)


def _draw_medians(axes: Axes, curves: pd.DataFrame, y: float) -> None:
    """Draw the medians of one configuration's curves at a height, with their intervals."""
    for row in curves.to_dict("records"):
        limits = [row["theta_lower"], row["theta_upper"]]
        if np.isfinite(limits).all() and limits[0] < limits[1]:
            axes.plot(limits, [y, y], color=BLACK, lw=1.2)
        axes.plot(row["theta"], y, "D", mec=BLACK, mfc="white", ms=4)


def _marks(tests: pd.DataFrame, curves: pd.DataFrame) -> list[Line2D]:
    """Marks of the legend, for what is drawn alone: tests by pedestal, medians, bounds."""
    handles = []
    sides = list(dict.fromkeys(tests["pedestal"]))
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
        handles.append(Line2D([], [], ls="", marker=5, color=GREY, label="bound only"))
    return handles


def could_change(results: Results) -> list[str]:
    """Conditions that could change the answer, each with the numbers that say how likely that is."""
    study, curves = results.study, results.table("fragility")
    ratios = np.ones(0)
    if study.vertical and not study.slides:
        ratios = results.least_gravity_ratio
    fallen = results.table("resurrections").dropna(subset=["first_upper"])
    survived = int((fallen["resurrections"] > 0).sum())
    rejected = curves.loc[curves["p_fit"] < REJECTED, "configuration"].nunique()
    words = [
        _sliding(results),
        _flight(int((ratios < LIGHT).sum()), ratios.size),
        _few(_earthquakes(results)),
        findings.scaled_far(results.table("scaling"), results.tests),
    ]
    if survived:
        counts = of_all(survived, len(fallen), "analysis", "analyses")
        words.append(
            f"Non-monotone response: a stronger motion was survived in {counts}."
        )
    if rejected:
        counts = of_all(rejected, curves["configuration"].nunique(), "configuration")
        words.append(
            f"The lognormal shape: it is rejected for {counts} in at least one definition."
        )
    return [word for word in words if word]


def _sliding(results: Results) -> str:
    """Sentence on what friction may change."""
    if results.study.slides:
        sliding = results.table("sliding")
        decided = int(sliding["saved"].sum() + sliding["felled"].sum())
        outcomes = of_all(decided, int(sliding["cases"].sum()), "outcome")
        return f"Another friction: the assumed one decides {outcomes}, and nobody measured it on these surfaces."
    validity = results.table("validity")
    if validity.empty:
        return ""
    if _needs_friction(results):
        return f"Sliding: {findings.friction_sentence(validity)}."
    return f"Sliding, on surfaces with a friction coefficient below {findings.FRICTION:g} (dry stone)."


def _flight(light: int, analyses: int) -> str:
    """Sentence on the analyses in which the ground takes more than half of all weight away."""
    if not light:
        return ""
    return (
        f"Flight: in {of_all(light, analyses, 'analysis', 'analyses')} the ground takes away more than half of "
        "all weight, so that bodies may leave it; the key friction lets them fly."
    )


def _few(earthquakes: int) -> str:
    """Sentence on how few the earthquakes are, empty if they are not."""
    if earthquakes == 1:
        return (
            "Other earthquakes: a single one does not show how much earthquakes differ."
        )
    if earthquakes < FEW:
        return f"Other earthquakes: these {earthquakes} are few, and the intervals describe only what they share."
    return ""
