"""Results follow the bytes of the user's files, whatever the times of these are."""

import io
import os
import random
import re
import shutil
import subprocess
import tarfile
import time
import zipfile
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout, suppress
from functools import reduce
from pathlib import Path
from typing import Any

import pytest
import yaml

from rockfrag.config.schema import read_schema
from rockfrag.runtime.processes import in_processes
from rockfrag.stages.running import bring_to_now
from rockfrag.study.loading import load_any
from rockfrag.study.study import Study

from ..stages_in_process import files_read
from .conftest import (
    CATALOGUE,
    STUDY,
    study_content,
    write_example,
    write_record,
    write_study,
    write_synthetic,
)
from .running import LAUNCHER, ROOT, SNAKEFILE, called, finished, snakemake

DAY_S = 86400.0
AFTER_IDA = {"tests", "fragility", "pedestal", "measured_tests", "report"}
EVERYTHING = {"motions", "ida"} | AFTER_IDA
BODIES = EVERYTHING - {"motions"}

FOLLOWS: dict[str, set[str]] = {
    "motions.csv": EVERYTHING,
    "record {0}.txt": EVERYTHING,
    "second0.txt": EVERYTHING,
    "up0.txt": EVERYTHING,
    "house.yaml": EVERYTHING,
    "specimens.csv": BODIES,
    "configurations.csv": BODIES,
    "isolators.csv": BODIES,
    "shaker.yaml": {"tests", "pedestal", "measured_tests", "report"},
    "tests.csv": {"measured_tests", "report"},
}
"""Each kind of file that a study is given, and the rules whose results depend on its bytes."""

MEASURED = (
    "test,object,pedestal,earthquake,floor,lower_g,upper_g,amplitude_g,censored,overturned_body,repetition\n"
    "1,T1,P,First,ground,0.3,0.34,0.34,none,statue,1\n"
    "2,T1,NP,First,ground,0.3,0.36,0.36,none,statue,1\n"
)


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a study with a file of each kind, some with a wildcard's name, that has run to its end."""
    folder = tmp_path_factory.mktemp("nothing stale") / "a study"
    write_study_of_all_kinds(folder)
    finished(snakemake(folder, "--cores", "2"))
    return folder


def write_study_of_all_kinds(folder: Path) -> None:
    """Write a study with a file of each kind."""
    shutil.copytree(STUDY, folder)
    (folder / "configurations.csv").write_text(
        "name,object,pedestal\nT1,T1,\nP&T1,T1,P\nT1 on dish,T1|dish,\n"
    )
    (folder / "isolators.csv").write_text(
        "name,mass_kg,radius_m,friction,stroke_cm\ndish,5,1.5,0.06,9\n"
    )
    rows = [CATALOGUE.replace(",file,", ",file,second,vertical,direction,")]
    for number, earthquake in enumerate(("First", "Second")):
        names = (f"record {{{number}}}.txt", f"second{number}.txt", f"up{number}.txt")
        for seed, name in enumerate(names):
            write_record(folder / name, 10 * number + seed, samples=300)
        # what no direction turns towards is measured
        files = ",".join((*names, ("", "stronger")[number]))
        rows.append(f"m{number},{earthquake},,,,,,folder,{files},,g,made up\n")
    (folder / "motions.csv").write_text("".join(rows))
    (folder / "house.yaml").write_text(
        "name: house\nstorey_heights_m: [3, 3]\nmasses_kg: [90000, 90000]\nfirst_period_s: 0.3\n"
        "floors: {ground: 0, top: 2}\n"
    )
    (folder / "shaker.yaml").write_text(
        "stroke_m: 0.29\nforce_n: 500\nlowest_hz: 0.5\nhighest_hz: 200\n"
        "start: off-centre\narmature_mass_kg: 5\ntable_mass_kg: 5\n"
    )
    (folder / "tests.csv").write_text(MEASURED)
    content = study_content() | {
        "vertical": True,
        "bodies": study_content()["bodies"] | {"isolators": "isolators.csv"},
        "building": "house.yaml",
        "shaker": "shaker.yaml",
        "measured_tests": "tests.csv",
        "amplitudes": {"lowest_g": 0.2, "highest_g": 1.6, "step_percent": 30},
        "protocol": {"step_percent": 30},
    }
    write_study(folder, content)


def reruns(folder: Path) -> set[str]:
    """Rules that a run would compute again."""
    # in a fork, which has loaded what a run needs: a process of its own takes five times as long
    import snakemake.cli  # noqa: F401

    return in_processes(_planned, [folder], 2)[0]


def _planned(folder: Path) -> set[str]:
    from snakemake.cli import main

    said = io.StringIO()
    study = ["--directory", str(folder), "--configfile", str(folder / "study.yaml")]
    with redirect_stdout(said), redirect_stderr(io.StringIO()):
        try:
            main(["--snakefile", SNAKEFILE, *study, "--dry-run"])
        except SystemExit as end:
            assert not end.code, said.getvalue()
    planned = re.findall(r"^(\w+) +(\d+)$", said.getvalue(), re.MULTILINE)
    return {name for name, _ in planned if name not in ("all", "total")}


TIMES: dict[str, Callable[[float], float]] = {
    "long ago": lambda now: now - 1000 * DAY_S,
    "now": lambda now: now,
    "ahead": lambda now: now + DAY_S,
}


@pytest.mark.slow
def test_bytes_make_rules_run_again_and_times_do_not(ran: Path):
    for name in FOLLOWS:
        ahead = time.time() + DAY_S
        os.utime(ran / name, (ahead, ahead))
    # with an older file in the place of another
    check(ran, "record {0}.txt", "long ago")
    check(ran, "shaker.yaml", "ahead")


@pytest.mark.slow
@pytest.mark.parametrize("when", TIMES)
@pytest.mark.parametrize("name", FOLLOWS)
def test_each_kind_of_file_makes_what_depends_on_it_run_again(
    ran: Path, name: str, when: str
):
    check(ran, name, when)


def check(folder: Path, name: str, when: str) -> None:
    file = folder / name
    kept = file.read_bytes()
    try:
        file.write_bytes(kept + b"\n")
        os.utime(file, (TIMES[when](time.time()),) * 2)
        assert reruns(folder) == FOLLOWS[name]
    finally:
        file.write_bytes(kept)
        os.utime(file, (TIMES[when](time.time()),) * 2)
    assert reruns(folder) == set()


def by_move(new: Path, file: Path) -> None:
    new.rename(file)


def by_copy(new: Path, file: Path) -> None:
    shutil.copy2(new, file)


def by_plain_copy(new: Path, file: Path) -> None:
    shutil.copy(new, file)


def by_tar(new: Path, file: Path) -> None:
    """Unpack it out of an archive, which keeps times."""
    packed = new.with_suffix(".tar")
    with tarfile.open(packed, "w") as archive:
        archive.add(new, arcname=file.name)
    if shutil.which("tar"):
        command = ["tar", "-x", "-f", str(packed), "-C", str(file.parent)]
        subprocess.run(command, check=True)
    else:
        with tarfile.open(packed) as archive:
            archive.extractall(file.parent, filter="data")


def by_zip(new: Path, file: Path) -> None:
    """Unpack it out of an archive, which keeps local times to two seconds."""
    packed = new.with_suffix(".zip")
    with zipfile.ZipFile(packed, "w") as archive:
        archive.write(new, arcname=file.name)
    if shutil.which("unzip"):
        command = ["unzip", "-o", "-q", str(packed), "-d", str(file.parent)]
        subprocess.run(command, check=True)
    else:
        with zipfile.ZipFile(packed) as archive:
            archive.extract(file.name, file.parent)


def by_rsync(new: Path, file: Path) -> None:
    if shutil.which("rsync"):
        subprocess.run(["rsync", "-a", str(new), str(file)], check=True)
    else:
        # it writes beside the file, sets the time and renames
        part = file.with_name(f".{file.name}.part")
        shutil.copy2(new, part)
        part.replace(file)


def by_link(new: Path, file: Path) -> None:
    """Put a link in its place."""
    file.unlink()
    file.symlink_to(new)


def by_writing(new: Path, file: Path) -> None:
    """Write into it and set its time."""
    file.write_bytes(new.read_bytes())
    os.utime(file, ns=(new.stat().st_mtime_ns,) * 2)


WAYS = (by_move, by_copy, by_plain_copy, by_tar, by_zip, by_rsync, by_link, by_writing)


@pytest.mark.slow
def test_forty_files_in_the_places_of_others(ran: Path, tmp_path: Path):
    """Older, newer, from the future, or the same bytes, put there in eight ways."""
    rng = random.Random(57)
    ways = [*WAYS] * 5
    rng.shuffle(ways)
    for number, way in enumerate(ways):
        name = rng.choice([*FOLLOWS])
        is_other, when = rng.random() < 0.6, rng.choice([*TIMES])
        file, kept = ran / name, (ran / name).read_bytes()
        new = tmp_path / f"new {number}"
        new.write_bytes(kept + b"\n" if is_other else kept)
        os.utime(new, (TIMES[when](time.time()),) * 2)
        try:
            way(new, file)
            wanted = FOLLOWS[name] if is_other else set()
            assert reruns(ran) == wanted, (number, way.__name__, name, is_other, when)
        finally:
            with suppress(FileNotFoundError):
                file.unlink()
            file.write_bytes(kept)
    assert reruns(ran) == set()


@pytest.fixture
def whole_study(tmp_path: Path) -> Path:
    """The folder of a study with a file of each kind, which has not run."""
    write_study_of_all_kinds(tmp_path / "a study")
    return tmp_path / "a study"


def test_every_file_that_a_study_may_name_is_named_and_of_a_kind_that_is_tried(
    whole_study: Path,
):
    content = yaml.safe_load((whole_study / "study.yaml").read_text())
    named = {key: _at(content, key) for key in _keys_of_files(read_schema("study"))}
    assert set(named.values()) <= set(FOLLOWS), named


def _keys_of_files(schema: dict[str, Any], above: tuple[str, ...] = ()) -> list[tuple]:
    """Keys of a schema that take the path of a file."""
    if str(schema.get("description")).startswith("the path of "):
        return [above]
    below = schema.get("properties", {}).items()
    return [key for name, part in below for key in _keys_of_files(part, (*above, name))]


def _at(content: Any, key: tuple[str, ...]) -> Any:
    return reduce(lambda part, name: part.get(name), key, content)


@pytest.mark.slow
def test_every_file_that_a_study_reads_makes_something_run_again(whole_study: Path):
    """Those that it names nowhere too, as what lies beside a record."""
    path = whole_study / "study.yaml"
    study = load_any(path)
    assert isinstance(study, Study)
    named = {*study.motion_files, *study.body_files}
    named |= {str(study.shaker_file), str(study.measured_tests), str(path)}
    read = files_read(path)
    assert {*map(str, read)} == named


@pytest.mark.slow
def test_a_table_in_the_place_of_another_is_read_and_one_from_the_future_too(
    tmp_path: Path,
):
    table = write_synthetic(tmp_path)
    study = write_example(tmp_path, table.name, replicates=20)
    # a name that is data, and neither an option nor a wildcard
    study.rename(tmp_path / "-{c}.yaml")
    run = (*LAUNCHER, "-{c}.yaml", "--cores", "1", "--logger", "rockfrag")
    ahead = time.time() + DAY_S
    os.utime(table, (ahead, ahead))
    finished(called(tmp_path, *run))
    curves = tmp_path / "results" / "measured-example" / "fragility.csv"
    first = curves.read_bytes()
    lines = table.read_text().splitlines(keepends=True)
    table.write_text("".join(lines[:120]))
    os.utime(table, (0, 0))
    finished(called(tmp_path, *run))
    second = curves.read_bytes()
    assert second != first
    # the clock is set back: what was written seems to be of tomorrow
    for path in (tmp_path / "results").rglob("*"):
        os.utime(path, (ahead, ahead))
    table.write_text("".join(lines))
    finished(called(tmp_path, *run))
    assert curves.read_bytes() == first


def test_times_ahead_come_back_in_their_order(tmp_path: Path):
    now = time.time_ns()
    moments = {"a": now - 5, "b": now + 10**12, "c": now + 10**13, "d": now + 10**12}
    for name, moment in moments.items():
        (tmp_path / name).touch()
        os.utime(tmp_path / name, ns=(moment, moment))
    bring_to_now(tmp_path.iterdir())
    found = {name: (tmp_path / name).stat().st_mtime_ns for name in moments}
    assert found["a"] == moments["a"] < found["b"] == found["d"] < found["c"]
    assert found["c"] <= time.time_ns()


def test_the_studies_of_the_project_name_no_file_as_an_input_of_a_rule():
    """Of an input Snakemake looks at the time; what the user gives goes in among the settings."""
    for path in (ROOT / "workflow" / "rules").glob("*.smk"):
        for block in re.findall(
            r"^    +input:\n((?:^     +.*\n|\n)+?)(?=^    +output:)",
            path.read_text(),
            re.MULTILINE,
        ):
            assert "_file" not in block and ".files" not in block, path
