"""Named steps: what each does to a motion, what is recorded, what is refused."""

import json
import re

import numpy as np
import pytest
from scipy.signal import butter, sosfilt

from rockfrag import motions as m
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY as G
from rockfrag.motions import intensity, processing
from rockfrag.records.motion import Motion, read_motion_set, write_motion_set

from ..case_tables import case_tables

TABLES = case_tables(__file__)


@pytest.fixture(scope="module")
def record(noise) -> Motion:
    """Ten seconds of noise that has been read from somewhere."""
    return noise(0, 1000, tapered=True, name="noise", provenance=({"step": "read"},))


def tone(hertz: float, seconds: float = 40.0, dt: float = 0.01) -> Motion:
    return Motion(np.sin(2 * np.pi * hertz * np.arange(round(seconds / dt)) * dt), dt)


def middle(samples: np.ndarray) -> np.ndarray:
    third = samples.size // 3
    return samples[third : 2 * third]


# --- the chain


def test_steps_are_taken_in_order_and_recorded(record, tmp_path):
    steps = [
        {"step": "pad", "before_s": 1, "after_s": 2},
        {"step": "highpass", "corner_hz": 0.2, "order": 2},
        {"step": "scale_to_pga", "pga_g": 0.3},
    ]
    assert m.process(record, []) is record
    processed = m.process(record, steps)
    assert len(processed.provenance) == 4
    for given, recorded in zip(steps, processed.provenance[1:], strict=True):
        assert given.items() <= recorded.items()
    by_hand = m.scale_to_pga(
        processing.highpass(processing.pad(record, 1, 2), 0.2, 2), 0.3
    )
    np.testing.assert_array_equal(processed.acceleration, by_hand.acceleration)
    # the record of the steps survives the file between two stages
    write_motion_set([processed], tmp_path / "motions.parquet")
    assert read_motion_set(tmp_path / "motions.parquet")[0].provenance == tuple(
        json.loads(json.dumps(processed.provenance))
    )


@pytest.mark.parametrize(("steps", "message"), TABLES["unknown"])
def test_unknown_steps_and_parameters_are_refused_with_what_is_known(
    record, steps, message
):
    with pytest.raises(InputError, match=message):
        m.process(record, steps)


@pytest.mark.parametrize(("step", "message"), TABLES["impossible"])
def test_impossible_parameters_are_refused_in_one_sentence(record, step, message):
    with pytest.raises(InputError, match=message) as refusal:
        m.process(record, [step])
    text = str(refusal.value)
    assert text.startswith(f"step {step['step']}: ")
    assert text.endswith(".")


@pytest.mark.parametrize(
    "name", [*filter(re.compile("scale_to|strong").match, processing.STEPS)]
)
def test_motion_of_zeros_can_not_be_scaled_or_cut_to_its_strong_part(name):
    with pytest.raises(InputError, match="zero throughout"):
        m.process(
            Motion(np.zeros(100), 0.01),
            [{"step": name, **TABLES["parameters"].get(name, {})}],
        )


@pytest.mark.parametrize("name", list(processing.STEPS))
def test_every_step_takes_or_refuses_a_motion_of_one_sample(name):
    try:
        processed = m.process(
            Motion([1.0], 0.01), [{"step": name, **TABLES["parameters"].get(name, {})}]
        )
    except InputError as refusal:
        assert str(refusal).startswith(f"step {name}: ")
    else:
        assert np.isfinite(processed.acceleration).all()


# --- zero line and ends


@pytest.mark.parametrize(
    ("step", "taken"), [(processing.demean, 3.0), (processing.remove_median, 2.0)]
)
def test_a_zero_line_is_taken_off_and_said(step, taken):
    still = step(Motion(np.array([1.0, 2.0, 6.0]), 0.01))
    assert still.acceleration.tolist() == [1.0 - taken, 2.0 - taken, 6.0 - taken]
    assert still.provenance[-1]["removed_m_s2"] == taken


@pytest.mark.parametrize("order", [0, 1, 3, 6])
def test_baseline_takes_out_a_polynomial_and_nothing_else(record, order):
    x = np.linspace(-1, 1, record.acceleration.size)
    drift = np.polynomial.polynomial.polyval(x, np.arange(1, order + 2) * 0.1)
    clean = processing.baseline(record, order)
    dirty = processing.baseline(Motion(record.acceleration + drift, record.dt), order)
    np.testing.assert_allclose(dirty.acceleration, clean.acceleration, atol=1e-12)


def test_displacement_baseline_takes_out_the_drift_of_a_displacement():
    # a displacement of 0.2 x² - 0.1 x³ on 10 s has a linear acceleration
    x = np.linspace(0, 1, 1001)
    drifting = Motion((0.4 - 0.6 * x) / 100, 0.01)
    assert intensity.pgd(
        processing.displacement_baseline(drifting)
    ) < 1e-9 * intensity.pgd(drifting)


def test_displacement_baseline_takes_a_smooth_line_from_the_acceleration(noise):
    motion = noise(0, 4000, tapered=True)
    straightened = processing.displacement_baseline(motion, 6)
    assert intensity.pgd(straightened) < 0.5 * intensity.pgd(motion)
    taken = motion.acceleration - straightened.acceleration
    # the second derivative of a polynomial of order six is one of order four
    fit = np.polynomial.Polynomial.fit(motion.time, taken, 4)
    np.testing.assert_allclose(fit(motion.time), taken, atol=1e-12)


def test_taper_brings_the_ends_to_zero_and_leaves_the_middle():
    tapered = processing.taper(Motion(np.ones(1001), 0.01), 2.0)
    assert tapered.acceleration[0] == tapered.acceleration[-1] == 0.0
    assert (tapered.acceleration[200:801] == 1.0).all()
    # half a cosine bell is at half its height in its middle
    assert tapered.acceleration[100] == pytest.approx(0.5)


def test_pads_change_nothing_but_the_time(record):
    padded = processing.pad(record, 1.5, 2.5)
    assert padded.acceleration.size == record.acceleration.size + 400
    assert m.pgv(padded) == pytest.approx(m.pgv(record))
    assert intensity.arias(padded) == pytest.approx(intensity.arias(record))


# --- filters and sampling


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize(
    ("kind", "corners"),
    [("highpass", [1.0]), ("lowpass", [1.0]), ("bandpass", [1.0, 10.0])],
)
def test_filters_are_butterworth_forwards_and_backwards(record, kind, corners, order):
    sos = butter(order, np.squeeze(corners), kind, fs=100.0, output="sos")
    forwards = sosfilt(sos, record.acceleration)
    expected = sosfilt(sos, forwards[::-1])[::-1]
    filtered = getattr(processing, kind)(record, *corners, order)
    np.testing.assert_allclose(filtered.acceleration, expected, atol=1e-10)


@pytest.mark.parametrize("dt", [0.005, 0.02, 0.0125])
def test_resampling_keeps_a_band_limited_signal(dt):
    resampled = processing.resample(tone(3.0), dt)
    assert resampled.dt == dt
    expected = np.sin(2 * np.pi * 3.0 * resampled.time)
    np.testing.assert_allclose(
        middle(resampled.acceleration), middle(expected), atol=2e-3
    )


@pytest.mark.parametrize("dt", [0.005, 0.004, 0.02])
def test_resampling_does_not_ring_where_a_motion_does_not_begin_or_end_at_zero(dt):
    constant = processing.resample(Motion(np.ones(400), 0.01), dt)
    np.testing.assert_allclose(constant.acceleration, 1.0, atol=1e-3)
    assert constant.time[-1] <= 3.99 + 1e-12
    line = processing.resample(Motion(np.linspace(0.5, 2.0, 401), 0.01), dt)
    np.testing.assert_allclose(line.acceleration, 0.5 + 1.5 * line.time / 4, atol=2e-3)


def test_steps_that_change_the_peak_say_so_and_can_be_taken_again(record):
    steps = [
        {"step": "highpass", "corner_hz": 1.0},
        {"step": "lowpass", "corner_hz": 20.0, "causal": True},
        {"step": "resample", "dt_s": 0.004},
        {"step": "demean"},
    ]
    once = m.process(record, steps)
    before = record.pga
    for entry in once.provenance[1:4]:
        assert entry["peak_before_m_s2"] == before
        assert entry["peak_after_m_s2"] != before
        before = entry["peak_after_m_s2"]
    again = m.process(record, once.provenance[1:])
    np.testing.assert_array_equal(once.acceleration, again.acceleration)


def test_a_filter_without_pads_says_what_it_leaves_at_the_ends():
    offset = Motion(np.ones(2000), 0.01)
    ends = processing.highpass(offset, 0.5).provenance[-1]["ends_m_s2"]
    assert max(map(abs, ends)) > 0.1
    padded = processing.highpass(processing.pad(offset, 30, 30), 0.5).provenance[-1][
        "ends_m_s2"
    ]
    assert max(map(abs, padded)) < 1e-6


@pytest.mark.parametrize("order", [2, 4])
def test_a_causal_filter_is_the_butterworth_filter_itself(order):
    impulse = np.zeros(4000)
    impulse[1000] = 1.0
    filtered = processing.lowpass(
        Motion(impulse, 0.01), 5.0, order, causal=True
    ).acceleration
    sections = butter(order, 5.0, "lowpass", fs=100, output="sos")
    np.testing.assert_allclose(filtered, sosfilt(sections, impulse), atol=1e-12)
    with pytest.raises(InputError, match="causal must be true or false"):
        processing.bandpass(Motion(impulse, 0.01), 1.0, 5.0, causal="yes")


def test_resampling_does_not_alias():
    # 40 Hz would appear as 10 Hz at 50 samples a second
    assert (
        np.abs(middle(processing.resample(tone(40.0), 0.02).acceleration)).max() < 0.01
    )


def test_interpolating_keeps_the_motion(record):
    fine = processing.interpolate(record, 0.002)
    assert fine.acceleration.size == 5 * (record.acceleration.size - 1) + 1
    np.testing.assert_array_equal(fine.acceleration[::5], record.acceleration)
    for measure in (
        m.pga,
        m.pgv,
        intensity.pgd,
        lambda x: intensity.spectral_acceleration(x, 0.1),
    ):
        assert measure(fine) == pytest.approx(measure(record), rel=1e-7)


# --- selection and scaling


def test_strong_part_holds_its_share_of_the_intensity(record):
    strong = processing.strong_part(record, 0.05, 0.95)
    assert intensity.arias(strong) == pytest.approx(
        0.9 * intensity.arias(record), rel=0.02
    )
    assert len(strong.time) * 0.01 == pytest.approx(
        intensity.significant_duration(record), abs=0.03
    )


def test_bracketed_part_begins_and_ends_at_the_threshold():
    motion = Motion(np.array([0.0, 0.1, 0.6, -0.1, -0.5, 0.3]) * G, 0.01)
    kept = processing.bracketed_part(motion, 0.5).acceleration / G
    np.testing.assert_allclose(kept, [0.6, -0.1, -0.5])


def test_trim_keeps_both_ends_of_its_window():
    motion = Motion(np.arange(101.0), 0.1)
    assert processing.trim(motion, 2.0, 3.0).acceleration.tolist() == list(
        range(20, 31)
    )
    assert processing.trim(motion, 0.0, 10.0).acceleration.size == 101


def test_scaling_reaches_its_target(record):
    assert m.pga(m.scale_to_pga(record, 0.4)) == pytest.approx(0.4 * G)
    assert m.pgv(m.scale_to_pgv(record, 30.0)) == pytest.approx(0.30)
    assert intensity.arias(processing.scale_to_arias(record, 1.7)) == pytest.approx(1.7)
    scaled = processing.scale_to_sa(record, 0.5, 0.8, 0.02)
    assert intensity.spectral_acceleration(scaled, 0.8, 0.02) == pytest.approx(0.5 * G)
    factor = scaled.provenance[-1]["factor"]
    np.testing.assert_allclose(scaled.acceleration, factor * record.acceleration)


def test_start_time_moves_with_the_first_sample():
    motion = Motion(
        np.ones(1001), 0.01, metadata={"start_time": "2016-11-13T11:03:00.000000Z"}
    )
    assert (
        processing.pad(motion, 1.5).metadata["start_time"]
        == "2016-11-13T11:02:58.500000Z"
    )
    assert (
        processing.trim(motion, 2.25, 4.0).metadata["start_time"]
        == "2016-11-13T11:03:02.250000Z"
    )
    unknown = Motion(np.ones(1001), 0.01, metadata={"start_time": None})
    assert processing.trim(unknown, 2.25, 4.0).metadata["start_time"] is None
