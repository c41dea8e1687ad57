"""Page of a site whose hazard was reweighted by survival, and the tables beside it.

In: :class:`rockfrag.survival.reweight.Constrained`. Out: HTML, JSON and CSV files, and lines for a screen;
levels in the unit of the hazard's measure, annual rates [1/year], information [bit].

Theory: ``docs/survival.md``, "How it is calculated" and "What it cannot say".
"""

import json
import os
from collections.abc import Hashable
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure

from rockfrag.base import figure_style as style
from rockfrag.base.files import file_name, write_table, write_text
from rockfrag.report.page import Page, column, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section
from rockfrag.survival.reweight import DECISION_RATE, RULED_OUT, Constrained

BRANCHES = (
    column("branch"),
    column("weight_before", decimals=4),
    column("weight_after", decimals=4),
    column("survival", "Probability that all stand", decimals=4),
)
OBJECTS = (
    column("object"),
    column("information_bit", "Information alone [bit]", decimals=2),
    column(
        "level_ratio_alone", "Level at 1e-4 with it alone, after / before", decimals=2
    ),
    column(
        "level_ratio_without", "Level at 1e-4 without it, after / before", decimals=2
    ),
)
ASSUMED = (
    column("assumption"),
    column("level_ratio", "Level at 1e-4, after / before", decimals=2),
)

LIMITS = (
    "Survival tells how strong shaking at the site has been since the objects stand, not how strong it will be "
    "in the next 50 years if rates change.",
    "The fragility is that of today; an object that was broader or lower, buried or supported was less fragile "
    "then, and counts for less: state since when with fragile_for_years.",
    "The branches are reweighted, not validated: if none of them is right, none of the new weights is.",
)
"""Limits of every answer, a sentence each."""


def write_constrained(found: Constrained, folder: str | os.PathLike[str]) -> Path:
    """Write page, JSON and tables of a site into a folder, and return the path of the page.

    Files: ``<site>.html``, ``<site>.json``, ``<site>-weights.csv`` (``rlz_id``, ``branch_path`` and ``weight`` as
    in OpenQuake's realizations, and the weight before) and ``<site>-curves.csv``.

    Parameters
    ----------
    found, folder : the site with its new weights, and where files go

    Returns
    -------
    Path of the page.
    """
    stem = Path(folder) / file_name(found.site.name)
    write_table(weights_table(found), Path(f"{stem}-weights.csv"))
    write_table(found.result.curves(), Path(f"{stem}-curves.csv"))
    write_text(json_of(found), f"{stem}.json")
    page = Path(f"{stem}.html")
    write_text(page_of(found), page)
    return page


def weights_table(found: Constrained) -> pd.DataFrame:
    """Weights by branch, with the columns of OpenQuake's realizations and the weight before."""
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
    """Numbers of the answer as JSON.

    Parameters
    ----------
    found : the site with its new weights

    Returns
    -------
    JSON.
    """
    tables = {
        "branches": found.result.table(),
        "mean_hazard": found.result.ratios(),
        "objects": found.by_object,
        "sensitivity": found.sensitivity,
    }
    content = {
        "site": found.site.name,
        "measure": found.site.measure.imt,
        "unit": found.site.measure.unit,
        "information_bit": found.result.information,
        "ruled_out": found.ruled_out,
        **{
            name: json.loads(table.to_json(orient="records"))
            for name, table in tables.items()
        },
        "limits": list(LIMITS),
    }
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


class _Sentences(NamedTuple):
    """The answer, a sentence each."""

    hazard: str
    branches: str
    evidence: str
    hangs_on: str  # the assumption that changes it most


def _sentences(found: Constrained) -> _Sentences:
    """What the page says first: of the hazard, the branches, the evidence and what it hangs on."""
    branches = (
        f"{len(found.ruled_out)} of {len(found.site.branches)} branches keep less than {100 * RULED_OUT:.0f} % "
        "of their weight."
    )
    return _Sentences(
        _hazard_sentence(found),
        branches,
        _evidence_sentence(found),
        _sensitivity_sentence(found),
    )


def _hazard_sentence(found: Constrained) -> str:
    """Change of the mean hazard at the annual rate of decisions."""
    measure = found.site.measure
    decided = found.result.ratios().set_index("annual_rate").loc[DECISION_RATE]
    if not decided["level_ratio"] > 0:
        return "The mean hazard at 1e-4 a year lies beyond the curves; extend them."
    change = decided["level_ratio"] - 1
    return (
        f"The mean {measure.imt} at 1e-4 a year is {decided['level_after']:.3g} {measure.unit} after "
        f"{decided['level_before']:.3g} {measure.unit} before, {100 * abs(change):.0f} % "
        f"{'lower' if change < 0 else 'higher'}."
    )


def _evidence_sentence(found: Constrained) -> str:
    """Object that moves the weights most."""
    first = found.by_object.to_dict("records")[0]
    if len(found.by_object) == 1:
        return f"{first['object']} is the only object; one object is weak evidence."
    without = ""
    if (ratio := first["level_ratio_without"]) > 0:
        without = f"; without it the mean hazard at 1e-4 a year is {ratio:.2f} times that before"
    return f"{first['object']} tells most ({first['information_bit']:.2f} bit alone){without}."


def _sensitivity_sentence(found: Constrained) -> str:
    """Assumption without which the level changes most."""
    moved = found.sensitivity.iloc[1:]
    moved = moved[moved["level_ratio"] > 0]
    if moved.empty or not found.result.level_ratio > 0:
        return "No assumption can be named, as the level at 1e-4 a year lies beyond the curves."
    away = np.log(moved["level_ratio"] / found.result.level_ratio).abs()
    worst = moved.iloc[int(away.to_numpy().argmax())]
    return (
        f"With {worst['assumption']} the level would be {worst['level_ratio']:.2f} times that before, with all as "
        f"stated {found.result.level_ratio:.2f} times."
    )


def lines_of(found: Constrained) -> list[str]:
    """Answer in lines for a screen.

    Parameters
    ----------
    found : the site with its new weights

    Returns
    -------
    The lines.
    """
    words = _sentences(found)
    branches = words.branches.replace(" branches", "", 1).rstrip(".")
    moved = f"{found.result.information:.2f} bit"
    return [
        f"Hazard    {words.hazard}",
        f"Branches  {branches}; the weights moved by {moved}.",
        f"Evidence  {words.evidence}",
        f"Hangs on  {words.hangs_on}",
        f"Limits    {' '.join(LIMITS)}",
    ]


def page_of(found: Constrained) -> str:
    """Page as HTML, which loads nothing from outside.

    Parameters
    ----------
    found : the site with its new weights

    Returns
    -------
    HTML.
    """
    words = _sentences(found)
    names = ", ".join(body.name for body in found.site.objects)
    curves = FigureSpec(
        name="curves",
        alt=f"Mean hazard before and after survival. {words.hazard}",
        caption=(
            "Mean hazard before (dashed) and after survival (solid); shaded from the 16th to the 84th "
            "percentile of the branches."
        ),
        draw=lambda: curves_figure(found),
    )
    weights = FigureSpec(
        name="weights",
        alt="Weights of the branches before and after survival.",
        caption="Weights of the branches that matter most.",
        draw=lambda: weights_figure(found),
    )
    file = f"{file_name(found.site.name)}-weights.csv"
    caption = "Branches of the hazard with their weights."
    branch_table = table_html(found.result.table(), BRANCHES, caption, file)
    caption = "What each object says by itself, and what is left without it."
    objects = table_html(found.by_object, OBJECTS, caption)
    caption = "One assumption at a time taken otherwise."
    assumed = table_html(found.sensitivity, ASSUMED, caption)
    return Page(
        title=f"What {names} say about the hazard of {found.site.name}",
        lead=(
            f"{len(found.site.branches)} branches of the hazard reweighted by what still stands: {names}."
        ),
        answer=Answer(
            asked="How strong can shaking have been, since these objects stand?",
            sentences=[
                Finding("Hazard", words.hazard),
                Finding("Evidence", words.evidence),
                Finding("It hangs on", words.hangs_on),
            ],
            figure=curves,
            rests_on=LIMITS,
        ),
        sections=[
            Section(
                "hazard",
                "Mean hazard before and after",
                words.hazard,
                (),
                [_hazard(found)],
            ),
            Section(
                "branches", "Branches", words.branches, (), [weights, branch_table]
            ),
            Section("objects", "Which object decides", words.evidence, (), [objects]),
            Section("hangs-on", "What it hangs on", words.hangs_on, LIMITS, [assumed]),
        ],
        provenance={"Program": f"rockfrag {version('rockfrag')}"},
    ).html()


def _hazard(found: Constrained) -> Markup:
    """Table of the mean hazard before and after."""
    unit, table = found.site.measure.unit, found.result.ratios()
    table = table.assign(rate=table["annual_rate"].map("{:g}".format))
    columns = (
        column("rate", "Annual rate [1/year]", numeric=True),
        column("level_before", f"Before [{unit}]", decimals=3),
        column("level_after", f"After [{unit}]", decimals=3),
        column("level_ratio", "Level after / before", decimals=2),
        column("rate_ratio", "Rate of the level before, after / before", decimals=2),
    )
    return table_html(table, columns, "Mean hazard at annual rates of 1e-2 to 1e-5.")


# Branches whose weights are drawn: those that matter most before or after
MOST_BRANCHES_SHOWN = 20
LONGEST_LABEL = 34  # Characters of a branch's name beside its weights


def curves_figure(found: Constrained) -> Figure:
    """Mean hazard before and after, with the range of the branches from the 16th to the 84th percentile."""
    measure = found.site.measure
    curves = found.result.curves()
    level = curves["level"].to_numpy()
    with style.panels(style.COLUMN_WIDTH, 2.8) as (figure, axes):
        for when, colour, line, words in (
            ("before", style.ORANGE, "--", "before"),
            ("after", style.BLUE, "-", "after survival"),
        ):
            low, high = curves[f"fractile_0.16_{when}"], curves[f"fractile_0.84_{when}"]
            axes.fill_between(level, low, high, color=colour, alpha=0.2, linewidth=0)
            mean = curves[f"mean_{when}"]
            axes.plot(level, mean, color=colour, linestyle=line, label=f"mean {words}")
        rates = curves[["mean_before", "mean_after"]].to_numpy()
        axes.set(
            ylim=(max(rates[-1].min(), 1e-6), min(rates[0].max() * 1.5, 10.0)),
            xlabel=f"{measure.imt} of the ground [{measure.unit}]",
            ylabel="Annual rate of exceedance [1/year]",
        )
        style.plain_log(axes, "xy")
        axes.legend(loc="lower left")
    return figure


def weights_figure(found: Constrained) -> Figure:
    """Weights of the branches before and after, those that matter most."""
    table = found.result.table()
    largest = table[["weight_before", "weight_after"]].max(axis=1)
    order = largest.sort_values(ascending=False, kind="stable").index
    table = table.loc[order[:MOST_BRANCHES_SHOWN]].sort_values(
        "weight_after", kind="stable"
    )
    before, after = table["weight_before"], table["weight_after"]
    place = np.arange(len(table))
    with style.panels(style.WIDEST, 0.7 + 0.2 * len(table)) as (figure, axes):
        axes.hlines(place, before, after, color=style.GUIDE, linewidth=0.8)
        axes.plot(
            before,
            place,
            "o",
            color=style.ORANGE,
            markerfacecolor="none",
            label="before",
        )
        axes.plot(after, place, "s", color=style.BLUE, label="after survival")
        names = [_short(name, number) for number, name in table["branch"].items()]
        axes.set_yticks(place, names)
        axes.set(xlabel="Weight of the branch [-]", xlim=(0, None))
        figure.legend(loc="outside upper center", ncols=2)
    return figure


def _short(name: str, number: Hashable) -> str:
    """Name of a branch that fits beside an axis: a long one by its place in the table and its end."""
    short = f"row {int(str(number)) + 1}: …{name[8 - LONGEST_LABEL :]}"
    return name if len(name) <= LONGEST_LABEL else short
