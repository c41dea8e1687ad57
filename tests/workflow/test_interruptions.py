"""A study runs once at a time, nothing outlives its run, and what was killed is taken up without a hand."""

import errno
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import psutil
import pytest

from rockfrag.base.errors import InputError
from rockfrag.runtime import lock
from rockfrag.runtime.processes import in_processes
from rockfrag.stages.log import check_folders, in_words, last_finding, logged
from rockfrag.stages.running import RUN, run_lock, same_numbers

from .running import LAUNCHER, ROOT, called


@contextmanager
def program(text: str, **more: str) -> Iterator[subprocess.Popen[str]]:
    """A program in Python that has said that it is there; it is killed at the end of the block."""
    process = subprocess.Popen(
        [sys.executable, "-c", text],
        env={**os.environ, **more},
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    try:
        assert process.stdout.readline().strip() == "there"
        yield process
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def holder(results: Path) -> AbstractContextManager[subprocess.Popen[str]]:
    """A process that runs a study."""
    return program(
        "import time\nfrom pathlib import Path\nfrom rockfrag.stages.running import run_lock\n"
        f"with run_lock(Path({str(results)!r})):\n    print('there', flush=True)\n    time.sleep(60)"
    )


def test_a_second_run_is_told_in_which_process_the_first_one_is(tmp_path: Path):
    with holder(tmp_path / "tiny") as first, run_lock(tmp_path / "another"):
        words = f"running already, in process {first.pid} since"
        with pytest.raises(InputError, match=words), run_lock(tmp_path / "tiny"):
            pass


def test_a_killed_run_leaves_neither_a_lock_nor_half_written_files(tmp_path: Path):
    part = tmp_path / "tiny" / "figures" / ".tests.csv.abc.part"
    with holder(tmp_path / "tiny"):
        part.parent.mkdir()
        part.write_text("half")
    with run_lock(tmp_path / "tiny"):
        assert not part.exists()


def test_where_there_are_no_locks_or_nothing_may_be_written_nobody_waits(
    tmp_path, monkeypatch
):
    (tmp_path / "file").write_text("")
    with lock.locked(tmp_path / "file" / "lock", patience_s=60) as free:
        assert free

    def refused(*_: object, **__: object) -> None:
        # what the system says on some network drives
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr("filelock.FileLock.acquire", refused)
    with (
        lock.locked(tmp_path / "lock", patience_s=60) as free,
        run_lock(tmp_path / "tiny"),
    ):
        assert free


def test_a_lock_that_another_process_holds_is_waited_for_no_longer_than_was_said(
    tmp_path: Path,
):
    with holder(tmp_path / "tiny") as first:
        # it would be free as soon as its owner had ended
        with lock.locked(tmp_path / "tiny" / ".lock", patience_s=0.2) as free:
            assert not free
        assert first.poll() is None


JOB = (
    "import os, time\nfrom rockfrag.runtime.processes import end_with\n"
    f"end_with(int(os.environ[{RUN!r}]))\nprint('there', flush=True)\ntime.sleep(60)"
)


@pytest.mark.parametrize("reaped", [True, False])
def test_a_job_ends_with_its_run_and_with_the_shell_that_started_it(reaped: bool):
    """Between a run and its job is a shell, which a signal to the run does not end."""
    with (
        program("import time; print('there', flush=True); time.sleep(60)") as run,
        program(JOB, **{RUN: str(run.pid)}) as job,
    ):
        run.kill()
        if reaped:
            run.wait()
        job.wait(30)


def test_a_job_whose_shell_was_killed_ends():
    text = f"import subprocess, sys\nsubprocess.run([sys.executable, '-c', {JOB!r}])"
    with program(text, **{RUN: str(os.getpid())}) as shell:
        (job,) = psutil.Process(shell.pid).children()
    job.wait(30)


POOL = (
    "import time\nfrom rockfrag.runtime.processes import in_processes\n"
    "print('there', flush=True)\nin_processes(lambda _: time.sleep(60), range(4), 3)"
)


@pytest.mark.skipif(sys.platform != "linux", reason="pools are made of forks on Linux")
def test_the_workers_of_a_pool_end_with_their_parent():
    with program(POOL) as parent:
        family = psutil.Process(parent.pid)
        while len(workers := family.children()) < 3:
            assert parent.poll() is None
            time.sleep(0.02)
    assert not psutil.wait_procs(workers, timeout=30)[1]


@pytest.mark.skipif(sys.platform != "linux", reason="pools are made of forks on Linux")
def test_a_worker_that_is_killed_is_one_sentence():
    def dies(number: int) -> int:
        if number == 2:
            os.kill(os.getpid(), signal.SIGKILL)
        return number

    with pytest.raises(BrokenProcessPool) as told:
        in_processes(dies, range(4), 2)
    assert in_words(told.value).startswith(
        "one of its processes was killed or ran out of memory"
    )


LACKED = {
    "disk is full": OSError(errno.EFBIG, "File too large"),
    "a limit of it is reached": OSError(
        "Error writing bytes. Detail: No space left on device"
    ),
    "t.csv may not be written": PermissionError(
        errno.EACCES, "Permission denied", "t.csv"
    ),
    "not enough memory": MemoryError("Unable to allocate 1. TiB"),
    "ValueError: a b": ValueError("a\nb"),
}


def test_what_a_machine_lacks_is_said_in_a_sentence(tmp_path, capsys):
    for words, error in LACKED.items():
        assert words in in_words(error) and "\n" not in in_words(error)
    # so does a job that may not write its log
    (tmp_path / "file").write_text("")
    with pytest.raises(SystemExit), logged(str(tmp_path / "file" / "x.log"), "ida"):
        pass
    said = capsys.readouterr().err
    assert said.startswith("ida failed: ") and said.count("\n") == 1


def test_a_run_that_may_not_have_the_memory_it_needs_says_so_at_once():
    """OpenBLAS would wait for ever for what it is refused while it is loaded."""
    pytest.importorskip("resource")
    # of this process alone, as a limit that was lowered is not raised again
    program = (
        "import resource, runpy, sys; resource.setrlimit(resource.RLIMIT_AS, (300 << 20,) * 2); "
        f"sys.argv = ['run.py', 'no.yaml']; runpy.run_path({LAUNCHER[1]!r}, run_name='__main__')"
    )
    done = called(ROOT, sys.executable, "-c", program)
    assert done.returncode == 2
    assert done.stderr.startswith("a process may reserve 300 MiB of memory here")
    assert done.stderr.count("\n") == 1


def test_a_folder_of_results_that_may_not_be_written_is_named_before_the_first_job(
    tmp_path, monkeypatch
):
    figures = tmp_path / "results" / "tiny" / "figures"
    check_folders(figures.parent)
    figures.mkdir(parents=True)
    check_folders(figures.parent)
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != figures)
    with pytest.raises(PermissionError) as told:
        check_folders(figures.parent)
    assert "figures may not be written" in in_words(told.value)


def test_libraries_take_what_every_processor_has(monkeypatch: pytest.MonkeyPatch):
    chosen = same_numbers(
        {"GLIBC_TUNABLES": "glibc.malloc.check=1:glibc.cpu.hwcaps=-AVX2"}
    )
    assert chosen["GLIBC_TUNABLES"].startswith(
        "glibc.malloc.check=1:glibc.cpu.hwcaps=-FMA,"
    )
    assert chosen["OPENBLAS_NUM_THREADS"] == "1"
    program = "import numpy; print(numpy.show_config(mode='dicts')['SIMD Extensions'].get('found'))"
    asked = (sys.executable, "-W", "error", "-c", program)
    found = called(ROOT, *asked, env={**os.environ, **chosen})
    assert found.stdout.strip() == "None", found.stderr


def test_a_log_that_is_taken_away_while_it_is_looked_for_says_nothing(
    tmp_path, monkeypatch
):
    monkeypatch.setattr(Path, "is_file", lambda path: True)
    assert last_finding(tmp_path / "thesis.log") == "done"
