"""The random cases that speed and accuracy are measured on: bodies × motions × amplitudes.

Base 0.1-1.0 m, H/B 3-6, peak ground acceleration 0.1-1.05 g, 40 s at 0.01 s.  Everything follows from
one seed; the ranges are filled evenly (one draw from each of as many equal fractions as there are values).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockfrag.motions.synthetic import evolutionary
from rockfrag.system.blocks import Block, Body, Column, Stack

DT = 0.01
SAMPLES = 4000
G = 9.81
DENSITY = 2700.0


@dataclass(frozen=True)
class Cases:
    """Bodies × motions × scales; ``accelerations`` have a peak of 1 g and ``scales`` are PGAs [g]."""

    bodies: list[Body]
    accelerations: list[NDArray[np.float64]]
    scales: NDArray[np.float64]
    dt: float = DT

    @property
    def count(self) -> int:
        """Number of histories."""
        return len(self.bodies) * self.scales.size

    def each(self, count, seed=0):
        """Yield index, body and scaled acceleration of ``count`` cases drawn without repetition."""
        shape = (len(self.bodies), *self.scales.shape)
        chosen = np.random.default_rng(seed).choice(self.count, count, replace=False)
        for flat in np.sort(chosen):
            i, j, k = (int(n) for n in np.unravel_index(flat, shape))
            yield (i, j, k), self.bodies[i], self.scales[j, k] * self.accelerations[j]


def filled(
    rng: np.random.Generator, low: float, high: float, count: int
) -> NDArray[np.float64]:
    """Draw one value from each of ``count`` equal fractions of a range, in random order."""
    return low + (high - low) * rng.permutation(
        (np.arange(count) + rng.random(count)) / count
    )


def motions(count: int, seed: int) -> list[NDArray[np.float64]]:
    """Return stochastic motions of 40 s whose peak is 1 g [m/s²].

    Durations, frequencies and bandwidths span those that Rezaeian & Der Kiureghian (2010) fitted to
    records of strong earthquakes on firm ground.
    """
    rng = np.random.default_rng(seed)
    drawn = {"d5_95_s": filled(rng, 6.0, 20.0, count)}
    drawn["mid_s"] = drawn["d5_95_s"] * filled(rng, 0.4, 0.9, count)
    ranges = {
        "mid_hz": (1.5, 8.0),
        "slope_hz_s": (-0.25, 0.0),
        "filter_damping": (0.1, 0.5),
    }
    drawn |= {
        name: filled(rng, low, high, count) for name, (low, high) in ranges.items()
    }
    made = []
    for i in range(count):
        own = {name: float(values[i]) for name, values in drawn.items()}
        motion = evolutionary(seed * 1_000_003 + i, arias_m_s=1.0, dt=DT, **own)
        motion = motion.acceleration[:SAMPLES]
        values = np.zeros(SAMPLES)
        values[: motion.size] = motion
        made.append(values * (G / np.abs(values).max()))
    return made


def blocks(count: int, seed: int) -> list[Body]:
    """Return lone blocks of granite."""
    rng = np.random.default_rng(seed + 1)
    base, ratio = filled(rng, 0.1, 1.0, count), filled(rng, 3.0, 6.0, count)
    return [
        Block(width=b, height=b * r, mass=DENSITY * b * b * b * r)
        for b, r in zip(base.tolist(), ratio.tolist(), strict=True)
    ]


def stacks(count: int, seed: int) -> list[Body]:
    """Return such blocks on pedestals a little wider than they, once to twice as high as wide."""
    rng = np.random.default_rng(seed + 2)
    wider, ratio = filled(rng, 1.05, 1.5, count), filled(rng, 0.5, 2.0, count)
    made: list[Body] = []
    for upper, w, r in zip(
        blocks(count, seed), wider.tolist(), ratio.tolist(), strict=True
    ):
        assert isinstance(upper, Block)
        base = upper.width * w
        made.append(
            Stack(Block(base, base * r, DENSITY * base * base * base * r), upper)
        )
    return made


def cases(kind: str, count: int = 10_000, seed: int = 5) -> Cases:
    """Return about ``count`` random cases of ``kind`` "lone" or "stack": a fifth of them per amplitude.

    10⁴ are 40 bodies × 50 motions × 5 amplitudes; other counts keep these proportions.
    """
    side = (count / 10_000) ** (1 / 3)
    n_bodies, n_motions = max(2, round(40 * side)), max(2, round(50 * side))
    n_scales = max(1, round(count / (n_bodies * n_motions)))
    rng = np.random.default_rng(seed + 3)
    pga = np.sort(
        filled(rng, 0.1, 1.05, n_motions * n_scales).reshape(n_motions, n_scales),
        axis=1,
    )
    made = blocks(n_bodies, seed) if kind == "lone" else stacks(n_bodies, seed)
    return Cases(made, motions(n_motions, seed), pga)


def columns(bodies: int, count: int, seed: int = 3) -> Cases:
    """Columns of as many blocks that narrow upwards, the uppermost slender, under two motions at two scales."""
    rng = np.random.default_rng(seed)
    made = []
    for width in filled(rng, 0.3, 1.0, max(1, count // 4)):
        widths = np.linspace(1.3 * width, width, bodies)
        heights = np.append(
            filled(rng, 0.3, 1.0, bodies - 1) * widths[:-1], 3.5 * width
        )
        sizes = zip(widths.tolist(), heights.tolist(), strict=True)
        made.append(Column(tuple(Block(b, h, DENSITY * (b * b * h)) for b, h in sizes)))
    return Cases(made, motions(2, seed), np.array([[0.4, 0.8], [0.4, 0.8]]))


def drum_column(drums: int = 7) -> Column:
    """Drums of equal height that taper from 1.11 to 0.90 m, and a capital: 5.95 m of 2620 kg/m³."""
    height, capital = (5.95 - 0.45) / drums, (0.90, 0.45)
    sizes = [(1.11 - 0.21 * (k + 0.5) / drums, height) for k in range(drums)]
    made = []
    for width, tall in (*sizes, capital):
        # round: mass of a cylinder, inertia of one across its axis
        mass = 2620 * np.pi / 4 * width**2 * tall
        made.append(Block(width, tall, mass, mass * (0.75 * width**2 + tall**2) / 12))
    return Column(tuple(made))


def drum_pulse(duration: float, dt: float) -> NDArray[np.float64]:
    """+1 for a duration [s], -1/2 for twice as long [m/s²]: the ground ends at rest."""
    time = np.arange(0, 3 * duration + dt / 2, dt)
    return np.where(time < duration, 1.0, np.where(time < 3 * duration, -0.5, 0.0))
