"""Medians of overturning in space beside planar ones, as ``docs/space.md`` prints them.

``python benchmarks/space_medians.py config/space.yaml --folder FOLDER`` prints a table; records are fetched
into the folder once.  A level is the geometric mean of the peaks of both components.  Intervals (90 %) are
those of resampled earthquakes.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from rockfrag.assess.motions import Records, common_pair, motion_set
from rockfrag.assess.place import Place
from rockfrag.engines.spatial import run_in_space
from rockfrag.motions.rotation import rotate
from rockfrag.records.ground_motion import GroundMotion
from rockfrag.records.motion import Motion
from rockfrag.rocking.ensemble import overturns
from rockfrag.system.blocks import Block

G = 9.81
DENSITY = 2500.0
Pair = tuple[Motion, Motion]


def records(folder: Path, every: int) -> tuple[list[Pair], NDArray[Any]]:
    """Pairs of components, and the earthquake of each."""
    found = motion_set(Records(), Place(), folder)
    pairs = [common_pair(found, pair) for pair in found.pairs[::every]]
    return pairs, np.array([found.contact_events[pair[0]] for pair in found.pairs[::every]])


def bodies(study: dict[str, Any]) -> Iterator[tuple[str, float, float, Block]]:
    """Base, slenderness, height and body of each row."""
    for base in study["bases"]:
        for slenderness in study["slenderness"]:
            for height in study["heights_m"]:
                width = height / slenderness
                is_round = base.startswith("round")
                depth = None if is_round else width * (2 if base == "one to two" else 1)
                mass = DENSITY * width * (depth or width) * height
                yield (
                    base, slenderness, height,
                    Block(width, height, mass, depth=depth, round=is_round),
                )  # fmt: skip


def median(fractions: NDArray[np.float64], levels: NDArray[np.float64]) -> float:
    """Level at which half of the motions topple a body, between levels by the logarithm; NaN beyond them."""
    rising = np.maximum.accumulate(fractions)
    k = int(np.searchsorted(rising, 0.5))
    if k == 0 or k == rising.size:
        return float("nan")
    part = (0.5 - rising[k - 1]) / (rising[k] - rising[k - 1])
    return float(levels[k - 1] * (levels[k] / levels[k - 1]) ** part)


def answers(
    body: Block, pairs: list[Pair], scales: NDArray[np.float64], directions: int, lossless: bool
) -> dict[str, NDArray[np.float64]]:
    """Fraction of directions in which each record topples a body at each level, shape (records, levels)."""
    shaking = [GroundMotion(pair, other) for pair, other in pairs]
    space = run_in_space([body], shaking, scales, threads=2).overturned[0].astype(float)
    plane = Block(
        body.width, body.height, body.mass, body.body.tensor[1, 1] if body.round else None
    )
    angles = np.arange(directions) * 180 / directions
    turned = [rotate(pair, other, angle) for pair, other in pairs for angle in angles]
    loss = [1.0] if lossless else None
    fell = overturns(plane, turned, scales=np.repeat(scales, directions, axis=0), restitution=loss)
    around = fell.overturned[0].reshape(len(pairs), directions, -1)
    quarter = directions // 2
    return {
        "space": space,
        "one component": around[:, [0, quarter]].mean(axis=1),
        "mean of directions": around.mean(axis=1),
        "worst direction": around.any(axis=1).astype(float),
    }


def ratio(
    found: dict[str, NDArray[np.float64]], name: str, rows: NDArray[np.int64], levels: Any
) -> float:
    """Median in space over a planar one, of some records."""
    return median(found["space"][rows].mean(0), levels) / median(found[name][rows].mean(0), levels)


def interval(
    found: dict[str, NDArray[np.float64]],
    name: str,
    contact_events: NDArray[Any],
    study: dict[str, Any],
    levels: Any,
) -> tuple[float, float]:
    """90 % of the ratios of resampled earthquakes."""
    rng = np.random.default_rng(study["seed"])
    of_contact_event = [
        np.flatnonzero(contact_events == contact_event)
        for contact_event in np.unique(contact_events)
    ]
    ratios = []
    for _ in range(study["resamples"]):
        drawn = rng.integers(0, len(of_contact_event), len(of_contact_event))
        rows = np.concatenate([of_contact_event[k] for k in drawn])
        ratios.append(ratio(found, name, rows, levels))
    low, high = np.nanquantile(ratios, [0.05, 0.95])
    return float(low), float(high)


def main(study: dict[str, Any], folder: Path) -> None:
    """Print the table."""
    pairs, contact_events = records(folder, study["every"])
    peaks = np.array([np.sqrt(pair.pga * other.pga) for pair, other in pairs])
    print(f"{len(pairs)} records of {len(set(contact_events))} earthquakes")
    planar = ("one component", "mean of directions", "worst direction")
    print("| base | H/B | H [m] | in space [g] | " + " | ".join(f"over {p}" for p in planar) + " |")
    print("|---|--:|--:|--:|" + "--:|" * len(planar))
    for base, slenderness, height, body in bodies(study):
        spread = np.geomspace(study["lowest"], study["highest"], study["levels"])
        levels = spread / slenderness
        found = answers(
            body, pairs, levels * G / peaks[:, None], study["directions"], "loss" in base
        )
        every = np.arange(len(pairs))
        cells = [f"{median(found['space'].mean(0), levels):.2f}"]
        for name in planar:
            low, high = interval(found, name, contact_events, study, levels)
            cells.append(f"{ratio(found, name, every, levels):.2f} ({low:.2f}-{high:.2f})")
        print(
            f"| {base} | {slenderness} | {height} | " + " | ".join(cells) + " |",
            flush=True,
        )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", type=Path)
    parser.add_argument("--folder", type=Path, default=Path("results/records"))
    given = parser.parse_args()
    main(yaml.safe_load(given.study.read_text(encoding="utf-8")), given.folder)
