"""A study runs once at a time, and a run that was killed is taken up without a hand."""

import errno
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import psutil
import pytest

from rockfrag.errors import InputError
from rockfrag.stages import one_run
from rockfrag.stages.log import in_words, logged
from rockfrag.stages.means import check_folders
from rockfrag.stages.one_run import RUNS, TOKEN, only_run
from rockfrag.stages.same_numbers import same_numbers

from .test_run import ROOT

LAUNCHER = ROOT / "workflow" / "run.py"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def holder(folder: Path, then: str) -> subprocess.Popen[str]:
    """A process that runs the study ``tiny`` and does something."""
    program = (
        "import subprocess, sys, time\nfrom pathlib import Path\n"
        "from rockfrag.stages.one_run import only_run\n"
        f"with only_run('tiny', Path('results')):\n    {then}\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", program], cwd=folder, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline().strip() == "there"
    return process


def test_a_second_run_is_told_in_which_process_the_first_one_is(here: Path):
    first = holder(here, "print('there', flush=True); time.sleep(60)")
    try:
        with (
            pytest.raises(InputError, match=f"running in process {first.pid} since"),
            only_run("tiny", here / "results"),
        ):
            pass
        with only_run("another", here / "results"):
            pass
    finally:
        first.kill()
        first.communicate()


def test_what_a_killed_run_left_running_or_half_written_goes(here: Path):
    (here / "results" / "tiny").mkdir(parents=True)
    part = here / "results" / "tiny" / ".tests.csv.abc.part"
    part.write_text("half")
    sleep = "[sys.executable, '-c', 'import time; time.sleep(60)'], stdout=-3"
    first = holder(
        here, f"job = subprocess.Popen({sleep}); print('there', flush=True); time.sleep(60)"
    )
    orphans = _children(first.pid)
    assert orphans
    first.kill()
    first.wait()
    assert first.stdout is not None
    first.stdout.close()
    assert all(_alive(one) for one in orphans)
    with only_run("tiny", here / "results"):
        assert not any(_alive(one) for one in orphans)
        assert not part.exists()
    assert json.loads((RUNS / "tiny.json").read_text()) == {}


def test_a_job_that_has_only_just_been_started_is_found_too(
    here: Path, monkeypatch: pytest.MonkeyPatch
):
    """Between its new memory and its new environment the kernel shows neither arguments nor environment."""
    RUNS.mkdir(parents=True)
    (RUNS / "tiny.json").write_text('{"process": 1, "started": 0, "token": "of the dead run"}')
    program = "print('there', flush=True); import time; time.sleep(60)"
    environment = {**os.environ, TOKEN: "of the dead run"}
    with subprocess.Popen(
        [sys.executable, "-c", program], env=environment, stdout=subprocess.PIPE
    ) as job:
        assert job.stdout is not None
        job.stdout.readline()
        looks = {"environ": 0, "cmdline": 0}

        def hidden_at_first(what: str) -> Callable[[psutil.Process], object]:
            shown = getattr(psutil.Process, what)

            def look(process: psutil.Process) -> object:
                if process.pid != job.pid:
                    return shown(process)
                looks[what] += 1
                return shown(process) if looks[what] > 3 else type(shown(process))()

            return look

        for what in looks:
            monkeypatch.setattr(psutil.Process, what, hidden_at_first(what))
        try:
            with only_run("tiny", here / "results"):
                assert job.poll() is not None
        finally:
            job.kill()


def test_a_job_that_has_ended_but_is_still_listed_keeps_nobody_waiting(here: Path):
    environment = {**os.environ, TOKEN: "of the dead run"}
    command = [sys.executable, "-c", "print('there', flush=True); import time; time.sleep(60)"]
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE) as job:
        assert job.stdout is not None
        job.stdout.readline()
        # nobody asks how it ended before the block does
        started = time.monotonic()
        one_run._end_all("of the dead run")
        assert time.monotonic() - started < one_run._PATIENCE / 2
        assert psutil.Process(job.pid).status() == psutil.STATUS_ZOMBIE


def test_a_process_that_never_has_arguments_or_environment_keeps_nobody_waiting(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr(psutil.Process, "environ", lambda process: {})
    monkeypatch.setattr(psutil.Process, "cmdline", lambda process: [])
    monkeypatch.setattr(one_run, "_PATIENCE", 0.05)
    assert one_run._processes_of("of the dead run") == []


def test_who_runs_a_study_is_written_whole(here: Path):
    RUNS.mkdir(parents=True)
    (RUNS / "tiny.json").write_text("{}")
    # whoever reads it meanwhile has the old text or the new, nothing between
    with (RUNS / "tiny.json").open() as reading, only_run("tiny", here / "results"):
        assert reading.read() == "{}"
        assert json.loads((RUNS / "tiny.json").read_text())["process"] == os.getpid()


def test_what_a_killed_job_left_half_written_goes_with_the_next_run(here: Path):
    with only_run("tiny", here / "results"):
        pass
    (here / "results" / "tiny" / "figures").mkdir(parents=True)
    part = here / "results" / "tiny" / "figures" / ".one.svg.abc.part"
    part.write_text("half")
    with only_run("tiny", here / "results"):
        assert not part.exists()


def _children(process: int) -> list[int]:
    deadline = time.monotonic() + 10
    listed: list[int] = []
    while not listed and time.monotonic() < deadline:
        text = Path(f"/proc/{process}/task/{process}/children").read_text()
        listed = [int(word) for word in text.split()]
    return listed


def _alive(process: int) -> bool:
    stat = Path(f"/proc/{process}/stat")
    return stat.exists() and stat.read_text().rsplit(")", 1)[1].split()[0] != "Z"


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (OSError(errno.ENOSPC, "No space left on device", "t.csv"), "disk is full"),
        (OSError("Error writing bytes to file. Detail: No space left on device"), "disk is full"),
        (OSError(errno.EFBIG, "File too large"), "disk is full"),
        (PermissionError(errno.EACCES, "Permission denied", "t.csv"), "t.csv may not be written"),
        (MemoryError("Unable to allocate 1. TiB"), "not enough memory"),
        (ValueError("a\nb"), "ValueError: a b"),
    ],
)
def test_what_a_machine_lacks_is_said_in_a_sentence(error: Exception, words: str):
    assert words in in_words(error)
    assert "\n" not in in_words(error)


def test_a_job_that_may_not_write_its_log_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    (tmp_path / "file").write_text("")
    with pytest.raises(SystemExit), logged(str(tmp_path / "file" / "x.log"), "sweep"):
        pass
    said = capsys.readouterr().err
    assert said.startswith("sweep failed: ")
    assert said.count("\n") == 1


@pytest.mark.parametrize("mebibytes", [300, 1000])
def test_a_run_that_may_not_have_the_memory_it_needs_says_so_at_once(mebibytes: int):
    """OpenBLAS would wait for ever for what it is refused while it is loaded."""
    pytest.importorskip("resource")
    # of this process alone, as a limit that was lowered is not raised again
    program = (
        f"import resource, runpy, sys; resource.setrlimit(resource.RLIMIT_AS, ({mebibytes << 20},) * 2); "
        f"sys.argv = ['run.py', 'no.yaml']; runpy.run_path({str(LAUNCHER)!r}, run_name='__main__')"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert done.stderr.startswith(f"a process may reserve {mebibytes} MiB of memory here")
    assert done.stderr.count("\n") == 1


def test_a_folder_of_results_that_may_not_be_written_is_named_before_the_first_job(
    here: Path, monkeypatch: pytest.MonkeyPatch
):
    figures = here / "results" / "tiny" / "figures"
    check_folders(figures.parent)
    figures.mkdir(parents=True)
    check_folders(figures.parent)
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != figures)
    with pytest.raises(PermissionError) as told:
        check_folders(figures.parent)
    assert "figures may not be written" in in_words(told.value)


@pytest.mark.slow
def test_a_run_killed_at_any_level_ends_in_the_same_bytes(study_folder: Path):
    from .test_run import tables_of

    command = [sys.executable, str(LAUNCHER), "study.yaml", "--cores", "2"]
    wanted = None
    for wait in (None, 6.0, 12.0):
        process = subprocess.Popen([*command, "--logger", "rockfrag"], cwd=study_folder)
        if wait is not None:
            time.sleep(wait)
            process.kill()
        process.wait()
        done = subprocess.run(command, cwd=study_folder, capture_output=True, text=True, check=True)
        assert "LockException" not in done.stderr
        found = tables_of(study_folder)
        wanted = wanted or found
        assert found == wanted
        subprocess.run(["rm", "-r", str(study_folder / "results")], check=True)


def test_libraries_take_what_every_processor_has(monkeypatch: pytest.MonkeyPatch):
    chosen = same_numbers({"GLIBC_TUNABLES": "glibc.malloc.check=1:glibc.cpu.hwcaps=-AVX2"})
    assert chosen["GLIBC_TUNABLES"].startswith("glibc.malloc.check=1:glibc.cpu.hwcaps=-FMA,")
    assert chosen["OPENBLAS_NUM_THREADS"] == "1"
    program = "import numpy; print(numpy.show_config(mode='dicts')['SIMD Extensions'].get('found'))"
    found = subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        env={**os.environ, **chosen},
        capture_output=True,
        text=True,
        check=True,
    )
    assert found.stdout.strip() == "None"


FOREIGN = {
    "OPENBLAS_CORETYPE": "Haswell",
    "NPY_DISABLE_CPU_FEATURES": "X86_V4",
    "NUMBA_CPU_NAME": "generic",
    "NUMBA_CPU_FEATURES": "",
    "PYTHONHASHSEED": "77",
    "TZ": "Asia/Tokyo",
    "LC_ALL": "de_DE.UTF-8",
    "OPENBLAS_NUM_THREADS": "2",
}


@pytest.mark.slow
def test_the_same_bytes_on_other_processors_and_in_other_places(
    study_folder: Path, monkeypatch: pytest.MonkeyPatch
):
    from .conftest import study_content, write_study
    from .test_run import tables_of

    (study_folder / "building.yaml").write_text((ROOT / "config" / "building.yaml").read_text())
    content = {**study_content(), "building": "building.yaml"}
    content["fragility"]["measures"] = ["pga_g", "pgv_cm_s", "sa_0_3s_g"]
    write_study(study_folder, content)
    command = [sys.executable, str(LAUNCHER), "study.yaml", "--cores", "2"]
    found = []
    for more in ({}, FOREIGN):
        environment = {**os.environ, **more}
        subprocess.run(command, cwd=study_folder, env=environment, capture_output=True, check=True)
        found.append(tables_of(study_folder))
        subprocess.run(["rm", "-r", str(study_folder / "results")], check=True)
    assert found[0] == found[1]
