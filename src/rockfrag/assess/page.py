"""The page of one object, and the files that are written beside it.

In: an answer. Out: an HTML page, figures and tables. Docs: ``docs/assess.md``.
"""

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from textwrap import fill

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockfrag.assess.answer import Assessment
from rockfrag.assess.export import as_json, as_nrml
from rockfrag.assess.findings import (
    MOST_ASSUMPTIONS,
    all_assumed,
    assumptions,
    details,
    few_earthquakes,
    first_screen,
    helps,
    how_likely,
    mitigation_cell,
    position,
    quality_flags,
    starts,
    uncertainty,
    value_of,
)
from rockfrag.assess.hazard.curve import HazardCurve
from rockfrag.assess.mitigations import Mitigation
from rockfrag.assess.motions import MotionSet
from rockfrag.assess.sources import SOURCES, parts_of
from rockfrag.assess.standing import Standing
from rockfrag.assess.texts import Text
from rockfrag.base.arrays import Floats
from rockfrag.base.figure_style import BLUE, COLUMN_WIDTH, OKABE_ITO, panels, plain_log
from rockfrag.base.files import file_name, write_text
from rockfrag.outcomes.limit_states import ROCKS, limit_states
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.live import carried, live_kernel
from rockfrag.report.live.live_space import Standing as Shown
from rockfrag.report.live.live_space import live_in_space
from rockfrag.report.page import Page, text_table
from rockfrag.report.part import Answer, FigureSpec, Finding, Section
from rockfrag.words import findings as said
from rockfrag.words.catalogue import FIRST, Catalogue, catalogue
from rockfrag.words.findings import Value, finding
from rockfrag.words.sentences import number

Rows = Sequence[Sequence[Value]]
"""Rows of a table."""

MOTIONS_SHOWN = 15  # Rows of the table of motions that topple the object first

# Return periods are given up to so many times the reach of the hazard curve
FURTHEST = 3.0


def write_answer(
    found: Assessment, folder: str | os.PathLike[str], language: str = FIRST
) -> Path:
    """Write page, JSON and the fragility for OpenQuake into a folder.

    Parameters
    ----------
    found : the answer
    folder : into which they are written
    language : of the page

    Returns
    -------
    Path of the page.
    """
    stem = Path(folder) / file_name(found.request.name)
    write_text(as_json(found), f"{stem}.json")
    write_text(as_nrml(found), f"{stem}.xml")
    page = Path(f"{stem}.html")
    write_text(page_of(found, language), page)
    return page


def page_of(found: Assessment, language: str = FIRST) -> str:
    """Return the page as HTML in a language, which loads nothing from outside."""
    return _Layout(found, catalogue(language)).page()


@dataclass(frozen=True)
class _Layout:
    """Lays out the page of an answer in a language."""

    found: Assessment
    texts: Catalogue

    def page(self) -> str:
        """The page as HTML."""
        found, texts = self.found, self.texts
        sections = [
            self._helps(),
            self._stands(),
            self._sure(),
            self._assumed(),
            *([self._rules()] if found.rules else []),
            self._levels(),
            self._motions(),
            self._glossary(),
        ]
        provenance = {
            Text.PROVENANCE_PROGRAM: f"rockfrag {version('rockfrag')}",
            Text.PROVENANCE_MOTIONS: texts.say(found.motions.about_set),
            Text.PROVENANCE_HAZARD: found.hazard.source if found.hazard else "–",
        }
        lead = finding(
            Text.PAGE_LEAD,
            name=found.request.called,
            where=found.request.where,
            motions=found.motions.about_set,
        )
        return Page(
            title=texts.sentence(how_likely(found)).rstrip("."),
            lead=texts.sentence(lead),
            answer=self._answer(),
            sections=sections,
            provenance={texts.text(id): value for id, value in provenance.items()},
            live=live_of(found, texts),
            language=texts.language,
        ).html()

    def _text(self, id: str) -> str:
        return self.texts.text(id)

    def _answer(self) -> Answer:
        """First screen: the answer, what to do, and where each question is answered."""
        found, texts = self.found, self.texts
        first, *others, to_do = texts.lines(first_screen(found))
        behind = {**details(found)}
        numbers = [texts.paragraph(said) for said in list(behind.values())[:2]]
        assumed = [said.why for said in all_assumed(found) if said.short is not None]
        motions = finding(Text.SENTENCE, words=found.motions.about_set)
        asked = [
            (Text.ASK_HELPS, "mitigations"),
            (Text.ASK_STANDS, "arrangements"),
            (Text.ASK_SURE, "sure"),
            (Text.ASK_ASSUMED, "assumed"),
        ]
        if not found.request.objects.from_all_sides:
            asked.append((Text.ASK_LIVE, "live"))
        return Answer(
            asked=self._text(Text.PAGE_ASKED),
            sentences=[
                Finding(first.rstrip("."), " ".join(others), " ".join(numbers)),
                Finding(to_do.rstrip(".")),
                Finding(texts.paragraph(helps(found)).rstrip(".")),
            ],
            figure=FigureSpec(
                "fractions",
                self._text(Text.FRACTIONS_ALT),
                fractions_caption(found, texts),
                lambda: fractions_figure(found, texts),
            ),
            rests_on=texts.lines([motions, *assumed[:MOST_ASSUMPTIONS]]),
            could_change=texts.lines(
                [*quality_flags(found), *uncertainty(found), *self._worst()]
            ),
            questions=[(self._text(id), anchor) for id, anchor in asked],
        )

    def _worst(self) -> list[said.Finding]:
        """How much of the shaking is enough from the worst direction."""
        directions = self.found.directions
        if directions is None or not math.isfinite(directions.factor):
            return []
        factor = said.percent(directions.factor)
        return [finding(Text.WORST_DIRECTION, factor=factor)]

    def _table(
        self, caption: str, titles: Sequence[Value], rows: Rows, numeric: slice
    ) -> Markup:
        """A table of values under their titles; ``numeric``: which of its columns are of numbers."""
        head = self.texts.lines(titles)
        cells = [self.texts.lines(row) for row in rows]
        return text_table(head, cells, self._text(caption), head[numeric])

    def _helps(self) -> Section:
        """What changes do to the answer, and what each costs."""
        found = self.found
        rows: list[tuple[Value, ...]] = [
            (each.change, _with_it(found, each), mitigation_cell(found, each))
            for each in found.mitigations
        ]
        titles = [Text.COLUMN_CHANGE, Text.COLUMN_WITH_IT, Text.COLUMN_DOES]
        if found.request.costs:
            costs = [_cost(each.cost) for each in found.mitigations]
            rows = [(*row, cost) for row, cost in zip(rows, costs, strict=True)]
            titles.append(Text.COLUMN_COST)
        stated = (Text.HELPS_ANCHORS, Text.HELPS_ISOLATION, Text.HELPS_PAD)
        return Section(
            "mitigations",
            self._text(Text.HELPS_TITLE),
            self.texts.paragraph(helps(found)),
            [self._text(id) for id in stated],
            [self._titled(Text.CHANGES_CAPTION, titles, rows, slice(1, 2))],
        )

    def _titled(
        self, caption: str, titles: Sequence[Text], rows: Rows, numeric: slice
    ) -> Markup:
        """A table whose titles are texts; ``numeric``: which of its columns are of numbers."""
        return self._table(caption, [finding(id) for id in titles], rows, numeric)

    def _stands(self) -> Section:
        """How the answer differs between the arrangements in which the object may stand."""
        found = self.found
        rows = [
            (finding(way), value_of(found, value))
            for way, value in found.by_arrangement.items()
        ]
        stated = self._turned()
        if len(rows) > 1:
            stated.append(finding(Text.STANDS_FLOOR))
        titles = [Text.COLUMN_WAY, Text.COLUMN_ESTIMATE]
        return Section(
            "arrangements",
            self._text(Text.STANDS_TITLE),
            self.texts.paragraph(position(found)),
            self.texts.lines(stated),
            [self._titled(Text.ARRANGEMENTS_CAPTION, titles, rows, slice(1, None))],
        )

    def _turned(self) -> list[said.Finding]:
        """What records do that are turned through all directions."""
        directions = self.found.directions
        if directions is None or not math.isfinite(directions.factor):
            return []
        factor = said.percent(directions.factor)
        count = directions.records
        stated = [finding(Text.STANDS_TURNED, records=count, factor=factor)]
        if math.isfinite(directions.fraction):
            parts = {"worst": directions.worst_fraction, "random": directions.fraction}
            shown = {name: said.percent(part) for name, part in parts.items()}
            stated.append(finding(Text.STANDS_TURNED_AT_SITE, **shown))
        return stated

    def _sure(self) -> Section:
        """How sure the answer is, and which sources make it unsure."""
        found, texts = self.found, self.texts
        stated = [finding(Text.SURE_HOLDS), finding(Text.SURE_SCALE)]
        parts: list[FigureSpec | Markup] = []
        if found.main.sources:
            alt, caption = map(self._text, (Text.SOURCES_ALT, Text.SOURCES_CAPTION))
            drawn = FigureSpec(
                "sources", alt, caption, lambda: sources_figure(found, texts)
            )
            parts.append(drawn)
        message = uncertainty(found) or [finding(Text.SURE_AGREE)]
        return Section(
            "sure",
            self._text(Text.SURE_TITLE),
            texts.paragraph(message),
            texts.lines(stated),
            [*parts, self._sources_table(), self._effects_table()],
        )

    def _sources_table(self) -> Markup:
        """The part of each source in the uncertainty, what it is known from, and how to measure it."""
        rows = []
        for name, part in parts_of(self.found.main.sources).items():
            source = SOURCES[name]
            of_all = finding("whole_percent", value=said.whole(100 * part))
            rows.append(
                (source.called, of_all, source.basis, source.measurement or "–")
            )
        titles = [
            *(Text.COLUMN_UNKNOWN, Text.COLUMN_PART),
            *(Text.COLUMN_BASIS, Text.COLUMN_MEASURE_IT),
        ]
        return self._titled(Text.SOURCES_TABLE, titles, rows, slice(1, 2))

    def _effects_table(self) -> Markup:
        """How the answer changes with each measured quantity one standard deviation lower and higher."""
        found = self.found
        rows = []
        for effect in found.effects:
            # a direction is moved by an angle
            spread: Value = "–"
            if effect.spread > 0:
                spread = finding(Text.CELL_SD, value=said.two(100 * effect.spread))
            sides = [value_of(found, side) for side in effect.sides]
            rows.append((SOURCES[effect.name].called, spread, *sides))
        titles = [
            *(Text.COLUMN_INEXACT, Text.COLUMN_SD),
            *(Text.COLUMN_LESS, Text.COLUMN_MORE),
        ]
        return self._titled(Text.EFFECTS_CAPTION, titles, rows, slice(1, None))

    def _assumed(self) -> Section:
        """What was assumed, a sentence each."""
        title, message = map(self._text, (Text.ASSUMED_TITLE, Text.ASSUMED_MESSAGE))
        stated = self.texts.lines(assumptions(self.found))
        return Section("assumed", title, message, stated)

    def _rules(self) -> Section:
        """How rules of thumb do on this object beside the simulation."""
        rows = [
            (
                rule.rule,
                number(rule.bias, 2),
                number(rule.scatter, 2),
                said.percent(rule.unsafe),
            )
            for rule in self.found.rules
        ]
        titles = [
            *(Text.COLUMN_RULE, Text.COLUMN_BIAS),
            *(Text.COLUMN_SCATTER, Text.COLUMN_UNSAFE),
        ]
        stated = (Text.RULES_TITLE, Text.RULES_MESSAGE, Text.RULES_HOW)
        title, message, how = map(self._text, stated)
        table = self._titled(Text.RULES_CAPTION, titles, rows, slice(1, None))
        return Section("rules", title, message, [how], [table])

    def _levels(self) -> Section:
        """What topples at each level of shaking."""
        found, texts = self.found, self.texts
        stated: list[Value] = []
        if found.curve is not None and math.isfinite(found.curve.fit.theta):
            fit = found.curve.fit
            about = {"median": said.three(fit.theta), "beta": said.two(fit.beta)}
            stated.append(finding(Text.LEVELS_CURVE, unit=found.measure.unit, **about))
            stated += found.curve.warnings
        table = levels_table(found)
        caption = self._text(Text.LEVELS_CAPTION)
        head = texts.lines(table)
        rows = zip(*(texts.lines(column) for column in table.values()), strict=True)
        return Section(
            "levels",
            self._text(Text.LEVELS_TITLE),
            texts.sentence(starts(found)),
            texts.lines(stated),
            [text_table(head, rows, caption, head)],
        )

    def _motions(self) -> Section:
        """The motions, those first that topple the object at the lowest level."""
        found = self.found
        recorded = found.motions.values(found.measure)
        first = found.counted.first_levels()
        rows: list[tuple[Value, ...]] = []
        for i in np.argsort(first, kind="stable")[:MOTIONS_SHOWN]:
            motion = found.motions.ground[i]
            station = str(motion.metadata.get("station", ""))
            places = dict.fromkeys((str(found.motions.earthquakes[i]), station))
            where = ", ".join(place for place in places if place)
            levels = (number(recorded[i], 2), number(first[i], 2))
            rows.append((motion.name, where, *levels))
        unit = found.measure.unit
        titles = [
            finding(Text.COLUMN_MOTION),
            finding(Text.COLUMN_EARTHQUAKE),
            finding(Text.COLUMN_RECORDED, unit=unit),
            finding(Text.COLUMN_TOPPLES_FROM, unit=unit),
        ]
        message = finding(Text.SENTENCE, words=found.motions.about_set)
        table = self._table(Text.MOTIONS_CAPTION, titles, rows, slice(2, None))
        title = self._text(Text.MOTIONS_TITLE)
        return Section("motions", title, self.texts.sentence(message), (), [table])

    def _glossary(self) -> Section:
        """The words of the page and what they mean."""
        words = sorted(
            (
                self.texts.sentence(finding(f"word_{word}")),
                self._text(f"meaning_{word}"),
            )
            for word in words_of(self.found)
        )
        titles = [Text.COLUMN_WORD, Text.COLUMN_MEANING]
        stated = (Text.GLOSSARY_TITLE, Text.GLOSSARY_MESSAGE)
        table = self._titled(Text.GLOSSARY_CAPTION, titles, words, slice(0))
        title, message = map(self._text, stated)
        return Section("glossary", title, message, (), [table])


WORDS = (
    *("interval", "limit", "motion", "pulse", "rock", "planar", "restitution"),
    *("fragility", "lognormal", "pga", "pgv"),
)
"""Words of every page that a reader may not know."""

WORDS_OF_BUILDINGS, WORDS_OF_HAZARD = (
    ("level", "period", "damping"),
    ("hazard", "return"),
)


def words_of(found: Assessment) -> list[str]:
    """Words of a page that a reader may not know, by the ids of their texts."""
    used = [*WORDS]
    if found.measure.openquake == "SA":
        used.append("sa")
    if found.request.place.building is not None:
        used += WORDS_OF_BUILDINGS
    if found.hazard is not None:
        used += WORDS_OF_HAZARD
    return used


def levels_table(found: Assessment) -> dict[Value, list[Value]]:
    """Fractions of motions by the level of shaking: columns by their titles."""
    outcomes, levels = found.outcomes, found.outcomes.intensity_levels.levels
    fractions, (low, high) = outcomes.fractions(), outcomes.band()
    reached: dict[str, Value] = {ROCKS: finding(Text.LEVELS_ROCK)}
    for state in limit_states():
        if state.name in outcomes.others:
            reached[state.name] = finding(Text.LEVELS_STATE, state=state.label)
    # every fourth level, from the first that rocks to the first that topples nearly all
    rocks = outcomes.fractions(state=ROCKS)
    shown = np.flatnonzero((rocks > 0) & (np.append(0, fractions[:-1]) < 0.99))[::4]
    measure, unit = found.measure.imt, found.measure.unit
    title = finding(Text.COLUMN_MEASURE, measure=measure, unit=unit)
    table: dict[Value, list[Value]] = {title: [number(levels[i], 3) for i in shown]}
    for name, what in reached.items():
        parts = outcomes.fractions(state=name)
        table[what] = [_part(parts[i]) for i in shown]
    table[finding(Text.LEVELS_TOPPLE)] = [
        finding(
            Text.CELL_INTERVAL,
            value=_part(fractions[i]),
            lower=said.whole(100 * low[i]),
            upper=said.whole(100 * high[i]),
        )
        for i in shown
    ]
    if found.hazard is not None:
        table[finding(Text.LEVELS_PERIOD)] = _return_periods(
            found, found.hazard, levels[shown]
        )
    return table


def _return_periods(
    found: Assessment, hazard: HazardCurve, levels: Floats
) -> list[Value]:
    """Return period of each level, or the words that the hazard does not reach so far.

    It reaches FURTHEST times the last level of a curve that was read, or the one level that it was made of.
    """
    furthest = FURTHEST * hazard.levels[-1]
    if found.request.level is not None and not found.request.hazard[0].is_read:
        furthest = FURTHEST * found.request.level.value
    return [
        _years(1 / float(hazard.rate(level)))
        if level <= furthest
        else finding(Text.LEVELS_BEYOND)
        for level in levels
    ]


def _part(fraction: float) -> said.Finding:
    return finding("whole_percent", value=said.whole(100 * fraction))


def _years(period: float) -> str:
    """A return period [years] to two digits, as text: 475 becomes 480."""
    rounded = float(f"{period:.2g}")
    return f"{rounded:,.0f}".replace(",", " ") if rounded >= 10 else f"{rounded:g}"


def _with_it(found: Assessment, change: Mitigation) -> Value:
    """The answer with a change: what is compared by other motions, or in one plane, takes the same part off it."""
    if math.isnan(change.factor):
        return value_of(found, change.value)
    value = found.main.value * change.factor
    return value_of(found, value if found.target.is_level else min(value, 1.0))


def _cost(cost: float) -> Value:
    """What a change costs, as the user stated it."""
    return said.three(cost) if math.isfinite(cost) else "–"


LIVE = (0.0, 0.1, 0.25, 0.5, 0.75)
"""Motions that may be chosen in the live part, by how many topple the object at less shaking [-]."""


def live_of(found: Assessment, texts: Catalogue) -> Markup:
    """The object under some motions, live: that which topples it first, and others by how soon they do."""
    objects, motions = found.request.objects, found.motions
    order = np.argsort(found.counted.first_levels(), kind="stable")
    places = dict.fromkeys(int(order[int(part * (order.size - 1))]) for part in LIVE)
    chosen = [i for i in places if motions.base[i].pga > 0]
    if not chosen:
        return Markup("")
    if motions.both and objects.solid(objects.body) is not None:
        return _in_space(objects, motions, chosen, texts)
    bodies = {
        _shown_as(objects, way, texts): objects.system_of(body)
        for way, body in objects.arrangements().items()
    }
    shaking = carried([_named(motions, motions.base[i], i) for i in chosen])
    return live_kernel(bodies, shaking, texts=texts)


def _shown_as(objects: Standing, way: str, texts: Catalogue) -> str:
    """What the live part calls a way to stand: it simulates the object without what holds it."""
    stands = finding(way)
    free = finding(Text.SHOWN_FREE, way=stands) if objects.under.holders else stands
    return texts.say(free)


def _in_space(
    objects: Standing, motions: MotionSet, chosen: list[int], texts: Catalogue
) -> Markup:
    """Markup of the live view in space of the ways to stand that are known there.

    Parameters
    ----------
    objects : the object and how it may stand
    motions : both components of records
    chosen : numbers of motions, in ``motions.ground``, whose records may be looked at
    texts : of the page's language

    Pedestals stay where they are, so they are shown as one block as high as all; ways that are not known in space
    are named below the view.
    """
    bodies, left_out = {}, []
    for way, body in objects.arrangements().items():
        name = _shown_as(objects, way, texts)
        solid, pedestals = objects.solid(body), body.blocks[:-1]
        if solid is None:
            left_out.append(name)
            continue
        tall = sum(block.height for block in pedestals)
        bodies[name] = Shown(
            solid, replace(pedestals[-1], height=tall) if pedestals else None
        )
    records, place = motions.records, motions.place_of_record()
    shaking = []
    for record in dict.fromkeys(records[place[i]] for i in chosen):
        x, *others = motions.components(record)
        shaking.append(GroundMotion(_named(motions, x, record[0]), *others))
    return live_in_space(bodies, shaking, left_out, texts)


def _named(motions: MotionSet, motion: Motion, i: int) -> Motion:
    """A motion with the name by which a reader knows it: earthquake, station and component."""
    about = motions.ground[i]
    earthquake = str(about.metadata.get("earthquake", ""))
    station = str(about.metadata.get("station", ""))
    known = (
        f"{earthquake}, {station} ({about.name})"
        if earthquake and station
        else about.name
    )
    return replace(motion, name=known)


NAME_WIDTH = 28  # Letters of a line beside bars

_REACHED = 0.995  # Fraction of motions up to which the curves are shown


def fractions_figure(found: Assessment, texts: Catalogue) -> Figure:
    """Fraction of the motions that topple the object over the level of shaking, for each arrangement."""
    imt, unit = found.measure.imt, found.measure.unit
    with panels(COLUMN_WIDTH, 2.7) as (figure, axes):
        ends = []
        for colour, (way, outcomes) in zip(
            OKABE_ITO, found.arrangements.items(), strict=False
        ):
            levels, fractions = outcomes.intensity_levels.levels, outcomes.fractions()
            if outcomes is found.outcomes:
                low, high = outcomes.band()
                axes.fill_between(
                    levels, 100 * low, 100 * high, color=colour, alpha=0.18, linewidth=0
                )
            axes.plot(levels, 100 * fractions, color=colour, label=texts.text(way))
            shown = levels[(fractions > 0) & (fractions < _REACHED)]
            ends += (
                [shown.min(), shown.max()] if shown.size else [levels[0], levels[-1]]
            )
        if found.level is not None:
            _mark_site(axes, found, texts)
            ends.append(found.level.value)
        axes.set(
            xlim=(0.8 * min(ends), 1.25 * max(ends)),
            ylim=(0, 100),
            xlabel=texts.say(finding(Text.AXIS_LEVEL, measure=imt, unit=unit)),
            ylabel=texts.text(Text.AXIS_TOPPLE),
        )
        plain_log(axes, "x")
        if len(found.arrangements) > 1:
            axes.legend(loc="upper left" if found.level is None else "center right")
    return figure


def fractions_caption(found: Assessment, texts: Catalogue) -> str:
    """What band and bar of that figure hold."""
    ids = [Text.FRACTIONS_CAPTION]
    if _has_interval(found):
        ids.append(Text.FRACTIONS_CAPTION_SITE)
    return " ".join(map(texts.text, ids))


def _has_interval(found: Assessment) -> bool:
    """Whether the answer says what fraction topples at the site's level, with an interval."""
    return found.fraction is not None and not few_earthquakes(found)


def _mark_site(axes: Axes, found: Assessment, texts: Catalogue) -> None:
    """Draw the level of the site, and what the answer says there with all that is not known."""
    level, fraction = found.level, found.fraction
    assert level is not None
    axes.axvline(level.value, color="#555555", linestyle="--", linewidth=0.9)
    words = axes.annotate(
        texts.text(Text.AXIS_SITE),
        (level.value, 98),
        (3, 0),
        textcoords="offset points",
        va="top",
    )
    words.set_color("#555555")
    if fraction is None or not _has_interval(found):
        return
    below, above = fraction.value - fraction.lower, fraction.upper - fraction.value
    axes.errorbar(
        [level.value],
        [100 * fraction.value],
        [[100 * max(below, 0.0)], [100 * max(above, 0.0)]],
        fmt="o",
        color="#222222",
        markersize=4,
        capsize=3,
        clip_on=False,
    )


def sources_figure(found: Assessment, texts: Catalogue) -> Figure:
    """How much each source of uncertainty adds to the interval."""
    ranked = sorted(found.main.sources.items(), key=lambda item: item[1])
    finite = {name: value for name, value in ranked if np.isfinite(value)}
    # names on several lines leave room for the bars
    known = {
        fill(texts.say(SOURCES[name].called), NAME_WIDTH): finite[name]
        for name in finite
    }
    lines = sum(name.count("\n") + 1 for name in known)
    with panels(COLUMN_WIDTH, 0.8 + 0.12 * len(known) + 0.13 * lines) as (figure, axes):
        axes.barh(list(known), list(known.values()), color=BLUE, height=0.6)
        axes.set(xlabel=fill(texts.text(Text.AXIS_SOURCES), NAME_WIDTH))
        axes.locator_params(axis="x", nbins=4)
    return figure
