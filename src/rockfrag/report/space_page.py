"""The report of a study of bodies in space: medians over planar ones, and what they come from."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd
from markupsafe import Markup

from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.figures.space import WORDS, fractions_figure, ratios_figure, words_of
from rockfrag.report.live.space import Standing, live_in_space
from rockfrag.report.page import Column, estimated, table_html
from rockfrag.report.part import Answer, Finding, Section, figure_of, finding_of
from rockfrag.report.provenance import provenance
from rockfrag.report.study_report import write_page
from rockfrag.report.wording import Macros, one_line, said
from rockfrag.rocking.space_medians import LOSS, PLANAR, body_of
from rockfrag.study.space import SpaceStudy

says = Macros("rockfrag.report", "space_page.j2")


def write_space_report(
    study: SpaceStudy,
    medians: pd.DataFrame,
    fractions: pd.DataFrame,
    ground: Sequence[Motion],
    folder: Path,
) -> None:
    """Draw the figures of a study of bodies in space and write its page, ``report.html``.

    ``ground`` are the components of its records, both of each in turn.
    """
    ratios = figure_of(says.ratios_figure(), "ratios", lambda: ratios_figure(medians))
    levels = figure_of(says.fractions_figure(), "fractions", lambda: fractions_figure(fractions))
    findings = [_finding(base, medians) for base in study.bases]
    answer = Answer(
        asked="At which shaking does a body topple under both components, beside planar rocking under one?",
        sentences=findings[:3],
        figure=ratios,
        rests_on=said(says.rests_on()),
        could_change=said(says.could_change(medians["flip_rate"].max())),
    )
    sections = [
        Section("medians", "Medians", f"{findings[0].headline}.", [], [_table(medians), ratios]),
        Section("fractions", "Fractions by level", "What the medians come from.", [], [levels]),
    ]
    write_page(
        folder,
        answer,
        sections,
        title=study.title,
        lead=one_line(says.lead(study)),
        provenance=provenance(study, {}),
        live=_live(study, ground),
    )


def _live(study: SpaceStudy, ground: Sequence[Motion]) -> Markup:
    """Bodies of the study under its first records, live; nothing where a body has another base for each record."""
    if study.sweep.spread > 0:
        return Markup()
    bodies = {
        f"{base}, height over width {slenderness:g}, {height:g} m": Standing(
            body_of(base, slenderness, height).system()
        )
        for base, slenderness, height in study.bodies
    }
    return live_in_space(bodies, list(map(GroundMotion, ground[::2], ground[1::2])))


def _finding(base: str, medians: pd.DataFrame) -> Finding:
    """What the second component does to one base, as the range of its rows."""
    rows = medians[(medians["base"] == base) & (medians["planar_impacts"] == LOSS)]
    spans = {name: f"{rows[name].min():.2f} to {rows[name].max():.2f}" for name in PLANAR}
    return finding_of(says.finding(base, spans))


def _table(medians: pd.DataFrame) -> Markup:
    shown = medians.assign(body=[words_of(row) for _, row in medians.iterrows()])
    columns = [
        Column("body", "Base"),
        Column("slenderness", "Height over width", 1),
        Column("height_m", "Height [m]", 1),
        Column("space_g", "Median in space [g]", 2),
        *(estimated(name, f"Over {WORDS[name]}", 2) for name in PLANAR),
        Column("flip_rate", "Flip rate", 2),
    ]
    return table_html(shown, columns, "Medians in space over planar ones, with 90 % intervals.")
