import numpy as np
import pytest

from rockfrag.building.floors import judge_drift, respond
from rockfrag.building.response import BuildingResponse
from rockfrag.building.settings import make_building


@pytest.fixture(scope="module")
def shaken(noise):
    """Outcome on a building under noise of a peak acceleration [m/s²]."""
    shaking = noise(5, 1000)

    def judge(building, pga):
        motion = shaking.after("scale", shaking.acceleration * pga / shaking.pga)
        return judge_drift(building, respond(building, motion))

    return judge


def test_an_elastic_building_is_believed_up_to_its_strength(settings, shaken):
    building = make_building(settings)
    outcomes = [shaken(building, pga) for pga in (0.1, 0.5, 1.0, 2.0, 10.0)]
    fractions = [v.strength_fraction for v in outcomes]
    assert fractions == pytest.approx(
        [fractions[0] * pga / 0.1 for pga in (0.1, 0.5, 1.0, 2.0, 10.0)]
    )
    assert [v.credible for v in outcomes] == [fraction <= 1 for fraction in fractions]
    assert outcomes[0].state == "uncracked"
    assert outcomes[-1].state == "beyond strength"
    assert "cannot break" in outcomes[-1].statement


def test_the_strength_share_is_the_base_shear_over_the_weight(settings):
    # a storey that carries the weight times the base shear coefficient is at its strength
    building = make_building(settings)
    weight = 9.81 * building.mass
    drift = np.zeros((6, 2))
    drift[0, 1] = 0.12 * weight / building.stiffnesses[0] / building.heights[0]
    response = BuildingResponse(np.zeros(2), np.zeros((7, 2)), drift)
    outcome = judge_drift(building, response)
    assert outcome.strength_fraction == pytest.approx(1)
    assert outcome.storey == 1


@pytest.mark.parametrize(
    ("drift", "state", "credible"),
    [
        (1e-5, "uncracked", True),
        (8e-4, "cracked", True),
        (2e-3, "beyond yield", True),
        (6e-3, "beyond the shear limit", True),
        (9e-3, "beyond the rocking limit", False),
    ],
)
def test_masonry_is_judged_by_the_drift_limits(settings, drift, state, credible):
    building = make_building(settings | {"model": "hysteretic"})
    drifts = np.zeros((6, 2))
    drifts[2, 1] = -drift
    outcome = judge_drift(building, BuildingResponse(np.zeros(2), np.zeros((7, 2)), drifts))
    assert (outcome.storey, outcome.state, outcome.credible) == (3, state, credible)
    assert outcome.statement.endswith(".")
