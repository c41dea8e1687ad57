"""Hypotheses of the thesis on floors, their order and margins, where the building is another.

In: the tables ``building_sensitivity/…``; margins [-] of amplitudes. Out: a section of the report. Theory:
``docs/building.md``, "The building as an axis".
"""

from collections.abc import Sequence
from functools import partial
from textwrap import fill

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.colors import SymLogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from rockfrag.base.figure_style import BLUE, COLUMN_WIDTH, GREEN, ORANGE, WIDEST, panels
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Results, Section
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag.words.sentences import number
from rockfrag_thesis.floor_order import HYPOTHESES, TIE
from rockfrag_thesis.sections.building import AXIS_NAMES
from rockfrag_thesis.settings import settings_of

FLOOR_STYLES = {
    "GF": ("ground floor", BLUE, "o"),
    "F3": ("3rd floor", ORANGE, "s"),
    "F5": ("5th floor", GREEN, "^"),
}

MEANINGFUL = 0.02
"""Margins below this mean nothing: the amplitudes of an IDA curve are 1 or 2 % apart."""

_COLUMNS = (
    Column("axis", "Assumption"),
    Column("hypothesis", "Hypothesis"),
    Column("min", "Least margin [%]", 1),
    Column("max", "Largest margin [%]", 1),
)


def floor_order_found(results: Results) -> Section | None:
    """Order of the floors and margins of the hypotheses in other buildings; None where none is varied."""
    if settings_of(results.study).sensitivity is None:
        return None
    margins = results.table("building_sensitivity/margins")
    rows = margins[margins["definition"] == DEFINITION]
    order = rows[(rows["axis"] == "first_period_s") & (rows["hypothesis"] == "order")]
    holds = [
        f"{value:g} s" for value in order.loc[order["margin"] > MEANINGFUL, "value"]
    ]
    varied = rows[rows["axis"] != "reference"]
    span = varied.groupby(["axis", "hypothesis"], sort=False)["margin"].agg(
        ["min", "max"]
    )
    # adding zero turns a negative zero into a plain one
    shown = ((100 * span).round(1) + 0.0).reset_index()
    shown["axis"] = shown["axis"].map(AXIS_NAMES)
    low, high = 100 * float(span["min"].min()), 100 * float(span["max"].max())
    message = f"Margins of the hypotheses lie between {number(low, 1)} and {number(high, 1)} %."
    parts: list[Markup | FigureSpec] = []
    if len(order):
        message = _order_message(holds, len(order))
        draw = partial(
            floor_order,
            results.table("building_sensitivity/means"),
            margins,
            DEFINITION,
        )
        caption = (
            "Mean overturning amplitude of lone objects on each floor over the first period of the building; "
            "shaded where the order is the thesis’s."
        )
        parts.append(FigureSpec("sensitivity_order", message, caption, draw))
    parts += [_margins_figure(margins, axis) for axis in dict.fromkeys(varied["axis"])]
    parts.append(
        table_html(shown, _COLUMNS, "Range of the margins of each hypothesis.")
    )
    title = "The thesis’s floors in other buildings"
    return Section("sensitivity", title, message, [], parts)


def _order_message(holds: Sequence[str], periods: int) -> str:
    """First periods, of those tried, at which the order of the floors is the thesis's."""
    order = "The thesis’s order of the floors, ground highest and 3rd lowest,"
    if not holds:
        return f"{order} does not appear by more than 2 % at any of {periods} first periods tried."
    return (
        f"{order} appears by more than 2 % at {len(holds)} of {periods} first periods tried "
        f"({', '.join(holds)})."
    )


def _margins_figure(margins: pd.DataFrame, axis: str) -> FigureSpec:
    """Figure of the margins along one assumption."""
    name = AXIS_NAMES[axis]
    return FigureSpec(
        name=f"sensitivity_hypotheses_{axis}",
        alt=f"Margins of the thesis’s hypotheses on floors over {name}.",
        caption=(
            "Margin by which each hypothesis on floors is true (positive) or false; dots: true by more than 2 %. "
            f"{name}."
        ),
        draw=partial(floor_hypotheses, margins, axis, DEFINITION),
    )


def floor_order(means: pd.DataFrame, margins: pd.DataFrame, definition: str) -> Figure:
    """Draw the mean overturning amplitude of lone objects on each floor against the first period.

    Shaded are the periods at which the order is the thesis's, ground highest and 3rd lowest. For ``margins`` see
    :func:`rockfrag_thesis.floor_order.margins_table`.
    """
    means = means[(means["axis"] == "first_period_s") & (means["by"] == "floor")]
    means = means[means["pedestal"] == "NP"]
    by_floor = means.pivot_table(
        index="value", columns="floor", values="mean_g", dropna=False
    )
    margins = margins[
        (margins["axis"] == "first_period_s") & (margins["hypothesis"] == "order")
    ]
    order = margins[margins["definition"] == definition].sort_values("value")
    with panels(COLUMN_WIDTH, 2.9) as (figure, axes):
        for floor, (name, colour, marker) in FLOOR_STYLES.items():
            of_floor = by_floor[floor]
            axes.plot(
                by_floor.index, of_floor, color=colour, marker=marker, ms=3, label=name
            )
        axes.set_ylim(bottom=0)
        _shade(axes, order["value"].to_numpy(), order["margin"].to_numpy())
        axes.set(
            xlabel="First period [s]",
            ylabel="Mean overturning amplitude,\nlone objects [g]",
        )
        handles, labels = axes.get_legend_handles_labels()
        handles += [Patch(color="#bbbbbb"), Patch(color="#e8e8e8")]
        labels += ["the thesis's order", f"by less than {100 * MEANINGFUL:.0f} %"]
        figure.legend(handles, labels, loc="outside upper center", ncols=2)
    return figure


def _shade(axes: Axes, periods: np.ndarray, margins: np.ndarray) -> None:
    """Shade the surroundings of each period where the order holds, half-way to its neighbours."""
    if periods.size == 0:
        return
    middles = (periods[1:] + periods[:-1]) / 2
    edges = np.concatenate([periods[:1], middles, periods[-1:]])
    for left, right, margin in zip(edges[:-1], edges[1:], margins, strict=True):
        if margin > TIE:
            colour = "#bbbbbb" if margin > MEANINGFUL else "#e8e8e8"
            axes.axvspan(left, right, color=colour, lw=0, zorder=0)


def floor_hypotheses(margins: pd.DataFrame, axis: str, definition: str) -> Figure:
    """Draw by how much each hypothesis about floors holds along an assumption such as ``first_period_s``."""
    chosen = margins[(margins["axis"] == axis) & (margins["definition"] == definition)]
    chosen = chosen[chosen["hypothesis"].isin(list(HYPOTHESES))]
    chosen = chosen.sort_values("value", kind="stable")
    labels = list(dict.fromkeys(chosen["label"]))
    values = [f"{value:g}" for value in dict.fromkeys(chosen["value"])]
    table = chosen.pivot_table(index="hypothesis", columns="label", values="margin")
    table = table.reindex(index=list(HYPOTHESES), columns=labels)
    with panels(WIDEST, 4.6) as (figure, axes):
        largest = 100 * max(
            0.1, float(np.nanmax(np.abs(table.to_numpy()), initial=0.0))
        )
        norm = SymLogNorm(linthresh=1, vmin=-largest, vmax=largest)
        image = axes.imshow(
            100 * table.to_numpy(), norm=norm, cmap="PuOr", aspect="auto"
        )
        # a dot where a hypothesis holds by enough to mean something
        rows, columns = np.nonzero(table.to_numpy() > MEANINGFUL)
        axes.plot(columns, rows, "o", color="black", ms=2)
        ticks = values if len(set(values)) == len(labels) else labels
        axes.set_xticks(range(len(labels)), ticks, rotation=90)
        axes.set_xlabel(AXIS_NAMES[axis])
        names = [fill(f"{number} {text}", 48) for number, text in HYPOTHESES.items()]
        axes.set_yticks(range(len(names)), names, fontsize=7)
        axes.tick_params(length=0)
        axes.spines[:].set_visible(False)
        marks = [-50, -10, -1, 0, 1, 10, 50]
        bar = figure.colorbar(image, ax=axes, pad=0.01, ticks=marks)
        bar.ax.set_yticklabels([str(mark) for mark in marks])
        bar.set_label("Margin [%], positive: holds")
    return figure
