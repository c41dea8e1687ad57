"""Overturning amplitudes: of every test, and which amplitudes overturn."""

from functools import partial

import pandas as pd

from rockfrag.files import file_name
from rockfrag.report.figures.ida import MOST_ROWS, outcome_map
from rockfrag.report.findings import amplitudes_found, resurrections_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, opened
from rockfrag.report.wording import amplitude, of_all


def _section(results: Results) -> Section:
    found = amplitudes_found(results.tests)
    resurrections = resurrections_found(results.table("resurrections"), results.table("tests"))
    tests = results.tests
    tests = tests[tests["repetition"] == tests["repetition"].min()]
    names = list(dict.fromkeys(tests["configuration"]))
    shown = _wide(tests)
    columns = [
        Column("earthquake", "Earthquake"),
        Column("floor", "Floor"),
        Column("motion", "Motion"),
    ]
    columns += [Column(name, f"{name} [g]", numeric=True) for name in names]
    return Section(
        "amplitudes",
        "Overturning amplitudes",
        f"{found.headline}.",
        [
            *opened(found),
            resurrections.said,
            "The motion is raised in steps from rest until the body overturns. “>” stands before the largest "
            "amplitude survived by a body that never overturned, “<” before the first step where it overturned "
            "there already. These bounds enter no mean.",
            "Bars show all amplitudes that overturn. Gaps are amplitudes survived although a weaker motion "
            "overturned the body.",
        ],
        [
            table_html(
                shown, columns, "Overturning amplitude of every test (step protocol).", "tests.csv"
            ),
            *_maps(results),
        ],
    )


def _wide(tests: pd.DataFrame) -> pd.DataFrame:
    """A row per motion and a column per configuration, amplitudes and bounds as text."""
    texts = tests.assign(text=[amplitude(test) for test in tests.to_dict("records")])
    keys = ["earthquake", "floor", "motion"]
    rows: dict[tuple[str, ...], dict[str, str]] = {}
    for row in texts.to_dict("records"):
        key = tuple(row[name] for name in keys)
        about = rows.setdefault(key, dict(zip(keys, key, strict=True)))
        about[row["configuration"]] = row["text"]
    return pd.DataFrame(list(rows.values())).fillna("–")


def _maps(results: Results) -> list[FigureSpec]:
    outcomes, resurrections = results.outcomes, results.table("resurrections")
    specs = []
    for name in results.objects:
        own = outcomes[outcomes["object"] == name]
        configurations = list(dict.fromkeys(own["configuration"]))
        ida_curves = resurrections[resurrections["configuration"].isin(configurations)]
        fallen = of_all(
            int(ida_curves["first_upper"].notna().sum()), len(ida_curves), "analysis", "analyses"
        )
        caption = f"{name}: amplitudes that overturn it, by motion."
        motions = ida_curves["motion"].nunique()
        if motions > MOST_ROWS:
            caption += f" Shown are the first {MOST_ROWS} of {motions} motions; the table has all."
        alt = f"Map of the amplitudes that overturn {name}; it overturns in {fallen}."
        draw = partial(outcome_map, own, configurations)
        specs.append(FigureSpec(f"outcomes_{file_name(name)}", alt, caption, draw))
    return specs


AMPLITUDES = Part(("tests", "resurrections"), _section)
