"""Tables 3.1, 3.3 and 4.1 come out to the printed digits."""

from dataclasses import astuple, replace
from pathlib import Path

import pytest

from rockfrag.base.errors import InputError
from rockfrag.study.configurations import read_specimens
from rockfrag.study.loading import load_any
from rockfrag.system.blocks import Block, Stack
from rockfrag_thesis.hypotheses.evidence import THESIS_BODIES
from rockfrag_thesis.printed_tables import (
    FOLDER,
    TABLE_3_1,
    TABLE_3_3,
    TABLE_4_1,
    compare,
    uplift_accelerations,
)

CONFIG = Path(__file__).resolve().parents[2] / "config"


@pytest.fixture
def computed(four_records):
    """The quantities of each printed table, from the thesis's study and its records."""
    study = load_any(CONFIG / "thesis.yaml")
    names = {name: name.replace("_", " ") for name in four_records}
    motions = [replace(four_records[file], name=name) for file, name in names.items()]
    return {
        "table_3_1": (study.specimens, TABLE_3_1),
        "table_3_3": ({motion.name: motion for motion in motions}, TABLE_3_3),
        "table_4_1": (
            {system.name: system for system in study.configurations},
            TABLE_4_1,
        ),
    }


def test_the_package_and_the_study_have_the_same_specimens():
    study = read_specimens(CONFIG / "specimens.csv")
    assert list(study) == list(THESIS_BODIES)
    for name, body in THESIS_BODIES.items():
        assert astuple(study[name]) == pytest.approx(astuple(body))


@pytest.mark.parametrize(
    ("name", "rows"), [("table_3_1", 16), ("table_3_3", 12), ("table_4_1", 9)]
)
def test_the_printed_tables_come_out(computed, name, rows):
    table = compare(*computed[name], FOLDER / f"{name}.csv")
    assert len(table) == rows
    assert table["agrees"].all()


def test_a_value_off_in_the_last_printed_digit_does_not_agree(tmp_path: Path):
    printed = tmp_path / "table.csv"
    printed.write_text((FOLDER / "table_3_1.csv").read_text().replace("19.61", "19.62"))
    table = compare({"T1": THESIS_BODIES["T1"]}, TABLE_3_1, printed)
    assert table.set_index("quantity")["agrees"].to_dict()["R"] is False


def test_without_printed_values_nothing_agrees_or_disagrees():
    table = compare({"X": Block(1, 2, 3)}, TABLE_3_1, FOLDER / "table_3_1.csv")
    assert table["agrees"].isna().all()


def test_a_printed_value_that_is_no_number_is_named(tmp_path: Path):
    printed = tmp_path / "table.csv"
    printed.write_text(
        (FOLDER / "table_3_1.csv").read_text().replace("19.61", "about 20")
    )
    with pytest.raises(InputError, match="radius_cm"):
        compare({"X": Block(1, 2, 3)}, TABLE_3_1, printed)


def test_an_eccentric_block_uplifts_about_its_nearer_edge():
    assert uplift_accelerations(Block(1, 4, 10, cg_offset=0.1))[1] == pytest.approx(
        0.2 * 9.81
    )


def test_a_heavy_pedestal_takes_the_threshold_of_pattern_3_to_its_own():
    statue, pedestal = Block(0.1, 0.4, 1e-6), Block(0.4, 0.4, 1e3)
    both, alone = uplift_accelerations(Stack(pedestal, statue))
    assert both == pytest.approx(9.81, rel=1e-6)
    assert alone == pytest.approx(0.25 * 9.81)
