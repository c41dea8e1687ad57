"""The page of one object, and the files that are written beside it."""

import os
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from rockfrag.assess.answer import Assessment
from rockfrag.assess.export import as_json, as_nrml
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.objects import Objects
from rockfrag.assess.words import NAMES, page_says, says
from rockfrag.base.figure_style import BLUE, COLUMN_WIDTH, OKABE_ITO, panels, plain_log
from rockfrag.base.files import file_name, write_text
from rockfrag.outcomes.limit_states import ROCKS, limit_states
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.live import carried, live_kernel
from rockfrag.report.live.live_space import Standing, live_in_space
from rockfrag.report.page import Page, text_table
from rockfrag.report.part import Answer, Finding, Section
from rockfrag.words.sentences import PART, number

MOTIONS_SHOWN = 15  # Rows of the table of motions that topple the object first

# Return periods are given up to so many times the reach of the hazard curve
FURTHEST = 3.0


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
    drawn = []
    if found.main.sources:
        drawn.append(page_says.figure("sources", lambda: sources_figure(found)))
    first, others = slice(1, 2), slice(1, None)
    earliest = np.argsort(found.counted.first_levels(), kind="stable")[:MOTIONS_SHOWN]
    sure = [_table("sources", found, first), _table("effects", found, others)]
    sections = [
        page_says.section("mitigations", [_table("mitigations", found, first)], found),
        page_says.section(
            "arrangements", [_table("arrangements", found, others)], found
        ),
        page_says.section("sure", [*drawn, *sure], found),
        page_says.section("assumed", [], found),
        *(
            [page_says.section("rules", [_table("rules", found, others)])]
            if found.rules
            else []
        ),
        _levels(found),
        page_says.section(
            "motions", [_table("motions", found, slice(2, None), earliest)], found
        ),
        page_says.section("glossary", [_table("glossary", found, slice(0))]),
    ]
    provenance = {
        "Program": f"rockfrag {version('rockfrag')}",
        "Motions": found.motions.words,
        "Hazard": found.hazard.source if found.hazard else "none",
    }
    lead, answer, live = page_says.line("lead", found), _answer(found), live_of(found)
    return Page(
        says.line("headline", found), lead, answer, sections, provenance, live=live
    ).html()


def _answer(found: Assessment) -> Answer:
    return Answer(
        asked="Does it topple, how probable is that, and what helps?",
        sentences=[Finding(*line.split(PART)) for line in page_says("findings", found)],
        figure=page_says.figure("fractions", lambda: fractions_figure(found), found),
        rests_on=page_says("rests_on", found),
        could_change=page_says("could_change", found),
        questions=[
            ("What helps?", "mitigations"),
            ("How does it stand best?", "arrangements"),
            ("How sure is that?", "sure"),
            ("What was assumed?", "assumed"),
            *(
                [("What if it were 5 cm wider?", "live")]
                if not found.request.objects.round
                else []
            ),
        ],
    )


def _table(name: str, found: Assessment, numeric: slice, *more: Any) -> Markup:
    """A table of which a macro says caption, titles and rows, a line each; some of its columns are of numbers."""
    lines = page_says(f"{name}_table", found, *more)
    (caption,), titles, *rows = (line.split(PART) for line in lines)
    return text_table(titles, rows, caption, titles[numeric])


def _levels(found: Assessment) -> Section:
    outcomes, levels = found.outcomes, found.outcomes.intensity_levels.levels
    fractions, (low, high) = outcomes.fractions(), outcomes.band()
    reached = {ROCKS: "Motions that make it rock"}
    for state in limit_states():
        if state.name in outcomes.others:
            reached[state.name] = f"Motions: {state.label}"
    rocks = outcomes.fractions(state=ROCKS)
    shown = np.flatnonzero((rocks > 0) & (np.append(0, fractions[:-1]) < 0.99))[::4]
    table = {
        f"{found.measure.imt} [{found.measure.unit}]": [
            number(levels[i], 3) for i in shown
        ]
    }
    for name, title in reached.items():
        parts = outcomes.fractions(state=name)
        table[title] = [f"{100 * parts[i]:.0f} %" for i in shown]
    table["Motions that topple it (90 % interval)"] = [
        f"{100 * fractions[i]:.0f} % ({100 * low[i]:.0f} to {100 * high[i]:.0f} %)"
        for i in shown
    ]
    if found.hazard is not None:
        reach = FURTHEST * found.hazard.levels[-1]
        if found.request.level is not None and not found.request.hazard[0].is_read:
            reach = FURTHEST * found.request.level.value
        table["Return period [years]"] = [
            _years(1 / float(found.hazard.rate(level)))
            if level <= reach
            else "beyond the hazard"
            for level in levels[shown]
        ]
    caption = "Motions that make it rock, and that topple it, by the level of shaking."
    rows = zip(*table.values(), strict=True)
    return page_says.section(
        "levels", [text_table(list(table), rows, caption, list(table))], found
    )


def _years(period: float) -> str:
    """A return period to two digits: 475 years stand for some 480."""
    rounded = float(f"{period:.2g}")
    return f"{rounded:,.0f}".replace(",", " ") if rounded >= 10 else f"{rounded:g}"


LIVE = (0.0, 0.1, 0.25, 0.5, 0.75)
"""Motions that may be chosen in the live part, by how many topple the object at less shaking [-]."""


def live_of(found: Assessment) -> Markup:
    """The object under some motions, live: that which topples it first, and others by how soon they do."""
    objects, motions = found.request.objects, found.motions
    order = np.argsort(found.counted.first_levels(), kind="stable")
    places = dict.fromkeys(int(order[int(part * (order.size - 1))]) for part in LIVE)
    chosen = [i for i in places if motions.base[i].pga > 0]
    if not chosen:
        return Markup("")
    if motions.both and objects.solid(objects.body) is not None:
        return _in_space(objects, motions, chosen)
    bodies = {
        name: objects.system_of(body) for name, body in objects.arrangements.items()
    }
    return live_kernel(
        bodies, carried([_named(motions, motions.base[i], i) for i in chosen])
    )


def _in_space(objects: Objects, motions: MotionSet, chosen: list[int]) -> Markup:
    """The ways to stand that are known in space, on pedestals that stay where they are, under both components."""
    bodies, left_out = {}, []
    for name, body in objects.arrangements.items():
        solid, pedestals = objects.solid(body), body.blocks[:-1]
        if solid is None:
            left_out.append(name)
            continue
        tall = sum(block.height for block in pedestals)
        bodies[name] = Standing(
            solid, replace(pedestals[-1], height=tall) if pedestals else None
        )
    records, place = motions.records, motions.place_of_record()
    shaking = []
    for record in dict.fromkeys(records[place[i]] for i in chosen):
        x, *others = motions.components(record)
        shaking.append(GroundMotion(_named(motions, x, record[0]), *others))
    return live_in_space(bodies, shaking, left_out)


def _named(motions: MotionSet, motion: Motion, i: int) -> Motion:
    """A motion with the name by which a reader knows it: earthquake, station and component."""
    about = motions.ground[i]
    earthquake, station = (
        str(about.metadata.get(key, "")) for key in ("earthquake", "station")
    )
    known = (
        f"{earthquake}, {station} ({about.name})"
        if earthquake and station
        else about.name
    )
    return replace(motion, name=known)


_REACHED = 0.995  # Fraction of motions up to which the curves are shown


def fractions_figure(found: Assessment) -> Figure:
    """Fraction of the motions that topple the object over the level of shaking, for each arrangement."""
    with panels(COLUMN_WIDTH, 2.7) as (figure, axes):
        ends = []
        for colour, (name, outcomes) in zip(
            OKABE_ITO, found.arrangements.items(), strict=False
        ):
            levels, fractions = outcomes.intensity_levels.levels, outcomes.fractions()
            if outcomes is found.outcomes:
                low, high = outcomes.band()
                axes.fill_between(
                    levels, 100 * low, 100 * high, color=colour, alpha=0.18, linewidth=0
                )
            axes.plot(levels, 100 * fractions, color=colour, label=name)
            shown = levels[(fractions > 0) & (fractions < _REACHED)]
            ends += (
                [shown.min(), shown.max()] if shown.size else [levels[0], levels[-1]]
            )
        if found.level is not None:
            axes.axvline(
                found.level.value, color="#555555", linestyle="--", linewidth=0.9
            )
            at = (found.level.value, 98)
            words = axes.annotate(
                "the site", at, (3, 0), textcoords="offset points", va="top"
            )
            words.set_color("#555555")
            ends.append(found.level.value)
        axes.set(
            xlim=(0.8 * min(ends), 1.25 * max(ends)),
            ylim=(0, 100),
            xlabel=f"{found.measure.imt} of the ground [{found.measure.unit}]",
            ylabel="Motions that topple it [%]",
        )
        plain_log(axes, "x")
        if len(found.arrangements) > 1:
            axes.legend(loc="upper left" if found.level is None else "center right")
    return figure


def sources_figure(found: Assessment) -> Figure:
    """How much each source of uncertainty adds to the interval."""
    ranked = sorted(found.main.sources.items(), key=lambda item: item[1])
    known = {NAMES[name]: value for name, value in ranked if np.isfinite(value)}
    with panels(COLUMN_WIDTH, 0.6 + 0.24 * len(known)) as (figure, axes):
        axes.barh(list(known), list(known.values()), color=BLUE, height=0.6)
        axes.set(xlabel="Standard deviation on the scale of the interval")
    return figure
