"""How long it takes to read a PEER record of 200 000 samples, against numpy's own text readers."""

import tempfile
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import obspy

from rockfrag.records.read import read_motion

SAMPLES = 200_000
HEADER_LINES = 4


def write_record(path: Path) -> None:
    values = np.random.default_rng(1).normal(size=SAMPLES)
    fields = [f"{value:15.7E}" for value in values.tolist()]
    lines = [
        "PEER NGA STRONG MOTION DATABASE RECORD",
        "Benchmark, 01/01/2000, Nowhere, 090",
        "ACCELERATION TIME SERIES IN UNITS OF G",
        f"NPTS= {SAMPLES}, DT=   .0050 SEC",
        *("".join(fields[i : i + 5]) for i in range(0, SAMPLES, 5)),
    ]
    path.write_text("\n".join(lines) + "\n")


def numpy_fromstring(path: Path) -> object:
    with path.open() as file:
        for _ in range(HEADER_LINES):
            file.readline()
        return np.fromstring(file.read(), sep=" ")


def numpy_fromfile(path: Path) -> object:
    with path.open() as file:
        for _ in range(HEADER_LINES):
            file.readline()
        return np.fromfile(file, sep=" ")


def numpy_loadtxt(path: Path) -> object:
    return np.loadtxt(path, skiprows=HEADER_LINES)


def best_time(
    read: Callable[[Path], object], path: Path, repetitions: int = 7
) -> float:
    """Return the shortest of some repetitions [s of processor time]."""
    times = []
    for _ in range(repetitions):
        start = time.process_time()
        read(path)
        times.append(time.process_time() - start)
    return min(times)


NUMPY = (numpy_fromstring, numpy_fromfile, numpy_loadtxt)


def measure() -> dict[str, float]:
    """Return the time of each reader [s], numpy's first."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "benchmark.AT2"
        write_record(path)
        readers = {read.__name__: read for read in NUMPY}
        ours = {"obspy.read": obspy.read, "read_motion": read_motion}
        return {name: best_time(read, path) for name, read in (readers | ours).items()}


def main() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        times = measure()
    fastest = min(times[read.__name__] for read in NUMPY)
    print(f"{SAMPLES} samples; numpy's fastest reader takes {1e3 * fastest:.1f} ms")
    for name, seconds in times.items():
        print(f"{name:20s} {1e3 * seconds:7.1f} ms {seconds / fastest:6.2f} x")


if __name__ == "__main__":
    main()
