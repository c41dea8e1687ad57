"""Statements about the experiment get the right verdict where the truth is known."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.errors import InputError
from rockfrag.thesis.statements import (
    COLUMNS,
    STATEMENTS,
    ClaimResult,
    Evidence,
    experiment_claims,
    ledger,
)
from rockfrag.thesis.statements.experiment import TESTS


def verdict(number, tests, **extra):
    return TESTS[number](Evidence(tests, "simulated", 1, **extra)).verdict


def on_floor(**effects):
    return lambda object_name, event, floor: effects.get(floor, 0.0)


def on_event(**effects):
    return lambda object_name, event, floor: effects.get(event.replace(" ", ""), 0.0)


def on_object(**effects):
    return lambda object_name, event, floor: effects.get(object_name, 0.0)


def everywhere(size):
    return lambda object_name, event, floor: size


def t1_first(floor, size):
    return lambda object_name, event, where: (
        size * (3 if object_name == "T1" else 1) if where == floor else 0.0
    )


THESIS_SIGNS = on_floor(GF=0.2, F3=-0.05, F5=-0.05)

CASES = [
    # number, supported by, contradicted by
    (29, everywhere(0.2), everywhere(-0.2)),
    (29, everywhere(0.2), everywhere(0.0)),
    (27, everywhere(0.2), on_object(T3=0.3)),
    (31, everywhere(0.2), on_object(T1=-0.2, T3=0.2)),
    (32, on_object(T3=0.3, T1=0.1), on_object(T1=0.3)),
    (33, on_object(T2=0.05), on_object(T2=-0.2)),
    (34, on_floor(GF=0.2), on_floor(GF=0.2, F3=0.2)),
    (35, on_floor(GF=0.2), on_floor(GF=-0.2)),
    (36, on_floor(F3=-0.05), on_floor(F3=0.1)),
    (37, on_floor(F5=-0.05), on_floor(F5=0.1)),
    (39, t1_first("GF", 0.1), t1_first("GF", -0.1)),
    (40, t1_first("F5", -0.1), t1_first("F5", 0.1)),
    (41, on_floor(GF=0.3, F3=-0.1, F5=0.1), on_floor(GF=0.1, F3=-0.3)),
    (45, on_event(Friuli=0.2, Kobe=0.2, LomaPrieta=0.2), on_event(Kobe=-0.2)),
    (46, on_event(Northridge=-0.2), on_event(Northridge=0.2)),
    (47, on_event(LomaPrieta=0.3), on_event(Friuli=0.3, LomaPrieta=0.1)),
    (48, on_event(Friuli=0.3, LomaPrieta=0.1), on_event(LomaPrieta=0.3)),
    (49, everywhere(0.1), everywhere(-0.1)),
    (50, THESIS_SIGNS, on_floor(F3=0.1, F5=0.1)),
    (51, THESIS_SIGNS, on_floor(GF=-0.1)),
]


@pytest.mark.parametrize(("number", "true", "false"), CASES)
def test_effect_decides_the_verdict(made, number, true, false):
    assert verdict(number, made(true)) == "supported"
    assert verdict(number, made(false)) == "contradicted"


def test_noise_alone_leaves_directions_and_ranks_undecided(made):
    """With scatter of 30 % and no effect nothing may be called supported but by the 5 % chance."""
    seeds = range(6)
    found = {
        (seed, one.number): one.verdict
        for seed in seeds
        for one in experiment_claims(Evidence(made(noise=0.3, seed=seed), "simulated", 1))
    }
    for number in sorted({case[0] for case in CASES} - {27, 31}):
        verdicts = [found[seed, number] for seed in seeds]
        assert verdicts.count("supported") <= 1, number
        assert "undecided" in verdicts, number


def test_signs_of_the_nine_cells(made):
    def thesis(object_name, event, floor):
        if floor == "GF" or (floor == "F3" and object_name == "T1"):
            return 0.1
        return -0.1

    assert verdict(38, made(thesis)) == "supported"
    assert verdict(38, made(on_floor(GF=0.1, F3=-0.1, F5=-0.1))) == "contradicted"


def test_level_of_floors_decides_where_the_mean_is_largest(made):
    # NP: GF 1.2, F3 1.0, F5 1.1; P on the 5th raised above all
    level = on_floor(GF=np.log(1.2), F5=np.log(1.1))
    tests = made(on_floor(F5=0.3, GF=0.1), level)
    assert verdict(42, tests) == "supported"
    assert verdict(43, tests) == "supported"
    assert verdict(44, tests) == "supported"
    upside_down = made(level=on_floor(F3=0.3))
    for number in (42, 43, 44):
        assert verdict(number, upside_down) == "contradicted"


def test_linear_objects_are_linear_and_inverse_ones_are_told_apart(made):
    linear = TESTS[25](Evidence(made(), "simulated", 1))
    assert linear.verdict == "supported" and "AICc prefers H/B" in linear.remark
    inverse = made(objects={"T1": 1.5 / 3, "T2": 1.5 / 4, "T3": 1.5 / 5})
    assert "AICc prefers B/H" in TESTS[25](Evidence(inverse, "simulated", 1)).remark
    bent = made(objects={"T1": 0.5, "T2": 0.3, "T3": 0.29})
    assert verdict(25, bent) == "contradicted"
    rising = made(objects={"T1": 0.3, "T2": 0.4, "T3": 0.5})
    for number in (25, 26, 53):
        assert verdict(number, rising) == "contradicted"


def test_falling_objects_overturn_in_order_with_and_without_pedestal(made):
    for number in (26, 53):
        assert verdict(number, made()) == "supported"


def test_slopes_that_differ_by_floor_are_seen(made):
    def steeper_above(object_name, event, floor):
        return 0.0 if floor == "GF" else 0.3 * (object_name == "T1")

    assert verdict(28, made(level=steeper_above)) == "supported"
    assert verdict(28, made()) == "contradicted"


def test_extrapolation_is_safe_on_a_line_and_not_on_a_bend(made):
    line = made(objects={"T1": 0.5, "T2": 0.4, "T3": 0.32})
    assert verdict(54, line) == "contradicted"
    bend = made(objects={"T1": 0.5, "T2": 0.4, "T3": 0.45})
    assert verdict(54, bend) == "supported"


def test_the_stack_is_less_slender_than_its_object(made):
    result = TESTS[30](Evidence(made(), "simulated", 1))
    assert result.verdict == "contradicted"
    assert result.figure.startswith("stack 2.66, 3.23, 3.83 against 3.00, 4.00, 5.00")
    assert result.estimate == pytest.approx(2.66 / 3, abs=0.002)


def measures_of(tests, **columns):
    motions = tests[["motion", "event", "floor"]].drop_duplicates().reset_index(drop=True)
    return motions.rename(columns={"motion": "name"}).assign(**columns)


def test_correlation_with_the_motion_is_found_when_it_is_there(made):
    period = {("Friuli", "GF"): 0.3}
    rng = np.random.default_rng(3)
    tests = made()
    motions = tests["motion"].unique()
    period = dict(zip(motions, rng.uniform(0.2, 1.0, len(motions)), strict=True))
    tests = made(lambda object_name, event, floor: 0.5 * period[f"{event}-{floor}"])
    measures = measures_of(
        tests,
        mean_period_s=list(period.values()),
        pgv_over_pga_s=rng.uniform(size=12),
        d5_95_s=rng.uniform(size=12),
    )
    result = TESTS[52](Evidence(tests, "simulated", 1, measures=measures))
    assert result.verdict == "contradicted"
    assert "mean period" in result.remark


def test_twelve_motions_cannot_show_that_there_is_no_correlation(made):
    tests = made(noise=0.1)
    rng = np.random.default_rng(4)
    measures = measures_of(tests, mean_period_s=rng.uniform(size=12))
    result = TESTS[52](Evidence(tests, "simulated", 1, measures=measures))
    assert result.verdict == "undecided"
    # Fisher: n = ((1.960 + 0.842) / atanh 0.3)² + 3
    assert "needs 85 motions" in result.remark


def test_pure_rocking_is_judged_by_friction_and_normal_force(made):
    tests = made()
    smooth = tests.assign(friction_demand=0.2, least_normal_force_n=10.0)
    assert verdict(57, smooth) == "supported"
    assert verdict(57, smooth.assign(friction_demand=0.5)) == "undecided"
    assert verdict(57, smooth.assign(friction_demand=1.5)) == "contradicted"
    assert verdict(57, smooth.assign(least_normal_force_n=-0.1)) == "contradicted"


def test_force_over_mass_is_checked_where_recorded(made):
    tests = made()
    mass = 10.0 + 2.172
    right = tests.assign(moved_mass_kg=mass, force_n=tests["amplitude_g"] * 9.81 * mass)
    assert verdict(56, right) == "supported"
    assert verdict(56, right.assign(moved_mass_kg=mass * 1.1)) == "contradicted"
    without = TESTS[56](Evidence(tests, "simulated", 1))
    assert without.verdict == "undecided" and "17 to 19 %" in without.figure


def test_sliding_is_compared_where_given(made):
    sliding = pd.DataFrame(
        {"event": list("ABCD"), "rocking_g": 0.3, "sliding_g": [0.4, 0.41, 0.39, 0.42]}
    )
    assert verdict(58, made(), sliding=sliding) == "supported"


def test_twelve_motions_per_specimen_are_counted(made):
    assert verdict(55, made()) == "supported"
    tests = made()
    assert verdict(55, tests[tests["event"] != "Kobe"]) == "undecided"


def test_ledger_has_all_34_statements_with_columns_and_reasons(made):
    table = ledger(made(noise=0.1), basis="measured", seed=1)
    assert list(table.columns) == list(COLUMNS)
    assert table["number"].tolist() == list(range(25, 59))
    assert (table["basis"] == "measured").all()
    assert table.loc[table["number"] == 58, "remark"].item().startswith("not decidable")
    undecided = table[(table["verdict"] == "undecided") & table["number"].between(27, 51)]
    assert undecided["remark"].str.contains("80 % power|no test|needed", regex=True).all()
    exploratory = table[table["number"].between(32, 48)]
    assert exploratory["remark"].str.startswith("exploratory").all()


def test_ledger_is_the_same_for_the_same_seed_and_any_order_of_rows(made):
    tests = made(noise=0.1)
    one = ledger(tests, basis="simulated", seed=1)
    two = ledger(tests.sample(frac=1, random_state=5), basis="simulated", seed=1)
    pd.testing.assert_frame_equal(one, two)


def test_missing_floors_events_and_objects_leave_their_statements_undecided(made):
    tests = made(noise=0.1)
    ground = experiment_claims(
        Evidence(tests[(tests["floor"] == "GF") & (tests["event"] != "Kobe")], "measured", 1)
    )
    by_number = {one.number: one for one in ground}
    for number in (36, 37, 41, 42, 44, 45):
        assert by_number[number].verdict == "undecided"
        assert "not decidable" in by_number[number].remark


def test_one_motion_decides_nothing_and_breaks_nothing(made):
    tests = made(noise=0.1)
    results = experiment_claims(Evidence(tests[tests["motion"] == "Kobe-GF"], "measured", 1))
    assert len(results) == 34
    # but for geometry no statement may be decided by one motion
    assert {one.number for one in results if one.verdict != "undecided"} <= {30}


def test_spelling_of_event_names_does_not_matter(made):
    tests = made(on_event(LomaPrieta=0.3))
    tests["event"] = tests["event"].str.lower().str.replace(" ", "_")
    assert verdict(47, tests) == "supported"


def test_unusable_table_is_an_input_error(made):
    with pytest.raises(InputError):
        ledger(made().assign(amplitude_g=np.nan), basis="simulated", seed=1)


def test_results_refuse_unknown_numbers_verdicts_and_bases():
    for bad in (
        (59, "supported", "simulated"),
        (1, "true", "simulated"),
        (1, "supported", "guess"),
    ):
        with pytest.raises(ValueError):
            ClaimResult(bad[0], "t", "f", bad[1], bad[2])


def test_there_are_58_statements_each_with_text_and_source():
    assert list(STATEMENTS) == list(range(1, 59))
    assert all(one.text and one.source for one in STATEMENTS.values())
    assert set(TESTS) == set(range(25, 59))
