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
from rockfrag.assess.figures import fractions_figure, sources_figure
from rockfrag.assess.glossary import words_used
from rockfrag.assess.live import live_of
from rockfrag.assess.mitigations import without_simulation
from rockfrag.assess.scale import SCALE_WORDS
from rockfrag.assess.sources import SOURCES, parts_of
from rockfrag.assess.words import (
    NAMES,
    assumptions,
    at_the_site,
    estimate_words,
    fraction_words,
    headline,
    helps,
    main_assumptions,
    mitigation_words,
    positions,
    quality_flags,
    risk,
    uncertainty,
    value_words,
    worst_direction,
)
from rockfrag.files import file_name, write_text
from rockfrag.outcomes.limit_states import ROCKS, limit_states
from rockfrag.report.page import Column, Picture, render, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section
from rockfrag.report.study_report import draw

MOTIONS_SHOWN = 15
"""Rows of the table of motions that topple the object first."""

FURTHEST = 3.0
"""Return periods are given up to so many times what the hazard curve reaches; beyond, its slope is a guess."""


def write_answer(found: Assessment, folder: str | os.PathLike[str]) -> Path:
    """Write page, JSON and the fragility for OpenQuake into a folder, and return the path of the page."""
    stem = Path(folder) / file_name(found.request.name)
    write_text(as_json(found), f"{stem}.json")
    write_text(as_nrml(found), f"{stem}.xml")
    page = Path(f"{stem}.html")
    write_text(page_of(found), page)
    return page


def page_of(found: Assessment) -> str:
    """Return the page as HTML, which loads nothing from outside."""
    answer, sections = _answer(found), _sections(found)
    specs = [part for section in sections for part in section.parts if isinstance(part, FigureSpec)]
    return render(
        title=headline(found),
        lead=f"{_capital(found.request.name)} {found.request.place.words}, shaken by {found.motions.words}.",
        answer=answer,
        sections=sections,
        pictures=_drawn([*([answer.figure] if answer.figure else []), *specs]),
        provenance=_provenance(found),
        live=live_of(found),
    )


def _drawn(specs: list[FigureSpec]) -> Mapping[str, Picture]:
    with tempfile.TemporaryDirectory(prefix="rockfrag.") as scratch:
        return {spec.name: draw(spec, Path(scratch)) for spec in specs}


def _answer(found: Assessment) -> Answer:
    doubtful = [*quality_flags(found), *uncertainty(found), worst_direction(found)]
    return Answer(
        asked="Does it topple, how probable is that, and what helps?",
        sentences=[
            Finding("At the site", at_the_site(found)),
            Finding(f"In {found.request.years:g} years", risk(found)),
            Finding("What helps", helps(found)),
        ],
        figure=FigureSpec(
            "fractions",
            f"Motions that topple the object by the level of shaking. {at_the_site(found)}",
            "Motions that topple it when they are scaled to a level of shaking; the band is what another "
            "choice of as many earthquakes could show (90 %).",
            lambda: fractions_figure(found),
        ),
        rests_on=[f"{found.motions.words}.", *main_assumptions(found)],
        could_change=doubtful,
        questions=[
            ("What helps?", "mitigations"),
            ("How does it stand best?", "arrangements"),
            ("How sure is that?", "sure"),
            ("What was assumed?", "assumed"),
            *([("What if it were 5 cm wider?", "live")] if not found.request.objects.round else []),
        ],
    )


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _sections(found: Assessment) -> list[Section]:
    return [
        _mitigations(found),
        _arrangements(found),
        _sure(found),
        _assumed(found),
        *([_rules(found)] if found.rules else []),
        _levels(found),
        _motions(found),
        _glossary(found),
    ]


def _mitigations(found: Assessment) -> Section:
    table = pd.DataFrame(
        {
            "name": [_capital(mitigation.name) for mitigation in found.mitigations],
            "value": [value_words(found, mitigation.value) for mitigation in found.mitigations],
            "effect": [
                _capital(mitigation_words(found, mitigation)) for mitigation in found.mitigations
            ],
        }
    )
    columns = (
        Column("name", "Change"),
        Column("value", "With it", numeric=True),
        Column("effect", "What it does (90 % interval)"),
    )
    return Section(
        "mitigations",
        "What helps",
        helps(found),
        without_simulation(),
        [
            table_html(
                table,
                columns,
                "Each change is simulated with the same motions and compared with the object as it stands.",
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
    words = []
    directions = found.directions
    if directions and np.isfinite(directions.factor):
        words.append(
            f"{directions.records} records with two components were turned through all directions. If each came "
            f"from its worst one, {100 * directions.factor:.0f} % of the shaking would topple the object"
            + (
                f", and {100 * directions.worst_fraction:.0f} % instead of "
                f"{100 * directions.fraction:.0f} % of the records at the site's level."
                if np.isfinite(directions.fraction)
                else "."
            )
            + " The figures of this page are for directions at random; the worst one is not counted in them. Both "
            "components at once are not simulated either."
        )
    if len(found.by_arrangement) > 1:
        stand = found.request.objects.stand
        words.append(f"On the floor is also what remains with the {stand} fixed to it.")
    message = positions(found)
    return Section(
        "arrangements",
        "How it stands best, and the worst direction",
        message,
        words,
        [table_html(table, columns, "The same object under the same motions.")],
    )


def _sure(found: Assessment) -> Section:
    parts: list[Markup | FigureSpec] = [_sources(found), _effects(found)]
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
    words = [
        "The interval holds what is not known; the variances of all its sources are added. What differs from one "
        "earthquake to the next is not ignorance and stands in the result itself."
    ]
    if found.probability or found.fraction:
        words.insert(0, f"The result is {estimate_words(found.main)}.")
    if found.probability:
        words.append(f"Our scale of risk: {SCALE_WORDS}. The steps are ours.")
    message = " ".join(uncertainty(found)) or "No interval can be given of sources that all agree."
    return Section("sure", "How sure that is", message, words, parts)


def _sources(found: Assessment) -> Markup:
    """The sources of the interval, what each adds to it, where its size comes from, and what would narrow it."""
    rows = []
    for name, part in parts_of(found.main.sources).items():
        source = SOURCES[name]
        measurement = source.measurement
        rows.append(
            {
                "name": _capital(source.words),
                "part": f"{100 * part:.0f} %",
                "basis": source.basis,
                "measure": _capital(measurement.words) if measurement else "–",
            }
        )
    columns = (
        Column("name", "Not known"),
        Column("part", "Part of the variance", numeric=True),
        Column("basis", "Where its size comes from"),
        Column("measure", "What would narrow it"),
    )
    return table_html(pd.DataFrame(rows), columns, "Sources of the interval, the largest first.")


def _effects(found: Assessment) -> Markup:
    rows = [
        {
            "name": _capital(NAMES[effect.name]),
            "spread": f"± {100 * effect.spread:g} %",
            "lower": value_words(found, effect.lower),
            "upper": value_words(found, effect.upper),
        }
        for effect in found.effects
    ]
    columns = (
        Column("name", "What is not known exactly"),
        Column("spread", "Standard deviation", numeric=True),
        Column("lower", "If less", numeric=True),
        Column("upper", "If more", numeric=True),
    )
    return table_html(
        pd.DataFrame(rows),
        columns,
        "What the answer is with each property moved by its standard deviation.",
    )


def _assumed(found: Assessment) -> Section:
    lines = assumptions(found)
    return Section(
        "assumed",
        "What was assumed",
        "What was not given, and what the model leaves out; that first which matters most.",
        lines,
    )


def _rules(found: Assessment) -> Section:
    table = pd.DataFrame(
        {
            "rule": [rule.rule for rule in found.rules],
            "bias": [rule.bias for rule in found.rules],
            "scatter": [rule.scatter for rule in found.rules],
            "unsafe": [fraction_words(rule.unsafe) for rule in found.rules],
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
    outcomes = found.outcomes
    fractions = outcomes.fractions()
    rocks = outcomes.fractions(state=ROCKS)
    others = [state for state in limit_states() if state.name in outcomes.others]
    shown = np.flatnonzero((rocks > 0) & (np.append(0, fractions[:-1]) < 0.99))[::4]
    low, high = outcomes.band()
    table = pd.DataFrame(
        {
            "level": outcomes.intensity_levels.levels[shown],
            "rocks": [f"{100 * value:.0f} %" for value in rocks[shown]],
            **{
                state.name: [
                    f"{100 * value:.0f} %" for value in outcomes.fractions(state=state.name)[shown]
                ]
                for state in others
            },
            "topples": [
                f"{100 * fractions[i]:.0f} % ({100 * low[i]:.0f} to {100 * high[i]:.0f} %)"
                for i in shown
            ],
        }
    )
    columns = [
        Column("level", f"{found.measure.imt} [{found.measure.unit}]", 3),
        Column("rocks", "Motions that make it rock", numeric=True),
        *(Column(state.name, f"Motions: {state.label}", numeric=True) for state in others),
        Column("topples", "Motions that topple it (90 % interval)", numeric=True),
    ]
    if found.hazard is not None:
        levels = table["level"].to_numpy()
        reach = FURTHEST * found.hazard.levels[-1]
        if found.request.level is not None and not found.request.hazard[0].is_read:
            reach = FURTHEST * found.request.level.value
        table["rate"] = [
            _years(1 / float(found.hazard.rate(level))) if level <= reach else "beyond the hazard"
            for level in levels
        ]
        columns.append(Column("rate", "Return period [years]", numeric=True))
    curve = found.curve
    words = []
    if curve is not None and np.isfinite(curve.fit.theta):
        words = [
            f"As a lognormal curve: median {curve.fit.theta:.3g} {found.measure.unit}, β {curve.fit.beta:.2f}.",
            *curve.warnings,
        ]
    starts = (
        f"It starts to rock at {found.measure.imt} {found.rocks_from:.2g} {found.measure.unit}."
        if np.isfinite(found.rocks_from)
        else "Nothing that was tried makes it rock."
    )
    return Section(
        "levels",
        "At other levels",
        starts,
        words,
        [
            table_html(
                table,
                columns,
                "Motions that make it rock, and that topple it, by the level of shaking.",
            )
        ],
    )


def _years(period: float) -> str:
    """A return period to two digits: 475 years stand for some 480."""
    rounded = float(f"{period:.2g}")
    return f"{rounded:,.0f}".replace(",", " ") if rounded >= 10 else f"{rounded:g}"


def _glossary(found: Assessment) -> Section:
    table = pd.DataFrame(words_used(found), columns=["word", "meaning"])
    columns = (Column("word", "Word"), Column("meaning", "What it means here"))
    return Section(
        "glossary",
        "Words used here",
        "What the words of earthquake engineers mean.",
        (),
        [table_html(table, columns, "Words and abbreviations of this page.")],
    )


def _motions(found: Assessment) -> Section:
    first = found.counted.first_levels()
    order = np.argsort(first, kind="stable")[:MOTIONS_SHOWN]
    table = pd.DataFrame(
        {
            "name": [found.motions.ground[i].name for i in order],
            "earthquake": [
                ", ".join(
                    dict.fromkeys(
                        [
                            str(found.motions.earthquakes[i]),
                            str(found.motions.ground[i].metadata.get("station", "")),
                        ]
                    )
                ).strip(", ")
                for i in order
            ],
            "recorded": found.motions.values(found.measure)[order],
            "first": first[order],
        }
    )
    columns = (
        Column("name", "Motion"),
        Column("earthquake", "Earthquake and station"),
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
