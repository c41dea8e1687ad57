"""What ``run.py`` measures about the package itself."""

import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines.compile.jit import entry_kernel
from rockfrag.engines.pure_rocking.kernels.lanes import (
    block,
    scheduler,
    stack_one,
    stack_two,
)
from rockfrag.engines.pure_rocking.kernels.lanes.case import LANES
from rockfrag.outcomes.outcomes import Outcomes
from rockfrag.simulation.ensemble import overturns
from rockfrag.simulation.history import simulate
from rockfrag.system.blocks import Block, Stack
from tests.oracle.cases import Cases

SEPARATE = Path(__file__).with_name("separate.py")
Array = NDArray[np.float64]


def cpu_seconds(work: Callable[[], object], repeats: int = 3) -> float:
    """Least process CPU time of a few runs [s]."""
    return _least_seconds(time.process_time, work, repeats)


def timed(work: Callable[..., Any], *given: Any, **more: Any) -> tuple[float, Any]:
    """Process CPU time of one call [s], and what it returns."""
    start = time.process_time()
    found = work(*given, **more)
    return time.process_time() - start, found


def wall_seconds(work: Callable[[], object], repeats: int = 3) -> float:
    """Least wall-clock time of a few runs [s]."""
    return _least_seconds(time.perf_counter, work, repeats)


def _least_seconds(
    clock: Callable[[], float], work: Callable[[], object], repeats: int
) -> float:
    best = math.inf
    for _ in range(repeats):
        start = clock()
        work()
        best = min(best, clock() - start)
    return best


def all_cases(cases: Cases, threads: int = 1, **settings: Any) -> Outcomes:
    return overturns(
        cases.bodies,
        cases.accelerations,
        cases.dt,
        cases.scales,
        threads=threads,
        **settings,
    )


def converged(cases: Cases) -> NDArray[np.bool_]:
    """Outcomes with an eighth of the step."""
    dense = []
    for values in cases.accelerations:
        closed = np.append(values, 0.0)
        at = np.arange(8 * closed.size - 7) / 8
        dense.append(np.interp(at, np.arange(closed.size), closed))
    return overturns(
        cases.bodies, dense, cases.dt / 8, cases.scales, step=0.1 / 8
    ).overturned


def followed_fraction(cases: Cases, count: int) -> float:
    """Fraction of ``count`` outcomes that differ from ``simulate``, which follows every impact."""
    outcomes = all_cases(cases).overturned
    differing = [
        simulate(body, values, cases.dt).overturned != outcomes[at]
        for at, body, values in cases.each(count, seed=4)
    ]
    return float(sum(differing) / count)


def nudged_fraction(cases: Cases, by: float = 1e-9) -> float:
    """Fraction of outcomes that change when every amplitude grows by one part in a billion."""
    nudged = replace(cases, scales=cases.scales * (1.0 + by))
    return float((all_cases(nudged).overturned != all_cases(cases).overturned).mean())


def ratio_in_turn(
    work: Callable[[], object], other: Callable[[], object], clock: Callable[[], float]
) -> float:
    """Time of ``work`` over that of ``other``: the median of fifteen pairs of runs, one right after the other.

    A machine that changes its speed from second to second changes both runs of a pair alike.
    """
    return float(
        np.median(
            [
                _least_seconds(clock, work, 1) / _least_seconds(clock, other, 1)
                for _ in range(15)
            ]
        )
    )


def two_thread_ratio(cases: Cases) -> float:
    """Speed of two threads over that of one, wall clock."""
    return ratio_in_turn(
        lambda: all_cases(cases, 1), lambda: all_cases(cases, 2), time.perf_counter
    )


def vertical_ratio(cases: Cases) -> float:
    """Time of the cases with vertical motion, of six tenths of the horizontal one, over that without."""
    upward = [0.6 * values[::-1] for values in cases.accelerations]

    def run(**vertical: Any) -> None:
        overturns(
            cases.bodies,
            cases.accelerations,
            cases.dt,
            cases.scales,
            threads=1,
            **vertical,
        )

    run(vertical=upward)
    return ratio_in_turn(lambda: run(vertical=upward), run, time.process_time)


@entry_kernel
def _only_blocks(lane: Any, count: int) -> None:
    for _ in range(count):
        block.advance(lane, False)


@entry_kernel
def _only_one(lane: Any, count: int) -> None:
    for _ in range(count):
        stack_one.advance(lane, 9.81, False)


@entry_kernel
def _only_two(lane: Any, count: int) -> None:
    for _ in range(count):
        stack_two.advance(lane, 9.81, False)


def over_limit(kind: str, cases: Cases) -> tuple[float, float]:
    """CPU time of all cases over that of as many lane steps of smooth arithmetic; steps per case."""
    steps = np.zeros(len(_SMOOTH[kind]), dtype=int)
    entry = getattr(*_ENTRY[kind])

    class Counted:
        """The kernel, adding up the steps it says it took."""

        def __getattr__(self, attribute: str) -> object:
            return getattr(entry, attribute)

        def __call__(self, *arguments: object) -> None:
            nonlocal steps
            steps += np.array(entry(*arguments))

    setattr(*_ENTRY[kind], Counted())
    try:
        all_cases(cases)
    finally:
        setattr(*_ENTRY[kind], entry)

    def smooth() -> None:
        for (module, lanes, only, still), count in zip(
            _SMOOTH[kind], steps, strict=True
        ):
            lane = np.zeros(1, module.LANE)[0]
            for row, value in still.items():
                lane[row] = value
            only(lane, count // lanes)

    smooth()
    over = ratio_in_turn(lambda: all_cases(cases), smooth, time.process_time)
    return over, float(steps.sum()) / cases.count


# where the ensembles find their entry kernels
_ENTRY: dict[str, tuple[Any, str]] = {
    "lone": (block, "integrate_blocks"),
    "stack": (scheduler, "integrate_stacks"),
}

# the kernels of the lanes, and what a lane steps on with for ever: no contact event, no division by zero
_SMOOTH: dict[str, list[tuple[Any, int, Any, dict[str, float]]]] = {
    "lone": [
        (
            block, block.LANES, _only_blocks,
            {
                "psi": 0.2, "angle": 0.25, "kappa": 1e-3, "crest": 10.0, "part_left": 1.0,
                "weight": 1.0, "weight_end": 1.0, "heavy": 1.0,
            },
        )
    ],
    "stack": [
        (stack_one, LANES, _only_one, {"theta": 0.2, "part_left": 1.0, "weight": 1.0, "weight_end": 1.0}),
        (
            stack_two, LANES, _only_two,
            {
                "theta1": 0.1, "theta2": 0.2, "m11": 3.0, "m22": 2.0, "part_left": 1.0, "part": 1.0,
                "weight": 1.0, "weight_end": 1.0,
            },
        ),
    ],
}  # fmt: skip


def separately(*arguments: object, cache: Path | None = None) -> float:
    """Number that ``separate.py`` prints in a process of its own."""
    environment = dict(os.environ)
    if cache is not None:
        environment["NUMBA_CACHE_DIR"] = str(cache)
    command = [sys.executable, str(SEPARATE), *map(str, arguments)]
    done = subprocess.run(
        command, env=environment, capture_output=True, text=True, check=True
    )
    return float(done.stdout)


def start_up(kind: str) -> tuple[float, float]:
    """Seconds to the first outcome of a new process, with an empty and with a filled cache."""
    cold, warm = math.inf, math.inf
    for _ in range(3):
        with tempfile.TemporaryDirectory() as folder:
            cold = min(cold, separately("first", kind, cache=Path(folder)))
            warm = min(
                warm, *(separately("first", kind, cache=Path(folder)) for _ in range(2))
            )
    return cold, warm


def thesis_bodies() -> list[Block | Stack]:
    """Return towers T1-T3 alone and on the pedestal, from the p and α that the thesis gives them."""
    made: list[Block | Stack] = []
    for slenderness, p in ((3, 6.12589), (4, 5.36484), (5, 4.82421)):
        radius = 0.75 * 9.81 / p**2
        width = 2 * radius / math.hypot(1, slenderness)
        tower = Block(width, slenderness * width, 2700 * slenderness * width**3)
        radius, sine = 0.75 * 9.81 / 7.27928**2, math.sqrt((1 - 0.341494) / 1.5)
        base, height = 2 * radius * sine, 2 * radius * math.sqrt(1 - sine**2)
        made += [tower, Stack(Block(base, height, 2700 * base * base * height), tower)]
    return made
