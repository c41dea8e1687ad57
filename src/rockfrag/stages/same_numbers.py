"""The same numbers on every processor: what libraries choose by the machine at hand is chosen for them.

Versions of a function for older and for newer processors add in another order or round once instead of twice. A
job takes the oldest of each, so that all machines of one architecture write the same bytes; kernels need none.
"""

import platform
from collections.abc import Mapping

import numpy as np

_BLAS = {"x86_64": "PRESCOTT", "AMD64": "PRESCOTT", "aarch64": "ARMV8", "arm64": "ARMV8"}
"""The kernels of OpenBLAS that every processor of an architecture can run."""

_C_LIBRARY = "glibc.cpu.hwcaps=" + ",".join(
    # the C library has known each of them by two names
    f"-{feature}{ending}"
    for feature in ("FMA", "FMA4", "AVX2")
    for ending in ("", "_Usable")
)


def same_numbers(environment: Mapping[str, str]) -> dict[str, str]:
    """Variables, set before Python starts, by which numbers depend on architecture and libraries alone."""
    simd = np.show_config(mode="dicts")["SIMD Extensions"]
    chosen = {
        "NPY_ENABLE_CPU_FEATURES": "",
        "NPY_DISABLE_CPU_FEATURES": " ".join([*simd.get("found", ()), *simd.get("not found", ())]),
        # sums of several threads are added in another order
        "OPENBLAS_NUM_THREADS": "1",
        "GLIBC_TUNABLES": _with_c_library(environment.get("GLIBC_TUNABLES", "")),
    }
    if blas := _BLAS.get(platform.machine()):
        chosen["OPENBLAS_CORETYPE"] = blas
    return chosen


def _with_c_library(tunables: str) -> str:
    kept = [
        tunable
        for tunable in tunables.split(":")
        if tunable and not tunable.startswith("glibc.cpu.hwcaps=")
    ]
    return ":".join([*kept, _C_LIBRARY])
