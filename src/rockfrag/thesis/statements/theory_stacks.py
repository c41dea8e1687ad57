"""C2, C9 to C13 and C21 to C24: how a stack starts, changes its pattern and loses energy."""

import math
from collections import Counter
from functools import lru_cache

import numpy as np
import pandas as pd
from scipy import stats

from rockfrag.rocking import Block, Stack, simulate
from rockfrag.thesis.statements.evidence import Undecidable
from rockfrag.thesis.statements.ledger import ClaimResult
from rockfrag.thesis.statements.theory_setting import (
    EXACT,
    PEAKS_G,
    Setting,
    jump,
    listed,
    require_thesis_specimens,
    uplift_threshold,
    wilson,
)
from rockfrag.units import STANDARD_GRAVITY

TABLE_4_1 = {"T1": 3.27, "T2": 2.45, "T3": 1.96}
TABLE_4_1_PATTERN_3 = {"P&T1": 3.69, "P&T2": 3.04, "P&T3": 2.56}
"""Printed accelerations that start rocking [m/s²]; those of pattern 4 repeat those of lone towers."""

SUDDEN = np.geomspace(1.01, 6.0, 40)
"""Sudden accelerations of C9 over the one that starts rocking [-]."""

GEOMETRIES = 120
"""Random stacks on which C12 looks."""

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


def _impacts(setting: Setting) -> pd.DataFrame:
    return pd.concat(
        [one.events[one.events["kind"] == "impact"] for one in setting.histories],
        ignore_index=True,
    )


def _where(setting: Setting) -> str:
    return (
        f"{len(setting.assemblies)} stacks under {len(setting.motions)} motions scaled to "
        + ", ".join(f"{peak:g}" for peak in PEAKS_G)
        + " g"
    )


def c2(setting: Setting) -> ClaimResult:
    """Least sudden accelerations, by bisection of simulations, against Table 4.1."""
    require_thesis_specimens(setting)
    printed = {
        **TABLE_4_1,
        **{f"{name} pattern 3": value for name, value in TABLE_4_1_PATTERN_3.items()},
        **{f"P&{name} pattern 4": value for name, value in TABLE_4_1.items()},
    }
    # stacks are told by what stands on them, whatever they are called
    label = {
        name: f"P&{object_name}"
        for name, stack in setting.assemblies.items()
        for object_name, block in setting.blocks.items()
        if stack.statue == block
    }
    computed = dict(setting.alone)
    computed |= {f"{label[name]} pattern 3": a for name, a in setting.pattern_3.items()}
    computed |= {f"{label[name]} pattern 4": a for name, a in setting.pattern_4.items()}
    wrong = [
        f"{name}: {computed.get(name, math.nan):.4f} against {figure}"
        for name, figure in printed.items()
        if name not in computed or round(computed[name], 2) != figure
    ]
    formula = 0.0
    for name, stack in setting.assemblies.items():
        arm = stack.common_arm(1)
        formula = max(
            formula, abs(setting.pattern_3[name] / (abs(arm.x) / arm.y * STANDARD_GRAVITY) - 1)
        )
        arm = stack.statue_arm(1)
        formula = max(
            formula, abs(setting.pattern_4[name] / (abs(arm.x) / arm.y * STANDARD_GRAVITY) - 1)
        )
    return ClaimResult(
        2,
        "least sudden acceleration that moves tower, stack (pattern 4) and stack held together "
        "(pattern 3), by bisection of simulations, rounded to the printed digits of Table 4.1",
        f"{len(printed) - len(wrong)} of {len(printed)} figures agree; largest difference from "
        f"eq. 2.21-2.25 {formula:.1e}" + "".join(f"; {one}" for one in wrong),
        "contradicted" if wrong or formula > EXACT else "supported",
        "simulated",
        (len(printed) - len(wrong)) / len(printed),
        remark="pattern 3 starts at this acceleration only if the statue is held; see C9",
    )


def c9(setting: Setting) -> ClaimResult:
    """First pattern under records and under sudden accelerations."""
    first: Counter[str] = Counter()
    for response in setting.histories:
        openings = response.events[response.events["kind"] == "opening"]
        if response.pattern[0] == "rest" and len(openings):
            first[openings["to"].iloc[0]] += 1
    sudden: Counter[str] = Counter()
    least = {}
    for name, stack in setting.assemblies.items():
        for factor in SUDDEN:
            for sign in (+1, -1):
                sudden[jump(stack, sign * factor * setting.pattern_4[name]).pattern[0]] += 1
        least[name] = uplift_threshold(stack, pedestal=True) / STANDARD_GRAVITY
    usual = sum(count for pattern, count in first.items() if pattern[0] in "34")
    others = sum(count for pattern, count in sudden.items() if pattern[0] not in "34")
    total, steps = sum(first.values()), sum(sudden.values())
    if total == 0:
        raise Undecidable("no stack rocks under the motions")
    verdict = "contradicted" if usual < total or others else "supported"
    return ClaimResult(
        9,
        f"first pattern of {_where(setting)}, and of each stack under {steps // len(least)} sudden "
        f"accelerations up to {SUDDEN[-1]:g} times the one that starts rocking",
        f"records: {usual} of {total} start in pattern 3 or 4 ("
        + ", ".join(f"{k} {v}" for k, v in sorted(first.items()))
        + f"); sudden: {steps - others} of {steps} do ("
        + ", ".join(f"{k} {v}" for k, v in sorted(sudden.items()))
        + ")",
        verdict,
        "simulated",
        (usual + steps - others) / (total + steps),
        remark="holds where the acceleration is continuous; a sudden one above "
        f"{listed(least, '.2f')} g takes the pedestal along, in pattern 3 or, with "
        "both interfaces open at once, in pattern 1",
    )


def c10(setting: Setting) -> ClaimResult:
    """Patterns from which interfaces open without an impact."""
    sources: Counter[str] = Counter()
    for response in setting.histories:
        sources.update(response.events.loc[response.events["kind"] == "opening", "from"])
    moving = Counter({k: v for k, v in sources.items() if k != "rest"})
    total = sum(moving.values())
    if total == 0:
        raise Undecidable("no interface opened during rocking")
    other = sum(count for pattern, count in moving.items() if pattern[0] not in "34")
    return ClaimResult(
        10,
        f"patterns from which an interface opens without an impact, {_where(setting)}",
        ", ".join(f"{k} {v}" for k, v in sorted(moving.items()))
        + f"; from rest {sources['rest']}; from patterns 1 and 2 {other}",
        "contradicted" if other else "supported",
        "simulated",
        (total - other) / total,
        remark="necessarily so: only patterns 3 and 4 have an interface in full contact",
    )


def c11(setting: Setting) -> ClaimResult:
    """Outcomes of impacts: both interfaces rocking, staying together, or another."""
    impacts = _impacts(setting)
    own = Counter(zip(impacts["from"], impacts["to"], strict=True))
    random = _random_stacks(setting.seed)[1]
    if not own and not random:
        raise Undecidable("no impact occurs")
    counted = {"the specimens": _kinds(own), "random stacks": _kinds(random)}
    neither = {
        f"{before}→{after}": n
        for (before, after), n in sorted((own + random).items())
        if _kind(before, after) == "neither"
    }
    ended = sum(
        int(((events["kind"] == "chatter") & events["to"].str.startswith("4")).sum())
        for events in (response.events for response in setting.histories)
    )
    total, others = sum((own + random).values()), sum(neither.values())
    return ClaimResult(
        11,
        f"outcomes of all impacts of {_where(setting)}, and of {GEOMETRIES} random stacks whose statue "
        "is tilted and released: both interfaces rock on, what met stays together, or neither",
        "; ".join(
            f"{name}: " + ", ".join(f"{kinds[kind]} {kind}" for kind in KINDS)
            for name, kinds in counted.items()
        )
        + "".join(f"; {name} {n}" for name, n in neither.items()),
        "contradicted" if others else "supported",
        "simulated",
        (total - others) / total,
        *wilson(total - others, total),
        remark="neither: the pedestal comes to rest under a statue that rocks on (1→4, 2→4) or the "
        "statue parts where the pedestal lands (3→2), which Table 2.1 lacks; "
        f"{ended} series of ever smaller impacts end so as well",
    )


KINDS = ("separate", "together", "neither")


def _kind(before: str, after: str) -> str:
    if after in SEPARATE.get(before, ()):
        return "separate"
    # a statue that sticks to the pedestal it has hit and turns with it stays together too
    if after in TOGETHER.get(before, ()) or after == "rest" or after[0] == "3":
        return "together"
    return "neither"


def _kinds(transitions: Counter[tuple[str, str]]) -> Counter[str]:
    found: Counter[str] = Counter()
    for (before, after), n in transitions.items():
        found[_kind(before, after)] += n
    return found


def _random_stack(rng: np.random.Generator) -> Stack:
    width = rng.uniform(0.2, 1.5)
    height = width * math.exp(rng.uniform(math.log(0.2), math.log(4.0)))
    base = width * rng.uniform(0.3, 1.0)
    tall = base * math.exp(rng.uniform(math.log(1.5), math.log(8.0)))
    return Stack(
        Block(width, height, 1000 * width * height),
        Block(base, tall, 1000 * base * tall * math.exp(rng.uniform(-1.0, 1.0))),
    )


def _free_fall(stack: Stack) -> pd.DataFrame:
    """Impacts after the statue is tilted a little on a still pedestal and released."""
    dt = 0.2 / stack.statue.frequency()
    response = simulate(
        stack, np.zeros(10), dt, theta0=(0.0, 0.05 * stack.statue.critical_angle(1))
    )
    return response.events[response.events["kind"] == "impact"]


def _first_from_4a(impacts: pd.DataFrame) -> str | None:
    """Pattern after the first impact, if the pedestal stood still until then."""
    if impacts.empty or impacts["from"].iloc[0] != "4a":
        return None
    return str(impacts["to"].iloc[0])


@lru_cache(maxsize=4)
def _random_stacks(seed: int) -> tuple[Counter[str], Counter[tuple[str, str]]]:
    """Outcomes of the first impact from 4a, and all impacts, of random stacks in free fall."""
    rng = np.random.default_rng(seed)
    first: Counter[str] = Counter()
    every: Counter[tuple[str, str]] = Counter()
    for _ in range(GEOMETRIES):
        impacts = _free_fall(_random_stack(rng))
        every.update(zip(impacts["from"], impacts["to"], strict=True))
        outcome = _first_from_4a(impacts)
        if outcome is not None:
            first[outcome] += 1
    return first, every


def c12(setting: Setting) -> ClaimResult:
    """Outcome of a statue's impact on a still pedestal, over the specimens and random geometries."""
    specimens = {name: _first_from_4a(_free_fall(s)) for name, s in setting.assemblies.items()}
    impacts = _impacts(setting)
    seen = impacts[impacts["from"].isin(["4a", "4b"])]
    usual = int(seen["to"].isin(["4a", "4b"]).sum())
    other = int(seen["to"].isin(["1a", "1b"]).sum())
    geometry = _random_stacks(setting.seed)[0]
    total = sum(geometry.values())
    stays = geometry["4b"]
    if total == 0:
        raise Undecidable("no statue came down on a still pedestal")
    lower, upper = wilson(stays, total)
    own = [one for one in specimens.values() if one is not None]
    if all(one == "4b" for one in own) and lower > 0.5 and geometry["1b"] > 0:
        verdict = "supported"
    elif all(one != "4b" for one in own) or upper < 0.5:
        verdict = "contradicted"
    else:
        verdict = "undecided"
    return ClaimResult(
        12,
        "pattern after a statue rocking in 4a first comes down on the still pedestal, free fall: the "
        f"specimens and {GEOMETRIES} random stacks; and all impacts from 4a, 4b of {_where(setting)}",
        "specimens: "
        + ", ".join(f"{name} {to}" for name, to in specimens.items())
        + f"; random stacks: 4b in {stays} of {total} ({stays / total:.2f} [{lower:.2f}, {upper:.2f}]), "
        + ", ".join(f"{to} {n}" for to, n in sorted(geometry.items()) if to != "4b")
        + f"; under the motions 4→4 {usual}, 4→1 {other} of {len(seen)}",
        verdict,
        "simulated",
        stays / total,
        lower,
        upper,
        remark="eq. 2.85 is homogeneous in the velocity, so the outcome is a matter of geometry and "
        "masses alone; where it is 1b the pedestal lifts by little and falls back at once",
    )


def c13(setting: Setting) -> ClaimResult:
    """Kinetic energy across impacts, velocities across openings, and the ledger between."""
    gain, kink, residual, loss = -math.inf, 0.0, 0.0, []
    for response in setting.histories:
        events = response.events
        impacts = events[(events["kind"] == "impact") & (events["energy_before"] > 0)]
        if len(impacts):
            change = impacts["energy_after"] / impacts["energy_before"] - 1
            gain = max(gain, float(change.max()))
            loss.append(float((impacts["energy_before"] - impacts["energy_after"]).sum()))
        for _, row in events[events["kind"] == "opening"].iterrows():
            kink = max(
                kink, float(np.abs(np.subtract(row["omega_after"], row["omega_before"])).max())
            )
        energy = response.energy
        scale = float(np.abs(energy[["kinetic", "input"]].to_numpy()).max())
        if scale > 0:
            residual = max(residual, float(energy["residual"].abs().max()) / scale)
    if not loss:
        raise Undecidable("no impact occurs")
    verdict = "supported" if gain <= EXACT and kink == 0 and residual < 1e-6 else "contradicted"
    return ClaimResult(
        13,
        f"kinetic energy after over before each impact, velocities across openings, and the sum of "
        f"kinetic and potential energy, losses and input, {_where(setting)}",
        f"largest change of energy in an impact {gain:+.1e}; largest jump of velocity without one "
        f"{kink:.1e} rad/s; largest unexplained energy {residual:.1e} of the largest there is",
        verdict,
        "simulated",
        gain,
        remark=f"in a history {float(np.median(loss)):.2g} J are lost on the median",
    )


def _paired(setting: Setting) -> dict[str, float]:
    """Threshold of each stack's statue alone [m/s²]."""
    return {name: uplift_threshold(stack.statue) for name, stack in setting.assemblies.items()}


def c21(setting: Setting) -> ClaimResult:
    """Threshold of pattern 4 over that of pattern 3."""
    ratio = {k: setting.pattern_4[k] / setting.pattern_3[k] for k in setting.assemblies}
    return ClaimResult(
        21,
        "least sudden acceleration that moves the stack over the one that moves it held together, by "
        "bisection of simulations",
        f"pattern 4 over pattern 3: {listed(ratio)}",
        "supported" if max(ratio.values()) < 1 else "contradicted",
        "simulated",
        max(ratio.values()),
        remark="of the specimens; a squat statue on a slender pedestal does the opposite",
    )


def c22(setting: Setting) -> ClaimResult:
    """Threshold of pattern 4 against that of the statue alone."""
    alone = _paired(setting)
    worst = max(abs(setting.pattern_4[k] / alone[k] - 1) for k in alone)
    return ClaimResult(
        22,
        "least sudden acceleration that moves the stack against that of its statue alone, by bisection "
        "of simulations",
        f"largest relative difference {worst:.1e}",
        "supported" if worst < EXACT else "contradicted",
        "simulated",
        worst,
    )


def c23(setting: Setting) -> ClaimResult:
    """Acceleration that moves the pedestal too, against that of the statue alone."""
    alone = _paired(setting)
    as_one = {k: setting.pattern_3[k] / alone[k] for k in alone}
    both = {
        k: uplift_threshold(stack, pedestal=True) / alone[k]
        for k, stack in setting.assemblies.items()
    }
    least = min(*as_one.values(), *both.values())
    return ClaimResult(
        23,
        "least sudden acceleration that moves the pedestal with a free statue and with a held one, over "
        "that of the statue alone, by bisection of simulations",
        f"held (pattern 3): {listed(as_one, '.2f')}; free (patterns 1, 2): {listed(both, '.2f')}",
        "supported" if least > 1 else "contradicted",
        "simulated",
        least,
        remark="once the statue rocks its impacts lift the pedestal too (C12)",
    )


def c24(setting: Setting) -> ClaimResult:
    """Rank correlation of thresholds with slenderness."""
    blocks = setting.blocks
    if len(blocks) < 3:
        raise Undecidable("fewer than three lone blocks")
    slenderness = [block.slenderness for block in blocks.values()]
    rho = {"lone": float(stats.spearmanr(slenderness, list(setting.alone.values())).statistic)}
    for name, found in (("pattern 3", setting.pattern_3), ("pattern 4", setting.pattern_4)):
        if len(found) >= 3:
            tall = [stack.statue.slenderness for stack in setting.assemblies.values()]
            rho[name] = float(stats.spearmanr(tall, list(found.values())).statistic)
    worst = max(rho.values())
    return ClaimResult(
        24,
        "rank correlation of the least sudden acceleration that starts rocking with H/B of the tower",
        listed(rho, ".2f"),
        "supported" if worst < -1 + 1e-12 else "contradicted" if worst > 0 else "undecided",
        "simulated",
        worst,
    )
