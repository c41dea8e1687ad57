"""Bodies, motions and shaking table that were tested, validity of the model, and records left out.

In: the results of a study (tables ``bodies``, ``measures``, ``shaker``, ``validity``, ``sliding``,
``scaling``, ``left_out``). Out: sections of the report with their tables and figures.

Docs: ``docs/report.md``; the model's assumptions: ``docs/rocking.md``, "What a response says about itself".
"""

from collections.abc import Sequence
from functools import partial
from itertools import cycle

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rockfrag.base import figure_style as style
from rockfrag.base.figure_style import GREY
from rockfrag.base.units import CENTIMETRES_PER_METRE, GRAVITY
from rockfrag.motions.intensity import intensity_measures
from rockfrag.records.motion import Motion
from rockfrag.records.quality_flags import DRIFT
from rockfrag.report.figures import MARKERS, drawn_tests
from rockfrag.report.findings import model_allowed, sliding_found
from rockfrag.report.page import Column, column, table_html
from rockfrag.report.part import FigureSpec, Results, Section, chapter
from rockfrag.report.sections.amplitudes import MOST_ROWS
from rockfrag.stages.tests import LIMITED, MOST_TESTED
from rockfrag.study.scaling import LARGEST_FACTOR
from rockfrag.words.sentences import (
    counted,
    label,
    listed,
    number,
    of_all,
    sentence,
    shortened,
)


def left_out(results: Results) -> Section | None:
    """Records that a study went on without."""
    table = results.table("left_out")
    if table.empty:
        return None
    columns = [
        column("motion", "Record"),
        column("reason", "Why it could not be used"),
    ]
    caption = "Records that could not be used."
    shown = table_html(table, columns, caption, "left_out.csv")
    names = list(table["motion"])
    records = counted(len(results.study.catalogue), "record")
    message = (
        f"{len(names)} of {records} could not be used: {_first_names(names)}. This page describes the "
        "others."
    )
    return Section("left-out", "Left out", message, [], [shown])


def _first_names(names: Sequence[str]) -> str:
    """All of a few names, the first two of many."""
    if len(names) <= MOST_NAMED:
        return listed(names)
    return f"{names[0]}, {names[1]} and others"


MOST_NAMED = 5  # so many records that were left out are named in a sentence


def shaker(results: Results) -> Section | None:
    """What the shaking table could do."""
    if results.study.shaker is None:
        return None
    limits, tests = results.table("shaker"), results.table("tests")
    limited = tests[tests["definition"] == LIMITED]
    ended = limited[limited["censored"] == "right"]
    free = results.tests[results.tests["censored"] == "right"]
    new = ended[~ended["test"].isin(free["test"])]
    names = [f"{row['test']} ({row['remark']})" for row in new.to_dict("records")]
    ended_tests = of_all(len(names), len(limited), "test") if names else "no test"
    message = (
        f"The shaking table’s limits end {ended_tests} before the object overturns."
    )
    caption = (
        "Peak up to which the shaking table can reproduce each motion (bars; behind each its limiting quantity: "
        "stroke, velocity, acceleration or force), and the peak that overturns each object."
    )
    draw = partial(shaker_limits, limits, results.tests)
    figure = FigureSpec("shaker_limits", message, caption, draw)
    columns = [
        column("motion"),
        column("travel_cm_per_g", "Peak to peak [cm/g]", decimals=2),
        column("excursion_cm_per_g", "From the start [cm/g]", decimals=2),
        column("limit_g", "Fits up to [g]", decimals=3),
        column("limited_by"),
    ]
    caption = "What each motion requires of the shaking table, per g of its peak."
    table = table_html(limits, columns, caption, "shaker.csv")
    words = [f"These are {listed(names)}."] if names else []
    words.append(
        "The definition “step protocol shaker” of the pedestal’s effect includes these limits. The other "
        "definitions do not, because the position at which the table starts is an assumption."
    )
    return Section(
        "shaker", "What the shaking table could do", message, words, [figure, table]
    )


def motions(results: Results) -> Section:
    """Motions with their measures and histories.

    Parameters
    ----------
    results : tables of the study

    Returns
    -------
    The section.
    """
    measures, ground = results.table("measures"), results.ground
    columns = [
        Column(
            each.column,
            f"{each.title or each.label} [{each.unit or '-'}]",
            each.decimals,
        )
        for each in intensity_measures()
        if each.decimals is not None
    ]
    columns.insert(0, column("name", "Motion"))
    caption = "Intensity of every motion as recorded."
    table = table_html(measures, columns, caption, "measures.csv")
    shown = min(len(ground), MOST_PANELS)
    peak = max(ground[:shown], key=lambda motion: motion.pga)
    records = len(results.records)
    caption = "Ground accelerations over time; the dot marks the peak."
    if shown < records:
        caption += f" The first {shown} of {records}; all are in the table."
    figure = FigureSpec(
        name="accelerations",
        alt=(
            f"Ground accelerations of {counted(shown, 'record')}; the strongest, {peak.name}, peaks at "
            f"{peak.pga / GRAVITY:.2f} g."
        ),
        caption=caption,
        draw=lambda: acceleration_histories(ground),
    )
    message = "The records shake the objects directly, without a building."
    if (building := results.study.building) is not None:
        floors = list(dict.fromkeys(measures["floor"]))
        message = (
            f"The motions of {counted(len(floors), 'floor')} ({listed(floors)}) are computed with a building "
            f"model ({building.name})."
        )
    scaling = results.table("scaling")
    words = [scaling_words(scaling), drift_words(scaling)]
    return Section(
        "motions",
        "Motions",
        message,
        [text for text in words if text],
        [table, figure, _scaling_html(scaling)],
    )


def scaling_words(scaling: pd.DataFrame) -> str:
    """Sentence on the factors by which motions are scaled.

    Parameters
    ----------
    scaling : table of the factors, a row a motion

    Returns
    -------
    The sentence.
    """
    least, most = scaling["factor_lowest"].min(), scaling["factor_highest"].max()
    words = (
        f"The amplitudes scale the motions by factors from {least:.2g} to {most:.3g}."
    )
    far = int((scaling["factor_highest"] > LARGEST_FACTOR).sum())
    if far:
        words += (
            f" At the highest amplitude {of_all(far, len(scaling), 'motion')} "
            f"{'is' if far == 1 else 'are'} scaled by more than {LARGEST_FACTOR:g}."
        )
    return words


def drift_words(scaling: pd.DataFrame) -> str:
    """Sentence on the motions that drift, empty if none does.

    Parameters
    ----------
    scaling : with ``motion`` and ``quality_flags``

    Returns
    -------
    The sentence.
    """
    drifting = scaling["quality_flags"].str.contains(DRIFT, regex=False)
    names = list(scaling.loc[drifting, "motion"])
    if not names:
        return ""
    return (
        f"{sentence(of_all(len(names), len(scaling), 'motion'))} ({_first_names(names)}) "
        f"{'ends' if len(names) == 1 else 'end'} with a drift, which topples what the earthquake may not have; "
        "a step of processing such as baseline or bandpass takes it away."
    )


def _scaling_html(scaling: pd.DataFrame) -> Markup:
    """Table of the factors on the motions."""
    columns = [
        column("motion"),
        column("pga_g", "Peak [g]", decimals=3),
        column("factor_lowest", "Factor at the lowest amplitude", decimals=2),
        column("factor_highest", "at the highest", decimals=2),
    ]
    if (scaling["quality_flags"] != "").any():
        columns.append(column("quality_flags", "What looks wrong"))
    caption = "By how much each motion is scaled."
    return table_html(scaling, columns, caption, "scaling.csv")


def bodies(results: Results) -> Section:
    """The objects, alone and on their pedestals."""
    table = results.table("bodies")
    is_held = table["held_by"].fillna("") != ""
    shown = table.assign(
        stands_on=table["stands_on"].replace("", "the floor"),
        width_cm=table["width_m"] * CENTIMETRES_PER_METRE,
        height_cm=table["height_m"] * CENTIMETRES_PER_METRE,
        uplift_g=table["uplift_m_s2"] / GRAVITY,
    )
    columns = [
        column("configuration"),
        column("stands_on"),
        *([column("held_by")] if is_held.any() else []),
        column("width_cm", decimals=1),
        column("height_cm", decimals=1),
        column("mass_kg", decimals=3),
        column("slenderness", "Height / width", decimals=2),
        column("critical_angle_rad", decimals=3),
        column("frequency_1_s", "Frequency parameter p [1/s]", decimals=2),
        column("uplift_g", "Starts to rock at [g]", decimals=3),
    ]
    caption = "The objects, alone and on their pedestals."
    message = sentence(counted(len(shown), "configuration"))
    known = shown["uplift_g"].dropna()
    if known.empty:
        message += "; simulation alone says when rocking starts."
    else:
        low, high = number(known.min(), 2), number(known.max(), 2)
        span = f"at {low} g" if low == high else f"between {low} and {high} g"
        condition = ""
        if results.study.slides or results.study.vertical:
            condition = " if the surfaces neither slip nor move vertically"
        message += f"; rocking starts {span} at the base{condition}."
    words = [
        "Rigid blocks that rock on two edges in the plane of the motion. The critical angle is the angle "
        "between the diagonal and the vertical. A block starts to rock when the acceleration of its base "
        "exceeds the one given, and overturns if it rotates too far beyond the critical angle."
    ]
    if len(known) < len(shown):
        words.append(
            "Where no acceleration is given the block is bonded, stands on an isolator or on casters, or touches "
            "a wall, and simulation alone says when it starts to rock."
        )
    return Section(
        "bodies", "Bodies", message, words, [table_html(shown, columns, caption)]
    )


def validity(results: Results) -> Section | None:
    """Validity of the model, or effect of friction where it is limited.

    Parameters
    ----------
    results : tables of the study

    Returns
    -------
    The section; None without tests that overturned.
    """
    if results.study.slides:
        return _sliding(results.table("sliding"))
    tests = results.table("validity")
    if tests.empty:
        return None
    demand = tests["friction_demand"].astype(float)
    known = tests.assign(
        needed=demand.where(np.isfinite(demand)),
        lifted=tests["least_normal_force_n"] <= 0,
    )
    shown = known.groupby(["object", "pedestal"], sort=False, as_index=False).agg(
        tests=("needed", "size"),
        known=("needed", "count"),
        median=("needed", "median"),
        largest=("needed", "max"),
        lifted=("lifted", "sum"),
    )
    side = shown["pedestal"].map({"P": "with", "NP": "without"})
    shown = shown.assign(side=side, beyond=shown["tests"] - shown["known"])
    columns = [
        column("object"),
        column("side", "Pedestal"),
        column("tests", decimals=0),
        column("median", "Friction needed, median", decimals=2),
        column("largest", "largest", decimals=2),
        column("beyond", "No friction is enough", decimals=0),
        column("lifted", "Lifts off", decimals=0),
    ]
    caption = "Friction coefficient needed, and tests with lift-off."
    which = "each test of a sample spread evenly over all"
    if shown["tests"].max() < MOST_TESTED:
        which = "every test"
    words = (
        f"Blocks neither slide nor jump in this model. The contact forces of {which}, at its overturning "
        "amplitude, give the friction that this requires."
    )
    return chapter(
        "validity",
        "What the model assumes",
        model_allowed(tests),
        [words],
        [table_html(shown, columns, caption)],
    )


def _sliding(sliding: pd.DataFrame) -> Section:
    """Section on what limited friction did; slips in metres."""
    shown = sliding.assign(largest_slip_cm=100 * sliding["largest_slip_m"])
    columns = [
        column("configuration"),
        column("cases", "Analyses", decimals=0),
        column("slid", "Slides", decimals=0),
        column("flew", "Flies", decimals=0),
        column("largest_slip_cm", decimals=1),
        column("saved", "Saved by sliding", decimals=0),
        column("felled", "Overturned by it", decimals=0),
    ]
    words = (
        "Bodies stick, slide, rock and fly with the friction of this study, at every amplitude of every motion. "
        "Each analysis is repeated without sliding. “Saved by sliding” overturns only without sliding, "
        "“overturned by it” only with sliding and flight."
    )
    table = table_html(shown, columns, "Sliding and flight in all analyses.")
    return chapter(
        "validity", "What friction does", sliding_found(sliding), [words], [table]
    )


def shaker_limits(limits: pd.DataFrame, tests: pd.DataFrame) -> Figure:
    """Draw the amplitude at which each motion leaves the shaker's limits beside what lone objects need, if any."""
    motions = list(limits["motion"])[:MOST_ROWS][::-1]
    place = {motion: number for number, motion in enumerate(motions)}
    lone = tests[tests["pedestal"] == "NP"]
    rows = drawn_tests(lone if len(lone) else tests)
    rows = rows[rows["motion"].isin(motions)]
    names = list(dict.fromkeys(rows["configuration"]))
    with style.panels(style.WIDEST, 1.2 + 0.22 * len(motions)) as (figure, axes):
        largest = limits.set_index("motion")["limit_g"]
        axes.barh(range(len(motions)), largest[motions], color="#dddddd", height=0.8)
        words = "up to the table's limit of the stated quantity"
        handles: list[Artist] = [Patch(color="#dddddd", label=words)]
        for name, marker, colour in zip(names, cycle(MARKERS), cycle(style.OKABE_ITO)):
            own = rows[rows["configuration"] == name]
            y = own["motion"].map(place).to_numpy(dtype=float)
            (line,) = axes.plot(
                own["a"], y, ls="", marker=marker, mfc="none", mec=colour, ms=4
            )
            line.set_label(f"{shortened(name)} overturns")
            handles.append(line)
            bounds = own["up"].to_numpy(dtype=bool)
            axes.plot(
                own["a"].to_numpy()[bounds],
                y[bounds],
                ls="",
                marker=">",
                color=colour,
                ms=3,
            )
        reasons = limits.set_index("motion")["limited_by"]
        marks = rows.groupby("motion")["a"].max()
        # behind the bar, and behind the marks that lie at its end or beyond
        ends = largest[motions].combine(1.03 * marks, max, fill_value=0.0)
        for y, motion in enumerate(motions):
            reason = axes.text(ends[motion], y, f" {reasons[motion]}", color=GREY)
            reason.set(va="center", fontsize=6.5)
        axes.set_xlim(0, 1.2 * float(ends.max()))
        axes.set_yticks(range(len(motions)), [label(name) for name in motions])
        axes.tick_params(axis="y", length=0)
        axes.set_xlabel("Peak acceleration of the motion [g]")
        figure.legend(handles=handles, loc="outside upper center", ncols=2)
        return figure


TWO_COLUMNS = 4  # so many motions are drawn in two columns
MOST_PANELS = 8  # more motions than this do not fit one figure; the first are drawn


def acceleration_histories(motions: Sequence[Motion]) -> Figure:
    """Draw the acceleration of ``MOST_PANELS`` motions over time with its peak, a panel a motion, on one scale."""
    shown = motions[:MOST_PANELS]
    columns = 1 if len(shown) < TWO_COLUMNS else 2
    rows = -(-len(shown) // columns)
    width = style.COLUMN_WIDTH if columns == 1 else style.PAGE_WIDTH
    shape = {"nrows": rows, "ncols": columns, "sharex": True, "sharey": True}
    with style.panels(width, 0.5 + 1.05 * rows, squeeze=False, **shape) as (
        figure,
        grid,
    ):
        panels = list(grid.ravel())
        highest = 1.12 * max(motion.pga for motion in shown) / GRAVITY
        for panel, motion in zip(panels, shown, strict=False):
            values = motion.acceleration / GRAVITY
            peak = style.draw_history(panel, motion.time, values, linewidth=0.5)
            panel.set_ylim(-highest, highest)
            name, earthquake = motion.name, str(motion.metadata.get("earthquake") or "")
            if earthquake.casefold() not in name.casefold():
                name = f"{earthquake}, {name}"
            panel.set_title(f"{shortened(name, 40)}: {peak:.2g} g", loc="left")
        for panel in panels[len(shown) :]:
            panel.set_visible(False)
        style.letter_panels(panels[: len(shown)], size=6.5)
        # the lowest panel of each column, which the right one may have a row higher
        for panel in panels[len(shown) - columns : len(shown)]:
            panel.set_xlabel("Time [s]")
            panel.tick_params(labelbottom=True)
        panels[0].set_xlim(0, max(motion.time[-1] for motion in shown))
        figure.supylabel("Acceleration [g]", fontsize=8)
        return figure
