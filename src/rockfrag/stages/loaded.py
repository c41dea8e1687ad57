"""Jobs as copies of one process that has the libraries loaded, so that not every job loads them again.

Libraries take a second or two to load, as long as many a stage works. A run starts a process that loads them
while Snakemake reads the study; a job asks it for a copy of itself (a fork), which runs the stage, and waits
for its end. A copy ends with its job, and all of them with their run.

A job runs its stage itself where there is no such process: on other systems than Linux, in an environment of its
own, and where Snakemake is started without ``workflow/run.py``. So does a job that a cluster's queue started, on
whichever node: the queue has given it its own memory and time.
"""

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import partial
from importlib import import_module
from multiprocessing import get_context
from multiprocessing.connection import wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

import psutil

from rockfrag.stages.same_numbers import same_numbers

ADDRESS = "ROCKFRAG_LOADED"
"""Variable of the environment that says of which run there are copies, in which Python, and at which socket."""

MODULES = (
    "rockfrag.guests",
    "numba",
    "rockfrag.records.read",
    "rockfrag.motions.measures",
    "rockfrag.rocking.ensemble",
    "rockfrag.shaketable.swept",
    "rockfrag.fragility.sweeps",
    "rockfrag.fragility.estimators",
    "rockfrag.pedestal.study",
    "rockfrag.report.study_report",
    "rockfrag.report.sections",
)
"""What most studies need and what takes long to load, as it brings libraries along; in the order of the stages."""


@contextmanager
def loaded(address: Path) -> Iterator[None]:
    """Have a process with the libraries while the block lasts, where there can be one.

    Parameters
    ----------
    address
        Its socket, from the folder in which the workflow runs, as paths of sockets must be short. One that
        a killed run left is replaced.
    """
    if sys.platform != "linux":
        yield
        return
    process = subprocess.Popen(
        [sys.executable, "-m", "rockfrag.stages.loaded", address],
        env={**os.environ, **same_numbers(os.environ)},
        stdin=subprocess.PIPE,
    )
    os.environ[ADDRESS] = f"{os.getpid()}:{sys.prefix}:{address}"
    try:
        yield
    finally:
        del os.environ[ADDRESS]
        process.kill()
        process.communicate()
        address.unlink(missing_ok=True)


def run_in_copy(job: Mapping[str, Any]) -> int | None:
    """Run a job in a copy of the process of its run.

    Parameters
    ----------
    job
        Arguments of :func:`rockfrag.guests.run_job`.

    Returns
    -------
    Exit status of the copy, 255 if that is not known; None if no copy was to be had and nothing was done.
    """
    of, _, address = os.environ.get(ADDRESS, "").rpartition(":")
    run, _, prefix = of.partition(":")
    here = psutil.Process()
    if prefix != sys.prefix or int(run) not in {one.pid for one in (here, *here.parents())}:
        return None
    # whoever stops a run tells all its processes: the copy writes so into its log and ends
    usual = signal.signal(signal.SIGINT, signal.SIG_IGN)
    begun = status = b""
    with suppress(OSError), socket.socket(socket.AF_UNIX) as process:
        process.connect(address)
        process.sendall(f"{json.dumps((dict(os.environ), dict(job)))}\n".encode())
        begun = process.recv(1)
        status = process.recv(1)
    signal.signal(signal.SIGINT, usual)
    if not begun:
        return None
    return status[0] if status else 255


def serve(address: str) -> None:
    """Load the libraries, and fork a copy for each job that asks, until standard input ends."""
    # this process ends with its run; blocked and not ignored, lest a copy miss what it is told before it can act
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    run = sys.stdin.fileno()
    to_load: list[Callable[[], object]] = [
        *(partial(import_module, name) for name in MODULES),
        _compile_once,
    ]
    copies: dict[socket.socket, BaseProcess] = {}
    with socket.socket(socket.AF_UNIX) as listener:
        try:
            Path(address).unlink(missing_ok=True)
            # for this user alone
            usual = os.umask(0o177)
            listener.bind(address)
            os.umask(usual)
        except OSError:
            # a path too long, or a file system without sockets: jobs run by themselves
            return
        listener.listen()
        while True:
            askers = {copy.sentinel: asker for asker, copy in copies.items()}
            ready = wait([run, listener, *copies, *askers], timeout=0 if to_load else None)
            if run in ready:
                break
            if not ready:
                # what cannot be loaded here says so in the job that needs it
                with suppress(Exception):
                    to_load.pop(0)()
            for one in ready:
                if one is listener:
                    asker = listener.accept()[0]
                    copy = _copy(asker, listener)
                    if copy:
                        copies[asker] = copy
                    else:
                        asker.close()
                elif one in askers:
                    asker = askers[one]
                    copy = copies.pop(asker)
                    copy.join()
                    with suppress(OSError):
                        asker.sendall(bytes([(copy.exitcode or 0) % 256]))
                    asker.close()
                elif one in copies:
                    # a job says nothing more until its copy has ended, unless it was killed
                    copies[one].kill()
    for copy in copies.values():
        copy.kill()


def _compile_once() -> None:
    """Have numba list the functions that it knows, as it does when something is compiled or fetched first."""
    import numba

    numba.njit()(lambda: None)()


def _copy(asker: socket.socket, listener: socket.socket) -> BaseProcess | None:
    """Fork a copy for the job at the other end of a socket and tell it so, if there is one and it can be done."""
    try:
        with asker.makefile("rb") as file:
            environment, job = json.loads(file.readline())
        copy = get_context("fork").Process(target=_run, args=(listener, environment, job))
        copy.start()
    except (OSError, ValueError):
        return None
    with suppress(OSError):
        asker.sendall(b"+")
    return copy


def _run(listener: socket.socket, environment: dict[str, str], job: dict[str, Any]) -> None:
    from rockfrag.guests import run_job

    # without the process of the run nobody answers
    listener.close()
    os.environ.update(environment)
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        run_job(**job)
    except KeyboardInterrupt:
        sys.exit(1)


if __name__ == "__main__":
    serve(sys.argv[1])
