"""Studies of other people's things run from configuration to report, and the report fits them."""

from pathlib import Path

import pandas as pd
import pytest

from rockfrag.report.part import Results
from rockfrag.study.loading import load_any

from .checked_report import check_first_page, check_report
from .studies import Foreign, run

TEN = {f"record {number}": f"quake {number // 2}" for number in range(10)}
MARBLE = {"marble figure": (30.0, 120.0, 110.0), "plinth": (50.0, 60.0, 350.0)}

STUDIES = {
    "one marble figure, one record": Foreign(
        blocks={"marble figure": MARBLE["marble figure"]},
        configurations={"figure": ("marble figure", None)},
        records={"Irpinia": "Irpinia 1980"},
    ),
    "with and without a plinth on one upper floor": Foreign(
        blocks=MARBLE,
        configurations={
            "figure": ("marble figure", None),
            "figure on plinth": ("marble figure", "plinth"),
        },
        records=TEN,
        floors={"piano nobile": 2},
    ),
    "three cabinets on floors of their own": Foreign(
        blocks={
            "Schrank groß": (60.0, 190.0, 90.0),
            "Schrank klein": (50.0, 120.0, 60.0),
            "Vitrine": (40.0, 180.0, 70.0),
        },
        configurations={
            "Schrank groß": ("Schrank groß", None),
            "Schrank klein": ("Schrank klein", None),
            "Vitrine": ("Vitrine", None),
        },
        records={"a": "Erste", "b": "Zweite", "c": "Zweite"},
        floors={"Keller": 0, "Dachboden": 3},
    ),
    "pairs of which some never overturn": Foreign(
        blocks={**MARBLE, "urn": (45.0, 90.0, 80.0)},
        configurations={
            "figure": ("marble figure", None),
            "figure on plinth": ("marble figure", "plinth"),
            "urn": ("urn", None),
            "urn on plinth": ("urn", "plinth"),
        },
        records=dict(list(TEN.items())[:4]),
        content={"amplitudes": {"lowest_g": 0.1, "highest_g": 0.7, "step_percent": 20}},
    ),
    "two bodies under one earthquake": Foreign(
        blocks={"bust": (25.0, 60.0, 45.0), "column": (30.0, 180.0, 200.0)},
        configurations={"bust": ("bust", None), "column": ("column", None)},
        records={"north": "the one", "east": "the one"},
    ),
    "the thesis's bodies, but nobody asks for the thesis": Foreign(
        blocks={
            "T1": (12.4, 37.2, 2.172),
            "T2": (12.4, 49.6, 2.79),
            "T3": (12.4, 62.0, 3.456),
            "P": (18.4, 20.8, 2.3),
        },
        configurations={
            "T1": ("T1", None),
            "T2": ("T2", None),
            "T3": ("T3", None),
            "P&T1": ("T1", "P"),
        },
        records={"Friuli": "Friuli", "Gilroy": "Loma Prieta"},
        floors={"GF": 0, "F5": 3},
    ),
    "nothing overturns": Foreign(
        blocks=MARBLE,
        configurations={
            "figure": ("marble figure", None),
            "figure on plinth": ("marble figure", "plinth"),
        },
        records={"a": "one", "b": "two"},
        content={"amplitudes": {"lowest_g": 0.01, "highest_g": 0.05, "step_percent": 20}},
    ),
    "everything overturns at the first step": Foreign(
        blocks={"pivot": (2.0, 150.0, 1.5), "foot": (30.0, 10.0, 20.0)},
        configurations={"pivot": ("pivot", None), "pivot on foot": ("pivot", "foot")},
        records={"a": "one", "b": "two"},
        content={"amplitudes": {"lowest_g": 0.8, "highest_g": 1.5, "step_percent": 20}},
    ),
    "one amplitude": Foreign(
        blocks={"marble figure": MARBLE["marble figure"]},
        configurations={"figure": ("marble figure", None)},
        records={"a": "one", "b": "two"},
        content={"amplitudes": {"lowest_g": 0.5, "highest_g": 0.55, "step_percent": 20}},
    ),
    "a stack only": Foreign(
        blocks=MARBLE,
        configurations={"figure on plinth": ("marble figure", "plinth")},
        records={"a": "one", "b": "two", "c": "three"},
    ),
    "two pedestals under one figure": Foreign(
        blocks={**MARBLE, "low plinth": (60.0, 20.0, 180.0)},
        configurations={
            "figure": ("marble figure", None),
            "figure on plinth": ("marble figure", "plinth"),
            "figure on low plinth": ("marble figure", "low plinth"),
        },
        records={"a": "one", "b": "two", "c": "three"},
    ),
    "a figure on a base on a plinth": Foreign(
        blocks={**MARBLE, "base": (40.0, 20.0, 85.0)},
        configurations={
            "figure": ("marble figure", None),
            "figure on plinth": ("marble figure", "plinth"),
            "figure on base on plinth": ("marble figure", "base|plinth"),
        },
        records={"a": "one", "b": "two", "c": "three"},
    ),
    "a base between figure and plinth, and nothing else": Foreign(
        blocks={**MARBLE, "base": (40.0, 20.0, 85.0)},
        configurations={
            "on plinth": ("marble figure", "plinth"),
            "on base": ("marble figure", "base|plinth", "on plinth"),
        },
        records={"a": "one", "b": "two", "c": "three"},
    ),
    "arrangements compared with each other": Foreign(
        blocks={**MARBLE, "base": (40.0, 20.0, 85.0)},
        configurations={
            "alone": ("marble figure", None),
            "on plinth": ("marble figure", "plinth"),
            "on base": ("marble figure", "base|plinth", "on plinth"),
        },
        records={"a": "one", "b": "two", "c": "three"},
    ),
    "a column that may slide, and nothing else": Foreign(
        blocks={**MARBLE, "base": (40.0, 20.0, 85.0)},
        configurations={"figure on base on plinth": ("marble figure", "base|plinth")},
        records={"a": "one", "b": "two"},
        content={"friction": {"ground": 0.7, "interface": 0.5}},
    ),
    "names that are hard to print": Foreign(
        blocks={
            "Büste „Ä“, $x_1$": (30.0, 90.0, 60.0),
            "<b>&amp; \\alpha^2": (28.0, 110.0, 70.0),
            "a very long name of a figure of a saint with a book in the left niche": (
                (26.0, 100.0, 60.0)
            ),
            "Sockel 50 %": (50.0, 40.0, 200.0),
        },
        configurations={
            "Büste „Ä“, $x_1$": ("Büste „Ä“, $x_1$", None),
            "Büste $ auf Sockel $": ("Büste „Ä“, $x_1$", "Sockel 50 %"),
            "<b>&amp; \\alpha^2": ("<b>&amp; \\alpha^2", None),
            "a very long name of a figure of a saint with a book in the left niche": (
                "a very long name of a figure of a saint with a book in the left niche",
                None,
            ),
        },
        records={"Motion <i>1</i>": "$E$ & Söhne", "2": "2"},
        floors={"1. Stock <hinten>": 1, "Dach $": 3},
    ),
}


@pytest.mark.parametrize("name", STUDIES)
def test_the_study_runs_and_its_report_fits_it(name: str, tmp_path: Path):
    study = STUDIES[name]
    results = run(study, tmp_path)
    page = check_report(results, study.names)
    check_first_page(Results(load_any(tmp_path / "study.yaml"), results))
    words = " ".join(page.words)
    tests = pd.read_parquet(results / "tests.parquet")
    tests = tests[tests["definition"] == "step_protocol"]
    assert len(tests) == len(study.configurations) * len(study.records) * len(study.floors or [1])
    # what is not known is shown as a bound wherever tests are shown
    bounds = tests[tests["amplitude_g"].isna()]
    shown = [cell for table in page.tables for row in table for cell in row]
    assert sum(cell.startswith((">", "<")) for cell in shown) >= len(bounds)
    assert ("no interval" in words) or ("[" in words) or "not known" in words or not _pairs(study)
    for object_name in study.blocks:
        used = any(object_name in pair for pair in study.configurations.values())
        assert not used or any(object_name in word for word in page.words)


def _pairs(study: Foreign) -> bool:
    sides = {(name, pedestal is None) for name, pedestal, *_ in study.configurations.values()}
    return any((name, True) in sides and (name, False) in sides for name, _ in sides)
