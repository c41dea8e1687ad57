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
from rockfrag.words.numbers import significant

LIMITS = (
    "What all objects share, the motion of this one earthquake and the error of the model, does not average out: "
    "more stones of one kind soon say no more.",
    "Objects that all fell say only that shaking was at least so strong, and objects that all stand that it was "
    "at most so strong; objects of several sizes bracket it.",
    "Stones that are mortared or pinned, that slide, lean or stand on soft ground, or that something else struck, "
    "are other objects; leave them out.",
    "PGV and PGA are those of the ground at the place, as the geometric mean of two components, and no intensity.",
)
"""Limits of every answer, a sentence each."""


def write_fallen(found: FallenPlace, folder: str | os.PathLike[str]) -> Path:
    """Write ``shaking.html``, ``shaking.json`` and ``shaking.csv`` into a folder.

    Parameters
    ----------
    found, folder : the place, and where files go

    Returns
    -------
    Path of the page.
    """
    page = Path(folder) / "shaking.html"
    write_table(posterior_table(found), page.with_suffix(".csv"))
    write_text(fallen_json(found), page.with_suffix(".json"))
    write_text(fallen_page(found), page)
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
        "groups": json.loads(_group_table(found).to_json(orient="records")),
        "shared_sd_ln": dict(found.shared),
        "direction": found.direction and _direction_data(found.direction),
        "motions": len(found.motions.ground),
        "limits": list(LIMITS),
    }
    return json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _direction_data(found: FallDirection) -> dict[str, float | int]:
    return dict(vars(found))


def fallen_lines(found: FallenPlace) -> list[str]:
    """Say the answer in lines for a screen.

    Parameters
    ----------
    found : the place

    Returns
    -------
    The lines.
    """
    lines = [
        f"Velocity   {_velocity(found)}",
        f"Peak       {_acceleration(found)}",
        f"Evidence   {_evidence(found)}",
    ]
    if found.direction is not None:
        lines.append(f"Direction  {_direction(found.direction)}")
    return [*lines, f"Hangs on   {_hangs_on(found)}", f"Limits     {' '.join(LIMITS)}"]


def _two(value: float) -> str:
    return significant(value, 2)


def _velocity(found: FallenPlace) -> str:
    """What PGV was, with its interval, or its one limit where the other is open."""
    middle, low, high = found.posterior.pgv()
    if found.posterior.open_above and found.posterior.open_below:
        return "PGV stays open: the falls say nothing of it."
    if found.posterior.open_above:
        return f"PGV was at least {_two(low)} cm/s; how much more stays open."
    if found.posterior.open_below:
        return f"PGV was at most {_two(high)} cm/s; how much less stays open."
    return f"PGV was about {_two(middle)} cm/s ({_two(low)} to {_two(high)} cm/s with 90 %)."


def _acceleration(found: FallenPlace) -> str:
    middle, low, high = found.posterior.pga()
    if found.posterior.open_above:
        return f"PGA was at least {_two(low)} g."
    if found.posterior.open_below:
        return f"PGA was at most {_two(high)} g."
    interval = f"{_two(low)} to {_two(high)} g with 90 %"
    return f"PGA was about {_two(middle)} g ({interval}), by the motions that have such a PGV."


def _evidence(found: FallenPlace) -> str:
    return (
        f"{found.fallen} of {found.count} objects fell; that narrows PGV by "
        f"{max(found.posterior.information_bit, 0.0):.1f} bit under {len(found.motions.ground)} motions."
    )


def _direction(found: FallDirection) -> str:
    if not found.points_somewhere:
        return f"{found.count} measured falls point nowhere in common (p = {found.p_value:.2g})."
    return (
        f"{found.count} measured falls point to {found.azimuth:.0f}° from north, within {found.within:.0f}° with "
        "90 %; square stones only fall over their edges."
    )


def _hangs_on(found: FallenPlace) -> str:
    parts = ", ".join(f"{name} {spread:.2g}" for name, spread in found.shared.items())
    own = max(found.own)
    return (
        f"what all share, as standard deviations of ln PGV ({parts}), and what differs from stone to stone "
        f"({own:.2g})."
    )


def _group_table(found: FallenPlace) -> pd.DataFrame:
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
                "fell": f"{group.fallen} of {group.count}",
                "fraction": group.fallen / group.count,
                "own_sd_ln": own,
                "alone": middle,
                "alone_lower": low,
                "alone_upper": high,
            }
        )
    return pd.DataFrame(rows)


def fallen_page(found: FallenPlace) -> str:
    """Return the page as HTML, which loads nothing from outside.

    Parameters
    ----------
    found : the place

    Returns
    -------
    HTML.
    """
    drawn = FigureSpec(
        name="shaking",
        alt=f"Probability of PGV before and after the falls. {_velocity(found)}",
        caption="PGV of the ground before (dashed) and after (solid) the falls were looked at.",
        draw=lambda: shaking_figure(found),
    )
    groups = table_html(
        _group_table(found),
        (
            column("name", "Objects"),
            column("width_cm", "Width [cm]", decimals=0),
            column("height_cm", "Height [cm]", decimals=0),
            column("fell", "Fell", numeric=True),
            column("alone", "PGV by these alone [cm/s]", decimals=0),
            column("alone_lower", "At least [cm/s]", decimals=0),
            column("alone_upper", "At most [cm/s]", decimals=0),
        ),
        "What fell and what stands, and what each kind says by itself (90 %).",
        "shaking.csv",
    )
    said = [
        Finding(_velocity(found).rstrip(".")),
        Finding(_acceleration(found).rstrip(".")),
        Finding(_evidence(found).rstrip(".")),
    ]
    sections = [
        Section("objects", "What fell and what stands", _evidence(found), (), [groups]),
        Section(
            "hangs-on",
            "What it hangs on",
            f"It hangs on {_hangs_on(found)}",
            LIMITS,
        ),
    ]
    if found.direction is not None:
        sections.insert(
            1,
            Section("direction", "Where falls point", _direction(found.direction)),
        )
    return Page(
        title=f"How strongly the ground shook: {found.fallen} of {found.count} fell",
        lead=f"What fell and what stands, under {len(found.motions.ground)} motions.",
        answer=Answer(
            asked="How strongly did the ground shake, if so many fell and so many stand?",
            sentences=said,
            figure=drawn,
            rests_on=LIMITS[:2],
        ),
        sections=sections,
        provenance={"Program": f"rockfrag {version('rockfrag')}"},
    ).html()


def shaking_figure(found: FallenPlace) -> Figure:
    """Density of ln PGV before and after the falls.

    Parameters
    ----------
    found : the place

    Returns
    -------
    The figure.
    """
    about = found.posterior
    step = math.log(about.levels[1] / about.levels[0])
    with style.panels(style.COLUMN_WIDTH, 2.6) as (figure, axes):
        axes.plot(
            about.levels, about.prior / step, "--", color=style.ORANGE, label="before"
        )
        axes.plot(
            about.levels,
            about.probability / step,
            color=style.BLUE,
            label="after the falls",
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
            xlabel="PGV of the ground [cm/s]",
            ylabel="Probability per unit of ln PGV [-]",
            ylim=(0, None),
        )
        style.plain_log(axes, "x")
        axes.legend(loc="upper left")
    return figure
