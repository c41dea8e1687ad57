"""What the building's assumptions do to the amplitudes on its floors."""

import pandas as pd
from matplotlib.figure import Figure

from rockfrag.figure_style import COLUMN_WIDTH, OKABE_ITO, figure_style, new_figure
from rockfrag.report.figures.amplitudes import GREY, MARKERS
from rockfrag.report.wording import shortened

AXIS_NAMES = {
    "first_period_s": "First period of the elastic building [s]",
    "damping_ratio": "Damping ratio",
    "base_shear": "Shear strength of the masonry / weight",
    "ground_scale": "Scale factor on the records of the masonry building",
    "floors": "Levels of the floors",
}
"""The building's assumptions that a study may vary, for a reader."""


def floor_amplitudes(means: pd.DataFrame, axis: str) -> Figure:
    """Draw the mean overturning amplitude of lone objects on each floor along one assumption.

    ``means`` are those by floor of every variant, with its ``axis``, ``label``, ``value`` and ``credible``.
    """
    rows = means[(means["axis"] == axis) & (means["by"] == "floor") & (means["pedestal"] == "NP")]
    rows = rows.sort_values("value", kind="stable")
    labels = list(dict.fromkeys(rows["label"]))
    place = {label: number for number, label in enumerate(labels)}
    values = [f"{value:g}" for value in rows.drop_duplicates("label")["value"]]
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 2.8)
        axes = figure.subplots()
        for number, (floor, own) in enumerate(rows.groupby("floor", sort=False)):
            axes.plot(
                own["label"].map(place),
                own["mean_g"],
                color=OKABE_ITO[number % len(OKABE_ITO)],
                marker=MARKERS[number % len(MARKERS)],
                ms=3.5,
                label=str(floor),
            )
            doubtful = own[~own["credible"].astype(bool)]
            axes.plot(doubtful["label"].map(place), doubtful["mean_g"], "x", color=GREY, ms=6)
        names = (
            values if len(set(values)) == len(labels) else [shortened(label) for label in labels]
        )
        axes.set_xticks(range(len(labels)), names, rotation=90 if len(labels) > 8 else 0)
        axes.set_ylim(bottom=0)
        axes.set_xlabel(AXIS_NAMES.get(axis, axis))
        axes.set_ylabel("Mean overturning amplitude [g]")
        figure.legend(loc="outside upper center", ncols=4)
        return figure
