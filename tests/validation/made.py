"""Random numbers and tables that several validations draw."""

import math

import numpy as np
import pandas as pd


def drawn(rng, law, size):
    """Values of mean zero and unit variance: ``normal``, ``t3`` or ``exponential``."""
    if law == "t3":
        return rng.standard_t(3, size=size) / math.sqrt(3)
    return rng.exponential(size=size) - 1 if law == "exponential" else rng.normal(size=size)


def pairs_of(d, **more):
    """Log ratios of one data set, shape (earthquakes, floors, objects), as a table of pairs."""
    names = (
        [f"{letter}{k}" for k in np.indices(d.shape)[at].ravel()] for at, letter in enumerate("EFT")
    )
    table = pd.DataFrame(dict(zip(("earthquake", "floor", "object"), names, strict=True)))
    return table.assign(motion=table["earthquake"] + table["floor"], d=d.ravel(), **more)
