from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh, expm

from rockfrag.building.floors import floor_motions
from rockfrag.building.model import ModalDamping, RayleighDamping, ShearBuilding
from rockfrag.building.model import stiffnesses_for_period as for_period
from rockfrag.building.response import find_modes, respond_elastically
from rockfrag.building.settings import make_building, read_building
from rockfrag.errors import InputError

MASSES = (350e3,) * 5 + (245e3,)
HEIGHTS = (4.5,) + (3.8,) * 5
FLOORS = {"GF": 0, "F3": 3, "F5": 5}

AMPLIFICATION = {
    0.35: {
        "Friuli": ("2.04", "2.70"),
        "Kobe": ("2.35", "3.15"),
        "Loma_Prieta": ("1.63", "1.98"),
        "Northridge": ("2.29", "3.05"),
    },
    0.60: {
        "Friuli": ("0.97", "1.44"),
        "Kobe": ("1.45", "1.77"),
        "Loma_Prieta": ("1.90", "1.76"),
        "Northridge": ("1.30", "1.91"),
    },
}


def reference(period=0.35, damping=None):
    return ShearBuilding(
        masses=MASSES,
        heights=HEIGHTS,
        stiffnesses=for_period(MASSES, HEIGHTS, period),
        damping=damping or ModalDamping(0.05),
        floors=FLOORS,
    )


def test_reference_building_has_the_published_periods_and_stiffnesses():
    building = reference()
    period = find_modes(building).period
    assert [f"{value:.5f}" for value in period[:3]] == ["0.35000", "0.11880", "0.07409"]
    assert [f"{value:.3e}" for value in building.stiffnesses[:2]] == ["1.580e+09", "1.871e+09"]
    assert building.stiffnesses[1:] == (building.stiffnesses[1],) * 5


@pytest.mark.parametrize("name", ["Friuli", "Kobe", "Loma_Prieta", "Northridge"])
@pytest.mark.parametrize("period", [0.35, 0.60])
def test_reference_building_amplifies_the_four_records_as_published(four_records, period, name):
    ground, third, fifth = floor_motions(reference(period), four_records[name])
    ratios = tuple(f"{floor.pga / ground.pga:.2f}" for floor in (third, fifth))
    assert ratios == AMPLIFICATION[period][name]


@pytest.mark.parametrize("damping", [ModalDamping(0.05), RayleighDamping(0.08, (1, 3))])
def test_modal_superposition_equals_the_matrix_exponential(damping, noise):
    building, motion = reference(0.6, damping), noise(3, 400, name="noise")
    n = building.storeys
    mass, stiffness = np.diag(building.masses), building.stiffness_matrix()
    if isinstance(damping, RayleighDamping):
        w1, w3 = find_modes(building).frequency[[0, 2]]
        factor = 2 * damping.ratio / (w1 + w3)
        viscous = factor * w1 * w3 * mass + factor * stiffness
    else:
        # C = 2 ζ M (M⁻¹K)^½ has the ratio ζ in every mode
        values, vectors = eigh(stiffness, mass)
        root = vectors @ np.diag(np.sqrt(values)) @ np.linalg.inv(vectors)
        viscous = 2 * damping.ratio * mass @ root
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
    drift = np.diff(state[:n], axis=0, prepend=0) / np.array(HEIGHTS)[:, None]
    assert np.abs(found.drift - drift).max() < 1e-9 * np.abs(drift).max()


def test_modes_take_up_the_whole_mass_and_every_floor_moves_with_the_ground():
    modes = find_modes(reference())
    assert modes.mass_fraction.sum() == pytest.approx(1, rel=1e-12)
    assert modes.shape @ modes.participation == pytest.approx(np.ones(6), rel=1e-12)


def test_floor_motions_say_where_they_come_from(noise):
    third = floor_motions(reference(), noise(3, 400, name="noise"), ["F3"])[0]
    assert third.name == "noise_F3"
    assert third.metadata["floor"] == "F3"
    assert third.metadata["ground_motion"] == "noise"
    assert third.provenance[-1]["step"] == "floor_motion"
    assert third.provenance[-1]["model"] == "elastic"
    assert third.provenance[-1]["outcome"].startswith("building, elastic: storey")


CONFIG = Path(__file__).resolve().parents[2] / "config" / "building.yaml"


def test_the_reference_building_is_what_the_configuration_holds():
    building = read_building(CONFIG)
    assert find_modes(building).period[0] == pytest.approx(0.35, rel=1e-12)
    assert (building.level("F3"), building.level("F5")) == (3, 5)
    assert building.model == "elastic"


def test_stiffnesses_can_be_given_instead_of_a_period(settings):
    del settings["first_period_s"]
    settings["storey_stiffnesses_N_m"] = [1e9] * 6
    assert make_building(settings).stiffnesses == (1e9,) * 6


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("masses_kg", [350e3] * 5 + [0], r"masses_kg\[5\]: expected a mass above 0 kg, found 0"),
        ("masses_kg", [350e3] * 5, "6 entries and masses_kg 5"),
        ("masses_kg", [350.0] * 6, r"masses_kg\[0\]: 350 kg is no building's.*check the unit"),
        ("masses_kg", [1e-9] * 6, "is no building's"),
        ("masses_kg", [350e3] * 101, "expected a list of 1 to 100 masses"),
        ("masses_kg", ["heavy"] * 6, r"masses_kg\[0\]: expected a mass such as"),
        ("storey_heights_m", [4.0] * 10_000, "m: expected a list of 1 to 100 heights"),
        ("storey_heights_m", [450.0] * 6, r"heights_m\[0\]: 450 m is no building's"),
        ("storey_heights_m", [], "storey_heights_m: expected a list"),
        ("first_period_s", 1e-6, "first_period_s: the first period would be 1e-06 s"),
        ("first_period_s", 1e6, r"first_period_s: the first period would be 1e\+06 s"),
        ("first_period_s", 1e-300, "first_period must be positive numbers of s"),
        ("first_period_s", -0.3, "first_period_s: expected .* found -0.3"),
        ("first_period_s", float("nan"), "s: expected a finite number, found nan"),
        ("storey_stiffnesses_N_m", [1e9] * 6, "not both"),
        *(
            ("only storey_stiffnesses_N_m", [k] * 6, "N_m: the first period")
            for k in (1e-3, 1.0, 1e15)
        ),
        ("only storey_stiffnesses_N_m", [1e9] * 5 + [-1e9], r"N_m\[5\]: .* found -1000000000"),
        ("floors", {"GF": 0, "gf": 1}, "gf and GF would share a file name"),
        ("floors", {"F9": 9}, "'F9' is level 9, but levels run from 0"),
        ("floors", {"F3": 3.5}, r"floors\.F3: expected a level .* found 3.5"),
        ("damping", {"kind": "modal", "ratio": 5}, r"damping\.ratio: expected a fraction"),
        ("damping", {"kind": "caughey"}, r"damping\.kind: expected modal or rayleigh"),
        ("damping", {"kind": "rayleigh", "modes": [1, 9]}, "names mode 9"),
        ("model", "plastic", "elastic or hysteretic"),
        ("storeys", 6, "key storeys is not known"),
        ("masonry", {"base_shear": 0}, "greater than zero"),
        ("masonry", {"shear_drift": 0.0001}, "drifts must rise"),
    ],
)
def test_unphysical_buildings_are_refused_in_one_sentence(settings, key, value, message):
    if key.startswith("only "):
        del settings["first_period_s"]
    settings[key.removeprefix("only ")] = value
    with pytest.raises(InputError, match=message) as refused:
        make_building(settings, "building.yaml")
    text = str(refused.value)
    assert text.startswith("building.yaml: ")
    assert text.endswith((".", "?"))


def test_a_floor_that_does_not_exist_is_refused(settings):
    with pytest.raises(InputError, match="floor 'F7' is not defined"):
        make_building(settings).level("F7")


def test_a_missing_file_and_broken_yaml_are_refused(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        read_building(tmp_path / "absent.yaml")
    broken = tmp_path / "broken.yaml"
    broken.write_text("masses_kg: [1, 2\nfloors: {", encoding="utf-8")
    with pytest.raises(InputError, match=r"broken\.yaml, line 2"):
        read_building(broken)


def test_heights_and_masses_may_be_given_in_any_unit(settings):
    usual = make_building(settings)
    settings["storey_heights_cm"] = [100 * h for h in settings.pop("storey_heights_m")]
    settings["masses"] = [f"{m / 1000} t" for m in settings.pop("masses_kg")]
    other = make_building(settings)
    assert other.heights == pytest.approx(usual.heights, rel=1e-15)
    assert other.masses == pytest.approx(usual.masses, rel=1e-15)
