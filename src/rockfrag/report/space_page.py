"""Report of a study of bodies in space: medians over planar ones, and the fractions that they come from.

In: the tables ``medians`` and ``fractions`` of the study; levels [g] are geometric means of the peaks of both
components. Out: the page ``report.html``. Theory: ``docs/space.md``, "In space and in the plane".
"""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure

from rockfrag.base import figure_style as style
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.live.live_space import Standing, live_in_space
from rockfrag.report.page import column, estimated, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section
from rockfrag.report.study_report import write_page
from rockfrag.stages.job import Job, Results
from rockfrag.stages.space_study import LOSS, NO_LOSS, PLANAR, body_of
from rockfrag.study.space import SpaceStudy
from rockfrag.words.sentences import counted


def run(job: Job[SpaceStudy]) -> Results:
    """Draw the figures of a study of bodies in space and write its page, ``report.html``."""
    study, medians, fractions = job.study, job.table("medians"), job.table("fractions")
    words = (
        "Level at which half of the records topple a uniform body in space over that of planar rocking, by "
        "base, height over the narrow side or diameter, and height; lines hold 90 % of resampled earthquakes."
    )
    ratios = FigureSpec("ratios", words, words, lambda: ratios_figure(medians))
    words = "Fraction of the records that topple each body, in space and in the plane, by the level."
    levels = FigureSpec("fractions", words, words, lambda: fractions_figure(fractions))
    findings = [_finding(base, medians) for base in study.bases]
    rate = 100 * medians["flip_rate"].max()
    answer = Answer(
        asked="At which shaking does a body topple under both components, beside planar rocking under one?",
        sentences=findings[:3],
        figure=ratios,
        rests_on=[
            "A level is the geometric mean of the peaks of both components; nothing slides, bodies are uniform."
        ],
        could_change=[
            f"A perturbation of 1e-6 changes up to {rate:.0f} % of the outcomes in space next to the median."
        ],
    )
    columns = [
        column("body", "Base"),
        column("slenderness", "Height over width", decimals=1),
        column("height_m", decimals=1),
        column("space_g", "Median in space [g]", decimals=2),
        *(estimated(name, f"Over {words}", 2) for name, words in WORDS.items()),
        column("flip_rate", decimals=2),
    ]
    caption = "Medians in space over planar ones, with 90 % intervals."
    table = table_html(medians.assign(body=_bases(medians)), columns, caption)
    sections = [
        Section("medians", "Medians", f"{findings[0].headline}.", [], [table, ratios]),
        Section(
            "fractions",
            "Fractions by level",
            "What the medians come from.",
            [],
            [levels],
        ),
    ]
    live = _live(study, job.motions("motions/ground"))
    write_page(job, answer, sections, about={}, lead=_lead(study), live=live)
    yield from ()


def _finding(base: str, medians: pd.DataFrame) -> Finding:
    """Effect of the second component on bodies of one base, as the range of the rows of its medians."""
    rows = medians[(medians["base"] == base) & (medians["planar_impacts"] == LOSS)]

    def span(name: str) -> str:
        return f"{rows[name].min():.2f} to {rows[name].max():.2f}"

    return Finding(
        f"Base {base}: in space {span('one_component')} times the level of one component",
        f"Over the mean of directions {span('mean_direction')}, over the worst direction "
        f"{span('worst_direction')}.",
    )


def _lead(study: SpaceStudy) -> str:
    """Sentence below the title: bodies, records and levels."""
    records = "all" if study.every == 1 else f"one in {study.every}"
    records += " records of FEMA P-695"
    if study.catalogue_file is not None:
        records = f"the records of {study.catalogue_file.name}"
    bodies = counted(len(study.bodies), "body", "bodies")
    return f"{bodies} under both components of {records} at {study.sweep['levels']} levels."


def _live(study: SpaceStudy, ground: Sequence[Motion]) -> Markup:
    """Bodies of the study under its first records, live; nothing where a body has another base for each record."""
    if study.sweep["base_spread"] > 0:
        return Markup()
    bodies = {}
    for base, slenderness, height in study.bodies:
        name = f"{base}, height over width {slenderness:g}, {height:g} m"
        bodies[name] = Standing(body_of(base, slenderness, height).system())
    return live_in_space(bodies, list(map(GroundMotion, ground[::2], ground[1::2])))


WORDS = {
    "one_component": "one component",
    "mean_direction": "mean of directions",
    "worst_direction": "worst direction",
}
COLOURS = dict(zip(PLANAR, (style.BLUE, style.ORANGE, style.GREEN), strict=True))


def _bases(medians: pd.DataFrame) -> pd.Series:
    """Return the base of each row in words, and that planar impacts lose nothing where they do not."""
    return medians["base"] + np.where(
        medians["planar_impacts"] == NO_LOSS, ", no loss", ""
    )


def ratios_figure(medians: pd.DataFrame) -> Figure:
    """Draw medians in space over the planar ones, with their limits."""
    with style.panels(style.PAGE_WIDTH, 0.6 + 0.2 * len(medians)) as (figure, panel):
        places = -np.arange(len(medians), dtype=float)
        for k, name in enumerate(PLANAR):
            low, high = medians[f"{name}_lower"], medians[f"{name}_upper"]
            off = places + 0.2 * (1 - k)
            panel.hlines(off, low, high, color=COLOURS[name], lw=1.0)
            panel.plot(
                medians[name],
                off,
                "os^"[k],
                color=COLOURS[name],
                ms=3.5,
                label=WORDS[name],
            )
        panel.axvline(1.0, color=style.BLACK, lw=0.8, ls="--")
        slenderness = _bases(medians) + medians["slenderness"].map(", {:g}".format)
        panel.set_yticks(
            places, slenderness + medians["height_m"].map(", {:g} m".format)
        )
        panel.set_ylim(places[-1] - 0.6, 0.6)
        panel.set_xlabel(
            "Median level in space over that of planar rocking [-]; unsafe below 1"
        )
        panel.set_ylabel("Base, height over width, height")
        figure.legend(loc="outside upper center", ncols=3)
        return figure


def fractions_figure(fractions: pd.DataFrame) -> Figure:
    """Draw the fraction of records that topple each body in space and in the plane, one panel a body."""
    bodies = list(fractions.groupby(["base", "slenderness", "height_m"], sort=False))
    columns = min(len(bodies), 6)
    rows = -(-len(bodies) // columns)
    with style.panels(
        style.PAGE_WIDTH,
        0.6 + 1.35 * rows,
        nrows=rows,
        ncols=columns,
        sharey=True,
        squeeze=False,
    ) as (figure, panels):
        for panel, ((base, slenderness, height), part) in zip(
            panels.flat, bodies, strict=False
        ):
            first = part[part["planar_impacts"] == part["planar_impacts"].iloc[0]]
            panel.plot(
                first["level_g"], first["space"], color=style.RED, label="in space"
            )
            for name in PLANAR:
                curve = panel.plot(
                    first["level_g"], first[name], color=COLOURS[name], lw=0.9
                )
                curve[0].set_label(WORDS[name])
            style.plain_log(panel, "x")
            panel.set_title(f"{base}\n{slenderness:g}, {height:g} m", loc="left")
        for panel in list(panels.flat)[len(bodies) :]:
            panel.set_visible(False)
        figure.supxlabel("Level, geometric mean of both peaks [g]", fontsize=8)
        figure.supylabel("Fraction of records that topple it [-]", fontsize=8)
        handles, labels = panels.flat[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=4)
        return figure
