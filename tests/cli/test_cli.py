"""The command line says what a person wants to know, and one sentence where it cannot."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import rockfrag
from rockfrag.cli.main import main, with_negative_sizes
from rockfrag.cli.simulated import _friction, contact_event_lines

from ..workflow.conftest import write_example, write_synthetic

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def record(tmp_path: Path) -> Path:
    """A record of a 2 Hz burst with a peak of 0.4 g."""
    time = np.arange(400) * 0.01
    acceleration = 0.4 * np.sin(4 * np.pi * time) * (time < 2)
    path = tmp_path / "burst.txt"
    rows = (f"{t:.2f} {a:.8f}" for t, a in zip(time, acceleration, strict=True))
    path.write_text("\n".join(rows) + "\n")
    return path


@pytest.fixture
def simulated(record, capsys):
    """Run ``rockfrag simulate`` on the record and return what it wrote."""

    def run(*options: str, path: Path = record, unit: str = "g", status: int = 0):
        assert main(["simulate", str(path), "--unit", unit, *options]) == status
        return capsys.readouterr()

    return run


def test_play_writes_a_page_that_loads_nothing(record, tmp_path, capsys):
    page = tmp_path / "page.html"
    case = [str(record), "--unit", "g", "--body", "30cm", "120cm", "110kg"]
    assert (
        main(
            [
                "play",
                *case,
                "--pedestal",
                "50cm",
                "60cm",
                "350kg",
                "--output",
                str(page),
            ]
        )
        == 0
    )
    assert str(page) in capsys.readouterr().out
    text = page.read_text(encoding="utf-8")
    assert "30 × 120\u00a0cm on 50 × 60\u00a0cm" in text
    assert 'src="http' not in text
    assert main(["play", *case, "--output", "page.pdf"]) == 2
    assert "ends in .html" in capsys.readouterr().err


def test_a_body_without_a_mass_is_of_stone_and_one_of_four_numbers_is_none(simulated):
    # 2500 kg/m³ over 0.3 m by 0.3 m by 1.2 m
    stone, given = (
        simulated("--body", "30cm", "120cm", *mass) for mass in ([], ["270kg"])
    )
    assert stone == given
    wrong = simulated("--body", "30cm", "120cm", "270kg", "4", status=2)
    assert wrong.err.startswith("--body: expected width, height and")


def test_info_draws_a_record(record: Path, tmp_path: Path):
    picture = tmp_path / "record.png"
    assert main(["info", str(record), "--unit", "g", "--picture", str(picture)]) == 0
    assert picture.stat().st_size > 5000


def test_a_squat_block_does_not_rock_and_a_slender_one_overturns(simulated):
    assert "never rocked" in simulated("--body", "1.0", "1.0", "1000").out
    slender = simulated("--body", "0.05", "0.5", "3", "--pga", "0.8")
    assert "overturned: the block" in slender.out
    # in any unit
    assert simulated("--body", "5cm", "500 mm", "3000g", "--pga", "0.8") == slender


STATUE = ("--body", "0.124", "0.372", "2.172")


def test_a_statue_on_its_pedestal_is_drawn(simulated, tmp_path):
    picture = tmp_path / "response.svg"
    shown = simulated(
        *STATUE, "--pedestal", "0.184", "0.208", "2.3", "--plot", str(picture)
    )
    assert "rest → 4" in shown.out
    assert picture.read_text().startswith("<?xml")


def test_a_vertical_component_shakes_too(simulated, record):
    case = ("--body", "0.2", "0.8", "60", "--pga", "0.3")
    both = simulated(*case, "--vertical", str(record), "--friction", "0.6")
    assert both.out != simulated(*case).out


HELD = {
    "--wall": (("2cm", "0.05"), "wall 1: largest force"),
    "--kerb": (("0.01", "0.1"), "wall 1: largest force"),
    "--putty": (("0.04kN",), "bond 1: largest force 40 N; broke at"),
    "--cord": (("100kN/m", "2 mm"), "tie 2: largest force"),
    "--bracket": (("1e6",), "tie 1: largest force"),
    "--pendulum": (("2", "0.05", "0.2"), "support: stroke"),
    "--springs": (("0.3kN/m", "30N", "20cm"), "support: stroke"),
}


def test_what_holds_a_body_is_told_with_what_it_had_to_bear(simulated):
    case = ("--body", "0.2", "0.8", "60", "--pga", "0.45", "--friction", "0.5")
    for option, (numbers, says) in HELD.items():
        assert says in simulated(*case, option, *numbers).out
    free = simulated(*case, "--casters", "free").out
    assert "largest rotation [rad]: 0.00000" in free and "slip " in free
    assert simulated(*case, "--casters", "locked").out == simulated(*case).out
    wrong = simulated(*case, "--pendulum", "2", status=2)
    assert wrong.err.startswith("--pendulum: expected 2 to 4 numbers, got 1.")
    two = ("--pendulum", "2", "0.05", "--springs", "300", "30")
    wrong = simulated(*case, *two, status=2)
    assert wrong.err.startswith("--springs: there is a --pendulum already")
    wrong = simulated(*case, "--putty", "1500N", "1500N", "40cm", status=2)
    assert "the pads lie outside the base" in wrong.err
    assert "give 0.1 m at most" in wrong.err
    wrong = simulated(*case, "--cord", "5kN", status=2)
    assert "expected a stiffness such as 50 kN/m in one of the units N/m" in wrong.err


def test_what_leans_at_the_end_is_told(tmp_path, capsys):
    time = np.arange(700) * 0.01
    shaken = tmp_path / "pulse.txt"
    np.savetxt(shaken, np.where(time < 0.6, 4 * np.sin(2 * np.pi * time / 0.6), 0.0))
    case = [str(shaken), "--unit", "m/s2", "--dt", "0.01", "--body", "0.3", "1.6", "99"]
    assert main(["simulate", *case, "--friction", "0.7", "--wall", "30cm"]) == 0
    told = "not overturned: it leans against a wall or hangs in a tie at the end"
    assert told in capsys.readouterr().out


def test_what_holds_a_body_in_space_says_what_it_bears_or_is_refused(simulated, record):
    case = ("--body", "0.2", "0.8", "60", "--depth", "0.2", "--second", str(record))
    for option, (numbers, says) in HELD.items():
        refused = option in ("--kerb", "--pendulum", "--springs")
        said = simulated(*case, option, *numbers, status=2 * refused)
        if refused:
            assert said.err.count("\n") == 1 and "leave" in said.err
        else:
            assert says.split(" 40 N")[0] in said.out
    free = simulated(*case, "--friction", "0.5", "--casters", "free").out
    assert "largest tilt [rad]: 0.00000" in free


def test_a_column_is_given_from_above(simulated, record, capsys):
    body = (*STATUE, "--pedestal", "0.2", "0.1", "9", "--pedestal", "0.3", "0.1", "20")
    slides = ("--pga", "0.6", "--friction", "0.6", "0.5", "0.4", "--restitution", "0.9")
    shown = simulated(*body, *slides).out
    assert len(shown.split("largest slip [mm]: ")[1].splitlines()[0].split(",")) == 3
    assert (
        "from below, got 2"
        in simulated(*body, "--friction", "0.6", "0.5", status=2).err
    )
    assert main(["play", str(record), "--unit", "g", *body, "--output", "x.html"]) == 2
    assert "two bodies on each other at most" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["simulate", "absent.dat", "--body", "1", "1", "900"], "absent.dat"),
        (["simulate", "absent.dat", "--body", "1", "-1", "1"], "height"),
        (
            ["simulate", "absent.dat", "--body", "1", "1", "900", "--plot", "x.pdf"],
            ".png or .svg",
        ),
        (["check-config", "absent.yaml"], "absent.yaml"),
    ],
)
def test_what_cannot_be_used_is_one_sentence_and_status_2(arguments, word, capsys):
    assert main(arguments) == 2
    shown = capsys.readouterr()
    assert word in shown.err
    assert shown.err.count("\n") == 1
    assert shown.out == ""


def test_a_right_configuration_is_summed_up(capsys: pytest.CaptureFixture[str]):
    assert main(["check-config", str(ROOT / "config" / "thesis.yaml")]) == 0
    assert "4 records, 3 floors, 6 configurations" in capsys.readouterr().out
    assert main(["check-config", "--quiet", str(ROOT / "config" / "thesis.yaml")]) == 0
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (["35", "120", "180"], ["--body", "0.0122 kg/m³", "less than any solid"]),
        (["0.35", "1.2", "180000"], ["more than any solid"]),
        (["35kg", "1.2", "180"], ["expected a length", "'35kg'"]),
    ],
)
def test_a_body_of_no_solid_is_refused_with_its_density(simulated, body, words):
    shown = simulated("--body", *body, status=2).err
    assert shown.count("\n") == 1
    assert all(word in shown for word in words)


def test_the_version_is_told(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit) as ended:
        main(["--version"])
    assert ended.value.code == 0
    assert capsys.readouterr().out == f"rockfrag {rockfrag.__version__}\n"


def test_a_reader_that_has_had_enough_is_no_error(record: Path):
    command = [
        sys.executable,
        "-m",
        "rockfrag.cli.main",
        "simulate",
        str(record),
        "--unit",
        "g",
    ]
    body = ["--body", "0.05", "0.5", "3", "--pga", "0.8", "--all-contact-events"]
    with subprocess.Popen(
        [*command, *body], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as run:
        run.stdout.close()
        assert run.stderr.read() == ""
        assert run.wait(120) == 0


@pytest.mark.parametrize(
    ("unit", "words"),
    [("m/s2", ["0.399 m/s²", "start rocking", "in g, multiply it by 9.81"]), ("g", [])],
)
def test_a_motion_that_looks_as_if_in_another_unit_is_doubted(simulated, unit, words):
    shown = simulated("--body", "0.1", "1", "20", unit=unit).err
    assert (shown == "") == (not words)
    assert all(word in shown for word in words)


def test_a_motion_in_cm_s2_is_refused_as_m_s2(simulated, record, tmp_path):
    rows = [line.split() for line in record.read_text().splitlines()]
    other = tmp_path / "gal.txt"
    other.write_text("".join(f"{t} {981 * float(a):.3f}\n" for t, a in rows))
    told = simulated("--body", "1", "1", "900", path=other, unit="m/s2", status=2).err
    assert "above 3 g" in told
    assert "force" not in told


def test_a_record_below_zero_throughout_takes_its_vertical_component_along(
    simulated, tmp_path
):
    path = tmp_path / "below.txt"
    values = -0.3 * np.sin(np.pi * np.arange(101) / 100) ** 2
    path.write_text(
        "\n".join(f"{0.01 * i:.2f} {a:.8f}" for i, a in enumerate(values)) + "\n"
    )
    body = ("--body", "30cm", "90cm", "--pga", "0.5", "--vertical", str(path))
    assert "peak 0.5000 g" in simulated(*body, path=path).out


def test_a_peak_is_said_with_its_unit_or_as_a_number_of_g(simulated):
    body = ("--body", "5cm", "50cm", "3kg")
    plain = simulated(*body, "--pga", "0.6").out
    assert simulated(*body, "--pga", "0.6g").out == plain
    assert simulated(*body, "--pga", "5.886 m/s2").out == plain
    said = simulated(*body, "--pga", "0.6 kg", status=2).err
    assert said.startswith("--pga: ") and said.count("\n") == 1


def test_a_negative_size_behind_an_option_is_no_option():
    given = ["assess", "--cg-offset", "-2cm", "--width=35cm", "--pga", "-.3g", "--json"]
    assert with_negative_sizes(given) == [
        *("assess", "--cg-offset=-2cm", "--width=35cm", "--pga=-.3g", "--json"),
    ]


def test_a_number_that_is_none_is_refused_in_plain_words(capsys):
    with pytest.raises(SystemExit):
        main(["simulate", "x.txt", "--body", "1", "2", "--dt", "soon"])
    assert "--dt: expected a number, got 'soon'" in capsys.readouterr().err


def test_friction_that_no_surface_has_is_said_in_words():
    lines = [_friction(value) for value in (0.3512, 1e6, float("inf"), float("nan"))]
    assert lines == ["0.351", *["none is enough"] * 3]


def test_a_table_of_tests_is_looked_into_before_it_is_called_right(tmp_path, capsys):
    write_synthetic(tmp_path)
    path = write_example(tmp_path, "synthetic.csv")
    assert main(["check-config", str(path)]) == 0
    table = tmp_path / "synthetic.csv"
    rows = table.read_text().splitlines()
    rows[3] = rows[3].rpartition(",")[0] + ",collapsed"
    table.write_text("\n".join(rows) + "\n")
    assert main(["check-config", str(path)]) == 2
    assert "'collapsed'" in capsys.readouterr().err


def test_names_of_rocking_modes_are_explained():
    row = {"time": 1.0, "kind": "opening", "from": "rest", "to": "4a"}
    assert contact_event_lines([row], 5)[-1].startswith("1: both bodies rock")
    column = {**row, "to": "R00"}
    assert contact_event_lines([column], 5)[-1].startswith("a letter for each body")


def test_the_package_is_a_command_of_the_same_name():
    said = subprocess.run(
        [sys.executable, "-m", "rockfrag", "--version"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout == f"rockfrag {rockfrag.__version__}\n"
