"""Boxes that tip under motions of trucks, conveyors, cranes and ships: cost, bits, statics, and half the step.

Run as ``python benchmarks/base_motion.py [boxes]``. Prints one line a statement; the last word of each is a number
that may be quoted with the machine. Times are processor times of this process.
"""

import hashlib
import sys
import time

import numpy as np

from rockfrag import Block, GroundMotion, Motion, overturns
from rockfrag.base.units import GRAVITY
from rockfrag.engines.steps import STEP

DT = 0.005
BOXES = 20_000


def ramped(peak_g: float, ramp: float, hold: float) -> Motion:
    """Acceleration [m/s²] that rises within ``ramp``, holds, falls, and leaves two seconds of rest [s]."""
    corners = np.cumsum([0.0, ramp, hold, ramp, 2.0])
    at = np.arange(0.0, corners[-1], DT)
    values = np.interp(at, corners, np.array([0, 1, 1, 0, 0]) * peak_g * GRAVITY)
    return Motion(values, DT, name=f"{peak_g:g} g for {hold:g} s")


def swinging(peak_g: float, period: float) -> Motion:
    """Acceleration [m/s²] of a load under a crane that swings five times and dies out."""
    at = np.arange(0.0, 5 * period, DT)
    values = np.exp(-at / (2 * period)) * np.sin(2 * np.pi * at / period)
    return Motion(peak_g * GRAVITY * values, DT, name=f"swings {period:g} s")


def rolling(degrees: float, period: float) -> GroundMotion:
    """Accelerations along and across a deck that rolls [m/s²]."""
    at = np.arange(0.0, 3 * period, DT)
    angle = np.radians(degrees) * np.sin(2 * np.pi * at / period)
    along = Motion(GRAVITY * np.sin(angle), DT, name=f"rolls {degrees:g}°")
    return GroundMotion(along, z=Motion(GRAVITY * (np.cos(angle) - 1), DT))


PROFILES = [
    *(GroundMotion(ramped(peak, 0.3, 2.0)) for peak in (0.3, 0.5, 0.8)),
    GroundMotion(ramped(0.3, 0.05, 0.4)),
    GroundMotion(swinging(0.25, 4.0)),
    rolling(20.0, 8.0),
]


def boxes(count: int, seed: int = 1) -> list[Block]:
    """Random boxes, 0.2 to 2.5 m high, twice to six times as high as wide."""
    draw = np.random.default_rng(seed)
    height = draw.uniform(0.2, 2.5, count)
    width = height / draw.uniform(1.2, 6.0, count)
    return [
        Block(float(b), float(h), float(400 * b * b * h))
        for b, h in zip(width, height, strict=True)
    ]


def digest(values: np.ndarray) -> str:
    """Sixteen digits that are equal where all bits are."""
    return hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()[:16]


def statics(bodies: list[Block], rocked: np.ndarray) -> int:
    """Number of cases that rock although no sample of the profile exceeds what they bear."""
    wrong = 0
    least = np.array([np.tan(body.alpha) for body in bodies])
    for j, profile in enumerate(PROFILES):
        weight = GRAVITY + (0.0 if profile.z is None else profile.z.acceleration)
        most = float((np.abs(profile.x.acceleration) / weight).max())
        wrong += int((rocked[:, j] & (least > most * (1 + 1e-9))).sum())
    return wrong


def main(count: int) -> None:
    """Tip the boxes, and print what it costs and what holds."""
    bodies = boxes(count)
    overturns(bodies[:16], PROFILES)
    begun = time.process_time()
    found = overturns(bodies, PROFILES, threads=1)
    seconds = time.process_time() - begun
    again = overturns(bodies, PROFILES, threads=3)
    half = overturns(bodies, PROFILES, step=STEP / 2)
    cases = found.overturned.size
    rocked = found.peak_rotation[:, :, 0, 0] > 0
    same = digest(found.peak_velocity) == digest(again.peak_velocity)
    changed = int((found.overturned != half.overturned).sum())
    print(f"{cases} outcomes, {found.overturned.mean():.1%} tip: {seconds:.2f} s")
    print(f"outcomes a second of one processor: {cases / seconds:.0f}")
    print(f"same bits with three threads (1 yes): {int(same)}")
    print(f"rock although statics forbids it: {statics(bodies, rocked)}")
    print(f"outcomes that change at half the step: {changed}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else BOXES)
