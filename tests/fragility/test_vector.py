"""Fragility in two measures: recovers what was drawn, keeps its level, agrees with statsmodels and itself."""

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm

from rockfrag.fragility.vector import (
    check_vector,
    fit_vector,
    linearly_separable,
    monotone_probability,
    vector_tables,
)
from rockfrag.report.sections.curves import two_measures_figure

MEASURES = ("pga_g", "pgv_over_pga_s")
VELOCITY = 0.6  # weight of ln PGV/PGA beside that of ln PGA in the made laboratories


def laboratory(rng, earthquakes, motions=5, levels=6, interaction=0.0):
    """Tests of a made laboratory: earthquakes and motions shift the capacity, PGV/PGA belongs to the motion."""
    earthquake = np.repeat(np.arange(earthquakes), motions)
    ratio = rng.normal(0, 0.35, earthquakes)[earthquake] + rng.normal(
        0, 0.3, earthquake.size
    )
    apart = rng.normal(0, 0.25, earthquakes)[earthquake] + rng.normal(
        0, 0.3, earthquake.size
    )
    x, y = np.broadcast_arrays(np.linspace(-1.2, 1.2, levels), ratio[:, np.newaxis])
    index = x + VELOCITY * y + interaction * x * y + apart[:, np.newaxis]
    index = index + rng.normal(0, 0.15, x.shape)
    return pd.DataFrame(
        {
            "earthquake": np.repeat(earthquake, levels).astype(str),
            "motion": np.repeat(np.arange(earthquake.size), levels).astype(str),
            MEASURES[0]: np.exp(x).ravel(),
            MEASURES[1]: np.exp(y).ravel(),
            "overturned": (index > 0).ravel().astype(int),
        }
    )


def test_fit_and_aic_are_those_of_statsmodels():
    table = laboratory(np.random.default_rng(1), 20)
    fit = fit_vector(table, MEASURES)
    logs = np.log(table[list(MEASURES)])
    model = sm.GLM(
        table["overturned"],
        sm.add_constant(logs),
        family=sm.families.Binomial(sm.families.links.Probit()),
    ).fit(tol=1e-12)
    assert fit.coefficients[:3] == pytest.approx(model.params.to_numpy(), abs=1e-6)
    assert fit.aic == pytest.approx(model.aic, abs=1e-6)


def test_contour_is_where_the_probability_has_its_level_and_limits_hold_it():
    fit = fit_vector(laboratory(np.random.default_rng(2), 10), MEASURES)
    second = np.array([0.6, 1.0, 1.5])
    for p in (0.1, 0.5, 0.9):
        value, lower, upper = fit.contour(p, second)
        assert fit.probability(value, second) == pytest.approx(p)
        assert (lower < value).all() and (value < upper).all()
        across, *_ = fit.contour(p, value, of=1)
        assert across == pytest.approx(second)
    # in one measure the probability is the mean over the records
    assert fit.mean_over(0.9, second) == pytest.approx(
        [fit.probability(0.9, second).mean()]
    )


def test_interaction_is_found_where_there_is_one_and_kept_in_the_fit():
    table = laboratory(np.random.default_rng(4), 40, interaction=0.8)
    fit = fit_vector(table, MEASURES)
    found = fit.interaction
    assert found.kept and found.p < 0.01 and found.likelihood_ratio > 10
    assert len(fit.coefficients) == 4
    value, *_ = fit.contour(0.5, [1.3])
    assert fit.probability(value, 1.3) == pytest.approx(0.5)


def test_one_earthquake_gives_no_limits_and_says_so():
    table = laboratory(np.random.default_rng(5), 1, motions=30)
    fit = fit_vector(table, MEASURES)
    _, lower, upper = fit.contour(0.5, [1.0])
    assert lower == 0 and upper == np.inf
    assert any("one earthquake" in note for note in fit.warnings)


@pytest.mark.parametrize(("earthquakes", "doubted"), [(3, True), (4, False)])
def test_limits_are_doubted_from_fewer_earthquakes_than_were_validated(
    earthquakes, doubted
):
    fit = fit_vector(laboratory(np.random.default_rng(8), earthquakes, 12), MEASURES)
    assert any("were not validated" in note for note in fit.warnings) == doubted


def test_of_two_earthquakes_each_is_left_out_once():
    table = laboratory(np.random.default_rng(7), 2, motions=20)
    fit = fit_vector(table, MEASURES)
    assert len(fit.replicates) == 2
    for name, left in zip(("0", "1"), fit.replicates, strict=True):
        other = table[table["earthquake"] != name]
        x = sm.add_constant(np.log(other[list(MEASURES)].to_numpy()))
        alone = sm.Probit(other["overturned"].to_numpy(), x).fit(disp=0)
        assert left == pytest.approx(alone.params, rel=1e-3)


def test_separation_by_a_plane_is_found_and_said():
    table = laboratory(np.random.default_rng(6), 4)
    index = np.log(table[MEASURES[0]]) + np.log(table[MEASURES[1]])
    table["overturned"] = (index > 0).astype(int)
    design = np.column_stack([np.ones(len(table)), np.log(table[list(MEASURES)])])
    assert linearly_separable(design, table["overturned"].to_numpy())
    assert not linearly_separable(design, np.arange(len(table)) % 2)
    fit = fit_vector(table, MEASURES)
    assert (
        any("separates" in note for note in fit.warnings) and "penalised" in fit.method
    )
    assert np.isfinite(fit.coefficients).all() and np.abs(fit.coefficients[1]) < 50


def test_fit_that_describes_its_outcomes_is_not_rejected_and_another_is():
    rng = np.random.default_rng(8)
    table = laboratory(rng, 30)
    good = check_vector(fit_vector(table, MEASURES), table)
    assert not good.rejected
    # outcomes that fall and rise again with the first measure
    index = np.abs(np.log(table["pga_g"])) - 0.6 + rng.normal(0, 0.1, len(table))
    bad = table.assign(overturned=(index > 0).astype(int))
    assert check_vector(fit_vector(bad, MEASURES), bad).rejected


def test_nonparametric_surface_rises_both_ways_and_keeps_the_number_overturned():
    table = laboratory(np.random.default_rng(9), 20)
    fit = fit_vector(table, MEASURES)
    surface = check_vector(fit, table).surface
    assert surface["tests"].sum() == len(table)
    assert (surface["probability"] * surface["tests"]).sum() == pytest.approx(
        table["overturned"].sum(), rel=1e-6
    )
    wide = surface.pivot_table("probability", MEASURES[0], MEASURES[1]).to_numpy()
    for rows in (wide, wide.T):
        for values in rows:
            assert (np.diff(values[~np.isnan(values)]) >= -1e-6).all()


def test_surface_of_one_row_is_isotonic_regression():
    fell = np.array([[0.0, 2.0, 1.0, 4.0]])
    tests = np.array([[4.0, 4.0, 4.0, 4.0]])
    assert monotone_probability(fell, tests)[0] == pytest.approx([0, 0.375, 0.375, 1])


def test_shakebot_tests_tell_velocity_from_acceleration(shared):
    table = pd.read_csv(shared / "measured" / "shakebot" / "september_0.csv")
    table["overturned"] = (table["toppled"] == "yes").astype(int)
    fit = fit_vector(table, MEASURES, earthquake=None)
    assert fit.n == 83 and fit.n_overturned == 46
    assert min(fit.coefficients[1:3]) > 0


@pytest.mark.parametrize("pair", [("pga_g", "pgv_cm_s"), ("pgv_cm_s", "pga_g")])
def test_contours_are_of_the_measure_that_decides_and_are_drawn(pair: tuple[str, str]):
    rng = np.random.default_rng(0)
    pga, pgv = np.exp(rng.normal(-1, 0.5, 300)), np.exp(rng.normal(3.7, 0.6, 300))
    fell = rng.random(300) < (pgv / 40) ** 4 / (1 + (pgv / 40) ** 4)
    about = {
        "earthquake": np.arange(300) % 12,
        "motion": np.arange(300),
        "overturned": fell,
    }
    table = pd.DataFrame({"pga_g": pga, "pgv_cm_s": pgv, **about})
    found = vector_tables({"T1": table}, (pair,))
    assert set(found.contours["of"]) == {"pgv_cm_s"}
    lines = two_measures_figure(found.contours, found.cells).axes[0].lines
    assert all(np.isfinite(line.get_xydata()).all(axis=1).sum() > 10 for line in lines)


def test_tables_hold_the_fit_its_contours_and_its_cells_and_a_figure_is_drawn_of_them():
    table = laboratory(np.random.default_rng(10), 12)
    table["twice_g"] = 2 * table["pga_g"]
    agreeing = table.assign(overturned=0)
    found = vector_tables(
        {"T1": table, "T2": agreeing}, (MEASURES, ("pga_g", "twice_g"))
    )
    fitted, proportional, other, _ = found.fits.to_dict("records")
    fit = fit_vector(table, MEASURES, source="T1")
    assert (fitted["c0"], fitted["c1"], fitted["c2"]) == fit.coefficients[:3]
    for row, said in ((other, "all 360 tests"), (proportional, "proportional")):
        assert row["method"] == "none" and said in row["warnings"]
    middle = found.contours[found.contours["probability"] == 0.5]
    assert set(middle["of"]) == {"pga_g"}
    assert fit.probability(middle["value"], middle["at"]) == pytest.approx(0.5)
    axes = two_measures_figure(found.contours, found.cells).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("PGA [g]", "PGV/PGA [s]")


@pytest.mark.slow
@pytest.mark.parametrize("earthquakes", [4, 10, 40])
def test_limits_cover_and_the_interaction_test_keeps_its_level(earthquakes):
    rng = np.random.default_rng(earthquakes)
    held = np.zeros(2)
    found, laboratories = 0, 1000
    for _ in range(laboratories):
        fit = fit_vector(laboratory(rng, earthquakes), MEASURES, level=0.90)
        found += fit.interaction.p < 0.05
        for of, other, truth in (
            (0, 1.35, 1.35**-VELOCITY),
            (1, 0.8, 0.8 ** (-1 / VELOCITY)),
        ):
            _, lower, upper = fit.contour(0.5, [other], of=of)
            held[of] += lower[0] <= truth <= upper[0]
    print(
        f"{earthquakes} earthquakes: covered {held / laboratories}, level {found / laboratories}"
    )
    assert (abs(held / laboratories - 0.90) <= 0.03).all()
    assert abs(found / laboratories - 0.05) <= 0.02


@pytest.mark.parametrize("seed", [2, 4])
def test_tables_hold_the_coefficient_of_a_product_that_earned_its_place(seed):
    """At 4 the slope by one measure nearly vanishes at some value of the other: limits are infinite there."""
    table = laboratory(np.random.default_rng(seed), 10, interaction=0.8)
    fit = fit_vector(table, MEASURES)
    assert fit.interaction.kept
    row = vector_tables({"T1": table}, (MEASURES,)).fits.iloc[0]
    assert tuple(row[["c0", "c1", "c2", "c12"]]) == fit.coefficients
    assert (row["aic"], row["p_interaction"]) == (fit.aic, fit.interaction.p)
