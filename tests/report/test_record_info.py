"""The table and the picture of what is in a record."""

import numpy as np
import pytest

from rockfrag.base.errors import InputError
from rockfrag.records.motion import Motion
from rockfrag.report.record_info import (
    COLUMNS,
    describe_files,
    draw_record,
    record_figure,
)


@pytest.fixture
def wave():
    """One and a half cycles of 1 m/s² at 0.5 s, linear between samples."""
    t = np.arange(151) * 0.005
    return Motion(
        np.sin(2 * np.pi * t / 0.5), 0.005, name="wave", metadata={"station": "S"}
    )


def test_a_folder_is_described_and_a_bad_file_does_not_stop_the_rest(tmp_path, wave):
    samples = zip(wave.time, wave.acceleration, strict=True)
    rows = "".join(f"{a:.4f} {b:.6f}\n" for a, b in samples)
    (tmp_path / "good.txt").write_text("Time [s]  Acceleration [m/s2]\n" + rows)
    (tmp_path / "bare.txt").write_text(rows)
    (tmp_path / "broken.txt").write_text(rows.replace("0.0500 ", "0.0500 x"))
    (tmp_path / ".hidden").write_text(rows)
    table = describe_files([tmp_path])
    assert list(table.columns) == list(COLUMNS)
    bare, broken, good = table.sort_values("file").to_dict("records")
    assert (good["error"], good["npts"], good["dt_s"]) == ("", 151, 0.005)
    assert good["duration_s"] == pytest.approx(0.75)
    assert good["pga_g"] == pytest.approx(1 / 9.81, rel=1e-6)
    # ∫ sin = (1 - cos ωt)/ω peaks at 2/ω and its integral at t/ω for whole cycles
    assert good["pgv_cm_s"] == pytest.approx(100 * 2 / (4 * np.pi), rel=1e-3)
    assert "does not state its unit" in bare["error"]
    assert bare["npts"] == 151
    assert "line 11" in broken["error"]
    # a named unit is for the files that do not state theirs, and a wrong one their error
    both = [tmp_path / "good.txt", tmp_path / "bare.txt"]
    table = describe_files(both, unit="gal")
    assert table["unit"].tolist() == ["m/s2", "cm/s2"]
    assert table["pga_g"][0] == pytest.approx(100 * table["pga_g"][1])
    table = describe_files(both, unit="furlong")
    assert table["error"][0] == ""
    assert "furlong" in table["error"][1]


def test_the_picture_shows_the_exact_peaks_and_is_written_the_same_twice(
    wave, tmp_path
):
    figure = record_figure(wave)
    titles = [
        axes.get_title(loc="right") for sub in figure.subfigs for axes in sub.axes
    ]
    assert f"peak {100 * 2 / (4 * np.pi):.1f}" in titles[1][:9]
    for ending in ("png", "svg"):
        first, second = tmp_path / f"a.{ending}", tmp_path / f"b.{ending}"
        draw_record(wave, first)
        draw_record(wave, second)
        assert first.read_bytes() == second.read_bytes()
    with pytest.raises(InputError, match=r"\.png or \.svg"):
        draw_record(wave, tmp_path / "a.jpg")


def test_a_motion_of_zeros_or_of_one_sample_can_be_drawn(tmp_path):
    draw_record(Motion(np.zeros(5), 0.01), tmp_path / "zeros.png")
    draw_record(Motion(np.ones(1), 0.01), tmp_path / "one.png")
