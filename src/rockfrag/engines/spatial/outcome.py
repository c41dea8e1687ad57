"""What one analysis in space ends with, and its history."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.arrays import Floats
from rockfrag.engines.kernels.jit import compiling_alone
from rockfrag.engines.spatial import _integrate as kernel
from rockfrag.engines.spatial import _modes as modes
from rockfrag.engines.spatial._forces import CASE
from rockfrag.engines.spatial.body import later_peaks, standing
from rockfrag.units import GRAVITY

TOLERANCE = 1e-9  # largest error of a step: position [m], attitude [-], velocities [m/s, rad/s]
CUT_OFF = 1e-6  # energy over rest, as a part of what a fall takes, at which a body rests [-]
AFTER = 30.0  # time after the motion at which an analysis ends at the latest [s]
RESTS = 99


@dataclass(frozen=True)
class SpatialOutcome:
    """What became of a body in space."""

    overturned: bool  # whether it fell
    certain_time: float  # instant from which the fall was certain [s]; NaN without one
    fall_direction: float  # from x towards y [rad]; NaN without a fall
    fell_over: str  # "edge 1-2", "vertex 2", "rim", "flight"; empty without a fall
    # largest tilt over that with the centre of mass above the outline [-]; infinite if it fell
    peak_rotation: float
    peak_tilt: float  # largest tilt until the outcome was known [rad]
    peak_velocity: float  # largest angular velocity until then [rad/s]
    # displacement of the base's point below the centre of mass, (x, y) at the end [m]
    walk: tuple[float, float]
    turn: float  # rotation about the vertical at the end [rad], several turns counted
    impacts: int  # number of impacts
    slidings: int  # number of contacts that began to slide
    flights: int  # number of flights
    ambiguous: int  # impacts and changes of mode with more than one admissible outcome
    paradoxes: int  # impacts and changes without one, and jams: contacts that no finite force holds
    dissipated: tuple[float, float]  # energy lost in impacts, and by friction [J/kg]
    residual: float  # what the balance of energy does not close by [J/kg]
    gained: float  # energy that events of contact added, by rounding or as a rim leaves rest tilted [J/kg]


def run_case(
    body: np.void,
    acceleration: Floats,
    dt: float,
    scale: float = 1.0,
    *,
    g: float = GRAVITY,
    peaks: Floats | None = None,
    samples: int = 0,
    tolerance: float = TOLERANCE,
    start: Floats | None = None,
) -> tuple[SpatialOutcome, Floats]:
    """Integrate one analysis; the outcome, and the history, shape (m, COLUMNS), of at most so many samples.

    ``acceleration`` is the ground's (x, y, up), shape (n, 3) [m/s²], ``peaks`` those of :func:`later_peaks`, and
    ``start`` a state to begin with, shape (SIZE,).
    """
    acceleration = np.ascontiguousarray(acceleration)
    y = standing(body) if start is None else start.copy()
    history = np.full((samples, kernel.COLUMNS), math.nan)
    out = np.zeros(kernel.OUTCOME)
    case: Any = np.zeros(1, CASE)[0]
    later = later_peaks(acceleration) if peaks is None else peaks
    steps = dt, g, math.ceil(AFTER / dt), tolerance, CUT_OFF
    with compiling_alone(kernel.integrate):
        kernel.integrate(body, acceleration, later, scale, *steps, y, history, out, case)
    kept = ~np.isnan(history[:, 0])
    return _outcome(body, out, case["counters"], y), history[kept]


def _outcome(body: np.void, out: Floats, counters: NDArray[np.int64], y: Floats) -> SpatialOutcome:
    fell = bool(out[kernel.FELL])
    return SpatialOutcome(
        overturned=fell,
        certain_time=float(out[kernel.CERTAIN_TIME]),
        fall_direction=float(out[kernel.FALL_AZIMUTH]) if fell else math.nan,
        fell_over=_named(body, out) if fell else "",
        peak_rotation=math.inf if fell else float(out[kernel.PEAK_RATIO]),
        peak_tilt=float(out[kernel.PEAK_TILT]),
        peak_velocity=float(out[kernel.PEAK_SPEED]),
        walk=(float(out[kernel.WALK_X]), float(out[kernel.WALK_Y])),
        turn=float(out[kernel.TURN]),
        impacts=int(counters[modes.IMPACTS]),
        slidings=int(counters[modes.SLIDINGS]),
        flights=int(counters[modes.FLIGHTS]),
        ambiguous=int(counters[modes.AMBIGUOUS]),
        paradoxes=int(counters[modes.UNSOLVED] + counters[modes.JAMS]),
        dissipated=(float(out[kernel.LOST]), float(y[14])),
        residual=float(out[kernel.ENERGY_BALANCE]),
        gained=float(out[kernel.GAINED]),
    )


def _named(body: np.void, out: Floats) -> str:
    """Say over what a body fell."""
    first, second = int(out[kernel.FALL_FIRST]), int(out[kernel.FALL_SECOND])
    if first < 0:
        return "flight"
    if body["rim"] > 0:
        return "rim"
    if second < 0:
        return f"vertex {first + 1}"
    low, high = sorted((first, second))
    return f"edge {low + 1}-{high + 1}"


def history_table(history: Floats, dt: float, height: float) -> pd.DataFrame:
    """Return a history of :func:`run_case` as the table of a :class:`rockfrag.engines.spatial.SpatialResponse`."""
    w, x, y, z = history[:, 3:7].T
    axis = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    closed = np.where(history[:, 14] == RESTS, math.nan, history[:, 14])
    return pd.DataFrame(
        {
            "time_s": np.arange(len(history)) * dt,
            "x_m": history[:, 0],
            "y_m": history[:, 1],
            "z_m": history[:, 2],
            "tilt_rad": np.arctan2(np.hypot(axis[0], axis[1]), axis[2]),
            "axis_x": axis[0],
            "axis_y": axis[1],
            "turn_rad": history[:, 13],
            "base_x_m": history[:, 0] - height * axis[0],
            "base_y_m": history[:, 1] - height * axis[1],
            "omega_x_rad_s": history[:, 10],
            "omega_y_rad_s": history[:, 11],
            "omega_z_rad_s": history[:, 12],
            "contacts": closed,
        }
    )
