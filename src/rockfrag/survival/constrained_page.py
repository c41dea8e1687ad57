"""Page of a site whose hazard was reweighted by survival, and the tables beside it.

In: :class:`rockfrag.survival.reweight.Constrained`. Out: HTML, JSON and CSV files, and lines for a screen;
levels in the unit of the hazard's measure, annual rates [1/year], information [bit]. Words are those of the
catalogue of a language.

Theory: ``docs/survival.md``, "How it is calculated" and "What it cannot say".
"""

import json
import os
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure

from rockfrag.base import figure_style as style
from rockfrag.base.files import file_name, write_table, write_text
from rockfrag.report.page import Page, column, table_html
from rockfrag.report.part import Answer, FigureSpec, Section
from rockfrag.report.part import Finding as Shown
from rockfrag.survival.reweight import DECISION_RATE, IN_SPACE, RULED_OUT, Constrained
from rockfrag.survival.site import UNNAMED
from rockfrag.words.catalogue import FIRST, Catalogue, catalogue
from rockfrag.words.findings import Finding, Value, finding, listed, three, two, whole

LIMITS = ("site_limit_past", "site_limit_fragility", "site_limit_branches")
"""Texts of the limits of every answer, a sentence each."""

ASSUMPTIONS = {
    "as_stated": "site_assumption_as_stated",
    "half_as_old": "site_assumption_half_as_old",
    "twice_as_old": "site_assumption_twice_as_old",
    "stronger": "site_assumption_stronger",
    "weaker": "site_assumption_weaker",
    "in_space": "site_assumption_in_space",
    "independent_errors": "site_assumption_independent",
    "shared_errors": "site_assumption_shared",
}
"""Texts of what is taken otherwise, by its name in the table of sensitivities."""


def write_constrained(
    found: Constrained, folder: str | os.PathLike[str], language: str = FIRST
) -> Path:
    """Write page, JSON and tables of a site into a folder, and return the path of the page.

    Files: ``<site>.html``, ``<site>.json``, ``<site>-weights.csv`` (``rlz_id``, ``branch_path`` and ``weight`` as
    in OpenQuake's realizations, and the weight before) and ``<site>-curves.csv``.

    Parameters
    ----------
    found : the site with its new weights
    folder, language : where files go, and the language of the page

    Returns
    -------
    Path of the page.
    """
    stem = Path(folder) / file_name(found.site.name)
    write_table(weights_table(found), Path(f"{stem}-weights.csv"))
    write_table(found.result.curves(), Path(f"{stem}-curves.csv"))
    write_text(json_of(found), f"{stem}.json")
    page = Path(f"{stem}.html")
    write_text(page_of(found, language), page)
    return page


def weights_table(found: Constrained) -> pd.DataFrame:
    """Weights by branch, with the columns of OpenQuake's realizations and the weight before.

    A branch of OpenQuake is called ``rlz-NUMBER PATH``; one without a number gets that of its row.
    """
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
    texts = catalogue()
    tables = {
        "branches": found.result.table(),
        "mean_hazard": found.result.ratios(),
        "objects": found.by_object,
        "sensitivity": _assumed(found, texts),
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
        "limits": [texts.text(id) for id in LIMITS],
    }
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def _assumed(found: Constrained, texts: Catalogue) -> pd.DataFrame:
    """Table of sensitivities with its assumptions in words."""
    words = [texts.say(_assumption(name)) for name in found.sensitivity["assumption"]]
    return found.sensitivity.assign(assumption=words)


def _assumption(name: str) -> Finding:
    """An assumption in words, by its name."""
    if name == "in_space":
        return finding(ASSUMPTIONS[name], less=whole(100 * (1 - IN_SPACE)))
    return finding(ASSUMPTIONS[name])


def _hazard_said(found: Constrained) -> Finding:
    """Change of the mean hazard at the annual rate of decisions."""
    measure = found.site.measure
    table = found.result.ratios()
    decided = table[table["annual_rate"] == DECISION_RATE].to_dict("records")[0]
    if not decided["level_ratio"] > 0:
        return finding("site_beyond_curves")
    change = decided["level_ratio"] - 1
    return finding(
        "site_lower" if change < 0 else "site_higher",
        measure=measure.imt,
        unit=measure.unit,
        after=three(decided["level_after"]),
        before=three(decided["level_before"]),
        change=whole(100 * abs(change)),
    )


def _branches_said(found: Constrained) -> Finding:
    """How many branches are as good as ruled out, in words."""
    return finding(
        "site_ruled_out",
        count=len(found.ruled_out),
        n=len(found.site.branches),
        least=whole(100 * RULED_OUT),
    )


def _evidence_said(found: Constrained) -> Finding:
    """Object that moves the weights most."""
    first = found.by_object.to_dict("records")[0]
    name, bit = first["object"], two(first["information_bit"])
    if len(found.by_object) == 1:
        return finding("site_only", name=name)
    if (without := first["level_ratio_without"]) > 0:
        ratio = two(without)
        return finding("site_tells_most_without", name=name, bit=bit, ratio=ratio)
    return finding("site_tells_most", name=name, bit=bit)


def _hangs_on_said(found: Constrained) -> Finding:
    """Assumption without which the level changes most."""
    moved = found.sensitivity.iloc[1:]
    moved = moved[moved["level_ratio"] > 0]
    if moved.empty or not found.result.level_ratio > 0:
        return finding("site_hangs_on_nothing")
    away = np.log(moved["level_ratio"] / found.result.level_ratio).abs()
    worst = moved.iloc[int(away.to_numpy().argmax())]
    return finding(
        "site_hangs_on",
        assumption=_assumption(worst["assumption"]),
        ratio=two(worst["level_ratio"]),
        stated=two(found.result.level_ratio),
    )


def lines_of(found: Constrained, language: str = FIRST) -> list[str]:
    """Answer in lines for a screen.

    Parameters
    ----------
    found, language : the site with its new weights, and the language

    Returns
    -------
    The lines.
    """
    texts = catalogue(language)
    moved = finding("site_moved", bit=two(found.result.information))
    said: dict[str, list[Value]] = {
        "site_head_hazard": [_hazard_said(found)],
        "site_head_branches": [_branches_said(found), moved],
        "site_head_evidence": [_evidence_said(found)],
        "site_head_hangs_on": [_hangs_on_said(found)],
        "site_head_limits": [finding(id) for id in LIMITS],
    }
    heads = [texts.text(id) for id in said]
    longest = max(map(len, heads))
    return [
        f"{head:<{longest}}  {' '.join(map(texts.say, values))}"
        for head, values in zip(heads, said.values(), strict=True)
    ]


def page_of(found: Constrained, language: str = FIRST) -> str:
    """Page as HTML, which loads nothing from outside.

    Parameters
    ----------
    found, language : the site with its new weights, and the language

    Returns
    -------
    HTML.
    """
    texts = catalogue(language)
    site = found.site
    names = listed([body.name for body in site.objects])
    place = finding("site_unnamed") if site.name == UNNAMED else site.name
    hazard, evidence, hangs_on = map(
        texts.say, (_hazard_said(found), _evidence_said(found), _hangs_on_said(found))
    )
    limits = [texts.text(id) for id in LIMITS]
    curves = FigureSpec(
        name="curves",
        alt=texts.say(finding("site_figure_curves_alt", hazard=hazard)),
        caption=texts.text("site_figure_curves"),
        draw=lambda: curves_figure(found, texts),
    )
    return Page(
        title=texts.say(finding("site_title", names=names, site=place)),
        lead=texts.say(finding("site_lead", n=len(site.branches), names=names)),
        answer=Answer(
            asked=texts.text("site_asked"),
            sentences=[
                Shown(texts.text("site_head_hazard"), hazard),
                Shown(texts.text("site_head_evidence"), evidence),
                Shown(texts.text("site_it_hangs_on"), hangs_on),
            ],
            figure=curves,
            rests_on=limits,
        ),
        sections=_sections(found, texts),
        provenance={
            texts.text("provenance_program"): f"rockfrag {version('rockfrag')}"
        },
        language=texts.language,
    ).html()


def _sections(found: Constrained, texts: Catalogue) -> list[Section]:
    """Chapters: the hazard, its branches, the objects, and on what the answer hangs."""
    weights = FigureSpec(
        name="weights",
        alt=texts.text("site_figure_weights_alt"),
        caption=texts.text("site_figure_weights"),
        draw=lambda: weights_figure(found, texts),
    )
    limits = [texts.text(id) for id in LIMITS]
    return [
        Section(
            "hazard",
            texts.text("site_hazard"),
            texts.say(_hazard_said(found)),
            (),
            [_hazard_table(found, texts)],
        ),
        Section(
            "branches",
            texts.text("site_branches"),
            texts.say(_branches_said(found)),
            (),
            [weights, _branch_table(found, texts)],
        ),
        Section(
            "objects",
            texts.text("site_objects"),
            texts.say(_evidence_said(found)),
            (),
            [_object_table(found, texts)],
        ),
        Section(
            "hangs-on",
            texts.text("site_assumptions"),
            texts.say(_hangs_on_said(found)),
            limits,
            [_assumption_table(found, texts)],
        ),
    ]


def _hazard_table(found: Constrained, texts: Catalogue) -> Markup:
    """Table of the mean hazard before and after."""
    unit, table = found.site.measure.unit, found.result.ratios()
    table = table.assign(rate=table["annual_rate"].map("{:g}".format))
    before = texts.say(finding("site_column_before", unit=unit))
    after = texts.say(finding("site_column_after", unit=unit))
    columns = (
        column("rate", texts.text("site_column_rate"), numeric=True),
        column("level_before", before, decimals=3),
        column("level_after", after, decimals=3),
        column("level_ratio", texts.text("site_column_level_ratio"), decimals=2),
        column("rate_ratio", texts.text("site_column_rate_ratio"), decimals=2),
    )
    return table_html(table, columns, texts.text("site_hazard_table"))


def _branch_table(found: Constrained, texts: Catalogue) -> Markup:
    """Table of the branches: weights before and after, and how probably each lets all stand."""
    columns = (
        column("branch", texts.text("site_column_branch")),
        column("weight_before", texts.text("site_column_weight_before"), decimals=4),
        column("weight_after", texts.text("site_column_weight_after"), decimals=4),
        column("survival", texts.text("site_column_survival"), decimals=4),
    )
    table, caption = found.result.table(), texts.text("site_branch_table")
    file = f"{file_name(found.site.name)}-weights.csv"
    return table_html(table, columns, caption, file, language=texts.language)


def _object_table(found: Constrained, texts: Catalogue) -> Markup:
    """Table of what each object says, alone and beside the others."""
    columns = (
        column("object", texts.text("site_column_object")),
        column("information_bit", texts.text("site_column_bit"), decimals=2),
        column("level_ratio_alone", texts.text("site_column_alone"), decimals=2),
        column("level_ratio_without", texts.text("site_column_without"), decimals=2),
    )
    return table_html(found.by_object, columns, texts.text("site_object_table"))


def _assumption_table(found: Constrained, texts: Catalogue) -> Markup:
    """Table of the ratio of levels with each assumption in turn."""
    columns = (
        column("assumption", texts.text("site_column_assumption")),
        column("level_ratio", texts.text("site_column_level"), decimals=2),
    )
    caption = texts.text("site_assumption_table")
    return table_html(_assumed(found, texts), columns, caption)


# Branches whose weights are drawn: those that matter most before or after
MOST_BRANCHES_SHOWN = 20
LONGEST_LABEL = 34  # Characters of a branch's name beside its weights


def curves_figure(found: Constrained, texts: Catalogue) -> Figure:
    """Mean hazard before and after, with the range of the branches from the 16th to the 84th percentile."""
    measure = found.site.measure
    curves = found.result.curves()
    level = curves["level"].to_numpy()
    with style.panels(style.COLUMN_WIDTH, 2.8) as (figure, axes):
        for when, colour, line, id in (
            ("before", style.ORANGE, "--", "site_figure_mean_before"),
            ("after", style.BLUE, "-", "site_figure_mean_after"),
        ):
            low, high = curves[f"fractile_0.16_{when}"], curves[f"fractile_0.84_{when}"]
            axes.fill_between(level, low, high, color=colour, alpha=0.2, linewidth=0)
            mean = curves[f"mean_{when}"]
            axes.plot(level, mean, color=colour, linestyle=line, label=texts.text(id))
        rates = curves[["mean_before", "mean_after"]].to_numpy()
        axes.set(
            ylim=(max(rates[-1].min(), 1e-6), min(rates[0].max() * 1.5, 10.0)),
            xlabel=texts.say(
                finding("site_figure_level", measure=measure.imt, unit=measure.unit)
            ),
            ylabel=texts.text("site_figure_rate"),
        )
        style.plain_log(axes, "xy")
        axes.legend(loc="lower left")
    return figure


def weights_figure(found: Constrained, texts: Catalogue) -> Figure:
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
            label=texts.text("site_figure_before"),
        )
        axes.plot(
            after, place, "s", color=style.BLUE, label=texts.text("site_figure_after")
        )
        names = [
            _short(name, row + 1, texts)
            for row, name in zip(table.index, table["branch"], strict=True)
        ]
        axes.set_yticks(place, names)
        axes.set(xlabel=texts.text("site_figure_weight"), xlim=(0, None))
        figure.legend(loc="outside upper center", ncols=2)
    return figure


def _short(name: str, row: int, texts: Catalogue) -> str:
    """Name of a branch that fits beside an axis: a long one by its place in the table and its end."""
    if len(name) <= LONGEST_LABEL:
        return name
    return texts.say(finding("site_figure_row", n=row, end=name[8 - LONGEST_LABEL :]))
