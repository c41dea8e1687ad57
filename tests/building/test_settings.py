from pathlib import Path

import pytest

from rockfrag.building.response import find_modes
from rockfrag.building.settings import make_building, read_building
from rockfrag.errors import InputError

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


def replace(key, value):
    return lambda settings: settings.update({key: value})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            replace("masses_kg", [350000.0] * 5 + [0]),
            r"masses_kg\[5\]: expected a mass above 0 kg, found 0",
        ),
        (replace("masses_kg", [350000.0] * 5), "6 entries and masses_kg 5"),
        (
            replace("storey_heights_m", [4.0] * 10_000),
            "storey_heights_m: expected a list of 1 to 100 heights",
        ),
        (
            replace("masses_kg", [350.0] * 6),
            r"masses_kg\[0\]: 350 kg is no building's.*check the unit",
        ),
        (replace("masses_kg", [1e-9] * 6), "is no building's"),
        (
            replace("storey_heights_m", [450.0] * 6),
            r"storey_heights_m\[0\]: 450 m is no building's",
        ),
        (replace("first_period_s", 1e-6), "first_period_s: the first period would be 1e-06 s"),
        (replace("first_period_s", 1e6), r"first_period_s: the first period would be 1e\+06 s"),
        (replace("floors", {"GF": 0, "gf": 1}), "gf and GF would share a file name"),
        (replace("masses_kg", [350000.0] * 101), "expected a list of 1 to 100 masses"),
        (replace("storey_heights_m", []), "storey_heights_m: expected a list"),
        (replace("masses_kg", ["heavy"] * 6), r"masses_kg\[0\]: expected a mass such as"),
        (replace("first_period_s", 1e-300), "first_period must be positive numbers of s"),
        (replace("first_period_s", -0.3), "first_period_s: expected .* found -0.3"),
        (
            replace("first_period_s", float("nan")),
            "first_period_s: expected a finite number, found nan",
        ),
        (replace("storey_stiffnesses_N_m", [1e9] * 6), "not both"),
        (replace("floors", {"F9": 9}), "'F9' is level 9, but levels run from 0"),
        (replace("floors", {"F3": 3.5}), r"floors\.F3: expected a level .* found 3.5"),
        (replace("damping", {"kind": "modal", "ratio": 5}), r"damping\.ratio: expected a fraction"),
        (replace("damping", {"kind": "caughey"}), r"damping\.kind: expected modal or rayleigh"),
        (replace("damping", {"kind": "rayleigh", "modes": [1, 9]}), "names mode 9"),
        (replace("model", "plastic"), "elastic or hysteretic"),
        (replace("storeys", 6), "key storeys is not known"),
        (replace("masonry", {"base_shear": 0}), "greater than zero"),
        (replace("masonry", {"shear_drift": 0.0001}), "drifts must rise"),
    ],
)
def test_unphysical_buildings_are_refused_in_one_sentence(settings, change, message):
    change(settings)
    with pytest.raises(InputError, match=message) as refused:
        make_building(settings, "building.yaml")
    text = str(refused.value)
    assert text.startswith("building.yaml: ")
    assert text.endswith((".", "?"))
    assert "\n" not in text


@pytest.mark.parametrize("stiffness", [1e-3, 1.0, 1e15])
def test_stiffnesses_of_no_building_do_not_blame_the_record(settings, stiffness):
    del settings["first_period_s"]
    settings["storey_stiffnesses_N_m"] = [stiffness] * 6
    with pytest.raises(InputError, match="storey_stiffnesses_N_m: the first period would be"):
        make_building(settings)


def test_negative_stiffness_is_refused(settings):
    del settings["first_period_s"]
    settings["storey_stiffnesses_N_m"] = [1e9] * 5 + [-1e9]
    with pytest.raises(InputError, match=r"storey_stiffnesses_N_m\[5\]: .* found -1000000000"):
        make_building(settings)


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
