"""Write the figures of docs/after.md: what two shocks in a row fell, beside what each fells by itself.

.venv/bin/python docs/tables/sequences.py
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from rockfrag import Block, overturns
from rockfrag.aftermath.sequence import one_after_the_other
from rockfrag.assess.hazard.curve import PGV
from rockfrag.assess.motions import motion_set
from rockfrag.assess.place import Place
from rockfrag.assess.request import Records
from rockfrag.records.motion import GroundMotion, Motion

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "after.md"
BEGIN = "<!-- written by docs/tables/sequences.py -->"
END = "<!-- end of that -->"
BLOCKS = {
    "square block of 20 × 80 cm": Block(0.20, 0.80, 80.0, depth=0.20),
    "block of 20 × 30 × 80 cm": Block(0.20, 0.80, 80.0, depth=0.30),
}
SECOND = 0.8  # PGV of the second shock over that of the first [-]
FOLLOWERS = 4  # second shocks after each first one
LEVELS = np.geomspace(0.1, 2.0, 60)  # PGV at which half of the records topple [m/s]


def default_records() -> list[tuple[Motion, Motion]]:
    """Both components of the default records, with a PGV (geometric mean) of 1 m/s."""
    found = motion_set(Records(), Place(), ROOT / "resources" / "records")
    records = []
    for i, j in found.pairs:
        first, second = found.components((i, j))
        peaks = [PGV.of_motion(each) / 100 for each in (first, second)]
        one = 1 / float(np.sqrt(np.prod(peaks)))
        records.append((scaled(first, one), scaled(second, one)))
    return records


def scaled(motion: Motion, factor: float) -> Motion:
    """A motion times a factor."""
    return replace(motion, acceleration=factor * motion.acceleration)


def fallen(block: Block, records: list[GroundMotion], levels: np.ndarray) -> np.ndarray:
    """Whether each record topples a block at each level, shape (records, levels)."""
    return np.asarray(overturns([block], records, scales=levels).overturned[0])


def sequences_of(block: Block) -> tuple[np.ndarray, np.ndarray]:
    """Whether each sequence felled a block, and whether one of its shocks does by itself, shape (sequences,)."""
    records = default_records()
    alone = [GroundMotion(*pair) for pair in records]
    fraction = fallen(block, alone, LEVELS).mean(axis=0)
    first = float(np.interp(0.5, np.maximum.accumulate(fraction), LEVELS))
    fells = fallen(block, alone, np.array([first, SECOND * first]))
    sequences, separate = [], []
    rng = np.random.default_rng(58)
    for i, main_shock in enumerate(records):
        others = np.delete(np.arange(len(records)), i)
        for j in rng.choice(others, FOLLOWERS, replace=False):
            strong = [scaled(each, first) for each in main_shock]
            weaker = [scaled(each, SECOND * first) for each in records[j]]
            sequences.append(GroundMotion(*one_after_the_other(strong, weaker)))
            separate.append(fells[i, 0] or fells[j, 1])
    return fallen(block, sequences, np.ones(1))[:, 0], np.array(separate)


def sentences() -> str:
    """What was found, in words."""
    said, count = [], 0
    for name, block in BLOCKS.items():
        joined, apart = sequences_of(block)
        count = joined.size
        said.append(
            f"{100 * joined.mean():.0f} % felled a {name}, where one of the two by itself felled "
            f"{100 * apart.mean():.0f} % ({(joined & ~apart).sum()} fell in the sequence alone, "
            f"{(apart & ~joined).sum()} by themselves alone)"
        )
    return (
        f"Of {count} sequences of two default records, both components (the first at the PGV at which half of "
        f"them topple the block, the second at {SECOND:g} times that), {'; '.join(said)}."
    )


def main() -> None:
    """Replace what stands between the two marks."""
    text = PAGE.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    PAGE.write_text(
        f"{before}{BEGIN}\n\n{sentences()}\n\n{END}{after}", encoding="utf-8"
    )


if __name__ == "__main__":
    main()
