"""Random draws in parts, one process each, and what came of them."""

import argparse
import random
import tempfile
import traceback
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

Found = tuple[Counter[int], list[str]]
"""How many ended with each exit status, and what is wrong."""


def run_draws(
    make: Callable[[random.Random, Path], tuple[Any, Callable[[], tuple[int, list[str]]]]],
    what: str,
    many: int,
    size: int,
    least: float,
    about: str,
) -> int:
    """Make the draws that the command line asks for; return 0 if nothing is wrong with any.

    Parameters
    ----------
    make
        Draws one in a folder: what it is, and what gives its exit status and what is wrong with it.
    what
        What is drawn, in the plural: an option of the command line.
    many
        How many there are if the option is left out.
    size
        Draws of a part.
    least
        Fraction of them that must be answered, and not refused [-].
    about
        What the command does.
    """
    parser = argparse.ArgumentParser(description=about.splitlines()[0])
    parser.add_argument(f"--{what}", type=int, default=many, dest="many", help="how many")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    parts = [
        (asked.seed, first, min(first + size, asked.many)) for first in range(0, asked.many, size)
    ]
    fates: Counter[int] = Counter()
    wrong: list[str] = []
    with ProcessPoolExecutor() as pool:
        for found, lines in pool.map(partial(_part, make), parts):
            fates += found
            wrong += lines
            print("\n".join([f"{sum(fates.values())} of {asked.many}", *lines]), flush=True)
    print(f"{asked.many} {what}: {fates[0]} answered, {fates[2]} refused in one sentence")
    print(f"{len(wrong)} contradictions" if wrong else "no contradiction")
    if fates[0] < least * asked.many:
        print("too few of them were answered for this to say anything")
        return 1
    return 1 if wrong else 0


def _part(make: Callable[..., Any], part: tuple[int, int, int]) -> Found:
    """Make the draws of a seed from a number up to another, all in one folder."""
    seed, first, last = part
    fates: Counter[int] = Counter()
    wrong = []
    with tempfile.TemporaryDirectory(prefix="rockfrag.") as folder:
        for number in range(first, last):
            drawn, answer = make(random.Random(f"{seed} {number}"), Path(folder))
            try:
                status, found = answer()
            except Exception:
                status, found = 1, [traceback.format_exc(limit=-3)]
            fates[status] += 1
            wrong += [f"{number}: {drawn}\n    {said}" for said in found]
    return fates, wrong
