"""Studies whose bodies slide and fly, or are shaken vertically too, from configuration to report."""

import logging
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import rockfrag.study.study
from rockfrag import Block, overturns, simulate
from rockfrag.records.motion import read_motion_set
from rockfrag.records.read import read_motion
from rockfrag.report.part import Results
from rockfrag.rocking.ensemble import LIGHT, LightBodies
from rockfrag.stages import fragility
from rockfrag.stages.job import Job
from rockfrag.study.loading import load_any
from rockfrag.units import GRAVITY

from .checked_report import Page, check_first_page, check_report
from .studies import CATALOGUE, Foreign, run, run_stages, write

SLENDER = {
    "figure": (30.0, 60.0, 60.0),
    "column": (30.0, 120.0, 110.0),
    "plinth": (50.0, 60.0, 350.0),
}
STANDING = {
    "figure": ("figure", None),
    "column": ("column", None),
    "column on plinth": ("column", "plinth"),
}
RECORDS = {"a": "one", "b": "two"}


def run_and_check(study: Foreign, folder: Path) -> tuple[Path, Page]:
    results = run(study, folder)
    page = check_report(results, study.names)
    check_first_page(Results(load_any(folder / "study.yaml"), results))
    return results, page


def table(results: Path, name: str) -> pd.DataFrame:
    return pd.read_parquet(results / f"{name}.parquet")


def test_on_smooth_surfaces_what_is_stout_slides_and_what_is_slender_rocks(tmp_path, monkeypatch):
    content = {
        "friction": 0.3,
        "amplitudes": {"lowest_g": 0.2, "highest_g": 1.2, "step_percent": 20},
    }
    study = Foreign(SLENDER, STANDING, RECORDS, floors={"hall": 0}, content=content)
    results, page = run_and_check(study, tmp_path)
    # b/h of the figure is 0.5: it slides before it could rock, and never overturns
    figure = table(results, "ida/figure")
    strong = figure["amplitude_g"] > 0.5
    assert not figure["overturned"].any()
    assert (figure["peak_rotation_body_1"] == 0).all()
    assert (figure.loc[strong, "peak_slip_contact_1_m"] > 0).all()
    assert figure.loc[strong, "overturned_without_sliding"].any()
    # b/h of the column is 0.25: it rocks as on surfaces that hold until it slides
    column = table(results, "ida/column")
    weak = column["amplitude_g"] < 0.29
    assert (
        column.loc[weak & (column["peak_slip_contact_1_m"] == 0), "overturned"]
        == column.loc[weak & (column["peak_slip_contact_1_m"] == 0), "overturned_without_sliding"]
    ).all()
    found = table(results, "sliding").set_index("configuration")
    assert found.loc["figure", "saved"] == figure["overturned_without_sliding"].sum()
    assert found.loc["figure", "felled"] == 0
    assert (table(results, "ida/column-on-plinth")["peak_slip_contact_2_m"] > 0).any()
    validity = table(results, "validity")
    assert (validity["friction_demand"] <= 0.3 * (1 + 1e-9)).all()
    assert {"peak_slip_m", "flights"} <= set(validity.columns)
    words = " ".join(page.words)
    assert "What friction does" in words and "Bodies slide in" in words
    assert "neither slide nor jump" not in words
    states = table(results, "fragility_floors")
    assert set(states["state"]) == {"slides", "overturns"}
    # outcomes that are counted give the same curves as outcomes that are rows
    monkeypatch.setattr(rockfrag.study.study, "MOST_ROWS", 10)
    job = Job(load_any(tmp_path / "study.yaml"), results, 1, logging.getLogger("test"))
    counted = dict(fragility.run(job))["fragility_floors"]
    keys = ["configuration", "floor", "measure", "state", "n_motions"]
    pd.testing.assert_frame_equal(counted[keys], states[keys], check_dtype=False)
    assert states["theta"].notna().any()
    np.testing.assert_allclose(counted["theta"], states["theta"], rtol=1e-3)


def test_vertical_components_shake_too_and_floors_take_them_as_they_are(tmp_path: Path):
    study = Foreign(
        SLENDER, STANDING, RECORDS, floors={"hall": 0, "loft": 3}, content={"vertical": True}
    )
    results, page = run_and_check(study, tmp_path)
    assert "vertical components" in " ".join(page.words)
    floors, ups = (
        read_motion_set(results / "motions" / f"{name}.parquet") for name in ("floors", "vertical")
    )
    assert [floor.name for floor in floors] == [item.name for item in ups]
    by_name = {item.name: item for item in ups}
    np.testing.assert_array_equal(by_name["a_hall"].acceleration, by_name["a_loft"].acceleration)
    # a row of the IDA curve is what simulate says of the two components
    ida = table(results, "ida/column")
    row = ida[(ida["motion"] == "a_loft") & ~ida["overturned"]].iloc[-1]
    motion = next(floor for floor in floors if floor.name == "a_loft")
    factor = row["amplitude_g"] * GRAVITY / motion.pga
    block = Block(0.3, 1.2, 110.0)
    response = simulate(
        block,
        factor * motion.acceleration,
        motion.dt,
        vertical=factor * by_name["a_loft"].acceleration,
    )
    peak = np.abs(response.theta).max() / block.alpha
    assert row["peak_rotation_body_1"] > 0
    np.testing.assert_allclose(row["peak_rotation_body_1"], peak, rtol=0.02)
    assert "peak_slip_contact_1_m" not in ida.columns


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
