"""What stands first on the page of a study that is compared with the thesis."""

from rockfrag.report.answer import could_overturn, questions, rests_on, study_answer
from rockfrag.report.part import Answer, FigureSpec, Results
from rockfrag.report.sections.explanation import asks_explanation
from rockfrag.report.sections.inversion import asks_inversion
from rockfrag.shaketable.readings import READING
from rockfrag.thesis.figures.answer import ratios_figure
from rockfrag.thesis.first_page import first_page


def thesis_answer(results: Results) -> Answer:
    """Return what the thesis reports, what the model gives, and what would give an effect."""
    study = results.study
    if not study.has_pairs:
        return study_answer(results)
    effects = results.table("pedestal/effects")
    explanation = results.table("explanation/effects") if asks_explanation(study) else None
    inversion = results.table("explanation/inversion") if asks_inversion(study) else None
    settings = study.more.explanation
    wanted = {} if settings is None else settings.wanted_percent
    found = first_page(effects, results.table("claims"), explanation, inversion, wanted)
    here = effects[effects["reading"] == READING]
    return Answer(
        asked="Does a pedestal make a statue overturn later on the ground and earlier on upper floors, as the "
        "thesis reports of its shake-table tests, if its towers only rock?",
        sentences=found,
        figure=FigureSpec(
            "answer",
            f"Amplitude with over amplitude without pedestal, with what the thesis reports. {found[0].headline}.",
            "Overturning amplitude with over that without pedestal, with 95 % intervals over earthquakes; grey is "
            "±10 %. Arrows show on which side of 1 the thesis reports each floor.",
            lambda: ratios_figure(here),
        ),
        rests_on=rests_on(results),
        could_overturn=could_overturn(results),
        questions=questions(results),
    )
