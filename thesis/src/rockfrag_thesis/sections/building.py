"""Building as an assumption: amplitudes on its floors where one of its properties is changed.

In: the tables ``building_sensitivity/…``; amplitudes [g]. Out: a section of the report. Theory:
``docs/building.md``, "The building as an axis".
"""

from functools import partial

import pandas as pd
from matplotlib.figure import Figure

from rockfrag.base.figure_style import COLUMN_WIDTH, GREY, OKABE_ITO, panels
from rockfrag.report.figures import MARKERS
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Results, Section
from rockfrag.words.sentences import agree, number, of_all, sentence, shortened
from rockfrag_thesis.settings import settings_of

AXIS_NAMES = {
    "first_period_s": "First period of the elastic building [s]",
    "damping_ratio": "Damping ratio",
    "base_shear": "Shear strength of the masonry / weight",
    "ground_scale": "Scale factor on the records of the masonry building",
    "floors": "Levels of the floors",
}
"""The building's assumptions that a study may vary, for a reader."""

_COLUMNS = (
    Column("axis", "Assumption"),
    Column("floor", "Floor"),
    Column("min", "Least mean [g]", 3),
    Column("max", "Largest mean [g]", 3),
)


def building(results: Results) -> Section | None:
    """Amplitudes on the floors of other buildings; None where the study varies none."""
    if settings_of(results.study).sensitivity is None:
        return None
    means = results.table("building_sensitivity/means")
    floors = means[(means["by"] == "floor") & (means["pedestal"] == "NP")]
    varied = floors[floors["axis"] != "reference"]
    span = (
        varied.groupby(["axis", "floor"], sort=False)["mean_g"]
        .agg(["min", "max"])
        .reset_index()
    )
    span = span.assign(axis=span["axis"].map(AXIS_NAMES))
    variants = means.drop_duplicates("label")
    doubtful = int((~variants["credible"].astype(bool)).sum())
    figures = [_figure(means, axis) for axis in dict.fromkeys(varied["axis"])]
    table = table_html(span, _COLUMNS, "Range of the mean amplitude on each floor.")
    known = span[span["min"] > 0].to_dict("records")
    most = max(known, key=lambda row: float(row["max"] / row["min"]), default=None)
    message = "No mean amplitude is known for other buildings."
    if most is not None:
        message = (
            f"The {most['axis'].lower()} matters most: the mean amplitude on {most['floor']} lies between "
            f"{number(most['min'], 2)} and {number(most['max'], 2)} g over the values tried."
        )
    words = [
        "One property of the building is changed at a time. Lines are geometric means of the objects without "
        "pedestal over the motions that overturned them on every floor.",
        f"{sentence(of_all(doubtful, len(variants), 'building'))} {agree(doubtful, len(variants), 'is', 'are')} "
        "shaken beyond the validity of the building model.",
    ]
    return Section(
        "building", "The assumed building", message, words, [*figures, table]
    )


def _figure(means: pd.DataFrame, axis: str) -> FigureSpec:
    """Figure of the amplitudes along one assumption."""
    name = AXIS_NAMES[axis]
    return FigureSpec(
        name=f"building_{axis}",
        alt=f"Mean overturning amplitude on each floor over {name}.",
        caption=(
            f"Mean overturning amplitude on each floor. {name}; crosses mark buildings shaken beyond the "
            "validity of their model."
        ),
        draw=partial(floor_amplitudes, means, axis),
    )


def floor_amplitudes(means: pd.DataFrame, axis: str) -> Figure:
    """Draw the mean overturning amplitude of lone objects on each floor along one assumption.

    ``means`` are those by floor of every variant, with its ``axis``, ``label``, ``value`` and ``credible``.
    """
    rows = means[
        (means["axis"] == axis) & (means["by"] == "floor") & (means["pedestal"] == "NP")
    ]
    rows = rows.sort_values("value", kind="stable")
    labels = list(dict.fromkeys(rows["label"]))
    place = {label: number for number, label in enumerate(labels)}
    values = [f"{value:g}" for value in rows.drop_duplicates("label")["value"]]
    with panels(COLUMN_WIDTH, 2.8) as (figure, axes):
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
            axes.plot(
                doubtful["label"].map(place), doubtful["mean_g"], "x", color=GREY, ms=6
            )
        names = (
            values if len(set(values)) == len(labels) else list(map(shortened, labels))
        )
        axes.set_xticks(
            range(len(labels)), names, rotation=90 if len(labels) > 8 else 0
        )
        axes.set_ylim(bottom=0)
        axes.set(xlabel=AXIS_NAMES[axis], ylabel="Mean overturning amplitude [g]")
        figure.legend(loc="outside upper center", ncols=4)
    return figure
