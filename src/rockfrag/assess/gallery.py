"""The page of a gallery: what topples together, what is lost, who adds most to it and what helps each.

In: an assessed inventory. Out: an HTML page and tables. Docs: ``docs/assess.md``, "A gallery".
"""

import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, NullFormatter

from rockfrag.assess.answer import assess_with
from rockfrag.assess.findings import estimate_of, mitigation
from rockfrag.assess.inventory import (
    Inventory,
    best_change,
    inventory_table,
    joint_findings,
)
from rockfrag.assess.joint_risk import JointRisk
from rockfrag.assess.page import write_answer
from rockfrag.assess.risk import probability_in
from rockfrag.assess.texts import Text
from rockfrag.base.figure_style import BLUE, COLUMN_WIDTH, PAGE_WIDTH, panels, plain_log
from rockfrag.base.files import write_table, write_text
from rockfrag.report.page import Column, Page, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section
from rockfrag.words.catalogue import FIRST, Catalogue, catalogue
from rockfrag.words.findings import Value, finding, limit, percent, three, two

MOST_DRAWN = 40  # Objects of which the correlation is drawn: those that add most


def write_inventory(
    inventory: Inventory,
    folder: str | os.PathLike[str],
    *,
    pages: bool = False,
    language: str = FIRST,
) -> Path:
    """Write tables and a page of an inventory.

    Parameters
    ----------
    inventory : the objects, assessed
    folder : into which they are written
    pages : whether a full page of each object is written too
    language : of the texts

    Returns
    -------
    Path of the page with the ranking.
    """
    place, joint = Path(folder) / "inventory.csv", inventory.joint
    write_table(inventory_table(inventory), place)
    if joint is not None:
        write_table(joint.numbers, place.with_name("together.csv"))
        write_table(joint.losses, place.with_name("losses.csv"))
        write_table(joint.correlation.reset_index(), place.with_name("correlation.csv"))
        page = gallery_page(inventory, joint, language)
        write_text(page, place.with_suffix(".html"))
    for found in inventory.found if pages else ():
        motions = inventory.motions.at(found.request.place)
        write_answer(assess_with(found.request, motions), folder, language)
    return place


def gallery_page(inventory: Inventory, joint: JointRisk, language: str = FIRST) -> str:
    """Return the page as HTML in a language, which loads nothing from outside."""
    return _Layout(inventory, joint, catalogue(language)).page()


@dataclass(frozen=True)
class _Layout:
    """Lays out the page of a gallery in a language."""

    inventory: Inventory
    joint: JointRisk
    texts: Catalogue

    @property
    def years(self) -> float:
        """Time for which probabilities are given [year]."""
        return self.inventory.found[0].request.years

    @property
    def valued(self) -> bool:
        """Whether the objects have values."""
        return math.isfinite(self.inventory.found[0].request.value)

    def page(self) -> str:
        """The page of all objects as HTML."""
        inventory = self.inventory
        joint = self.joint
        texts = self.texts
        years = self.years
        numbers = self._figure(
            "numbers",
            (Text.NUMBERS_ALT, Text.NUMBERS_CAPTION),
            lambda: numbers_figure(joint, years, texts),
        )
        losses = self._figure(
            "losses",
            (Text.LOSSES_ALT, Text.LOSSES_CAPTION),
            lambda: losses_figure(joint, years, texts),
        )
        drawn = self._figure(
            "correlation",
            (Text.CORRELATION_ALT, Text.CORRELATION_CAPTION),
            lambda: correlation_figure(joint, texts),
        )
        count, motions = len(inventory.found), len(inventory.motions.ground)
        others = texts.lines(joint_findings(inventory)[1:])
        lead = finding(Text.GALLERY_LEAD, n=count, motions=motions)
        lost = [losses] if self.valued and len(joint.losses) > 1 else []
        return Page(
            title=texts.say(finding(Text.GALLERY_TITLE, n=count)),
            lead=texts.say(lead),
            answer=Answer(
                texts.text(Text.GALLERY_ASKED),
                [self._how_many(), *(Finding(words.rstrip(".")) for words in others)],
                numbers,
            ),
            sections=[self._ranking(), self._numbers(lost), self._correlation(drawn)],
            provenance={
                texts.text(Text.PROVENANCE_PROGRAM): f"rockfrag {version('rockfrag')}"
            },
            language=texts.language,
        ).html()

    def _figure(
        self, name: str, words: tuple[Text, Text], draw: Callable[[], Figure]
    ) -> FigureSpec:
        """A figure with its description and caption in the page's language."""
        alt, caption = words
        below = self.texts.say(finding(caption, years=three(self.years)))
        return FigureSpec(name, self.texts.text(alt), below, draw)

    def _how_many(self) -> Finding:
        """How probably one or more, and the most that topple together, do."""
        first, last = self.joint.numbers.iloc[0], self.joint.numbers.iloc[-1]
        first_one = finding(
            Text.ONE_OR_MORE,
            years=three(self.years),
            p=percent(first["probability"]),
            lower=limit(first["probability_lower"]),
            upper=limit(first["probability_upper"]),
        )
        p = percent(last["probability"])
        most = finding(Text.SO_MANY, n=int(last["at_least"]), p=p)
        return Finding(self.texts.say(first_one), self.texts.say(most))

    def _ranking(self) -> Section:
        """Which objects add most to the expected loss, and what helps each."""
        texts = self.texts
        parts = self.joint.objects.set_index("name")["contribution"]
        rows = []
        for found in self.inventory.found:
            best, request = best_change(found), found.request
            row = {
                "name": request.name,
                "place": texts.say(request.where),
                "probability": texts.say(estimate_of(found.main)),
                "contribution": 100 * float(parts[request.name]),
                "change": texts.sentence(mitigation(found, best)) if best else "–",
            }
            rows.append(row)
        titles = {
            "name": Text.COLUMN_OBJECT,
            "place": Text.COLUMN_STANDS,
            "probability": Text.COLUMN_TOPPLES,
            "contribution": Text.COLUMN_OF_MEAN,
            "change": Text.COLUMN_HELPS,
        }
        columns = [
            Column(
                name,
                texts.text(title),
                1 if name == "contribution" else None,
                name == "probability",
            )
            for name, title in titles.items()
        ]
        caption = texts.text(Text.RANKING_CAPTION)
        table = table_html(
            pd.DataFrame(rows),
            columns,
            caption,
            "inventory.csv",
            language=texts.language,
        )
        title, message = texts.text(Text.RANKING_TITLE), texts.say(self._adds_most())
        return Section("ranking", title, message, (), [table])

    def _adds_most(self) -> Value:
        """The object that adds most to the expected loss or number, and its part of it where that is known."""
        top = self.joint.objects.iloc[0]
        name = str(top["name"])
        if not math.isfinite(top["contribution"]):
            return finding(Text.ADDS_MOST, name=name)
        text = Text.ADDS_MOST_LOSS if self.valued else Text.ADDS_MOST_NUMBER
        return finding(text, name=name, part=percent(top["contribution"]))

    def _numbers(self, figures: Sequence[FigureSpec]) -> Section:
        """How many objects topple in one earthquake, and how often."""
        texts, numbers = self.texts, self.joint.numbers
        most, rate = int(numbers["at_least"].max()), numbers["annual_rate"].iloc[-1]
        message = finding(Text.NONE_TOPPLES)
        if rate:
            message = finding(Text.NUMBERS_TOGETHER, count=most, years=two(1 / rate))
        chances = [f"probability{end}" for end in ("", "_lower", "_upper")]
        shown = numbers.assign(
            rate=numbers["annual_rate"].map("{:.2g}".format), **100 * numbers[chances]
        )
        titles = (Text.COLUMN_PROBABILITY, Text.COLUMN_LOWER, Text.COLUMN_UPPER)
        columns = [
            Column("at_least", texts.text(Text.COLUMN_AT_LEAST), 0),
            Column("rate", texts.text(Text.COLUMN_RATE), numeric=True),
            *(
                Column(name, texts.text(title), 2)
                for name, title in zip(chances, titles, strict=True)
            ),
        ]
        table = table_html(shown, columns, texts.text(Text.NUMBERS_TABLE))
        return Section(
            "numbers",
            texts.text(Text.NUMBERS_TITLE),
            texts.say(message),
            [texts.text(Text.NUMBERS_WITHOUT)],
            [table, *figures],
        )

    def _correlation(self, drawn: FigureSpec) -> Section:
        """How alike the objects topple, pair by pair."""
        table = self.joint.correlation
        apart = table.to_numpy()[np.triu_indices(len(table), 1)]
        known = apart[np.isfinite(apart)]
        message = finding(Text.NO_PAIR)
        if known.size:
            message = finding(Text.PAIR_MEDIAN, median=two(float(np.median(known))))
        title = self.texts.text(Text.CORRELATION_TITLE)
        return Section("correlation", title, self.texts.say(message), (), [drawn])


def numbers_figure(joint: JointRisk, years: float, texts: Catalogue) -> Figure:
    """How probably at least so many topple in one earthquake."""
    numbers = joint.numbers
    at = numbers["at_least"].to_numpy()
    middle = 100 * numbers["probability"].to_numpy()
    low = 100 * numbers["probability_lower"].to_numpy()
    high = 100 * numbers["probability_upper"].to_numpy()
    bars = [np.maximum(middle - low, 0), np.maximum(high - middle, 0)]
    with panels(COLUMN_WIDTH, 2.5) as (figure, axes):
        axes.errorbar(at, middle, yerr=bars, fmt="o", color=BLUE, capsize=2)
        _set_logarithmic(axes, texts, Text.AXIS_NUMBERS, years)
        axes.set_xticks(at, [f"{n:g}" for n in at])
        axes.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
    return figure


def losses_figure(joint: JointRisk, years: float, texts: Catalogue) -> Figure:
    """How probably a loss is exceeded in one earthquake."""
    losses = joint.losses
    chance = [100 * probability_in(rate, years) for rate in losses["annual_rate"]]
    with panels(COLUMN_WIDTH, 2.5) as (figure, axes):
        axes.step(losses["loss"], chance, where="pre", color=BLUE)
        _set_logarithmic(axes, texts, Text.AXIS_LOSSES, years)
        axes.xaxis.set_major_formatter(EngFormatter(sep=""))
        axes.xaxis.set_minor_formatter(NullFormatter())
    return figure


def _set_logarithmic(axes: Axes, texts: Catalogue, across: Text, years: float) -> None:
    """Both axes by the logarithm: across what the text says, upwards the probability in some years."""
    label = texts.say(finding(Text.AXIS_PROBABILITY, years=three(years)))
    axes.set(xscale="log", yscale="log", xlabel=texts.text(across), ylabel=label)
    plain_log(axes, "y")


def correlation_figure(joint: JointRisk, texts: Catalogue) -> Figure:
    """Correlation of the toppling of each two of the objects that add most."""
    names = list(joint.objects["name"][:MOST_DRAWN])
    table = joint.correlation.loc[names, names].to_numpy()
    side = min(PAGE_WIDTH, 2.4 + 0.11 * len(names))
    with panels(side, 0.8 * side) as (figure, axes):
        image = axes.imshow(table, vmin=0, vmax=1, cmap="Blues")
        short = [name if len(name) <= 18 else f"{name[:17]}…" for name in names]
        axes.set_xticks(range(len(names)), short, rotation=90, fontsize=6)
        axes.set_yticks(range(len(names)), short, fontsize=6)
        figure.colorbar(image, ax=axes, label=texts.text(Text.AXIS_CORRELATION))
    return figure
