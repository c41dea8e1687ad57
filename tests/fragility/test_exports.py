"""Exports carry the same curve in the units and parameters that other programs read."""

import json
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from rockfrag.base.errors import InputError
from rockfrag.fragility.exports import (
    STEP,
    spread_points,
    write_nrml,
    write_simcenter,
)
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
        "x": [0.30, 0.34, 0.60, 0.70],
        "fraction": [0.0, 0.45, 0.55, 0.9],
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


def written(folder, curves, fractions=None, *, model_error=False):
    """What both files say of curves, which are left in the folder."""
    model, csv, story = (
        folder / name for name in ("model.xml", "damage.csv", "damage.json")
    )
    write_nrml(curves, model, fractions=fractions, model_error=model_error)
    write_simcenter(curves, csv, story, fractions=fractions, model_error=model_error)
    root = ElementTree.parse(model).getroot()
    return SimpleNamespace(
        text=model.read_text(),
        states=root.find(".//n:limitStates", SPACE).text,
        description=root.find(".//n:description", SPACE).text,
        functions={
            item.get("id"): item
            for item in root.findall(".//n:fragilityFunction", SPACE)
        },
        rows=pd.read_csv(csv).set_index("ID"),
        told=json.loads(story.read_text()),
    )


def test_median_and_dispersion_are_given_back_in_the_units_of_each_program(tmp_path):
    found = written(tmp_path, CURVES)
    assert found.states == "overturns"
    for name, imt, theta, beta in (("T1", "PGA", 0.5, 0.4), ("P_T1", "PGV", 30.0, 0.5)):
        params = found.functions[name].find("n:params", SPACE)
        mean, deviation = float(params.get("mean")), float(params.get("stddev"))
        sigma = np.sqrt(np.log1p((deviation / mean) ** 2))
        assert found.functions[name].find("n:imls", SPACE).get("imt") == imt
        assert sigma == pytest.approx(beta)
        assert mean / np.exp(sigma**2 / 2) == pytest.approx(theta)
    titles = "Incomplete Demand-Type Demand-Unit Demand-Offset Demand-Directional "
    titles += "LS1-Family LS1-Theta_0 LS1-Theta_1 LS1-DamageStateWeights"
    assert list(found.rows.columns) == titles.split()
    demand = ["Demand-Type", "Demand-Unit", "LS1-Theta_0", "LS1-Theta_1"]
    assert found.rows.loc["ROCKFRAG.T1", demand].tolist() == [
        *("Peak Ground Acceleration", "g"),
        *(0.5, 0.4),
    ]
    assert found.rows.loc["ROCKFRAG.P_T1", demand[:2]].tolist() == [
        "Peak Ground Velocity",
        "mps",
    ]
    assert set(found.told) == {"_GeneralInformation", *found.rows.index}
    state = found.told["ROCKFRAG.T1"]["LimitStates"]["LS1"]["DS1"]
    assert state["Description"] == "Overturned"


HOW_TO = Path(__file__).parents[2] / "docs" / "how-to" / "export.md"


@pytest.fixture
def shown(tmp_path, monkeypatch, capsys) -> str:
    """What the code of the page prints, which leaves its files in the folder."""
    monkeypatch.chdir(tmp_path)
    text = HOW_TO.read_text(encoding="utf-8")
    exec(text.split("```python\n")[1].split("```")[0], {})
    return capsys.readouterr().out.strip()


def test_the_page_shows_the_number_that_the_written_curve_gives(shown):
    """It stood at .95 % with an error of the model that had been found anew since."""
    assert f"It prints `{shown}`" in HOW_TO.read_text(encoding="utf-8")


def test_openquake_has_that_number_from_the_file(shown, tmp_path):
    pytest.importorskip(
        "openquake.risklib.read_nrml",
        reason="openquake.engine is not installed, or cannot run here",
        exc_type=ImportError,
    )
    from openquake.hazardlib import nrml
    from openquake.risklib import scientific

    model = nrml.to_python(str(tmp_path / "fragility.xml"))
    curve = model["PGA", "statue"].build(model.limitStates, 20, 1)
    levels = np.array([0.05, 0.1, 0.2, 0.4, 0.8, 1.6])
    rates = np.array([2e-2, 7e-3, 1.8e-3, 3.2e-4, 3.5e-5, 2e-6])
    edges = np.geomspace(0.05, 1.6, 400)
    exceeded = np.exp(np.interp(np.log(edges), np.log(levels), np.log(rates)))
    poes = -np.expm1(-50 * exceeded)
    _, toppled = scientific.classical_damage(curve, edges, poes, 50.0, 50.0)
    said = float(re.search(r"as written (.*)%", shown)[1]) / 100
    assert toppled == pytest.approx(said, rel=0.01)


def levels_of(function):
    assert function.get("format") == "discrete"
    levels = np.array(function.find("n:imls", SPACE).text.split(), dtype=float)
    return levels, {
        item.get("ls"): np.array(item.text.split(), dtype=float)
        for item in function.findall("n:poes", SPACE)
    }


def test_a_written_curve_holds_the_errors_of_estimate_and_model(tmp_path):
    """β of motions, estimate and model add as squares; the median and where rocking starts stay."""
    curves = CURVES.assign(beta_statistical=[0.1, np.nan])
    found = written(tmp_path, curves, model_error=True)
    blind = MODEL_ERRORS[CUT].blind
    for name, theta, parts in (
        ("T1", 0.5, (0.4, 0.1, blind)),
        ("P_T1", 30.0, (0.5, blind)),
    ):
        params = found.functions[name].find("n:params", SPACE)
        mean, deviation = float(params.get("mean")), float(params.get("stddev"))
        sigma = np.sqrt(np.log1p((deviation / mean) ** 2))
        assert sigma == pytest.approx(np.sqrt(np.square(parts).sum()))
        assert mean / np.exp(sigma**2 / 2) == pytest.approx(theta)
    assert "The curve as written holds all three" in found.text
    both = written(tmp_path, OF_TWO_STATES, model_error=True).rows
    assert both.loc["ROCKFRAG.bust", "LS1-Theta_1"] == STEP
    assert both.loc["ROCKFRAG.bust", "LS2-Theta_1"] == pytest.approx(
        np.hypot(0.35, blind)
    )


def test_points_of_a_rejected_curve_are_those_of_levels_known_to_a_factor():
    x, fraction = (POINTS_OF_URN[name].to_numpy() for name in ("x", "fraction"))
    levels, chance = spread_points(x, fraction, 0.3)
    assert (np.diff(chance) >= 0).all() and chance[0] < 1e-3 and chance[-1] > 0.999
    factors = np.exp(0.3 * stats.norm.ppf((np.arange(20_000) + 0.5) / 20_000))
    at, known = np.log([0.15, *x, 1.4]), [0.0, *fraction, 1.0]
    for level in (0.25, 0.5, 0.9):
        expected = np.interp(np.log(level * factors), at, known).mean()
        found = np.interp(np.log(level), np.log(levels), chance)
        assert found == pytest.approx(expected, abs=0.01)
    assert spread_points(x, fraction, 0.0) == (x, fraction)


@pytest.mark.parametrize("sigmas", [np.log(0.25 / 0.4) / 0.4, -3.24])
def test_nothing_that_does_not_rock_overturns_in_nrml(tmp_path, sigmas):
    """Lognormal curves say so: 12 % at the amplitude below which nothing rocks, or a small tail of 6e-4."""
    assert stats.norm.cdf(sigmas) > 5e-4
    theta = 0.25 * np.exp(-0.4 * sigmas)
    curves = OF_TWO_STATES[:2].assign(theta=[0.25, theta], beta=[1e-9, 0.4])
    levels, chance = levels_of(written(tmp_path, curves).functions["urn"])
    assert (chance["overturns"] <= chance["rocks"]).all()
    assert (chance["overturns"][levels < 0.24] < 1e-9).all()
    high = levels > 0.26
    lognormal = stats.norm.cdf(np.log(levels[high] / theta) / 0.4)
    assert chance["overturns"][high] == pytest.approx(lognormal, abs=1e-9)
    assert (np.diff(levels) > 0).all()


def test_rejected_curve_is_exported_as_its_points(tmp_path):
    found = written(tmp_path, OF_TWO_STATES, POINTS_OF_URN)
    levels, chance = levels_of(found.functions["urn"])
    fraction = np.interp(POINTS_OF_URN["x"], levels, chance["overturns"])
    assert fraction == pytest.approx(POINTS_OF_URN["fraction"].to_numpy(), abs=1e-9)
    row = found.rows.loc["ROCKFRAG.urn"]
    assert (row["LS1-Family"], row["LS2-Family"]) == ("lognormal", "multilinear_CDF")
    # nothing is known beyond the last level, and a distribution must end somewhere
    assert row["LS2-Theta_0"] == "0.3,0.34,0.6,0.7,1.4|0.0,0.45,0.55,0.9,1.0"
    assert "Beyond 0.7 g nothing was tried" in found.told["ROCKFRAG.urn"]["Comments"]


@pytest.mark.parametrize(
    ("curves", "said"),
    [
        (
            CURVES.assign(im="Arias intensity"),
            "Arias intensity is no intensity measure",
        ),
        (CURVES.assign(floor="F3"), "floor F3"),
        (CURVES.assign(theta=np.nan), "'T1' has no lognormal curve"),
        (pd.concat([CURVES, CURVES]), "'T1' has two curves"),
        (CURVES.iloc[:0], "there is no curve to write"),
        (OF_TWO_STATES[:3], "'bust' has no curve for the limit state overturns"),
    ],
)
def test_nrml_refuses_what_openquake_cannot_compute(tmp_path, curves, said):
    with pytest.raises(InputError, match=said):
        write_nrml(curves, tmp_path / "model.xml")
    assert not (tmp_path / "model.xml").exists()
    with pytest.raises(InputError, match="no demand of this export"):
        write_simcenter(
            CURVES.assign(unit="furlong"), tmp_path / "d.csv", tmp_path / "d.json"
        )


def test_the_tidy_table_has_every_reading_with_limits_over_earthquakes():
    table = fragility_table(synthetic_ida(), record_set="abc")
    assert list(table.configuration) == ["T1"] * 3 + ["T2"] * 3
    assert set(table.estimator) == {
        "mean_probability",
        "first_overturning",
        "always_overturning",
    }
    assert (table.resampled == "earthquake").all() and (table.groups == 3).all()
    assert table.warnings.str.contains("3 earthquakes the coverage").all()
    assert (table.theta_lower < table.theta).all() and (
        table.theta < table.theta_upper
    ).all()
    assert (table.record_set_sha256 == "abc").all()
    # without structural resurrections first and always are the same amplitude
    theta = table.pivot_table(
        index="configuration", columns="estimator", values="theta"
    )
    first, always = theta["first_overturning"], theta["always_overturning"]
    assert first.to_numpy() == pytest.approx(always.to_numpy(), rel=1e-12)
    assert first["T1"] == pytest.approx(0.5, rel=0.35)
    half = np.log(table.theta_upper / table.theta_lower) / 2
    statistical = half.to_numpy() / stats.norm.ppf(0.95)
    assert table.beta_statistical.to_numpy() == pytest.approx(statistical)
    squares = table.beta**2 + statistical**2 + MODEL_ERRORS[CUT].blind ** 2
    assert table.beta_total.to_numpy() == pytest.approx(np.sqrt(squares))


def test_measures_of_a_scaled_motion_follow_their_power_of_the_amplitude():
    ida = pd.DataFrame(
        {"motion": ["m", "m"], "amplitude_g": [0.2, 0.4], "overturned": [0, 1]}
    )
    columns = ["pga_g", "pgv_cm_s", "arias_m_s", "d5_95_s"]
    measures = pd.DataFrame([["m", 0.1, 10.0, 1.0, 8.0]], columns=["name", *columns])
    rows = with_measures(ida, measures, columns)
    expected = [[0.2, 20.0, 4.0, 8.0], [0.4, 40.0, 16.0, 8.0]]
    assert rows[columns].to_numpy() == pytest.approx(np.array(expected))
    assert scale_power("pgv_over_pga_s") == 0 and scale_power("sa_0_3s_g") == 1
    with pytest.raises(InputError, match="not known how it grows"):
        scale_power("colour")
    with pytest.raises(InputError, match="no row for motion 'm'"):
        with_measures(ida, measures.assign(name="other"), ["pga_g"])


def test_the_hash_of_a_record_set_sees_every_sample_and_no_order():
    a, b, c = (
        Motion(np.array([0.0, 1.0, k]), 0.01, name="m") for k in (2, 3, 3 + 1e-12)
    )
    b, c = replace(b, name="n"), replace(c, name="n")
    assert record_set_hash([a, b]) == record_set_hash([b, a]) != record_set_hash([a, c])


def curves_of(ida):
    """Curves in the amplitude as the ground's PGA, with a rocking state before overturning."""
    table = fragility_table(ida, record_set="abc")
    fallen = table[table.estimator == "mean_probability"].assign(state="overturns")
    rocks = fallen.assign(state="rocks", theta=0.2, beta=1e-6)
    return pd.concat([rocks, fallen], ignore_index=True)


def test_files_say_how_few_motions_a_curve_rests_on_and_what_is_known_of_it(tmp_path):
    ida = synthetic_ida()
    curves = curves_of(ida[ida.motion.isin(["m0", "m2", "m4", "m5"])])
    found = written(tmp_path, curves.iloc[::-1])
    for text in (found.text, found.told["ROCKFRAG.T1"]["Comments"]):
        for said in (
            "4 motions of 3 earthquakes",
            "90 % limits: theta",
            f"of the model {MODEL_ERRORS[CUT].blind:.3f}",
            f"of a {CUT}: {MODEL_ERRORS[CUT].words}",
            "Goodness of fit p = ",
            "based on only 4 motions",
        ):
            assert said in text
    assert "<!-- T1: rocks:" in found.text
    # a warning that all functions share is said once, and nothing is said twice
    assert found.text.count("based on only 4 motions") == 1
    assert found.description.count("based on only") == 1
    # limit states come in the order in which a body passes them
    assert found.states == "rocks overturns"
    curves = found.functions["T1"].findall("n:params", SPACE)
    assert [curve.get("ls") for curve in curves] == ["rocks", "overturns"]
    row = found.rows.loc["ROCKFRAG.T1"]
    # an exact threshold is written as steep as the formats take it
    assert (row["LS1-Theta_0"], row["LS1-Theta_1"]) == (0.2, 0.01)
    assert row["LS2-Theta_0"] > 0.2


def expected(name: str, level: float) -> float:
    """Probability to overturn at a level, which is never above that to rock."""
    rocks, falls = OF_TWO_STATES[OF_TWO_STATES["configuration"] == name].to_dict(
        "records"
    )
    if level < rocks["theta"] * 0.95:
        return 0.0
    if name == "urn":
        points = np.log(POINTS_OF_URN["x"]), POINTS_OF_URN["fraction"]
        return float(np.interp(np.log(level), *points))
    return float(stats.norm.cdf(np.log(level / falls["theta"]) / falls["beta"]))


@pytest.mark.peers
def test_openquake_reads_levels_and_lognormal_functions(tmp_path):
    # it teaches the reader what a fragility model is
    pytest.importorskip(
        "openquake.risklib.read_nrml", reason="openquake.engine is not installed"
    )
    from openquake.hazardlib import nrml

    write_nrml(
        OF_TWO_STATES,
        tmp_path / "curves.xml",
        fractions=POINTS_OF_URN,
        model_error=False,
    )
    model = nrml.to_python(str(tmp_path / "curves.xml"))
    functions = {item.id: item for item in model.values()}
    # the lognormal curve of the bust would overturn what does not rock
    formats = {name: function.format for name, function in functions.items()}
    assert formats == {"urn": "discrete", "bust": "discrete"}
    levels = np.array([0.15, 0.32, 0.45, 0.65, 0.7])
    for name, function in functions.items():
        rocks, falls = (state(levels) for state in function.build(list(STATES)))
        wanted = [expected(name, level) for level in levels]
        assert falls == pytest.approx(np.array(wanted), abs=0.01)
        assert (rocks >= falls).all()


@pytest.mark.peers
def test_pelicun_draws_as_many_overturned_as_the_curves_say(tmp_path):
    # an old pelicun is there and cannot be imported beside SciPy of today
    assessment = pytest.importorskip(
        "pelicun.assessment", reason="pelicun is not installed", exc_type=ImportError
    )
    paths = tmp_path / "curves.csv", tmp_path / "curves.json"
    write_simcenter(OF_TWO_STATES, *paths, fractions=POINTS_OF_URN, model_error=False)
    draws, level = 20_000, 0.45
    run = assessment.Assessment({"PrintLog": False, "Seed": 1, "Verbose": False})
    index = ["Units", *range(draws)]
    run.demand.load_sample(
        pd.DataFrame({"1-PGA-1-1": ["g"] + [level] * draws}, index=index)
    )
    run.stories = 1
    names = list(pd.read_csv(paths[0])["ID"])
    places = {
        "Units": "ea",
        "Location": "1",
        "Direction": "1",
        "Theta_0": "1",
        "Blocks": "1",
    }
    run.asset.load_cmp_model(
        {"marginals": pd.DataFrame(places | {"Family": None}, index=names)}
    )
    run.asset.generate_cmp_sample(draws)
    run.damage.load_model_parameters([str(paths[0])], set(names))
    run.damage.calculate()
    fractions = run.damage.ds_model.sample.mean()
    for name in ("urn", "bust"):
        assert fractions[f"ROCKFRAG.{name}", "1", "1", "0", "2"] == pytest.approx(
            expected(name, level), abs=0.012
        )
