"""Random requests of `rockfrag assess`, and what an answer may not say of itself.

Used by ``test_answer.py`` for some dozens of requests, by ``tests/fuzz/inputs.py`` for thousands.
"""

import contextlib
import io
import json
import math
import random
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rockfrag.cli.main import main

from ..case_tables import case_tables

CASES = case_tables(__file__)

_EMPTY = re.compile(
    r"\bnan\b|\binf\b|\bNone\b(?! of)|less than 0 %|\b0 to 100 %|\{\w+\}"
)
"""Words of an answer that say nothing."""


def request(rng: random.Random, records: Path, hazard: Path) -> list[str]:
    """Options of one request with a catalogue and a hazard curve; most of them make sense."""
    usual = rng.random() < 0.75
    chosen: list[str] = []
    for option, values in CASES["sizes"].items():
        needed = option in ("--width", "--height")
        if needed or rng.random() < (0.12 if usual else 0.3):
            # the last ones are wrong, or unusual
            few = values[1:4] if needed else values[:2]
            chosen += [option, rng.choice(few if usual else values)]
    for option, given in CASES["others"].items():
        if rng.random() < (
            0.06 if usual and option not in ("--pedestal", "--floor") else 0.16
        ):
            chosen += [option, *rng.choice(given[:2] if usual else given)]
    if rng.random() < 0.85:
        chosen += rng.choice(CASES["levels"][:7] if usual else CASES["levels"])
    if rng.random() < 0.4:
        chosen += [
            "--return-period",
            rng.choice(("475", "2475", "50" if usual else "0")),
        ]
    elif rng.random() < 0.3:
        chosen += ["--hazard", str(hazard)]
    if not usual and rng.random() < 0.2:
        chosen += rng.choice(
            (["--on-floor"], ["--pga", "0.4g"], ["--pedestal", "60cm", "20cm"])
        )
    return [*chosen, "--record", str(records)]


def answered(options: Sequence[str], folder: Path) -> tuple[int, str, str]:
    """Run ``rockfrag assess``; return the exit status and what it wrote to both channels."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            status = main(["assess", *options, "--json", "--output", str(folder)])
        except SystemExit as end:
            status = int(end.code or 0)
    return status, out.getvalue(), err.getvalue()


def contradictions(status: int, out: str, err: str) -> list[str]:
    """What is wrong with an answer; nothing where it agrees with itself or was refused in one sentence."""
    if status == 2:
        said = [
            line
            for line in err.splitlines()
            if not line.startswith(("usage:", "warning:"))
        ]
        return (
            []
            if len(said) == 1 and not out
            else [f"refused in {len(said)} lines: {err[-300:]}"]
        )
    if status != 0:
        return [f"exit status {status}: {err[-300:]}"]
    return _within(json.loads(out))


def _within(answer: dict[str, Any]) -> list[str]:
    rocking, toppling = answer["fraction_rocking"], answer["fraction_toppling"]
    amplitudes, likely = answer["amplitude_toppling"], answer["probability"]
    limited = {
        "rocking": rocking,
        "toppling": toppling,
        "probability": likely,
        **amplitudes,
    }
    checks = {
        **{
            f"{name}: {item}": item is None or _ordered(item)
            for name, item in limited.items()
        },
        "toppling is likelier than rocking": rocking is None
        or all(
            toppling[key] <= rocking[key] + 1e-12 for key in ("value", "lower", "upper")
        ),
        "a tenth topples at more than half": _of(amplitudes["0.1"])
        <= _of(amplitudes["0.5"]),
        "toppling starts below rocking": _topples_after_rocking(answer),
        "counts": _counts_agree(answer),
        "decision": _decided(answer),
        "below uplift": _at_rest(answer),
        "lines": _lines_agree(answer),
        "what helps": _helps(answer),
        "shares are parts": all(0 <= p <= 1 for p in answer["fragility"]["fraction"]),
    }
    return [name for name, right in checks.items() if not right]


def _topples_after_rocking(answer: dict[str, Any]) -> bool:
    """None topples it below the level at which one rocks it, nor half of all that may be."""
    starts = _of({"value": answer["rocks_from"]})
    half = _of(answer["amplitude_toppling"]["0.5"])
    curve = answer["fragility"]
    fell = zip(curve["levels"], curve["fraction"], strict=True)
    return starts <= half and not any(
        fraction > 0 for level, fraction in fell if level < starts
    )


def _of(estimate: dict[str, Any]) -> float:
    return math.inf if estimate["value"] is None else estimate["value"]


def _ordered(item: dict[str, Any]) -> bool:
    """Limits hold the value; a level that none reaches is null."""
    low = 0.0 if item["lower"] is None else item["lower"]
    high = math.inf if item["upper"] is None else item["upper"]
    return low <= _of(item) * (1 + 1e-9) and _of(item) <= high * (1 + 1e-9)


def _counts_agree(answer: dict[str, Any]) -> bool:
    """No more motions topple it than rock it, and none where it does not move."""
    counts = answer["counts"]
    if counts is None:
        return True
    ordered = counts["topple"] <= counts["rock"] <= counts["motions"]
    return ordered and not (answer["does_not_move"] and counts["topple"])


def _decided(answer: dict[str, Any]) -> bool:
    """What is done without a measurement follows from the probability and the one that is accepted."""
    decision, main = answer["decision"], answer["probability"]
    main = main or answer["fraction_toppling"]
    if decision is None:
        return main is None
    secure = main["value"] > answer["accepted"]
    chance = decision["chance"]
    named = decision["action"] == "measure"
    # on the mean of a rate and of its probability alike, but for what lies between them
    near = abs(main["value"] - answer["accepted"]) < 0.2 * answer["accepted"]
    right = near or decision["otherwise"] == ("secure" if secure else "leave")
    return right and named == bool(decision["source"]) and 0 <= chance <= 1


def _at_rest(answer: dict[str, Any]) -> bool:
    """Below the level at which it starts to rock, nothing rocks and the line says so."""
    level, starts = answer["level"], answer["rocks_from"]
    if level is None or answer["fraction_rocking"] is None:
        return True
    if starts is not None and level >= starts:
        return not answer["does_not_move"]
    words = answer["lines"][0]
    unlikely = re.search("does not rock|unlikely|too few|hardly rocks", words)
    counts = answer["counts"]
    still = counts is None or counts["rock"] == 0
    return still and (not answer["does_not_move"] or unlikely is not None)


def _lines_agree(answer: dict[str, Any]) -> bool:
    """At most sixty words; each says how likely, how far away, what to do, and they agree with the numbers."""
    lines, details = answer["lines"], answer["details"]
    if len(" ".join(lines).split()) > 60 or _EMPTY.search("\n".join(lines + details)):
        return False
    ids = [each["id"] for each in answer["findings"]]
    if ids[0] == "how_likely_few_earthquakes":
        return ids[1:] == ["give_earthquakes"]
    toppling, likely = answer["fraction_toppling"], answer["probability"]
    estimate = likely or toppling
    if estimate is None:
        return ids[-1] == "give_level"
    # what is above the accepted risk is never left, what is below never secured
    above = estimate["value"] > answer["accepted"]
    wrong = ("leave_it", "leave_unless") if above else ("secure_it", "secure_unless")
    return ids[-1] not in wrong


def _helps(answer: dict[str, Any]) -> bool:
    """What is said to help makes nothing worse in its limits, and only what is shown to help is said."""
    line = " ".join(line for line in answer["details"] if line.startswith("What helps"))
    amplitude = answer["fraction_toppling"] is None and answer["probability"] is None
    for change in answer["mitigations"]:
        factor, upper = change["factor"], change["upper"]
        better = factor is None or (factor > 1 if amplitude else factor < 1)
        if change["helps"] and not better:
            return False
        if change["shown"] and not amplitude and upper is not None and upper >= 1:
            return False
        if change["change"]["words"].lower() in line.lower() and not change["shown"]:
            return False
    return True
