"""The table and the picture of what is in a record."""

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.report.record_info import COLUMNS, describe_files, draw_record, record_figure


@pytest.fixture
def wave():
    """One and a half cycles of 1 m/s² at 0.5 s, linear between samples."""
    t = np.arange(151) * 0.005
    return Motion(np.sin(2 * np.pi * t / 0.5), 0.005, name="wave", metadata={"station": "S"})


@pytest.fixture
def folder(tmp_path, wave):
    t = wave.time
    rows = "".join(f"{a:.4f} {b:.6f}\n" for a, b in zip(t, wave.acceleration, strict=True))
    (tmp_path / "good.txt").write_text("Time [s]  Acceleration [m/s2]\n" + rows)
    (tmp_path / "bare.txt").write_text(rows)
    (tmp_path / "broken.txt").write_text(rows.replace("0.0500 ", "0.0500 x"))
    (tmp_path / ".hidden").write_text(rows)
    return tmp_path


def test_a_folder_is_described_and_a_bad_file_does_not_stop_the_rest(folder, wave):
    table = describe_files([folder]).set_index("file")
    assert list(table.reset_index().columns) == list(COLUMNS)
    good, bare, broken = (table.loc[str(folder / f"{n}.txt")] for n in ("good", "bare", "broken"))
    assert len(table) == 3
    assert good["error"] == ""
    assert good["npts"] == 151
    assert good["dt_s"] == 0.005
    assert good["duration_s"] == pytest.approx(0.75)
    assert good["pga_g"] == pytest.approx(1 / 9.81, rel=1e-6)
    # ∫ sin = (1 - cos ωt)/ω peaks at 2/ω and its integral at t/ω for whole cycles
    assert good["pgv_cm_s"] == pytest.approx(100 * 2 / (4 * np.pi), rel=1e-3)
    assert "does not state its unit" in bare["error"]
    assert bare["npts"] == 151
    assert "line 11" in broken["error"]


def test_a_named_unit_is_for_the_files_that_do_not_state_theirs(folder):
    table = describe_files([folder / "good.txt", folder / "bare.txt"], unit="gal")
    assert table["unit"].tolist() == ["m/s2", "cm/s2"]
    assert table["pga_g"][0] == pytest.approx(100 * table["pga_g"][1])


def test_a_wrong_unit_is_an_error_of_each_file_that_needs_one(folder):
    table = describe_files([folder / "good.txt", folder / "bare.txt"], unit="furlong")
    assert table["error"][0] == ""
    assert "furlong" in table["error"][1]


def test_the_picture_shows_the_exact_peaks_and_is_written_the_same_twice(wave, tmp_path):
    figure = record_figure(wave)
    titles = [axes.get_title(loc="right") for sub in figure.subfigs for axes in sub.axes]
    assert f"peak {100 * 2 / (4 * np.pi):.1f}" in titles[1][:9]
    for name in ("a.png", "b.png", "a.svg", "b.svg"):
        draw_record(wave, tmp_path / name)
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
    with pytest.raises(InputError, match=r"\.png or \.svg"):
        draw_record(wave, tmp_path / "a.jpg")


def test_a_motion_of_zeros_or_of_one_sample_can_be_drawn(tmp_path):
    draw_record(Motion(np.zeros(5), 0.01), tmp_path / "zeros.png")
    draw_record(Motion(np.ones(1), 0.01), tmp_path / "one.png")
