"""Progress of what takes long: how much is done and how many seconds are left, on the error stream.

In: a number done and one of all, as often as a computation likes, or a block that lasts. Out: lines on the error
stream, none for what ends within :data:`QUIET` seconds; standard output holds the answer alone. A terminal shows
one line that is written over, a file or a pipe a line every :data:`EVERY` seconds. Docs: ``docs/reliability.md``.
"""

import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

QUIET = 3.0  # seconds that pass before anything is said
EVERY = 10.0  # seconds between two lines of a file or a pipe
SILENT = 15.0  # seconds after which what cannot be counted gives its first sign
OFTEN = 0.5  # seconds between two states of the line of a terminal

Progress = Callable[[float, float], None]
"""What a long computation calls with the number done, of which parts count, and that of all."""

LONG = 120.0  # seconds from which it is said beforehand how long something takes


def progress_line(
    what: str,
    stream: TextIO | None = None,
    clock: Callable[[], float] = time.monotonic,
    *,
    in_percent: bool = False,
) -> Progress:
    """Make a function that says how much is done and how long the rest takes.

    Parameters
    ----------
    what : what is counted, such as ``objects``
    stream : where to say it, the error stream if None
    clock : seconds of a clock that never goes back
    in_percent : say which part is done, as of work that cannot be counted

    Returns
    -------
    The function, to be called with the number done and that of all.
    """
    to = sys.stderr if stream is None else stream
    shown = to.isatty()
    begun = clock()
    said = begun + QUIET - (OFTEN if shown else EVERY)
    ended = False

    def say(done: float, total: float) -> None:
        """Print how much is done, but not too often."""
        nonlocal said, ended
        now = clock()
        finished = done >= total
        if finished and ended:
            return
        if now - begun < QUIET or (
            not finished and now - said < (OFTEN if shown else EVERY)
        ):
            return
        said, ended = now, finished
        left = (now - begun) * (total - done) / done if done else float("nan")
        count = (
            f"{100 * done / total:.0f} %"
            if in_percent
            else f"{done:.0f} of {total:.0f}"
        )
        words = f"{count} {what}, {in_words(now - begun)}"
        if not finished and done:
            words += f", about {in_words(left)} left"
        print(
            f"\r\x1b[K{words}" if shown else words,
            end="\n" if finished or not shown else "",
            file=to,
            flush=True,
        )

    return say


def in_words(seconds: float) -> str:
    """Return a time that a person waits: ``8 s``, ``2 min``, ``1 h 20 min``.

    Parameters
    ----------
    seconds : the time [s]

    Returns
    -------
    The words.
    """
    if seconds < 100:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    if minutes < 100:
        return f"{minutes} min"
    return f"{minutes // 60} h {minutes % 60} min"


class Meter:
    """Work that is done, of all that is expected."""

    def __init__(self, expected: float, say: Callable[[float], None] | None) -> None:
        """Take the work that is expected, in any unit, and what is called with the part of it that is done."""
        self._expected = expected
        self._say = say
        self._done = 0.0

    def add(self, work: float) -> None:
        """Count work that was done.

        Parameters
        ----------
        work : in the unit of what is expected
        """
        self._done += work
        if self._say is not None and self._expected > 0:
            self._say(min(self._done / self._expected, 1.0))


@contextmanager
def sign_of_life(
    words: str, stream: TextIO | None = None, *, expected: float | None = None
) -> Iterator[None]:
    """Say after :data:`SILENT` seconds, and again at ever longer intervals, that a block is still at work.

    Parameters
    ----------
    words : what it does, and what would be quicker
    stream : where to say it, the error stream if None
    expected : about how long it takes [s], of which it is said how much is left; None where that is not known

    Returns
    -------
    A context that lasts as long as the block.
    """
    to = sys.stderr if stream is None else stream
    ended = threading.Event()
    begun = time.monotonic()

    def speak() -> None:
        """Print a sign of life now and then, until it has ended."""
        wait = SILENT
        while not ended.wait(wait):
            lasted = time.monotonic() - begun
            so_far = f"{in_words(lasted)} so far"
            if expected is not None and lasted < expected:
                so_far += f", about {in_words(expected - lasted)} left"
            print(f"{words} ({so_far})", file=to, flush=True)
            wait = max(EVERY, 2 * wait)

    speaker = threading.Thread(target=speak, daemon=True)
    speaker.start()
    try:
        yield
    finally:
        ended.set()
        speaker.join()
