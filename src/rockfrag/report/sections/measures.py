"""Which intensity measure predicts overturning best."""

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, section_of
from rockfrag.report.sections.words import sentences
from rockfrag.stages.measure_selection import best_of

_COLUMNS = (
    Column("configuration", "Configuration"),
    Column("im", "Recommended"),
    Column("beta_amplitude", "β", 3),
    Column("auc", "AUC", 3),
    Column("chosen_fraction", "Fraction of bootstrap samples in which it is best", 2),
    Column("words", "Reasons"),
)


def _section(results: Results) -> Section:
    choice = results.table("measure_selection")
    asked = results.study.fragility.measures
    best = choice[choice["recommended"].astype(bool)]
    named = set(best["configuration"])
    none = [name for name in dict.fromkeys(choice["configuration"]) if name not in named]
    better = list(dict.fromkeys(best.loc[~best["measure"].isin(list(asked)), "im"]))
    compared = choice["measure"].nunique()
    text = sentences().measures(best_of(choice, asked), better, compared, none)
    caption = "Recommended measure of each configuration, with reasons."
    return section_of(text, "measures", [table_html(best, _COLUMNS, caption)])


MEASURES = Part(("measure_selection",), _section)
