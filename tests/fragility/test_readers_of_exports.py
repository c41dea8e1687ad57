"""The programs that curves are written for read them, and find in them what the tables say.

OpenQuake and pelicun each want an environment of their own; these tests skip where they are absent.
"""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from rockfrag.fragility.exports import write_nrml, write_simcenter

pytestmark = pytest.mark.peers

STATES = ("rocks", "overturns")
CURVES = pd.DataFrame(
    {
        "configuration": ["urn", "urn", "bust", "bust"],
        "im": "PGA",
        "unit": "g",
        "state": STATES * 2,
        "theta": [0.25, 0.5, 0.2, 0.35],
        "beta": [1e-9, 0.3, 1e-9, 0.35],
    }
)
POINTS = pd.DataFrame(
    {
        "configuration": "urn",
        "state": "overturns",
        "x": [0.30, 0.34, 0.60, 0.70, 0.95],
        "fraction": [0.0, 0.45, 0.55, 0.9, 1.0],
    }
)


def expected(name: str, level: float) -> float:
    """Probability to overturn at a level, which is never above that to rock."""
    row = CURVES[(CURVES["configuration"] == name) & (CURVES["state"] == "overturns")].iloc[0]
    rocks = CURVES[CURVES["configuration"] == name].iloc[0]["theta"]
    if level < rocks * 0.95:
        return 0.0
    if name == "urn":
        return float(np.interp(np.log(level), np.log(POINTS["x"]), POINTS["fraction"]))
    return float(stats.norm.cdf(np.log(level / row["theta"]) / row["beta"]))


@pytest.mark.parametrize("level", [0.15, 0.32, 0.45, 0.65, 0.9])
def test_openquake_reads_levels_and_lognormal_functions(tmp_path, level):
    # it teaches the reader what a fragility model is
    pytest.importorskip("openquake.risklib.read_nrml", reason="openquake.engine is not installed")
    from openquake.hazardlib import nrml

    write_nrml(CURVES, tmp_path / "curves.xml", fractions=POINTS)
    model = nrml.to_python(str(tmp_path / "curves.xml"))
    functions = {item.id: item for item in model.values()}
    # the lognormal curve of the bust would overturn what does not rock
    assert {name: function.format for name, function in functions.items()} == {
        "urn": "discrete",
        "bust": "discrete",
    }
    for name, function in functions.items():
        rocks, falls = (
            float(state(np.array([level]))[0]) for state in function.build(list(STATES))
        )
        assert falls == pytest.approx(expected(name, level), abs=0.01)
        assert rocks >= falls


def test_pelicun_draws_as_many_overturned_as_the_curves_say(tmp_path):
    # an old pelicun is there and cannot be imported beside SciPy of today
    assessment = pytest.importorskip(
        "pelicun.assessment", reason="pelicun is not installed", exc_type=ImportError
    )
    paths = tmp_path / "curves.csv", tmp_path / "curves.json"
    write_simcenter(CURVES, *paths, fractions=POINTS)
    draws, level = 20_000, 0.45
    run = assessment.Assessment({"PrintLog": False, "Seed": 1, "Verbose": False})
    index = ["Units", *range(draws)]
    run.demand.load_sample(pd.DataFrame({"1-PGA-1-1": ["g"] + [level] * draws}, index=index))
    run.stories = 1
    names = list(pd.read_csv(paths[0])["ID"])
    places = {"Units": "ea", "Location": "1", "Direction": "1", "Theta_0": "1", "Blocks": "1"}
    run.asset.load_cmp_model({"marginals": pd.DataFrame(places | {"Family": None}, index=names)})
    run.asset.generate_cmp_sample(draws)
    run.damage.load_model_parameters([str(paths[0])], set(names))
    run.damage.calculate()
    fractions = run.damage.ds_model.sample.mean()
    for name in ("urn", "bust"):
        assert fractions[f"ROCKFRAG.{name}", "1", "1", "0", "2"] == pytest.approx(
            expected(name, level), abs=0.012
        )
