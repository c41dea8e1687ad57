"""A box and a cylinder under three components, 40 s at 0.01 s: the engine in space beside MuJoCo in steps of 1 ms.

Prints cases per second of process time of both, in one run, the fractions overturned, whether one and two
threads give the same bits, and by how much the peak memory grows in space and in the
plane; then what is reached of what was meant to be.  ``python benchmarks/space.py [motions]``
"""

import multiprocessing
import resource
import sys
import time
from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfilt

from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation.ensemble import overturns
from rockfrag.system.blocks import Block

DT = 0.01
G = 9.81
WIDTH, HEIGHT, MASS = 0.35, 1.2, 300.0
BODIES = {
    "box": Block(WIDTH, HEIGHT, MASS, depth=WIDTH),
    "round": Block(WIDTH, HEIGHT, MASS, round=True),
}
GEOMETRIES = {
    "box": f'type="box" size="{WIDTH / 2} {WIDTH / 2} {HEIGHT / 2}"',
    "round": f'type="cylinder" size="{WIDTH / 2} {HEIGHT / 2}"',
}
"""The same bodies as MuJoCo has them."""
TIMES_MUJOCO = {"box": 600, "round": 300}
"""How many times as fast as MuJoCo at 1 ms each should be."""
SCALES = (0.35, 0.45, 0.6)
MANY = 1000
"""Scales of one motion, whose cases in space and in the plane are held against each other in memory."""
PASSES = 10
"""Passes of the engine, each of a tenth of a second; the fastest counts."""
SCENE = """
<mujoco><option timestep="0.001" cone="elliptic" impratio="100" gravity="0 0 -9.81"/>
<default><geom friction="{friction} 0 0" condim="3" solref="0.002 1" solimp="0.99 0.999 0.0001"/></default>
<worldbody><geom type="plane" size="50 50 1"/>
<body pos="0 0 {half}"><freejoint/><geom {geometry} mass="{mass}"/></body></worldbody></mujoco>
"""
Array = NDArray[np.float64]


def motions(count: int) -> list[Array]:
    """Synthetic motions with three components, largest horizontal accelerations 1 g, shape (4000, 3) each."""
    rng = np.random.default_rng(3)
    time_ = np.arange(4000) * DT
    envelope = np.exp(-(((time_ - 14) / 7.2) ** 2))[:, None]
    made = []
    for _ in range(count):
        sections = butter(2, [0.3, rng.uniform(2, 5)], "band", fs=1 / DT, output="sos")
        noise = sosfilt(sections, rng.standard_normal((4000, 3)), axis=0) * envelope
        peaks = np.abs(noise[:, :2]).max(axis=0)
        made.append(noise * [1, 1, 0.5] * G / np.sqrt(peaks.prod()))
    return made


def mujoco_falls(ground: Array, kind: str = "box", friction: float = 1.0) -> bool:
    """Whether a body falls in MuJoCo, which stops as soon as it lies."""
    import mujoco

    about = {"geometry": GEOMETRIES[kind], "half": HEIGHT / 2, "mass": MASS}
    scene = SCENE.format(friction=friction, **about)
    model = mujoco.MjModel.from_xml_string(scene)
    data = mujoco.MjData(model)
    each = round(DT / model.opt.timestep)
    for k in range(len(ground) - 1):
        for part in range(each):
            fraction = (part + 0.5) / each
            pull = -(ground[k] * (1 - fraction) + ground[k + 1] * fraction)
            model.opt.gravity[:] = (pull[0], pull[1], pull[2] - G)
            mujoco.mj_step(model, data)
        if data.xmat[1][8] <= 0.2:
            return True
    return False


def grown(work: Callable[..., object]) -> float:
    """Peak memory by which many cases take more than one, in a process of their own [MiB]."""
    work(scales=[0.2])
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    work(scales=[0.1 + 0.6 * k / MANY for k in range(MANY)])
    return (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024


def memory(body: Block, motion: GroundMotion) -> None:
    """Print how much memory many cases take in space and in the plane."""
    flat = Block(body.width, body.height, body.mass)
    works = (
        partial(overturns, [body], [motion]),
        partial(overturns, [flat], [motion.x]),
    )
    with multiprocessing.get_context("spawn").Pool(1, maxtasksperchild=1) as pool:
        space, plane = pool.map(grown, works, chunksize=1)
    print(
        f"memory of {MANY} cases: {space:.1f} MiB in space, {plane:.1f} MiB in the plane"
    )


def times_as_fast(kind: str, shaken: list[GroundMotion], made: list[Array]) -> float:
    """Run a body in both programs and print; return how many times as fast as MuJoCo the engine is."""
    body = BODIES[kind]
    overturns([body], shaken[:1], scales=[0.1])
    times = []
    for _ in range(PASSES):
        start = time.process_time()
        first = overturns([body], shaken, scales=SCALES)
        times.append(time.process_time() - start)
    ours = len(made) * len(SCALES) / min(times)
    second = overturns([body], shaken, scales=SCALES, threads=2)
    equal = np.array_equal(first.turn, second.turn) and np.array_equal(
        first.certain_time, second.certain_time, equal_nan=True
    )
    fell = first.overturned[0]
    print(f"{kind} in space: {ours:.1f} cases/s, overturned {fell.mean(axis=0)}")
    print(f"one and two threads give the same bits: {equal}")
    start = time.process_time()
    fallen = np.array(
        [[mujoco_falls(item * scale, kind) for scale in SCALES] for item in made]
    )
    theirs = fallen.size / (time.process_time() - start)
    print(f"MuJoCo, 1 ms: {theirs:.2f} cases/s, overturned {fallen.mean(axis=0)}")
    print(f"outcomes equal: {(fallen == fell).mean():.2f}", flush=True)
    return ours / theirs


def main(count: int) -> None:
    """Run both bodies in both programs and print."""
    made = motions(count)
    shaken = [
        GroundMotion(*(Motion(component, DT) for component in item.T)) for item in made
    ]
    memory(BODIES["box"], shaken[0])
    for kind, least in TIMES_MUJOCO.items():
        times = times_as_fast(kind, shaken, made)
        met = "met" if times >= least else "not met"
        print(f"{kind}: {times:.0f} times as fast as MuJoCo at 1 ms (≥ {least}: {met})")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 8)
