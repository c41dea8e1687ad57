"""The table of measures: a row per motion, units in the names."""

import math
import weakref

import numpy as np
import pytest

from rockfrag import motions as m
from rockfrag.errors import InputError
from rockfrag.files import write_table
from rockfrag.motions import intensity
from rockfrag.motions.intensity import housner_and_average
from rockfrag.records.motion import Motion
from rockfrag.units import GRAVITY as G

COLUMNS = [
    *("name", "earthquake", "floor", "pga_g", "pgv_cm_s", "pgd_cm", "pgv_over_pga_s", "arias_m_s"),
    *("cav_m_s", "d5_75_s", "d5_95_s", "mean_period_s", "predominant_period_s"),
    *("sa_0_3s_g", "sv_0_3s_cm_s", "sd_0_3s_cm", "sa_1_0s_g", "sv_1_0s_cm_s", "sd_1_0s_cm"),
    *("avgsa_g", "housner_cm", "pulse_period_s", "pulse_velocity_cm_s", "pulse_explained"),
]


@pytest.fixture
def named(noise):
    """Maker of motions with a name, an earthquake and a floor."""

    def make(name: str, seed: int) -> Motion:
        about = {"earthquake": "Nowhere", "floor": "roof"}
        return noise(seed, 600, tapered=True, name=name, metadata=about)

    return make


def test_table_has_a_row_per_motion_in_the_order_given(tmp_path, named):
    table = m.measure_motions([named("b", 1), named("a", 2)])
    assert list(table.columns) == COLUMNS
    assert table["name"].tolist() == ["b", "a"]
    assert set(table["floor"]) == {"roof"}
    assert table.select_dtypes("number").notna().all(axis=None)
    write_table(table, tmp_path / "measures.csv", tmp_path / "measures.parquet")


def test_units_are_those_of_the_names(named):
    motion = named("one", 3)
    row = m.measure_motion(motion)
    assert row["pga_g"] * G == pytest.approx(m.pga(motion))
    assert row["pgv_cm_s"] / 100 == pytest.approx(m.pgv(motion))
    assert row["pgd_cm"] / 100 == pytest.approx(intensity.pgd(motion))
    assert row["housner_cm"] / 100 == pytest.approx(housner_and_average(motion)[0])
    assert row["sa_0_3s_g"] * G == pytest.approx(intensity.spectral_acceleration(motion, 0.3))
    assert row["sd_0_3s_cm"] / 100 == pytest.approx(
        m.response_spectrum(motion, [0.3]).displacement[0]
    )
    periods = [round(0.2 * k, 1) for k in range(1, 11)]
    logs = [math.log(intensity.spectral_acceleration(motion, period)) for period in periods]
    assert row["avgsa_g"] * G == pytest.approx(math.exp(sum(logs) / 10), rel=1e-6)
    omega = 2 * math.pi / 0.3
    assert row["sa_0_3s_g"] * G == pytest.approx(row["sd_0_3s_cm"] / 100 * omega**2)


def test_periods_name_their_columns(named):
    row = m.measure_motion(named("one", 4), periods=(0.05, 2, 1.25), damping=0.02)
    names = [key for key in row if key.startswith("sa_")]
    assert names == ["sa_0_05s_g", "sa_2_0s_g", "sa_1_25s_g"]
    assert not [
        key for key in m.measure_motion(named("one", 4), periods=()) if key.startswith("sa_")
    ]


def test_motion_of_zeros_has_nan_where_nothing_is_defined():
    row = m.measure_motion(Motion(np.zeros(50), 0.01, "still"))
    undefined = {key for key, value in row.items() if isinstance(value, float) and value != value}
    assert undefined == {
        *("pgv_over_pga_s", "d5_75_s", "d5_95_s", "mean_period_s", "predominant_period_s"),
        *("pulse_period_s", "pulse_velocity_cm_s", "pulse_explained"),
    }
    assert row["arias_m_s"] == row["cav_m_s"] == row["pgd_cm"] == row["housner_cm"] == 0.0


def test_motion_of_one_sample_is_measured():
    assert m.measure_motion(Motion([1.0], 0.01, "one"))["pga_g"] == pytest.approx(1 / G)


def test_motions_are_taken_one_at_a_time(named):
    seen: list[weakref.ref] = []
    most = 0

    def arriving():
        nonlocal most
        for seed in range(5):
            motion = named(f"motion {seed}", seed)
            seen.append(weakref.ref(motion))
            most = max(most, sum(item() is not None for item in seen))
            yield motion
            del motion

    assert len(m.measure_motions(arriving())) == 5
    # the one that is measured and the one that comes
    assert most <= 2


def test_motions_of_one_name_are_refused(named):
    with pytest.raises(InputError, match="two motions are called 'a'"):
        m.measure_motions([named("a", 1), named("a", 2)])


def test_pair_has_the_measures_of_its_rotation(named):
    first, second = named("first", 6), named("second", 7)
    row = m.measure_pair(first, second, periods=(0.5,))
    assert list(row) == [
        f"rotd{p}_{name}" for name in ("pga_g", "pgv_cm_s", "sa_0_5s_g") for p in (50, 100)
    ]
    assert row["rotd50_pga_g"] * G == pytest.approx(m.rotd(first, second, m.pga, 50))
    assert row["rotd100_pgv_cm_s"] / 100 == pytest.approx(m.rotd(first, second, m.pgv, 100))
    sa = m.rotd(first, second, lambda motion: intensity.spectral_acceleration(motion, 0.5), 100)
    assert row["rotd100_sa_0_5s_g"] * G == pytest.approx(sa)


def test_rocking_table_has_a_row_per_motion_and_block(named):
    motions = [named("a", 8), named("b", 9)]
    blocks = {"wide": (0.32, 6.0), "slender": (0.20, 5.0)}
    table = m.measure_rocking(motions, blocks)
    assert table["name"].tolist() == ["a", "a", "b", "b"]
    assert table["block"].tolist() == ["wide", "slender", "wide", "slender"]
    alone = m.measure_rocking(motions[1:], {"slender": blocks["slender"]})
    assert table.iloc[3].tolist() == alone.iloc[0].tolist()
    assert m.measure_rocking([], blocks).empty
