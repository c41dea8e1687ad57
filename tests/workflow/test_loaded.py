"""Jobs run in copies of a process that has the libraries, and end as jobs that run by themselves do."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from rockfrag.stages.loaded import ADDRESS, loaded, run_in_copy
from rockfrag.yaml_file import read_yaml

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="no copies on this system")

SOCKET = Path("tiny.socket")


@pytest.fixture
def here(study_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(study_folder)
    return study_folder


@pytest.fixture
def process(here: Path) -> Iterator[psutil.Process]:
    """The process that copies are made of, once it listens."""
    with loaded(SOCKET):
        found = next(
            one for one in psutil.Process().children() if "rockfrag.stages.loaded" in one.cmdline()
        )
        until(lambda: [one for one in found.net_connections("unix") if one.laddr])
        yield found


def until(holds, seconds: float = 60.0) -> None:
    deadline = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < deadline
        time.sleep(0.02)


def job(log_file: str = "motions.log") -> dict:
    return {
        "name": "motions",
        "config": read_yaml(Path("study.yaml")),
        "study_file": "study.yaml",
        "threads": 1,
        "log_file": log_file,
    }


def asker(folder: Path) -> subprocess.Popen[bytes]:
    """A job whose copy waits, as nobody reads its log."""
    os.mkfifo("waiting")
    program = (
        "import sys\nfrom rockfrag.stages.loaded import run_in_copy\n"
        f"sys.exit(run_in_copy({job('waiting')!r}))"
    )
    return subprocess.Popen([sys.executable, "-c", program], cwd=folder)


def test_a_job_runs_in_a_copy_and_its_status_comes_back(here: Path, process: psutil.Process):
    assert run_in_copy(job()) == 0
    assert (here / "results" / "tiny" / "motions" / "ground.parquet").is_file()
    (here / "record0.txt").write_text("nothing")
    assert run_in_copy(job()) == 1
    assert "record0.txt" in (here / "motions.log").read_text()
    assert not process.children()


def test_a_copy_ends_with_its_job(here: Path, process: psutil.Process):
    asking = asker(here)
    until(process.children)
    (copy,) = process.children()
    asking.kill()
    asking.wait()
    copy.wait(60)
    assert process.is_running()


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM])
def test_a_job_fails_with_its_copy(here: Path, process: psutil.Process, end: signal.Signals):
    asking = asker(here)
    until(process.children)
    process.children()[0].send_signal(end)
    assert asking.wait(60) == 256 - end


def test_process_and_copies_end_with_their_run(here: Path):
    program = (
        "from pathlib import Path\nfrom rockfrag.stages.loaded import loaded, run_in_copy\n"
        f"with loaded(Path({str(SOCKET)!r})):\n    while True:\n"
        f"        run_in_copy({job('waiting')!r})"
    )
    os.mkfifo("waiting")
    with subprocess.Popen([sys.executable, "-c", program]) as run:
        family = psutil.Process(run.pid)
        until(lambda: len(family.children(recursive=True)) == 2)
        left = family.children(recursive=True)
        run.kill()
    assert not psutil.wait_procs(left, timeout=60)[1]
    # the socket that is left is no hindrance
    with loaded(SOCKET):
        until(lambda: run_in_copy({**job(), "threads": 2}) == 0)


def test_nothing_is_done_where_there_is_no_such_process(
    here: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.delenv(ADDRESS, raising=False)
    assert run_in_copy(job()) is None
    monkeypatch.setenv(ADDRESS, f"{os.getpid()}:{sys.prefix}:{SOCKET}")
    assert run_in_copy(job()) is None


def test_another_environment_is_not_served(
    here: Path, process: psutil.Process, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv(ADDRESS, f"{os.getpid()}:/elsewhere:{SOCKET}")
    assert run_in_copy(job()) is None


def test_a_job_that_a_queue_started_runs_by_itself(here: Path, process: psutil.Process):
    program = (
        "import os, time\nfrom rockfrag.stages.loaded import run_in_copy\nown = os.getpid()\n"
        "if os.fork():\n    os._exit(0)\n"
        "while os.getppid() == own:\n    time.sleep(0.01)\n"
        f"print(run_in_copy({job()!r}))"
    )
    # its parent is gone, and who took it over is no child of the run
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stdout == "None\n"


def test_a_job_that_is_stopped_waits_for_the_last_word_of_its_copy(
    here: Path, process: psutil.Process
):
    asking = asker(here)
    until(process.children)
    for one in (asking, process, *process.children()):
        one.send_signal(signal.SIGINT)
    assert asking.wait(60) == 1
    assert process.is_running()
