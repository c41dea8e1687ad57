"""The page of a gallery: what topples together, what is lost, who adds most to it and what helps each."""

import math
import os
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter, NullFormatter

from rockfrag.assess.answer import assess_with
from rockfrag.assess.inventory import (
    Inventory,
    JointRisk,
    best_change,
    inventory_table,
    joint_lines,
)
from rockfrag.assess.page import write_answer
from rockfrag.assess.risk import probability_in
from rockfrag.assess.words import estimate_words, gallery_says, says
from rockfrag.base.figure_style import BLUE, COLUMN_WIDTH, PAGE_WIDTH, panels, plain_log
from rockfrag.base.files import write_table, write_text
from rockfrag.report.page import Page, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section

MOST_DRAWN = 40  # Objects of which the correlation is drawn: those that add most

RANKING = (
    "name = Object; place = Stands; probability = Topples (90 % interval) #",
    "contribution = Part of the mean [%] .1; change = What helps most",
)
NUMBERS = (
    "at_least = At least so many .0; rate = Earthquakes that topple so many [1/year] #",
    "probability = Probability [%] .2; probability_lower = Lower limit [%] .2",
    "probability_upper = Upper limit [%] .2",
)


def write_inventory(
    inventory: Inventory, folder: str | os.PathLike[str], *, pages: bool = False
) -> Path:
    """Write tables, a page, and with ``pages`` a full one of each object; return the path of the ranking."""
    place, joint = Path(folder) / "inventory.csv", inventory.joint
    write_table(inventory_table(inventory), place)
    if joint is not None:
        write_table(joint.numbers, place.with_name("together.csv"))
        write_table(joint.losses, place.with_name("losses.csv"))
        write_table(joint.correlation.reset_index(), place.with_name("correlation.csv"))
        write_text(gallery_page(inventory, joint), place.with_suffix(".html"))
    for found in inventory.found if pages else ():
        motions = inventory.motions.at(found.request.place)
        write_answer(assess_with(found.request, motions), folder)
    return place


def gallery_page(inventory: Inventory, joint: JointRisk) -> str:
    """Return the page as HTML, which loads nothing from outside."""
    first = inventory.found[0].request
    years, valued = first.years, math.isfinite(first.value)
    fewest, most = joint.numbers.iloc[0], joint.numbers.iloc[-1]
    numbers = gallery_says.figure(
        "numbers", lambda: numbers_figure(joint, years), years
    )
    losses = gallery_says.figure("losses", lambda: losses_figure(joint, years), years)
    drawn = gallery_says.figure("correlation", lambda: correlation_figure(joint))
    apart = joint.correlation.to_numpy()[np.triu_indices(len(joint.correlation), 1)]
    known, count = apart[np.isfinite(apart)], len(inventory.found)
    return Page(
        title=f"What {count} objects risk together",
        lead=f"{count} objects, shaken by the same {len(inventory.motions.ground)} motions.",
        answer=Answer(
            "How many topple in one earthquake, what is lost, and what helps?",
            [
                gallery_says.finding("how_many", fewest, most, years),
                *(Finding(words.rstrip(".")) for words in joint_lines(inventory)[1:]),
            ],
            numbers,
        ),
        sections=[
            _ranking(inventory, joint, "loss" if valued else "number"),
            _numbers(joint, [losses] if valued and len(joint.losses) > 1 else []),
            gallery_says.section(
                "correlation", [drawn], np.median(known) if known.size else None
            ),
        ],
        provenance={"Program": f"rockfrag {version('rockfrag')}"},
    ).html()


def _ranking(inventory: Inventory, joint: JointRisk, mean: str) -> Section:
    parts = joint.objects.set_index("name")["contribution"]
    rows = []
    for found in inventory.found:
        best, request = best_change(found), found.request
        change = says.line("mitigation", found, best) if best else "–"
        part = 100 * float(parts[request.name])
        rows.append(
            (
                request.name,
                request.place.words,
                estimate_words(found.main),
                part,
                change,
            )
        )
    names = ["name", "place", "probability", "contribution", "change"]
    ranked = pd.DataFrame(rows, columns=names)
    caption = "The objects, the one that adds most first; each change is simulated as a body of its own."
    table = table_html(ranked, RANKING, caption, "inventory.csv")
    return gallery_says.section("ranking", [table], joint.objects.iloc[0], mean)


def _numbers(joint: JointRisk, figures: Sequence[FigureSpec]) -> Section:
    numbers = joint.numbers
    most, rate = int(numbers["at_least"].max()), numbers["annual_rate"].iloc[-1]
    years = float(f"{1 / rate:.2g}") if rate else 0.0
    chances = [f"probability{end}" for end in ("", "_lower", "_upper")]
    shown = numbers.assign(
        rate=numbers["annual_rate"].map("{:.2g}".format), **100 * numbers[chances]
    )
    table = table_html(shown, NUMBERS, "How many objects topple in one earthquake.")
    return gallery_says.section("numbers", [table, *figures], most, years)


def numbers_figure(joint: JointRisk, years: float) -> Figure:
    """How probably at least so many topple in one earthquake."""
    numbers = joint.numbers
    at = numbers["at_least"].to_numpy()
    middle, low, high = (
        100 * numbers[name].to_numpy()
        for name in ("probability", "probability_lower", "probability_upper")
    )
    bars = [np.maximum(middle - low, 0), np.maximum(high - middle, 0)]
    with panels(COLUMN_WIDTH, 2.5) as (figure, axes):
        axes.errorbar(at, middle, yerr=bars, fmt="o", color=BLUE, capsize=2)
        _set_logarithmic(axes, "Objects that topple in one earthquake, at least", years)
        axes.set_xticks(at, [f"{n:g}" for n in at])
        axes.tick_params(axis="x", which="minor", bottom=False, labelbottom=False)
    return figure


def losses_figure(joint: JointRisk, years: float) -> Figure:
    """How probably a loss is exceeded in one earthquake."""
    losses = joint.losses
    chance = [100 * probability_in(rate, years) for rate in losses["annual_rate"]]
    with panels(COLUMN_WIDTH, 2.5) as (figure, axes):
        axes.step(losses["loss"], chance, where="pre", color=BLUE)
        _set_logarithmic(axes, "Loss in one earthquake [unit of the values]", years)
        axes.xaxis.set_major_formatter(EngFormatter(sep=""))
        axes.xaxis.set_minor_formatter(NullFormatter())
    return figure


def _set_logarithmic(axes: Axes, words: str, years: float) -> None:
    """Both axes by the logarithm: across what the words say, upwards the probability in some years."""
    label = f"Probability in {years:g} years [%]"
    axes.set(xscale="log", yscale="log", xlabel=words, ylabel=label)
    plain_log(axes, "y")


def correlation_figure(joint: JointRisk) -> Figure:
    """Correlation of the toppling of each two of the objects that add most."""
    names = list(joint.objects["name"][:MOST_DRAWN])
    table = joint.correlation.loc[names, names].to_numpy()
    side = min(PAGE_WIDTH, 2.4 + 0.11 * len(names))
    with panels(side, 0.8 * side) as (figure, axes):
        image = axes.imshow(table, vmin=0, vmax=1, cmap="Blues")
        short = [name if len(name) <= 18 else f"{name[:17]}…" for name in names]
        axes.set_xticks(range(len(names)), short, rotation=90, fontsize=6)
        axes.set_yticks(range(len(names)), short, fontsize=6)
        figure.colorbar(image, ax=axes, label="Correlation [-]")
    return figure
