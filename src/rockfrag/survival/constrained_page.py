"""The page of a site whose hazard was reweighted by survival, and the tables beside it."""

import json
import os
from collections.abc import Hashable
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure

from rockfrag.base import figure_style as style
from rockfrag.base.files import file_name, write_table, write_text
from rockfrag.report.page import Page, table_html
from rockfrag.report.part import Answer, Finding, Says, Section
from rockfrag.survival.reweight import DECISION_RATE, RULED_OUT, Constrained

BRANCHES = (
    "branch; weight_before .4; weight_after .4; survival = Probability that all stand .4",
)
OBJECTS = (
    "object; information_bit = Information alone [bit] .2",
    "level_ratio_alone = Level at 1e-4 with it alone, after / before .2",
    "level_ratio_without = Level at 1e-4 without it, after / before .2",
)
ASSUMED = ("assumption; level_ratio = Level at 1e-4, after / before .2",)


def write_constrained(found: Constrained, folder: str | os.PathLike[str]) -> Path:
    """Write page, JSON and tables of a site into a folder, and return the path of the page.

    Files: ``<site>.html``, ``<site>.json``, ``<site>-weights.csv`` (``rlz_id``, ``branch_path`` and ``weight`` as
    in OpenQuake's realizations, and the weight before) and ``<site>-curves.csv``.
    """
    stem = Path(folder) / file_name(found.site.name)
    write_table(weights_table(found), Path(f"{stem}-weights.csv"))
    write_table(found.result.curves(), Path(f"{stem}-curves.csv"))
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
        "limits": _say("limits"),
    }
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


_say = Says("rockfrag.survival", "page.j2", RULED_OUT=RULED_OUT)


def _sentences(found: Constrained) -> list[str]:
    """Hazard, branches, evidence and what the answer hangs on, a sentence each."""
    hazard = found.result.ratios().set_index("annual_rate")
    moved = found.sensitivity.iloc[1:]
    moved = moved[moved["level_ratio"] > 0]
    worst = None
    if len(moved) and found.result.level_ratio > 0:
        away = np.log(moved["level_ratio"] / found.result.level_ratio).abs()
        worst = moved.iloc[int(away.to_numpy().argmax())].to_dict()
    return _say("sentences", found, hazard.loc[DECISION_RATE].to_dict(), worst)


def lines_of(found: Constrained) -> list[str]:
    """The answer in lines for a screen."""
    return _say("lines", found, *_sentences(found))


def page_of(found: Constrained) -> str:
    """Return the page as HTML, which loads nothing from outside."""
    hazard, branches, *told = _sentences(found)
    (evidence, hangs_on), limits = told, _say("limits")
    names = ", ".join(body.name for body in found.site.objects)
    title, lead = _say("head", found, names)
    curves = _say.figure("curves", lambda: curves_figure(found), hazard)
    weights = _say.figure("weights", lambda: weights_figure(found))
    file = f"{file_name(found.site.name)}-weights.csv"
    caption = "Branches of the hazard with their weights."
    branch_table = table_html(found.result.table(), BRANCHES, caption, file)
    caption = "What each object says by itself, and what is left without it."
    objects = table_html(found.by_object, OBJECTS, caption)
    caption = "One assumption at a time taken otherwise."
    assumed = table_html(found.sensitivity, ASSUMED, caption)
    return Page(
        title=title,
        lead=lead,
        answer=Answer(
            asked="How strong can shaking have been, since these objects stand?",
            sentences=list(
                map(Finding, ("Hazard", "Evidence", "It hangs on"), (hazard, *told))
            ),
            figure=curves,
            rests_on=limits,
        ),
        sections=[
            Section(
                "hazard", "Mean hazard before and after", hazard, (), [_hazard(found)]
            ),
            Section("branches", "Branches", branches, (), [weights, branch_table]),
            Section("objects", "Which object decides", evidence, (), [objects]),
            Section("hangs-on", "What it hangs on", hangs_on, limits, [assumed]),
        ],
        provenance={"Program": f"rockfrag {version('rockfrag')}"},
    ).html()


def _hazard(found: Constrained) -> Markup:
    unit, table = found.site.measure.unit, found.result.ratios()
    table = table.assign(rate=table["annual_rate"].map("{:g}".format))
    shown = (
        f"rate = Annual rate [1/year] #; level_before = Before [{unit}] .3",
        f"level_after = After [{unit}] .3; level_ratio = Level after / before .2",
        "rate_ratio = Rate of the level before, after / before .2",
    )
    return table_html(table, shown, "Mean hazard at annual rates of 1e-2 to 1e-5.")


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
            low, high = (curves[f"fractile_{part}_{when}"] for part in ("0.16", "0.84"))
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
    before, after, place = (
        table["weight_before"],
        table["weight_after"],
        np.arange(len(table)),
    )
    with style.panels(style.WIDEST, 0.7 + 0.2 * len(table)) as (figure, axes):
        axes.hlines(place, before, after, color="#999999", linewidth=0.8)
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
