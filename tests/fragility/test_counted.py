"""IDA curves counted part by part give the curves of the table with a row per outcome."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.fragility.counted import count_ida
from rockfrag.fragility.empirical import TableIda, resurrections_of
from rockfrag.fragility.estimators import fragility_of
from rockfrag.fragility.ida_curves import outcome_bins, with_measures
from rockfrag.fragility.measure_selection import area_under_curve
from rockfrag.shaketable.definitions import Swept

MOTIONS = 24
AMPLITUDES = np.geomspace(0.05, 2.0, 120)


def parts(size: int) -> list[Swept]:
    """Motions of eight earthquakes that overturn above scattered amplitudes, most with a resurrection."""
    rng = np.random.default_rng(4)
    capacity = 0.4 * np.exp(0.35 * rng.normal(size=MOTIONS))
    near = np.abs(np.log(AMPLITUDES / capacity[:, None])) < 0.15
    fell = (capacity[:, None] < AMPLITUDES) ^ (near & (rng.random(near.shape) < 0.1))
    about = pd.DataFrame(
        {
            "configuration": "T",
            "earthquake": [f"earthquake {k // 3}" for k in range(MOTIONS)],
            "floor": "ground",
            "motion": [f"motion {k}" for k in range(MOTIONS)],
        }
    )
    return [
        Swept(
            about.iloc[i : i + size].reset_index(drop=True),
            AMPLITUDES,
            fell[i : i + size],
            fell[i : i + size].astype(np.intp),
            ("", "statue"),
        )
        for i in range(0, MOTIONS, size)
    ]


def measures() -> pd.DataFrame:
    rng = np.random.default_rng(5)
    return pd.DataFrame(
        {
            "name": [f"motion {k}" for k in range(MOTIONS)],
            "pga_g": rng.uniform(0.1, 0.6, MOTIONS),
            "pgv_cm_s": rng.uniform(5, 50, MOTIONS),
            "arias_m_s": rng.uniform(0.1, 2, MOTIONS),
        }
    )


def rows() -> pd.DataFrame:
    return parts(MOTIONS)[0].rows(("configuration", "earthquake", "floor", "motion"))


@pytest.mark.parametrize("column", ["pga_g", "pgv_cm_s", "arias_m_s"])
def test_counts_give_the_curve_of_the_rows(column: str):
    wanted = {"": [column], "ground": [column]}
    counted = count_ida(resurrections_of(parts(5)), parts(5), measures(), wanted)["ground"]
    table = TableIda(with_measures(rows(), measures(), [column]))
    few, many = counted.outcomes(column), table.outcomes(column)
    assert (few.n, few.n_overturned) == (many.n, many.n_overturned)
    assert (few.n_motions, few.n_earthquakes) == (many.n_motions, many.n_earthquakes)
    found, known = fragility_of(few), fragility_of(many)
    # a cell's width in units of β, squared, is what cells change
    assert found.fit.theta == pytest.approx(known.fit.theta, rel=1e-4)
    assert found.fit.beta == pytest.approx(known.fit.beta, rel=1e-3)
    assert found.fit.log_likelihood == pytest.approx(known.fit.log_likelihood, rel=1e-3)
    assert found.interval.theta == pytest.approx(known.interval.theta, rel=1e-3)
    assert found.interval.groups == known.interval.groups == 8
    assert found.checks.p_fit == pytest.approx(known.checks.p_fit, abs=0.02)
    assert area_under_curve(few) == pytest.approx(area_under_curve(many), abs=1e-3)
    bins = [outcome_bins({}, found, few), outcome_bins({}, known, many)]
    assert bins[0]["fraction"].to_numpy() == pytest.approx(bins[1]["fraction"].to_numpy(), abs=0.03)
    assert bins[0]["motions"].to_numpy() == pytest.approx(bins[1]["motions"].to_numpy(), abs=1)


def test_parts_change_nothing_and_windows_are_those_of_the_table():
    known = TableIda(rows()).resurrections("amplitude_g")
    counted = [
        count_ida(resurrections_of(parts(k)), parts(k), measures(), {"": ["pga_g"]})[""]
        for k in (1, 7, 24)
    ]
    for found in counted:
        windows = found.resurrections("amplitude_g")[known.columns]
        pd.testing.assert_frame_equal(windows, known, check_dtype=False)
        outcomes = found.outcomes("pga_g").overturned
        assert np.array_equal(outcomes, counted[0].outcomes("pga_g").overturned)
