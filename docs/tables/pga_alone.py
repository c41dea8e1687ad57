"""Write the table of docs/assess.md that shows intervals with PGA alone, of another version and of this one.

Under the other version (its ``src`` first on the path) ``python docs/tables/pga_alone.py > other.json`` writes its
figures; under this one ``python docs/tables/pga_alone.py --against other.json`` puts both into the page.
"""

import argparse
import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
from two_measures import HAZARDS, PAGE, ROOT, curve, objects

from rockfrag.assess.answer import assess_with
from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.motions import motion_set
from rockfrag.assess.request import make_request

BEGIN, END = (
    "<!-- written by docs/tables/pga_alone.py -->",
    "<!-- end of pga_alone.py -->",
)


def figures() -> dict[str, list[list[float]]]:
    """Probability in 50 years with its limits, of ten objects under each hazard in PGA alone."""
    found = {}
    for name, about in objects().items():
        request = make_request(about, "table")
        motions = motion_set(
            request.records, request.place, ROOT / "resources" / "records"
        )
        found[name] = []
        for pga, _ in HAZARDS.values():
            asked = replace(request, hazard=(curve(PGA, pga),))
            item = assess_with(asked, motions, brief=True).probability
            found[name].append([item.value, item.lower, item.upper])
    return found


def table(
    before: dict[str, list[list[float]]], after: dict[str, list[list[float]]]
) -> str:
    """The table in Markdown, and the sentence below it."""
    titles = [f"{name}, {when}" for name in HAZARDS for when in ("0.1.0", "now")]
    lines = [f"| {' | '.join(['object', *titles])} |", f"|{'---|' * (1 + len(titles))}"]
    widths = []
    for name, now in after.items():
        cells = []
        for pair in zip(before[name], now, strict=True):
            for value, low, high in pair:
                cells.append(
                    f"{100 * value:.2g} % (× {high / value:.2g}, ÷ {value / low:.2g})"
                )
            old, new = (math.log(high / low) for _, low, high in pair)
            widths.append(new / old)
        lines.append(f"| {' | '.join([name, *cells])} |")
    return "\n".join(
        [
            *lines,
            "",
            "Probability of toppling in 50 years with PGA alone, and the factors to the limits of its 90 % "
            f"interval. Intervals are {np.median(widths):.2f} times as wide (ln upper over lower, median) as "
            "those of 0.1.0.",
        ]
    )


def main() -> None:
    """Print the figures of this version, or write both into the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--against", type=Path, help="figures of the other version")
    against = parser.parse_args().against
    if against is None:
        print(json.dumps(figures()))
        return
    before, rest = PAGE.read_text().split(BEGIN)
    after = rest.split(END)[1]
    written = table(json.loads(against.read_text()), figures())
    PAGE.write_text(f"{before}{BEGIN}\n\n{written}\n\n{END}{after}")


if __name__ == "__main__":
    main()
