"""The table of measures: a row per motion, units in the names."""

import math
import warnings
import weakref

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import PPoly, make_interp_spline

from rockfrag import motions as m
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY as G
from rockfrag.motions import intensity, processing
from rockfrag.motions.intensity import housner_and_average
from rockfrag.records.motion import Motion, integrate, peak_displacement, peak_velocity

COLUMNS = [
    *(
        "name",
        "earthquake",
        "floor",
        "pga_g",
        "pgv_cm_s",
        "pgd_cm",
        "pgv_over_pga_s",
        "arias_m_s",
    ),
    *("cav_m_s", "d5_75_s", "d5_95_s", "mean_period_s", "predominant_period_s"),
    *(
        "sa_0_3s_g",
        "sv_0_3s_cm_s",
        "sd_0_3s_cm",
        "sa_1_0s_g",
        "sv_1_0s_cm_s",
        "sd_1_0s_cm",
    ),
    *(
        "avgsa_g",
        "housner_cm",
        "pulse_period_s",
        "pulse_velocity_cm_s",
        "pulse_explained",
    ),
]


@pytest.fixture
def named(noise):
    """Maker of motions with a name, an earthquake and a floor."""

    def make(name: str, seed: int) -> Motion:
        about = {"earthquake": "Nowhere", "floor": "roof"}
        return noise(seed, 600, tapered=True, name=name, metadata=about)

    return make


def test_table_has_a_row_per_motion_in_the_order_given(named):
    table = m.measure_motions([named("b", 1), named("a", 2)])
    assert list(table.columns) == COLUMNS
    assert table["name"].tolist() == ["b", "a"]
    assert set(table["floor"]) == {"roof"}
    assert table.select_dtypes("number").notna().all(axis=None)


def test_units_are_those_of_the_names(named):
    motion = named("one", 3)
    row = m.measure_motion(motion)
    assert row["pga_g"] * G == pytest.approx(m.pga(motion))
    assert row["pgv_cm_s"] / 100 == pytest.approx(m.pgv(motion))
    assert row["pgd_cm"] / 100 == pytest.approx(intensity.pgd(motion))
    spectrum = m.response_spectrum(motion, [0.3, *np.arange(0.2, 2.1, 0.2)])
    assert row["sd_0_3s_cm"] / 100 == pytest.approx(spectrum.displacement[0])
    assert row["sa_0_3s_g"] * G == pytest.approx(spectrum.pseudo_acceleration[0])
    average = np.exp(np.log(spectrum.pseudo_acceleration[1:]).mean())
    assert row["avgsa_g"] * G == pytest.approx(average, rel=1e-6)
    other = m.measure_motion(motion, periods=(0.05, 2, 1.25))
    names = [key for key in other if key.startswith("sa_")]
    assert names == ["sa_0_05s_g", "sa_2_0s_g", "sa_1_25s_g"]


def test_motion_of_zeros_has_nan_where_nothing_is_defined():
    row = m.measure_motion(Motion(np.zeros(50), 0.01, "still"))
    undefined = {
        key for key, value in row.items() if isinstance(value, float) and value != value
    }
    assert undefined == {
        *(
            "pgv_over_pga_s",
            "d5_75_s",
            "d5_95_s",
            "mean_period_s",
            "predominant_period_s",
        ),
        *("pulse_period_s", "pulse_velocity_cm_s", "pulse_explained"),
    }
    assert (
        row["arias_m_s"] == row["cav_m_s"] == row["pgd_cm"] == row["housner_cm"] == 0.0
    )
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
        f"rotd{p}_{name}"
        for name in ("pga_g", "pgv_cm_s", "sa_0_5s_g")
        for p in (50, 100)
    ]
    assert row["rotd50_pga_g"] * G == pytest.approx(m.rotd(first, second, m.pga, 50))
    assert row["rotd100_pgv_cm_s"] / 100 == pytest.approx(
        m.rotd(first, second, m.pgv, 100)
    )
    sa = m.rotd(
        first, second, lambda motion: intensity.spectral_acceleration(motion, 0.5), 100
    )
    assert row["rotd100_sa_0_5s_g"] * G == pytest.approx(sa)


# a drawing of whole thousandths keeps zeros and repeated values likely and overflow impossible
accelerations = st.lists(st.integers(-5000, 5000), min_size=2, max_size=30).map(
    lambda values: np.array(values) / 1000
)


@settings(max_examples=150)
@given(accelerations)
def test_integrals_and_their_peaks_are_those_of_scipys_piecewise_polynomials(
    acceleration,
):
    dt = 0.5
    spline = make_interp_spline(np.arange(acceleration.size) * dt, acceleration, k=1)
    velocity = PPoly.from_spline(spline).antiderivative()
    displacement = velocity.antiderivative()
    ends = np.arange(acceleration.size) * dt
    curves = zip(
        (velocity, displacement),
        integrate(acceleration, dt),
        (peak_velocity, peak_displacement),
        strict=True,
    )
    for curve, at_samples, ours in curves:
        np.testing.assert_allclose(at_samples, curve(ends), rtol=1e-12, atol=1e-13)
        # a stretch of zero slope has NaN among its roots; its ends are in the list already
        roots = curve.derivative().roots(extrapolate=False)
        instants = np.concatenate([ends, roots[np.isfinite(roots)]])
        peak = np.abs(curve(instants)).max()
        assert ours(acceleration, dt) == pytest.approx(peak, rel=1e-9, abs=1e-9)


@pytest.fixture(scope="module")
def harmonic() -> Motion:
    """Ten cycles of 2 m/s² and half a second."""
    return m.sine(2.0, 0.5, 10, dt=0.001)


def test_sine_has_its_closed_forms(harmonic):
    amplitude, period, length = 2.0, 0.5, 5.0
    omega = 2 * math.pi / period
    assert m.pga(harmonic) == pytest.approx(amplitude, rel=1e-9)
    # from rest the velocity is a/ω (1 - cos ωt) and the displacement grows by a/ω in each second
    assert m.pgv(harmonic) == pytest.approx(2 * amplitude / omega, rel=1e-4)
    assert intensity.pgd(harmonic) == pytest.approx(
        amplitude / omega * length, rel=1e-4
    )
    assert intensity.arias(harmonic) == pytest.approx(
        math.pi / (2 * G) * amplitude**2 * length / 2
    )
    assert intensity.cav(harmonic) == pytest.approx(
        2 / math.pi * amplitude * length, rel=1e-4
    )
    assert intensity.predominant_period(harmonic) == pytest.approx(period, rel=0.012)
    assert intensity.pgv_over_pga(harmonic) == pytest.approx(2 / omega, rel=1e-4)


def test_steady_shaking_has_the_fractions_of_its_length_as_durations():
    steady = Motion(np.full(1001, -3.0), 0.01)
    assert intensity.significant_duration(steady) == pytest.approx(9.0)
    assert intensity.significant_duration(steady, 0.05, 0.75) == pytest.approx(7.0)
    assert intensity.arias_times(steady, 0.25, 0.5) == pytest.approx((2.5, 5.0))


def test_mean_period_weighs_periods_of_its_band_with_squared_amplitudes():
    time = np.arange(4000) * 0.01
    two = np.sin(2 * np.pi * 2.0 * time) + 2 * np.sin(2 * np.pi * 10.0 * time)
    beyond = 5 * np.sin(2 * np.pi * 30.0 * time)
    assert intensity.mean_period(Motion(two + beyond, 0.01)) == pytest.approx(
        (0.5 + 4 * 0.1) / 5, rel=1e-6
    )


def test_housner_intensity_of_a_short_pulse_is_its_impulse_times_the_range_of_periods():
    # an undamped oscillator keeps the pseudo-velocity that the impulse gave it
    pulse = m.rectangular(100.0, 0.002, dt=0.001)
    assert housner_and_average(pulse, damping=0.0)[0] == pytest.approx(
        0.2 * 2.4, rel=1e-3
    )


def test_block_starts_to_rock_at_an_uplift_ratio_of_one():
    b, h = 0.05, 0.2
    motion = m.sine(b / h * G, 0.5, 1)
    assert intensity.uplift_ratio(motion, math.atan2(b, h)) == pytest.approx(1.0)


def test_rocking_measures_have_no_dimension(harmonic):
    alpha, p = 0.2, 2.5
    # a block four times as large under a motion that lasts twice as long: the same measures
    slower = processing.compress_time(harmonic, 0.5)
    blocks = {"block": (alpha, p), "large": (alpha, p / 2)}
    table = m.measure_rocking([harmonic, slower], blocks)
    assert table["block"].tolist() == ["block", "large"] * 2
    measures = table.iloc[0]
    assert table.iloc[3, 2:].tolist() == pytest.approx(measures[2:].tolist(), rel=2e-3)
    assert measures["velocity_ratio"] == pytest.approx(
        p * m.pgv(harmonic) / (G * math.tan(alpha))
    )
    pulse = m.strongest_pulse(harmonic)
    assert measures["frequency_ratio"] == pytest.approx(2 * math.pi / pulse.period / p)


POWERS = {
    m.pga: (1, 0), m.pgv: (1, 1), intensity.pgd: (1, 2), intensity.cav: (1, 1), intensity.arias: (2, 1),
    intensity.pgv_over_pga: (0, 1), intensity.significant_duration: (0, 1),
}  # fmt: skip
"""Powers of amplitude and of time with which measures grow."""


@settings(max_examples=20)
@given(st.integers(0, 10_000), st.floats(0.01, 100.0), st.floats(0.2, 5.0))
def test_measures_grow_with_amplitude_and_time_as_they_should(
    noise, seed, factor, time
):
    motion = noise(seed, tapered=True)
    scaled = processing.compress_time(m.scale(motion, factor), 1 / time)
    for measure, (of_amplitude, of_time) in POWERS.items():
        expected = measure(motion) * factor**of_amplitude * time**of_time
        assert measure(scaled) == pytest.approx(expected, rel=1e-9)
    expected = factor * intensity.spectral_acceleration(motion, 0.5)
    assert intensity.spectral_acceleration(scaled, 0.5 * time) == pytest.approx(
        expected, rel=1e-9
    )


def test_block_without_a_critical_angle_is_refused(harmonic):
    with pytest.raises(InputError, match="alpha"):
        intensity.uplift_ratio(harmonic, 0.0)
    with pytest.raises(InputError, match="alpha"):
        intensity.velocity_ratio(harmonic, math.nan, 2.0)
    with pytest.raises(InputError, match="p: expected a positive number"):
        intensity.frequency_ratio(0.5, 0.0)


def peer(name: str):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pytest.importorskip(name, reason=f"{name} is not installed")


@pytest.fixture(scope="module")
def motion(noise) -> Motion:
    return Motion(
        np.pad(noise(11, 2000, tapered=True).acceleration, (1, 1)), 0.01, "noise"
    )


@pytest.mark.peers
def test_rotated_spectra_are_pyrotds(motion):
    pyrotd = peer("pyrotd")
    other = Motion(np.roll(motion.acceleration, 37) * 0.8, motion.dt)
    fine = [
        processing.interpolate(processing.pad(x, 0.0, 60.0), 0.002).acceleration
        for x in (motion, other)
    ]
    theirs = pyrotd.calc_rotated_spec_accels(
        0.002,
        *fine,
        np.array([2.0]),
        0.05,
        percentiles=[50, 100],
        angles=np.arange(180),
    )
    for percentile, value in zip((50, 100), theirs["spec_accel"], strict=True):
        ours = m.rotd(
            motion, other, lambda x: intensity.spectral_acceleration(x, 0.5), percentile
        )
        assert ours == pytest.approx(float(value), rel=2e-4)
