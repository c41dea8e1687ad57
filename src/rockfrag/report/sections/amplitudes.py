"""Overturning amplitudes: of every test, and which amplitudes overturn."""

from functools import partial

import pandas as pd

from rockfrag.files import file_name
from rockfrag.report.figures.sweep import MOST_ROWS, verdict_map
from rockfrag.report.findings import amplitudes_found, windows_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, opened
from rockfrag.report.wording import amplitude, of_all


def _section(results: Results) -> Section:
    found = amplitudes_found(results.tests)
    windows = windows_found(results.table("survival_windows"), results.table("tests"))
    tests = results.tests
    tests = tests[tests["repetition"] == tests["repetition"].min()]
    names = list(dict.fromkeys(tests["configuration"]))
    shown = _wide(tests)
    columns = [Column("event", "Earthquake"), Column("floor", "Floor"), Column("motion", "Motion")]
    columns += [Column(name, f"{name} [g]", numeric=True) for name in names]
    return Section(
        "amplitudes",
        "Overturning amplitudes",
        f"{found.headline}.",
        [
            *opened(found),
            windows.said,
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
    keys = ["event", "floor", "motion"]
    rows: dict[tuple[str, ...], dict[str, str]] = {}
    for row in texts.to_dict("records"):
        key = tuple(row[name] for name in keys)
        about = rows.setdefault(key, dict(zip(keys, key, strict=True)))
        about[row["configuration"]] = row["text"]
    return pd.DataFrame(list(rows.values())).fillna("–")


def _maps(results: Results) -> list[FigureSpec]:
    verdicts, windows = results.verdicts, results.table("survival_windows")
    specs = []
    for name in results.objects:
        own = verdicts[verdicts["object"] == name]
        configurations = list(dict.fromkeys(own["configuration"]))
        sweeps = windows[windows["configuration"].isin(configurations)]
        fallen = of_all(
            int(sweeps["first_upper"].notna().sum()), len(sweeps), "analysis", "analyses"
        )
        caption = f"{name}: amplitudes that overturn it, by motion."
        motions = sweeps["motion"].nunique()
        if motions > MOST_ROWS:
            caption += f" Shown are the first {MOST_ROWS} of {motions} motions; the table has all."
        alt = f"Map of the amplitudes that overturn {name}; it overturns in {fallen}."
        draw = partial(verdict_map, own, configurations)
        specs.append(FigureSpec(f"verdicts_{file_name(name)}", alt, caption, draw))
    return specs


AMPLITUDES = Part(("tests", "survival_windows"), _section)
