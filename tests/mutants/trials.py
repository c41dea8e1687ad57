"""Asking tests about one mutant: in a process of its own, forked from one that has loaded the libraries."""

import importlib.abc
import importlib.machinery
import importlib.util
import json
import os
import resource
import signal
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType, ModuleType
from typing import Any

import pytest

from .changes import Change

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "rockfrag"

LONGEST_TEST_S = 4.0  # of the processor; slower tests are not asked
LONGEST_TRIAL_S = 40.0
"""Time of the processor that all tests of a mutant may take that does not change them."""


@dataclass(frozen=True)
class Group:
    """Files of the library, and the tests that reach them."""

    files: tuple[str, ...]  # folders and files under src/rockfrag
    tests: tuple[str, ...]  # folders and files under tests
    plain: bool  # whether kernels run as plain Python


@dataclass(frozen=True)
class Mutant:
    """A file with one line changed."""

    path: Path
    change: Change

    def __str__(self) -> str:
        """Where it is and what was changed, as a compiler would say it."""
        line = self.path.read_text(encoding="utf-8").splitlines()[self.change.line - 1]
        where = (
            f"{self.path.relative_to(SOURCE)}:{self.change.line}:{self.change.start}"
        )
        return f"{where} '{self.change.old}' -> '{self.change.new}': {line.strip()}"


class _Changed(importlib.abc.MetaPathFinder, importlib.machinery.SourceFileLoader):
    """Finds and loads the changed file in the place of what lies on the disk."""

    def __init__(self, mutant: Mutant, scratch: str) -> None:
        parts = mutant.path.relative_to(SOURCE.parent).with_suffix("").parts
        super().__init__(".".join(parts).removesuffix(".__init__"), str(mutant.path))
        self.mutant = mutant
        self.place = Path(scratch) / mutant.path.name

    def find_spec(
        self, name: str, path: Any = None, target: ModuleType | None = None
    ) -> Any:
        """Say that it has the changed file, and nothing else."""
        if name != self.name:
            return None
        return importlib.util.spec_from_file_location(name, self.path, loader=self)

    def get_code(self, fullname: str) -> Any:
        """Compile the changed source; it has a place of its own, where no machine code of the other lies."""
        source = self.mutant.path.read_text(encoding="utf-8")
        changed = self.mutant.change.applied(source)
        self.place.write_text(changed, encoding="utf-8")
        return compile(changed, self.place, "exec")


_FORKING = threading.Lock()


class TooSlow(BaseException):
    """A test takes more of the processor than it may."""


class _Watch:
    """Notes what each test did and how long it took, and ends the slow ones."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self.failed: list[str] = []
        self.bad: set[str] = set()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        start = time.process_time()
        try:
            return (yield)
        finally:
            self.seconds[item.nodeid] = time.process_time() - start

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Iterator[None]:
        def end(number: int, frame: FrameType | None) -> None:
            raise TooSlow(item.nodeid)

        signal.signal(signal.SIGPROF, end)
        signal.setitimer(signal.ITIMER_PROF, LONGEST_TEST_S)
        try:
            return (yield)
        except TooSlow:
            # skipped anew: of where the signal met the test nothing can be printed
            pytest.skip("too slow")
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)

    def pytest_exception_interact(self, node: Any, call: Any, report: Any) -> None:
        self.failed.append(report.nodeid)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if not report.passed:
            self.bad.add(report.nodeid)


@contextmanager
def _silent() -> Iterator[None]:
    sink = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(sink, stream)
    yield


def run_tests(
    names: Sequence[str], plain: bool, mutant: Mutant | None = None
) -> dict[str, Any]:
    """Run tests in a fork: (times of those that passed, first that failed or what became of the process)."""
    with TemporaryDirectory(prefix="mutant ") as scratch:
        # a fork of another thread in between would hold this one's pipe open
        with _FORKING:
            read, write = os.pipe()
            child = os.fork()
            if child == 0:
                os.close(read)
                # whatever happens, this process ends here
                try:
                    with _silent():
                        _run_here(names, plain, mutant, scratch, write)
                finally:
                    os._exit(3)
            os.close(write)
        with os.fdopen(read) as answer:
            said = answer.read()
        _, status = os.waitpid(child, 0)
    if said:
        return dict(json.loads(said))
    ended = os.waitstatus_to_exitcode(status)
    return {"seconds": {}, "failed": f"the process ended with {ended}"}


def _run_here(
    names: Sequence[str],
    plain: bool,
    mutant: Mutant | None,
    scratch: str,
    write: int,
) -> None:
    os.chdir(ROOT)
    if mutant is not None:
        # what does not end is noticed too
        most = int(3 * LONGEST_TRIAL_S + 10)
        resource.setrlimit(resource.RLIMIT_CPU, (most, most))
    if plain:
        from .plain import without_compiling

        without_compiling()
    if mutant is not None:
        sys.meta_path.insert(0, _Changed(mutant, scratch))
    watch = _Watch()
    options = ["-q", "-p", "no:cacheprovider", "-m", "not slow", "--hypothesis-seed=1"]
    options += ["--continue-on-collection-errors"]
    if plain:
        # threads of their own know nothing of numpy.seterr
        options += ["-W", "ignore::RuntimeWarning"]
    stop = ["-x"] if mutant else []
    status = pytest.main([*options, *stop, *names], plugins=[watch])
    failed = next(iter(watch.failed), "")
    if status not in (0, 1, 2) and not failed:
        failed = f"pytest ended with {int(status)}"
    passed = {
        name: seconds
        for name, seconds in watch.seconds.items()
        if name not in watch.bad
    }
    os.write(write, json.dumps({"seconds": passed, "failed": failed}).encode())
    os.close(write)


def quick_tests(group: Group) -> list[str]:
    """Tests of a group that pass on what is not changed, the shortest first, as many as may be asked."""
    seconds = run_tests([f"tests/{name}" for name in group.tests], group.plain)[
        "seconds"
    ]
    chosen, total = [], 0.0
    for name in sorted(seconds, key=lambda name: seconds[name]):
        total += seconds[name]
        if total > LONGEST_TRIAL_S:
            break
        chosen.append(name)
    return chosen


def noticed_by(mutant: Mutant, group: Group, tests: Sequence[str]) -> str:
    """First test that fails on a mutant, or what became of its process; empty if nothing was noticed."""
    return str(run_tests(tests, group.plain, mutant)["failed"])
