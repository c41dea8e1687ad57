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
    assert "\n" not in text


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
