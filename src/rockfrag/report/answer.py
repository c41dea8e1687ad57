"""What stands first on the page of any study: the question, three sentences, one figure, and what they rest on."""

from rockfrag.report.figures.answer import strength_figure
from rockfrag.report.findings import (
    FRICTION,
    amplitudes_found,
    objects_compared,
    pedestal_effect,
    recorded_found,
    strength_found,
    windows_found,
)
from rockfrag.report.part import Answer, FigureSpec, Finding, Results
from rockfrag.report.wording import counted, listed, of_all, sentence

FEW = 10
"""Of fewer earthquakes than this the intervals rest on little."""

QUESTIONS = (
    ("Will it fall in a repeat?", "as_recorded"),
    ("Does the pedestal help?", "pedestal"),
    ("How strong must it be?", "fragility"),
    ("How sure is that?", "grounds"),
    ("What if it were 5 cm wider?", "live"),
)
"""What a keeper asks, and the chapter with the answer; a study without pairs is not asked the second."""


def study_answer(results: Results) -> Answer:
    """Return what stands first on the page of a study, made of its tables alone."""
    return Answer(
        asked=_asked(results),
        sentences=sentences(results),
        figure=_figure(results),
        rests_on=rests_on(results),
        could_overturn=could_overturn(results),
        questions=questions(results),
    )


def questions(results: Results) -> list[tuple[str, str]]:
    """Questions that a study's page answers."""
    study = results.study
    answered = {"pedestal": study.has_pairs, "live": study.simulated_in_page}
    return [one for one in QUESTIONS if answered.get(one[1], True)]


def _asked(results: Results) -> str:
    study = results.study
    sides = ", alone and on a pedestal," if study.has_pairs else ""
    events = study.catalogue["event"].nunique()
    where = (
        f" felt on {counted(len(study.floors), 'floor')} of a building" if study.building else ""
    )
    fall = "falls" if len(results.objects) == 1 else "fall"
    return (
        f"How strong must shaking be that {listed(results.objects)}{sides} {fall}, judged by "
        f" {counted(events, 'earthquake')}{where}?"
    )


def sentences(results: Results) -> list[Finding]:
    """How strong the shaking must be, what a repeat would do, and what the pedestal changes."""
    curves = results.table("fragility")
    level = f"{100 * results.study.fragility.confidence:g} %"
    strong = strength_found(curves[curves["theta"].notna()], level)
    found = [
        strong or amplitudes_found(results.tests),
        recorded_found(results.table("as_recorded")),
    ]
    if results.study.has_pairs:
        return [*found, pedestal_effect(results.table("pedestal/effects"))[0]]
    slenderness = {name: results.study.specimens[name].slenderness for name in results.objects}
    windows = windows_found(results.table("survival_windows"), results.table("tests"))
    return [*found, *objects_compared(results.table("mean_amplitudes"), slenderness), windows][:3]


def _figure(results: Results) -> FigureSpec:
    curves = results.table("fragility")
    curves = curves[
        (curves["im"] == curves["im"].iloc[0]) & (curves["estimator"] == "mean_probability")
    ]
    # amplitudes are peaks of acceleration; a median in another measure has no place beside them
    curves = curves[(curves["unit"] == "g") & curves["theta"].notna()]
    names = [one.name for one in results.study.configurations]
    finding = sentences(results)[0]
    return FigureSpec(
        "answer",
        f"Overturning amplitude of each configuration. {finding.said}",
        "Peak acceleration of the motion that overturns. Marks are tests, those with arrows bounds; diamonds are "
        "medians with their intervals.",
        lambda: strength_figure(results.tests, curves, names),
    )


def rests_on(results: Results) -> list[str]:
    """What the numbers rest on: model, motions, building, steps."""
    study = results.study
    motions, events = len(study.catalogue), study.catalogue["event"].nunique()
    moves = (
        "Rigid blocks that rock, slide and fly in the plane of the motion; impacts follow Coulomb's law."
        if study.slides
        else "Rigid blocks that rock in the plane of the motion and neither slide nor jump; impacts conserve "
        "angular momentum."
    )
    if study.vertical:
        moves += " The vertical components of the records shake them too."
    words = [
        moves,
        f"{counted(motions, 'record')} of {counted(events, 'earthquake')}, each scaled to "
        f"{counted(len(study.amplitudes.values_g), 'amplitude')} from {study.amplitudes.lowest_g:g} to "
        f"{study.amplitudes.highest_g:g} g.",
    ]
    if study.building is not None:
        words.append(
            f"Floors are those of a model of a building ({study.building.name}); what is said of floors is "
            "said of that model."
        )
    return words


def could_overturn(results: Results) -> list[str]:
    """What would make the answer wrong, each with the numbers that say how likely that is."""
    words = []
    validity = results.table("validity")
    if results.study.slides:
        sliding = results.table("sliding")
        other, cases = (
            int(sliding[["saved", "felled"]].to_numpy().sum()),
            int(sliding["cases"].sum()),
        )
        words.append(
            f"Another friction: that of this study decides {of_all(other, cases, 'case')}, which nobody measured "
            "on these surfaces."
        )
    elif len(validity):
        demand = validity["friction_demand"].to_numpy(dtype=float)
        slides = int((~(demand <= FRICTION)).sum())
        words.append(
            f"Sliding: {of_all(slides, len(demand), 'test')} {'needs' if slides == 1 else 'need'} more than the "
            f"friction of dry stone ({FRICTION:g})."
            if slides
            else f"Sliding, on surfaces with less friction than dry stone ({FRICTION:g}), which holds every test."
        )
    if results.study.vertical and not results.study.slides:
        from rockfrag.rocking.ensemble import LIGHT

        lightest = results.lightest
        light = int((lightest < LIGHT).sum())
        if light:
            words.append(
                f"Flight: in {of_all(light, len(lightest), 'case')} the ground takes more than half of all weight "
                "away, where bodies may leave it; the key friction lets them fly."
            )
    events = results.study.catalogue["event"].nunique()
    if events < FEW:
        words.append(
            f"Other earthquakes: {events} are few, and limits can only say what these have in common."
            if events > 1
            else "Other earthquakes: from one of them nobody knows how much they differ."
        )
    windows = results.table("survival_windows")
    fallen = windows[windows["first_upper"].notna()]
    with_windows = int((fallen["windows"] > 0).sum())
    if with_windows:
        words.append(
            f"Luck: {of_all(with_windows, len(fallen), 'overturning sweep')} "
            f"{'has' if with_windows == 1 else 'have'} amplitudes that are survived above one that overturns."
        )
    curves = results.table("fragility")
    doubtful = curves[curves["p_fit"] < 0.05]["configuration"].nunique()
    if doubtful:
        words.append(
            f"The lognormal shape: it does not describe the verdicts of "
            f"{of_all(doubtful, curves['configuration'].nunique(), 'configuration')} in every reading."
        )
    return [sentence(one) for one in words]
