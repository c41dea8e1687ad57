"""Write the tables of docs/holding.md: what putty and brackets buy here, beside the orders that are published.

.venv/bin/python docs/tables/published_orders.py
"""

from pathlib import Path

import numpy as np

from rockfrag import Block, overturns
from rockfrag.assess.motions import motion_set
from rockfrag.assess.place import Place
from rockfrag.assess.request import Records
from rockfrag.assess.standing.holders import Bracket, Putty
from rockfrag.base.units import GRAVITY
from rockfrag.records.motion import Motion
from rockfrag.system import System

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "holding.md"
BEGIN = "<!-- written by docs/tables/published_orders.py -->"
END = "<!-- end of that -->"
EVERY = 4  # of the default motions, one in so many
SHELF = {
    "flask 6 × 12": Block(0.06, 0.12, 0.5),
    "vase 8 × 20": Block(0.08, 0.20, 1.0),
    "vase 10 × 30": Block(0.10, 0.30, 2.5),
    "bottle 7 × 25": Block(0.07, 0.25, 1.0),
    "figure 12 × 40": Block(0.12, 0.40, 4.0),
}
"""Fragile objects on shelves: width × height [cm], and masses as such things have them."""
HIGH = (0.737, 1.041, 1.422, 1.803, 2.064)
"""Heights of the bookcases of FEMA P-58 [m], all of which rock over a depth of .321 m."""
PULLS = (1.0, 2.0, 4.0)  # of the putty, over the weight of the object [-]
BEARS = (0.1, 0.2, 0.3, 0.5)  # of the bracket, likewise
PEAK = 0.8  # of the motions that shake furniture [g]: as in the towns near Kumamoto's fault
LEVELS = np.geomspace(0.05, 6.0, 40)  # peak accelerations of the shelf [g]
ROUGH, SMOOTH = 0.6, 0.15  # friction of a shelf, and of one of low friction [-]


def default_motions() -> list[Motion]:
    """Some of the motions that an assessment takes."""
    found = motion_set(Records(), Place(), ROOT / "resources" / "records")
    return list(found.ground[::EVERY])


def scales_to(levels: np.ndarray, motions: list[Motion]) -> np.ndarray:
    """Factors that give each motion these peaks [g], shape (motions, levels)."""
    return levels * GRAVITY / np.array([[motion.pga] for motion in motions])


def half_topple(system: System, motions: list[Motion], mu: float) -> float:
    """Peak acceleration from which on half of the motions topple it, or slide it off its shelf [g]."""
    found = overturns([system], motions, scales=scales_to(LEVELS, motions), friction=mu)
    # 15 cm lie between what stands on a shelf and its edge
    gone = found.overturned[0] | (found.peak_slip[0, :, :, 0] > 0.15)
    fractions = np.maximum.accumulate(gone.mean(axis=0))
    return float(np.exp(np.interp(0.5, fractions, np.log(LEVELS))))


def shelf_rows(motions: list[Motion]) -> list[list[str]]:
    """A row an object: the level free, on a smooth shelf, and with putty over that, by its pull."""
    rows = []
    for name, block in SHELF.items():
        free = half_topple(block.system(), motions, ROUGH)
        smooth = half_topple(block.system(), motions, SMOOTH)
        weight = block.mass * GRAVITY
        held = [Putty(pull * weight).on(block.system()) for pull in PULLS]
        factors = [half_topple(each, motions, ROUGH) / free for each in held]
        rows.append(
            [
                f"{name} cm",
                f"{free:.2f}",
                f"{smooth:.2f}",
                *(f"{factor:.1f}" for factor in factors),
            ]
        )
    return rows


def bookcase_rows(motions: list[Motion]) -> list[list[str]]:
    """A row a bookcase: the fraction that topples free, and with brackets over that, by what they bear."""
    scales, rows = scales_to(np.array([PEAK]), motions), []
    for high in HIGH:
        block = Block(0.321, high, 150.0 * high)
        weight = block.mass * GRAVITY
        held = [Bracket(part * weight).on(block.system()) for part in BEARS]
        systems = [block.system(), *held]
        found = overturns(systems, motions, scales=scales, friction=ROUGH)
        free, *rest = found.overturned.mean(axis=(1, 2))
        parts = [f"{part / free:.2f}" if free else "–" for part in rest]
        rows.append([f"0.321 × {high} m", f"{free:.2f}", *parts])
    return rows


def table(head: list[str], rows: list[list[str]]) -> str:
    """A table in Markdown."""
    ruler = ["---", *["--:"] * (len(head) - 1)]
    return "\n".join(f"| {' | '.join(row)} |" for row in [head, ruler, *rows])


def main() -> None:
    """Compute both tables and put them into the page."""
    motions = default_motions()
    shelf = [
        *("object on a shelf", "half topple from [g]", "on a smooth shelf [g]"),
        *(f"putty of {pull:g} weights: times" for pull in PULLS),
    ]
    cases = [
        *("bookcase", f"topple at {PEAK:g} g"),
        *(f"bracket of {part:g} weights: times" for part in BEARS),
    ]
    text = "\n\n".join(
        [
            BEGIN,
            table(shelf, shelf_rows(motions)),
            table(cases, bookcase_rows(motions)),
            END,
        ]
    )
    before, rest = PAGE.read_text(encoding="utf-8").split(BEGIN)
    PAGE.write_text(before + text + rest.split(END)[1], encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
