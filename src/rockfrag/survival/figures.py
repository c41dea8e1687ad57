"""What stands on the page of a site as drawings."""

from collections.abc import Hashable

import numpy as np
from matplotlib.figure import Figure

from rockfrag import figure_style as style
from rockfrag.survival.answer import Constrained

MOST_BRANCHES_SHOWN = 20
"""Branches whose weights are drawn: those that matter most before or after."""


LONGEST_LABEL = 34
"""Characters of a branch's name beside its weights."""


def curves_figure(found: Constrained) -> Figure:
    """Mean hazard before and after, with the range of the branches from the 16th to the 84th percentile."""
    measure = found.site.measure
    curves = found.result.curves(measure)
    level = curves["level"].to_numpy()
    with style.one_panel(style.COLUMN_WIDTH, 2.8) as (figure, axes):
        for when, colour, line, words in (
            ("before", style.ORANGE, "--", "before"),
            ("after", style.BLUE, "-", "after survival"),
        ):
            axes.fill_between(
                level,
                curves[f"fractile_0.16_{when}"],
                curves[f"fractile_0.84_{when}"],
                color=colour,
                alpha=0.2,
                linewidth=0,
            )
            axes.plot(
                level, curves[f"mean_{when}"], color=colour, linestyle=line, label=f"mean {words}"
            )
        rates = curves[["mean_before", "mean_after"]].to_numpy()
        axes.set(
            ylim=(max(rates[-1].min(), 1e-6), min(rates[0].max() * 1.5, 10.0)),
            xlabel=f"{measure.imt} of the ground [{measure.unit}]",
            ylabel="Annual rate of exceedance [1/year]",
        )
        style.plain_log(axes, "xy")
        axes.legend(loc="lower left")
    return figure


def weights_figure(found: Constrained) -> Figure:
    """Weights of the branches before and after, those that matter most."""
    table = found.result.table()
    largest = table[["weight_before", "weight_after"]].max(axis=1)
    table = table.loc[
        largest.sort_values(ascending=False, kind="stable").index[:MOST_BRANCHES_SHOWN]
    ]
    table = table.sort_values("weight_after", kind="stable")
    place = np.arange(len(table))
    with style.one_panel(style.WIDEST, 0.7 + 0.2 * len(table)) as (figure, axes):
        axes.hlines(
            place, table["weight_before"], table["weight_after"], color="#999999", linewidth=0.8
        )
        axes.plot(
            table["weight_before"],
            place,
            "o",
            color=style.ORANGE,
            markerfacecolor="none",
            label="before",
        )
        axes.plot(table["weight_after"], place, "s", color=style.BLUE, label="after survival")
        names = [_short(name, number) for number, name in table["branch"].items()]
        axes.set_yticks(place, names)
        axes.set(xlabel="Weight of the branch [-]", xlim=(0, None))
        figure.legend(loc="outside upper center", ncols=2)
    return figure


def _short(name: str, number: Hashable) -> str:
    """Name of a branch that fits beside an axis: a long one by its place in the table and its end."""
    short = f"row {int(str(number)) + 1}: …{name[8 - LONGEST_LABEL :]}"
    return name if len(name) <= LONGEST_LABEL else short
