"""The thesis's specimens, which stand in the package and in a study's table."""

from dataclasses import astuple
from pathlib import Path

import pytest

from rockfrag.study.configurations import read_specimens
from rockfrag_thesis.hypotheses.evidence import THESIS_BODIES

ROOT = Path(__file__).resolve().parents[2]


def test_the_package_and_the_study_have_the_same_specimens():
    study = read_specimens(ROOT / "config" / "specimens.csv")
    assert list(study) == list(THESIS_BODIES)
    for name, body in THESIS_BODIES.items():
        assert astuple(study[name]) == pytest.approx(astuple(body))
