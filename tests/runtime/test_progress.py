"""Progress: silent for what is quick, seconds left for what takes long, nothing on standard output."""

import io
import time

from rockfrag.runtime import progress
from rockfrag.runtime.progress import in_words, progress_line, sign_of_life


def _said(seconds_each: float, total: int, stream: io.StringIO) -> str:
    now = 0.0

    def clock() -> float:
        return now

    say = progress_line("objects", stream, clock)
    for done in range(1, total + 1):
        now += seconds_each
        say(done, total)
    return stream.getvalue()


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_nothing_is_said_of_what_ends_soon():
    assert _said(0.1, 20, io.StringIO()) == ""


def test_the_seconds_left_are_those_that_the_rest_takes_at_the_same_pace():
    lines = _said(4.0, 20, io.StringIO()).splitlines()
    assert lines[0] == "1 of 20 objects, 4 s, about 76 s left"
    # every ten seconds from then on, and at the end
    assert lines[1] == "4 of 20 objects, 16 s, about 64 s left"
    assert lines[-1] == "20 of 20 objects, 80 s"
    assert len(lines) == 8


def test_the_end_is_said_once():
    now = 60.0
    stream = io.StringIO()
    say = progress_line("objects", stream, lambda: now)
    now = 100.0
    for done in (2, 3, 3):
        say(done, 3)
    assert stream.getvalue().count("3 of 3 objects") == 1


def test_a_terminal_has_one_line_that_is_written_over():
    text = _said(4.0, 20, Terminal())
    assert text.count("\n") == 1 and text.count("\r") == 20


def test_work_that_cannot_be_counted_is_said_in_percent():
    now = 0.0
    stream = io.StringIO()
    say = progress_line("of it", stream, lambda: now, in_percent=True)
    now = 12.0
    say(0.25, 1.0)
    assert stream.getvalue() == "25 % of it, 12 s, about 36 s left\n"


def test_times_are_said_as_people_say_them():
    assert [in_words(s) for s in (7.6, 99, 150, 7 * 3600)] == [
        "8 s",
        "99 s",
        "2 min",
        "7 h 0 min",
    ]


def test_a_block_that_lasts_gives_a_sign_of_life(monkeypatch):
    monkeypatch.setattr(progress, "SILENT", 0.02)
    stream = io.StringIO()
    with sign_of_life("still simulating", stream):
        deadline = time.monotonic() + 5
        while not stream.getvalue() and time.monotonic() < deadline:
            time.sleep(0.005)
    assert stream.getvalue().startswith("still simulating (0 s so far)")
    stream = io.StringIO()
    with sign_of_life("still simulating", stream, expected=40):
        deadline = time.monotonic() + 5
        while not stream.getvalue() and time.monotonic() < deadline:
            time.sleep(0.005)
    assert "(0 s so far, about 40 s left)" in stream.getvalue()
    quick = io.StringIO()
    with sign_of_life("still simulating", quick):
        pass
    assert quick.getvalue() == ""
