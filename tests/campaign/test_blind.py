"""Blind answers: no outcome is used, the interval holds the truth, and the model error is what campaigns print."""

import contextlib
import io
import math
import re

import numpy as np
import pytest
from scipy import stats

from rockfrag.base.errors import InputError
from rockfrag.campaign.comparison import MeasuredTests
from rockfrag.campaign.standing import LEAST_ANGLE_DEG, draw_arrangements, unknowns_of
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS, SCAN
from rockfrag.stages.model_error import (
    PRIOR,
    BlindAnswer,
    blind_answer,
    main,
    model_error,
)
from rockfrag.system.blocks import Block

from .conftest import PEDESTAL, configured, granite


def fallen(measure, theta, beta, random):
    return random.random(len(measure)) < stats.norm.cdf(np.log(measure / theta) / beta)


def test_a_model_that_errs_by_a_factor_is_seen_to_err_by_it():
    random = np.random.default_rng(4)
    measure = np.exp(random.uniform(-1.5, 1.5, 1200))
    groups = np.arange(1200) % 60
    measured = fallen(measure, 1.0, 0.4, random)
    ways = np.array(
        [fallen(measure, 1.4 * f, 0.4, random) for f in np.geomspace(0.8, 1.25, 21)]
    )
    found = blind_answer(MeasuredTests(measured, groups, 1), measure, ways)
    assert found.error == pytest.approx(math.log(1.4), abs=0.1)
    # quartiles of an even spread, as those of a normal
    assert found.arrangement_spread == pytest.approx(
        math.log(1.25 / 0.8) / 2 / 1.349, rel=0.3
    )
    low, high = found.interval()
    assert low < found.lower < found.median < found.upper < high
    # outcomes of the laboratory move the measured median only
    more = MeasuredTests(fallen(measure, 1.3, 0.4, random), groups, 1)
    other = blind_answer(more, measure, ways)
    assert other.median == found.median and other.measured > 1.2 * found.measured


def seen(error: float, ways: float, limitless: float = 0.0) -> BlindAnswer:
    """A body whose simulated medians lie by a factor off, of which a part has no upper limit."""
    medians = np.exp(error + ways * stats.norm.ppf((np.arange(400) + 0.5) / 400))
    medians[: round(limitless * 400)] = np.inf
    low, middle, high = np.quantile(medians, [0.05, 0.5, 0.95], method="nearest")
    return BlindAnswer(1.0, middle, low, high, 0.05, 0.4, medians)


def test_errors_beyond_the_ways_to_stand_are_found_and_those_they_explain_are_not():
    """Bodies whose medians are off by 0.35 beyond ways that spread by 0.1; then by what ways explain."""
    random = np.random.default_rng(8)
    off = [seen(float(e), 0.1) for e in random.normal(0, np.hypot(0.35, 0.1), 20)]
    assert model_error(off)[1] == pytest.approx(0.35, rel=0.25)
    explained = [seen(float(e), 0.4) for e in random.normal(0, 0.4, 60)]
    assert model_error(explained)[1] < 0.2


def test_one_body_without_an_upper_limit_erases_nothing_that_others_show():
    others = [seen(0.5, 0.05), seen(-0.5, 0.05), seen(0.5, 0.05)]
    _, without = model_error(others)
    _, with_it = model_error([*others, seen(0.0, 0.3, limitless=0.6)])
    assert without > 0.35
    assert with_it > 0.9 * without
    # and a body of which no way has a limit says nothing at all
    assert model_error([*others, seen(0.0, 0.3, limitless=1.0)])[1] == pytest.approx(
        without
    )


def test_ways_in_which_all_topples_leave_the_blind_interval_without_a_lower_limit():
    ways = np.array([0.0, 0.0, 0.8, 1.0, 1.2])
    low, high = BlindAnswer(1.0, 0.8, 0.0, 1.2, 0.05, 0.4, ways).interval()
    assert low == 0.0 and 1.2 < high < np.inf


def test_luck_is_no_proof_of_a_model_without_error():
    assert model_error([seen(0.0, 0.05)])[1] > 0.05
    assert model_error([])[1] == pytest.approx(PRIOR, rel=0.01)


def test_the_transform_of_the_measured_median_is_its_place_among_the_ways():
    assert seen(0.0, 0.3).transform(0.0) == pytest.approx(0.5, abs=0.01)
    assert seen(0.6, 0.3).transform(0.0) == pytest.approx(stats.norm.cdf(-2), abs=0.01)
    assert seen(0.6, 0.3).transform(0.6) > 0.15


def test_a_cut_block_leaves_less_open_than_a_scan():
    scan, cut = unknowns_of(SCAN), unknowns_of(CUT)
    for name in cut:
        width = [item[name](0.95) - item[name](0.05) for item in (scan, cut)]
        assert width[1] < width[0]
    stated = unknowns_of(SCAN, 0.5)["contact_tolerance_mm"]
    guessed = scan["contact_tolerance_mm"]
    assert stated(0.5) == guessed(0.5) and stated(0.95) < guessed(0.95)
    ways = draw_arrangements(Block(0.1, 0.8, 30.0), cut, 64, 1)
    assert (
        ways.table["width_m"].between(0.096, 0.1).all()
        and ways.table["width_m"].std() > 5e-4
    )
    with pytest.raises(InputError, match=f"stand at {LEAST_ANGLE_DEG:g}"):
        draw_arrangements(Block(0.02, 0.8, 30.0), cut, 64, 1)


def test_the_command_prints_the_error_of_a_synthetic_laboratory(
    tmp_path, laboratory, capsys
):
    assert main([str(configured(tmp_path, laboratory))]) == 0
    said = capsys.readouterr().out
    error = float(re.search(r"ln ratio (-?[\d.]+)", said)[1])
    # the outcomes are those of the model itself, with edges up to 2 mm of 40 mm further out than the guesses
    assert -2 * 2 / 40 < error < 0.03
    assert re.search(
        rf"{CUT}: blind 0\.\d+, beyond the ways to stand 0\.\d+ of ln median", said
    )
    unknowns = {"edge_retreat_mm": [0, 2], "friction": [0.1, 0.2]}
    path = configured(
        tmp_path, laboratory, object__pedestal=PEDESTAL, unknowns=unknowns
    )
    for wrong, words in (
        (path, "object.pedestal"),
        (tmp_path / "absent.yaml", "absent.yaml"),
    ):
        assert main([str(wrong)]) == 2
        assert words in capsys.readouterr().err


@pytest.fixture(scope="module")
def said_of_granite(tmp_path_factory, shared) -> str:
    with contextlib.redirect_stdout(io.StringIO()) as said:
        assert main([str(granite(tmp_path_factory.mktemp("granite"), shared))]) == 0
    return said.getvalue()


@pytest.mark.slow
def test_the_stated_model_error_is_what_the_command_prints(said_of_granite):
    said = re.search(
        r"scan: blind ([\d.]+), beyond the ways to stand ([\d.]+)", said_of_granite
    )
    stated = MODEL_ERRORS[SCAN]
    assert (float(said[1]), float(said[2])) == (stated.blind, stated.beyond)
    assert "published" in MODEL_ERRORS[CUT].words or "Kaneko" in MODEL_ERRORS[CUT].words


@pytest.mark.slow
def test_the_blind_interval_of_the_granite_rock_holds_what_was_measured(
    said_of_granite,
):
    """Seen in space: 12.0 cm/s (8.5 to 14.7) against 13.9 measured."""
    numbers = r"([\d.]+) blind \(([\d.]+) to ([\d.]+), without model error\), ([\d.]+) measured"
    median, low, high, measured = map(
        float, re.search(numbers, said_of_granite).groups()
    )
    assert low < measured < high
    assert max(median / low, high / median) < 2.2
