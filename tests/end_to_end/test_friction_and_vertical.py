"""Studies whose bodies slide and fly, or are shaken vertically too, from configuration to report."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockfrag import Block, overturns, simulate
from rockfrag.base.units import GRAVITY
from rockfrag.outcomes.response import Response
from rockfrag.records.motion import read_motion_set
from rockfrag.simulation.ensemble import LIGHT, LightBodies

from .checked_report import run_and_check
from .studies import Foreign, alone

SLENDER = {"figure": (30.0, 60.0, 60.0), "column": (30.0, 120.0, 110.0)}
SLENDER |= {"plinth": (50.0, 60.0, 350.0)}
STANDING = alone("figure", "column") | {"column on plinth": ("column", "plinth")}
RECORDS = {"a": "one", "b": "two"}


def table(results: Path, name: str) -> pd.DataFrame:
    return pd.read_parquet(results / f"{name}.parquet")


@pytest.mark.slow
def test_on_smooth_surfaces_what_is_stout_slides_and_what_is_slender_rocks(tmp_path):
    amplitudes = {"lowest_g": 0.2, "highest_g": 1.2, "step_percent": 20}
    content = {"friction": 0.3, "amplitudes": amplitudes}
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
    holds = column[weak & (column["peak_slip_contact_1_m"] == 0)]
    assert (holds["overturned"] == holds["overturned_without_sliding"]).all()
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
    written = (results / "exports/fragility_pga.xml").read_text()
    assert "<limitStates>slides overturns</limitStates>" in written
    damage = (results / "exports/fragility_pga.json").read_text()
    assert "Slides and may be displaced" in damage


COLUMN = Block(0.3, 1.2, 110.0)


def test_each_outcome_is_that_of_both_components_scaled_together(tmp_path):
    amplitudes = {"lowest_g": 0.2, "highest_g": 2.4, "step_percent": 20}
    content = {"vertical": True, "amplitudes": amplitudes}
    study = Foreign(
        SLENDER, STANDING, RECORDS, floors={"hall": 0, "loft": 3}, content=content
    )
    results, page = run_and_check(study, tmp_path)
    words = " ".join(page.words)
    felt = {
        motion.name: motion
        for motion in read_motion_set(results / "motions/floors.parquet")
    }
    ups = {
        motion.name: motion
        for motion in read_motion_set(results / "motions/vertical.parquet")
    }
    motion, up = felt["a_hall"], ups["a_hall"].acceleration
    # floors take vertical components as they are
    np.testing.assert_array_equal(up, ups["a_loft"].acceleration)

    def simulated(peak_g: float) -> Response:
        factor = peak_g * GRAVITY / motion.pga
        return simulate(
            COLUMN, factor * motion.acceleration, motion.dt, vertical=factor * up
        )

    ida = table(results, "ida/column")
    assert "peak_slip_contact_1_m" not in ida.columns
    rows = ida[ida["motion"] == "a_hall"]
    assert rows["overturned"].any() and not rows["overturned"].all()
    with pytest.warns(LightBodies):
        for row in rows.to_dict("records"):
            response = simulated(row["amplitude_g"])
            assert response.overturned == row["overturned"]
            least = 1 + row["amplitude_g"] / motion.pga * min(up.min(), 0)
            assert row["minimum_gravity_ratio"] == pytest.approx(least, abs=1e-9)
            if not row["overturned"]:
                rotation, peak = (
                    row["peak_rotation_body_1"],
                    np.abs(response.theta).max(),
                )
        factors = rows["amplitude_g"].to_numpy() * GRAVITY / motion.pga
        fell = overturns(COLUMN, motion.acceleration, motion.dt, factors, vertical=[up])
    assert rotation == pytest.approx(peak / COLUMN.alpha, rel=0.02)
    np.testing.assert_array_equal(fell.overturned.ravel(), rows["overturned"])
    # the report says in how many cases bodies may fly
    cases = pd.concat(
        pd.read_parquet(path) for path in (results / "ida").glob("*.parquet")
    )
    light = int((cases["minimum_gravity_ratio"] < LIGHT).sum())
    assert 0 < light < len(cases)
    assert "The vertical components of the records act too" in words
    said = "analyses the ground takes away more than half of all weight"
    assert f"in {light} of {len(cases)} {said}" in words
    # and counts the tests in which a block lifts off
    validity = table(results, "validity")
    row = validity.query(
        "motion == 'a_hall' and object == 'column' and pedestal == 'NP'"
    ).iloc[0]
    response = simulated(row["amplitude_g"])
    assert row["least_normal_force_n"] == pytest.approx(
        float(response.least_normal_force.min())
    )
    assert row["friction_demand"] == pytest.approx(
        float(response.friction_demand.max())
    )
    assert row["unstable_distance"] == pytest.approx(response.unstable_distance)
    lifted = int((validity["least_normal_force_n"] <= 0).sum())
    assert ("No block would have lifted off" in words) == (lifted == 0)
