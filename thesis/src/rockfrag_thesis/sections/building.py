"""The building as an assumption: amplitudes on its floors where one of its properties is another."""

from functools import partial

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, figure_of, section_of
from rockfrag.study.study import Study
from rockfrag_thesis.figures.building import AXIS_NAMES, floor_amplitudes
from rockfrag_thesis.sections.words import sentences
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
    figures = [
        figure_of(
            sentences().building_figure(AXIS_NAMES.get(axis, axis)),
            f"building_{axis}",
            partial(floor_amplitudes, means, axis),
        )
        for axis in axes
    ]
    table = table_html(span, _COLUMNS, "Range of the mean amplitude on each floor.")
    known = span[span["min"] > 0].to_dict("records")
    most = max(known, key=lambda row: float(row["max"] / row["min"]), default=None)
    text = sentences().building(most, doubtful, len(variants))
    return section_of(text, "building", [*figures, table])


BUILDING = Part(("building_sensitivity/means",), _section, asked=varies_building)
