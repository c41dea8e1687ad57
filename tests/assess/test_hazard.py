"""Hazard files of every kind are read, and what is wrong with one is said in a sentence."""

import math
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from rockfrag.assess import read_hazard
from rockfrag.assess.hazard.curve import (
    PGA,
    PGV,
    _numbers,
    _statistic_of,
    curve_of_one_level,
    make_curve,
    rate_weights,
    rates_of,
    read_measure,
)
from rockfrag.base.errors import InputError
from rockfrag.motions.intensity import intensity_measures

from ..case_tables import case_tables
from .samples import SAMPLES, openquake_csv, quantile_files, rate

CASES = case_tables(__file__)


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", SAMPLES)
def test_every_kind_of_file_gives_the_rates_it_was_made_of(name, tmp_path):
    (curve,) = read_hazard([write(tmp_path, name, SAMPLES[name])])
    at = np.array([0.03, 0.1, 0.7])
    assert curve.rate(at) == pytest.approx([rate(x) for x in at], rel=1e-4)
    assert curve.level(rate(0.3)) == pytest.approx(0.3, rel=1e-4)


def test_measures_are_known_by_all_their_names():
    for text in ("SA(0.2)", "SA0P2", "sa_0.2s", "PSA-0.2s", "SA[0.2]"):
        assert read_measure(text, "here").imt == "SA(0.2)"
    assert read_measure("pga", "here") == PGA
    # they are those of tables and curves
    known = intensity_measures([0.2])
    assert {PGA, PGV, read_measure("SA(0.2)", "here")} <= set(known)


def test_files_of_one_measure_are_a_curve_with_its_quantiles_which_none_is_twice(
    tmp_path,
):
    paths = quantile_files(tmp_path, "PGA")
    other = write(tmp_path, "other.csv", openquake_csv(imt="SA(0.3)"))
    curve, spectral = read_hazard([*paths, other])
    assert (curve.measure.imt, spectral.measure.imt) == ("PGA", "SA(0.3)")
    assert list(curve.quantiles) == [0.16, 0.84]
    assert curve.quantiles[0.84].rate(0.1) == pytest.approx(0.015, rel=1e-4)
    with pytest.raises(InputError, match=r"only quantile.* of PGA is given"):
        read_hazard(paths[1:])
    with pytest.raises(InputError, match="twice"):
        read_hazard([other, other])


def test_one_level_passes_through_its_return_period():
    curve = curve_of_one_level(PGA, 0.25, 475)
    assert curve.rate(0.25) == pytest.approx(1 / 475)
    assert curve.rate(0.5) == pytest.approx(1 / 475 / 8)
    # a steeper one is lower above the level, and higher below it
    steep, flat = curve.quantiles[0.16], curve.quantiles[0.84]
    for factor in (0.8, 1.25):
        rates = [float(each.rate(0.25 * factor)) for each in (steep, curve, flat)]
        assert rates == sorted(rates, reverse=factor < 1)
        assert len(set(rates)) == 3


def test_weights_of_levels_integrate_over_a_hazard_curve():
    """Of a function that is linear in ln level, ∫ P dν of a power law in closed form; and of one, all its rate."""
    k, levels = 2.5, np.array([0.1, 0.2, 0.3, 0.8])
    curve = make_curve(PGA, [0.01, 10.0], [rate(0.01), rate(10.0)], "test")
    weights = rate_weights(curve, levels)
    assert weights.sum() == pytest.approx(rate(0.1))
    # ∫ ln(x/x0) k ν dx/x = (ν0 - νn)/k up to the last level, with what lies above at its value
    integral = (rate(0.1) - rate(0.8)) / k
    assert weights @ np.log(levels / 0.1) == pytest.approx(integral)


@pytest.mark.parametrize(("text", "words"), CASES["refused"])
def test_what_is_wrong_is_said_in_a_sentence(text, words, tmp_path):
    with pytest.raises(InputError, match=words):
        read_hazard([write(tmp_path, "hazard", text)])


@pytest.mark.parametrize(("name", "old", "new", "words"), CASES["damaged"])
def test_what_is_wrong_with_a_file_of_a_maker_is_said_in_a_sentence(
    name, old, new, words, tmp_path
):
    text = SAMPLES[name]
    wrong = text.replace(old, new) if old else text[:-20]
    with pytest.raises(InputError, match=words):
        read_hazard([write(tmp_path, "hazard", wrong)])


def test_a_file_that_is_absent_or_no_table_is_refused(tmp_path):
    with pytest.raises(InputError, match="damaged as a table"):
        read_hazard(
            [write(tmp_path, "long.csv", SAMPLES["openquake.csv"] + "9" * 140_000)]
        )
    binary = tmp_path / "x.csv"
    binary.write_bytes(b"\xff\xfe\x00\x01")
    for path in (tmp_path / "absent.csv", tmp_path, binary):
        with pytest.raises(InputError):
            read_hazard([path])


def test_probabilities_of_any_time_are_rates_of_poissons_law():
    for years in (0.5, 1.0, 50.0):
        found = rates_of([0.0, 0.1, 0.9, 1.0], years, "test")
        expected = [0.0, -math.log(0.9) / years, -math.log(0.1) / years, math.inf]
        assert found == pytest.approx(expected)
    for years in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(InputError, match="must be above 0 years"):
            rates_of([0.1], years, "test")
    # the one that is wrong is named
    for wrong in (-0.2, 1.5):
        with pytest.raises(InputError, match=f"test: {wrong:g} is no probability"):
            rates_of([0.0, 1.0, wrong], 50.0, "test")


def test_a_curve_through_one_level_is_told_from_one_that_was_read():
    assert not curve_of_one_level(PGA, 0.25, 475).is_read
    assert make_curve(PGA, [0.01, 10.0], [rate(0.01), rate(10.0)], "test").is_read


@pytest.mark.parametrize(
    ("about", "said"),
    [
        ("", ""),
        ('statistics="mean"', "mean"),
        ('statistics="quantile" quantileValue="0.84"', "quantile-0.84"),
        ('sourceModelTreePath="b1"', "branch of a logic tree"),
        # a mean has a path through no tree, whatever else is written there
        ('statistics="mean" sourceModelTreePath="b1"', "mean"),
    ],
)
def test_which_of_several_curves_an_element_holds_is_read(about, said):
    assert _statistic_of(ET.fromstring(f"<hazardCurves {about}/>")) == said


def test_nothing_but_numbers_is_taken_for_a_list_of_numbers():
    assert _numbers([1, 0.5]) == [1.0, 0.5]
    for wrong in ([0.1, True], [0.1, "0.2"], [None], "0.1", {"0": 0.1}):
        with pytest.raises(TypeError):
            _numbers(wrong)
