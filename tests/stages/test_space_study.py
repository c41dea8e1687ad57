"""A study of bodies in space: medians under both components over those of planar rocking."""

import math

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.rocking.space_medians import PLANAR, median
from rockfrag.stages import space as stage
from rockfrag.study.loading import any_study
from rockfrag.study.space import SpaceStudy

from ..stages_in_process import run_stages

SMALL = {
    "study": "space",
    "title": "Bodies in space",
    "seed": 1,
    "space": {
        "every": 1,
        "bases": ["square", "round"],
        "slenderness": [4],
        "heights_m": [1.0],
        "levels": 8,
        "lowest": 0.7,
        "highest": 6.0,
        "directions": 4,
        "resamples": 20,
    },
}


def test_a_median_lies_between_the_levels_where_half_is_passed():
    levels = np.array([1.0, 2.0, 4.0])
    assert median(np.array([0.0, 0.25, 0.75]), levels) == pytest.approx(2 * math.sqrt(2))
    # where more shaking topples fewer, the first half counts
    assert median(np.array([0.4, 0.6, 0.2]), levels) == pytest.approx(math.sqrt(2))
    assert math.isnan(median(np.array([0.6, 0.7, 0.8]), levels))
    assert math.isnan(median(np.array([0.1, 0.2, 0.3]), levels))


def test_a_study_of_bodies_in_space_gives_medians_and_a_report(tmp_path, monkeypatch, made_motions):
    motions = made_motions(12)
    pairs = list(zip(motions[::2], motions[1::2], strict=True))
    names = [str(first.metadata["earthquake"]) for first, _ in pairs]
    monkeypatch.setattr(stage, "wide_set", lambda every: (pairs[::every], names[::every]))
    study = any_study(SMALL, "space.yaml")
    assert isinstance(study, SpaceStudy)
    folder = run_stages(study, tmp_path)
    medians = stage.pd.read_parquet(folder / "medians.parquet")
    assert list(zip(medians["base"], medians["planar_impacts"], strict=True)) == [
        ("square", "momentum"),
        ("round", "momentum"),
        ("round", "none"),
    ]
    assert (medians["flip_rate"].between(0, 1)).all()
    for name in PLANAR:
        assert (medians[f"{name}_lower"] <= medians[f"{name}_upper"]).all()
    fractions = stage.pd.read_parquet(folder / "fractions.parquet")
    assert len(fractions) == 3 * 8
    # every direction that topples is among those of which the worst is taken
    assert (fractions["worst_direction"] >= fractions["mean_direction"]).all()
    # planar impacts that lose nothing change the planar answers only
    lossless = fractions["planar_impacts"] == "none"
    rolls = fractions[(fractions["base"] == "round") & ~lossless]
    np.testing.assert_array_equal(fractions[lossless]["space"], rolls["space"])
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "Base round: in space" in page


def test_a_base_that_is_not_known_is_told():
    with pytest.raises(InputError, match="bases"):
        any_study(SMALL | {"space": SMALL["space"] | {"bases": ["oval"]}}, "space.yaml")
