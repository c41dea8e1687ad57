"""The report of a campaign on a shake table: how often the simulation is right, and where it is not."""

import math
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import pandas as pd
from markupsafe import Markup

from rockfrag.campaign.comparison import REPEATS
from rockfrag.campaign.trials import preferred_edges
from rockfrag.campaign.validation import FEWEST_VOTERS
from rockfrag.fragility.observations import name_and_unit
from rockfrag.fragility.vector_tables import VectorTables
from rockfrag.report.figures import campaign as figures
from rockfrag.report.page import Column, table_html, text_table
from rockfrag.report.part import (
    Answer,
    FigureSpec,
    Finding,
    Section,
    figure_of,
    finding_of,
    section_of,
)
from rockfrag.report.provenance import provenance
from rockfrag.report.sections.curves import two_measures_section
from rockfrag.report.study_report import write_page
from rockfrag.report.wording import Macros, estimate, number, one_line, probability, said
from rockfrag.stages.campaign import IN_PLANE, OURS, TABLES, VOTES
from rockfrag.study.campaign import CampaignStudy


def write_campaign_report(study: CampaignStudy, folder: Path) -> None:
    """Draw the figures of a campaign and write its page, ``report.html``, beside the tables of its stages."""
    tables = {name: pd.read_parquet(folder / f"{name}.parquet") for name in TABLES}
    sections = [
        _agreement(study, tables),
        _fragility(study, tables),
        *_two_measures(study, tables),
        _tests(study, tables),
        _object(study, tables),
        _conditioning(study, tables),
    ]
    tests = tables["tests"]
    write_page(
        folder,
        _answer(study, tables, sections),
        sections,
        title=study.title,
        lead=one_line(says.lead(tests, _motion(study))),
        provenance=provenance(study, {"Tests": study.tests.name}),
        basis="measured",
    )


Row = Mapping[Any, Any]


def _percent(row: Row) -> str:
    return estimate(100 * row["right"], 100 * row["lower"], 100 * row["upper"], 1) + " %"


def _better(row: Row) -> str:
    """By how many percentage points the simulation is better, with limits."""
    middle, low, high = (
        number(100 * row[name], 1) for name in ("better", "better_lower", "better_upper")
    )
    return f"{middle} [{low}, {high}]"


LEVEL = 0.05
"""A difference between programs is stated below this adjusted p value [-]."""


def _p(value: float) -> str:
    text = probability(value)
    return text if text.startswith("<") else f"= {text}"


says = Macros(
    "rockfrag.report",
    "campaign_page.j2",
    {"better": _better, "estimate": estimate, "p": _p, "percent": _percent}
    | {"FEWEST_VOTERS": FEWEST_VOTERS, "LEVEL": LEVEL},
)


def _who(name: str) -> str:
    """Who predicted the outcomes, in words: thresholds by their measure, codes by their name."""
    if name in (OURS, IN_PLANE):
        return "simulation" + name.removeprefix(OURS)
    for start in ("threshold on ", "probit on "):
        if name.startswith(start):
            measures = name.removeprefix(start).split(" and ")
            return start + " and ".join(name_and_unit(measure)[0] for measure in measures)
    return name


def _answer(
    study: CampaignStudy, tables: dict[str, pd.DataFrame], sections: Sequence[Section]
) -> Answer:
    """What stands first: how often the simulation is right, beside whom, and in which fragility."""
    found, tests = _findings(tables), tables["tests"]
    near = int(tests["near_critical"].sum())
    specs = [part for section in sections for part in section.parts if isinstance(part, FigureSpec)]
    return Answer(
        asked="How often does the simulation predict what happened on the shaking table?",
        sentences=found[:3],
        figure=next((spec for spec in specs if spec.name == "tests"), specs[0]),
        rests_on=said(says.rests_on(tests, _motion(study))),
        could_change=[
            *said(says.near_critical(near, len(tests))),
            *(finding.headline + "." for finding in found[3:]),
        ],
    )


def _motion(study: CampaignStudy) -> str:
    """Say whether the motions were measured on the table, or follow from what it was told."""
    return "commanded of" if study.pulse_cycles else "measured on"


def _findings(tables: dict[str, pd.DataFrame]) -> list[Finding]:
    ours, *others = tables["agreement"].to_dict("records")
    rivals = [row for row in others if row["who"] != IN_PLANE]
    found = [
        finding_of(says.predicted(ours)),
        *(_beside_plane(ours, row) for row in others if row["who"] == IN_PLANE),
        *_against_rivals(rivals),
        *_fragility_found(tables["fragility"]),
    ]
    tests = tables["tests"]
    near, wrong = tests["near_critical"], ~tests["right"]
    if wrong.any():
        counts = (int((wrong & near).sum()), int(wrong.sum()), int(near.sum()), len(tests))
        found.append(finding_of(says.wrong(*counts)))
    return found


def _beside_plane(ours: Row, plane: Row) -> Finding:
    """Whether three dimensions predict better than one plane."""
    return finding_of(says.beside_plane(ours, plane))


def _against_rivals(others: Sequence[Row]) -> list[Finding]:
    # what is read off the tests themselves is the ceiling of all models, not one of them
    rivals = [row for row in others if row["who"] != REPEATS]
    if not rivals:
        return []
    best = max(rivals, key=lambda row: float(row["right"]))
    return [finding_of(says.beside_rivals(best, _who(best["who"]), len(rivals)))]


def _two_measures(study: CampaignStudy, tables: dict[str, pd.DataFrame]) -> list[Section]:
    found = VectorTables(tables["two_measures"], tables["contours"], tables["cells"])
    section = two_measures_section(found, study.confidence)
    return [section] if section else []


def _fragility_found(fragility: pd.DataFrame) -> list[Finding]:
    rows = fragility.dropna(subset=["theta_ratio"])
    if rows.empty:
        return []
    measure = _ordering(fragility)
    found = {
        row["who"]: _ratios(row) for row in rows[rows["measure"] == measure].to_dict("records")
    }
    return [finding_of(says.fragility(name_and_unit(measure)[0], found[OURS], found[VOTES]))]


def _ordering(fragility: pd.DataFrame) -> str:
    """Return the measure in which the measured curve has the least dispersion."""
    measured = fragility[fragility["who"] == "measured"]
    return str(measured.set_index("measure")["beta"].fillna(math.inf).idxmin())


def _ratios(row: Row) -> tuple[str, str]:
    """Simulated over measured median and dispersion, with limits."""
    theta, beta = (
        estimate(row[key], row[f"{key}_lower"], row[f"{key}_upper"], 2)
        for key in ("theta_ratio", "beta_ratio")
    )
    return theta, beta


def _agreement(study: CampaignStudy, tables: dict[str, pd.DataFrame]) -> Section:
    agreement = tables["agreement"]
    shown = agreement.assign(
        who=[_who(name) for name in agreement["who"]],
        right_text=[_percent(row) for row in agreement.to_dict("records")],
        better_text=[
            _better(row) if pd.notna(row["better"]) else "–" for row in agreement.to_dict("records")
        ],
        p_text=[probability(p) for p in agreement["p"]],
    )
    columns = (
        Column("who", "Predicted by"),
        Column("tests", "Tests", 0),
        Column("right_text", "Right", numeric=True),
        Column("false_alarms", "False alarms", 1),
        Column("missed", "Missed", 1),
        Column("better_text", "Simulation better by [percentage points]", numeric=True),
        Column("p_text", "p", numeric=True),
        Column("judged", "Judged"),
    )
    best = max(agreement.to_dict("records"), key=lambda row: float(row["right"]))
    text = says.agreement_figure(best, _who(best["who"]), _level(study))
    drawn = agreement.assign(who=shown["who"])
    figure = figure_of(text, "agreement", lambda: figures.agreement_figure(drawn))
    table = table_html(shown, columns, "Outcomes predicted, and the difference on the same tests.")
    text = says.agreement(_findings(tables)[0])
    return section_of(text, "agreement", [figure, table, *_rocking(tables["rocking"])])


def _level(study: CampaignStudy) -> str:
    return f"{100 * study.confidence:g} %"


def _rocking(rocking: pd.DataFrame) -> list[Markup]:
    """Whether the object rocked at all, where the laboratory noted it."""
    if rocking.empty:
        return []
    shown = rocking.assign(right_text=[_percent(row) for row in rocking.to_dict("records")])
    columns = (
        Column("right_text", "Right", numeric=True),
        Column("false_alarms", "Rocked in the simulation only", 1),
        Column("missed", "Rocked in the laboratory only", 1),
    )
    return [table_html(shown, columns, "Whether the object rocked at all, simulated and noted.")]


_OUTCOMES = {
    "measured": "measured",
    OURS: "simulated, majority of votes",
    VOTES: "simulated, votes",
}


def _fragility(study: CampaignStudy, tables: dict[str, pd.DataFrame]) -> Section:
    fragility, tests = tables["fragility"], tables["tests"]
    digits = {"theta": 3, "beta": 2, "theta_ratio": 2, "beta_ratio": 2}
    rows = [
        {
            "measure": "{} [{}]".format(*name_and_unit(row["measure"])),
            "who": _OUTCOMES[row["who"]],
            **{
                key: estimate(row[key], row[f"{key}_lower"], row[f"{key}_upper"], decimals)
                for key, decimals in digits.items()
            },
        }
        for row in fragility.to_dict("records")
    ]
    columns = (
        Column("measure", "Measure"),
        Column("who", "Outcomes"),
        Column("theta", "Median θ", numeric=True),
        Column("beta", "Dispersion β", numeric=True),
        Column("theta_ratio", "θ over measured", numeric=True),
        Column("beta_ratio", "β over measured", numeric=True),
    )
    measure = _ordering(fragility)
    name, unit = name_and_unit(measure)
    found = _fragility_found(fragility)
    own = fragility[fragility["measure"] == measure]
    figure = figure_of(
        says.beside_figure(found, name),
        "fragility_beside",
        lambda: figures.beside_figure(tests, own, measure, f"{name} [{unit}]"),
    )
    caption = "Curves of measured and of simulated outcomes."
    table = table_html(pd.DataFrame(rows), columns, caption)
    return section_of(says.curves(found, _level(study)), "fragility", [figure, table])


def _tests(study: CampaignStudy, tables: dict[str, pd.DataFrame]) -> Section:
    tests, regions = tables["tests"], tables["regions"]
    names = [
        region.removesuffix("_from") for region in map(str, regions) if region.endswith("_from")
    ]
    labels = {name: "{} [{}]".format(*name_and_unit(name)) for name in names}
    shown = regions[regions["tests"] > 0].copy()
    for name in names:
        shown[name] = [
            f"{low:.3g} to {high:.3g}"
            for low, high in regions.loc[shown.index, [f"{name}_from", f"{name}_to"]].to_numpy()
        ]
    shown["right"] = 100 * shown["right"]
    columns = (
        *(Column(name, label, numeric=True) for name, label in labels.items()),
        Column("tests", "Tests", 0),
        Column("overturned", "Overturned", 0),
        Column("simulated", "Simulated", 0),
        Column("right", "Right [%]", 0),
    )
    wrong = tests[~tests["right"]].assign(votes=lambda t: 100 * t["votes_to_overturn"])
    wrong_columns = (
        Column("test", "Test"),
        Column("group", "Input motion"),
        *(
            Column(name, "{} [{}]".format(*name_and_unit(name)), 3)
            for name in study.measures or names
        ),
        Column("overturned", "Overturned"),
        Column("votes", "Votes to overturn [%]", 0),
        Column("near_critical", "Near-critical"),
    )
    parts: list[Markup | FigureSpec] = []
    if len(names) == 2:
        x, y = names
        draw = partial(figures.tests_figure, tests, x, y, (labels[x], labels[y]))
        parts.append(figure_of(says.tests_figure(tests), "tests", draw))
    parts += [
        table_html(shown, columns, "Tests by thirds of two measures."),
        table_html(wrong, wrong_columns, "Tests predicted wrong."),
    ]
    return section_of(says.tests(tests), "tests", parts)


def _object(study: CampaignStudy, tables: dict[str, pd.DataFrame]) -> Section:
    trials, contact, footprint = tables["trials"], tables["contact"], tables["footprint"]
    likely = trials[trials["plausible"]]
    titles = {
        "direction_deg": "Direction of shaking [°]",
        "contact_tolerance_mm": "Contact tolerance [mm]",
        "edge_retreat_mm": "Retreat of the edges [mm]",
        "restitution": "Restitution [-]",
        "friction": "Coefficient of friction [-]",
        "left_m": "Left edge to the centre of gravity [m]",
        "right_m": "Right edge to the centre of gravity [m]",
        "alpha_deg": "Smaller critical angle [°]",
    }
    tried, plausible = (
        {name: part[name] for name in titles if name in trials} for part in (trials, likely)
    )
    parts: list[Markup | FigureSpec] = []
    if not footprint.empty:
        text = says.footprint_figure(100 * (likely["left_m"] + likely["right_m"]))
        parts.append(
            figure_of(text, "footprint", lambda: figures.footprint_figure(footprint, trials))
        )
    parts.append(
        text_table(
            {
                "Property": [titles[name] for name in tried],
                "Range tried": [f"{x.min():.3g} to {x.max():.3g}" for x in tried.values()],
                "Plausible range": [f"{x.min():.3g} to {x.max():.3g}" for x in plausible.values()],
                "Median of the plausible": [f"{x.median():.3g}" for x in plausible.values()],
            },
            "Unmeasured properties: ranges tried, and ranges that agree with the tests.",
            ["Range tried", "Plausible range", "Median of the plausible"],
        )
    )
    contact_columns = (
        Column("contact_tolerance_mm", "Contact tolerance [mm]", 2),
        Column("worst_direction_deg", "Worst direction [°]", 0),
        Column("alpha_deg", "Critical angle [°]", 1),
        Column("alpha_lower_deg", "5 % of scans", 1),
        Column("alpha_upper_deg", "95 % of scans", 1),
        Column("trials", "Trials near it", 0),
        Column("width_cm", "Their base [cm]", 1),
        Column("overturned_percent", "Overturn in [% of tests]", 0),
        Column("right_percent", "Right, in sample [%]", 0),
    )
    parts.append(
        table_html(
            contact.assign(
                width_cm=100 * contact["width_m"],
                overturned_percent=100 * contact["overturned"],
                right_percent=100 * contact["right"],
            ),
            contact_columns,
            "Smallest critical angle by contact tolerance; the object cannot stand where it is negative.",
        )
    )
    # ranges that end where the tests would have them go on
    edges = [
        f"{titles[name].split(' [')[0].lower()} ({edge})"
        for name, edge in preferred_edges(trials, likely.index, study.unknowns).items()
    ]
    blocks = len(study.object.get("pedestal", ()))
    text = says.how_it_stood(blocks, len(likely), len(trials), edges)
    return section_of(text, "object", parts)


def _conditioning(study: CampaignStudy, tables: dict[str, pd.DataFrame]) -> Section:
    rows = tables["conditioning"]
    shown = rows.assign(right_text=[_percent(row) for row in rows.to_dict("records")])
    columns = (
        Column("conditioning", "Conditioning"),
        Column("trials", "Trials", 0),
        Column("right_text", "Right", numeric=True),
        Column("false_alarms", "False alarms", 1),
        Column("missed", "Missed", 1),
    )
    steps = [" ".join(str(value) for value in step.values()) for step in study.conditioning]
    table = table_html(shown, columns, "Outcomes predicted right, by conditioning.")
    return section_of(says.conditioning(steps), "conditioning", [table])
