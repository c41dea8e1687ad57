"""Make the module of the core that the page computes with: ``python -m rockfrag.assess.app.build``.

It is built as those of the kernels are (:mod:`rockfrag.web.build`), of the functions that Python calls too.

In: the functions of :mod:`rockfrag.assess.core`. Out: a WebAssembly module beside this file.
Docs: ``docs/app.md``.
"""

from pathlib import Path
from typing import Any

import numpy as np

from rockfrag.assess.core import (
    bodies,
    choices,
    demands,
    estimates,
    fractions,
    hazards,
    holding,
    scales,
    velocity,
)
from rockfrag.building import modes
from rockfrag.engines.compile.jit import kernel
from rockfrag.motions import oscillator
from rockfrag.motions.between_samples import fill_between
from rockfrag.system.system import round_inertia
from rockfrag.web.build import module_of

PATH = Path(__file__).with_name("core.wasm")

_FLOAT, _WHOLE = 0.0, 0
_ROW, _TABLE, _CUBE = np.zeros(1), np.zeros((1, 1)), np.zeros((1, 1, 1))
_NUMBERS, _BINS = np.zeros(1, np.int64), np.zeros((1, 1), np.uint8)
_FLAGS = np.zeros((1, 1), np.bool_)
_COUNTS = (_ROW, _CUBE, _TABLE, _TABLE, _ROW, _ROW, _ROW)

ENTRIES: dict[Any, tuple[Any, ...]] = {
    fractions.fill_counts: (_ROW, _FLAGS, _FLAGS, _ROW, _NUMBERS, _TABLE, *_COUNTS),
    fractions.fill_fractions: (*_COUNTS, *(_TABLE,) * 5),
    fractions.fill_uplifts: (_ROW, _FLAGS, _FLAGS, _FLAGS, _ROW, _ROW),
    fractions.fill_counts_at: (_ROW, _FLOAT, *(_FLAGS,) * 3, _ROW),
    fractions.fill_deciding: (_ROW, _FLAGS, _FLAGS, _FLOAT, _ROW),
    fractions.fill_counted: (_FLAGS, _FLAGS, _ROW, _ROW),
    fractions.fill_shift: (_ROW,) * 6,
    estimates.fill_place: (_ROW, _FLOAT, _ROW),
    estimates.fill_sums: (_TABLE, _ROW, _ROW),
    estimates.fill_crossings: (_TABLE, _ROW, _FLOAT, _ROW),
    estimates.fill_errors: (_ROW, _TABLE, _ROW),
    estimates.sum_of_squares: (_ROW,),
    estimates.rate_of: (_FLOAT, _FLOAT),
    estimates.fill_shown: (_WHOLE, _FLOAT, _ROW, _ROW),
    estimates.fill_estimate: (
        *(_WHOLE, _FLOAT, _FLOAT, _FLOAT), *(_ROW,) * 3, _BINS, _WHOLE, _WHOLE, _ROW,
    ),
    estimates.fill_decision: (
        *(_ROW, _BINS, _NUMBERS, _ROW, _FLOAT, _FLOAT), _ROW, _TABLE, _ROW,
    ),
    estimates.fill_order: (_ROW, _ROW, False, _NUMBERS),
    estimates.fill_parts: (_ROW, _ROW),
    estimates.fill_comparison: (_WHOLE, _ROW, _ROW, _WHOLE, _WHOLE, _TABLE, _ROW),
    hazards.fill_rate_weights: (_ROW, _FLOAT, *(_ROW,) * 3),
    hazards.fill_level: (_ROW, _ROW, _FLOAT, _ROW),
    hazards.fill_power_law: (*(_FLOAT,) * 3, _ROW, _ROW),
    hazards.spread_of_quantiles: (_ROW, _ROW),
    velocity.fill_weight: (
        *(_ROW, _FLAGS, _FLAGS, _ROW, _NUMBERS, False), _TABLE, _ROW, _ROW,
    ),
    velocity.fill_wanted: (_ROW, _TABLE, _ROW),
    velocity.spread_of_mean: (_FLOAT, _FLOAT, _TABLE),
    velocity.shift_by_velocity: (*(_FLOAT,) * 3, _ROW, _FLOAT),
    velocity.fill_moved: (
        *(_ROW, *(_FLAGS,) * 3, *(_ROW,) * 3, _FLOAT, False, _ROW),
        *(np.zeros((1, 1), np.int64), *(_FLAGS,) * 3),
    ),
    scales.fill_scales: (*(_ROW,) * 3, _TABLE, _FLAGS),
    scales.fill_factors: (_TABLE, _FLAGS, _ROW, _TABLE),
    scales.peak_of: (_ROW,),
    demands.ask: (_ROW, _ROW),
    demands.count_held: (_ROW, _FLOAT),
    scales.fill_direction: (_ROW, _ROW, _FLOAT, _FLOAT, _ROW),
    scales.lifting_in_plane: (_FLOAT, _FLOAT),
    scales.lifting_over_edges: (_TABLE, _FLOAT, _ROW, _ROW),
    scales.lifting_over_rim: (*(_FLOAT,) * 4, _ROW, _ROW),
    fill_between: (_ROW, *(_FLOAT,) * 3, _ROW),
    modes.fill_modes: (_ROW, _ROW, *(_TABLE,) * 6),
    modes.fill_stiffnesses: (_ROW, _ROW, _FLOAT, _TABLE, _TABLE, _ROW),
    modes.fill_slower: (_ROW, _FLOAT, _ROW),
    modes.add_mode: (_ROW, *(_FLOAT,) * 3, _TABLE, _ROW, _TABLE, _TABLE),
}  # fmt: skip
"""Functions of the module, with arguments of their types."""

_LIMITS = (_FLOAT,) * 3
PLAIN: dict[Any, tuple[Any, ...]] = {
    choices.likelihood: (_FLOAT,),
    choices.stays: (_FLOAT,),
    choices.are_few: (_FLOAT,),
    choices.how_likely: (False, False, _FLOAT),
    choices.chance: _LIMITS,
    choices.how_far: (_FLOAT, _FLOAT),
    choices.in_years: _LIMITS,
    choices.advice: (_FLOAT, False, False, _FLOAT),
    choices.counted: (_FLOAT, _FLOAT),
    choices.between: _LIMITS,
    choices.starts: (_FLOAT,),
    choices.over_years: _LIMITS,
    choices.needs_change: (_FLOAT, False, False),
    choices.reduces: (_FLOAT, False),
    choices.change_alone: (_FLOAT, False, False),
    choices.whole_percent_below: (_FLOAT,),
    choices.tell_reduction: (*_LIMITS, _ROW),
    choices.names_source: (_FLOAT,),
    choices.lists_measurement: (_FLOAT,),
    choices.is_worse: (_FLOAT, False),
    choices.safest: (False,),
    bodies.solid_mass: (*_LIMITS, False),
    holding.tell_fastener: (_ROW, False, _ROW),
    holding.tell_springs: (_FLOAT, _ROW),
    holding.pads_across: (_FLOAT,),
    holding.rounded_up: (_FLOAT,),
    bodies.usual_period: (_FLOAT, _FLOAT),
    round_inertia: _LIMITS,
    bodies.stretch: (_ROW, *(_FLOAT,) * 3, _ROW),
    bodies.add_ballast: (_ROW, _FLOAT, _ROW),
    bodies.make_plate: (_ROW, _ROW),
    bodies.make_lower: (_ROW, _ROW),
    bodies.join: (_ROW, _ROW, _ROW),
    bodies.carries_plate: (_ROW, _ROW),
    bodies.is_whole: (_ROW, _ROW),
    bodies.tell_box: (_ROW, _ROW, _ROW),
    bodies.tell_round: (_ROW, _ROW),
    oscillator.fill_propagator: (*(_FLOAT,) * 3, _TABLE),
}
"""Plain functions of the module."""


def build_core() -> bytes:
    """Return the bytes of the module."""
    entries = {
        entry.__name__: (kernel(entry.py_func), arguments)
        for entry, arguments in ENTRIES.items()
    }
    entries |= {
        plain.__name__: (kernel(plain), arguments) for plain, arguments in PLAIN.items()
    }
    constants: dict[str, float] = {
        "MOTION": fractions.MOTION,
        "AT_LEVEL": fractions.LEVEL,
        "FALLS": fractions.FALLS,
        "FRACTION": estimates.FRACTION,
        "RATE": estimates.RATE,
        "LEVEL": estimates.LEVEL,
        "CLASSES": fractions.CLASSES,
        "BINS": estimates.BINS,
        "ACTION": estimates.ACTION,
        "OTHERWISE": estimates.OTHERWISE,
        "FIRST": estimates.FIRST,
        "MOST_LEVELS": velocity.MOST_LEVELS,
        "MEMORY": velocity.MEMORY,
        "STATE": velocity.STATE,
    }
    # of what a page hands over all stands in arrays
    records = {"call": np.dtype([("nothing", np.float64)])}
    return module_of(entries, records, constants, fused=None)


if __name__ == "__main__":
    PATH.write_bytes(build_core())
    print(f"{PATH}: {PATH.stat().st_size} bytes")
