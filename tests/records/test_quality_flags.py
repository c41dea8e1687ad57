"""What looks wrong in a record is said, and a record in order is not accused."""

import json

import numpy as np
import pytest

from rockfrag.cli import main
from rockfrag.records.motion import Motion
from rockfrag.records.quality_flags import quality_flags
from rockfrag.records.write import write_motion


def quake(dt=0.01, peak=3.0):
    """A burst that begins and ends quietly, its velocity back at zero."""
    t = np.arange(0, 20, dt)
    wave = np.exp(-(((t - 8) / 2.5) ** 2)) * np.sin(2 * np.pi * 1.3 * (t - 8))
    wave += 0.3 * np.exp(-(((t - 7) / 2) ** 2)) * np.sin(2 * np.pi * 4.1 * (t - 7))
    return wave * peak / np.abs(wave).max()


def said(acceleration, dt=0.01):
    return "; ".join(quality_flags(Motion(acceleration, dt)))


def test_a_record_in_order_is_not_doubted():
    assert said(quake()) == ""


@pytest.mark.parametrize(
    ("samples", "dt", "words"),
    [
        (981 * quake(), 0.01, "above 3 g"),
        (quake() + 0.3, 0.01, "a drift"),
        (np.clip(quake(), -1.5, 1.5), 0.01, "clipped"),
        (quake()[700:], 0.01, "triggered late"),
        (quake(peak=1.0) + 5 * (np.arange(2000) == 300), 0.01, "a lone spike"),
        (np.repeat(quake(0.02), 2), 0.01, "repeats the one before"),
        (np.zeros(500), 0.01, "all samples are zero"),
        (quake(0.05), 0.05, "too long"),
    ],
)
def test_what_looks_wrong_is_said(samples, dt, words):
    assert words in said(samples, dt)


def test_info_says_quality_flags_status_and_values_as_json_and_csv(tmp_path, capsys):
    write_motion(Motion(quake(), 0.01, "fine"), tmp_path / "a.AT2")
    write_motion(Motion(40 * quake(), 0.01, "strong"), tmp_path / "b.AT2")
    assert main(["info", str(tmp_path), "--format", "json"]) == 0
    fine, strong = json.loads(capsys.readouterr().out)
    assert fine["quality_flags"] == ""
    assert "above 3 g" in strong["quality_flags"]
    assert fine["pga_g"] == pytest.approx(3 / 9.81)
    (tmp_path / "c.AT2").write_text("broken")
    assert main(["info", str(tmp_path), "--format", "csv"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 4
    assert lines[0].endswith("quality_flags,error,status")
    assert lines[3].endswith("unreadable")


def test_velocities_in_a_folder_are_no_bad_files_but_named_ones_are(tmp_path, builders, capsys):
    built = builders["at2_peer"](tmp_path)
    text = built.path.read_text().replace("ACCELERATION", "VELOCITY").replace("OF G", "OF CM/S")
    (tmp_path / "peer.VT2").write_text(text)
    assert main(["info", str(tmp_path)]) == 0
    assert main(["info", str(tmp_path / "peer.VT2")]) == 1
    capsys.readouterr()


def test_a_picture_of_every_channel(tmp_path, builders, capsys):
    built = builders["geonet_v1a"](tmp_path)
    assert main(["info", str(built.path), "--pictures", str(tmp_path / "pictures")]) == 0
    assert len(list((tmp_path / "pictures").glob("*.png"))) == 3
    capsys.readouterr()
