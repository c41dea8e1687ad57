"""Survival reweights hazard: closed forms, drawn histories, and the command with its files or one sentence."""

import csv
import json
import math
import os
import re
import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
from scipy import special

from rockfrag.assess.hazard.curve import PGA, PGV, HazardCurve
from rockfrag.base.errors import InputError
from rockfrag.cli.main import main
from rockfrag.survival.constrained_page import page_of
from rockfrag.survival.reweight import SAMPLES, Reweighted, constrain, reweight, scaled
from rockfrag.survival.site import (
    Age,
    Branch,
    Site,
    StandingObject,
    VelocityRatio,
    lognormal_coefficients,
    read_branches,
    read_site,
)
from rockfrag.words.catalogue import TEXTS

from ..assess.samples import openquake_csv
from ..case_tables import case_tables

SLOPE = 2.5


def power_law(k0: float, slope: float = SLOPE) -> HazardCurve:
    """H(x) = k0 x^-slope."""
    levels = np.geomspace(0.01, 5.0, 25)
    return HazardCurve(PGA, levels, k0 * levels**-slope, "made")


def made_branches(*factors: float, weights: list[float] | None = None) -> list[Branch]:
    fractions = weights or [1 / len(factors)] * len(factors)
    return [
        Branch(f"factor {f:g}", w, {PGA: power_law(1e-4 * f)})
        for f, w in zip(factors, fractions, strict=True)
    ]


def rock(
    years: float,
    theta: float = 0.4,
    beta: float = 0.3,
    sd: float = 0.0,
    name: str = "rock",
):
    age = Age(years, years)
    return StandingObject(name, PGA, lognormal_coefficients(theta, beta), sd, age)


def weighed(branches, objects, samples=SAMPLES, **more) -> Reweighted:
    return reweight(Site("here", tuple(branches), tuple(objects), **more), samples)


def test_no_time_leaves_the_weights_as_do_equal_branches_and_long_time_leaves_the_gentlest():
    found = weighed(made_branches(1.0, 1.0, 1.0), [rock(3000, sd=0.3)])
    assert found.weights == pytest.approx([1 / 3] * 3)
    assert found.information == pytest.approx(0.0, abs=1e-12)
    branches = made_branches(0.5, 1.0, 2.0, weights=[0.2, 0.5, 0.3])
    assert weighed(branches, [rock(1e-9)]).weights == pytest.approx([0.2, 0.5, 0.3])
    assert weighed(branches, [rock(1e6)]).weights == pytest.approx(
        [1.0, 0.0, 0.0], abs=1e-12
    )


def test_independent_objects_multiply_and_identical_ones_with_shared_error_do_not():
    branches = made_branches(0.5, 1.0, 2.0)
    first, other = rock(2000, sd=0.4, name="one"), rock(2000, sd=0.4, name="other")
    alone = weighed(branches, [first]).log_survival
    apart = weighed(branches, [first, other], shared_error=0.0, same_earthquakes=False)
    assert apart.log_survival == pytest.approx(2 * alone, rel=5e-3)
    together = weighed(
        branches, [first, other], shared_error=1.0, same_earthquakes=False
    )
    assert (together.log_survival > 2 * alone + 0.02).all()


def test_an_object_that_came_later_is_exposed_to_fewer_earthquakes():
    branches = made_branches(1.0, 2.0)
    old, young = rock(2000, theta=0.4, name="old"), rock(500, theta=0.3, name="young")
    found = weighed(branches, [old, young])
    for k0, value in zip((1e-4, 2e-4), found.log_survival, strict=True):
        x = np.geomspace(1e-3, 50, 20_001)
        fall = -np.diff(k0 * x**-SLOPE)
        middle = np.sqrt(x[1:] * x[:-1])
        p_old, p_young = (
            special.ndtr(np.log(middle / theta) / 0.3) for theta in (0.4, 0.3)
        )
        both = 1 - (1 - p_old) * (1 - p_young)
        assert value == pytest.approx(
            -(1500 * (p_old @ fall) + 500 * (both @ fall)), rel=2e-3
        )


def test_velocity_that_scatters_widens_a_fragility_in_two_measures_as_normal_theory_says():
    """Φ(c0 + c1 ln a + c2 (m + s Z)) averaged over Z is Φ((c0 + c1 ln a + c2 m) / √(1 + c2² s²))."""
    body = StandingObject("rock", PGA, (10.0, 4.0, 3.0), 0.0, Age(1000, 1000))
    m, s = math.log(0.08), 0.5
    root = math.sqrt(1 + (3.0 * s) ** 2)
    one = ((10.0 + 3.0 * m) / root, 4.0 / root)
    merged = StandingObject("merged", PGA, one, 0.0, Age(1000, 1000))
    branches = made_branches(0.1, 0.3)
    found = weighed(branches, [body], velocity=VelocityRatio(0.08, s))
    assert found.log_survival == pytest.approx(
        weighed(branches, [merged]).log_survival, rel=2e-3
    )


def test_drawn_histories_of_sites_recover_the_weights():
    """Draw a branch, then a history of T years, and keep the histories in which the object stands."""
    rng = np.random.default_rng(12)
    factors, weights, years = np.array([0.3, 1.0, 3.0]), [0.3, 0.4, 0.3], 2000.0
    found = weighed(
        made_branches(*factors, weights=weights), [rock(years, sd=0.3)], samples=8192
    )
    n = 20_000
    branch = rng.choice(3, n, p=weights)
    theta = 0.4 * np.exp(rng.normal(0, 0.3, n))
    # earthquakes above 0.08 g in T years; hardly one below topples it
    lowest = 0.08
    counts = rng.poisson(years * 1e-4 * factors[branch] * lowest**-SLOPE)
    history = np.repeat(np.arange(n), counts)
    level = lowest * rng.random(history.size) ** (-1 / SLOPE)
    topples = rng.random(history.size) < special.ndtr(
        np.log(level / theta[history]) / 0.3
    )
    stands = np.bincount(history[topples], minlength=n) == 0
    kept = np.bincount(branch[stands], minlength=3) / stands.sum()
    error = np.sqrt(kept * (1 - kept) / stands.sum())
    assert (np.abs(found.weights - kept) < 4 * error + 0.002).all()


def test_curves_before_are_the_weighted_mean_and_ratios_follow_from_the_curves():
    branches = made_branches(0.5, 1.0, 2.0, weights=[0.25, 0.5, 0.25])
    found = weighed(branches, [rock(3000)])
    curves = found.curves()
    mean = sum(
        b.weight * b.curves[PGA].rate(curves["level"].to_numpy()) for b in branches
    )
    assert curves["mean_before"].to_numpy() == pytest.approx(mean)
    fractiles = curves.filter(regex="fractile.*before").to_numpy()
    assert (np.diff(fractiles, axis=1) >= 0).all()
    row = found.ratios().set_index("annual_rate").loc[1e-3]
    assert row["rate_ratio"] == pytest.approx(row["level_ratio"] ** SLOPE, rel=1e-3)
    assert row["level_after"] < row["level_before"]


def test_more_capacity_or_less_age_tells_less():
    branches, body = made_branches(0.5, 1.0, 2.0), rock(3000)
    base = weighed(branches, [body]).information
    assert weighed(branches, scaled([body], capacity=1.5)).information < base
    assert weighed(branches, scaled([body], age=0.5)).information < base


def test_ages_are_certain_uniform_or_lognormal_and_end_with_fragility():
    uniform = np.array([0.0, 0.5, 1.0])
    assert Age(3000, 3000).exposure(uniform) == pytest.approx([3000] * 3)
    assert Age(1000, 3000).exposure(uniform) == pytest.approx([1000, 2000, 3000])
    assert Age(9000, 9000, 0.3).exposure(np.array([0.5])) == pytest.approx([9000])
    assert Age(9000, 9000, 0.3, 4000).exposure(np.array([0.5])) == pytest.approx([4000])


CASES = case_tables(__file__)


def write_branches(path):
    """A table of three branches, power laws."""
    rows = [
        {
            "branch": f"b{i}",
            "weight": w,
            "pga_g": x,
            "annual_rate": 1e-4 * factor * x**-2.5,
        }
        for i, (w, factor) in enumerate([(0.25, 0.5), (0.5, 1.0), (0.25, 2.0)])
        for x in np.geomspace(0.02, 3.0, 12)
    ]
    pd.DataFrame(rows).to_csv(path, index=False)


@pytest.fixture
def site(tmp_path):
    write_branches(tmp_path / "branches.csv")
    path = tmp_path / "site.yaml"
    path.write_text(CASES["files"]["site.yaml"])
    return path


def run(site, capsys, *more):
    status = main(["constrain", str(site), "--output", str(site.parent / "out"), *more])
    return status, capsys.readouterr()


def test_answer_lines_page_json_and_tables(site, capsys):
    status, said = run(site, capsys)
    assert status == 0
    first, *_ = said.out.splitlines()
    assert "lower" in first and "1e-4 a year" in first
    assert "rock A tells most" in said.out
    _, said = run(site, capsys, "--json")
    answer = json.loads(said.out)
    after = [row["weight_after"] for row in answer["branches"]]
    assert sum(after) == pytest.approx(1.0)
    assert after[0] > 0.25 > after[2]
    folder = site.parent / "out"
    page = (folder / "Hill.html").read_text(encoding="utf-8")
    assert "reweighted, not validated" in page
    # labels of axes are numbers and no markup
    assert "mathdefault" not in page and ">0.0001<" in page
    weights = pd.read_csv(folder / "Hill-weights.csv")
    assert list(weights.columns[:3]) == ["rlz_id", "branch_path", "weight"]
    assert weights["weight"].tolist() == pytest.approx(after)
    curves = pd.read_csv(folder / "Hill-curves.csv")
    assert (curves["mean_after"] <= curves["mean_before"]).all()


def test_lines_and_page_of_a_site_speak_italian(site, capsys):
    status, said = run(site, capsys, "--language", "it")
    assert status == 0
    first, *_, last = said.out.splitlines()
    assert first.startswith("Pericolosità") and "in meno" in first
    assert "rock A dice di più" in said.out and last.startswith("Limiti")
    page = (site.parent / "out" / "Hill.html").read_text(encoding="utf-8")
    assert '<html lang="it"' in page and "Quale oggetto decide" in page
    assert "oggetti che resistono al 25\u00a0% in più" in page
    # nothing of what the page says in English is left
    english = json.loads((TEXTS / "en.json").read_text(encoding="utf-8"))
    for id, text in english.items():
        if id.startswith("site_") and isinstance(text, str):
            longest = max(re.split(r"{\w+}", text), key=len).strip()
            assert len(longest) < 9 or longest not in page, id
    # numbers for programs are the same in every language
    assert json.loads((site.parent / "out" / "Hill.json").read_text())["limits"]


def test_an_unknown_language_is_refused_before_anything_is_written(site, capsys):
    status, said = run(site, capsys, "--language", "tlh")
    assert status == 2 and "no texts in 'tlh'" in said.err
    assert not (site.parent / "out").exists()


def test_a_table_that_is_cut_says_so_in_the_language_of_its_page():
    branches = made_branches(*np.linspace(0.5, 2.0, 501))
    found = constrain(Site("here", tuple(branches), (rock(3000),)))
    assert "The first 500 of 501; here-weights.csv has all." in page_of(found)
    assert "Le prime 500 di 501" in page_of(found, "it")


@pytest.mark.parametrize(("file", "old", "new", "sentence"), CASES["refused"])
def test_what_cannot_be_is_said_in_one_sentence(site, capsys, file, old, new, sentence):
    path = site.parent / file
    path.write_text(path.read_text().replace(old, new))
    status, said = run(site, capsys)
    assert status == 2
    assert re.search(sentence, said.err) and said.err.count("\n") == 1
    assert not (site.parent / "out").exists()


def test_two_tables_give_two_measures_of_the_same_branches(tmp_path):
    write_branches(tmp_path / "pga.csv")
    table = pd.read_csv(tmp_path / "pga.csv").rename(columns={"pga_g": "pgv_cm_s"})
    table["pgv_cm_s"] *= 100
    table.to_csv(tmp_path / "pgv.csv", index=False)
    found = read_branches([tmp_path / "pga.csv", tmp_path / "pgv.csv"])
    assert {m.imt for m in found[0].curves} == {"PGA", "PGV"}
    table["weight"] = 1 / 3
    table.to_csv(tmp_path / "pgv.csv", index=False)
    with pytest.raises(InputError, match="elsewhere"):
        read_branches([tmp_path / "pga.csv", tmp_path / "pgv.csv"])


def simulated_site(folder, catalogue, more="", velocity=""):
    write_branches(folder / "branches.csv")
    path = folder / "site.yaml"
    path.write_text(
        f"hazard: {{curves: [branches.csv]{velocity}}}\nobjects:\n  - {{name: stele, age_years: 800, statue: "
        f"{{width: 30 cm, height: 1.5 m, records: {{paths: ['{catalogue}']}}{more}}}}}\n"
    )
    return path


@pytest.mark.parametrize("velocity", ["", ", velocity: {median_s: 0.1, sd_ln: 0.3}"])
def test_an_object_may_be_simulated(own_records, tmp_path, velocity):
    catalogue = own_records / "catalogue.csv"
    site = read_site(simulated_site(tmp_path, catalogue, velocity=velocity))
    (stele,) = site.objects
    assert len(stele.coefficients) == (3 if velocity else 2)
    assert stele.coefficients[1] > 0
    # what is not known of a body that nobody measured is a fifth of its median at least
    assert 0.2 < stele.sd_ln < 2
    assert constrain(site).result.weights.sum() == pytest.approx(1)
    wider = simulated_site(tmp_path, catalogue, ", depth: 60 cm", velocity)
    assert read_site(wider).objects[0].coefficients == stele.coefficients


@pytest.mark.parametrize(
    ("more", "words"),
    [(", pga: 0.3 g", "key pga has no effect"), (", width: 0 cm", "width")],
)
def test_a_simulated_object_is_refused_in_one_sentence(
    own_records, tmp_path, capsys, more, words
):
    site = simulated_site(tmp_path, own_records / "catalogue.csv", more)
    status, said = run(site, capsys)
    assert status == 2 and words in said.err and said.err.count("\n") == 1


def test_curves_that_end_before_the_level_decided_on_give_no_number_that_is_none(
    tmp_path, capsys
):
    # velocities that are exceeded oftener than once in ten thousand years, whatever the branch
    (tmp_path / "b.csv").write_text(CASES["files"]["ending.csv"])
    site = tmp_path / "site.yaml"
    site.write_text(CASES["files"]["ending.yaml"])
    assert main(["constrain", str(site), "--output", str(tmp_path / "out")]) == 0
    shown = capsys.readouterr().out
    assert not re.search(
        r"\bnan\b", shown + (tmp_path / "out" / "Chapel.html").read_text()
    )
    assert "lies beyond the curves" in shown and "pinnacle tells most" in shown


YEARS = 50.0
THETA, BETA, AGE = 0.25, 0.3, 4000.0
RUN = """
from openquake.commonlib import logs
logs.dbcmd("upgrade_db")
from openquake.calculators import base
from openquake.calculators.export import export
with logs.init("job.ini") as log:
    oq = log.get_oqparam()
    oq.export_dir = "."
    calculator = base.calculators(oq, log.calc_id)
    calculator.run(export_dir=".")
    for what in ("realizations", "hcurves"):
        export((what, "csv"), calculator.datastore)
"""


def rows_of(path):
    """Levels and probabilities of a file of curves, read without the package."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    header, row = csv.reader(lines)
    levels = [float(re.sub("^poe-", "", title)) for title in header[3:]]
    return np.array(levels), np.array(row[3:], dtype=float)


@pytest.fixture(scope="module")
def calculated(tmp_path_factory):
    """What OpenQuake exported of a calculation of its own."""
    pytest.importorskip(
        "openquake.calculators.base",
        reason="openquake.engine is not installed, or cannot run here",
    )
    folder = tmp_path_factory.mktemp("openquake")
    # one source with two rates of earthquakes, two ground motion models: four branches of unequal weight
    for name, text in CASES["openquake"]:
        (folder / name).write_text(text)
    environment = os.environ | {"OQ_DISTRIBUTE": "no", "OQ_DATADIR": str(folder)}
    environment |= {"HOME": str(folder)}
    subprocess.run(
        [sys.executable, "-c", RUN],
        cwd=folder,
        check=True,
        capture_output=True,
        env=environment,
    )
    return folder


@pytest.mark.peers
@pytest.mark.slow
@pytest.mark.parametrize("measure", [PGA, PGV])
def test_weights_of_openquake_return_its_mean_curve(calculated, measure):
    paths = sorted(calculated.glob(f"hazard_curve-rlz-*-{measure.imt}_*.csv"))
    branches = read_branches(paths, calculated / "realizations_1.csv")
    weights = [0.35 * 0.6, 0.35 * 0.4, 0.65 * 0.6, 0.65 * 0.4]
    assert [branch.weight for branch in branches] == pytest.approx(weights)
    levels, mean = rows_of(calculated / f"hazard_curve-mean-{measure.imt}_1.csv")
    curves = [branch.curves[measure] for branch in branches]
    # beyond the ends that all exports know the package continues a power law
    first, last = max(c.levels[0] for c in curves), min(c.levels[-1] for c in curves)
    known = (levels >= first) & (levels <= last)
    assert known.sum() >= 20
    # its mean is that of the probabilities
    poes = [-np.expm1(-YEARS * curve.rate(levels[known])) for curve in curves]
    assert np.array(weights) @ poes == pytest.approx(mean[known], rel=2e-5)


def exported(folder):
    """Exports of three branches at one site, whose rates at 0.1 g come back by their numbers."""
    rates = {0: 0.002, 1: 0.005, 2: 0.012}
    for number, rate in rates.items():
        path = folder / f"hazard_curve-rlz-{number:03d}-PGA_7.csv"
        path.write_text(openquake_csv("PGA", f"rlz-{number:03d}", rate))
    (folder / "realizations_7.csv").write_text(CASES["files"]["realizations.csv"])
    return rates


def test_exports_are_read_reweighted_and_read_back(tmp_path, monkeypatch):
    rates = exported(tmp_path)
    monkeypatch.chdir(tmp_path)
    names = sorted(path.name for path in tmp_path.glob("hazard_curve-*.csv"))
    site = CASES["files"]["of_exports.yaml"].replace("CURVES", ", ".join(names))
    (tmp_path / "site.yaml").write_text(site)
    assert main(["constrain", "site.yaml"]) == 0
    table = pd.read_csv("constrained/site-weights.csv")
    assert table["rlz_id"].tolist() == [0, 1, 2]
    assert table["branch_path"].tolist() == ["AA~A", "AB~A", "AC~A"]
    # λ = k0 θ^-k exp(k² β² / 2)
    of_each = np.array(list(rates.values()))
    toppling = of_each * (THETA / 0.1) ** -2.5 * math.exp((2.5 * BETA) ** 2 / 2)
    stands = np.array([0.2, 0.5, 0.3]) * np.exp(-AGE * toppling)
    assert table["weight"].to_numpy() == pytest.approx(stands / stands.sum(), rel=2e-3)
    again = read_branches(names, "constrained/site-weights.csv")
    assert [branch.weight for branch in again] == pytest.approx(
        table["weight"].tolist()
    )
    for n, branch in enumerate(again):
        assert branch.curves[PGA].rate(0.1) == pytest.approx(rates[n], rel=1e-5)


def test_samples_of_a_logic_tree_keep_their_numbers(tmp_path):
    """Of a sampled tree the same path may come twice; the number of the realization tells them apart."""
    exported(tmp_path)
    path = tmp_path / "realizations_7.csv"
    path.write_text(path.read_text().replace("AB~A", "AA~A"))
    curves = sorted(tmp_path.glob("hazard_curve-*.csv"))
    assert len({branch.name for branch in read_branches(curves, path)}) == 3
    with pytest.raises(InputError, match="realization 2 is given twice"):
        read_branches([*curves, curves[-1]], path)
