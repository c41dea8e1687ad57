"""What stands first on the page of a study that is compared with the thesis."""

from rockfrag.report.answer import could_change, questions, rests_on, study_answer
from rockfrag.report.findings import FRICTION
from rockfrag.report.part import Answer, Results, figure_of
from rockfrag.report.wording import said
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag_thesis.figures.answer import has_thesis_floors, ratios_figure
from rockfrag_thesis.first_page import first_page
from rockfrag_thesis.sections.inverse_problem import asks_inverse_problem
from rockfrag_thesis.sections.sensitivity_analysis import asks_sensitivity_analysis
from rockfrag_thesis.sections.words import sentences
from rockfrag_thesis.settings import settings_of


def thesis_answer(results: Results) -> Answer:
    """Return what the thesis reports, what the model gives, and what would give an effect."""
    study = results.study
    if not study.has_pairs:
        return study_answer(results)
    effects = results.table("pedestal/effects")
    sensitivity_analysis = (
        results.table("sensitivity_analysis/effects") if asks_sensitivity_analysis(study) else None
    )
    inverse_problem = (
        results.table("sensitivity_analysis/inverse_problem")
        if asks_inverse_problem(study)
        else None
    )
    settings = settings_of(study).sensitivity_analysis
    wanted = {} if settings is None else settings.wanted_percent
    found = first_page(
        effects, results.table("hypotheses"), sensitivity_analysis, inverse_problem, wanted
    )
    here = effects[effects["definition"] == DEFINITION]
    return Answer(
        asked="Does a pedestal delay overturning on the ground and hasten it on upper floors?",
        sentences=found,
        figure=figure_of(
            sentences().answer_figure(found[0].headline, has_thesis_floors(here)),
            "answer",
            lambda: ratios_figure(here),
        ),
        advice=_advice(results),
        rests_on=rests_on(results),
        could_change=could_change(results),
        questions=questions(results),
    )


def _advice(results: Results) -> list[str]:
    """What to measure: the friction that rocking without sliding needs, where that is much."""
    validity = results.table("validity")
    if results.study.slides or validity.empty:
        return []
    with_pedestal = validity[validity["pedestal"] == "P"]
    beyond = int((~(with_pedestal["friction_demand"].astype(float) <= FRICTION)).sum())
    return said(sentences().advice(beyond, len(with_pedestal), FRICTION))
