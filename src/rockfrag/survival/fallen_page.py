"""Page of a place whose shaking was estimated by what fell and what stands, and the files beside it.

In: :class:`rockfrag.survival.fallen.FallenPlace`. Out: HTML, JSON and CSV files, and lines for a screen; PGV
[cm/s], PGA [g]. Theory and limits: ``docs/constrain-shaking.md``.
"""

import json
import math
import os
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from rockfrag.base import figure_style as style
from rockfrag.base.files import write_table, write_text
from rockfrag.report.page import Page, column, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section
from rockfrag.survival.directions_of_falls import FallDirection
from rockfrag.survival.fallen import FallenPlace
from rockfrag.words.catalogue import FIRST, Catalogue, catalogue
from rockfrag.words.findings import Finding as Said
from rockfrag.words.findings import Value, finding, listed, two, whole

LIMITS = (
    "fallen_limit_shared",
    "fallen_limit_one_sided",
    "fallen_limit_others",
    "fallen_limit_place",
)
"""Texts of the limits of every answer, a sentence each."""


AXIS_IS_OPEN = 60.0  # Half of an interval from which no axis is said [degrees]
VELOCITY = ("fallen_velocity", "fallen_velocity_at_least", "fallen_velocity_at_most")
PEAK = ("fallen_peak", "fallen_peak_at_least", "fallen_peak_at_most")
"""Texts of a level: with its interval, and with one limit."""

COMMON_ERRORS = {
    "model": "fallen_share_model",
    "second component": "fallen_share_second_component",
    "slenderness": "fallen_share_slenderness",
}
"""Texts of what all objects share."""


def write_fallen(
    found: FallenPlace, folder: str | os.PathLike[str], language: str = FIRST
) -> Path:
    """Write ``shaking.html``, ``shaking.json`` and ``shaking.csv`` into a folder.

    Parameters
    ----------
    found : the place
    folder, language : where files go, and the language of the page

    Returns
    -------
    Path of the page.
    """
    page = Path(folder) / "shaking.html"
    write_table(posterior_table(found), page.with_suffix(".csv"))
    write_text(fallen_json(found), page.with_suffix(".json"))
    write_text(fallen_page(found, language), page)
    return page


def posterior_table(found: FallenPlace) -> pd.DataFrame:
    """Make a row a level of PGV: its probability before and after.

    Parameters
    ----------
    found : the place

    Returns
    -------
    Columns ``pgv_cm_s``, ``probability_before`` and ``probability_after`` [-].
    """
    about = found.posterior
    return pd.DataFrame(
        {
            "pgv_cm_s": about.levels,
            "probability_before": about.prior,
            "probability_after": about.probability,
        }
    )


def fallen_json(found: FallenPlace) -> str:
    """Return the numbers of the answer as JSON.

    Parameters
    ----------
    found : the place

    Returns
    -------
    JSON.
    """
    pgv, pga = found.posterior.pgv(), found.posterior.pga()
    names = ("median", "lower", "upper")
    content = {
        "pgv_cm_s": dict(zip(names, pgv, strict=True)),
        "pga_g": dict(zip(names, pga, strict=True)),
        "interval": 0.9,
        "at_least": found.posterior.open_above,
        "at_most": found.posterior.open_below,
        "information_bit": found.posterior.information_bit,
        "fallen": found.fallen,
        "count": found.count,
        "groups": json.loads(
            _group_table(found, catalogue()).to_json(orient="records")
        ),
        "shared_sd_ln": dict(found.shared),
        "direction": found.direction and _direction_data(found.direction),
        "axis": found.axis and dict(vars(found.axis)),
        "motions": len(found.motions.ground),
        "limits": [catalogue().text(id) for id in LIMITS],
    }
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _direction_data(found: FallDirection) -> dict[str, float | int]:
    return dict(vars(found))


def fallen_lines(found: FallenPlace, language: str = FIRST) -> list[str]:
    """Say the answer in lines for a screen.

    Parameters
    ----------
    found, language : the place, and the language

    Returns
    -------
    The lines.
    """
    texts = catalogue(language)
    said: dict[str, list[Value]] = {
        "fallen_head_velocity": [_velocity(found)],
        "fallen_head_peak": [_acceleration(found)],
        "fallen_head_evidence": _evidence(found),
    }
    if found.direction is not None:
        said["fallen_head_direction"] = _directions(found, found.direction)
    said["fallen_head_hangs_on"] = [_hangs_on(found)]
    said["fallen_head_limits"] = [finding(id) for id in LIMITS]
    heads = [texts.text(id) for id in said]
    longest = max(map(len, heads))
    words = [" ".join(map(texts.say, values)) for values in said.values()]
    return [
        f"{head:<{longest}}  {line}" for head, line in zip(heads, words, strict=True)
    ]


def _velocity(found: FallenPlace) -> Said:
    """What PGV was, with its interval, or its one limit where the other is open."""
    about = found.posterior
    if about.open_above and about.open_below:
        return finding("fallen_velocity_open")
    return _level(VELOCITY, about.pgv(), found)


def _acceleration(found: FallenPlace) -> Said:
    return _level(PEAK, found.posterior.pga(), found)


def _level(
    texts: tuple[str, str, str], level: tuple[float, float, float], found: FallenPlace
) -> Said:
    """A level with its interval, or with its one limit where the other is open."""
    middle, low, high = map(two, level)
    both, at_least, at_most = texts
    if found.posterior.open_above:
        return finding(at_least, low=low)
    if found.posterior.open_below:
        return finding(at_most, high=high)
    return finding(both, middle=middle, low=low, high=high)


def _evidence(found: FallenPlace) -> list[Value]:
    """How many fell, what was known before, and whether both agree."""
    n = len(found.motions.ground)
    said: list[Value] = [
        finding("fallen_evidence", fallen=found.fallen, count=found.count, n=n)
    ]
    if not found.knowledge.prior.knows_something:
        return said
    middle, low, high = found.posterior.pgv_before()
    known = finding("fallen_before", middle=two(middle), low=two(low), high=two(high))
    said.append(known)
    if not low <= found.posterior.pgv()[0] <= high:
        said.append(finding("fallen_against"))
    return said


def _directions(found: FallenPlace, falls: FallDirection) -> list[Value]:
    """Where falls point, and along which axis the ground shook most, if that can be said."""
    said: list[Value] = [_direction(falls)]
    if found.axis is not None and found.axis.within < AXIS_IS_OPEN:
        azimuth, within = whole(found.axis.azimuth), whole(found.axis.within)
        said.append(finding("fallen_axis", azimuth=azimuth, within=within))
    return said


def _direction(found: FallDirection) -> Said:
    """Where falls point, or that they point nowhere, in words."""
    if not found.points_somewhere:
        return finding("fallen_nowhere", n=found.count, p=two(found.p_value))
    return finding(
        "fallen_towards",
        n=found.count,
        azimuth=whole(found.azimuth),
        within=whole(found.within),
    )


def _hangs_on(found: FallenPlace) -> Said:
    """Errors that objects share and have of their own, in words."""
    shared = [
        finding(COMMON_ERRORS[name], spread=two(spread))
        for name, spread in found.shared.items()
    ]
    return finding("fallen_hangs_on", shared=listed(shared), own=two(max(found.own)))


def _group_table(found: FallenPlace, texts: Catalogue) -> pd.DataFrame:
    """Each group of objects: its size, how many fell, and the shaking that it says alone."""
    rows = []
    for group, own, (middle, low, high) in zip(
        found.groups, found.own, found.alone, strict=True
    ):
        block = group.request.objects.block
        rows.append(
            {
                "name": group.request.name,
                "width_cm": 100 * block.width,
                "height_cm": 100 * block.height,
                "fell": texts.say(
                    finding("fallen_of", fallen=group.fallen, count=group.count)
                ),
                "fraction": group.fallen / group.count,
                "own_sd_ln": own,
                "alone": middle,
                "alone_lower": low,
                "alone_upper": high,
            }
        )
    return pd.DataFrame(rows)


def fallen_page(found: FallenPlace, language: str = FIRST) -> str:
    """Return the page as HTML, which loads nothing from outside.

    Parameters
    ----------
    found, language : the place, and the language

    Returns
    -------
    HTML.
    """
    texts = catalogue(language)
    caption = texts.text("fallen_figure")
    drawn = FigureSpec(
        name="shaking",
        alt=f"{caption} {texts.say(_velocity(found))}",
        caption=caption,
        draw=lambda: shaking_figure(found, texts),
    )
    said = texts.lines([_velocity(found), _acceleration(found), *_evidence(found)])
    limits = [texts.text(id) for id in LIMITS]
    count = finding("fallen_title", fallen=found.fallen, count=found.count)
    lead = finding("fallen_lead", n=len(found.motions.ground))
    return Page(
        title=texts.say(count),
        lead=texts.say(lead),
        answer=Answer(
            asked=texts.text("fallen_asked"),
            sentences=[Finding(sentence.rstrip(".")) for sentence in said],
            figure=drawn,
            rests_on=limits[:2],
        ),
        sections=_sections(found, texts),
        provenance={
            texts.text("provenance_program"): f"rockfrag {version('rockfrag')}"
        },
        language=texts.language,
    ).html()


def _sections(found: FallenPlace, texts: Catalogue) -> list[Section]:
    """Chapters: the objects, where they fell, and on what the answer hangs."""
    columns = (
        column("name", texts.text("fallen_column_name")),
        column("width_cm", texts.text("fallen_column_width"), decimals=0),
        column("height_cm", texts.text("fallen_column_height"), decimals=0),
        column("fell", texts.text("fallen_column_fell"), numeric=True),
        column("alone", texts.text("fallen_column_alone"), decimals=0),
        column("alone_lower", texts.text("fallen_column_lower"), decimals=0),
        column("alone_upper", texts.text("fallen_column_upper"), decimals=0),
    )
    caption = texts.text("fallen_table")
    table = table_html(
        _group_table(found, texts),
        columns,
        caption,
        "shaking.csv",
        language=texts.language,
    )
    limits = [texts.text(id) for id in LIMITS]
    title = texts.text("fallen_objects")
    sections = [
        Section("objects", title, " ".join(texts.lines(_evidence(found))), (), [table]),
        Section(
            "hangs-on",
            texts.text("fallen_head_hangs_on"),
            texts.sentence(_hangs_on(found)),
            limits,
        ),
    ]
    if found.direction is not None:
        title = texts.text("fallen_directions")
        said = " ".join(map(texts.say, _directions(found, found.direction)))
        where = Section("direction", title, said)
        sections.insert(1, where)
    return sections


def shaking_figure(found: FallenPlace, texts: Catalogue) -> Figure:
    """Density of ln PGV before and after the falls.

    Parameters
    ----------
    found, texts : the place, and the texts of a language

    Returns
    -------
    The figure.
    """
    about = found.posterior
    step = math.log(about.levels[1] / about.levels[0])
    with style.panels(style.COLUMN_WIDTH, 2.6) as (figure, axes):
        axes.plot(
            about.levels,
            about.prior / step,
            "--",
            color=style.ORANGE,
            label=texts.text("fallen_figure_before"),
        )
        axes.plot(
            about.levels,
            about.probability / step,
            color=style.BLUE,
            label=texts.text("fallen_figure_after"),
        )
        _, low, high = about.pgv()
        inside = (about.levels >= low) & (about.levels <= high)
        axes.fill_between(
            about.levels,
            np.where(inside, about.probability / step, np.nan),
            color=style.BLUE,
            alpha=0.2,
            linewidth=0,
        )
        axes.set(
            xscale="log",
            xlabel=texts.text("fallen_figure_axis"),
            ylabel=texts.text("fallen_figure_density"),
            ylim=(0, None),
        )
        style.plain_log(axes, "x")
        axes.legend(loc="upper left")
    return figure
