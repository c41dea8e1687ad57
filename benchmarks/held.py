"""Blocks beside walls and kerbs and in cords: the engine in the plane beside MuJoCo in steps of 1 ms.

Each block is shaken by several motions, as an assessment does.  Prints cases per second of process time of both,
in one run, and how many outcomes are equal.  ``python benchmarks/held.py [blocks [motions of each]]``
"""

import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from rockfrag.records.motion import Motion
from rockfrag.simulation.ensemble import overturns

# the random cases and MuJoCo lie with the oracles of the tests
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tests.engines.planar.cases import DT
from tests.engines.planar.held_cases import DRAWN, LEVELS, HeldCase, drawn_case


def grid(kind: str, blocks: int, motions: int) -> list[list[HeldCase]]:
    """Draw blocks of a kind of holder, each under several motions."""
    rng = np.random.default_rng(22)
    found = []
    for _ in range(blocks):
        cases = [drawn_case(kind, LEVELS[k % len(LEVELS)], rng) for k in range(motions)]
        found.append([cases[0]._replace(motion=case.motion) for case in cases])
    return found


def by_engine(cases: list[HeldCase]) -> list[bool]:
    """Whether a block falls under each motion."""
    shaking = [Motion(case.motion, DT) for case in cases]
    found = overturns([cases[0].system], shaking, friction=cases[0].mu, threads=1)
    return [bool(fell) for fell in found.overturned[0, :, 0]]


def timed(
    work: Callable[[list[HeldCase]], list[bool]], given: Any
) -> tuple[Any, float]:
    """Outcomes of all blocks, and the process time that they took [s]."""
    begun = time.process_time()
    found = [work(cases) for cases in given]
    return np.array(found), time.process_time() - begun


def main(blocks: int, motions: int) -> None:
    """Run both and print, a line a kind of holder."""
    for kind in DRAWN:
        given = grid(kind, blocks, motions)
        # compiled before it is timed
        by_engine(given[0][:1])
        found, taken = timed(by_engine, given)
        theirs, others = timed(
            lambda cases: [case.falls_in_mujoco() for case in cases], given
        )
        print(
            f"{kind}: {found.size / taken:.0f} cases/s, MuJoCo {found.size / others:.1f}, "
            f"ratio {others / taken:.0f}, outcomes equal {(found == theirs).mean():.2f}",
            flush=True,
        )


if __name__ == "__main__":
    main(*(int(each) for each in sys.argv[1:3] or (8, 12)))
