"""Which perturbed parameters give the signs that the thesis reports on its floors."""

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.wording import agree, listed, of_all, sentence
from rockfrag_thesis.hypotheses.floors import FLOORS
from rockfrag_thesis.pattern import perturbations_by_floor
from rockfrag_thesis.sections.sensitivity_analysis import asks_sensitivity_analysis


def _section(results: Results) -> Section:
    table = perturbations_by_floor(results.table("sensitivity_analysis/effects"))
    named = list(table.loc[table["signs"], "name"])
    clear = list(table.loc[table["beyond_chance"], "name"])
    verb = agree(len(named), len(table), "gives", "give")
    message = (
        f"{sentence(of_all(len(named), len(table), 'perturbation'))} {verb} mean ratios with the signs "
        f"of the thesis."
    )
    words = [
        "The thesis reports a ratio above 1 on the ground floor and below 1 on the other two. The "
        "perturbations share the same pairs of tests, and many leave the ratio at exactly 1, so no chance "
        "level is given for them.",
        f"The mean ratios have these signs for {listed(named)}." if named else "",
        f"The intervals have them for {listed(clear)}."
        if clear
        else "No perturbation has its intervals on these sides.",
    ]
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
    return Section(
        "signs",
        "What would give the thesis’s signs",
        message,
        [word for word in words if word],
        [table_html(shown, columns, "Mean ratio of amplitudes with/without pedestal by floor.")],
    )


SIGNS = Part(("sensitivity_analysis/effects",), _section, asked=asks_sensitivity_analysis)
