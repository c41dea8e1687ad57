"""Write the table of docs/assess.md: what knowing the ground velocity does to probabilities and their intervals.

.venv/bin/python docs/tables/two_measures.py
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import yaml

from rockfrag.assess.answer import assess_with
from rockfrag.assess.findings import estimate_of
from rockfrag.assess.hazard.curve import PGA, PGV, HazardCurve, make_curve
from rockfrag.assess.motions import motion_set
from rockfrag.assess.request import make_request
from rockfrag.assess.risk import Estimate
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.words.catalogue import catalogue

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "assess.md"
BEGIN, END = "<!-- written by docs/tables/two_measures.py -->", "<!-- end of that -->"
HAZARDS = {"low": (0.1, 5.0), "moderate": (0.25, 20.0), "high": (0.45, 55.0)}
"""PGA [g] and PGV [cm/s] of 475 years of three made sites."""
FACTORS, PERIODS = (0.1, 0.4, 1.0, 2.2, 5.0), (7.0, 90.0, 475.0, 3600.0, 50000.0)
"""Levels over that of 475 years and their return periods: curves of about the bend that such curves have."""


def curve(measure: IntensityMeasure, level: float) -> HazardCurve:
    """A made hazard curve through a level of 475 years."""
    levels = [factor * level for factor in FACTORS]
    return make_curve(measure, levels, [1 / period for period in PERIODS], "made")


def objects() -> dict[str, dict[str, object]]:
    """Ten objects, alone and on pedestals, as config/rules-of-thumb.yaml has them."""
    given = yaml.safe_load((ROOT / "config" / "rules-of-thumb.yaml").read_text())[
        "objects"
    ]
    return {about.pop("name"): about for about in given}


def row_of(about: dict[str, object], records: Path) -> list[tuple[Estimate, Estimate]]:
    """Probability in 50 years with PGA alone and with PGV too, under each hazard."""
    request = make_request(about, "table")
    motions = motion_set(request.records, request.place, records)
    found = []
    for pga, pgv in HAZARDS.values():
        curves = curve(PGA, pga), curve(PGV, pgv)
        alone, both = (
            assess_with(
                replace(request, hazard=curves[:count]), motions, brief=True
            ).probability
            for count in (1, 2)
        )
        found.append((alone, both))
    return found


def narrowing(pairs: list[tuple[Estimate, Estimate]]) -> float:
    """Median of the width of intervals (ln) with PGV over that without, where both have limits."""
    widths = [
        math.log(after.upper / after.lower) / math.log(before.upper / before.lower)
        for before, after in pairs
        if before.lower > 0 and after.lower > 0
    ]
    return float(np.median(widths))


def line_of(name: str, pairs: list[tuple[Estimate, Estimate]]) -> str:
    """A row of the table."""
    texts = catalogue()
    cells = [texts.say(estimate_of(item)) for pair in pairs for item in pair]
    return f"| {' | '.join([name, *cells])} |"


def table(records: Path) -> str:
    """The table in Markdown, and the sentence below it."""
    titles = [
        f"{name}, {what}" for name in HAZARDS for what in ("PGA alone", "PGA and PGV")
    ]
    lines = [f"| {' | '.join(['object', *titles])} |", f"|{'---|' * (1 + len(titles))}"]
    pairs = []
    for name, about in objects().items():
        row = row_of(about, records)
        lines.append(line_of(name, row))
        pairs += row
    sites = "; ".join(
        f"{name}: {pga} g and {pgv:g} cm/s" for name, (pga, pgv) in HAZARDS.items()
    )
    lines += [
        "",
        "Probability of toppling in 50 years with its 90 % interval, for the ten objects of "
        f"`config/rules-of-thumb.yaml` on the ground of three made sites ({sites} every 475 years). "
        "Over these the intervals with PGV "
        f"have {narrowing(pairs):.2f} of the width (ln upper over lower, median) of those without.",
    ]
    return "\n".join(lines)


def main() -> None:
    """Replace what stands between the two marks."""
    text = PAGE.read_text()
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    PAGE.write_text(
        f"{before}{BEGIN}\n\n{table(ROOT / 'resources' / 'records')}\n\n{END}{after}"
    )


if __name__ == "__main__":
    main()
