"""Overturning amplitudes: of every test, and which amplitudes overturn."""

from functools import partial

import pandas as pd

from rockfrag.files import file_name
from rockfrag.report.figures.sweep import MOST_ROWS, verdict_map
from rockfrag.report.findings import amplitudes_found, windows_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section
from rockfrag.report.wording import amplitude, of_all


def _section(results: Results) -> Section:
    message = amplitudes_found(results.tests).said
    windows = windows_found(results.table("survival_windows"), results.table("tests"))
    tests = results.tests
    tests = tests[tests["repetition"] == tests["repetition"].min()]
    names = list(dict.fromkeys(tests["configuration"]))
    shown = _wide(tests)
    columns = [Column("event", "Event"), Column("floor", "Floor"), Column("motion", "Motion")]
    columns += [Column(name, f"{name} [g]", numeric=True) for name in names]
    return Section(
        "amplitudes",
        "Overturning amplitudes",
        message,
        [
            windows.said,
            "The amplitude is the peak of the motion that shakes the body: raised in steps from rest, "
            "and read just before the first overturning. Where a body never overturned, “>” stands "
            "before the largest amplitude that it survived; “<” stands where it overturned at the "
            "first step. Such bounds are in no mean.",
            "Bars show every amplitude that overturns; gaps are amplitudes survived although a weaker "
            "motion overturned the body.",
        ],
        [
            table_html(
                shown, columns, "Overturning amplitude of every test, step protocol.", "tests.csv"
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
        fallen = of_all(int(sweeps["first_upper"].notna().sum()), len(sweeps), "sweep")
        caption = f"{name}: every amplitude that overturns it, per motion."
        motions = sweeps["motion"].nunique()
        if motions > MOST_ROWS:
            caption += f" The first {MOST_ROWS} of {motions} motions."
        alt = f"Map of the amplitudes that overturn {name}; it overturns in {fallen}."
        draw = partial(verdict_map, own, configurations)
        specs.append(FigureSpec(f"verdicts_{file_name(name)}", alt, caption, draw))
    return specs


AMPLITUDES = Part(("tests", "survival_windows"), _section)
