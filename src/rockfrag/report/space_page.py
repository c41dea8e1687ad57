"""The report of a study of bodies in space: medians over planar ones, and what they come from."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure

from rockfrag.base import figure_style as style
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.live.live_space import Standing, live_in_space
from rockfrag.report.part import Answer, Says, Section
from rockfrag.report.study_report import write_page
from rockfrag.stages.job import Job, Results
from rockfrag.stages.space_study import LOSS, NO_LOSS, PLANAR, body_of
from rockfrag.study.space import SpaceStudy

says = Says("rockfrag.report", "space_page.j2")


def run(job: Job[SpaceStudy]) -> Results:
    """Draw the figures of a study of bodies in space and write its page, ``report.html``."""
    study, medians, fractions = job.study, job.table("medians"), job.table("fractions")
    ratios = says.figure("ratios", lambda: ratios_figure(medians))
    levels = says.figure("fractions", lambda: fractions_figure(fractions))
    findings = []
    for base in study.bases:
        # what the second component does to one base, as the range of its rows
        rows = medians[(medians["base"] == base) & (medians["planar_impacts"] == LOSS)]
        spans = {
            name: f"{rows[name].min():.2f} to {rows[name].max():.2f}" for name in PLANAR
        }
        findings.append(says.finding("finding", base, spans))
    answer = Answer(
        asked="At which shaking does a body topple under both components, beside planar rocking under one?",
        sentences=findings[:3],
        figure=ratios,
        rests_on=says("rests_on"),
        could_change=says("could_change", medians["flip_rate"].max()),
    )
    shown = medians.assign(body=_bases(medians))
    table = says.table("medians", shown, WORDS)
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
    write_page(job, answer, sections, {}, lead=says.line("lead", study), live=live)
    yield from ()


def _live(study: SpaceStudy, ground: Sequence[Motion]) -> Markup:
    """Bodies of the study under its first records, live; nothing where a body has another base for each record."""
    if study.sweep["base_spread"] > 0:
        return Markup()
    words = "{}, height over width {:g}, {:g} m"
    bodies = {
        words.format(*about): Standing(body_of(*about).system())
        for about in study.bodies
    }
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
            low, high = (medians[f"{name}_{end}"] for end in ("lower", "upper"))
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
    size, shape = (style.PAGE_WIDTH, 0.6 + 1.35 * rows), (rows, columns)
    with style.panels(*size, *shape, sharey=True, squeeze=False) as (figure, panels):
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
        handles = panels.flat[0].get_legend_handles_labels()
        figure.legend(*handles, loc="outside upper center", ncols=4)
        return figure
