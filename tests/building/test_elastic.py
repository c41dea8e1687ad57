import numpy as np
import pytest
from scipy.linalg import eigh, expm

from rockfrag.building.floors import floor_motions
from rockfrag.building.response import find_modes, respond_elastically
from rockfrag.building.settings import make_building
from rockfrag.errors import InputError

from ..case_tables import case_tables

CASES = case_tables(__file__)


def test_reference_building_has_the_published_periods_and_stiffnesses(settings):
    building = make_building(settings)
    period = find_modes(building).period
    assert [f"{value:.5f}" for value in period[:3]] == ["0.35000", "0.11880", "0.07409"]
    assert [f"{value:.3e}" for value in building.stiffnesses[:2]] == ["1.580e+09", "1.871e+09"]
    assert building.stiffnesses[1:] == (building.stiffnesses[1],) * 5
    assert building.model == "elastic"
    with pytest.raises(InputError, match="floor 'F7' is not defined"):
        building.level("F7")


@pytest.mark.parametrize(("period", "name", "third", "fifth"), CASES["amplification"])
def test_reference_building_amplifies_the_four_records_as_published(
    settings, four_records, period, name, third, fifth
):
    building = make_building(settings | {"first_period_s": period})
    ground, *floors = floor_motions(building, four_records[name])
    assert [f"{floor.pga / ground.pga:.2f}" for floor in floors] == [third, fifth]
    assert floors[0].name.endswith("_F3")
    assert floors[0].metadata["floor"] == "F3"
    assert floors[0].metadata["ground_motion"] == ground.name.removesuffix("_GF")
    step = floors[0].provenance[-1]
    assert (step["step"], step["model"]) == ("floor_motion", "elastic")
    assert "elastic: storey" in step["outcome"]


@pytest.mark.parametrize(
    "damping",
    [{"kind": "modal", "ratio": 0.05}, {"kind": "rayleigh", "ratio": 0.08, "modes": [1, 3]}],
)
def test_modal_superposition_equals_the_matrix_exponential(settings, damping, noise):
    building = make_building(settings | {"first_period_s": 0.6, "damping": damping})
    motion = noise(3, 400)
    n, ratio = building.storeys, building.damping.ratio
    mass, stiffness = np.diag(building.masses), building.stiffness_matrix()
    if damping["kind"] == "rayleigh":
        w1, w3 = find_modes(building).frequency[[0, 2]]
        factor = 2 * ratio / (w1 + w3)
        viscous = factor * w1 * w3 * mass + factor * stiffness
    else:
        # C = 2 ζ M (M⁻¹K)^½ has the ratio ζ in every mode
        values, vectors = eigh(stiffness, mass)
        root = vectors @ np.diag(np.sqrt(values)) @ np.linalg.inv(vectors)
        viscous = 2 * ratio * mass @ root
    system = np.zeros((2 * n + 2, 2 * n + 2))
    system[:n, n : 2 * n] = np.eye(n)
    system[n : 2 * n, :n] = -np.linalg.solve(mass, stiffness)
    system[n : 2 * n, n : 2 * n] = -np.linalg.solve(mass, viscous)
    system[n : 2 * n, 2 * n] = -1
    system[2 * n, 2 * n + 1] = 1
    step = expm(system * motion.dt)[: 2 * n]
    state = np.zeros((2 * n, motion.acceleration.size))
    slopes = np.diff(motion.acceleration) / motion.dt
    for i, slope in enumerate(slopes):
        state[:, i + 1] = step @ [*state[:, i], motion.acceleration[i], slope]
    total = system[n : 2 * n, : 2 * n] @ state
    found = respond_elastically(building, motion)
    scale = np.abs(total).max()
    assert np.abs(found.acceleration[1:] - total).max() < 1e-9 * scale
    drift = np.diff(state[:n], axis=0, prepend=0) / np.array(building.heights)[:, None]
    assert np.abs(found.drift - drift).max() < 1e-9 * np.abs(drift).max()


def test_modes_take_up_the_whole_mass_and_every_floor_moves_with_the_ground(settings):
    modes = find_modes(make_building(settings))
    assert modes.mass_fraction.sum() == pytest.approx(1, rel=1e-12)
    assert modes.shape @ modes.participation == pytest.approx(np.ones(6), rel=1e-12)


@pytest.mark.parametrize(("key", "value", "times", "message"), CASES["refused"])
def test_unphysical_buildings_are_refused_in_one_sentence(settings, key, value, times, message):
    if key.startswith("only "):
        del settings["first_period_s"]
    settings[key.removeprefix("only ")] = [value] * times if times else value
    with pytest.raises(InputError, match=message) as refused:
        make_building(settings, "building.yaml")
    text = str(refused.value)
    assert text.startswith("building.yaml: ")
    assert text.endswith((".", "?"))


def test_heights_and_masses_may_be_in_any_unit_and_stiffnesses_stand_for_a_period(settings):
    usual = make_building(settings)
    del settings["first_period_s"]
    settings["storey_stiffnesses_N_m"] = list(usual.stiffnesses)
    settings["storey_heights_cm"] = [100 * h for h in settings.pop("storey_heights_m")]
    settings["masses"] = [f"{m / 1000} t" for m in settings.pop("masses_kg")]
    other = make_building(settings)
    assert other.stiffnesses == usual.stiffnesses
    assert other.heights == pytest.approx(usual.heights, rel=1e-15)
    assert other.masses == pytest.approx(usual.masses, rel=1e-15)
