"""The page of one object, and the files that are written beside it."""

import os
import tempfile
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd
from markupsafe import Markup

from rockfrag.assess.answer import Assessment
from rockfrag.assess.as_json import as_json
from rockfrag.assess.as_nrml import as_nrml
from rockfrag.assess.figures import shares_figure, sources_figure
from rockfrag.assess.remedies import without_simulation
from rockfrag.assess.words import (
    NAMES,
    assumptions,
    doubts,
    estimate_words,
    five_lines,
    remedy_words,
    safest,
    share_words,
    value_words,
    verdict,
)
from rockfrag.files import file_name, write_text
from rockfrag.report.live import carried, live_kernel
from rockfrag.report.page import Column, Picture, render, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section
from rockfrag.report.study_report import draw

MOTIONS_SHOWN = 15
"""Rows of the table of motions that topple the object first."""


def write_answer(found: Assessment, folder: str | os.PathLike[str]) -> Path:
    """Write page, JSON and the fragility for OpenQuake into a folder, and return the path of the page.

    Parameters
    ----------
    found
        The assessment.
    folder
        Where to write them; made if absent.
    """
    stem = Path(folder) / file_name(found.request.name)
    write_text(as_json(found), f"{stem}.json")
    write_text(as_nrml(found), f"{stem}.xml")
    page = Path(f"{stem}.html")
    write_text(page_of(found), page)
    return page


def page_of(found: Assessment) -> str:
    """Return the page as HTML, which loads nothing from outside.

    Parameters
    ----------
    found
        The assessment.
    """
    answer, sections = _answer(found), _sections(found)
    specs = [part for section in sections for part in section.parts if isinstance(part, FigureSpec)]
    return render(
        title=verdict(found),
        lead=f"{found.request.name}, {found.request.place.words}; {found.motions.words}.",
        answer=answer,
        sections=sections,
        pictures=_drawn([*([answer.figure] if answer.figure else []), *specs]),
        provenance=_provenance(found),
        live=_live(found),
    )


def _live(found: Assessment) -> Markup:
    """The object under some motions, live: two components, those that topple it first and a middling one."""
    order = np.argsort(found.verdicts.first_levels(), kind="stable")
    chosen = [found.motions.base[i] for i in (order[0], order[len(order) // 2])]
    motions = carried([motion for motion in chosen if motion.pga > 0])
    if not motions:
        return Markup("")
    return live_kernel(found.request.objects.arrangements, motions)


def _drawn(specs: list[FigureSpec]) -> Mapping[str, Picture]:
    with tempfile.TemporaryDirectory(prefix="rockfrag.") as scratch:
        return {spec.name: draw(spec, Path(scratch)) for spec in specs}


def _answer(found: Assessment) -> Answer:
    topples, likely, _, helps, _ = (line.partition("  ")[2] for line in five_lines(found))
    best = f"Safest is {safest(found)}. " if len(found.by_arrangement) > 1 else ""
    return Answer(
        asked="Does it topple, how probable is that, and what helps?",
        sentences=[
            Finding("At the site", _capital(topples)),
            Finding(f"In {found.request.years:g} years", _capital(likely)),
            Finding("What helps", f"{best}{_capital(helps)}"),
        ],
        figure=FigureSpec(
            "shares",
            f"Share of the motions that topple the object over the level of shaking. {topples}",
            "Share of the motions that topple it when they are scaled to a level of shaking.",
            lambda: shares_figure(found),
        ),
        rests_on=assumptions(found),
        could_change=[*doubts(found), f"The range comes mostly from {NAMES[found.main.largest]}."]
        if found.main.largest
        else doubts(found),
        questions=[
            ("What helps?", "remedies"),
            ("How does it stand best?", "arrangements"),
            ("How sure is that?", "sure"),
            ("What if it were 5 cm wider?", "live"),
        ],
    )


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _sections(found: Assessment) -> list[Section]:
    return [
        _remedies(found),
        _arrangements(found),
        _sure(found),
        _rules(found),
        _levels(found),
        _motions(found),
    ]


def _remedies(found: Assessment) -> Section:
    table = pd.DataFrame(
        {
            "name": [remedy.name for remedy in found.remedies],
            "value": [value_words(found, remedy.value) for remedy in found.remedies],
            "factor": [remedy.factor for remedy in found.remedies],
            "limits": [
                "–" if np.isnan(r.lower) else f"{r.lower:.2g} to {r.upper:.2g}"
                for r in found.remedies
            ],
        }
    )
    columns = (
        Column("name", "Change"),
        Column("value", "With it", numeric=True),
        Column("factor", "Factor", 2),
        Column("limits", "90 % interval", numeric=True),
    )
    message = f"{_capital(remedy_words(found, found.remedies[0]))}." if found.remedies else ""
    return Section(
        "remedies",
        "What helps",
        message,
        without_simulation(),
        [
            table_html(
                table,
                columns,
                "Each change simulated with the same motions; the factor is on what is estimated without it.",
            )
        ],
    )


def _arrangements(found: Assessment) -> Section:
    table = pd.DataFrame(
        {
            "name": list(found.by_arrangement),
            "value": [value_words(found, value) for value in found.by_arrangement.values()],
        }
    )
    columns = (Column("name", "How it stands"), Column("value", "Estimate", numeric=True))
    words = [f"It rocks {found.request.objects.plane}."]
    directions = found.directions
    if directions and np.isfinite(directions.factor):
        words.append(
            f"Turned through all directions, {directions.records} records topple it at "
            f"{directions.factor:.2f} times the level if each comes from its worst one"
            + (
                f"; at the site's level {100 * directions.worst_share:.0f} % instead of "
                f"{100 * directions.share:.0f} % do."
                if np.isfinite(directions.share)
                else "."
            )
        )
    words.append("On the floor is also what remains if the pedestal is fixed to it.")
    return Section(
        "arrangements",
        "How it stands best, and the worst direction",
        f"Safest is {safest(found)}.",
        words,
        [table_html(table, columns, "The same object under the same motions.")],
    )


def _sure(found: Assessment) -> Section:
    rows = [
        {
            "name": NAMES[effect.name],
            "spread": f"± {100 * effect.spread:g} %",
            "lower": value_words(found, effect.lower),
            "upper": value_words(found, effect.upper),
        }
        for effect in found.effects
    ]
    columns = (
        Column("name", "What is not known to the digit"),
        Column("spread", "Standard deviation", numeric=True),
        Column("lower", "If less", numeric=True),
        Column("upper", "If more", numeric=True),
    )
    parts: list[Markup | FigureSpec] = [
        table_html(pd.DataFrame(rows), columns, "What each assumption does to the answer.")
    ]
    if found.main.sources:
        parts.insert(
            0,
            FigureSpec(
                "sources",
                "How much each source of uncertainty widens the interval.",
                "What widens the interval.",
                lambda: sources_figure(found),
            ),
        )
    return Section(
        "sure",
        "How sure that is",
        f"{estimate_words(found.main) if found.probability or found.share else 'The amplitude'}: the interval "
        "holds motions, body, floor and model.",
        ["Variances of all sources are added; the table shows each assumption moved alone."],
        parts,
    )


def _rules(found: Assessment) -> Section:
    table = pd.DataFrame(
        {
            "rule": [rule.rule for rule in found.rules],
            "bias": [rule.bias for rule in found.rules],
            "scatter": [rule.scatter for rule in found.rules],
            "unsafe": [share_words(rule.unsafe) for rule in found.rules],
        }
    )
    columns = (
        Column("rule", "Rule"),
        Column("bias", "Its amplitude over the simulated one (median)", 2),
        Column("scatter", "Scatter (ln)", 2),
        Column("unsafe", "Motions that topple it earlier", numeric=True),
    )
    return Section(
        "rules",
        "What rules of thumb say",
        "Checks of practice beside the simulation of this object.",
        [
            "A ratio below 1 is cautious, above 1 unsafe. An object on a pedestal is checked alone and as one "
            "body with it, and the lower amplitude counts, as practice does with three models."
        ],
        [table_html(table, columns, "Rules held against every motion that topples the object.")],
    )


def _levels(found: Assessment) -> Section:
    verdicts = found.verdicts
    shares = verdicts.shares()
    rocks = verdicts.shares(rocks=True)
    shown = np.flatnonzero((rocks > 0) & (np.append(0, shares[:-1]) < 0.99))[::4]
    table = pd.DataFrame(
        {
            "level": verdicts.ladder.levels[shown],
            "rocks": [f"{100 * value:.0f} %" for value in rocks[shown]],
            "topples": [f"{100 * value:.0f} %" for value in shares[shown]],
        }
    )
    columns = [
        Column("level", f"{found.measure.name} [{found.measure.unit}]", 3),
        Column("rocks", "Rocks", numeric=True),
        Column("topples", "Topples", numeric=True),
    ]
    if found.hazard is not None:
        table["rate"] = [1 / rate for rate in found.hazard.rate(table["level"].to_numpy())]
        columns.append(Column("rate", "Return period [years]", 0))
    curve = found.curve
    words = []
    if curve is not None and np.isfinite(curve.fit.theta):
        words = [
            f"As a lognormal curve: median {curve.fit.theta:.3g} {found.measure.unit}, β {curve.fit.beta:.2f}.",
            *curve.warnings,
        ]
    return Section(
        "levels",
        "At other levels",
        "Share of the motions by level of shaking.",
        words,
        [table_html(table, columns, "Motions that make it rock, and that topple it.")],
    )


def _motions(found: Assessment) -> Section:
    first = found.verdicts.first_levels()
    order = np.argsort(first, kind="stable")[:MOTIONS_SHOWN]
    table = pd.DataFrame(
        {
            "name": [found.motions.ground[i].name for i in order],
            "event": [str(found.motions.events[i]) for i in order],
            "recorded": found.motions.values(found.measure)[order],
            "first": first[order],
        }
    )
    columns = (
        Column("name", "Motion"),
        Column("event", "Earthquake"),
        Column("recorded", f"As recorded [{found.measure.unit}]", 2),
        Column("first", f"Topples it from [{found.measure.unit}]", 2),
    )
    return Section(
        "motions",
        "Which motions topple it first",
        found.motions.words + ".",
        (),
        [table_html(table, columns, "The motions that need the least shaking.")],
    )


def _provenance(found: Assessment) -> dict[str, str]:
    kept = {
        "Program": f"rockfrag {version('rockfrag')}",
        "Motions": found.motions.words,
        "Hazard": found.hazard.source if found.hazard else "none",
    }
    return kept
