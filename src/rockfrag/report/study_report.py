"""What stands in the report of a study, section by section."""

from collections.abc import Mapping

import pandas as pd
from markupsafe import Markup

from rockfrag.report.estimate_columns import EFFECT, with_limits
from rockfrag.report.findings import Finding, all_findings
from rockfrag.report.page import Column, Picture, Section, comparison_html, render, table_html
from rockfrag.report.supplements import supplement_sections
from rockfrag.shaketable.readings import READING
from rockfrag.study.study import Study
from rockfrag.thesis.ledger_html import ledger_html

COMPARISONS = ("table_3_1", "table_3_3", "table_4_1")

_CAPTIONS = {
    "table_3_1": "Table 3.1: critical angle, radius, frequency parameter and slenderness of the "
    "blocks.",
    "table_3_3": "Table 3.3: peaks of the ground motions, integrated exactly for an acceleration "
    "that is linear between samples.",
    "table_4_1": "Table 4.1: least acceleration that starts rocking, of both bodies as one "
    "(pattern 3) and of the object alone (pattern 4).",
}


def write_page(
    study: Study,
    tables: Mapping[str, pd.DataFrame],
    pictures: Mapping[str, Picture],
    provenance: Mapping[str, str],
) -> str:
    """Return the whole report as HTML.

    Parameters
    ----------
    study
        The study.
    tables
        Result tables by name, as in ``results/<study>/``: ``tests``, ``measures``, ``fragility``,
        ``survival_windows``, ``validity``, ``table_3_1``, ``table_3_3``, ``table_4_1`` and, where the study has
        pairs, ``pedestal/effects``, ``pedestal/whole``, ``claims`` and ``contradictions``; further
        those of the optional parts (:mod:`rockfrag.report.supplements`).
    pictures
        Figures by name, in the order in which they are to appear within a section.
    provenance
        What the reader needs to get the same results again.
    """
    sections = [
        _bodies(tables, pictures),
        _motions(tables, pictures),
        _amplitudes(tables, pictures),
        _fragility(study, tables, pictures),
    ]
    if "pedestal/effects" in tables:
        sections.append(_pedestal(tables, pictures))
    sections += supplement_sections(study, tables, pictures)
    if "claims" in tables:
        sections.append(_claims(tables["claims"], tables["contradictions"]))
    return render(
        title=study.title,
        lead=_lead(study),
        findings=_findings(tables),
        sections=sections,
        provenance=provenance,
    )


def _lead(study: Study) -> str:
    motions = len(study.catalogue)
    events = study.catalogue["event"].nunique()
    return (
        f"Rocking and overturning of {len(study.configurations)} configurations under {motions} "
        f"records of {events} earthquakes"
        + (", on the ground and on floors of a building" if study.building else "")
        + ", simulated event by event."
    )


def _findings(tables: Mapping[str, pd.DataFrame]) -> list[Finding]:
    return all_findings(
        tables["tests"],
        tables.get("pedestal/effects"),
        tables["survival_windows"],
        tables["validity"],
        [tables[name] for name in COMPARISONS if name in tables],
        tables.get("claims"),
    )


def _chosen(pictures: Mapping[str, Picture], *starts: str) -> list[Picture]:
    return [picture for name, picture in pictures.items() if name.startswith(starts)]


def _bodies(tables: Mapping[str, pd.DataFrame], pictures: Mapping[str, Picture]) -> Section:
    return Section(
        "bodies",
        "Bodies and the start of rocking",
        [
            "Rigid blocks with two edges to rock on, no sliding and no bouncing; momentum is "
            "conserved in impacts unless the study says otherwise."
        ],
        [
            *(
                comparison_html(tables[name], _CAPTIONS[name])
                for name in COMPARISONS[::2]
                if name in tables
            ),
            *_chosen(pictures, "bodies"),
        ],
    )


def _motions(tables: Mapping[str, pd.DataFrame], pictures: Mapping[str, Picture]) -> Section:
    columns = (
        Column("name", "Motion"),
        Column("pga_g", "PGA [g]", 3),
        Column("pgv_cm_s", "PGV [cm/s]", 1),
        Column("pgd_cm", "PGD [cm]", 2),
        Column("pgv_over_pga_s", "PGV/PGA [s]", 3),
        Column("mean_period_s", "Mean period [s]", 2),
        Column("d5_95_s", "D5-95 [s]", 1),
        Column("arias_m_s", "Arias [m/s]", 2),
    )
    return Section(
        "motions",
        "Motions",
        [
            "GF is the ground motion itself; F3 and F5 are floors of an assumed building, which "
            "the thesis does not describe. What is said of floors is said of that building."
        ],
        [
            *(comparison_html(tables[n], _CAPTIONS[n]) for n in ("table_3_3",) if n in tables),
            *_chosen(pictures, "figure_3_4", "building", "floor"),
            table_html(
                tables["measures"], columns, "Intensity of every motion, before it is scaled."
            ),
        ],
    )


def _amplitudes(tables: Mapping[str, pd.DataFrame], pictures: Mapping[str, Picture]) -> Section:
    tests = tables["tests"]
    rows = tests[(tests["reading"] == READING) & (tests["repetition"] == 1)]
    wide = rows.assign(
        specimen=rows["pedestal"].map({"NP": "", "P": "P&"}).astype(str) + rows["object"]
    )
    specimens = list(dict.fromkeys(wide["specimen"]))
    table = (
        wide.pivot_table(
            index=["event", "floor", "motion"],
            columns="specimen",
            values="amplitude_g",
            sort=False,
            dropna=False,
        )
        .dropna(how="all")
        .reset_index()
    )
    columns = [Column("event", "Event"), Column("floor", "Floor")]
    columns += [Column(one, f"{one} [g]", 3) for one in specimens]
    return Section(
        "amplitudes",
        "Overturning amplitudes",
        [
            "Simulated counterparts of the thesis’s figures 4.1 to 4.7. The amplitude is the peak "
            "of the motion that shakes the body: raised in steps from rest, and read just before "
            "the first overturning. Bars below show every amplitude that overturns; gaps are "
            "amplitudes that are survived although a weaker motion overturned the body."
        ],
        [
            table_html(table, columns, "Overturning amplitude of every test, step protocol."),
            *_chosen(pictures, "figure_4", "verdicts"),
        ],
    )


def _fragility(
    study: Study, tables: Mapping[str, pd.DataFrame], pictures: Mapping[str, Picture]
) -> Section:
    level = f"{100 * study.fragility.confidence:g} %"
    curves = tables["fragility"]
    order = {one.name: i for i, one in enumerate(study.configurations)}
    curves = curves.sort_values("configuration", key=lambda names: names.map(order), kind="stable")
    for name in ("theta", "beta"):
        curves[f"{name}_text"] = [
            f"{value:.3g} [{low:.3g}, {high:.3g}]"
            for value, low, high in curves[[name, f"{name}_lower", f"{name}_upper"]].itertuples(
                index=False
            )
        ]
    notes = sorted({note for note in curves["warnings"] if note})
    return Section(
        "fragility",
        "Fragility",
        [
            "Lognormal curves: the probability to overturn is Φ(ln(IM/θ)/β). Mean probability "
            "counts every amplitude, survival windows included; the other two readings take one "
            f"amplitude a motion. Intervals of {level} resample earthquakes, not amplitudes.",
            *notes,
        ],
        [
            *_chosen(pictures, "fragility"),
            *_curve_tables(curves, level),
        ],
    )


def _curve_tables(curves: pd.DataFrame, level: str) -> list[Markup]:
    """One narrow table per intensity measure and reading, so that telephones show it whole."""
    tables = []
    for (measure, unit, reading), rows in curves.groupby(["im", "unit", "estimator"], sort=False):
        columns = (
            Column("configuration", "Configuration"),
            Column("theta_text", f"Median θ [{unit}]"),
            Column("beta_text", "Dispersion β"),
        )
        caption = f"{measure}, {str(reading).replace('_', ' ')}: with {level} intervals."
        tables.append(table_html(rows, columns, caption))
    return tables


def _pedestal(tables: Mapping[str, pd.DataFrame], pictures: Mapping[str, Picture]) -> Section:
    effects = tables["pedestal/effects"]
    whole = tables["pedestal/whole"]
    whole = whole.assign(reading=whole["reading"].str.replace("_", " "))
    shown = (
        *EFFECT,
        Column("equivalent", "Within ±10 %"),
        Column("detectable_ratio", "Detectable", 3),
    )
    methods = (
        Column("reading", "Reading"),
        Column("method", "Method"),
        *with_limits("estimate", "P/NP", "lower", "upper"),
        Column("p", "p", 3),
        Column("smallest_p", "Smallest possible p", 3),
        Column("remark", "Remark"),
    )
    return Section(
        "pedestal",
        "Effect of the pedestal",
        [
            "Ratio of the overturning amplitude with the pedestal (P) to that without (NP), paired "
            "by object and motion. Motions of one earthquake are not independent, so intervals rest "
            "on earthquakes. “Detectable” is the ratio that would be found with 80 % power. An interval "
            "without width means that all pairs have the same amplitude, to the steps tested."
        ],
        [
            *_chosen(pictures, "pedestal"),
            table_html(
                effects[effects["reading"] == READING],
                shown,
                "Effect by scope, step protocol, 95 % intervals.",
            ),
            table_html(whole, methods, "The whole by other methods and readings."),
        ],
    )


def _claims(claims: pd.DataFrame, contradictions: pd.DataFrame) -> Section:
    columns = (
        Column("statements", "Statements"),
        Column("what", "What"),
        Column("why", "Why"),
        Column("in_these_tests", "In these tests"),
    )
    return Section(
        "claims",
        "The thesis’s statements",
        [
            "Each statement with its test and verdict. A verdict on simulated tests says what the "
            "model does, not what the laboratory saw."
        ],
        [
            ledger_html(claims),
            table_html(contradictions, columns, "Where the thesis contradicts itself."),
        ],
    )
