"""What every later stage receives: components of ground or floor acceleration, on one time base.

An acceleration is linear between its samples. In an interval that starts with acceleration a₀, velocity v₀ and
displacement d₀ and ends with a₁, with the slope s = (a₁ - a₀)/dt, a(τ) = a₀ + s τ, v(τ) = v₀ + a₀ τ + s τ²/2 and
d(τ) = d₀ + v₀ τ + a₀ τ²/2 + s τ³/6: integration loses nothing, and peaks between samples are found exactly.
"""

import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pyarrow.parquet as pq

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.files import whole_file
from rockfrag.base.short_repr import short_repr
from rockfrag.base.units import GRAVITY
from rockfrag.records.velocity_steps import VelocitySteps

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_SAMPLES = 10_000_000  # more than this are taken for a mistake in a unit
SAID = "said"
"""Key of a step of the provenance: words that everybody who uses the motion should read."""

# motions of a row group of a file, which can be read by themselves
MOTIONS_AT_ONCE = 64


@dataclass(frozen=True)
class Motion:
    """One component of acceleration, linear between samples.

    Attributes
    ----------
    acceleration : acceleration [m/s²], shape (n,), read-only
    dt : sampling interval [s]
    name : short name, unique within a study
    metadata : what is known about it: ``earthquake``, ``station``, ``component``, ``start_time``, ``floor``, …
    provenance : one entry per step it went through: ``{"step": name, **parameters}``
    """

    acceleration: Floats
    dt: float
    name: str = ""
    metadata: Mapping[str, Any] = field(default_factory=dict)
    provenance: tuple[Mapping[str, Any], ...] = ()

    __repr__ = short_repr

    def __post_init__(self) -> None:
        acceleration = self.acceleration
        # nobody can change those of another motion; others are copied
        if not (
            isinstance(acceleration, np.ndarray) and acceleration.dtype == np.float64
        ) or (acceleration.base is not None or acceleration.flags.writeable):
            acceleration = np.array(acceleration, dtype=np.float64)
        if acceleration.ndim != 1 or acceleration.size == 0:
            raise InputError(
                f"motion {self.name!r}: acceleration needs shape (n,) with n ≥ 1, got {acceleration.shape}."
            )
        if not np.isfinite(acceleration).all():
            first = int(np.flatnonzero(~np.isfinite(acceleration))[0])
            raise InputError(
                f"motion {self.name!r}: sample {first} is not a finite number."
            )
        if not (np.isfinite(self.dt) and self.dt > 0):
            raise InputError(
                f"motion {self.name!r}: dt must be a positive number of seconds, got {self.dt}."
            )
        acceleration.setflags(write=False)
        object.__setattr__(self, "acceleration", acceleration)
        object.__setattr__(self, "dt", float(self.dt))

    @property
    def time(self) -> Floats:
        """Time of each sample [s], shape (n,), from zero."""
        return np.arange(self.acceleration.size, dtype=np.float64) * self.dt

    @cached_property
    def pga(self) -> float:
        """Peak absolute acceleration [m/s²]."""
        return float(np.abs(self.acceleration).max())

    def plot(self) -> "Figure":
        """Draw acceleration [g], velocity [cm/s] and displacement [cm]; a dot marks the largest sample of each."""
        # matplotlib is loaded only by those who draw
        from rockfrag.base import figure_style as style

        velocity, displacement = integrate(self.acceleration, self.dt)
        drawn = (
            ("Acceleration [g]", self.acceleration / GRAVITY),
            ("Velocity [cm/s]", 100 * velocity),
            ("Displacement [cm]", 100 * displacement),
        )
        with style.panels(style.COLUMN_WIDTH, 4.2, 3, sharex=True) as (figure, panels):
            for panel, (label, values) in zip(panels, drawn, strict=True):
                style.draw_history(panel, self.time, values)
                panel.set_ylabel(label)
            panels[0].set_title(self.name, loc="left")
            panels[-1].set_xlabel("Time [s]")
            figure.align_ylabels(panels)
            return figure

    def peaks(self, samples: Floats) -> dict[str, float]:
        """Return the peaks [m/s²] before and after a step that changes samples, for its provenance."""
        after = float(np.abs(samples).max()) if samples.size else 0.0
        return {"peak_before_m_s2": self.pga, "peak_after_m_s2": after}

    def after(
        self,
        step: str,
        acceleration: Floats,
        dt: float | None = None,
        **parameters: Any,
    ) -> "Motion":
        """Return the motion that ``step`` made of this one, with the step in its provenance."""
        return replace(
            self,
            acceleration=acceleration,
            dt=self.dt if dt is None else dt,
            provenance=(*self.provenance, {"step": step, **parameters}),
        )


def write_motion_set(motions: Sequence[Motion], path: str | os.PathLike[str]) -> None:
    """Write motions to one Parquet file, a row per motion.

    Columns: ``name``, ``dt_s``, ``npts``, ``acceleration_m_s2`` (list), ``metadata`` and ``provenance`` (JSON).

    Parameters
    ----------
    motions
        Of any lengths and intervals.
    path
        Of the file, which appears whole or not at all.
    """
    table = pd.DataFrame(
        {
            "name": [m.name for m in motions],
            "dt_s": [m.dt for m in motions],
            "npts": [m.acceleration.size for m in motions],
            "acceleration_m_s2": [m.acceleration for m in motions],
            "metadata": [json.dumps(dict(m.metadata), sort_keys=True) for m in motions],
            "provenance": [
                json.dumps([dict(p) for p in m.provenance], sort_keys=True)
                for m in motions
            ],
        }
    )
    with whole_file(path) as file:
        table.to_parquet(
            file, index=False, engine="pyarrow", row_group_size=MOTIONS_AT_ONCE
        )


def read_motion_set(
    path: str | os.PathLike[str],
    part: tuple[int, int] = (0, 1),
    most: int | None = None,
) -> list[Motion]:
    """Read what :func:`write_motion_set` wrote, or part k of n of it, in order.

    Parameters
    ----------
    path
        Of the file.
    part
        Number of the part, from zero, and of parts.
    most
        Motions that are read at most.

    Returns
    -------
    list
        Motions with accelerations in m/s².
    """
    with pq.ParquetFile(path) as file:
        total, (number, parts) = file.metadata.num_rows, part
        first, last = number * total // parts, (number + 1) * total // parts
        if most is not None:
            last = min(last, first + most)
        found, size = [], file.metadata.row_group(0).num_rows if total else 1
        for group in range(first // size, -(-last // size)):
            begin = group * size
            rows = file.read_row_group(group).slice(max(first - begin, 0))
            table = rows.slice(0, last - max(first, begin)).to_pandas()
            found += [
                Motion(
                    acceleration=np.asarray(row["acceleration_m_s2"], dtype=np.float64),
                    dt=row["dt_s"],
                    name=row["name"],
                    metadata=json.loads(row["metadata"]),
                    provenance=tuple(json.loads(row["provenance"])),
                )
                for row in table.to_dict("records")
            ]
    return found


def read_motion_metadata(path: str | os.PathLike[str]) -> list[dict[str, Any]]:
    """Read what is known of each motion of a set, without its samples.

    Parameters
    ----------
    path
        Of a file of :func:`write_motion_set`.

    Returns
    -------
    list
        Metadata of each motion, in order.
    """
    found = pq.read_table(path, columns=["metadata"])["metadata"].to_pylist()
    return [json.loads(line) for line in found]


SAME_STEP = 1e-9  # relative difference of sampling intervals that is rounding of a file


@dataclass(frozen=True)
class GroundMotion:
    """Acceleration of the ground or floor: along x, and where it is known along y and upwards (z).

    Attributes
    ----------
    x : horizontal component along the x axis of the bodies, the plane of planar ones
    y : horizontal component across that plane; None where it is not given
    z : vertical component, upwards; None where it is not given
    steps : jumps of the velocity of ground or floor beside its accelerations; None for none
    """

    x: Motion
    y: Motion | None = None
    z: Motion | None = None
    steps: VelocitySteps | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        for name, other in (("y", self.y), ("z", self.z)):
            if other is None:
                continue
            if abs(other.dt - self.x.dt) > SAME_STEP * self.x.dt:
                raise InputError(
                    f"ground motion {self.name!r}: component {name} is sampled every {other.dt:g} s, component x "
                    f"every {self.x.dt:g} s; resample one of them."
                )
            if other.acceleration.size != self.x.acceleration.size:
                raise InputError(
                    f"ground motion {self.name!r}: component {name} has {other.acceleration.size} samples, "
                    f"component x {self.x.acceleration.size}; cut or pad one of them."
                )

    @property
    def dt(self) -> float:
        """Sampling interval [s]."""
        return self.x.dt

    @property
    def name(self) -> str:
        """Name of the component along x."""
        return self.x.name

    @property
    def components(self) -> str:
        """The components that are given: ``"x"``, ``"xz"``, ``"xy"`` or ``"xyz"``."""
        return (
            "x"
            + ("y" if self.y is not None else "")
            + ("z" if self.z is not None else "")
        )

    @property
    def accelerations(self) -> Floats:
        """Accelerations along x, y and z [m/s²], shape (n, 3); zero where a component is not given."""
        found = np.zeros((self.x.acceleration.size, 3))
        for column, motion in zip(found.T, (self.x, self.y, self.z), strict=True):
            if motion is not None:
                column[:] = motion.acceleration
        return found

    def with_second(self) -> "GroundMotion":
        """Return the motion with a second component, a still one if it has none: bodies then move in space."""
        if self.y is not None:
            return self
        still = self.x.after("still", np.zeros_like(self.x.acceleration))
        return replace(self, y=still)


def integrate(acceleration: Floats, dt: float) -> tuple[Floats, Floats]:
    """Integrate an acceleration that is linear between samples, from rest.

    Parameters
    ----------
    acceleration
        Samples, shape (n,) [m/s²].
    dt
        Sampling interval [s].

    Returns
    -------
    velocity : ndarray
        At the samples, shape (n,) [m/s].
    displacement : ndarray
        Likewise [m].
    """
    a0, a1 = acceleration[:-1], acceleration[1:]
    velocity = np.concatenate([[0.0], np.cumsum((a0 + a1) * (dt / 2))])
    steps = velocity[:-1] * dt + (2 * a0 + a1) * (dt**2 / 6)
    return velocity, np.concatenate([[0.0], np.cumsum(steps)])


def peak_velocity(acceleration: Floats, dt: float) -> float:
    """Peak absolute velocity [m/s], at samples or where the acceleration crosses zero between them.

    Parameters
    ----------
    acceleration
        Samples, shape (n,) [m/s²].
    dt
        Sampling interval [s].

    Returns
    -------
    float
        In m/s.
    """
    velocity, _ = integrate(acceleration, dt)
    a0, a1 = acceleration[:-1], acceleration[1:]
    turns = a0 * a1 < 0
    tau = dt * a0[turns] / (a0[turns] - a1[turns])
    between = velocity[:-1][turns] + a0[turns] * tau / 2
    return float(np.abs(np.concatenate([velocity, between])).max())


def peak_displacement(acceleration: Floats, dt: float) -> float:
    """Peak absolute displacement [m], at samples or where the velocity crosses zero between them.

    Parameters
    ----------
    acceleration
        Samples, shape (n,) [m/s²].
    dt
        Sampling interval [s].

    Returns
    -------
    float
        In m.
    """
    velocity, displacement = integrate(acceleration, dt)
    # the velocity has a zero in an interval only if it changes its sign there, or turns
    changes = (velocity[:-1] * velocity[1:] < 0) | (
        acceleration[:-1] * acceleration[1:] < 0
    )
    a0 = acceleration[:-1][changes]
    v0 = velocity[:-1][changes]
    d0 = displacement[:-1][changes]
    slope = np.diff(acceleration)[changes] / dt
    discriminant = a0**2 - 2 * slope * v0
    # the two roots in the form that loses no digits when one of them is small; a root that does not
    # exist comes out infinite or not a number and so does not lie inside the interval
    q = -(a0 + np.copysign(np.sqrt(np.maximum(discriminant, 0.0)), a0))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        roots = np.stack([q / slope, 2 * v0 / q])
    inside = (discriminant >= 0) & (roots > 0) & (roots < dt)
    tau = np.where(inside, roots, 0.0)
    between = d0 + v0 * tau + a0 * tau**2 / 2 + slope * tau**3 / 6
    return float(np.abs(np.concatenate([displacement, between[inside]])).max())
