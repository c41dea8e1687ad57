"""Velocity that topples, and that rocks, by width and height: a surface fitted to simulations, as a look-up.

In: width and height of uniform blocks on a floor [m], arrays of any shape. Out: medians of peak ground velocity
[m/s] or of peak ground acceleration [g], and dispersions [-]. The coefficients stand in
``toppling_velocity.json``, which ``python -m rockfrag.stages.toppling_velocity`` writes;
``docs/toppling-velocity.md`` shows how well they follow the simulations. With x = ln(B / 0.4 m), y = ln(H / 3B)

    ln median = c0 + c1 x + c2 y + c3 x² + c4 x y + c5 y² + c6 y³,        and the dispersion likewise.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from rockfrag.base.arrays import Flags, Floats
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import real_array

STANDINGS = ("plane", "square", "oblong", "round")
"""How a block is simulated: in one plane under one component, or in space under both: on a square, on an oblong
whose other side is twice the width, on a circle."""

LIMITS = (0.01, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
"""Rotations over the critical angle that are limit states; 1 stands for the fall (after D'Angela et al., 2026)."""

MEASURES = ("pgv_m_s", "pga_g")
"""Measures of the medians; of two components, their geometric mean."""

WIDTHS, HEIGHTS, SLENDERNESSES = (0.1, 0.8), (0.3, 3.0), (1.25, 30.0)
"""Least and largest width [m], height [m], and height over width [-] that the surface was fitted to."""

FILE = "toppling_velocity.json"
# edges of the range belong to it, whatever rounding made of them
EDGE = 1e-9


@dataclass(frozen=True)
class Surface:
    """Median and dispersion over width and height.

    Attributes
    ----------
    median, dispersion : coefficients c0 to c6 of ln median, and of the dispersion
    residual : standard deviation of ln median of sizes that the fit has not seen about the surface [-]
    largest : largest of those differences [-]
    earthquakes : standard error of ln median from the choice of the earthquakes, of a middle size [-]
    """

    median: tuple[float, ...]
    dispersion: tuple[float, ...]
    residual: float
    largest: float
    earthquakes: float

    def at(
        self,
        width_m: Floats | Sequence[float] | float,
        height_m: Floats | Sequence[float] | float,
    ) -> tuple[Floats, Floats]:
        """Median and dispersion of sizes; NaN outside of the sizes that the surface was fitted to.

        Parameters
        ----------
        width_m, height_m : side over which blocks rock, and height [m], which broadcast

        Returns
        -------
        Medians in the unit of the surface's measure, and dispersions [-], of the shape of both.
        """
        width, height = np.broadcast_arrays(
            real_array("width_m", width_m, "m"), real_array("height_m", height_m, "m")
        )
        inside = is_inside(width, height)
        terms = terms_of(np.where(inside, width, 1.0), np.where(inside, height, 3.0))
        median, dispersion = np.exp(terms @ self.median), terms @ self.dispersion
        # of one size it is one number
        shape = np.broadcast_shapes(np.shape(width_m), np.shape(height_m))
        return (
            np.where(inside, median, np.nan).reshape(shape),
            np.where(inside, dispersion, np.nan).reshape(shape),
        )


def is_inside(width_m: Floats, height_m: Floats) -> Flags:
    """Whether sizes are among those that the surface was fitted to.

    Parameters
    ----------
    width_m, height_m : sizes [m], of one shape

    Returns
    -------
    Flags of that shape.
    """
    slenderness = height_m / np.where(width_m > 0, width_m, np.nan)
    pairs = ((width_m, WIDTHS), (height_m, HEIGHTS), (slenderness, SLENDERNESSES))
    inside = np.ones(np.shape(slenderness), dtype=bool)
    for values, (low, high) in pairs:
        inside &= (values >= low * (1 - EDGE)) & (values <= high * (1 + EDGE))
    return inside


def terms_of(width_m: Floats, height_m: Floats) -> Floats:
    """Terms of the surface.

    Parameters
    ----------
    width_m, height_m : sizes [m], of one shape

    Returns
    -------
    The terms [-], that shape with 7 more.
    """
    x, y = np.log(width_m / 0.4), np.log(height_m / width_m / 3)
    return np.stack([np.ones_like(x), x, y, x**2, x * y, y**2, y**3], axis=-1)


def toppling_velocity(
    width_m: Floats | Sequence[float] | float,
    height_m: Floats | Sequence[float] | float,
    *,
    standing: str = "plane",
    limit: float = 1.0,
    measure: str = "pgv_m_s",
) -> tuple[Floats, Floats]:
    """Median and dispersion of the velocity (or acceleration) that topples uniform blocks, or rocks them so far.

    Parameters
    ----------
    width_m, height_m : side of the base over which the block rocks, and height [m], arrays that broadcast
    standing : one of :data:`STANDINGS`
    limit : rotation over the critical angle, one of :data:`LIMITS`; 1 is the fall
    measure : ``pgv_m_s`` or ``pga_g``

    Returns
    -------
    Medians in the unit of the measure and logarithmic standard deviations [-]; NaN outside of :data:`WIDTHS`,
    :data:`HEIGHTS` and :data:`SLENDERNESSES`.

    Examples
    --------
    A bookcase 0.32 m deep and 1.8 m high:

    >>> from rockfrag.fragility.toppling_velocity import toppling_velocity
    >>> median, dispersion = toppling_velocity(0.32, 1.8)
    >>> bool(0.3 < median < 0.6)
    True
    """
    return surface_of(standing, limit, measure).at(width_m, height_m)


def surface_of(standing: str, limit: float = 1.0, measure: str = "pgv_m_s") -> Surface:
    """Return the surface of a standing, a limit state and a measure.

    Parameters
    ----------
    standing, limit, measure : as of :func:`toppling_velocity`

    Returns
    -------
    The :class:`Surface`.
    """
    known = surfaces()
    if (standing, limit, measure) not in known:
        raise InputError(
            f"toppling velocity: no surface for {standing!r}, limit {limit!r}, {measure!r}; choose one of "
            f"{', '.join(STANDINGS)}, of {', '.join(f'{each:g}' for each in LIMITS)} and of "
            f"{', '.join(MEASURES)}."
        )
    return known[standing, limit, measure]


@cache
def surfaces() -> Mapping[tuple[str, float, str], Surface]:
    """Return all surfaces of the package, by standing, limit and measure."""
    text = files("rockfrag.fragility").joinpath(FILE).read_text(encoding="utf-8")
    return {
        (row["standing"], float(row["limit"]), row["measure"]): surface_from(row)
        for row in json.loads(text)["surfaces"]
    }


def surface_from(row: Mapping[str, Any]) -> Surface:
    """Return the surface of a row of the file.

    Parameters
    ----------
    row : of ``toppling_velocity.json``

    Returns
    -------
    The :class:`Surface`.
    """
    names = ("residual", "largest", "earthquakes")
    return Surface(
        tuple(row["median"]), tuple(row["dispersion"]), *(row[name] for name in names)
    )
