"""What stands first on the page of any study: the question, what was found, what to do, and what it rests on."""

import numpy as np

from rockfrag.report.figures.answer import strength_figure
from rockfrag.report.findings import (
    FRICTION,
    ONE_MOTION,
    amplitudes_found,
    friction_sentence,
    headline_curves,
    objects_compared,
    pedestal_effect,
    recorded_found,
    resurrections_found,
    strength_found,
)
from rockfrag.report.part import Answer, FigureSpec, Finding, Results
from rockfrag.report.sides import sides_of
from rockfrag.report.wording import counted, listed, of_all, sentence

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


def study_answer(results: Results) -> Answer:
    """Return what stands first on the page of a study, made of its tables alone."""
    return Answer(
        asked=_asked(results),
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


def _asked(results: Results) -> str:
    names = results.objects
    which = f"the {len(names)} objects" if len(names) > MOST_NAMED else listed(names)
    its = "its" if len(names) == 1 else "their"
    sides = f", with and without {its} pedestal" if results.study.has_pairs else ""
    if results.study.counterparts:
        sides = ", in each arrangement and in the one it is compared with"
    return f"How strong must shaking be to overturn {which}{sides}?"


MOST_NAMED = 4
"""So many objects are named in the question."""


def has_one_record(results: Results) -> bool:
    """Whether a study has a single record, of which no fragility can be made."""
    return len(results.records) == 1


def sentences(results: Results) -> list[Finding]:
    """How strong the shaking must be, what the motions do as recorded, and what the pedestal changes."""
    recorded = recorded_found(results.table("as_recorded"))
    found = [_strength(results), recorded]
    if has_one_record(results):
        return [amplitudes_found(results.tests), recorded, ONE_MOTION]
    if results.study.has_pairs:
        return [
            *found,
            pedestal_effect(results.table("pedestal/effects"), sides_of(results.study))[0],
        ]
    slenderness = {name: results.study.specimens[name].slenderness for name in results.objects}
    resurrections = resurrections_found(results.table("resurrections"), results.table("tests"))
    return [
        *found,
        *objects_compared(results.table("mean_amplitudes"), slenderness),
        resurrections,
    ][:3]


def _strength(results: Results) -> Finding:
    level = f"{100 * results.study.fragility.confidence:g} %"
    curves = results.table("fragility")
    return strength_found(curves[curves["theta"].notna()], level) or amplitudes_found(results.tests)


def advice(results: Results) -> list[str]:
    """What to do: the weakest first, and what would make the result more robust."""
    words = []
    if not has_one_record(results):
        curves = headline_curves(results.table("fragility")).rows
        curves = curves[curves["theta"].notna()]
        if len(curves) > 1 and curves["theta"].min() < curves["theta"].max():
            # within what three digits tell
            weakest = curves.loc[curves["theta"] < 1.005 * curves["theta"].min(), "configuration"]
            words.append(f"Secure {listed(weakest.tolist())} first.")
    validity = results.table("validity")
    if not results.study.slides and len(validity):
        demand = validity["friction_demand"].to_numpy(dtype=float)
        if (~(demand <= FRICTION)).any():
            words.append(
                "Measure the friction of the contact surfaces: the objects may slide instead of rock."
            )
    earthquakes = results.study.catalogue["earthquake"].nunique()
    if earthquakes < FEW and not words[1:]:
        words.append(
            f"Add records of other earthquakes; {'one is' if earthquakes == 1 else f'{earthquakes} are'} too few."
        )
    return words


def _figure(results: Results) -> FigureSpec:
    curves = headline_curves(results.table("fragility")).rows
    # amplitudes are peaks of acceleration; a median in another measure has no place beside them
    curves = curves[(curves["unit"] == "g") & curves["theta"].notna()]
    if has_one_record(results):
        curves = curves.iloc[:0]
    names = [configuration.name for configuration in results.study.configurations]
    finding = sentences(results)[0]
    caption = "Peak acceleration that overturns, one mark per test; arrows are bounds."
    if len(curves):
        level = f"{100 * results.study.fragility.confidence:g} %"
        caption += f" Diamonds are medians with {level} intervals."
    return FigureSpec(
        "answer",
        f"Overturning amplitude of each configuration. {finding.said}",
        caption,
        lambda: strength_figure(results.tests, curves, names),
    )


def rests_on(results: Results) -> list[str]:
    """What the numbers rest on: model, motions, building, steps."""
    study = results.study
    motions, earthquakes = len(study.catalogue), study.catalogue["earthquake"].nunique()
    moves = (
        "Rigid blocks that rock, slide and fly in the plane of the motion; impacts follow Coulomb's law."
        if study.slides
        else "Rigid blocks that rock in the plane of the motion and neither slide nor jump. Energy loss at impact "
        "follows Housner (conservation of angular momentum)."
    )
    if study.vertical:
        moves += " The vertical components of the records act too."
    words = [
        moves,
        f"{counted(motions, 'record')} of {counted(earthquakes, 'earthquake')}, each scaled to "
        f"{counted(len(study.amplitudes.values_g), 'amplitude')} from {study.amplitudes.lowest_g:g} to "
        f"{study.amplitudes.highest_g:g} g.",
    ]
    if study.building is not None:
        words.append(
            f"The floor motions are those of a building model ({study.building.name}), not measured."
        )
    return words


def could_change(results: Results) -> list[str]:
    """What could change the answer, each with the numbers that say how likely that is."""
    words = [_friction_words(results)]
    if results.study.vertical and not results.study.slides:
        words.append(_flight_words(results))
    earthquakes = results.study.catalogue["earthquake"].nunique()
    if earthquakes < FEW:
        words.append(
            f"Other earthquakes: these {earthquakes} are few, and the intervals describe only what they share."
            if earthquakes > 1
            else "Other earthquakes: a single one does not show how much earthquakes differ."
        )
    resurrections = results.table("resurrections")
    fallen = resurrections[resurrections["first_upper"].notna()]
    with_resurrections = int((fallen["resurrections"] > 0).sum())
    if with_resurrections:
        words.append(
            f"Non-monotone response: a stronger motion was survived in "
            f"{of_all(with_resurrections, len(fallen), 'analysis', 'analyses')}."
        )
    curves = results.table("fragility")
    rejected = curves[curves["p_fit"] < 0.05]["configuration"].nunique()
    if rejected:
        words.append(
            f"The lognormal shape: it is rejected for "
            f"{of_all(rejected, curves['configuration'].nunique(), 'configuration')} in at least one definition."
        )
    return [sentence(word) for word in words if word]


def _friction_words(results: Results) -> str:
    """What friction could change, of bodies that slide and of bodies that are assumed not to."""
    if results.study.slides:
        sliding = results.table("sliding")
        other = int(sliding[["saved", "felled"]].to_numpy().sum())
        cases = int(sliding["cases"].sum())
        return (
            f"Another friction: the assumed one decides {of_all(other, cases, 'outcome')}, and nobody measured "
            "it on these surfaces."
        )
    validity = results.table("validity")
    if validity.empty:
        return ""
    if not (~(validity["friction_demand"].to_numpy(dtype=float) <= FRICTION)).any():
        return f"Sliding, on surfaces with a friction coefficient below {FRICTION:g} (dry stone)."
    return f"Sliding: {friction_sentence(validity)}."


def _flight_words(results: Results) -> str:
    """In how many analyses the ground falls away so fast that bodies may leave it."""
    from rockfrag.rocking.ensemble import LIGHT

    light = int((results.least_gravity_ratio < LIGHT).sum())
    if not light:
        return ""
    fraction = of_all(light, np.size(results.least_gravity_ratio), "analysis", "analyses")
    return (
        f"Flight: in {fraction} the ground takes away more than half of all weight, so that bodies may leave it; "
        "the key friction lets them fly."
    )
