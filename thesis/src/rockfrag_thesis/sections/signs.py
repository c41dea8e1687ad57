"""Which perturbed parameters give the signs that the thesis reports on its floors."""

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, section_of
from rockfrag.report.wording import sentence
from rockfrag_thesis.hypotheses.floors import FLOORS
from rockfrag_thesis.pattern import perturbations_by_floor
from rockfrag_thesis.sections.sensitivity_analysis import asks_sensitivity_analysis
from rockfrag_thesis.sections.words import sentences


def _section(results: Results) -> Section:
    table = perturbations_by_floor(results.table("sensitivity_analysis/effects"))
    named = list(table.loc[table["signs"], "name"])
    clear = list(table.loc[table["beyond_chance"], "name"])
    shown = table.assign(
        name=table["name"].map(sentence),
        signs=table["signs"].map({True: "yes", False: "no"}),
        beyond_chance=table["beyond_chance"].map({True: "yes", False: "no"}),
    )
    columns = [Column("name", "Perturbed parameter")]
    columns += [Column(floor, f"With/without pedestal on {floor}", 3) for floor in FLOORS]
    columns += [
        Column("signs", "Means have the signs"),
        Column("beyond_chance", "Intervals have them"),
    ]
    caption = "Mean ratio of amplitudes with/without pedestal by floor."
    text = sentences().signs(named, clear, len(table))
    return section_of(text, "signs", [table_html(shown, columns, caption)])


SIGNS = Part(("sensitivity_analysis/effects",), _section, asked=asks_sensitivity_analysis)
