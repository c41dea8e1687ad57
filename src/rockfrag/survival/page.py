"""The page of a site whose hazard was reweighted by survival, and the tables beside it."""

import json
import os
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.files import file_name, write_table, write_text
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section
from rockfrag.report.study_report import page_text
from rockfrag.survival.answer import DECISION_RATE, LIMITS, RULED_OUT, Constrained
from rockfrag.survival.figures import curves_figure, weights_figure


def write_constrained(found: Constrained, folder: str | os.PathLike[str]) -> Path:
    """Write page, JSON and tables of a site into a folder, and return the path of the page.

    Files: ``<site>.html``, ``<site>.json``, ``<site>-weights.csv`` (``rlz_id``, ``branch_path`` and ``weight`` as
    in OpenQuake's realizations, and the weight before) and ``<site>-curves.csv``.
    """
    stem = Path(folder) / file_name(found.site.name)
    write_table(weights_table(found), Path(f"{stem}-weights.csv"))
    write_table(found.result.curves(found.site.measure), Path(f"{stem}-curves.csv"))
    write_text(json_of(found), f"{stem}.json")
    page = Path(f"{stem}.html")
    write_text(page_of(found), page)
    return page


def weights_table(found: Constrained) -> pd.DataFrame:
    """A row a branch, its columns those of OpenQuake's realizations and what it had before."""
    table = found.result.table()
    numbers = table["branch"].str.extract(r"^rlz-(\d+)")[0]
    paths = table["branch"].str.replace(r"^rlz-\d+ ?", "", regex=True)
    return pd.DataFrame(
        {
            "rlz_id": np.where(numbers.isna(), table.index, numbers).astype(int),
            "branch_path": paths,
            "weight": table["weight_after"],
            "weight_before": table["weight_before"],
            "survival": table["survival"],
        }
    )


def json_of(found: Constrained) -> str:
    """All numbers of the answer as JSON."""
    tables = {
        "branches": found.result.table(),
        "mean_hazard": found.result.ratios(found.site.measure),
        "objects": found.by_object,
        "sensitivity": found.sensitivity,
    }
    content = {
        "site": found.site.name,
        "measure": found.site.measure.imt,
        "unit": found.site.measure.unit,
        "information_bit": found.result.information,
        "ruled_out": found.ruled_out,
        **{name: json.loads(table.to_json(orient="records")) for name, table in tables.items()},
        "limits": list(LIMITS),
    }
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def lines_of(found: Constrained) -> list[str]:
    """The answer in lines for a screen."""
    objects = found.by_object
    ruled = len(found.ruled_out)
    return [
        f"Hazard    {_level_sentence(found)}",
        f"Branches  {ruled} of {len(found.result.branches)} keep less than {100 * RULED_OUT:.0f} % of their "
        f"weight; the "
        f"weights moved by {found.result.information:.2f} bit.",
        f"Evidence  {_object_sentence(objects)}",
        f"Hangs on  {_sensitivity_sentence(found)}",
        f"Limits    {' '.join(LIMITS)}",
    ]


def _level_sentence(found: Constrained) -> str:
    measure = found.site.measure
    row = found.result.ratios(measure).set_index("annual_rate").loc[DECISION_RATE]
    if not row["level_ratio"] > 0:
        return "The mean hazard at 1e-4 a year lies beyond the curves; extend them."
    change = row["level_ratio"] - 1
    direction = "lower" if change < 0 else "higher"
    return (
        f"The mean {measure.imt} at 1e-4 a year is {row['level_after']:.3g} {measure.unit} after "
        f"{row['level_before']:.3g} {measure.unit} before, {100 * abs(change):.0f} % {direction}."
    )


def _object_sentence(objects: pd.DataFrame) -> str:
    first = objects.iloc[0]
    if len(objects) == 1:
        return f"{first['object']} is the only object; one object is weak evidence."
    most = f"{first['object']} tells most ({first['information_bit']:.2f} bit alone)"
    if not first["level_ratio_without"] > 0:
        return f"{most}."
    return (
        f"{most}; without it the mean hazard at 1e-4 a year is {first['level_ratio_without']:.2f} times that "
        "before."
    )


def _sensitivity_sentence(found: Constrained) -> str:
    table = found.sensitivity.iloc[1:]
    table = table[table["level_ratio"] > 0]
    if table.empty or not found.level_ratio > 0:
        return "No assumption can be named, as the level at 1e-4 a year lies beyond the curves."
    away = (table["level_ratio"] / found.level_ratio).map(abs).map(lambda r: max(r, 1 / r))
    row = table.iloc[int(away.to_numpy().argmax())]
    return (
        f"With {row['assumption']} the level would be {row['level_ratio']:.2f} times that before, with all as "
        f"stated {found.level_ratio:.2f} times."
    )


def page_of(found: Constrained) -> str:
    """Return the page as HTML, which loads nothing from outside."""
    curves = FigureSpec(
        "curves",
        f"Mean hazard before and after survival. {_level_sentence(found)}",
        "Mean hazard before (dashed) and after survival (solid); shaded from the 16th to the 84th percentile "
        "of the branches.",
        lambda: curves_figure(found),
    )
    weights = FigureSpec(
        "weights",
        "Weights of the branches before and after survival.",
        "Weights of the branches that matter most.",
        lambda: weights_figure(found),
    )
    names = ", ".join(body.name for body in found.site.objects)
    return page_text(
        title=f"What {names} say about the hazard of {found.site.name}",
        lead=f"{len(found.result.branches)} branches of the hazard reweighted by what still stands: {names}.",
        answer=Answer(
            asked="How strong can shaking have been, since these objects stand?",
            sentences=[
                Finding("Hazard", _level_sentence(found)),
                Finding("Evidence", _object_sentence(found.by_object)),
                Finding("It hangs on", _sensitivity_sentence(found)),
            ],
            figure=curves,
            rests_on=LIMITS,
        ),
        sections=[_hazard(found), _branches(found, weights), _objects(found), _hangs_on(found)],
        provenance={"Program": f"rockfrag {version('rockfrag')}"},
    )


def _hazard(found: Constrained) -> Section:
    unit = found.site.measure.unit
    columns = (
        Column("annual_rate", "Annual rate [1/year]", numeric=True),
        Column("level_before", f"Before [{unit}]", 3),
        Column("level_after", f"After [{unit}]", 3),
        Column("level_ratio", "Level after / before", 2),
        Column("rate_ratio", "Rate of the level before, after / before", 2),
    )
    table = found.result.ratios(found.site.measure)
    table["annual_rate"] = [f"{rate:g}" for rate in table["annual_rate"]]
    return Section(
        "hazard",
        "Mean hazard before and after",
        _level_sentence(found),
        (),
        [table_html(table, columns, "Mean hazard at annual rates of 1e-2 to 1e-5.")],
    )


def _branches(found: Constrained, weights: FigureSpec) -> Section:
    columns = (
        Column("branch", "Branch"),
        Column("weight_before", "Weight before", 4),
        Column("weight_after", "Weight after", 4),
        Column("survival", "Probability that all stand", 4),
    )
    ruled = len(found.ruled_out)
    return Section(
        "branches",
        "Branches",
        f"{ruled} of {len(found.result.branches)} branches keep less than {100 * RULED_OUT:.0f} % of their "
        "weight.",
        (),
        [
            weights,
            table_html(
                found.result.table(),
                columns,
                "Branches of the hazard with their weights.",
                f"{file_name(found.site.name)}-weights.csv",
            ),
        ],
    )


def _objects(found: Constrained) -> Section:
    columns = (
        Column("object", "Object"),
        Column("information_bit", "Information alone [bit]", 2),
        Column("level_ratio_alone", "Level at 1e-4 with it alone, after / before", 2),
        Column("level_ratio_without", "Level at 1e-4 without it, after / before", 2),
    )
    return Section(
        "objects",
        "Which object decides",
        _object_sentence(found.by_object),
        (),
        [
            table_html(
                found.by_object,
                columns,
                "What each object says by itself, and what is left without it.",
            )
        ],
    )


def _hangs_on(found: Constrained) -> Section:
    columns = (
        Column("assumption", "Assumption"),
        Column("level_ratio", "Level at 1e-4, after / before", 2),
    )
    return Section(
        "hangs-on",
        "What it hangs on",
        _sensitivity_sentence(found),
        LIMITS,
        [table_html(found.sensitivity, columns, "One assumption at a time taken otherwise.")],
    )
