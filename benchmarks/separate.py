"""Measurements that need a process of their own: start-up and memory.  Called by ``run.py``."""

import resource
import sys
import tempfile
import time
from pathlib import Path


def first_outcome(kind: str) -> float:
    """Seconds from importing the package to the first outcome."""
    start = time.perf_counter()
    import numpy as np

    from rockfrag.simulation.ensemble import overturns
    from rockfrag.system.blocks import Block, Stack

    block = Block(0.3, 1.2, 200.0)
    body = block if kind == "lone" else Stack(Block(0.4, 0.3, 100.0), block)
    motion = 6.0 * np.sin(np.arange(1000) * 0.06)
    overturns(body, motion, 0.01, [1.0])
    return time.perf_counter() - start


def streamed_memory(kind: str, count: int) -> float:
    """Largest resident memory [MiB] of a process that streams ``count`` short histories to a file."""
    import numpy as np

    from rockfrag.simulation.parquet import stream_overturns
    from rockfrag.system.blocks import Block, Body, Stack

    blocks = [Block(0.3 + 0.001 * i, 1.2, 200.0) for i in range(100)]
    bodies: list[Body] = (
        [*blocks]
        if kind == "lone"
        else [Stack(Block(0.5, 0.3, 100.0), block) for block in blocks]
    )
    time_ = np.arange(100) * 0.01
    motions = [9.81 * np.sin(2 * np.pi * f * time_) for f in np.linspace(1.0, 3.0, 20)]
    scales = np.linspace(0.1, 1.0, count // 2000)
    with tempfile.TemporaryDirectory() as folder:
        stream_overturns(
            bodies, motions, 0.01, scales, Path(folder) / "e.parquet", table="bodies"
        )
    status = Path("/proc/self/status")
    if not status.exists():
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    # the other figure starts from the memory of the process that started this one
    line = next(
        line for line in status.read_text().splitlines() if line.startswith("VmHWM")
    )
    return int(line.split()[1]) / 1024


if __name__ == "__main__":
    what, kind, *count = sys.argv[1:]
    print(
        first_outcome(kind) if what == "first" else streamed_memory(kind, int(count[0]))
    )
