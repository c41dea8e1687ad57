"""Random small studies, and what the results of one may not say.

Used by ``test_foreign_studies.py`` for a few studies, by ``tests/fuzz/inputs.py`` for hundreds.
"""

import json
import random
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import yaml

from rockfrag.base.errors import LONGEST_MESSAGE, InputError
from rockfrag.base.yaml_file import read_yaml
from rockfrag.report.part import Results
from rockfrag.stages.running import prepared

from ..case_tables import case_tables
from .checked_report import check_first_page, check_report
from .studies import Foreign, alone, run_stages, write

TABLES = case_tables(__file__)
PARTICULAR = ("sensitivity_analysis", "building_sensitivity")
"""Keys that ask for pairs, and for a building."""


def draw(rng: random.Random) -> Foreign:
    """Draw a study; most make sense, some ask for what cannot be."""
    names = rng.sample(TABLES["names"], rng.randint(1, 3))
    if rng.random() < 0.04:
        names[0] = "=1+1"
    blocks = {
        name: (rng.uniform(15, 60), rng.uniform(60, 200), rng.uniform(20, 400))
        for name in names
    }
    configurations = alone(*names)
    if rng.random() < 0.6:
        blocks["plinth"] = (
            rng.uniform(20, 90),
            rng.uniform(10, 100),
            rng.uniform(50, 900),
        )
        on = rng.sample(names, rng.randint(1, len(names)))
        configurations |= {f"{name} on plinth": (name, "plinth") for name in on}
        if rng.random() < 0.2:
            configurations = {f"{name} on plinth": (name, "plinth") for name in on}
        elif rng.random() < 0.3:
            blocks["step"] = (rng.uniform(60, 120), rng.uniform(10, 30), 400.0)
            configurations["three"] = (names[0], "plinth|step")
    count = rng.choice((1, 2, 2, 3, 5))
    records = {f"record {k}": rng.choice(TABLES["earthquakes"]) for k in range(count)}
    floors = {"roof": 4} if rng.random() < 0.03 else rng.choice(TABLES["floors"])
    keys = _keys(rng, names)
    if len(configurations) == len(names) or floors is None:
        keep = rng.random() < 0.1
        keys = {
            key: value for key, value in keys.items() if keep or key not in PARTICULAR
        }
    return Foreign(blocks, configurations, records, floors, keys)


def _keys(rng: random.Random, names: list[str]) -> dict[str, Any]:
    measures = rng.sample(TABLES["measures"], rng.randint(1, 3))
    measures += [rng.choice(TABLES["pairs"])] if rng.random() < 0.3 else []
    amplitudes = {
        "lowest_g": rng.choice((0.05, 0.1, 0.15)),
        "highest_g": rng.choice((0.2, 0.7, 1.5, 2.5)),
        "step_percent": rng.choice((15, 25, 40)),
    }
    chosen = {
        "amplitudes": amplitudes,
        "protocol": {"step_percent": rng.choice((40, 50, 10))},
        "fragility": {"measures": measures, "confidence": rng.choice((0.9, 0.68))},
        "motions": {"catalogue": "motions.csv"} | _some(rng, "motions"),
    }
    if rng.random() < 0.1:
        restitution = {"blocks": dict.fromkeys(names, rng.choice((0.9, 0.97, 1.1)))}
        chosen["bodies"] = {
            "specimens": "blocks.csv",
            "configurations": "configurations.csv",
        }
        chosen["bodies"]["restitution"] = restitution
    return chosen | _some(rng, "keys")


def _some(rng: random.Random, table: str) -> dict[str, Any]:
    """Keys of a table, each as often as it says, with one of its values."""
    each = TABLES[table].items()
    return {
        key: rng.choice(values) for key, (often, values) in each if rng.random() < often
    }


def fate(study: Foreign, folder: Path) -> tuple[int, list[str]]:
    """Run a study to its report; return 0 if it ran and 2 if it was refused, and what is wrong with it."""
    path = write(study, folder)
    (folder / "shaker.yaml").write_text(yaml.safe_dump(TABLES["shaker"]))
    try:
        loaded, _ = prepared(read_yaml(path), path)
    except InputError as error:
        return 2, _one_sentence(str(error))
    try:
        results = run_stages(path)
    except InputError as error:
        return 2, [*_one_sentence(str(error)), f"refused only while it ran: {error}"]
    wrong = _tables(results)
    try:
        check_report(results, study.names, plugin="compare_with" in study.content)
        check_first_page(Results(loaded, results))
    except AssertionError as error:
        wrong.append(str(error).splitlines()[0])
    return 0, wrong


def _one_sentence(said: str) -> list[str]:
    short = "\n" not in said and len(said) <= LONGEST_MESSAGE
    return [] if short else [f"no single sentence: {said}"]


def _tables(results: Path) -> list[str]:
    """Limits of any table that do not hold what they belong to, and falls without rocking."""
    wrong = [
        f"{path.name}, {said}"
        for path in sorted(results.rglob("*.parquet"))
        for said in wrong_limits(pd.read_parquet(path))
    ]
    shaken = pd.read_parquet(results / "as_recorded.parquet")
    fell = shaken["overturned"].fillna(False).astype(bool)
    if not shaken.loc[fell, "rocked"].all():
        wrong.append("as_recorded: a fall without rocking")
    if not shaken.loc[shaken["peak_rotation"] > 0, "rocked"].all():
        wrong.append("as_recorded: a rotation without rocking")
    tests = pd.read_parquet(results / "tests.parquet")
    ends = tests[["lower_g", "amplitude_g", "upper_g"]].to_numpy(float)
    known = np.isfinite(ends).all(axis=1)
    if not (np.diff(ends[known], axis=1) >= 0).all():
        wrong.append("tests: an amplitude outside its bracket")
    return wrong + _lost(results) + _falls_before_rocking(results)


def _lost(results: Path) -> list[str]:
    """Records of which nothing is in the results, and no reason why."""
    left_out = set(pd.read_parquet(results / "left_out.parquet")["motion"])
    scaling = pd.read_parquet(results / "scaling.parquet")
    about = pd.read_parquet(results / "motions" / "ground.parquet")["metadata"]
    used = {json.loads(words)["ground_motion"] for words in _floors(results)}
    wrong = [] if len(about) == len(used) else ["a ground motion shakes no floor"]
    if used & left_out:
        wrong.append("a motion is used and left out")
    if not (scaling["factor_lowest"] <= scaling["factor_highest"]).all():
        wrong.append("scaling: the lowest amplitude has the largest factor")
    return wrong


def _floors(results: Path) -> pd.Series:
    return pd.read_parquet(results / "motions" / "floors.parquet")["metadata"]


def _falls_before_rocking(results: Path) -> list[str]:
    """Medians of overturning in peak acceleration below where rocking starts, without friction."""
    curves = pd.read_parquet(results / "fragility_floors.parquet")
    if curves.empty or "state" not in curves:
        return []
    peak = curves[curves["im"].isin(["PGA", "PFA"])].dropna(subset=["theta"])
    table = peak.pivot_table(
        index=["configuration", "floor"], columns="state", values="theta"
    )
    if not {"rocks", "overturns"} <= set(table.columns):
        return []
    both = table.dropna(subset=["rocks", "overturns"])
    bad = both["overturns"] < both["rocks"] * (1 - 1e-6)
    return [f"{name}: falls before it rocks" for name in both.index[bad]]


def wrong_limits(table: pd.DataFrame) -> list[str]:
    """Columns of which a value lies outside its own limits; missing values and limits say nothing."""
    wrong = []
    for name in table.columns:
        if not {f"{name}_lower", f"{name}_upper"} <= set(table.columns):
            continue
        value, low, high = table[name], table[f"{name}_lower"], table[f"{name}_upper"]
        # an end that a search found ends where its tolerance does
        bad = (value < low * (1 - 1e-6)) | (value > high * (1 + 1e-6)) | (low > high)
        if bad.any():
            wrong.append(
                f"{name}: {value[bad].iloc[0]} of {low[bad].iloc[0]} to {high[bad].iloc[0]}"
            )
    return wrong
