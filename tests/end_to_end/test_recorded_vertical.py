"""A study with the vertical component of a real three-component record, from its file to the report."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockfrag.records.read import read_motion
from rockfrag.report.part import Results
from rockfrag.rocking import Block, overturns, simulate
from rockfrag.rocking.ensemble import LIGHT, LightBodies
from rockfrag.study.loading import load_any
from rockfrag.units import GRAVITY

from .checked_report import check_first_page, check_report
from .studies import CATALOGUE, Foreign, run_stages, write

# Coalinga, 2 May 1983 (CSMIP 36456): components 90, UP and 0, of 3251 and 3250 samples
FILE = "ce36456p_CE36456.V2"
BLOCK = Block(0.3, 1.2, 110.0)


@pytest.fixture(scope="module")
def results(shared: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    record = shared / "records" / "formats" / "csmip_dmg" / FILE
    if not record.is_file():
        pytest.skip("the record is absent")
    study = Foreign(
        {"column": (30.0, 120.0, 110.0), "plinth": (50.0, 60.0, 350.0)},
        {"column": ("column", None), "column on plinth": ("column", "plinth")},
        {"across": "Coalinga", "along": "Coalinga"},
        content={
            "vertical": True,
            "amplitudes": {"lowest_g": 0.2, "highest_g": 2.4, "step_percent": 20},
        },
    )
    folder = tmp_path_factory.mktemp("recorded")
    path = write(study, folder)
    shutil.copy(record, folder / FILE)
    rows = [
        f"{name},Coalinga,,,,,,folder,{FILE}#{angle},{FILE}#UP,,,own"
        for name, angle in (("across", "90"), ("along", "0"))
    ]
    (folder / "motions.csv").write_text("\n".join([CATALOGUE.strip(), *rows]) + "\n")
    found = run_stages(path)
    page = check_report(found, study.names)
    check_first_page(Results(load_any(path), found))
    (folder / "words.txt").write_text(" ".join(page.words))
    return found


def components(results: Path) -> tuple[np.ndarray, np.ndarray]:
    """Component 90 and the vertical one as the file has them, over the time both last [m/s²]."""
    path = results.parents[1] / FILE
    item, up = (read_motion(path, channel=name).acceleration for name in ("90", "UP"))
    n = min(item.size, up.size)
    return item[:n], up[:n]


def test_each_outcome_is_that_of_both_components_scaled_together(results: Path) -> None:
    across, up = components(results)
    ida = pd.read_parquet(results / "ida" / "column.parquet")
    rows = ida[ida["motion"] == "across_ground"]
    assert rows["overturned"].any() and not rows["overturned"].all()
    for row in rows.to_dict("records"):
        factor = row["amplitude_g"] * GRAVITY / np.abs(across).max()
        response = simulate(BLOCK, factor * across, 0.02, vertical=factor * up)
        assert response.overturned == row["overturned"]
        assert row["minimum_gravity_ratio"] == pytest.approx(
            1 + min((factor * up).min(), 0) / GRAVITY, abs=1e-9
        )
    factors = rows["amplitude_g"].to_numpy() * GRAVITY / np.abs(across).max()
    with pytest.warns(LightBodies):
        fell = overturns(BLOCK, across, 0.02, factors, vertical=[up])
    np.testing.assert_array_equal(fell.overturned.ravel(), rows["overturned"])


def test_the_report_says_in_how_many_cases_bodies_may_fly(results: Path) -> None:
    ida_curves = [pd.read_parquet(path) for path in (results / "ida").glob("*.parquet")]
    cases = pd.concat(ida_curves)
    light = int((cases["minimum_gravity_ratio"] < LIGHT).sum())
    assert 0 < light < len(cases)
    words = (results.parents[1] / "words.txt").read_text()
    assert "The vertical components of the records act too" in words
    assert (
        f"in {light} of {len(cases)} analyses the ground takes away more than half of all weight"
        in words
    )


def test_the_report_counts_the_tests_in_which_a_block_lifts_off(results: Path) -> None:
    across, up = components(results)
    validity = pd.read_parquet(results / "validity.parquet")
    row = validity.query("motion == 'across_ground' and pedestal == 'NP'").iloc[0]
    factor = row["amplitude_g"] * GRAVITY / np.abs(across).max()
    response = simulate(BLOCK, factor * across, 0.02, vertical=factor * up)
    assert row["least_normal_force_n"] == pytest.approx(float(response.least_normal_force.min()))
    assert row["friction_demand"] == pytest.approx(float(response.friction_demand.max()))
    lifted = int((validity["least_normal_force_n"] <= 0).sum())
    words = (results.parents[1] / "words.txt").read_text()
    assert ("No block would have lifted off" in words) == (lifted == 0)
