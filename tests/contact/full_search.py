"""An oracle: all modes that touching ends allow, tried one after the other, fewer closed ends first."""

import numpy as np

from rockfrag.engines.kernels.jit import entry_kernel
from rockfrag.engines.planar.search import (
    CONSISTENT,
    mode_number,
    search,
    take_number,
    try_mode,
    weigh,
)
from rockfrag.engines.planar.solve import look_at


def modes_of(touching: np.ndarray, moves: np.ndarray, impact: bool) -> np.ndarray:
    """Numbers of all modes of touching ends, in the order in which they are tried."""
    listed = [(0, 0)]
    for k, ends in enumerate(touching):
        choices = []
        for code in range(4):
            if (code & 1) > ends[0] or (code >> 1) > ends[1]:
                continue
            ways = [0] if code == 0 else [0, 1, -1]
            if code and not impact and moves[k]:
                ways = [moves[k]]
            closed = (code & 1) + (code >> 1)
            choices += [((code + 4 * (way + 1)) << (4 * k), closed) for way in ways]
        listed = [(n + a, c + b) for n, c in listed for a, b in choices]
    return np.array([number for number, _ in sorted(listed, key=lambda item: item[1])])


@entry_kernel
def try_all(p, w, ah, av, impact, force, motion, numbers, margins):
    """Least margin of every mode."""
    look_at(p, w, w.q)
    weigh(p, w, ah, av, impact)
    for i in range(numbers.size):
        take_number(p, w, numbers[i])
        margins[i] = try_mode(p, w, impact, force, motion)


@entry_kernel
def search_quickly(p, w, ah, av, impact, force, motion):
    """Number of the mode that the package takes."""
    look_at(p, w, w.q)
    search(p, w, ah, av, impact, force, motion, -1)
    return mode_number(p, w.closed, w.slides)


def consistent(margins: np.ndarray) -> np.ndarray:
    """Which modes violate nothing."""
    return margins >= -CONSISTENT
