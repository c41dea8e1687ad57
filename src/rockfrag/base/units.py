"""Units that data enter or leave with; everything inside is SI.

A unit stands in the name of a key or column (``width_cm``), or beside the number (``35 cm``).
"""

import math
import re
import sys
from collections.abc import Mapping

from rockfrag.base.errors import InputError

GRAVITY = 9.81
"""Acceleration of gravity [m/s²] used throughout, as printed tables of ground motions use it.

Standard gravity, which other programs mean by g, is 9.80665 m/s².
"""

CENTIMETRES_PER_METRE = 100.0

DIMENSIONS: Mapping[str, Mapping[str, tuple[float, float]]] = {
    "length": {
        **{"m": (1.0, 1.0), "cm": (1.0, 100.0), "mm": (1.0, 1000.0)},
        **{"in": (0.0254, 1.0), "ft": (0.3048, 1.0)},
    },
    "mass": {
        "kg": (1.0, 1.0),
        "g": (1.0, 1000.0),
        "t": (1000.0, 1.0),
        "lb": (0.45359237, 1.0),
    },
    "moment of inertia": {
        **{"kg_m2": (1.0, 1.0), "kg_cm2": (1.0, 1e4), "g_cm2": (1.0, 1e7)},
        **{"t_m2": (1000.0, 1.0), "lb_ft2": (0.45359237 * 0.3048**2, 1.0)},
    },
    "acceleration": {
        **{"m_s2": (1.0, 1.0), "cm_s2": (1.0, 100.0), "gal": (1.0, 100.0)},
        "g": (GRAVITY, 1.0),
    },
    "velocity": {"m_s": (1.0, 1.0), "cm_s": (1.0, 100.0), "mm_s": (1.0, 1000.0)},
    "time": {"s": (1.0, 1.0), "ms": (1.0, 1000.0)},
    "force": {
        **{"N": (1.0, 1.0), "kN": (1000.0, 1.0)},
        # what spring balances show
        **{"kgf": (9.80665, 1.0), "lbf": (4.4482216152605, 1.0)},
    },
    "stiffness": {"N_m": (1.0, 1.0), "kN_m": (1000.0, 1.0), "N_mm": (1000.0, 1.0)},
}
"""Of each dimension its units, and of each unit the factor and the divisor that lead to SI.

A g beside an acceleration is that of gravity; as a unit to convert to it is the gram.
"""

EXAMPLES: Mapping[str, str] = {
    "length": "a length such as 1.2 m",
    "mass": "a mass such as 180 kg",
    "moment of inertia": "a moment of inertia such as 25 kg m2",
    "acceleration": "an acceleration such as 0.25 g",
    "velocity": "a velocity such as 20 cm/s",
    "time": "a time such as 0.3 s",
    "force": "a force such as 120 N",
    "stiffness": "a stiffness such as 50 kN/m",
}
"""What a message names as an example of each dimension: a size that people meet."""

_DECIMAL_COMMA = re.compile(r"\s*[-+]?\d+,\d+(?!\d*,)")
_NUMBER = re.compile(
    r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*", re.DOTALL
)


def dimension_of(unit: str) -> str:
    """Dimension of a unit as it stands in names.

    Parameters
    ----------
    unit : such as ``cm`` or ``kg_m2``

    Returns
    -------
    The dimension, such as ``length``.
    """
    return next(name for name, units in DIMENSIONS.items() if unit in units)


def convert(value: float, unit: str, to: str) -> float:
    """Express a value in another unit of the same dimension.

    Parameters
    ----------
    value : in ``unit``
    unit, to : of the same dimension, as they stand in :data:`DIMENSIONS`

    Returns
    -------
    The value in the unit ``to``.
    """
    if unit == to:
        return value
    units = DIMENSIONS[dimension_of(to)]
    (factor, divisor), (to_factor, to_divisor) = units[unit], units[to]
    return value * factor / divisor * to_divisor / to_factor


def quantity(given: object, to: str, unit: str | None) -> float:
    """Read a number, or a text with a number and a unit such as ``35 cm``, in another unit.

    ``unit`` is that of a number without one, or None where it must stand beside the number. A message is to be
    put behind the place where the number was found.

    Parameters
    ----------
    given : a number, or a text of a number and a unit
    to : unit of the number that is returned
    unit : of a number without one; None where it must be written

    Returns
    -------
    The number, in the unit ``to``.
    """
    dimension = dimension_of(to)
    units = DIMENSIONS[dimension]
    expected = f"expected {EXAMPLES[dimension]}"
    if isinstance(given, str) and _DECIMAL_COMMA.match(given):
        raise InputError(
            f"{expected}, found {given!r:.60}; write decimals with a point, as "
            f"{given.strip().replace(',', '.', 1)!r:.60}."
        )
    number = _NUMBER.fullmatch(given) if isinstance(given, str) else None
    if isinstance(given, int | float) and not isinstance(given, bool):
        # a whole number may be larger than any float
        value = math.inf if abs(given) > sys.float_info.max else float(given)
        written = ""
    elif number:
        value, written = float(number[1]), number[2]
    else:
        raise InputError(f"{expected}, found {given!r:.60}.")
    if not math.isfinite(value):
        raise InputError(f"{expected}, found {given!r:.60}.")
    # kg m², kg·m^2 and kg*m2 are kg_m2, cm/s² is cm_s2
    plain = written.replace("²", "2").replace("^", "").strip()
    found = "_".join(re.split(r"[\s·*_/]+", plain)) if written else unit
    if found is None:
        raise InputError(f"{expected}, found {given!r:.60} without a unit.")
    if found not in units:
        # m_s2 is written m/s², and N_m N/m
        known = ", ".join(re.sub(r"_(s2?|(?<=N_)mm?)$", r"/\1", unit) for unit in units)
        known = known.replace("_", " ").replace("2", "²")
        raise InputError(
            f"{expected} in one of the units {known}, found {given!r:.60}."
        )
    return convert(value, found, to)


def other_names(name: str) -> dict[str, str | None]:
    """Names under which a quantity such as ``width_cm`` may be given, and the unit that each states.

    ``{"width": None, "width_m": "m", "width_cm": "cm", …}``; None where the unit stands beside the number. Names
    are written small: ``putty_kn`` states kN.

    Parameters
    ----------
    name : of a key or column that ends in a unit

    Returns
    -------
    The unit by the name that states it.
    """
    stem, unit = split_name(name)
    units = DIMENSIONS[dimension_of(unit)]
    return {stem: None, **{f"{stem}_{unit.lower()}": unit for unit in units}}


def split_name(name: str) -> tuple[str, str]:
    """Split a name such as ``inertia_kg_m2`` into what it names and its unit.

    Parameters
    ----------
    name : of a key or column that ends in a unit of stiffness, length, mass, moment of inertia, force or time

    Returns
    -------
    The name without its unit, and the unit.
    """
    # what ends in N/m ends in m too
    for dimension in (
        "stiffness",
        "moment of inertia",
        "mass",
        "length",
        "force",
        "time",
    ):
        for unit in DIMENSIONS[dimension]:
            ending = f"_{unit.lower()}"
            if name.endswith(ending):
                return name.removesuffix(ending), unit
    raise ValueError(f"{name} names no unit")
