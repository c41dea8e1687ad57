"""Ways of damaging what a program is given: bytes of any file, and values of a configuration."""

import copy
import random
import re
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

VALUES: tuple[Any, ...] = (
    None, True, False, 0, 1, -1, 2**31, 10**400, 0.0, -0.0, 1.0, 1e-300, 1e308, -1e308, float("nan"),
    float("inf"), "", " ", "x", "a\nb", "=1+1", "../x", "/etc/passwd", "x" * 3000, "1e3", "35 cm", "像",
    "\x07", "${HOME}", "{x}", "1976-13-45", [], {}, [[]], [1, 2], ["pga_g"], {"a": 1}, {1: 2}, [None],
    [0.9, "b"], "motions.csv", "study.yaml", ".", "specimens.csv",
)  # fmt: skip
WORDS = (
    b"NPTS=", b"1e308", b"1e-308", b"-1", b"0", b"999999999999", b"nan", b"inf", b"\n", b"\n\n", b";",
    b",", b"\t", b"\x00", b"\xff", b"\xef\xbb\xbf", b"{", b"}", b"/&", b"*****", b"1.2.3", b"E+99",
    b"DT= 1e-30", b"units=", b"#", b"|", b"-32768", b"\r", b"a" * 9000, b"9" * 400,
)  # fmt: skip


def damage(content: bytes, other: bytes, rng: random.Random) -> bytes:
    """Return a damaged copy: one to four cuts, flips, insertions, repetitions or exchanges."""
    data = bytearray(content)
    for _ in range(rng.choice((1, 1, 2, 4))):
        size = len(data)
        at = rng.randrange(size + 1)
        # headers decide how a file is read, so that half of the damage is done there
        if rng.random() < 0.5:
            at = min(at, rng.randrange(2000))
        kind = rng.randrange(8)
        if kind == 0:
            del data[at:]
        elif kind == 1 and size:
            data[min(at, size - 1)] = rng.randrange(256)
        elif kind == 2:
            data[at:at] = rng.choice(WORDS)
        elif kind == 3:
            del data[at : at + rng.randint(1, 200)]
        elif kind == 4:
            data[at:at] = data[at : at + rng.randint(1, 500)] * rng.randint(1, 3)
        elif kind == 5:
            _exchange_number(data, at, rng)
        elif kind == 6 and other:
            start = rng.randrange(len(other))
            data[at : at + rng.randint(0, 300)] = other[
                start : start + rng.randint(1, 300)
            ]
        else:
            lines = bytes(data).split(b"\n")
            rng.shuffle(lines) if len(lines) < 3 else lines.insert(
                rng.randrange(len(lines)), lines[rng.randrange(len(lines))]
            )
            data = bytearray(b"\n".join(lines))
    return bytes(data)


Attempt = tuple[Path, Callable[[], object]]  # the file under test, and what reads it

Seed = tuple[str, bytes, Callable[[Path], object]]
"""Name and content of a file in order, and how it is read."""


def damaged(folder: Path, seeds: Sequence[Seed]) -> Callable[[random.Random], Attempt]:
    """Return what makes a file with damaged bytes."""

    def draw(rng: random.Random) -> Attempt:
        name, content, read = rng.choice(seeds)
        path = folder / name
        path.write_bytes(damage(content, rng.choice(seeds)[1], rng))
        return path, lambda: read(path)

    return draw


def _exchange_number(data: bytearray, at: int, rng: random.Random) -> None:
    """Put another number where the next one stands."""
    choices = [
        b"0",
        b"-5",
        b"1e308",
        b"99999999999",
        b"3.7",
        b"1e-30",
        b"007",
        b"4294967296",
    ]
    if number := re.compile(rb"\d[\d.]*").search(data, at):
        data[slice(*number.span())] = rng.choice(choices)


def _places(node: Any) -> Iterator[tuple[Any, Any]]:
    """Yield every dictionary or list in a configuration with each of its keys."""
    keys = (
        node
        if isinstance(node, dict)
        else range(len(node))
        if isinstance(node, list)
        else ()
    )
    for key in keys:
        yield node, key
        yield from _places(node[key])


def changed(content: Any, rng: random.Random) -> Any:
    """Return a copy of a configuration with one value exchanged, removed, renamed or repeated."""
    content = copy.deepcopy(content)
    places = list(_places(content))
    if not places:
        return rng.choice(VALUES)
    node, key = rng.choice(places)
    kind = rng.randrange(5)
    if kind == 0:
        del node[key]
    elif kind == 1 and isinstance(node, dict):
        word = str(rng.choice(VALUES))
        node[word[:100]] = node.pop(key)
    elif kind == 2:
        other, inner = rng.choice(places)
        node[key] = copy.deepcopy(other[inner])
    else:
        node[key] = copy.deepcopy(rng.choice(VALUES))
    return content
