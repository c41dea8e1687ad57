"""What was tested: bodies, motions and shaking table, what the model assumes, and what a study went on without."""

from collections.abc import Sequence
from functools import partial
from itertools import cycle

import numpy as np
import pandas as pd
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rockfrag.base import figure_style as style
from rockfrag.base.units import CENTIMETRES_PER_METRE, GRAVITY
from rockfrag.motions.intensity import intensity_measures
from rockfrag.records.motion import Motion
from rockfrag.report.figures import GREY, MARKERS, drawn_tests
from rockfrag.report.findings import model_allowed, sliding_found
from rockfrag.report.page import Column
from rockfrag.report.part import Results, Section, says
from rockfrag.report.sections.amplitudes import MOST_ROWS
from rockfrag.stages.tests import LIMITED, MOST_TESTED
from rockfrag.words.sentences import label, number, shortened


def left_out(results: Results) -> Section | None:
    """Records that a study went on without."""
    if not results.study.keep_going or (table := results.table("left_out")).empty:
        return None
    shown = says.table("left_out", table, file="left_out.csv")
    return says.section(
        "left-out", [shown], list(table["motion"]), len(results.study.catalogue)
    )


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
    draw = partial(shaker_limits, limits, results.tests)
    figure = says.figure("shaker_limits", draw, names, len(limited))
    table = says.table("shaker", limits, file="shaker.csv")
    return says.section("shaker", [figure, table], names, len(limited))


def motions(results: Results) -> Section:
    """The motions, how strong each is and how it goes."""
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
    table = says.table("motions", measures, more=columns, file="measures.csv")
    shown = min(len(ground), MOST_PANELS)
    peak = max(ground[:shown], key=lambda motion: motion.pga)
    about = (shown, len(results.records), peak, peak.pga / GRAVITY)
    figure = says.figure(
        "accelerations", lambda: acceleration_histories(ground), *about
    )
    floors = list(dict.fromkeys(measures["floor"]))
    return says.section("motions", [table, figure], floors, results.study.building)


def bodies(results: Results) -> Section:
    """The objects, alone and on their pedestals."""
    table = results.table("bodies")
    shown = table.assign(
        stands_on=table["stands_on"].replace("", "the floor"),
        width_cm=table["width_m"] * CENTIMETRES_PER_METRE,
        height_cm=table["height_m"] * CENTIMETRES_PER_METRE,
        uplift_g=table["uplift_m_s2"] / GRAVITY,
    )
    ends = (
        number(value, 2) for value in (shown["uplift_g"].min(), shown["uplift_g"].max())
    )
    may_differ = results.study.slides or results.study.vertical
    return says.section(
        "bodies", [says.table("bodies", shown)], len(shown), *ends, may_differ
    )


def validity(results: Results) -> Section | None:
    """What the model assumes, or what friction did where it is limited."""
    if results.study.slides:
        sliding = results.table("sliding")
        shown = sliding.assign(largest_slip_cm=100 * sliding["largest_slip_m"])
        table = says.table("sliding", shown)
        return says.section("validity", [table], sliding_found(sliding), of="sliding")
    tests = results.table("validity")
    if tests.empty:
        return None
    demand = tests["friction_demand"].astype(float)
    needed, lifted = (
        demand.where(np.isfinite(demand)),
        tests["least_normal_force_n"] <= 0,
    )
    known = tests.assign(needed=needed, lifted=lifted)
    shown = known.groupby(["object", "pedestal"], sort=False, as_index=False).agg(
        tests=("needed", "size"),
        known=("needed", "count"),
        median=("needed", "median"),
        largest=("needed", "max"),
        lifted=("lifted", "sum"),
    )
    side = shown["pedestal"].map({"P": "with", "NP": "without"})
    shown = shown.assign(side=side, beyond=shown["tests"] - shown["known"])
    table, all_tests = says.table("validity", shown), shown["tests"].max() < MOST_TESTED
    return says.section("validity", [table], model_allowed(tests), all_tests)


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
        for y, motion in enumerate(motions):
            reason = axes.text(largest[motion], y, f" {reasons[motion]}", color=GREY)
            reason.set(va="center", fontsize=6.5)
        axes.set_xlim(0, 1.2 * float(largest[motions].max()))
        axes.set_yticks(range(len(motions)), [label(name) for name in motions])
        axes.tick_params(axis="y", length=0)
        axes.set_xlabel("Peak acceleration of the motion [g]")
        figure.legend(handles=handles, loc="outside upper center", ncols=2)
        return figure


MOST_PANELS = 8  # more motions than this do not fit one figure; the first are drawn


def acceleration_histories(motions: Sequence[Motion]) -> Figure:
    """Draw the acceleration of ``MOST_PANELS`` motions over time with its peak, a panel a motion, on one scale."""
    shown = motions[:MOST_PANELS]
    size, shape = (style.COLUMN_WIDTH, 0.5 + 0.95 * len(shown)), {"nrows": len(shown)}
    with style.panels(*size, **shape, sharex=True, sharey=True, squeeze=False) as (
        figure,
        grid,
    ):
        panels = grid[:, 0]
        highest = 1.12 * max(motion.pga for motion in shown) / GRAVITY
        for panel, motion in zip(panels, shown, strict=True):
            values = motion.acceleration / GRAVITY
            peak = style.draw_history(panel, motion.time, values, linewidth=0.5)
            panel.set_ylim(-highest, highest)
            name, earthquake = motion.name, str(motion.metadata.get("earthquake") or "")
            if earthquake.casefold() not in name.casefold():
                name = f"{earthquake}, {name}"
            panel.set_title(f"{shortened(name, 44)}: {peak:.2f} g", loc="left")
        style.letter_panels(panels, size=6.5)
        panels[-1].set_xlabel("Time [s]")
        panels[-1].set_xlim(0, max(motion.time[-1] for motion in shown))
        figure.supylabel("Acceleration [g]", fontsize=8)
        return figure
