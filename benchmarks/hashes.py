"""Print digests of what the kernels compute, to see whether a change of them changes a bit.

    python benchmarks/hashes.py > before.txt
    … change the kernels …
    python benchmarks/hashes.py | diff before.txt -

Outcomes and peaks of 10⁴ random blocks and 10⁴ random stacks, of uneven bodies with measured restitution, and
whole histories; ensembles on one and on two threads.
"""

import hashlib
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.simulation.ensemble import overturns
from rockfrag.simulation.history import simulate
from rockfrag.system.blocks import Block, Body, Stack

# the random cases lie with the oracles of the tests
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tests.oracle.cases import DT, blocks, cases, motions, stacks


def digest(arrays: list[NDArray[Any]]) -> str:
    """First 16 digits of the SHA-256 of the arrays' bytes."""
    made = hashlib.sha256()
    for values in arrays:
        made.update(np.ascontiguousarray(values).tobytes())
    return made.hexdigest()[:16]


def ensemble(threads: int, *arguments: Any, **settings: Any) -> str:
    """Digest of every array of an ensemble's result."""
    found = overturns(*arguments, threads=threads, **settings)
    # as the kernels number bodies: 2 is the uppermost one, 1 the one below it
    lone = np.array([count == 1 for count in found.counts])[:, np.newaxis, np.newaxis]
    fallen = np.where(lone & found.overturned, 2, found.overturned_body).astype(np.int8)
    below = np.where(lone, 0.0, found.peak_rotation[..., 0])
    return digest(
        [
            found.overturned, fallen, found.certain_time, found.of_top("peak_rotation"), below,
            found.of_top("peak_velocity"), found.impacts, found.unstable_distance,
        ]
    )  # fmt: skip


def uneven() -> tuple[list[Body], list[Any]]:
    """Leaning bodies with their weight to one side, and a measured restitution for each."""
    block = Block(0.3, 1.2, 100.0, cg_offset=0.02, lean=0.01)
    on_top = Stack(
        Block(0.4, 0.3, 150.0, cg_offset=-0.01, lean=0.005), block, offset=0.01
    )
    return [block, block, on_top, on_top, on_top], [
        None,
        0.9,
        None,
        (0.93, 0.9),
        (None, 0.95),
    ]


def histories(bodies: list[Body], count: int, **settings: Any) -> str:
    """Digest of histories, forces and energies of bodies under random motions."""
    rng = np.random.default_rng(7)
    shaken = motions(count, seed=9)
    arrays = []
    for i in range(count):
        body = bodies[i % len(bodies)]
        response = simulate(body, rng.uniform(0.1, 0.9) * shaken[i], DT, **settings)
        arrays += [response.theta, response.omega, response.alpha, response.state]
        energy = response.energy
        if response.system.count == 1:
            # the kernels' lower body, which a lone one has not
            energy = energy.assign(lost_contact_0=0.0)
            energy = energy[
                [*energy.columns[:4], "lost_contact_0", *energy.columns[4:-1]]
            ]
        arrays += [energy.to_numpy(), response.normal_force]
        arrays += [response.contact_events[["time", "energy_after"]].to_numpy()]
        arrays += [
            np.array([response.unstable_distance, response.impacts, response.grazings])
        ]
    return digest(arrays)


if __name__ == "__main__":
    # random bodies are meant to be odd; only bits count here
    warnings.simplefilter("ignore")
    for kind in ("lone", "stack"):
        drawn = cases(kind)
        for threads in (1, 2):
            print(
                f"{kind} {drawn.count} threads {threads}:",
                ensemble(threads, drawn.bodies, drawn.accelerations, DT, drawn.scales),
            )
    bodies, restitution = uneven()
    amplitudes = np.linspace(0.1, 1.2, 40)
    for threads in (1, 2):
        print(
            f"uneven threads {threads}:",
            ensemble(
                threads,
                bodies,
                motions(8, seed=3),
                DT,
                amplitudes,
                restitution=restitution,
            ),
        )
    print("histories of blocks:", histories(blocks(40, 5), 40))
    print("histories of stacks:", histories(stacks(40, 5), 40))
    print("histories of stacks, linear:", histories(stacks(40, 5), 20, linear=True))
    print("histories of blocks, linear:", histories(blocks(40, 5), 20, linear=True))
    print("uneven histories:", histories([bodies[0], bodies[2]], 20))
    print("uneven block, measured:", histories(bodies[:1], 10, restitution=0.9))
    print(
        "uneven stack, measured:", histories(bodies[2:3], 10, restitution=(0.93, 0.9))
    )
