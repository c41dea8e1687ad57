"""Tables as people have them: read and fitted, or refused in one sentence that says how to mend them."""

import resource

import numpy as np
import pandas as pd
import pytest

from rockfrag.base.errors import InputError
from rockfrag.fragility.tests_file import _outcomes, read_tests, read_titles
from rockfrag.fragility.user_table import fit_user_table

from ..case_tables import case_tables
from ..workflow.conftest import write_synthetic

CASES = case_tables(__file__)
PGV = ["pga_g", "pgv_over_pga_s", 980.665]
ROWS = [("r1", 0.35, "no"), ("r2", 0.5, "yes"), ("r3", 0.25, "no")]


def write(path, separator=",", decimal=".", encoding="utf-8", title="pga_g"):
    lines = [separator.join(("record", title, "overturned"))]
    lines += [
        separator.join((name, str(value).replace(".", decimal), outcome))
        for name, value, outcome in ROWS
    ]
    path.write_bytes("\n".join(lines).encode(encoding))
    return path


@pytest.mark.parametrize("form", CASES["read"])
def test_same_table_in_every_form(tmp_path, form):
    table = read_tests(write(tmp_path / "t.csv", **form), ["pga_g"], motion="record")
    assert table["motion"].tolist() == ["r1", "r2", "r3"]
    assert table["pga_g"].tolist() == [0.35, 0.5, 0.25]
    assert table["overturned"].tolist() == [0, 1, 0]


def test_comments_above_the_header_are_no_rows(tmp_path):
    path = write(tmp_path / "t.csv")
    path.write_text("# tests of 2019\n# in the hall, by hand\n" + path.read_text())
    assert read_titles(path) == ["record", "pga_g", "overturned"]
    table = read_tests(path, ["pga_g"], motion="record")
    assert table["pga_g"].tolist() == [0.35, 0.5, 0.25]


@pytest.mark.parametrize(("yes", "no"), [("sì", "no"), ("VRAI", "FAUX")])
def test_western_european_labels_and_outcomes_are_read_beside_titles_that_stand_twice(
    tmp_path, yes, no
):
    path = tmp_path / "t.csv"
    text = f"record,pga_g,note,note,fell\nGröbming,0.3,a,b,{yes}\nB,0.2,a,b,{no}\n"
    path.write_bytes(text.encode("cp1252"))
    table = read_tests(path, ["pga_g"], overturned="fell", motion="record")
    assert table["motion"].tolist() == ["Gröbming", "B"]
    assert table["overturned"].tolist() == [1, 0]


@pytest.mark.parametrize(("content", "said"), CASES["refused"])
def test_tables_that_cannot_be_used_are_refused_by_file_row_and_column(
    tmp_path, content, said
):
    path = tmp_path / "t.csv"
    if content is not None:
        path.write_text(content)
    with pytest.raises(InputError, match=rf"t\.csv.*{said}"):
        read_tests(path, ["pga_g"], motion="record")


def test_measure_without_a_unit_is_refused_with_the_cure(tmp_path):
    path = write(tmp_path / "t.csv", title="PGA")
    with pytest.raises(
        InputError, match=r"'PGA': the name does not tell a unit.*PGA_g: \[PGA\]"
    ):
        read_tests(path, ["PGA"])
    assert read_tests(path, {"pga_g": ["PGA"]})["pga_g"].tolist() == [0.35, 0.5, 0.25]


@pytest.mark.slow
def test_a_million_rows_of_2000_motions_take_bounded_memory(tmp_path):
    """An IDA curve of 2000 motions; one array of motions by rows alone would take 15 GiB."""
    rng = np.random.default_rng(1)
    motions, each = 2000, 500
    motion = np.repeat(np.arange(motions), each)
    velocity = np.exp(rng.normal(3.0, 0.6, motion.size))
    capacity = np.exp(3.2 + 0.3 * rng.normal(size=motions)[motion])
    path = tmp_path / "many.csv"
    pd.DataFrame(
        {
            "record": [f"r{k}" for k in motion],
            "pgv_cm_s": velocity,
            "pga_g": velocity / 200 * np.exp(0.5 * rng.normal(size=motion.size)),
            "overturned": (velocity > capacity).astype(int),
        }
    ).to_csv(path, index=False)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    found = fit_user_table(path, ["pgv_cm_s", "pga_g"], motion="record")
    grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 2**20
    assert found.choice.name == "PGV"
    assert found.fits["pgv_cm_s"].fit.theta == pytest.approx(np.exp(3.2), rel=0.02)
    assert found.fits["pgv_cm_s"].interval.groups == motions
    assert grown < 2.0, f"{grown:.1f} GiB"


@pytest.mark.parametrize(
    ("title", "value", "said"),
    [
        ("pga_g", "549", "the largest is 549, more than"),
        ("pgv_cm_s", "0.02", "too little"),
    ],
)
def test_peaks_in_a_wrong_unit_are_doubted_on_both_sides(tmp_path, title, value, said):
    path = tmp_path / "t.csv"
    path.write_text(f"{title},overturned\n{value},1\n{value},0\n")
    with pytest.warns(UserWarning, match=f"column '{title}': .*{said}.*mend the unit"):
        read_tests(path, [title])


def test_the_measure_that_decides_is_recommended_with_its_reasons(tmp_path):
    path, measures = write_synthetic(tmp_path), {"pga_g": ["pga_g"], "pgv_cm_s": PGV}
    given = {"motion": "record", "given": ["pgv_over_pga_s"], "replicates": 50}
    result = fit_user_table(path, measures, **given)
    assert (result.choice.recommended, result.choice.name) == ("pgv_cm_s", "PGV")
    fit = result.fits["pgv_cm_s"].fit
    assert fit.theta == pytest.approx(40.0, rel=0.1)
    assert fit.beta == pytest.approx(0.2, abs=0.1)
    assert result.fits["pgv_cm_s"].interval.groups == 30
    compared = result.choice.table.set_index("im")
    assert compared.loc["PGV", "beta"] < compared.loc["PGA", "beta"]
    assert compared.loc["PGV", "auc"] > compared.loc["PGA", "auc"]
    assert compared.loc["PGV", "chosen_fraction"] > 0.95
    assert (
        compared.loc["PGV", "p_pgv_over_pga_s"]
        > 0.01
        > compared.loc["PGA", "p_pgv_over_pga_s"]
    )
    assert "one measure is enough" in result.choice.words
    assert result.goodness["pgv_cm_s"].p_value > 0.05
    assert set(result.table["measure"]) == {"pga_g", "pgv_cm_s"}
    assert result.bins.groupby("measure").tests.sum().tolist() == [150, 150]
    assert result.bins.index.is_unique


def test_a_table_in_which_all_survived_gives_a_bound_and_no_recommendation(tmp_path):
    path = tmp_path / "stout.csv"
    pd.DataFrame({"pga_g": [0.1, 0.2, 0.3], "overturned": 0}).to_csv(path, index=False)
    result = fit_user_table(path, ["pga_g"])
    assert result.choice.recommended == ""
    assert "None of 3 tests overturned" in result.table["warnings"].iloc[0]


def test_limits_are_over_the_earthquakes_that_a_table_names(tmp_path):
    rng, path = np.random.default_rng(2), tmp_path / "t.csv"
    pga = np.exp(rng.normal(-1, 0.5, 60))
    fell = (pga > 0.4 * np.exp(rng.normal(0, 0.3, 60))).astype(int)
    event = [f"e{k % 12}" for k in range(60)]
    pd.DataFrame({"pga_g": pga, "overturned": fell, "event": event}).to_csv(path)
    found = fit_user_table(path, ["pga_g"], earthquake="event", replicates=5)
    limits = found.fits["pga_g"].interval
    assert (limits.over, limits.groups) == ("earthquake", 12)


def test_the_granite_rock_follows_its_velocity(shared):
    path = shared / "measured" / "granite_rock_1.csv"
    measures = {"pga_g": ["pga_g"], "pgv_cm_s": PGV}
    result = fit_user_table(path, measures, motion="record", replicates=50)
    assert result.fits["pga_g"].fit.aic == pytest.approx(656.0, abs=0.1)
    assert result.fits["pgv_cm_s"].fit.aic == pytest.approx(309.0, abs=0.1)
    assert result.two_measures is not None
    assert result.two_measures.fits["aic"].iloc[0] == pytest.approx(309.4, abs=0.1)
    assert result.choice.name == "PGV"
    assert (result.outcomes["pga_g"].n, result.outcomes["pga_g"].n_overturned) == (
        582,
        243,
    )


def test_outcomes_written_as_decimals_are_outcomes():
    piece = pd.DataFrame({"fell": ["1.0", "0,00", " Yes ", "0."]})
    assert _outcomes(piece, "fell", "t.csv", 2).tolist() == [1.0, 0.0, 1.0, 0.0]
    with pytest.raises(InputError, match="'10' is no outcome"):
        _outcomes(pd.DataFrame({"fell": ["10"]}), "fell", "t.csv", 2)
