"""Optional parts of a study in its report: tables, figures with captions, and a section for each."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from rockfrag.report.figures.building import AXIS_NAMES
from rockfrag.report.page import Column, Picture, Section, table_html
from rockfrag.report.sections.explanation import explanation_section
from rockfrag.report.sections.measured import measured_section
from rockfrag.shaketable.readings import READING
from rockfrag.stages.measured_tests import MEASURED_TABLES
from rockfrag.stages.shaker import LIMITED
from rockfrag.study.study import Study

Tables = Mapping[str, pd.DataFrame]
Pictures = Mapping[str, Picture]

ORDER_FIGURE = "sensitivity_order"
STATEMENTS_FIGURE = "sensitivity_statements_"


@dataclass(frozen=True)
class Supplement:
    """An optional part: names of its tables, captions of its figures by name, and its section."""

    tables: tuple[str, ...]
    section: Callable[[Tables, Pictures], Section]
    captions: Mapping[str, str] = field(default_factory=dict)


def supplements(study: Study) -> list[Supplement]:
    """Optional parts of a study, in the order of its report."""
    found = [Supplement(("measure_choice", "fragility_ground"), _measures)]
    if study.more.explanation is not None and study.has_pairs:
        caption = (
            "Ratio P/NP where one factor at a time differs from the ideal model, with 95 % intervals "
            "over earthquakes; small marks are floors. Grey is ±10 %."
        )
        names = ("explanation/ratios", "explanation/effects")
        found.append(Supplement(names, explanation_section, {"explanation": caption}))
    if study.more.shaker is not None:
        caption = (
            "Peak up to which each motion fits the shaker (bars), and the peak that overturns each "
            "lone object without a limit."
        )
        found.append(Supplement(("shaker",), _shaker, {"shaker_limits": caption}))
    if study.more.sensitivity is not None and study.compare_with == "thesis":
        captions = {
            name: "By how much each statement on floors holds (positive) or fails; dots: by more than "
            f"2 %. {AXIS_NAMES.get(name.removeprefix(STATEMENTS_FIGURE), '')}."
            for name in sensitivity_figures(study)
        }
        if ORDER_FIGURE in captions:
            captions[ORDER_FIGURE] = (
                "Mean overturning amplitude of lone objects on each floor over the first period of the "
                "building, by three readings; shaded where the order is the thesis’s."
            )
        names = ("building_sensitivity/tests", "building_sensitivity/margins")
        found.append(Supplement(names, _sensitivity, captions))
    if study.more.measured_tests is not None:
        caption = "Measured over simulated amplitude of the same test; arrows are lower bounds."
        claims = ("measured/claims",) if study.compare_with == "thesis" else ()
        found.append(
            Supplement((*MEASURED_TABLES, *claims), measured_section, {"measured_beside": caption})
        )
    return found


def sensitivity_figures(study: Study) -> list[str]:
    """Names of the figures of the building's sensitivity."""
    axes = list(study.more.sensitivity or {})
    order = [ORDER_FIGURE] if "first_period_s" in axes else []
    return [*order, *(f"{STATEMENTS_FIGURE}{axis}" for axis in axes)]


def supplement_tables(study: Study) -> list[str]:
    """Names of all tables of the optional parts."""
    return [name for one in supplements(study) for name in one.tables]


def supplement_figures(study: Study) -> list[str]:
    """Names of all figures of the optional parts."""
    return [name for one in supplements(study) for name in one.captions]


def supplement_pictures(study: Study, folder: Path) -> dict[str, Picture]:
    """Figures of the optional parts with captions, from the files in ``folder``."""
    return {
        name: Picture(folder / f"{name}.svg", caption)
        for one in supplements(study)
        for name, caption in one.captions.items()
    }


def supplement_sections(study: Study, tables: Tables, pictures: Pictures) -> list[Section]:
    """Sections of the optional parts."""
    return [one.section(tables, pictures) for one in supplements(study)]


def _measures(tables: Tables, pictures: Pictures) -> Section:
    choice = tables["measure_choice"]
    columns = (
        Column("configuration", "Configuration"),
        Column("im", "Recommended"),
        Column("beta_amplitude", "β", 3),
        Column("auc", "AUC", 3),
        Column("chosen_share", "Best in share of bootstrap samples", 2),
        Column("words", "Reasons"),
    )
    best = choice[choice["recommended"]]
    return Section(
        "measures",
        "Which intensity measure",
        [
            "Measures compared by how well they foretell the first overturning amplitude of each "
            "motion, over all floors. Curves in measures of the ground motion stand as NRML for "
            "OpenQuake and as SimCenter tables in the folder exports; floors are not in them."
        ],
        [table_html(best, columns, "Recommended measure of each configuration, with reasons.")],
    )


def _shaker(tables: Tables, pictures: Pictures) -> Section:
    limits, tests = tables["shaker"], tables["tests"]
    columns = (
        Column("motion", "Motion"),
        Column("travel_cm_per_g", "Peak to peak [cm/g]", 2),
        Column("excursion_cm_per_g", "From the start [cm/g]", 2),
        Column("limit_g", "Fits up to [g]", 3),
        Column("limited_by", "Limited by"),
    )
    limited = tests[tests["reading"] == LIMITED]
    ended = limited[limited["censored"] == "right"]
    free = tests[(tests["reading"] == READING) & (tests["censored"] == "right")]
    new = ended[~ended["test"].isin(free["test"])]
    names = "; ".join(f"{row['test']}: {row['remark']}" for row in new.to_dict("records"))
    words = (
        f"With the shaker’s limits {len(new)} of {len(limited)} tests end before the object overturns: "
        f"{names}."
        if len(new)
        else "The shaker’s limits end no test before the object overturns."
    )
    return Section(
        "shaker",
        "What the shaking table could do",
        [
            words,
            "The reading “step protocol shaker” carries this through the pedestal’s statistics; the "
            "other readings are free of it, since where the table starts is an assumption.",
        ],
        [
            pictures["shaker_limits"],
            table_html(limits, columns, "What each motion asks of the shaker per g of its peak."),
        ],
    )


def _sensitivity(tables: Tables, pictures: Pictures) -> Section:
    table = tables["building_sensitivity/margins"]
    rows = table[table["reading"] == READING]
    order = rows[(rows["axis"] == "first_period_s") & (rows["statement"] == "order")]
    holds = [f"{value:g} s" for value in order.loc[order["margin"] > 0.02, "value"]]
    words = (
        f"By the step protocol the thesis’s order of the floors, ground highest and 3rd lowest, appears "
        f"by more than 2 % at the first periods {', '.join(holds)} of {len(order)} tried."
        if holds
        else "By the step protocol the thesis’s order of the floors, ground highest and 3rd lowest, "
        "appears at none of the first periods tried by more than 2 %."
    )
    doubtful = sorted(set(rows.loc[~rows["credible"], "label"]))
    share = f"{len(doubtful)} of {rows['label'].nunique()}"
    varied = rows[rows["axis"] != "reference"]
    margins = varied.groupby(["axis", "statement"], sort=False)["margin"].agg(["min", "max"])
    # adding zero turns a negative zero into a plain one
    shown = ((100 * margins).round(1) + 0.0).reset_index()
    shown["axis"] = shown["axis"].map(AXIS_NAMES)
    columns = (
        Column("axis", "Assumption"),
        Column("statement", "Statement"),
        Column("min", "Least margin [%]", 1),
        Column("max", "Largest margin [%]", 1),
    )
    return Section(
        "sensitivity",
        "The building as an assumption",
        [
            words,
            f"{share} buildings are shaken beyond what their model is to be believed for.",
        ],
        [
            *(pictures[name] for name in pictures if name.startswith("sensitivity_")),
            table_html(shown, columns, "Range of the margins of each statement."),
        ],
    )
