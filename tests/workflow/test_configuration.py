"""A study that cannot run is refused before anything runs, in one sentence with file and key."""

import copy
from collections.abc import Callable
from pathlib import Path

import pytest

from rockfrag.errors import InputError
from rockfrag.study.loading import load_any

from .conftest import SPECIMENS, study_content, write_study

Change = Callable[[dict], object]


def refusal(folder: Path, content: dict) -> str:
    path = write_study(folder, content)
    with pytest.raises(InputError) as caught:
        load_any(path)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(str(folder))
    return message


def test_the_studies_of_the_project_are_right():
    root = Path(__file__).resolve().parents[2]
    for name in ("thesis", "smoke", "wide"):
        assert load_any(root / "config" / f"{name}.yaml").name == name


def test_the_thesis_has_72_tests():
    study = load_any(Path(__file__).resolve().parents[2] / "config" / "thesis.yaml")
    assert len(study.catalogue) * 3 * len(study.configurations) == 72


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda c: c["amplitudes"].update(hihgest_g=2), ["amplitudes.hihgest_g", "highest_g"]),
        (lambda c: c["amplitudes"].pop("lowest_g"), ["amplitudes.lowest_g", "missing", "of g"]),
        (lambda c: c["amplitudes"].update(lowest_g=-0.1), ["amplitudes.lowest_g", "-0.1"]),
        (lambda c: c["amplitudes"].update(lowest_g="0.1 m/s2"), ["amplitudes.lowest_g", "of g"]),
        (lambda c: c["amplitudes"].update(lowest_g=3), ["amplitudes.highest_g", "more than"]),
        (lambda c: c["amplitudes"].update(highest_g=float("nan")), ["amplitudes.highest_g"]),
        (lambda c: c["amplitudes"].update(highest_g=float("inf")), ["amplitudes.highest_g"]),
        (lambda c: c["protocol"].update(step_percent=0), ["protocol.step_percent", "percent"]),
        (lambda c: c["bodies"].update(use=["T9"]), ["bodies.use[0]", "P&T1", "T9"]),
        (lambda c: c["motions"].update(use=["Nowhere"]), ["motions.use[0]", "motion 0"]),
        (lambda c: c["motions"].update(catalogue="no.csv"), ["motions.catalogue", "no.csv"]),
        (lambda c: c["motions"].update(processing=[{"step": "smooth"}]), ["smooth", "highpass"]),
        (lambda c: c["motions"].update(processing=[{"step": "highpass"}]), ["corner_hz"]),
        (lambda c: c.update(building="no.yaml"), ["building", "no.yaml"]),
        (lambda c: c.update(compare_with="nobody"), ["compare_with", "thesis", "nobody"]),
        (lambda c: c.update(study="../elsewhere"), ["study", "lower-case"]),
        (lambda c: c.update(seed=1.5), ["seed", "whole number"]),
        (lambda c: c.update(seed=True), ["seed", "whole number"]),
        (lambda c: c.update(seed=10**300), ["seed", "expected a number of at most"]),
        (lambda c: c.pop("seed"), ["seed", "missing"]),
        (lambda c: c.update(study="tiny\n"), ["key study"]),
        (lambda c: c.update(title="two\nlines"), ["key title: expected one line"]),
        (lambda c: c["fragility"].update(measures=["PGA"]), ["measures[0]: expected one"]),
        (lambda c: c["fragility"].update(measures=["d5_95_s"]), ["found d5_95_s"]),
        (
            lambda c: c["fragility"].update(measures=["pga_g", ["pga_g"]]),
            ["a pair of intensity measures"],
        ),
        (lambda c: c.update(fragility=None), ["fragility", "mapping"]),
    ],
)
def test_a_wrong_key_or_value_is_named_with_what_was_expected(study_folder, change, words):
    content = copy.deepcopy(study_content())
    change(content)
    message = refusal(study_folder, content)
    for word in words:
        assert word in message


@pytest.mark.parametrize(
    ("table", "words"),
    [
        (
            SPECIMENS.replace("12.4,37.2", "-12.4,37.2"),
            ["line 2", "width_cm", "more than 0", "-12.4"],
        ),
        (SPECIMENS.replace("width_cm", "width_inch"), ["width_inch", "width_m"]),
        (SPECIMENS.replace("2172", "2 cm"), ["line 2", "mass_g", "2 cm"]),
        (SPECIMENS.replace("2172", "2"), ["line 2", "density", "less than any solid"]),
        (SPECIMENS.replace("width_cm", "width_m"), ["line 2", "kg/m³", "less than any solid"]),
        (SPECIMENS.replace("height_cm", "width_m"), ["twice"]),
        (SPECIMENS.replace("12.4,37.2", "12 kg,37.2"), ["line 2", "expected a length"]),
        (SPECIMENS.replace("mass_g", "mass"), ["line 2", "column mass", "without a unit"]),
        (SPECIMENS.replace("2172", "nan"), ["line 2", "mass_g"]),
        (SPECIMENS.replace("2172", "1e400"), ["line 2", "mass_g"]),
        (SPECIMENS.replace("T2,", "T1,"), ["line 3", "T1", "twice"]),
        (SPECIMENS.replace("2172", "2172,7"), ["line 2", "4 cells"]),
        ("", ["header"]),
        (
            SPECIMENS.replace("P,18.4,20.8", "P,4,2").replace("2300", "50"),
            ["configurations.csv, line 4", "ground"],
        ),
    ],
)
def test_a_wrong_cell_is_named_with_line_and_column(study_folder, table, words):
    (study_folder / "specimens.csv").write_text(table)
    message = refusal(study_folder, study_content())
    for word in words:
        assert word in message


def test_an_unknown_block_in_a_configuration_is_named(study_folder: Path):
    (study_folder / "configurations.csv").write_text("name,object,pedestal\nX,T7,\n")
    message = refusal(study_folder, study_content())
    assert "line 2, column object" in message
    assert "T7" in message


def test_absent_files_and_folders_are_refused(study_folder):
    for path in (study_folder / "absent.yaml", study_folder):
        with pytest.raises(InputError, match="cannot be read"):
            load_any(path)
