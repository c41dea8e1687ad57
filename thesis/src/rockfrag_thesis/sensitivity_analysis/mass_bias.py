"""Bias of P/NP where accelerations are computed from force, and mass was not counted.

An acceleration may be taken as the shaker's force over the moved mass.  Mass that was moved but not
counted scales every acceleration; if the pedestal's fraction of it differs, P/NP is biased by the same
factor for every motion.
"""

import math

from rockfrag.errors import InputError


def _nonnegative(name: str, mass: float) -> None:
    if not (math.isfinite(mass) and mass >= 0):
        raise InputError(f"Measurement model: {name} must be a mass of 0 kg or more, got {mass}.")


def ratio_bias(
    statue: float, pedestal: float, table: float, *, counted_with: float, counted_without: float
) -> float:
    """Factor on P/NP when a is computed from force over the counted mass [-].

    The force F = (table + blocks) a moves everything; the reported figure is F over the counted mass, which was
    divided by in tests with and without the pedestal. All masses in kg.
    """
    for name, mass in (("statue", statue), ("pedestal", pedestal), ("table", table)):
        _nonnegative(name, mass)
    for name, mass in (("counted_with", counted_with), ("counted_without", counted_without)):
        _nonnegative(name, mass)
        if mass == 0:
            raise InputError(f"Measurement model: {name} is 0 kg, and force is divided by it.")
    with_pedestal = (table + statue + pedestal) / counted_with
    without = (table + statue) / counted_without
    return with_pedestal / without
