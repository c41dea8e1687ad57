"""The command `constrain` as a user meets it: an answer with its files, or one sentence."""

import json
import re

import numpy as np
import pandas as pd
import pytest

from rockfrag.cli import main
from rockfrag.errors import InputError
from rockfrag.survival.answer import constrain
from rockfrag.survival.branches import read_branches
from rockfrag.survival.site import read_site

SITE = """
name: Hill
hazard: {{curves: [branches.csv]}}
objects:
  - {{name: rock A, median: 0.4 g, beta: 0.3, median_sd_ln: 0.2, age_years: {age}}}
  - {{name: rock B, median: 0.5 g, beta: 0.3, age_years: [2000, 6000], fragile_for_years: 3000}}
shared_error: 0.5
"""


def write_branches(path, weights=(0.25, 0.5, 0.25)):
    """A table of three branches, power laws."""
    levels = np.geomspace(0.02, 3.0, 12)
    rows = [
        {"branch": f"b{i}", "weight": w, "pga_g": x, "annual_rate": 1e-4 * factor * x**-2.5}
        for i, (w, factor) in enumerate(zip(weights, (0.5, 1.0, 2.0), strict=True))
        for x in levels
    ]
    pd.DataFrame(rows).to_csv(path, index=False)


@pytest.fixture
def site(tmp_path):
    write_branches(tmp_path / "branches.csv")
    path = tmp_path / "site.yaml"
    path.write_text(SITE.format(age="3000"))
    return path


def run(site, capsys, *more):
    status = main(["constrain", str(site), "--output", str(site.parent / "out"), *more])
    return status, capsys.readouterr()


def test_answer_page_json_and_tables(site, capsys):
    status, said = run(site, capsys, "--json")
    assert status == 0
    answer = json.loads(said.out)
    after = [row["weight_after"] for row in answer["branches"]]
    assert sum(after) == pytest.approx(1.0)
    assert after[0] > 0.25 > after[2]
    folder = site.parent / "out"
    page = (folder / "Hill.html").read_text(encoding="utf-8")
    assert "reweighted, not validated" in page
    assert "validated by" not in page
    # labels of axes are numbers and no markup
    assert "mathdefault" not in page and ">0.0001<" in page
    weights = pd.read_csv(folder / "Hill-weights.csv")
    assert list(weights.columns[:3]) == ["rlz_id", "branch_path", "weight"]
    assert weights["weight"].tolist() == pytest.approx(after)
    curves = pd.read_csv(folder / "Hill-curves.csv")
    assert (curves["mean_after"] <= curves["mean_before"]).all()


def test_lines_say_how_the_mean_hazard_moved_and_which_object_decides(site, capsys):
    status, said = run(site, capsys)
    assert status == 0
    first, *_ = said.out.splitlines()
    assert "lower" in first and "1e-4 a year" in first
    assert "rock A tells most" in said.out


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda t: t.replace("age_years: 3000", "age_years: -3"), "age_years"),
        (lambda t: t.replace("[2000, 6000]", "[6000, 2000]"), "ends before it begins"),
        (lambda t: t.replace("median: 0.4 g", "median: 0.4"), "unit"),
        (lambda t: t.replace("median: 0.4 g, beta: 0.3", "coefficients: [1, -2]"), "above 0"),
        (
            lambda t: t.replace("median: 0.4 g, ", ""),
            "give statue, median and beta, or coefficients",
        ),
        (lambda t: t.replace("rock B", "rock A"), "given twice"),
        (lambda t: t.replace("shared_error: 0.5", "shared_error: 1.5"), "0 to 1"),
        (lambda t: t.replace("branches.csv", "absent.csv"), "absent.csv"),
        (lambda t: t.replace("median: 0.4 g", "measure: PGV, median: 30 cm/s"), "PGV"),
        (lambda t: t.replace("objects:", "things:"), "things"),
    ],
)
def test_what_cannot_be_is_said_in_one_sentence(site, capsys, change, sentence):
    site.write_text(change(SITE.format(age="3000")))
    status, said = run(site, capsys)
    assert status == 2
    assert sentence in said.err and said.err.count("\n") == 1
    assert not (site.parent / "out").exists()


def test_objects_that_no_branch_lets_stand_are_said_to_be_at_odds(site, capsys):
    site.write_text(SITE.format(age="10000000"))
    status, said = run(site, capsys)
    assert status == 2
    assert "in no branch" in said.err and "rock A" in said.err


@pytest.mark.parametrize("weights", [(0.25, 0.5, 0.3), (0.25, 0.75, 0.0), (0.5, 0.75, -0.25)])
def test_weights_that_are_none_are_refused(tmp_path, weights):
    write_branches(tmp_path / "b.csv", weights)
    with pytest.raises(InputError, match=r"sum to|above 0"):
        read_branches([tmp_path / "b.csv"])


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


def test_a_simulated_object_says_what_has_no_effect(own_records, tmp_path, capsys):
    site = simulated_site(tmp_path, own_records / "catalogue.csv", ", pga: 0.3 g")
    status, said = run(site, capsys)
    assert status == 2 and "key pga has no effect" in said.err and said.err.count("\n") == 1
    site = simulated_site(tmp_path, own_records / "catalogue.csv", ", width: 0 cm")
    status, said = run(site, capsys)
    assert status == 2 and said.err.count("\n") == 1


def test_curves_that_end_before_the_level_decided_on_give_no_number_that_is_none(tmp_path, capsys):
    # velocities that are exceeded oftener than once in ten thousand years, whatever the branch
    rows = [
        f"{branch},0.5,{level},{rate * factor}"
        for branch, factor in (("a", 1), ("b", 4))
        for level, rate in ((5, 0.02), (20, 0.002), (80, 0.0003))
    ]
    (tmp_path / "b.csv").write_text("\n".join(["branch,weight,pgv_cm_s,annual_rate", *rows]))
    standing = "measure: PGV, beta: 0.4, median_sd_ln: 0.3, age_years: 600"
    objects = f"[{{name: pinnacle, median: 45 cm/s, {standing}}}, {{name: urn, median: 60 cm/s, {standing}}}]"
    site = tmp_path / "site.yaml"
    site.write_text(f"name: Chapel\nhazard: {{curves: [b.csv]}}\nobjects: {objects}\n")
    assert main(["constrain", str(site), "--output", str(tmp_path / "out")]) == 0
    shown = capsys.readouterr().out
    assert not re.search(r"\bnan\b", shown + (tmp_path / "out" / "Chapel.html").read_text())
    assert "lies beyond the curves" in shown and "pinnacle tells most" in shown
