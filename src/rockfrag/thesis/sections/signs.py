"""Which departures from the ideal model give the signs that the thesis reports on its floors."""

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.sections.explanation import asks_explanation
from rockfrag.report.wording import listed, number, of_all, sentence
from rockfrag.thesis.pattern import departures_by_floor, expected_by_chance
from rockfrag.thesis.statements.floors import FLOORS


def _section(results: Results) -> Section:
    table = departures_by_floor(results.table("explanation/effects"))
    named = list(table.loc[table["signs"], "name"])
    clear = list(table.loc[table["beyond_chance"], "name"])
    words = (
        f"{sentence(of_all(len(named), len(table), 'departure'))} give mean ratios with the signs that the "
        "thesis reports, above one on the ground floor and below one on the others"
        + (f" ({listed(named)})" if named else "")
        + f"; of so many without any effect {number(expected_by_chance(len(table)), 1)} would by chance. "
    )
    words += (
        f"With intervals on those sides: {listed(clear)}."
        if clear
        else "None has its intervals on those sides."
    )
    shown = table.assign(
        name=table["name"].map(sentence),
        signs=table["signs"].map({True: "yes", False: "no"}),
        beyond_chance=table["beyond_chance"].map({True: "yes", False: "no"}),
    )
    columns = [Column("name", "Departure from the ideal model")]
    columns += [Column(floor, f"P/NP on {floor}", 3) for floor in FLOORS]
    columns += [
        Column("signs", "Means have the signs"),
        Column("beyond_chance", "Intervals have them"),
    ]
    return Section(
        "signs",
        "What would give the thesis’s signs",
        words,
        [],
        [table_html(shown, columns, "Mean ratio P/NP by floor.")],
    )


SIGNS = Part(("explanation/effects",), _section, asked=asks_explanation)
