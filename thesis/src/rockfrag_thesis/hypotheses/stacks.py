"""C2, C9 to C13 and C21 to C24: how a stack starts, changes its pattern and loses energy.

In: the setting of the thesis. Out: an outcome a hypothesis. Theory: ``docs/hypotheses.md``,
``docs/derivation.md``.
"""

import math
from collections import Counter
from functools import lru_cache

import numpy as np
import pandas as pd

from rockfrag.base.units import GRAVITY
from rockfrag.outcomes.response import ROCKING_MODES
from rockfrag.simulation import simulate
from rockfrag.system.blocks import Block, Stack
from rockfrag_thesis.hypotheses.hypothesis import (
    Finding,
    Result,
    Undecidable,
    hypothesis,
)
from rockfrag_thesis.hypotheses.outcomes import most
from rockfrag_thesis.hypotheses.setting import (
    EXACT,
    Setting,
    below,
    jump,
    listed,
    require_thesis_specimens,
    starts_at,
)
from rockfrag_thesis.printed_tables import uplift_accelerations

TABLE_4_1 = {"T1": 3.27, "T2": 2.45, "T3": 1.96}
TABLE_4_1_ROCKING_MODE_3 = {"P&T1": 3.69, "P&T2": 3.04, "P&T3": 2.56}
"""Printed accelerations that start rocking [m/s²]; those of pattern 4 repeat those of lone towers."""


@hypothesis(2)
def c2(setting: Setting) -> Result:
    """The closed forms against Table 4.1, and simulations on either side of them."""
    require_thesis_specimens(setting)
    printed = {
        **TABLE_4_1,
        **{
            f"{name} pattern 3": value
            for name, value in TABLE_4_1_ROCKING_MODE_3.items()
        },
        **{f"P&{name} pattern 4": value for name, value in TABLE_4_1.items()},
    }
    computed, agree = dict(setting.alone), []
    for name, stack in setting.assemblies.items():
        # stacks are told by what stands on them, whatever they are called
        tower = next(n for n, block in setting.blocks.items() if stack.upper == block)
        computed[f"P&{tower} pattern 3"] = setting.rocking_mode_3[name]
        computed[f"P&{tower} pattern 4"] = setting.rocking_mode_4[name]
        agree.append(starts_at(stack.rigidly_joined(), setting.rocking_mode_3[name]))
        agree.append(starts_at(stack, setting.rocking_mode_4[name]))
    wrong = [
        f"{name}: {computed.get(name, math.nan):.4f} against {figure}"
        for name, figure in printed.items()
        if name not in computed or round(computed[name], 2) != figure
    ]
    return Result(
        Finding.FOR if all(agree) and not wrong else Finding.AGAINST,
        f"{len(printed) - len(wrong)} of {len(printed)} figures agree; {sum(agree)} of {len(agree)} "
        "simulated stacks start there" + "".join(f"; {name}" for name in wrong),
        (len(printed) - len(wrong)) / len(printed),
        remark="pattern 3 starts at its figure only if the statue is held; see C9",
    )


SUDDEN = np.geomspace(1.01, 6.0, 20)
"""Sudden accelerations of C9 over the one that starts rocking [-]."""


@hypothesis(9, most=SUDDEN[-1])
def c9(setting: Setting) -> Result:
    """First pattern under records and under sudden accelerations."""
    first: Counter[str] = Counter()
    for response in setting.histories:
        openings = response.contact_events[response.contact_events["kind"] == "opening"]
        if not response.state[0].any() and len(openings):
            first[openings["to"].iloc[0]] += 1
    sudden: Counter[str] = Counter()
    for name, stack in setting.assemblies.items():
        for factor in SUDDEN:
            state = jump(stack, factor * setting.rocking_mode_4[name]).state[0]
            sudden[ROCKING_MODES[int(state[0]), int(state[1])]] += 1
    usual = sum(
        count for rocking_mode, count in first.items() if rocking_mode[0] in "34"
    )
    suddenly = sum(
        count for rocking_mode, count in sudden.items() if rocking_mode[0] in "34"
    )
    if not first:
        raise Undecidable("no stack rocks under the motions")
    finding = Finding.FOR if suddenly == sudden.total() else Finding.SPECIMENS_ONLY
    if usual < first.total():
        finding = Finding.AGAINST
    least = {name: a / GRAVITY for name, a in setting.pedestal_too.items()}
    return Result(
        finding,
        f"{usual} of {first.total()} start in pattern 3 or 4 under motions ({_counted(first)}), {suddenly} "
        f"of {sudden.total()} under sudden accelerations ({_counted(sudden)})",
        usual / first.total(),
        remark=f"{setting.where}; a sudden acceleration above {listed(least, '.2f')} g takes the pedestal "
        "along, in pattern 3 or, with both interfaces open at once, in pattern 1",
    )


def _counted(counts: Counter[str]) -> str:
    return ", ".join(f"{name} {n}" for name, n in sorted(counts.items()))


@hypothesis(10)
def c10(setting: Setting) -> Result:
    """Patterns from which interfaces open without an impact."""
    sources: Counter[str] = Counter()
    for response in setting.histories:
        sources.update(
            response.contact_events.loc[
                response.contact_events["kind"] == "opening", "from"
            ]
        )
    moving = Counter({k: v for k, v in sources.items() if k != "rest"})
    if not moving:
        raise Undecidable("no interface opened during rocking")
    other = sum(
        count for rocking_mode, count in moving.items() if rocking_mode[0] not in "34"
    )
    return Result(
        Finding.AGAINST if other else Finding.FOR,
        f"openings from {_counted(moving)}; from rest {sources['rest']}; from patterns 1 and 2 {other}",
        1 - other / moving.total(),
        remark=setting.where,
    )


SEPARATE = {
    "1a": {"2a", "2b"},
    "1b": {"2a", "2b"},
    "2a": {"1a", "1b"},
    "2b": {"1a", "1b"},
    "3a": {"1b"},
    "3b": {"1a"},
    "4a": {"1b"},
    "4b": {"1a"},
}
TOGETHER = {
    "1a": {"3a"},
    "1b": {"3b"},
    "2a": {"3a"},
    "2b": {"3b"},
    "3a": {"3b"},
    "3b": {"3a"},
    "4a": {"4b"},
    "4b": {"4a"},
}
"""Outcomes of an impact in Table 2.1 (its gap and misplaced row mended): rocking on both interfaces
afterwards, or the fallback to one."""

KINDS = ("separate", "together", "neither")


def _kind(before: str, after: str) -> str:
    if after in SEPARATE.get(before, ()):
        return "separate"
    # a statue that sticks to the pedestal it has hit and turns with it stays together too
    if after in TOGETHER.get(before, ()) or after == "rest" or after[0] == "3":
        return "together"
    return "neither"


def _kinds(transitions: Counter[tuple[str, str]]) -> Counter[str]:
    return Counter(_kind(before, after) for before, after in transitions.elements())


@hypothesis(11)
def c11(setting: Setting) -> Result:
    """Outcomes of impacts: both interfaces rocking, staying together, or another."""
    own = Counter(zip(setting.impacts["from"], setting.impacts["to"], strict=True))
    random = random_stacks(setting.seed)[1]
    if not own:
        raise Undecidable("no impact occurs")
    specimens, elsewhere = _kinds(own), _kinds(random)
    finding = Finding.SPECIMENS_ONLY if elsewhere["neither"] else Finding.FOR
    if specimens["neither"]:
        finding = Finding.AGAINST
    exceptions = {
        f"{before}→{after}": n
        for (before, after), n in sorted((own + random).items())
        if _kind(before, after) == "neither"
    }
    return Result(
        finding,
        "; ".join(
            f"{name}: " + ", ".join(f"{kinds[kind]} {kind}" for kind in KINDS)
            for name, kinds in (("specimens", specimens), ("random stacks", elsewhere))
        )
        + "".join(f"; {name} {n}" for name, n in exceptions.items()),
        1 - specimens["neither"] / own.total(),
        remark=f"{setting.where}; neither: the pedestal comes to rest under a statue that rocks on (1→4, "
        "2→4) or the statue parts where the pedestal lands (3→2), which Table 2.1 lacks",
    )


GEOMETRIES = 120  # random stacks on which C11 and C12 look


def _random_stack(rng: np.random.Generator) -> Stack:
    width = rng.uniform(0.2, 1.5)
    height = width * math.exp(rng.uniform(math.log(0.2), math.log(4.0)))
    base = width * rng.uniform(0.3, 1.0)
    tall = base * math.exp(rng.uniform(math.log(1.5), math.log(8.0)))
    return Stack(
        Block(width, height, 1000 * width * height),
        Block(base, tall, 1000 * base * tall * math.exp(rng.uniform(-1.0, 1.0))),
    )


def free_fall(stack: Stack) -> pd.DataFrame:
    """Contact events after the statue is tilted a little on a still pedestal and released."""
    dt = 0.2 / stack.upper.frequency()
    response = simulate(
        stack, np.zeros(10), dt, theta0=(0.0, 0.05 * stack.upper.critical_angle(1))
    )
    return response.contact_events


CONTACTS = {name: contacts for contacts, name in ROCKING_MODES.items()}
"""Contact states of pedestal and statue by pattern."""

STILL, SETTLES, LIFTED = "stays still", "settles at once", "rocks on"


def after_impacts(contact_events: pd.DataFrame) -> list[str]:
    """What the pedestal does after each landing of a statue that rocked on it while it stood still.

    It stays still (4a to 4b), it lifts but stands still again before the statue comes down next (4a to 1b
    and on to 4b), or it rocks on until then (4a to 1b).
    """
    befores, afters = contact_events["from"].tolist(), contact_events["to"].tolist()
    outcomes = []
    for k in np.flatnonzero(
        (contact_events["kind"] == "impact") & contact_events["from"].isin(["4a", "4b"])
    ):
        statue = CONTACTS[afters[k]][1]
        if afters[k][0] == "4":
            outcomes.append(STILL)
            continue
        for before, after in zip(befores[k + 1 :], afters[k + 1 :], strict=True):
            lower_after, upper_after = CONTACTS[after]
            if lower_after == 0 and upper_after == statue:
                outcomes.append(SETTLES)
                break
            if upper_after != statue or CONTACTS[before][1] != statue:
                outcomes.append(LIFTED)
                break
    return outcomes


@lru_cache(maxsize=4)
def random_stacks(seed: int) -> tuple[Counter[str], Counter[tuple[str, str]]]:
    """What random pedestals do after the first landing in free fall, and outcomes of all impacts."""
    rng = np.random.default_rng(seed)
    first: Counter[str] = Counter()
    every: Counter[tuple[str, str]] = Counter()
    for _ in range(GEOMETRIES):
        contact_events = free_fall(_random_stack(rng))
        impacts = contact_events[contact_events["kind"] == "impact"]
        every.update(zip(impacts["from"], impacts["to"], strict=True))
        if len(impacts) and impacts["from"].iloc[0] == "4a":
            first.update(after_impacts(contact_events)[:1])
    return first, every


@hypothesis(12, random=GEOMETRIES)
def c12(setting: Setting) -> Result:
    """What a still pedestal does after the statue lands on it."""
    own: Counter[str] = Counter()
    for response in setting.histories:
        own.update(after_impacts(response.contact_events))
    if not own:
        raise Undecidable("no statue came down on a still pedestal")
    random = random_stacks(setting.seed)[0]
    finding = most(own[STILL] + own[SETTLES], own.total())
    if finding is Finding.FOR and random[LIFTED]:
        finding = Finding.SPECIMENS_ONLY
    return Result(
        finding,
        "; ".join(
            f"{name}: the pedestal "
            + ", ".join(
                f"{what} after {found[what]}" for what in (STILL, SETTLES, LIFTED)
            )
            + f" of {found.total()} landings"
            for name, found in (("specimens", own), ("random stacks", random))
        ),
        1 - own[LIFTED] / own.total(),
        remark=f"{setting.where}; by eq. 2.85 the specimens always lift (1b), but by so little that the "
        "pedestal stands again at once",
    )


@hypothesis(13)
def c13(setting: Setting) -> Result:
    """Energy and velocities across contact events, and the balance between them."""
    gain, kink, residual, loss = -math.inf, 0.0, 0.0, []
    for response in setting.histories:
        contact_events = response.contact_events
        impacts = contact_events[
            (contact_events["kind"] == "impact") & (contact_events["energy_before"] > 0)
        ]
        if len(impacts):
            change = impacts["energy_after"] / impacts["energy_before"] - 1
            gain = max(gain, float(change.max()))
            loss.append(
                float((impacts["energy_before"] - impacts["energy_after"]).sum())
            )
        opened = contact_events[contact_events["kind"] == "opening"]
        for before, after in zip(
            opened["omega_before"], opened["omega_after"], strict=True
        ):
            kink = max(kink, float(np.abs(np.subtract(after, before)).max()))
        energy = response.energy
        scale = float(np.abs(energy[["kinetic", "input"]].to_numpy()).max())
        if scale > 0:
            residual = max(residual, float(energy["residual"].abs().max()) / scale)
    if not loss:
        raise Undecidable("no impact occurs")
    holds = gain <= EXACT and kink == 0 and residual < 1e-6
    return Result(
        Finding.FOR if holds else Finding.AGAINST,
        f"energy gained in an impact {below(max(gain, 0.0))} of what there was; largest jump of velocity "
        f"without one {kink:g} rad/s; largest unexplained energy {below(residual, 1e-6)} of the largest",
        remark=f"{setting.where}; in a history {float(np.median(loss)):.2g} J are lost on the median",
    )


SQUAT_ON_SLENDER = Stack(Block(0.1, 1.0, 10.0), Block(0.1, 0.05, 0.5))
"""A squat statue on a slender pedestal, the other way round than the thesis's [m, kg]."""


@hypothesis(21)
def c21(setting: Setting) -> Result:
    """Threshold of pattern 4 over that of pattern 3."""
    ratio = {
        k: setting.rocking_mode_4[k] / setting.rocking_mode_3[k]
        for k in setting.assemblies
    }
    other_3, other_4 = uplift_accelerations(SQUAT_ON_SLENDER)
    return Result(
        Finding.SPECIMENS_ONLY
        if max(ratio.values()) < 1 < other_4 / other_3
        else Finding.AGAINST,
        f"pattern 4 over pattern 3: {listed(ratio)}; squat statue on a slender pedestal {other_4 / other_3:.1f}",
        max(ratio.values()),
    )


@hypothesis(22)
def c22(setting: Setting) -> Result:
    """Threshold of pattern 4 against that of the statue alone."""
    worst = max(
        abs(setting.rocking_mode_4[name] / uplift_accelerations(stack.upper)[1] - 1)
        for name, stack in setting.assemblies.items()
    )
    return Result(
        Finding.FOR if worst < EXACT else Finding.AGAINST,
        f"largest relative difference {below(worst)}",
    )


@hypothesis(23)
def c23(setting: Setting) -> Result:
    """Acceleration that moves the pedestal too, against that of the statue alone."""
    held = {
        k: setting.rocking_mode_3[k] / setting.rocking_mode_4[k]
        for k in setting.assemblies
    }
    free = {
        k: setting.pedestal_too[k] / setting.rocking_mode_4[k]
        for k in setting.assemblies
    }
    least = min(*held.values(), *free.values())
    other_3, other_4 = uplift_accelerations(SQUAT_ON_SLENDER)
    return Result(
        Finding.SPECIMENS_ONLY if least > 1 > other_3 / other_4 else Finding.AGAINST,
        f"over the single block: held (pattern 3) {listed(held, '.2f')}; free (patterns 1, 2) "
        f"{listed(free, '.2f')}; squat statue on a slender pedestal, held {other_3 / other_4:.2f}",
        least,
        remark="once the statue rocks its impacts lift the pedestal too (C12)",
    )


@hypothesis(24)
def c24(setting: Setting) -> Result:
    """Thresholds in the order of slenderness."""
    if len(setting.blocks) < 2:
        raise Undecidable("there is one lone block only")
    groups = {
        "lone": [
            (block.slenderness, setting.alone[name])
            for name, block in setting.blocks.items()
        ]
    }
    if len(setting.stacks) > 1:
        for label, found in (
            ("pattern 3", setting.rocking_mode_3),
            ("pattern 4", setting.rocking_mode_4),
        ):
            groups[label] = [
                (stack.upper.slenderness, found[name])
                for name, stack in setting.assemblies.items()
            ]
    ordered = {name: [a for _, a in sorted(points)] for name, points in groups.items()}
    falls = all(np.all(np.diff(values) < 0) for values in ordered.values())
    return Result(
        Finding.FOR if falls else Finding.AGAINST,
        "; ".join(
            f"{name} " + ", ".join(f"{a:.2f}" for a in values)
            for name, values in ordered.items()
        )
        + " m/s²",
    )
