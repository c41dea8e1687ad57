from pathlib import Path

import pytest

from rockfrag.errors import InputError
from rockfrag.shaketable.settings import make_shaker, read_shaker
from rockfrag.shaketable.shaker import Shaker

SHAKER = Path(__file__).resolve().parents[2] / "config" / "experiment" / "shaker.yaml"


def test_the_shaker_of_the_thesis_is_what_the_configuration_holds():
    assert read_shaker(SHAKER) == Shaker()


def test_wrong_shakers_are_refused(tmp_path):
    with pytest.raises(InputError, match="key strokes is not known; did you mean stroke_m"):
        make_shaker({"strokes": 0.29})
    with pytest.raises(InputError, match="key force_n: expected a number of newtons"):
        make_shaker({"force_n": "500 N"})
    with pytest.raises(InputError, match=r"key stroke: .* without a unit"):
        make_shaker({"stroke": 0.29})
    with pytest.raises(InputError, match="shaker: key stroke_m: expected a length above 0 m"):
        make_shaker({"stroke_m": -1})
    with pytest.raises(InputError, match="cannot be read"):
        read_shaker(tmp_path / "absent.yaml")


def test_lengths_and_masses_may_be_given_in_any_unit():
    assert make_shaker({"stroke": "29 cm", "table_mass_g": 2500}) == make_shaker(
        {"stroke_m": 0.29, "table_mass_kg": 2.5}
    )
