"""Give the package damaged inputs of all kinds, and see that each is used or refused.

    python -m tests.fuzz --inputs 1000000
    python -m tests.fuzz --inputs 1000 --only hazard --seed 7
    python -m tests.fuzz --inputs 2000 --only requests

Each must be used, or refused with an :class:`InputError` of one line and at most 500 characters, within five
seconds of processor time and one gibibyte. All processors work. Prints how many there were of each kind, and
what went wrong; the first inputs that did are kept. Exit status 1 if anything did. Commands, requests and studies
are drawn only if they are asked for: each must be answered without a contradiction, or refused, within a minute.
"""

import argparse
import itertools
import math
import os
import random
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from rockfrag.base.errors import LONGEST_MESSAGE, InputError
from rockfrag.runtime.processes import in_processes
from rockfrag.runtime.progress import progress_line

from . import inputs
from .commands import commands
from .damage import Attempt
from .records import records
from .texts import texts

LONGEST_WAIT = 20
"""By the clock, over the seconds of processor time, for what hangs without using any: the machine may do other
things, and an alarm within the compiling of kernels would leave them broken."""

COMPILING_S, TRIED_AGAIN_S = 300.0, 10.0
"""Processor time that compiling kernels may take, and that from which a call is tried once more, so that its time
is that of a simulation."""

KEPT = 20


@dataclass(frozen=True)
class Kind:
    """What makes inputs, their fraction of all, and what one of them may take at most."""

    make: Callable[[Path], Callable[[random.Random], Attempt]]
    fraction: float = 0.0
    most_seconds: float = 5.0
    most_bytes: int = 2**30
    chunk: int = 500
    least_used: float = 0.0
    simulates: bool = False


KINDS: Mapping[str, Kind] = {
    "records, archives and catalogues": Kind(records, 0.3),
    "configurations": Kind(inputs.configurations, 0.15),
    "tables": Kind(inputs.tables, 0.2),
    "hazard files": Kind(inputs.hazard_files, 0.15),
    "statues and inventories": Kind(inputs.objects, 0.1),
    "numbers": Kind(inputs.numbers, 0.08),
    "texts that state what they hold": Kind(texts, 0.02, least_used=0.3),
    "commands": Kind(
        commands, most_seconds=60, chunk=20, least_used=0.8, simulates=True
    ),
    "requests": Kind(
        inputs.requests,
        most_seconds=60,
        most_bytes=2**33,
        chunk=50,
        least_used=0.25,
        simulates=True,
    ),
    "studies": Kind(
        inputs.studies,
        most_seconds=60,
        most_bytes=2**33,
        chunk=10,
        least_used=0.4,
        simulates=True,
    ),
}


@dataclass
class Tally:
    """What came of the inputs of a kind."""

    kind: str
    fates: Counter[str] = field(default_factory=Counter)
    wrong: Counter[str] = field(default_factory=Counter)
    slowest_s: float = 0.0
    most_bytes: int = 0


class _TooSlow(BaseException):
    """An input took too long; not an Exception, so that nothing under test catches it."""


def main() -> int:
    """Run the harness; return 0 if nothing went wrong."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--inputs", type=int, default=1_000_000, help="how many in all")
    parser.add_argument("--seed", type=int, default=1, help="seed of the damage")
    parser.add_argument(
        "--processes", type=int, default=os.cpu_count() or 1, help="that work at once"
    )
    parser.add_argument(
        "--only", default="", help="kinds of inputs, by a word of their names"
    )
    options = parser.parse_args()
    begin = time.monotonic()
    asked = {
        name: kind.fraction for name, kind in KINDS.items() if options.only in name
    }
    kinds = {name: part for name, part in asked.items() if part} or dict.fromkeys(
        asked, 1.0
    )
    chunks = [
        (kind, number, min(KINDS[kind].chunk, count - number))
        for kind, fraction in kinds.items()
        for count in [round(options.inputs * fraction / sum(kinds.values()))]
        for number in range(0, count, KINDS[kind].chunk)
    ]
    # files in memory where there are such: a disk is slower than what is under test
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(
        dir=memory if os.access(memory, os.W_OK) else None
    ) as scratch:
        # each process says how far it is itself, and all have about as much to do
        say, begun = progress_line("chunks"), itertools.count(1)
        own = -(-len(chunks) // options.processes)

        def one(chunk: tuple[str, int, int]) -> Tally:
            found = _tried(Path(scratch), options.seed, *chunk)
            say(min(next(begun), own), own)
            return found

        found = in_processes(one, chunks, options.processes)
    tallies = {kind: Tally(kind) for kind in kinds}
    for part in found:
        tally = tallies[part.kind]
        tally.fates, tally.wrong = tally.fates + part.fates, tally.wrong + part.wrong
        tally.slowest_s = max(tally.slowest_s, part.slowest_s)
        tally.most_bytes = max(tally.most_bytes, part.most_bytes)
    for kind, tally in tallies.items():
        used, refused = tally.fates["used"], tally.fates["refused"]
        if used < KINDS[kind].least_used * tally.fates.total():
            tally.wrong["too few of them were used for this to say anything"] += 1
        print(
            f"{kind}: {tally.fates.total()}, {used} used, {refused} refused, {tally.wrong.total()} wrong; "
            f"the slowest {tally.slowest_s:.2f} s, at most {tally.most_bytes / 2**20:.0f} MiB"
        )
        for what, count in tally.wrong.most_common():
            print(f"{count:8d}  {what}")
    total = sum(tally.fates.total() for tally in tallies.values())
    wrong = sum(tally.wrong.total() for tally in tallies.values())
    print(
        f"{total} inputs (seed {options.seed}), {wrong} wrong, {time.monotonic() - begin:.0f} s"
    )
    return 1 if wrong else 0


@cache
def _maker(scratch: Path, kind: str) -> tuple[Path, Callable[[random.Random], Attempt]]:
    """What makes inputs of a kind, once in each process, and the folder in which they lie."""
    folder = scratch / str(os.getpid()) / kind
    folder.mkdir(parents=True)
    tempfile.tempdir = str(folder)
    make = KINDS[kind].make(folder)
    return folder, make


def _tried(scratch: Path, seed: int, kind: str, number: int, count: int) -> Tally:
    rng = random.Random(f"{seed} {kind} {number}")
    tally = Tally(kind)
    folder, make = _maker(scratch, kind)
    os.chdir(folder)
    signal.signal(signal.SIGPROF, _alarm)
    signal.signal(signal.SIGALRM, _alarm)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for place in range(number, number + count):
            path, attempt = make(rng)
            fate, seconds = _timed(attempt, KINDS[kind])
            tally.slowest_s = max(tally.slowest_s, seconds)
            tally.fates[fate] += 1
            if fate not in ("used", "refused"):
                tally.wrong[f"{path.name}: {fate}"] += 1
                if tally.wrong.total() <= KEPT and path.is_file():
                    kept = Path("/tmp") / f"fuzz-{seed}-{place}-{path.name}"
                    shutil.copy(path, kept)
                    print(f"{kept}: {fate}", file=sys.stderr, flush=True)
    tally.most_bytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    if tally.most_bytes > KINDS[kind].most_bytes:
        tally.wrong[f"more than {KINDS[kind].most_bytes / 2**20:.0f} MiB"] += 1
    return tally


def _timed(attempt: Callable[[], object], kind: Kind) -> tuple[str, float]:
    """What becomes of an attempt, and the processor time that it takes [s] where its kernels are compiled."""
    fate, seconds = "", math.inf
    for most in (COMPILING_S, kind.most_seconds)[not kind.simulates :]:
        if seconds > TRIED_AGAIN_S:
            start = time.process_time()
            fate = _fate(attempt, most)
            seconds = time.process_time() - start
    return fate, seconds


def _alarm(*_: object) -> None:
    raise _TooSlow


def _fate(attempt: Callable[[], object], most_seconds: float) -> str:
    signal.setitimer(signal.ITIMER_PROF, most_seconds)
    signal.setitimer(signal.ITIMER_REAL, LONGEST_WAIT * most_seconds)
    try:
        attempt()
        return "used"
    except InputError as error:
        text = str(error)
        if len(text) > LONGEST_MESSAGE or not text.isprintable():
            return f"unfit message: {text[:80]!r}"
        return "refused"
    except _TooSlow:
        return "too slow"
    except AssertionError as error:
        return f"wrong: {error}"
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        return f"uncaught: {type(error).__name__} in {Path(place.filename).name}:{place.lineno}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.setitimer(signal.ITIMER_REAL, 0)


if __name__ == "__main__":
    sys.exit(main())
