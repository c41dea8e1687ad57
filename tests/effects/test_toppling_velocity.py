"""Medians over size from simulations: weights of earthquakes, fits, and the surface against other sizes."""

import re
from pathlib import Path

import numpy as np
import pytest

from rockfrag import InputError
from rockfrag.effects.shaken_records import Records
from rockfrag.effects.toppling_causes import (
    BOOKCASES,
    CAUSES,
    ShakenPieces,
    cause_named,
    causes_table,
)
from rockfrag.effects.toppling_velocity import (
    Shaken,
    earthquake_weights,
    grid_of_sizes,
    medians_by,
    random_sizes,
    shaken_in_plane,
    shaken_in_space,
    surface_coefficients,
    velocity_levels,
)
from rockfrag.fragility.toppling_velocity import LIMITS, terms_of, toppling_velocity
from rockfrag.motions import one_sine
from rockfrag.motions.intensity import pgv
from rockfrag.simulation.closed_forms import kaneko_velocity
from rockfrag.stages.toppling_velocity import (
    BEGIN,
    END,
    around_tables,
    cause_lines,
    main,
    pieces_of,
    records_of,
)

NAMES = [cause.name for cause in CAUSES]


def made(median: float, dispersion: float, records: int = 400) -> Shaken:
    """Records whose capacities are lognormal, as if one size had been shaken."""
    rng = np.random.default_rng(3)
    capacities = median * np.exp(dispersion * rng.standard_normal(records))
    levels = np.geomspace(0.1, 10, 60)[np.newaxis]
    fell = levels[0] >= capacities[:, np.newaxis]
    return Shaken(np.array([[0.3, 1.0]]), levels, np.tile(fell, (len(LIMITS), 1, 1, 1)))


def test_the_fit_finds_median_and_dispersion_of_lognormal_capacities():
    medians, dispersions = made(0.8, 0.4).fits(np.ones((1, 400)))
    assert medians[0, 0] == pytest.approx(0.8, rel=0.05)
    assert dispersions[0, 0] == pytest.approx(0.4, rel=0.15)


def test_another_measure_moves_the_median_by_its_factor():
    shaken = made(0.8, 0.4)
    fell, levels = shaken.reached[-1, 0], shaken.levels[0]
    whole = np.ones((1, 400))
    one, _ = medians_by(fell, levels, np.ones(400), whole)
    twice, _ = medians_by(fell, levels, np.full(400, 2.0), whole)
    assert twice == pytest.approx(2 * one, rel=1e-6)
    # by the measure of the levels themselves it is the fit of all sizes
    assert one == pytest.approx(shaken.fits(whole)[0][0], rel=1e-6)


CAUSE_ROW = re.compile(r"^\| ([a-z0-9.-]+) \|.*\|$", re.MULTILINE)


def documented_causes() -> dict[str, str]:
    """Rows of the table of causes in docs/toppling-velocity.md by their names."""
    page = (Path(__file__).parents[2] / "docs" / "toppling-velocity.md").read_text()
    rows = {found[1]: found[0] for found in CAUSE_ROW.finditer(page)}
    return {name: row for name, row in rows.items() if name in NAMES}


def test_the_page_has_a_row_for_every_cause():
    assert list(documented_causes()) == NAMES


def assert_documented(records: Records, *names: str) -> None:
    shaken = ShakenPieces(records, BOOKCASES)
    table = causes_table(shaken, [cause_named(name) for name in names])
    _, _, *rows = cause_lines(table)
    for name, row in zip(names, rows, strict=True):
        assert documented_causes()[name] == row


def test_the_page_says_of_two_causes_what_the_command_prints(records):
    assert_documented(records, "own-component", "pulse")


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_page_says_of_each_cause_what_the_command_prints(records, name):
    assert_documented(records, name)


def test_a_cause_that_nobody_knows_is_refused_with_those_that_are():
    with pytest.raises(InputError, match="own-component, geometric-mean"):
        cause_named("wind")


def test_pieces_of_ones_own_are_held_against_both_curves(tmp_path):
    file = tmp_path / "own.csv"
    file.write_text("width_cm,height,fema_p58_m_s\n32.1,0.737 m,0.724\n")
    (piece,) = pieces_of(str(file)).to_dict("records")
    assert piece == pytest.approx(BOOKCASES.iloc[0].to_dict())
    file.write_text("name,width_m,height_m,fema_p58_m_s\nlow,0.321,0.737,0.724\n")
    (piece,) = pieces_of(str(file)).to_dict("records")
    assert piece.pop("name") == "low"
    assert piece == pytest.approx(BOOKCASES.iloc[0].to_dict())


def test_records_of_an_earthquake_count_together():
    names = ["a", "a", "b", "c", "c", "c"]
    weights = earthquake_weights(names, resamples=50)
    assert weights.shape == (51, 6)
    assert (weights[0] == 1).all()
    assert (weights[:, 0] == weights[:, 1]).all()
    assert (weights[:, 3] == weights[:, 5]).all()
    assert (weights[1:, [0, 2, 3]].sum(axis=1) == 3).all()


def test_sizes_fill_the_range_and_those_held_out_are_others():
    grid, others = grid_of_sizes(6, 7), random_sizes(8, 1)
    assert ((grid[:, 1] / grid[:, 0]) >= 1.25 - 1e-9).all()
    assert not {tuple(x) for x in grid} & {tuple(x) for x in others}


def test_a_surface_follows_a_law_of_powers_exactly():
    sizes = grid_of_sizes(6, 7)
    law = 0.3 + 0.5 * np.log(sizes[:, 0]) - 1.1 * np.log(sizes[:, 1] / sizes[:, 0])
    found = surface_coefficients(sizes, law)
    assert terms_of(*sizes.T) @ found == pytest.approx(law, abs=1e-9)


def test_a_block_rocks_before_it_falls_in_the_plane_and_in_space():
    motion = one_sine(1.0, period=0.6)
    sizes, velocity = np.array([[0.3, 1.2]]), np.array([pgv(motion)])
    levels = velocity_levels(sizes, np.geomspace(0.3, 4, 12))
    still = motion.after("still", np.zeros_like(motion.acceleration))
    for shaken in (
        shaken_in_plane(sizes, [motion], velocity, levels),
        shaken_in_space(sizes, "oblong", [(motion, still)], velocity, levels),
    ):
        counts = shaken.reached.sum(axis=(1, 2, 3))
        assert counts[0] > counts[-1] > 0
        assert (np.diff(counts) <= 0).all()


@pytest.fixture(scope="module")
def records(default_records) -> Records:
    return records_of(1, default_records)


@pytest.mark.slow
@pytest.mark.parametrize("standing", ["plane", "square"])
def test_the_surface_in_the_package_is_that_of_simulations_it_has_not_seen(
    records, standing
):
    sizes = random_sizes(6, 2026)
    shaken = records.shake(sizes, standing, "pgv_m_s")
    medians, dispersions = shaken.fits(records.weights(standing)[:1])
    surface, spread = toppling_velocity(*sizes.T, standing=standing)
    assert np.abs(np.log(medians[0] / surface)).max() < 0.12
    assert np.abs(dispersions[0] - spread).max() < 0.1


def test_the_surface_is_that_of_simulations_of_bookcases_in_the_plane(records):
    sizes = np.array([[0.321, 1.041], [0.321, 2.064]])
    shaken = records.shake(sizes, "plane", "pgv_m_s")
    medians, _ = shaken.fits(np.ones((1, len(records.motions))))
    surface, _ = toppling_velocity(*sizes.T)
    assert medians[0] == pytest.approx(surface, rel=0.06)
    kaneko = [kaneko_velocity(*size) for size in sizes.tolist()]
    assert medians[0] / kaneko == pytest.approx(1.22, rel=0.06)


def test_a_page_without_a_place_for_tables_is_refused_before_the_work(tmp_path, capsys):
    page = tmp_path / "page.md"
    page.write_text("# A page of somebody's\n", encoding="utf-8")
    assert main(["--page", str(page), "--output", str(tmp_path / "found")]) == 2
    assert "page.md: tables stand between the lines" in capsys.readouterr().err
    assert not (tmp_path / "found").exists()
    assert around_tables(tmp_path / "new.md") == ("", "\n")
    page.write_text(f"before {BEGIN} old {END} after", encoding="utf-8")
    assert around_tables(page) == ("before ", " after")
