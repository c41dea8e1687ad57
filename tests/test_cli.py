"""The command line says what a person wants to know, and one sentence where it cannot."""

from pathlib import Path

import numpy as np
import pytest

from rockfrag.cli import main

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture
def record(tmp_path: Path) -> Path:
    """A record of a 2 Hz burst with a peak of 0.4 g."""
    time = np.arange(400) * 0.01
    acceleration = 0.4 * np.sin(4 * np.pi * time) * (time < 2)
    path = tmp_path / "burst.txt"
    rows = (f"{t:.2f} {a:.8f}" for t, a in zip(time, acceleration, strict=True))
    path.write_text("\n".join(rows) + "\n")
    return path


def test_info_tells_peak_and_does_not_stop_at_a_bad_file(
    record: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    bad = tmp_path / "bad.AT2"
    bad.write_text("nothing of the kind\n")
    assert main(["info", str(bad), str(record), "--unit", "g"]) == 1
    shown = capsys.readouterr()
    assert "0.4" in shown.out
    assert "bad.AT2" in shown.err
    assert "Traceback" not in shown.err


def test_info_draws_a_record(record: Path, tmp_path: Path):
    picture = tmp_path / "record.png"
    assert main(["info", str(record), "--unit", "g", "--picture", str(picture)]) == 0
    assert picture.stat().st_size > 5000


def test_a_squat_block_does_not_rock_and_a_slender_one_overturns(
    record: Path, capsys: pytest.CaptureFixture[str]
):
    block = ["simulate", str(record), "--unit", "g", "--body"]
    assert main([*block, "1.0", "1.0", "1000"]) == 0
    assert "never rocked" in capsys.readouterr().out
    assert main([*block, "0.05", "0.5", "3", "--pga", "0.8"]) == 0
    assert "overturned: the block" in capsys.readouterr().out


def test_a_statue_on_its_pedestal_is_drawn(
    record: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    picture = tmp_path / "response.svg"
    body = ["--body", "0.124", "0.372", "2.172", "--pedestal", "0.184", "0.208", "2.3"]
    arguments = ["simulate", str(record), "--unit", "g", *body, "--plot", str(picture)]
    assert main(arguments) == 0
    assert "rest → 4" in capsys.readouterr().out
    assert picture.read_text().startswith("<?xml")


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["simulate", "absent.dat", "--body", "1", "1", "1"], "absent.dat"),
        (["simulate", "absent.dat", "--body", "1", "-1", "1"], "height"),
        (["simulate", "absent.dat", "--body", "1", "1", "1", "--plot", "x.pdf"], ".png or .svg"),
        (["check-config", "absent.yaml"], "absent.yaml"),
    ],
)
def test_what_cannot_be_used_is_one_sentence_and_status_2(
    arguments: list[str], word: str, capsys: pytest.CaptureFixture[str]
):
    assert main(arguments) == 2
    shown = capsys.readouterr()
    assert word in shown.err
    assert shown.err.count("\n") == 1
    assert shown.out == ""


def test_a_right_configuration_is_summed_up(capsys: pytest.CaptureFixture[str]):
    assert main(["check-config", str(ROOT / "config" / "thesis.yaml")]) == 0
    assert "4 records, 6 configurations" in capsys.readouterr().out
    assert main(["check-config", "--report", str(ROOT / "config" / "thesis.yaml")]) == 0
    assert "results/thesis/report.html" in capsys.readouterr().out
