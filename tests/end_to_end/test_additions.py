"""A law, a limit state, a measure and an engine, each by one declaration, go through a study to its report."""

import json
import math

import numpy as np
import pandas as pd
import pytest

from rockfrag import laws
from rockfrag.engines import contract
from rockfrag.engines.contract import Engine, Support, engines, register_engine
from rockfrag.laws import ratio
from rockfrag.motions.intensity import _MEASURES, intensity_measure
from rockfrag.outcomes.limit_states import _STATES, limit_state
from rockfrag.outcomes.outcomes import empty_outcomes

from .checked_report import run_and_check
from .studies import Foreign, alone


class Needles(Engine):
    """Answers that bodies of next to no width stand, for want of anything better."""

    name = "needles"
    meets = frozenset()

    def supports(self, system, motion, request):
        thin = system.bodies[0].width < 1e-3
        found = super().supports(system, motion, request)
        return found if thin else Support(reason="it is for needles")

    def run(self, cases):
        return empty_outcomes(cases.names, cases.scales, (self.name,))


@pytest.fixture
def additions(monkeypatch):
    """Declare one of each, and take them back."""
    monkeypatch.setattr(contract, "_ENGINES", list(engines()))
    monkeypatch.setattr(laws, "_LAWS", {law.name: law for law in laws.laws()})
    laws.declare("energy", lambda shape, kept, pivot: (ratio.NUMBER, math.sqrt(kept)))

    @limit_state(
        "turns_far",
        order=50,
        label="turning far",
        damage="Turned far",
        repair="Look at it",
    )
    def _(outcomes):
        return (np.nan_to_num(outcomes.peak_rotation) > 0.3).any(axis=-1)

    @intensity_measure(
        "g",
        power=1,
        label="RMS acceleration",
        compared=True,
        decimals=3,
        openquake="RMSA",
    )
    def rms(motion):
        return float(np.sqrt(np.mean(motion.acceleration**2)))

    register_engine(Needles(), before=engines()[0].name)
    yield rms
    del _MEASURES["rms"]
    del _STATES["turns_far"]


@pytest.mark.slow
def test_one_declaration_each_reaches_the_report(additions, tmp_path):
    bodies = {"specimens": "blocks.csv", "configurations": "configurations.csv"}
    bodies |= {"restitution": {"law": "energy", "blocks": {"column": 0.8}}}
    content = {
        "bodies": bodies,
        "amplitudes": {"lowest_g": 0.05, "highest_g": 2.0, "step_percent": 8},
        "fragility": {
            "measures": ["rms_g", ["rms_g", "pgv_over_pga_s"]],
            "confidence": 0.9,
        },
    }
    blocks = {"column": (30.0, 120.0, 110.0), "plinth": (60.0, 40.0, 350.0)}
    blocks["needle"] = (0.05, 60.0, 0.2)
    standing = {**alone("column"), "both": ("column", "plinth"), **alone("needle")}
    study = Foreign(
        blocks, standing, {name: name for name in "abcdef"}, content=content
    )
    results, page = run_and_check(study, tmp_path)
    # the engine answered for the needle, and only for it
    fell = pd.read_parquet(results / "ida/needle.parquet")["overturned"]
    column = pd.read_parquet(results / "ida/column.parquet")
    assert not fell.any() and column["overturned"].any()
    # the limit state is counted, has curves between rocking and overturning, and is exported
    assert column["turns_far"].sum() > column["overturned"].sum()
    floors = pd.read_parquet(results / "fragility_floors.parquet")
    order = floors.loc[floors["configuration"] == "column", "state"].unique().tolist()
    assert order == ["rocks", "turns_far", "overturns"]
    damage = json.loads((results / "exports/fragility_pga.json").read_text())
    assert (
        damage["ROCKFRAG.column"]["LimitStates"]["LS2"]["DS2"]["Description"]
        == "Turned far"
    )
    # the measure is in the table of motions, in curves, in their comparison and in files for other programs
    assert "rms_g" in pd.read_parquet(results / "measures.parquet")
    curves = pd.read_parquet(results / "fragility.parquet")
    assert set(curves["im"]) == {"RMS acceleration"} and set(curves["unit"]) == {"g"}
    assert "rms_g" in set(
        pd.read_parquet(results / "measure_selection.parquet")["measure"]
    )
    assert (
        'imt="RMSA"' in (results / "exports/fragility_rms_acceleration.xml").read_text()
    )
    words = " ".join(page.words)
    assert "RMS acceleration [g]" in words and "turning far" in words
