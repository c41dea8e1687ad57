"""Speed and accuracy of the rocking kernels against other programs, in one process on this machine.

``python benchmarks/run.py`` takes a quarter of an hour; ``--quick`` three minutes, with too few cases to
quote; ``--wide`` adds a study of 2.4 million histories.  Everything goes to ``results/bench``.
"""

import argparse
import json
import os
import platform
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pandas as pd
import scipy

from rockfrag.base.figure_style import save_figure
from rockfrag.base.files import write_table, write_text
from rockfrag.engines.steps import STEP
from rockfrag.simulation.ensemble import overturns
from rockfrag.simulation.parquet import stream_overturns
from rockfrag.simulation.robustness import find_step_size_sensitive
from rockfrag.system.blocks import Block, Body, Stack

# the random cases and MuJoCo lie with the oracles of the tests
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from competitors import numpy_lone, scipy_lone, scipy_stack
from figure import draw_benchmark
from measures import (
    all_cases,
    converged,
    cpu_seconds,
    followed_fraction,
    nudged_fraction,
    over_limit,
    separately,
    start_up,
    thesis_bodies,
    timed,
    two_thread_ratio,
    vertical_ratio,
    wall_seconds,
)  # fmt: skip

from tests.oracle.cases import Cases, cases, columns, motions
from tests.oracle.mujoco_model import mujoco_outcome

BEGIN, END = "<!-- results of make bench -->", "<!-- end of results -->"
NAMES = {"lone": "single block", "stack": "two blocks"}
COLUMNS = {"three": 3, "five": 5, "eight": 8}
"""Bodies of the columns that are measured with friction alone."""
TIMES_MUJOCO = {"three": 60, "five": 30, "eight": 30}
"""How many times as fast as MuJoCo at 1 ms columns should be."""
SLIDING = "friction of 0.2 to 0.8"
BY_CONTACT_EVENT, BY_SAMPLE = (
    "solve_ivp from contact event to contact event",
    "solve_ivp from sample to sample",
)


def machine() -> dict[str, object]:
    """Describe the machine without naming it."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        lines = [
            line
            for line in info.read_text().splitlines()
            if line.startswith("model name")
        ]
        model = lines[0].split(":", 1)[1].strip() if lines else model
    return {
        "processor": model,
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "numba": numba.__version__,
    }


def speeds(kind: str, set_: Cases, quick: bool) -> list[dict[str, Any]]:
    """Histories per second and core, and wrong outcomes, of the package and its competitors.

    The package runs again and again between the histories of a competitor, so that a machine that changes its
    speed changes both.
    """
    reference = converged(set_)
    fast = all_cases(set_)
    seconds = cpu_seconds(lambda: all_cases(set_))
    wrong = int((fast.overturned != reference).sum())
    name_of_kind = NAMES[kind]
    rows = [
        row(name_of_kind, "rockfrag", set_.count, seconds, wrong, set_.count / seconds)
    ]
    if kind == "lone":
        few = cases("lone", 300 if quick else 2000)
        seconds, found = timed(
            numpy_lone, few.bodies, few.accelerations, few.scales, few.dt
        )
        wrong = int((found != converged(few)).sum())
        own = set_.count / cpu_seconds(lambda: all_cases(set_))
        rows.append(
            row(
                name_of_kind,
                "numpy, no contact event location",
                few.count,
                seconds,
                wrong,
                own,
            )
        )
    scipy_outcome = scipy_lone if kind == "lone" else scipy_stack
    count = 3 if quick else 20
    competitors: list[tuple[str, Callable[..., bool], int]] = [
        (BY_CONTACT_EVENT, scipy_outcome, count),
        (BY_SAMPLE, partial(scipy_outcome, by_sample=True), count),
    ]
    try:
        import mujoco  # noqa: F401
    except ImportError:
        print("MuJoCo is absent: its rows are left out")
    else:
        count = 5 if quick else 60
        competitors += [
            ("MuJoCo 1 ms, stiffest contacts", mujoco_outcome, count),
            (
                "MuJoCo 1 ms, default contacts",
                partial(mujoco_outcome, stiff=False),
                count,
            ),
        ]
    for name, outcome, count in competitors:
        wrong, seconds, runs, own_seconds = 0, 0.0, 0, 0.0
        for n, (at, body, values) in enumerate(set_.each(count)):
            if n % max(1, count // 10) == 0:
                own_seconds += cpu_seconds(lambda: all_cases(set_), 1)
                runs += 1
            once, found = timed(outcome, body, values, set_.dt)
            seconds += once
            wrong += found != reference[at]
        rows.append(
            row(
                name_of_kind,
                name,
                count,
                seconds,
                wrong,
                runs * set_.count / own_seconds,
            )
        )
    return rows


def friction_rows(kind: str, whole: Cases, quick: bool) -> list[dict[str, Any]]:
    """Rows of bodies that may slide, with the same friction at every interface: the package and MuJoCo.

    Each body has its own coefficient, from 0.2 to 0.8.  Outcomes are held against those at a tenth of the step.
    """
    bodies = whole.bodies[:: 1 + len(whole.bodies) // 10]
    set_ = Cases(
        bodies, whole.accelerations, whole.scales[:, :: 1 + whole.scales.shape[1] // 4]
    )
    name = NAMES.get(kind, f"{kind} blocks")
    mus = np.random.default_rng(5).uniform(0.2, 0.8, len(bodies)).tolist()

    def outcomes(step: float = STEP) -> np.ndarray:
        return overturns(
            bodies,
            set_.accelerations,
            set_.dt,
            set_.scales,
            friction=mus,
            step=step,
            threads=1,
        ).overturned

    finest = outcomes(0.1 * STEP)
    seconds = cpu_seconds(outcomes, 3)
    wrong = int((outcomes() != finest).sum())
    own = set_.count / seconds
    rows = [row(name, f"{SLIDING}, rockfrag", set_.count, seconds, wrong, own)]
    try:
        import mujoco  # noqa: F401
    except ImportError:
        return rows
    wrong, theirs, ours, runs = 0, 0.0, 0.0, 0
    count = min(set_.count, 20 if quick else 200)
    for n, (at, body, values) in enumerate(set_.each(count)):
        if n % max(1, count // 4) == 0:
            ours += cpu_seconds(outcomes, 1)
            runs += 1
        once, found = timed(mujoco_outcome, body, values, set_.dt, friction=mus[at[0]])
        theirs += once
        wrong += found != finest[at]
    own = runs * set_.count / ours
    rows.append(row(name, f"{SLIDING}, MuJoCo 1 ms", count, theirs, wrong, own))
    return rows


def row(
    bodies: str, name: str, count: int, seconds: float, wrong: int, own: float
) -> dict[str, Any]:
    """Row of a program; ``own``: histories per second of the package meanwhile."""
    made = {
        "bodies": bodies, "program": name, "histories": count,
        "histories_per_s_core": count / seconds, "wrong_outcomes": wrong,
        "wrong_fraction": wrong / count, "rockfrag_times_as_fast": own * seconds / count,
    }  # fmt: skip
    print(
        f"{bodies:13s} {name:32s} {count / seconds:12.4g} /s {100 * wrong / count:6.2f} % wrong"
    )
    return made


def more(base: Cases, times: int) -> Cases:
    """Return as many times the cases: more amplitudes of the same bodies and motions."""
    scales = np.repeat(base.scales, times, axis=1)
    return Cases(
        base.bodies,
        base.accelerations,
        scales * np.linspace(0.95, 1.05, scales.shape[1]),
    )


def scaling(kind: str, largest: int, speed: float) -> list[dict[str, Any]]:
    """Cost against the number of cases, as far as three minutes go."""
    rows = []
    for count in (10**n for n in range(2, 7)):
        if count > min(largest, 180 * speed):
            break
        base = cases(kind, min(count, 10_000))
        set_ = more(base, max(1, count // base.count))
        seconds = cpu_seconds(partial(all_cases, set_), 3 if count < 10**5 else 1)
        rows.append(
            {"bodies": NAMES[kind], "histories": set_.count, "seconds": seconds}
        )
    return rows


def thesis_study() -> tuple[float, bool]:
    """Time the thesis's rocking stage: 72 tests × 200 amplitudes, 1 % of 2 g apart.

    Returns
    -------
    Wall time [s], and whether one and two threads give the same bits.
    """
    made, scales = motions(12, 8), np.arange(1, 201) * 0.01
    results = [
        overturns(thesis_bodies(), made, 0.01, scales, threads=n) for n in (1, 2)
    ]
    same = all(
        np.array_equal(
            values, getattr(results[1], name), equal_nan=values.dtype.kind == "f"
        )
        for name, values in vars(results[0]).items()
        if isinstance(values, np.ndarray)
    )
    return wall_seconds(lambda: overturns(thesis_bodies(), made, 0.01, scales), 2), same


def wide_study(folder: Path) -> float:
    """Wall time of 100 components × 3 towers × P/NP × 200 amplitudes × 20 samples of the bodies."""
    rng = np.random.default_rng(9)
    bodies: list[Body] = []
    restitution: list[float | None] = []
    for body in thesis_bodies():
        for _ in range(20):
            grow, e = rng.normal(1.0, 0.01), float(rng.uniform(0.8, 0.95))
            if isinstance(body, Block):
                bodies.append(Block(body.width * grow, body.height, body.mass))
                restitution.append(e)
            else:
                tower = body.upper
                upper = Block(tower.width * grow, tower.height, tower.mass)
                bodies.append(Stack(body.lower, upper))
                restitution.append(None)
    made = motions(100, 9)
    return wall_seconds(
        lambda: stream_overturns(
            bodies, made, 0.01, np.arange(1, 201) * 0.01, folder / "wide.parquet",
            restitution=restitution,
        ),
        1,
    )  # fmt: skip


def reach(
    kind: str, table: pd.DataFrame, other: dict[str, float]
) -> list[dict[str, Any]]:
    """Rows of the targets: what is asked, what was measured, whether it is met."""
    times = table[table.bodies == NAMES[kind]].set_index("program")[
        "rockfrag_times_as_fast"
    ]
    rows: list[tuple[str, str, float, bool]] = []

    def add(what: str, target: str, value: float, met: bool) -> None:
        rows.append((what, target, value, met))

    add(
        f"times as fast as {BY_CONTACT_EVENT}",
        "≥ 20000",
        times[BY_CONTACT_EVENT],
        times[BY_CONTACT_EVENT] >= 20_000,
    )
    peers = times[times.index.str.startswith("MuJoCo")]
    if len(peers):
        add(
            "times as fast as MuJoCo at 1 ms",
            "≥ 2000",
            peers.min(),
            peers.min() >= 2000,
        )
    beside = f"{SLIDING}, MuJoCo 1 ms"
    if beside in times:
        least = 100 if kind == "lone" else 50
        met = times[beside] >= least
        add(
            "times as fast as MuJoCo at 1 ms, with friction",
            f"≥ {least}",
            times[beside],
            met,
        )
    most = 1.6 if kind == "lone" else 2.5
    add(
        "time over smooth arithmetic",
        f"≤ {most}",
        other[f"{kind}_limit"],
        other[f"{kind}_limit"] <= most,
    )
    add(
        "two threads over one",
        "≥ 1.9",
        other[f"{kind}_threads"],
        other[f"{kind}_threads"] >= 1.9,
    )
    upward = other[f"{kind}_vertical"]
    add("time with vertical motion over that without", "< 1.10", upward, upward < 1.10)
    memory = other[f"{kind}_memory_MiB"]
    add(
        f"memory of {other[f'{kind}_memory_histories']:.0e} histories [MiB]",
        "< 2048",
        memory,
        memory < 2048,
    )
    add("memory over that of a tenth of them", "≤ 1.1", memory / other[f"{kind}_memory_tenth_MiB"],
        memory <= 1.1 * other[f"{kind}_memory_tenth_MiB"])  # fmt: skip
    add(
        "first outcome, warm cache [s]",
        "< 1",
        other[f"{kind}_warm_s"],
        other[f"{kind}_warm_s"] < 1,
    )
    cold = 4 if kind == "lone" else 8
    add(
        "first outcome, cold cache [s]",
        f"≤ {cold}",
        other[f"{kind}_cold_s"],
        other[f"{kind}_cold_s"] <= cold,
    )
    gate, fraction = (
        0.001 if kind == "lone" else 0.005,
        other[f"{kind}_sensitive_fraction"],
    )
    add(
        "fraction of outcomes changed by halving the step",
        f"< {gate}",
        fraction,
        fraction < gate,
    )
    columns = ("what", "target", "measured", "met")
    return [
        {"bodies": NAMES[kind], **dict(zip(columns, values, strict=True))}
        for values in rows
    ]


def reach_of_columns(table: pd.DataFrame) -> list[dict[str, Any]]:
    """Rows of the targets of columns beside MuJoCo."""
    goals = []
    for kind, least in TIMES_MUJOCO.items():
        name = f"{kind} blocks"
        of_kind = table[table.bodies == name].set_index("program")
        for times in of_kind["rockfrag_times_as_fast"].filter(like="MuJoCo"):
            goals.append(
                {
                    "bodies": name,
                    "what": "times as fast as MuJoCo at 1 ms, with friction",
                    "target": f"≥ {least}",
                    "measured": times,
                    "met": times >= least,
                }
            )
    return goals


def summary(about: dict[str, Any], programs: pd.DataFrame, goals: pd.DataFrame) -> str:
    """Return the results as the text of a document."""
    m = about["machine"]
    lines = [
        f"Machine: {m['processor']}, {m['cores']} cores, {m['system']}; Python {m['python']}, "
        f"numba {m['numba']}, numpy {m['numpy']}, scipy {m['scipy']}.",
        "" if not about["quick"] else "\nA quick run, with too few cases to quote.\n",
        "| bodies | program | histories | per second and core | times that rockfrag is as fast | wrong outcomes |",
        "|---|---|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {r['bodies']} | {r['program']} | {r['histories']} | {r['histories_per_s_core']:.4g} "
        f"| {r['rockfrag_times_as_fast']:,.0f} | {100 * r['wrong_fraction']:.2f} % |"
        for r in programs.to_dict("records")
    ]
    lines += ["", "| bodies | what | target | measured | |", "|---|---|---|---:|---|"]
    lines += [
        f"| {r.bodies} | {r.what} | {r.target} | {r.measured:.4g} | {'met' if r.met else '**not met**'} |"
        for r in goals.itertuples()
    ]
    lines += ["", "| bodies | what changes | outcomes that change |", "|---|---|---:|"]
    changes = {
        "sensitive": "half the step",
        "nudged": "amplitudes greater by 1e-9 of themselves",
        "followed": "every impact followed (`simulate`)",
    }
    lines += [
        f"| {name} | {words} | {100 * about['measured'][f'{kind}_{key}_fraction']:.2f} % |"
        for kind, name in NAMES.items()
        for key, words in changes.items()
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--quick", action="store_true", help="three minutes, too few cases to quote"
    )
    parser.add_argument(
        "--wide", action="store_true", help="also run 2.4 million histories"
    )
    parser.add_argument("--docs", type=Path, help="document to put the results into")
    parser.add_argument("--out", type=Path, default=Path("results/bench"))
    given = parser.parse_args()
    folder: Path = given.out
    folder.mkdir(parents=True, exist_ok=True)
    rows, costs, goals = [], [], []
    other: dict[str, float] = {}
    memory_histories = 10**5 if given.quick else 10**7
    for kind in NAMES:
        set_ = cases(kind, 500 if given.quick else 10_000)
        rows += speeds(kind, set_, given.quick)
        rows += friction_rows(kind, set_, given.quick)
        other[f"{kind}_limit"], other[f"{kind}_steps_per_history"] = over_limit(
            kind, set_
        )
        sensitive = find_step_size_sensitive(
            set_.bodies, set_.accelerations, set_.dt, set_.scales, sample=set_.count
        )
        other[f"{kind}_sensitive_fraction"] = sensitive.fraction
        other[f"{kind}_nudged_fraction"] = nudged_fraction(set_)
        other[f"{kind}_followed_fraction"] = followed_fraction(
            set_, 100 if given.quick else 1000
        )
        # enough cases that the lanes that run dry at the end do not matter
        speed = next(r for r in rows if r["bodies"] == NAMES[kind])[
            "histories_per_s_core"
        ]
        other[f"{kind}_threads"] = two_thread_ratio(
            more(set_, round(3 * speed / set_.count) or 1)
        )
        other[f"{kind}_vertical"] = vertical_ratio(set_)
        costs += scaling(kind, 10**3 if given.quick else 10**6, speed)
        other[f"{kind}_cold_s"], other[f"{kind}_warm_s"] = start_up(kind)
        tenth = memory_histories // 10
        other[f"{kind}_memory_histories"] = memory_histories
        other[f"{kind}_memory_tenth_MiB"] = separately("memory", kind, tenth)
        other[f"{kind}_memory_MiB"] = separately("memory", kind, memory_histories)
    for kind, bodies in COLUMNS.items():
        rows += friction_rows(
            kind, columns(bodies, 20 if given.quick else 80), given.quick
        )
    other["thesis_study_s"], same = thesis_study()
    if given.wide:
        other["wide_study_s"] = wide_study(folder)
    table = pd.DataFrame(rows)
    for kind in NAMES:
        goals += reach(kind, table, other)
    goals += reach_of_columns(table)
    studies = [
        ("thesis study, 72 tests × 200 amplitudes [s]", "< 5", "thesis_study_s", 5.0)
    ]
    if given.wide:
        studies.append(
            ("wide study, 2.4 million histories [s]", "< 300", "wide_study_s", 300.0)
        )
    goals += [
        {
            "bodies": "both",
            "what": w,
            "target": t,
            "measured": other[k],
            "met": other[k] < limit,
        }
        for w, t, k, limit in studies
    ]
    what = "differing results of one and two threads"
    goals.append(
        {
            "bodies": "both",
            "what": what,
            "target": "0",
            "measured": float(not same),
            "met": same,
        }
    )
    goal_table, cost_table = pd.DataFrame(goals), pd.DataFrame(costs)
    write_table(table, folder / "programs.csv")
    write_table(cost_table, folder / "scaling.csv")
    write_table(goal_table, folder / "reach.csv")
    about = {"machine": machine(), "quick": given.quick, "measured": other}
    write_text(
        json.dumps(about, indent=1, ensure_ascii=False) + "\n", folder / "machine.json"
    )
    save_figure(
        draw_benchmark(table, cost_table), folder / "speed.png", folder / "speed.svg"
    )
    words = summary(about, table, goal_table)
    write_text(words, folder / "summary.md")
    if given.docs is not None:
        before, _, rest = given.docs.read_text(encoding="utf-8").partition(BEGIN)
        write_text(
            before + BEGIN + "\n" + words + END + rest.partition(END)[2], given.docs
        )
    print(f"\n{'':13s} {'':45s} {'target':>9s} {'measured':>10s}")
    for goal in goals:
        met = "met" if goal["met"] else "NOT MET"
        print(
            f"{goal['bodies']:13s} {goal['what']:45s} {goal['target']:>9s} {goal['measured']:10.4g} {met}"
        )


if __name__ == "__main__":
    main()
