"""The building as an assumption: amplitudes on its floors where one of its properties is another."""

from functools import partial

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section
from rockfrag.report.wording import agree, number, of_all, sentence
from rockfrag.study.study import Study
from rockfrag_thesis.figures.building import AXIS_NAMES, floor_amplitudes
from rockfrag_thesis.settings import settings_of

_COLUMNS = (
    Column("axis", "Assumption"),
    Column("floor", "Floor"),
    Column("min", "Least mean [g]", 3),
    Column("max", "Largest mean [g]", 3),
)


def varies_building(study: Study) -> bool:
    """Whether a study varies its building."""
    return settings_of(study).sensitivity is not None


def _section(results: Results) -> Section:
    means = results.table("building_sensitivity/means")
    floors = means[(means["by"] == "floor") & (means["pedestal"] == "NP")]
    varied = floors[floors["axis"] != "reference"]
    axes = list(dict.fromkeys(varied["axis"]))
    span = varied.groupby(["axis", "floor"], sort=False)["mean_g"].agg(["min", "max"]).reset_index()
    span = span.assign(axis=[AXIS_NAMES.get(axis, axis) for axis in span["axis"]])
    variants = means.drop_duplicates("label")
    doubtful = int((~variants["credible"].astype(bool)).sum())
    return Section(
        "building",
        "The assumed building",
        _message(span),
        [
            "One property of the building is changed at a time. Lines are geometric means of the objects "
            "without pedestal over the motions that overturned them on every floor.",
            f"{sentence(of_all(doubtful, len(variants), 'building'))} "
            f"{agree(doubtful, len(variants), 'is', 'are')} shaken beyond the validity of the building model.",
        ],
        [
            *(
                FigureSpec(
                    f"building_{axis}",
                    f"Mean overturning amplitude on each floor over {AXIS_NAMES.get(axis, axis)}.",
                    f"Mean overturning amplitude on each floor. {AXIS_NAMES.get(axis, axis)}; crosses "
                    "mark buildings shaken beyond the validity of their model.",
                    partial(floor_amplitudes, means, axis),
                )
                for axis in axes
            ),
            table_html(span, _COLUMNS, "Range of the mean amplitude on each floor."),
        ],
    )


def _message(span: pd.DataFrame) -> str:
    """Say which assumption moves the mean amplitude of a floor most."""
    known = span[span["min"] > 0]
    if known.empty:
        return "No mean amplitude is known for other buildings."
    row = max(known.to_dict("records"), key=lambda row: float(row["max"] / row["min"]))
    return (
        f"The {str(row['axis']).lower()} matters most: the mean amplitude on {row['floor']} lies between "
        f"{number(row['min'], 2)} and {number(row['max'], 2)} g over the values tried."
    )


BUILDING = Part(("building_sensitivity/means",), _section, asked=varies_building)
