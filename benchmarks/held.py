"""Blocks beside walls and kerbs and in cords: the engine in the plane beside MuJoCo in steps of 1 ms.

Prints cases per second of process time of both, in one run, and how many outcomes are equal.
``python benchmarks/held.py [cases of each level]``
"""

import sys
import time
from pathlib import Path

import numpy as np

from rockfrag.simulation.ensemble import overturns

# the random cases and MuJoCo lie with the oracles of the tests
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from tests.engines.planar.cases import DT
from tests.engines.planar.held_cases import DRAWN, LEVELS, HeldCase, drawn_case


def main(each: int) -> None:
    """Run both and print, a line a kind of holder."""
    for kind in DRAWN:
        rng = np.random.default_rng(22)
        cases = [drawn_case(kind, level, rng) for level in LEVELS for _ in range(each)]

        def ours(cases: list[HeldCase] = cases) -> list[bool]:
            return [
                bool(overturns(c.system, c.motion, DT, friction=c.mu).overturned.any())
                for c in cases
            ]

        # compiled before it is timed
        ours(cases[:1])
        begun = time.process_time()
        found = ours()
        taken = time.process_time() - begun
        begun = time.process_time()
        theirs = [case.falls_in_mujoco() for case in cases]
        others = time.process_time() - begun
        equal = np.mean(np.array(found) == np.array(theirs))
        print(
            f"{kind}: {len(cases) / taken:.0f} cases/s, MuJoCo {len(cases) / others:.2f}, "
            f"ratio {others / taken:.0f}, outcomes equal {equal:.2f}"
        )


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
