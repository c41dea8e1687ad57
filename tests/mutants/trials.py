"""Asking tests about one mutant: in a process of its own, forked from one that has loaded the libraries."""

import ast
import hashlib
import json
import os
import resource
import shutil
import signal
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType
from typing import Any, Self

import pytest

from .changes import Change

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "rockfrag"

LONGEST_TEST_S = 4.0  # of the processor; slower tests are not asked
# Times that a quick test may take with a change; what then does not end is noticed
SLOWER = 2
# more that a test may take which waits for changed kernels to be compiled
COMPILING_S = 60.0
KEPT = ROOT / ".pytest_cache" / "mutants"
"""Folder of what is known of the tests of a group, which takes minutes to find."""
LONGEST_TRIAL_S = 40.0
"""Time of the processor that all tests of a mutant may take that does not change them."""


@dataclass(frozen=True)
class Group:
    """Files of the library, and the tests that reach them."""

    files: tuple[str, ...]  # folders and files under src/rockfrag
    # folders and files under tests: those asked while kernels run as plain Python, and then those asked of what
    # these have not noticed, when its kernels are compiled
    plain: tuple[str, ...]
    compiled: tuple[str, ...]


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


def changed_library(mutant: Mutant, scratch: str) -> str:
    """Put the library with the change into a folder; return it, to be looked in first.

    All other files, machine code among them, are those of the library, with their times.
    """
    folder = Path(scratch) / "library"
    shutil.copytree(SOURCE, folder / SOURCE.name)
    place = folder / SOURCE.name / mutant.path.relative_to(SOURCE)
    changed = mutant.change.applied(mutant.path.read_text(encoding="utf-8"))
    place.unlink()
    place.write_text(changed, encoding="utf-8")
    return str(folder)


_FORKING = threading.Lock()


class TooSlow(BaseException):
    """A test takes more of the processor than it may."""


class _Watch:
    """Notes what each test did and how long it took, and ends the slow ones."""

    def __init__(self, *, notes_calls: bool, compiles: bool) -> None:
        self.notes_calls = notes_calls
        self.longest = LONGEST_TEST_S * (1 if notes_calls else SLOWER)
        self.longest += COMPILING_S if compiles else 0.0
        self.seconds: dict[str, float] = {}
        self.reached: dict[str, list[str]] = {}
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
        signal.setitimer(signal.ITIMER_PROF, self.longest)
        calls: set[tuple[str, int]] = set()
        if self.notes_calls:
            _note_calls(calls)
        try:
            return (yield)
        except TooSlow:
            # raised anew: of where the signal met the test nothing can be printed
            if not self.notes_calls:
                pytest.fail("does not end", pytrace=False)
            pytest.skip("too slow")
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
            sys.setprofile(None)
            self.reached[item.nodeid] = sorted(
                place_of(file, line)
                for file, line in calls
                if file.startswith(f"{SOURCE}{os.sep}")
            )

    def pytest_exception_interact(self, node: Any, call: Any, report: Any) -> None:
        self.failed.append(report.nodeid)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if not report.passed:
            self.bad.add(report.nodeid)


def _note_calls(calls: set[tuple[str, int]]) -> None:
    """Note from now on each function that is called in this thread or one that it starts, by file and line."""

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            calls.add((frame.f_code.co_filename, frame.f_code.co_firstlineno))

    threading.setprofile(note)
    sys.setprofile(note)


def place_of(file: str | Path, line: int) -> str:
    """A function by its file under the library and its first line."""
    return f"{Path(file).relative_to(SOURCE).as_posix()}:{line}"


@contextmanager
def _silent() -> Iterator[None]:
    sink = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(sink, stream)
    yield


def run_tests(
    names: Sequence[str],
    plain: bool,
    mutant: Mutant | None = None,
    *,
    compiles: bool = True,
) -> dict[str, Any]:
    """Run tests in a fork; in machine code a test has more time if it may be one that ``compiles``.

    Returns
    -------
    Without a mutant ``seconds`` of the tests that passed and the functions that each ``reached``; with one the
    first test that ``failed``, or what became of the process.
    """
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
                        watch = _Watch(
                            notes_calls=mutant is None,
                            compiles=compiles and not plain,
                        )
                        _run_here(names, plain, mutant, scratch, write, watch)
                finally:
                    os._exit(3)
            os.close(write)
        with os.fdopen(read) as answer:
            said = answer.read()
        _, status = os.waitpid(child, 0)
    if said:
        return dict(json.loads(said))
    ended = os.waitstatus_to_exitcode(status)
    return {
        "seconds": {},
        "reached": {},
        "failed": f"the process ended with {ended}",
    }


def _run_here(
    names: Sequence[str],
    plain: bool,
    mutant: Mutant | None,
    scratch: str,
    write: int,
    watch: _Watch,
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
        sys.path.insert(0, changed_library(mutant, scratch))
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
    said = {"seconds": passed, "reached": watch.reached, "failed": failed}
    with os.fdopen(write, "w") as answer:
        json.dump(said, answer)


@dataclass(frozen=True)
class QuickTests:
    """Tests of a group that pass on what is not changed."""

    seconds: dict[str, float]  # Time of the processor of each
    reached: dict[str, list[str]]  # Functions that each calls, by :func:`place_of`

    def of(self, mutant: Mutant) -> list[str]:
        """Tests that call the changed function, the shortest first, as many as may be asked.

        What stands outside of functions concerns all tests, and so does what only machine code calls.
        """
        function = function_of(mutant)
        calling = [name for name in self.seconds if function in self.reached[name]]
        chosen, total = [], 0.0
        for name in sorted(calling or self.seconds, key=self.seconds.__getitem__):
            total += self.seconds[name]
            if total > LONGEST_TRIAL_S:
                break
            chosen.append(name)
        return chosen


def function_of(mutant: Mutant) -> str:
    """The innermost function in which a mutant's line stands, by :func:`place_of`; empty outside of functions."""
    tree = ast.parse(mutant.path.read_text(encoding="utf-8"))
    around = [
        # where its code begins: at its first decorator
        min(each.lineno for each in (node, *node.decorator_list))
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
        and node.body[0].lineno <= mutant.change.line <= (node.end_lineno or 0)
    ]
    return place_of(mutant.path, max(around)) if around else ""


def quick_tests(files: Sequence[str], plain: bool) -> QuickTests:
    """Those of some files of tests that are quick and pass on what is not changed; none of no files."""
    if not files:
        return QuickTests({}, {})
    names = [f"tests/{name}" for name in files]
    kept = KEPT / f"{_digest(names, plain)}.json"
    if not kept.exists():
        if not plain:
            # once to compile
            run_tests(names, plain)
        found = run_tests(names, plain, compiles=False)
        KEPT.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(found), encoding="utf-8")
    found = json.loads(kept.read_text(encoding="utf-8"))
    quick = {
        name: seconds
        for name, seconds in found["seconds"].items()
        if seconds < LONGEST_TEST_S
    }
    return QuickTests(quick, found["reached"])


def _digest(names: Sequence[str], plain: bool) -> str:
    """Of the library, some tests and what lies beside them: what tests take and reach depends on these."""
    places = [ROOT / name for name in names]
    folders = {place if place.is_dir() else place.parent for place in places}
    digest = hashlib.sha256(json.dumps([*names, plain]).encode())
    for folder in (SOURCE, *sorted(folders)):
        for path in sorted(folder.rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


@dataclass(frozen=True)
class Trials:
    """What is asked about the mutants of a group."""

    plain: QuickTests
    compiled: QuickTests

    @classmethod
    def of(cls, group: Group) -> Self:
        """Find the quick tests of a group."""
        return cls(
            quick_tests(group.plain, plain=True),
            quick_tests(group.compiled, plain=False),
        )

    def noticed_by(self, mutant: Mutant) -> str:
        """First test that fails on a mutant, or what became of its process; empty if nothing was noticed."""
        found = ""
        for tests, plain in ((self.plain, True), (self.compiled, False)):
            if tests.seconds and not found:
                found = str(run_tests(tests.of(mutant), plain, mutant)["failed"])
        return found
