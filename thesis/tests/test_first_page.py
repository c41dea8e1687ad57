"""The words of the first page: every number in them is one of the tables."""

import re

import pandas as pd
import pytest

from rockfrag.report.page import Page
from rockfrag.report.part import Answer, Finding
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag.stages.pedestal import pedestal_tables
from rockfrag_thesis.hypotheses import Evidence, hypothesis_table
from rockfrag_thesis.hypotheses.evidence import THESIS_BODIES
from rockfrag_thesis.sections.first_page import first_page
from rockfrag_thesis.sections.signs import perturbations_by_floor
from rockfrag_thesis.sensitivity_analysis.explain import explain
from rockfrag_thesis.sensitivity_analysis.simulated import REFERENCE
from tests.end_to_end.checked_report import open_words
from tests.paired_tests import build

WORDS_WITH_DIGITS = ("3rd", "5th", "F3", "F5", "95 %", "10 %", "at 5 % over 1 test")
WORDS_WITH_DIGITS += ("above 1", "below 1")
"""Names, and levels that the rules state."""


def effects_of(tests: pd.DataFrame) -> pd.DataFrame:
    slenderness = {name: body.slenderness for name, body in THESIS_BODIES.items()}
    return pedestal_tables(tests.assign(definition=DEFINITION), 1, slenderness)[
        "effects"
    ]


def hypotheses_of(tests: pd.DataFrame) -> pd.DataFrame:
    hypotheses = hypothesis_table(Evidence(tests, "simulated"))
    c12 = hypotheses.iloc[[0]].assign(number=12, estimate=1.0)
    return pd.concat([c12, hypotheses], ignore_index=True)


def page_of(tests: pd.DataFrame) -> list[Finding]:
    return first_page(effects_of(tests), hypotheses_of(tests))


@pytest.fixture(scope="module")
def plain() -> pd.DataFrame:
    """Tests in which the pedestal does nothing."""
    return build(noise=0.03)


@pytest.fixture(scope="module")
def effects(plain) -> pd.DataFrame:
    return effects_of(plain)


@pytest.fixture(scope="module")
def hypotheses(plain) -> pd.DataFrame:
    return hypotheses_of(plain)


def departing(floors: dict[str, float]) -> pd.DataFrame:
    """Effects of a sensitivity analysis whose one perturbed parameter changes P/NP on the floors by so much."""
    reference = build(noise=0.005, seed=1)
    wide = reference.pivot_table(
        index=["object", "earthquake", "floor", "motion"],
        columns="pedestal",
        values="amplitude_g",
    ).reset_index()
    wide["ratio"] = wide["P"] / wide["NP"]
    changed = wide["ratio"] * wide["floor"].map(floors)
    perturbed = wide.assign(ratio=changed, level="0.9", reference=False)
    both = pd.concat([wide.assign(level=REFERENCE, reference=True), perturbed])
    return explain(both.assign(factor="statue_restitution"))


def said(findings) -> str:
    return " ".join(finding.said for finding in findings)


def as_printed(row: pd.Series, lower: str = "lower", upper: str = "upper") -> str:
    return f"{row['ratio']:.3f} [{row[lower]:.3f}, {row[upper]:.3f}]"


def unexplained(words: str, facts: list[str]) -> list[str]:
    """Numbers that are left when the facts, each worded from its table here, are struck out."""
    for fact in sorted([*facts, *WORDS_WITH_DIGITS], key=len, reverse=True):
        words = words.replace(fact, "")
    return re.findall(r"\d+(?:\.\d+)?", words)


def facts_of(effects: pd.DataFrame) -> list[str]:
    here = effects[
        (effects["definition"] == DEFINITION)
        & effects["scope"].isin(["whole", "floor"])
    ]
    return [as_printed(row) for _, row in here.iterrows()]


@pytest.mark.parametrize("ground", [-0.2, 0.0, 0.2])
def test_every_number_of_the_words_stands_in_the_tables(ground):
    tests = build(
        lambda o, e, floor: ground if floor == "GF" else -0.04, noise=0.03, step=0.05
    )
    effects, hypotheses = effects_of(tests), hypotheses_of(tests)
    sensitivity_analysis = departing({"GF": 1.1, "F3": 1.1, "F5": 1.1})
    words = said(first_page(effects, hypotheses, sensitivity_analysis))

    perturbation = sensitivity_analysis[
        (sensitivity_analysis["level"] == "0.9")
        & (sensitivity_analysis["floor"] == "all")
    ]
    facts = [*facts_of(effects), f"{len(tests) // 2} pairs", "× 0.9"]
    facts += [
        as_printed(row, "ratio_lower", "ratio_upper")
        for _, row in perturbation.iterrows()
    ]
    assert unexplained(words, facts) == []


def inverted(reaches: bool = False) -> pd.DataFrame:
    """One perturbed parameter, two together, and one that acts on the ground alone, with what they give."""
    nothing = {"factor_2": "", "level_2": float("nan"), "acts_on": "all floors"}
    rows = [
        {
            "factor_1": "pedestal_width_cm",
            "level_1": 16.0,
            "ground": 1.021,
            "above": 1.002,
        },
        {
            "factor_1": "pedestal_lean_deg",
            "level_1": 2.0,
            "ground": 1.053,
            "above": 0.994,
        },
        {
            "factor_1": "interface_friction",
            "level_1": 0.35,
            "ground": 1.125,
            "above": 0.987,
        },
    ]
    rows = [nothing | row | {"reaches": False, "plausible": True} for row in rows]
    rows[1] |= {"factor_2": "pedestal_not_counted", "level_2": 20.0, "reaches": reaches}
    rows[2] |= {"acts_on": "ground"}
    return pd.DataFrame(rows)


@pytest.mark.parametrize(
    ("reaches", "who"), [(False, "None of 3 mechanisms"), (True, "1 of 3 mechanisms")]
)
def test_what_was_asked_the_other_way_round_is_one_sentence_of_its_table(
    effects, hypotheses, reaches, who
):
    wanted = {"ground": 10.0, "above": -5.0}
    table, sensitivity_analysis = (
        inverted(reaches),
        departing({"GF": 1.1, "F3": 1.1, "F5": 1.1}),
    )
    plain = first_page(effects, hypotheses, sensitivity_analysis)
    whole = first_page(effects, hypotheses, sensitivity_analysis, table, wanted)
    assert [item.headline for item in whole] == [item.headline for item in plain]
    words = said(whole).removeprefix(said(plain)).strip()
    assert words.count(". ") == 0 and words.startswith(who)
    facts = [who, "+10 % on the ground and −5 % above it", "16 cm", "2°", "20 kg"]
    facts += ["coefficient of 0.35"]
    facts += [
        f"{row['ground']:.3f} and {row['above']:.3f}" for _, row in table.iterrows()
    ]
    assert all(fact in words for fact in facts)
    assert unexplained(words, facts) == []


@pytest.mark.parametrize(
    ("ground", "words"),
    [
        (0.3, "reproduces it"),
        (0.0, "a gain of 10 % or more is excluded, a smaller one is not"),
        (-0.3, "gives the opposite"),
    ],
)
def test_the_headline_is_the_hypothesis_table_s_finding(ground, words):
    tests = build(lambda o, e, floor: ground if floor == "GF" else 0.0, noise=0.02)
    assert words in page_of(tests)[0].headline


def test_what_the_simulations_leave_open_is_called_open():
    tests = build(noise=0.4, seed=2)
    found = page_of(tests)[0]
    assert "undecided" in found.headline and "GF: undecided" in found.numbers


def test_the_pattern_is_named_only_with_intervals_on_its_side(effects, hypotheses):
    def headline(floors):
        return first_page(effects, hypotheses, departing(floors))[1].headline

    assert headline({"GF": 1.2, "F3": 0.9, "F5": 0.9}).startswith(
        "The only perturbation"
    )
    assert headline({"GF": 1.2, "F3": 0.9, "F5": 1.0}).startswith("No perturbation")
    assert headline({"GF": 1.2, "F3": 1.2, "F5": 1.2}).startswith("No perturbation")


def test_simulated_perturbations_are_judged_together_by_a_named_rule(
    effects, hypotheses
):
    sensitivity_analysis = departing({"GF": 1.2, "F3": 1.2, "F5": 1.2})

    def found(p: float):
        return first_page(effects, hypotheses, sensitivity_analysis.assign(p=p))[
            1
        ].numbers

    rule = r"\(Benjamini–Hochberg at 5 % over 1 test\)"
    largest = r"the largest is the object's restitution everywhere × 0\.9 \(1\.\d+ \[1\.\d+, 1\.\d+\]\)\."
    changes = r"imulated perturbation changes the ratio over all floors"
    assert re.search(rf"No s{changes} {rule}; {largest}", found(0.5))
    assert re.search(rf"The only s{changes} {rule}; {largest}", found(0.01))


def test_arithmetic_is_told_apart_from_simulation_and_counts_in_no_adjustment(
    effects, hypotheses
):
    simulated = departing({"GF": 1.0, "F3": 1.0, "F5": 1.0}).assign(p=0.04)
    computed = simulated.assign(factor="table_not_counted", p=1e-6)
    computed = computed[computed["level"] != REFERENCE]
    numbers = first_page(effects, hypotheses, pd.concat([simulated, computed]))[
        1
    ].numbers
    assert "1 other is arithmetic, not simulation" in numbers
    # one simulated test alone: its p value stays 0.04, however small those of arithmetic are
    assert "The only simulated perturbation changes the ratio" in numbers
    both = perturbations_by_floor(pd.concat([simulated, computed])).set_index("factor")
    assert both.loc["table_not_counted", "arithmetic"]
    assert pd.isna(both.loc["table_not_counted", "p_adjusted"])


def test_why_is_said_only_where_the_simulations_show_it(effects, hypotheses):
    assert "lifts the pedestal" in said(first_page(effects, hypotheses))
    estimate = hypotheses["estimate"].where(hypotheses["number"] != 12, 0.98)
    unsettled = first_page(effects, hypotheses.assign(estimate=estimate))
    assert "lifts the pedestal" not in said(unsettled)


def test_a_study_without_the_floors_says_what_it_has(plain):
    tests = plain[plain["floor"] == "GF"].assign(floor="ground")
    found = page_of(tests)[0]
    assert "depends on the floor" in found.headline
    assert "does not have the thesis’s floors" in found.numbers
    assert "36 pairs" not in found.numbers


MOST_WORDS = 120


def test_the_first_page_stands_open_in_few_words(effects, hypotheses):
    """All that is read without a click but the figure's caption, the links and the advice of some 40 words."""
    sensitivity_analysis = departing({"GF": 1.2, "F3": 1.0, "F5": 1.0})
    wanted = {"ground": 10.0, "above": -5.0}
    found = first_page(effects, hypotheses, sensitivity_analysis, inverted(), wanted)
    page = Page("T", "lead", Answer("Does a pedestal help?", found)).html()
    answer = page[page.index('<section id="answer"') : page.index("</section>")]
    assert len(open_words(answer)) <= MOST_WORDS - 40
    assert "[" not in " ".join(open_words(answer))
