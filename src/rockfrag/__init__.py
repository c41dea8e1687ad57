"""Rocking and overturning of free-standing objects in earthquakes.

Lengths are in metres, masses in kilograms, accelerations in m/s², angles in radians.

>>> import numpy as np
>>> from rockfrag import Block, Motion, simulate
>>> time = np.arange(0, 2, 0.01)
>>> motion = Motion(4.0 * np.sin(2 * np.pi * time) * (time < 1), dt=0.01)
>>> statue = Block(width=0.3, height=1.2, mass=180.0)
>>> simulate(statue, motion).overturned
True

What is most used stands here; the rest is in the subpackages, and ``dir()`` of each lists it:

===========  ======================================================================
records      read, write and list strong-motion records
motions      filter, scale, rotate, measure; spectra, pulses, synthetic motions
building     motions of the floors of a building
system       what is shaken: bodies, contacts, blocks, stacks and columns
outcomes     what comes out: tables of outcomes, limit states
simulation   single histories, ensembles, thresholds, rocking spectra
shaketable   what a shaking table can do, and protocols of its tests
fragility    curves and their intervals, choice of the intensity measure, exports
effects      paired comparison of objects with and without a pedestal
collections  dimensions that museums write in words, made inventories
assess       one object at one place: what ``rockfrag assess`` does
===========  ======================================================================
"""

import difflib
from typing import Any

import lazy_loader

__version__ = "0.2.0"

_find, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
_SUBPACKAGES = (
    "records",
    "motions",
    "building",
    "system",
    "outcomes",
    "simulation",
    "shaketable",
    "fragility",
    "effects",
    "collections",
    "assess",
)


def __getattr__(name: str) -> Any:
    """Load a public name when it is first used; say where a name stands that is looked for in vain."""
    if name in __all__:
        return _find(name)
    if not name.startswith("_"):
        for package in _SUBPACKAGES:
            if name in _find(package).__all__:
                raise AttributeError(
                    f"module 'rockfrag' has no attribute '{name}'; it is rockfrag.{package}.{name}"
                )
    near = difflib.get_close_matches(name, __all__, n=1)
    meant = f"; did you mean {near[0]}?" if near else ""
    raise AttributeError(f"module 'rockfrag' has no attribute '{name}'{meant}")
