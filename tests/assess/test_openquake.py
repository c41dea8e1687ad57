"""OpenQuake's own risk calculator reads the exported function and gives the same probability."""

import json
from pathlib import Path

import numpy as np
import pytest

from rockfrag.assess.answer import assess_with
from rockfrag.assess.page import write_answer
from rockfrag.assess.request import make_request

pytestmark = pytest.mark.peers


def test_the_probability_is_that_of_openquakes_risk_calculator(motions, tmp_path):
    scientific = pytest.importorskip(
        "openquake.risklib.scientific", reason="openquake.engine is not installed"
    )
    from openquake.hazardlib import nrml

    (tmp_path / "hazard.csv").write_text(
        "pga_g,annual_rate\n0.01,0.3\n0.05,0.04\n0.12,0.009\n0.4,0.0006\n1.1,0.00002\n6,1e-7\n"
    )
    settings = {"name": "figure", "width": "35 cm", "height": "120 cm", "hazard": ["hazard.csv"]}
    page = write_answer(assess_with(make_request(settings, "test", tmp_path), motions), tmp_path)
    answer = json.loads(page.with_suffix(".json").read_text(encoding="utf-8"))
    levels = np.array(answer["fragility"]["levels"])
    known, rates = (np.array(answer["hazard"][key]) for key in ("levels", "annual_rates"))
    fine = np.geomspace(levels[0], levels[-1], 1000)
    poes = 1 - np.exp(-50 * np.exp(np.interp(np.log(fine), np.log(known), np.log(rates))))
    (function,) = nrml.to_python(str(Path(page).with_suffix(".xml"))).values()
    _, toppled = scientific.classical_damage(
        function.build(["overturned"], None, 0.0), fine, poes, 50, 50, 1
    )
    assert float(toppled) == pytest.approx(answer["probability"]["value"], rel=0.01)
