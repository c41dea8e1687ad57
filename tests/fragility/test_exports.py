"""Exports carry the same curve in the units and parameters that other programs read."""

import json
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from rockfrag.errors import InputError
from rockfrag.fragility.exports import write_nrml, write_simcenter
from rockfrag.fragility.ida_curves import (
    fragility_table,
    record_set_hash,
    scale_power,
    with_measures,
)
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS
from rockfrag.records.motion import Motion

from .made import ida_of

SPACE = {"n": "http://openquake.org/xmlns/nrml/0.5"}
CURVES = pd.DataFrame(
    {
        "configuration": ["T1", "P&T1"],
        "im": ["PGA", "PGV"],
        "unit": ["g", "m/s"],
        "theta": [0.5, 0.3],
        "beta": [0.4, 0.5],
    }
)


def synthetic_ida():
    """Two configurations under six synthetic motions of three earthquakes, at common amplitudes."""
    rng, levels = np.random.default_rng(1), np.geomspace(0.05, 2.0, 75)
    parts = [
        ida_of(theta * np.exp(0.3 * rng.normal(size=6)), levels, name, each=2)
        for name, theta in (("T1", 0.5), ("T2", 0.3))
    ]
    return pd.concat(parts, ignore_index=True)


def functions_of(path):
    """Functions of an NRML file by their names, and the file's root."""
    root = ElementTree.parse(path).getroot()
    return {item.get("id"): item for item in root.findall(".//n:fragilityFunction", SPACE)}, root


def test_nrml_gives_back_median_and_dispersion_in_its_own_units(tmp_path):
    path = tmp_path / "model.xml"
    write_nrml(CURVES, path)
    functions, root = functions_of(path)
    assert root.find(".//n:limitStates", SPACE).text == "overturns"
    for name, imt, theta, beta in (("T1", "PGA", 0.5, 0.4), ("P_T1", "PGV", 30.0, 0.5)):
        params = functions[name].find("n:params", SPACE)
        mean, deviation = float(params.get("mean")), float(params.get("stddev"))
        found = np.sqrt(np.log1p((deviation / mean) ** 2))
        assert functions[name].find("n:imls", SPACE).get("imt") == imt
        assert found == pytest.approx(beta)
        assert mean / np.exp(found**2 / 2) == pytest.approx(theta)


def states_of_one(theta=0.4):
    """Rocking at exactly 0.25 g, and overturning whose lognormal curve begins below it."""
    states = {"state": ["rocks", "overturns"], "theta": [0.25, theta], "beta": [1e-9, 0.4]}
    return pd.DataFrame({"configuration": "urn", "im": "PGA", "unit": "g", **states})


def levels_of(path):
    (function,) = functions_of(path)[0].values()
    assert function.get("format") == "discrete"
    levels = np.array(function.find("n:imls", SPACE).text.split(), dtype=float)
    return levels, {
        item.get("ls"): np.array(item.text.split(), dtype=float)
        for item in function.findall("n:poes", SPACE)
    }


@pytest.mark.parametrize("sigmas", [np.log(0.25 / 0.4) / 0.4, -3.24])
def test_nothing_that_does_not_rock_overturns_in_nrml(tmp_path, sigmas):
    """Lognormal curves say so: 12 % at the amplitude below which nothing rocks, or a small tail of 6e-4."""
    assert stats.norm.cdf(sigmas) > 5e-4
    theta = 0.25 * np.exp(-0.4 * sigmas)
    write_nrml(states_of_one(theta), tmp_path / "model.xml")
    levels, chance = levels_of(tmp_path / "model.xml")
    assert (chance["overturns"] <= chance["rocks"]).all()
    assert (chance["overturns"][levels < 0.24] < 1e-9).all()
    high = levels > 0.26
    lognormal = stats.norm.cdf(np.log(levels[high] / theta) / 0.4)
    assert chance["overturns"][high] == pytest.approx(lognormal, abs=1e-9)
    assert (np.diff(levels) > 0).all()


def test_rejected_curve_is_exported_as_its_points(tmp_path):
    points = pd.DataFrame(
        {
            "configuration": "urn",
            "state": "overturns",
            "x": [0.3, 0.5, 0.6, 0.8],
            "fraction": [0.0, 0.3, 0.4, 0.9],
        }
    )
    write_nrml(states_of_one(), tmp_path / "model.xml", fractions=points)
    levels, chance = levels_of(tmp_path / "model.xml")
    found = np.interp(points["x"], levels, chance["overturns"])
    assert found == pytest.approx(points["fraction"].to_numpy(), abs=1e-9)
    csv, story = tmp_path / "damage.csv", tmp_path / "damage.json"
    write_simcenter(states_of_one(), csv, story, fractions=points)
    row = pd.read_csv(csv).iloc[0]
    assert (row["LS1-Family"], row["LS2-Family"]) == ("lognormal", "multilinear_CDF")
    at, fraction = (
        np.array(part.split(","), dtype=float) for part in row["LS2-Theta_0"].split("|")
    )
    # nothing is known beyond the last level, and a distribution must end somewhere
    assert at.tolist() == [0.3, 0.5, 0.6, 0.8, 1.6] and fraction[-1] == 1.0
    assert (
        "Beyond 0.8 g nothing was tried"
        in json.loads(story.read_text())["ROCKFRAG.urn"]["Comments"]
    )


@pytest.mark.parametrize(
    ("curves", "said"),
    [
        (CURVES.assign(im="Arias intensity"), "Arias intensity is no intensity measure"),
        (CURVES.assign(floor="F3"), "floor F3"),
        (CURVES.assign(theta=np.nan), "'T1' has no lognormal curve"),
        (pd.concat([CURVES, CURVES]), "'T1' has two curves"),
        (CURVES.iloc[:0], "there is no curve to write"),
    ],
)
def test_nrml_refuses_what_openquake_cannot_compute(tmp_path, curves, said):
    with pytest.raises(InputError, match=said):
        write_nrml(curves, tmp_path / "model.xml")
    assert not (tmp_path / "model.xml").exists()


def test_simcenter_rows_carry_theta_and_beta_and_their_story(tmp_path):
    csv, story = tmp_path / "damage.csv", tmp_path / "damage.json"
    write_simcenter(CURVES.assign(im=["PGA", "PFV"]), csv, story)
    table = pd.read_csv(csv)
    titles = "ID Incomplete Demand-Type Demand-Unit Demand-Offset Demand-Directional "
    titles += "LS1-Family LS1-Theta_0 LS1-Theta_1 LS1-DamageStateWeights"
    assert list(table.columns) == titles.split()
    rows = table.set_index("ID")
    assert rows.loc["ROCKFRAG.T1", "Demand-Type"] == "Peak Ground Acceleration"
    assert rows.loc["ROCKFRAG.P_T1", "Demand-Type"] == "Peak Floor Velocity"
    assert rows.loc["ROCKFRAG.P_T1", "Demand-Unit"] == "mps"
    assert tuple(rows.loc["ROCKFRAG.T1", ["LS1-Theta_0", "LS1-Theta_1"]]) == (0.5, 0.4)
    told = json.loads(story.read_text())
    assert set(told) == {"_GeneralInformation", *rows.index}
    assert told["ROCKFRAG.T1"]["LimitStates"]["LS1"]["DS1"]["Description"] == "Overturned"
    with pytest.raises(InputError, match="no demand of this export"):
        write_simcenter(CURVES.assign(unit="furlong"), csv, story)


def test_the_tidy_table_has_every_reading_with_limits_over_earthquakes(tmp_path):
    table = fragility_table(synthetic_ida(), record_set="abc")
    assert list(table.configuration) == ["T1"] * 3 + ["T2"] * 3
    assert set(table.estimator) == {"mean_probability", "first_overturning", "always_overturning"}
    assert (table.resampled == "earthquake").all() and (table.groups == 3).all()
    assert table.warnings.str.contains("3 earthquakes the coverage").all()
    assert (table.theta_lower < table.theta).all() and (table.theta < table.theta_upper).all()
    assert (table.record_set_sha256 == "abc").all()
    first = table[table.estimator == "first_overturning"].set_index("configuration")
    write_nrml(table[table.estimator == "first_overturning"], tmp_path / "model.xml")
    # without structural resurrections first and always are the same amplitude
    always = table[table.estimator == "always_overturning"].set_index("configuration")
    assert first.theta.to_numpy() == pytest.approx(always.theta.to_numpy(), rel=1e-12)
    assert first.loc["T1", "theta"] == pytest.approx(0.5, rel=0.35)


def test_measures_of_a_scaled_motion_follow_their_power_of_the_amplitude():
    ida = pd.DataFrame({"motion": ["m", "m"], "amplitude_g": [0.2, 0.4], "overturned": [0, 1]})
    measures = pd.DataFrame(
        {"name": ["m"], "pga_g": [0.1], "pgv_cm_s": [10.0], "arias_m_s": [1.0], "d5_95_s": [8.0]}
    )
    rows = with_measures(ida, measures, ["pga_g", "pgv_cm_s", "arias_m_s", "d5_95_s"])
    assert rows.pga_g.tolist() == [0.2, 0.4]
    assert rows.pgv_cm_s.tolist() == pytest.approx([20.0, 40.0])
    assert rows.arias_m_s.tolist() == pytest.approx([4.0, 16.0])
    assert rows.d5_95_s.tolist() == [8.0, 8.0]
    assert scale_power("pgv_over_pga_s") == 0 and scale_power("sa_0_3s_g") == 1
    with pytest.raises(InputError, match="not known how it grows"):
        scale_power("colour")
    with pytest.raises(InputError, match="no row for motion 'm'"):
        with_measures(ida, measures.assign(name="other"), ["pga_g"])


def test_the_hash_of_a_record_set_sees_every_sample_and_no_order():
    a, b = (Motion(np.array([0.0, 1.0, k]), 0.01, name=f"m{k}") for k in (2, 3))
    changed = Motion(np.array([0.0, 1.0, 3.0 + 1e-12]), 0.01, name="m3")
    assert record_set_hash([a, b]) == record_set_hash([b, a])
    assert record_set_hash([a, changed]) != record_set_hash([a, b])


def curves_of(ida):
    """Curves in the amplitude as the ground's PGA, with a rocking state before overturning."""
    table = fragility_table(ida, record_set="abc")
    fallen = table[table.estimator == "mean_probability"].assign(state="overturns")
    rocks = fallen.assign(state="rocks", theta=0.2, beta=1e-6)
    return pd.concat([rocks, fallen], ignore_index=True)


def test_files_say_how_few_motions_a_curve_rests_on_and_what_is_known_of_it(tmp_path):
    ida = synthetic_ida()
    curves = curves_of(ida[ida.motion.isin(["m0", "m2", "m4", "m5"])])
    write_nrml(curves, tmp_path / "model.xml")
    write_simcenter(curves, tmp_path / "d.csv", tmp_path / "d.json")
    description = functions_of(tmp_path / "model.xml")[1].find(".//n:description", SPACE).text
    said = (tmp_path / "model.xml").read_text()
    told = json.loads((tmp_path / "d.json").read_text())["ROCKFRAG.T1"]["Comments"]
    for text in (said, told):
        assert "4 motions of 3 earthquakes" in text
        assert (
            "90 % limits: theta" in text and f"of the model {MODEL_ERRORS[CUT].blind:.3f}" in text
        )
        assert f"of a {CUT}: {MODEL_ERRORS[CUT].words}" in text
        assert "Goodness of fit p = " in text
        assert "based on only 4 motions" in text
    assert "<!-- T1: rocks:" in said
    # a warning that all functions share is said once, and nothing is said twice
    assert said.count("based on only 4 motions") == description.count("based on only") == 1


def test_limit_states_come_in_the_order_in_which_a_body_passes_them(tmp_path):
    curves = curves_of(synthetic_ida())
    write_nrml(curves.iloc[::-1], tmp_path / "model.xml")
    functions, root = functions_of(tmp_path / "model.xml")
    assert root.find(".//n:limitStates", SPACE).text == "rocks overturns"
    function = functions["T1"]
    kinds = ("n:params", "n:poes")
    states = [item.get("ls") for kind in kinds for item in function.findall(kind, SPACE)]
    assert states == ["rocks", "overturns"]
    write_simcenter(curves.iloc[::-1], tmp_path / "d.csv", tmp_path / "d.json")
    row = pd.read_csv(tmp_path / "d.csv").iloc[0]
    # an exact threshold is written as steep as the formats take it
    assert (row["LS1-Theta_0"], row["LS1-Theta_1"]) == (0.2, 0.01)
    assert row["LS2-Theta_0"] > 0.2
    with pytest.raises(InputError, match="'T2' has no curve for the limit state rocks"):
        write_nrml(curves[~((curves.configuration == "T2") & (curves.state == "rocks"))], "x")


def test_uncertainties_of_motions_estimate_and_model_add_as_squares():
    row = fragility_table(synthetic_ida()).iloc[1]
    half = np.log(row.theta_upper / row.theta_lower) / 2
    assert row.beta_statistical == pytest.approx(half / stats.norm.ppf(0.95))
    squares = row.beta**2 + row.beta_statistical**2 + MODEL_ERRORS[CUT].blind ** 2
    assert row.beta_total == pytest.approx(np.sqrt(squares))


STATES = ("rocks", "overturns")
OF_TWO_STATES = pd.DataFrame(
    {
        "configuration": ["urn", "urn", "bust", "bust"],
        "im": "PGA",
        "unit": "g",
        "state": STATES * 2,
        "theta": [0.25, 0.5, 0.2, 0.35],
        "beta": [1e-9, 0.3, 1e-9, 0.35],
    }
)
POINTS_OF_URN = pd.DataFrame(
    {
        "configuration": "urn",
        "state": "overturns",
        "x": [0.30, 0.34, 0.60, 0.70, 0.95],
        "fraction": [0.0, 0.45, 0.55, 0.9, 1.0],
    }
)


def expected(name: str, level: float) -> float:
    """Probability to overturn at a level, which is never above that to rock."""
    row = OF_TWO_STATES[
        (OF_TWO_STATES["configuration"] == name) & (OF_TWO_STATES["state"] == "overturns")
    ].iloc[0]
    rocks = OF_TWO_STATES[OF_TWO_STATES["configuration"] == name].iloc[0]["theta"]
    if level < rocks * 0.95:
        return 0.0
    if name == "urn":
        return float(
            np.interp(np.log(level), np.log(POINTS_OF_URN["x"]), POINTS_OF_URN["fraction"])
        )
    return float(stats.norm.cdf(np.log(level / row["theta"]) / row["beta"]))


@pytest.mark.peers
@pytest.mark.parametrize("level", [0.15, 0.32, 0.45, 0.65, 0.9])
def test_openquake_reads_levels_and_lognormal_functions(tmp_path, level):
    # it teaches the reader what a fragility model is
    pytest.importorskip("openquake.risklib.read_nrml", reason="openquake.engine is not installed")
    from openquake.hazardlib import nrml

    write_nrml(OF_TWO_STATES, tmp_path / "curves.xml", fractions=POINTS_OF_URN)
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


@pytest.mark.peers
def test_pelicun_draws_as_many_overturned_as_the_curves_say(tmp_path):
    # an old pelicun is there and cannot be imported beside SciPy of today
    assessment = pytest.importorskip(
        "pelicun.assessment", reason="pelicun is not installed", exc_type=ImportError
    )
    paths = tmp_path / "curves.csv", tmp_path / "curves.json"
    write_simcenter(OF_TWO_STATES, *paths, fractions=POINTS_OF_URN)
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
