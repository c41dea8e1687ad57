"""A law of impacts with a function of its own, declared first, is compiled into the kernels."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = """
import numpy as np
from rockfrag import laws

def rate(value, by_momentum, before, moved):
    return value * (0.25 * by_momentum + 0.5 * before)

declared = laws.declare("between", lambda shape, ratio, pivot: (4, ratio), rate)
assert declared.number == 4

from rockfrag import Block, MeasuredRestitution, Stack, simulate

body = Stack(Block(0.6, 0.4, 300.0), Block(0.3, 1.2, 110.0))
shake = 5.0 * np.sin(2 * np.pi * 1.1 * np.arange(0, 1, 0.01))

def first(law, ratio):
    found = simulate(body, shake, 0.01, restitution=MeasuredRestitution((None, ratio), law))
    impacts = found.contact_events[found.contact_events["kind"] == "impact"]
    return impacts.iloc[0]

def turning(of):
    return of[1] - of[0]

plain = simulate(body, shake, 0.01).contact_events
plain = plain[plain["kind"] == "impact"].iloc[0]
own = first("between", 0.8)
wanted = 0.8 * (0.25 * turning(plain["omega_after"]) + 0.5 * turning(plain["omega_before"]))
assert np.isclose(turning(own["omega_after"]), wanted, rtol=1e-12), (turning(own["omega_after"]), wanted)
assert not np.isclose(turning(first("ratio", 0.8)["omega_after"]), wanted, rtol=1e-3)
"""


@pytest.mark.slow
def test_a_law_with_a_rate_of_its_own_is_inlined_by_the_kernels(tmp_path: Path) -> None:
    # kept code is that of the laws it was compiled with
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT],
        env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
