"""Times beside samples: what is even, what may be off, and what an interval that is stated must fit."""

import re

import numpy as np
import pytest

from rockfrag.base.errors import InputError
from rockfrag.records.parsing.text_file import read_text
from rockfrag.records.parsing.time_column import JITTER, STATED_JITTER, TimeColumn
from rockfrag.records.quality_flags import quality_flags
from rockfrag.records.read import read_motion


def written(path, times, form="{:.9f}", title="Time (s),Acceleration (g)"):
    rows = [
        f"{form.format(t)},{0.2 * np.sin(4 * i / 100):.5f}" for i, t in enumerate(times)
    ]
    path.write_text("\n".join([title, *rows]) + "\n")
    return path


def noise(count, seed=1):
    """Return numbers between -1 and 1 of which the largest is near 1, shape (count,)."""
    return np.random.default_rng(seed).uniform(-1, 1, count)


EVEN = np.arange(400) * 0.01


def test_times_of_a_phone_are_read_at_their_mean_step_and_said(tmp_path):
    """Each time is off by less than a stated part of a step: no sample can be taken for its neighbour."""
    motion = read_motion(written(tmp_path / "a.csv", EVEN + 5e-4 * noise(400)))
    assert (motion.acceleration.size, motion.dt) == (400, 0.01)
    (step,) = [s for s in motion.provenance if s["step"] == "take uneven times as even"]
    assert 0.8 * 5e-4 < step["largest_deviation_s"] < 1.2 * 5e-4
    (flag,) = [f for f in quality_flags(motion) if "off even ones" in f]
    assert re.search(r"up to [3-6](\.\d)? % of a step", flag)


def test_times_in_single_precision_are_times(tmp_path):
    single = (EVEN - 113.17).astype(np.float32).astype(float)
    motion = read_motion(written(tmp_path / "a.csv", single, "{:.6f}"))
    assert (motion.acceleration.size, motion.dt) == (400, 0.01)


def test_times_far_off_even_ones_want_the_interval_which_settles_them(tmp_path):
    jitter = 0.5 * (JITTER + STATED_JITTER) * 0.01
    path = written(tmp_path / "a.csv", EVEN + jitter * noise(400))
    with pytest.raises(InputError, match=r"not equally spaced.*give dt= \(0\.01 s\)"):
        read_motion(path)
    assert read_motion(path, dt=0.01).dt == 0.01
    path = written(tmp_path / "b.csv", EVEN + 0.4 * 0.01 * noise(400))
    for dt in (None, 0.01):
        with pytest.raises(InputError, match=r"times"):
            read_motion(path, dt=dt)


@pytest.mark.parametrize("form", ["{:.2f}", "{:.6f}", "{:.6g}"])
@pytest.mark.parametrize("lost", [1, 3, 50])
@pytest.mark.parametrize("dt", [None, 0.01, 0.02])
def test_a_gap_is_a_gap_whatever_the_user_says(tmp_path, form, lost, dt):
    times = np.delete(EVEN, slice(150, 150 + lost))
    with pytest.raises(InputError, match=rf"line 152: .*gap.* {lost} are missing"):
        read_motion(written(tmp_path / "a.csv", times, form), dt=dt)


@pytest.mark.parametrize("wrong", [0.005, 0.0095, 0.0105, 0.02, 0.1, 1.0])
@pytest.mark.parametrize("off", [0.0, 5e-4])
@pytest.mark.parametrize("form", ["{:.2f}", "{:.9f}"])
def test_an_interval_that_the_times_contradict_is_refused(tmp_path, wrong, off, form):
    if off and form == "{:.2f}":
        off = 0.0
    path = written(tmp_path / "a.csv", EVEN + off * noise(400), form)
    with pytest.raises(InputError, match=rf"dt= gives {wrong:g} s, but times step by"):
        read_motion(path, dt=wrong)
    assert read_motion(path, dt=0.01).dt == 0.01


def test_a_clock_that_drifts_is_read_and_a_step_that_changes_is_not(tmp_path):
    count = np.arange(20_000)
    drifting = 0.005 * (count + 8 * np.sin(2 * np.pi * count / count.size))
    motion = read_motion(written(tmp_path / "a.csv", drifting))
    assert motion.dt == pytest.approx(0.005, rel=1e-3)
    assert any("off even ones" in flag for flag in quality_flags(motion))
    changing = np.cumsum(np.where(count < 10_000, 0.005, 0.0051))
    with pytest.raises(InputError, match=r"not equally spaced.*interpolate"):
        read_motion(written(tmp_path / "b.csv", changing))


def test_times_that_stand_still_in_print_want_the_interval(tmp_path):
    """5 ms printed to hundredths: the interval that is given fits within the rounding."""
    path = written(tmp_path / "a.csv", np.arange(400) * 0.005, "{:.2f}")
    with pytest.raises(InputError, match=r"stands still.*give the interval with dt="):
        read_motion(path)
    assert read_motion(path, dt=0.005).dt == 0.005
    with pytest.raises(InputError, match="stands still"):
        read_motion(path, dt=0.004)


def test_messages_have_the_digits_that_tell_times_apart(tmp_path):
    times = EVEN - 113.17 + 0.003 * (np.arange(400) == 200)
    with pytest.raises(InputError, match=r"-111\.167 s here"):
        read_motion(written(tmp_path / "a.csv", times, "{:.6f}"))


PRINTS = ("{:.2f}", "{:.3f}", "{:.4f}", "{:.6f}", "{:.9f}", "{:.6g}", "{:.8e}", "{!r}")


@pytest.mark.parametrize("seed", range(12))
def test_no_interval_comes_out_that_is_not_that_of_the_times(tmp_path, seed):
    """Random columns whose truth is known: the right interval or an error, and no gap is closed."""
    source = np.random.default_rng(seed)
    (tmp_path / "none.txt").write_text("x")
    text = read_text(tmp_path / "none.txt")
    read = 0
    for _ in range(150):
        dt = float(source.choice([0.02, 0.01, 1 / 128, 0.005, 0.0025, 1 / 300, 0.001]))
        count = int(source.integers(50, 1500))
        times = source.choice([0.0, dt, -113.17, 1e4]) + np.arange(count) * dt
        times += dt * source.choice([0, 0, 1e-3, 0.05, 0.2, 0.4]) * noise(count, seed)
        times *= 1 + source.choice([0, 0, 3e-4])
        lost = int(source.choice([0, 0, 1, 7]))
        times = np.delete(times, slice(count // 3, count // 3 + lost))
        if source.random() < 0.2:
            times = times.astype(np.float32).astype(float)
        form = str(source.choice(PRINTS))
        printed = np.array([float(form.format(float(t))) for t in times])
        given = source.choice([0, 0, 1, 0.8, 1.25, 2]) * dt or None
        try:
            found, _ = TimeColumn(printed, text, 0).interval_beside(given, "dt= gives")
        except InputError:
            continue
        read += 1
        # 3 ms may be 2.5 ms printed to milliseconds
        rounded = given == found and form == "{:.3f}" and dt < 0.01
        assert rounded or (abs(found / dt - 1) < 2e-3 and not lost), (dt, form, given)
    assert read > 10
